// SPDX-License-Identifier: Apache-2.0
const { workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

exports.activate = () => {
  const [command, ...args] = workspace.getConfiguration("prehend").get("server");
  client = new LanguageClient("prehend", "prehend", { command, args }, { documentSelector: [{ language: "prehend-grammar" }] });
  return client.start();
};
exports.deactivate = () => client?.stop();
