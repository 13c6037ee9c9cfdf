// SPDX-License-Identifier: Apache-2.0
// `python3 -m prehend lsp`, as an editor would use it; then a thousand random edits of library grammars.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import protocol from "vscode-languageserver-protocol/node.js";

const { createProtocolConnection, StreamMessageReader, StreamMessageWriter } = protocol;
const project = process.env.PROJECT;
const library = join(project, "grammar/library");
let server, connection, died = false, version = 1;
const waiting = new Map();  // uri -> who waits for its diagnostics

before(async () => {
  server = spawn("/usr/bin/python3", ["-B", "-m", "prehend", "lsp"], {
    env: { ...process.env, PYTHONPATH: join(dirname(process.env.PREHEND), "python"), PREHEND_HOME: project },
    stdio: ["pipe", "pipe", "inherit"] });
  server.on("exit", () => { died = true; });
  connection = createProtocolConnection(new StreamMessageReader(server.stdout), new StreamMessageWriter(server.stdin));
  connection.onNotification("textDocument/publishDiagnostics", ({ uri, diagnostics }) => {
    waiting.get(uri)?.(diagnostics);
    waiting.delete(uri);
  });
  connection.listen();
  const { capabilities } = await connection.sendRequest("initialize", { processId: process.pid, rootUri: null, capabilities: {} });
  assert.ok(capabilities.hoverProvider && capabilities.renameProvider && capabilities.definitionProvider);
  await connection.sendNotification("initialized", {});
});

after(async () => {
  await connection.sendRequest("shutdown");
  const gone = new Promise((done) => server.on("exit", done));
  await connection.sendNotification("exit");
  assert.equal(await gone, 0);
});

const uriOf = (name) => pathToFileURL(join("/nowhere", name)).href;
const diagnosed = (uri) => new Promise((done) => waiting.set(uri, done));

const opened = async (name, text) => {
  const uri = uriOf(name), found = diagnosed(uri);
  await connection.sendNotification("textDocument/didOpen",
    { textDocument: { uri, languageId: "prehend-grammar", version: version++, text } });
  return { uri, diagnostics: await found };
};
const changed = async (uri, text) => {
  const found = diagnosed(uri);
  await connection.sendNotification("textDocument/didChange", { textDocument: { uri, version: version++ }, contentChanges: [{ text }] });
  return found;
};
/** Where `words` stand in a text, plus so many characters. */
const at = (text, words, more = 0) => {
  const begin = text.indexOf(words) + more, line = text.slice(0, begin).split("\n").length - 1;
  return { line, character: begin - (text.lastIndexOf("\n", begin - 1) + 1) };
};
const ask = (what, uri, position, more = {}) => connection.sendRequest(`textDocument/${what}`, { textDocument: { uri }, position, ...more });

const TEXT = `grammar mine
use grasp
param near = 5 cm
# It is where one drinks.
condition at_mouth(hand: Hand, cup: Thing)
  while grasping(hand, cup) and height(cup) > near
event drinking(hand: Hand, cup: Thing)
  from grasping(hand, cup) begins to at_mouth(hand, cup) ends
`;

test("errors while typing, all of them, each with its range and remedy", async () => {
  const { uri, diagnostics } = await opened("errors.grammar", TEXT.replace("use grasp\n", "") + "event x(c: Thing) while c.speed > 1\n");
  const messages = diagnostics.map(({ message }) => message);
  assert.equal(messages.length, 2, messages.join("\n"));
  assert.match(messages[0], /unknown event.*'grasping'[^]*use grasp/);
  assert.match(messages[1], /speed\(c\)/);
  assert.deepEqual(diagnostics[0].range.start, { line: 4, character: 8 });
  assert.deepEqual(diagnostics[0].range.end, { line: 4, character: 16 });
  assert.deepEqual(await changed(uri, TEXT), []);
  assert.equal((await changed(uri, TEXT + "param spare = 3\n"))[0].severity, 2);
});

