// SPDX-License-Identifier: Apache-2.0
// replay.js and what it needs of three.js, as one script, deflated, in base64: `node bundle.mjs OUTPUT`. The report page
// inflates it when somebody opens a replay.
import {build} from 'esbuild';
import {writeFileSync} from 'node:fs';
import {deflateSync} from 'node:zlib';

const result = await build({
  entryPoints: ['replay.js'],
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2020',
  legalComments: 'inline',
  write: false,
  logLevel: 'error',
});
const script = Buffer.from(result.outputFiles[0].contents);
writeFileSync(process.argv[2], deflateSync(script, {level: 9}).toString('base64'));
