// SPDX-License-Identifier: Apache-2.0
// See same_bson. The statements of each episode and of its map, as rapper reads them from Turtle, must be those of
// the BSON documents; transforms must follow each other in time and have unit quaternions.
import {deserialize} from 'bson';
import {execFileSync} from 'node:child_process';
import {readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';

const folder = process.argv[2];
let faults = 0;
const fault = text => { console.log(text); ++faults; };

function documents(file) {
  const bytes = readFileSync(file), found = [];
  for (let at = 0; at < bytes.length;) {
    const size = bytes.readInt32LE(at);
    found.push(deserialize(bytes.subarray(at, at + size), {promoteValues: true}));
    at += size;
  }
  return found;
}

// "s p o" of each statement; numbers by their value.
function statements(file) {
  const lines = execFileSync('rapper', ['-q', '-i', 'turtle', '-o', 'ntriples', file], {encoding: 'utf8', maxBuffer: 1 << 28});
  return lines.split('\n').filter(Boolean).map(line => {
    const [, s, p, o] = /^<(.*?)> <(.*?)> (.*) \.$/.exec(line);
    if (o.startsWith('<')) return [s, p, o.slice(1, -1)];
    const [, text, type] = /^("(?:.*)")(?:\^\^<(.*)>)?$/.exec(o);
    const plain = JSON.parse(text);
    return [s, p, /#(double|integer)$/.test(type ?? '') ? Number(plain) : plain];
  });
}

const key = triple => JSON.stringify(triple);
let all = 0, transforms = 0;
for (const episode of readdirSync(join(folder, 'neem'))) {
  const of = name => documents(join(folder, 'neem', episode, name + '.bson'));
  const own = statements(join(folder, 'episodes', episode + '.ttl'));
  const map = own.find(([, p]) => p.endsWith('#performedTask'))[2].split('#')[1];
  const wanted = new Set([...own, ...statements(join(folder, 'maps', map + '.ttl'))].map(key));
  const found = new Set([...of('triples').map(d => key([d.s, d.p, typeof d.o === 'bigint' ? Number(d.o) : d.o])),
                         ...of('annotations').map(d => key([d.s, d.p, d.string]))]);
  for (const one of wanted) if (!found.has(one)) fault(`${episode}: missing ${one}`);
  for (const one of found) if (!wanted.has(one)) fault(`${episode}: too much ${one}`);
  for (const d of of('triples'))
    if (d['p*'][0] !== d.p || (d['o*'] && d['o*'][0] !== d.o)) fault(`${episode}: closure of ${d.s} ${d.p}`);
  all += found.size;
  let last = 0;
  for (const d of of('tf')) {
    const {x, y, z, w} = d.transform.rotation;
    if (Math.abs(Math.hypot(x, y, z, w) - 1) > 1e-9) fault(`${episode}: rotation of ${d.child_frame_id}`);
    if (!(d.header.stamp.getTime() >= last) || d.header.frame_id !== 'world') fault(`${episode}: header ${d.header.seq}`);
    last = d.header.stamp.getTime();
    ++transforms;
  }
}
console.log(`${all} statements and ${transforms} transforms read back`);
process.exit(faults || !all || !transforms ? 1 : 0);