test("completion, hover, definition", async () => {
  const { uri } = await opened("help.grammar", TEXT);
  const items = await ask("completion", uri, at(TEXT, "height", 3));
  const found = new Map(items.map((item) => [item.label, item]));
  for (const label of ["height", "grasping", "at_mouth", "near", "cup", "lasting", "gap"]) assert.ok(found.has(label), label);
  assert.match(found.get("height").documentation.value, /above the world's origin/);
  assert.match(found.get("at_mouth").documentation.value, /where one drinks/);
  const uses = await ask("completion", uri, at(TEXT, "use grasp", 6));
  assert.ok(uses.some(({ label }) => label === "pick_and_place"));
  assert.match((await ask("hover", uri, at(TEXT, "height", 1))).contents.value, /`height\(p\) \[m\]`/);
  assert.match((await ask("hover", uri, at(TEXT, "at_mouth(hand, cup) ends", 1))).contents.value, /condition at_mouth[^]*where one drinks/);
  assert.match((await ask("hover", uri, at(TEXT, "from", 1))).contents.value, /Begins at A/);
  const there = await ask("definition", uri, at(TEXT, "at_mouth(hand, cup) ends", 1));
  assert.deepEqual([there.uri, there.range.start], [uri, at(TEXT, "at_mouth(hand: Hand")]);
  assert.match((await ask("definition", uri, at(TEXT, "grasping", 1))).uri, /grammar\/library\/grasp\.grammar$/);
  assert.deepEqual((await ask("definition", uri, at(TEXT, "height(cup", 8))).range.start, at(TEXT, "cup: Thing"));
});

test("rename, layout", async () => {
  const { uri } = await opened("rename.grammar", TEXT);
  const applied = (edits) => {
    const lines = TEXT.split("\n");
    for (const { range, newText } of [...edits].sort((a, b) => b.range.start.character - a.range.start.character))
      lines[range.start.line] = lines[range.start.line].slice(0, range.start.character) + newText + lines[range.start.line].slice(range.end.character);
    return lines.join("\n");
  };
  const renamed = async (words, newName) =>
    applied(Object.values((await ask("rename", uri, at(TEXT, words, 1), { newName })).changes)[0]);
  assert.equal(await renamed("at_mouth(hand: Hand", "sipping"), TEXT.replaceAll("at_mouth", "sipping"));
  assert.equal(await renamed("near = 5", "close"), TEXT.replaceAll("near", "close"));
  const [head, ...rest] = TEXT.split("event drinking");
  assert.equal(await renamed("cup: Thing", "mug"), head.replaceAll("cup", "mug") + "event drinking" + rest.join(""));
  for (const [words, newName] of [["grasping", "holding"], ["near = 5", "while"], ["near = 5", "at_mouth"], ["near = 5", "3 x"],
    ["near = 5", "_close"], ["near = 5", "nähe"], ["near = 5", "cup"], ["at_mouth(hand: Hand", "speed"], ["at_mouth(hand: Hand", "grasping"],
    ["cup: Thing", "near"]])
    await assert.rejects(ask("rename", uri, at(TEXT, words, 1), { newName }), `${words} ${newName}`);
  await changed(uri, TEXT.replaceAll(" > ", ">").replaceAll("  ", "\t"));
  const [edit] = await ask("formatting", uri, undefined, { options: { tabSize: 2, insertSpaces: true } });
  assert.equal(edit.newText, TEXT);
});

test("a rename in a text with errors is refused as in one without", async () => {
  for (const broken of ["\nevent later(cup: Thing) while", "\nevent later(cup: Thing) while heigth(cup) > 1 m\n"]) {
    const text = TEXT + broken, { uri } = await opened("broken.grammar", text);
    const rename = (words, newName) => ask("rename", uri, at(text, words, 1), { newName });
    assert.ok(Object.values((await rename("at_mouth(hand: Hand", "sipping")).changes)[0].length > 1);
    assert.ok(await rename("near = 5", "close"));
    assert.ok(await rename("cup: Thing", "mug"));
    for (const [words, newName] of [["at_mouth(hand: Hand", "speed"], ["at_mouth(hand: Hand", "grasping"],
      ["cup: Thing", "near"], ["at_mouth(hand: Hand", "touching"]])
      await assert.rejects(rename(words, newName), `${words} ${newName}`);
  }
});

test("columns are those of UTF-16; a name begins behind its bracket; the words of a table of files are none", async () => {
  const text = 'grammar wide\ndefine near(a: Hand, b: Thing) = distance(a, b) < 5 cm\n' +
    'event a(hand: Hand, o: Thing)\n  while sensor_set(hand, "D\u00E4u\u{1F600}\u{1F600}", o) and near(hand, o) and speed(hand) > 3 s\n';
  const { uri, diagnostics } = await opened("wide.grammar", text);
  assert.deepEqual(diagnostics.at(-1).range.start, at(text, "> 3 s"));
  await changed(uri, text.replace("3 s", "3 m/s"));
  const { changes } = await ask("rename", uri, at(text, "near(a"), { newName: "closer" });
  assert.deepEqual(changes[uri].map(({ range }) => range.start), [at(text, "near(a"), at(text, "near(hand")]);
  assert.deepEqual((await ask("hover", uri, at(text, "near(hand"))).range.end, at(text, "near(hand", 4));
  assert.deepEqual((await ask("definition", uri, at(text, "hand, o) and speed"))).range.start, at(text, "hand: Hand"));
  const items = new Map((await ask("completion", uri, at(text, "speed(hand"))).map((item) => [item.label, item]));
  assert.ok(!items.has("contact") && !items.has("original_") && !items.has("tabletop"));
  assert.match(items.get("force").detail, /force\(a, b\) \[N\]/);
});

test("what is no request is answered, and the next one, too", async () => {
  for (const body of ["[1]", "{", '"x"']) server.stdin.write(`Content-Length: ${body.length}\r\n\r\n${body}`);
  const { uri } = await opened("later.grammar", TEXT);
  assert.ok(await ask("hover", uri, at(TEXT, "height", 1)));
});

test("a thousand random edits: it lives, and answers within 50 ms of processor time", async () => {
  let seed = 51;
  const below = (n) => { seed = (seed * 1103515245 + 12345) % 2147483648; return Math.floor(seed / 65536) % n; };
  const spent_ms = () => Number(readFileSync(`/proc/${server.pid}/schedstat`, "utf8").split(" ")[0]) / 1e6;
  const texts = readdirSync(library).filter((name) => name.endsWith(".grammar")).map((name) => readFileSync(join(library, name), "utf8"));
  const times = [];
  for (let round = 0; round < 100; ++round) {
    let text = texts[below(texts.length)];
    const { uri } = await opened(`edited_${round}.grammar`, text);
    for (let i = 0; i < 10; ++i) {
      const where = below(text.length), length = below(30);
      const put = ["", text.slice(where, where + length), "object.speed", "(", "\u201C", "\n", "use ", "\u{1F600}", "#"][below(9)];
      text = text.slice(0, where) + put + text.slice(where + (below(2) ? length : 0));
      const began = spent_ms();
      await changed(uri, text);
      const position = at(text, text.slice(where, where + 8));
      const asked = ["completion", "hover", "definition", "formatting", "rename"][below(5)];
      await ask(asked, uri, position, { options: {}, newName: "renamed" }).catch((error) => assert.equal(asked, "rename", error));
      times.push(spent_ms() - began);
      assert.ok(!died);
    }
    await connection.sendNotification("textDocument/didClose", { textDocument: { uri } });
  }
  times.sort((a, b) => a - b);
  console.log(`an edit and a question: median ${times[500].toFixed(1)} ms, longest ${times.at(-1).toFixed(1)} ms`);
  assert.equal(times.length, 1000);
  assert.ok(times.at(-1) < 50, `the slowest took ${times.at(-1)} ms`);
});
