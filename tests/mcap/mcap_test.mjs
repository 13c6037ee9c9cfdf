// SPDX-License-Identifier: Apache-2.0
// Every message of an exported MCAP file is decoded by @mcap/core and Foxglove's reader of ROS 2; the file is what rosbag2
// and Foxglove ask for: index, checksums, counts, metadata.yaml.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, openSync, fstatSync, readSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";

const folder = mkdtempSync(join(tmpdir(), "prehend_mcap_"));
after(() => rmSync(folder, { recursive: true }));
const prehend = (...words) => execFileSync(process.env.PREHEND, words, { cwd: process.env.PROJECT, encoding: "utf8", maxBuffer: 1 << 30 });

const readable = (path) => {
  const file = openSync(path), size = fstatSync(file).size;
  return {
    size: async () => BigInt(size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      assert.equal(readSync(file, bytes, 0, bytes.length, Number(offset)), bytes.length);
      return bytes;
    },
  };
};

/** Its messages by topic, each with its time in nanoseconds, through the index. */
const decoded = async (path) => {
  const reader = await McapIndexedReader.Initialize({ readable: readable(path) });
  assert.equal(reader.header.profile, "ros2");
  const readers = new Map(), topics = {};
  for (const [id, channel] of reader.channelsById) {
    const schema = reader.schemasById.get(channel.schemaId);
    assert.equal(channel.messageEncoding, "cdr");
    assert.equal(schema.encoding, "ros2msg");
    assert.match(channel.metadata.get("offered_qos_profiles"), /durability: [12]/);
    readers.set(id, new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true })));
    topics[channel.topic] = { type: schema.name, messages: [] };
  }
  let last = 0n, count = 0n;
  for await (const message of reader.readMessages()) {
    assert.ok(message.logTime >= last);
    last = message.logTime;
    count += 1n;
    topics[reader.channelsById.get(message.channelId).topic].messages.push({ ns: message.logTime, ...readers.get(message.channelId).readMessage(message.data) });
  }
  assert.equal(count, reader.statistics.messageCount);
  assert.equal(last, reader.statistics.messageEndTime);
  assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
  for (const [id, channel] of reader.channelsById)
    assert.equal(reader.statistics.channelMessageCounts.get(id) ?? 0n, BigInt(topics[channel.topic].messages.length));
  return { topics, count, reader };
};

const exported = (...words) => {
  const name = `bag${Math.random()}`.replace(".", "");
  prehend("episode", "export", ...words, "--to", "mcap", "-o", join(folder, name, "take.mcap"));
  return join(folder, name, "take.mcap");
};

/** [{tick, poses by entity}] of a recording. */
const framesOf = (...words) => {
  const path = join(folder, "take.jsonl");
  prehend("episode", "export", ...words, "--to", "jsonl", "-o", path);
  const lines = readFileSync(path, "utf8").trim().split("\n").map((line) => JSON.parse(line));
  const now = {};
  return { first: lines[0], frames: lines.slice(1).filter((line) => "tick" in line).map((line) => ({ ...line, now: { ...Object.assign(now, line.samples) } })) };
};

for (const scenario of ["milk_carton_wrap", "drawer_is_opened_with_hook"]) {
  test(`${scenario}: transforms are the recording's poses`, async () => {
    const path = exported(scenario), { topics } = await decoded(path);
    const { first, frames } = framesOf(scenario);
    const still = Object.fromEntries(topics["/tf_static"].messages[0].transforms.map((one) => [one.child_frame_id, one]));
    assert.ok(Object.keys(still).length > 0);
    assert.equal(topics["/tf"].messages.length, frames.length);
    frames.forEach((frame, i) => {
      const message = topics["/tf"].messages[i], seen = { ...still };
      assert.equal(message.ns, BigInt(Math.round((frame.tick / first.ticks_per_second) * 1e9)));
      for (const one of message.transforms) {
        assert.equal(BigInt(one.header.stamp.sec) * 1000000000n + BigInt(one.header.stamp.nanosec ?? one.header.stamp.nsec), message.ns);
        seen[one.child_frame_id] = one;
      }
      for (const [name, look] of Object.entries(frame.now)) {
        const { translation: p, rotation: q } = seen[name].transform;
        assert.deepEqual([p.x, p.y, p.z], look.at_m, name);
        assert.deepEqual([q.w, q.x, q.y, q.z], look.quat_wxyz, name);
        assert.equal(seen[name].header.frame_id, "world");
      }
      const grip = topics["/joint_states"].messages[i];
      for (const [name, look] of Object.entries(frame.now)) {
        const joint = grip.name.indexOf(name);
        assert.equal(joint < 0 ? 0 : grip.position[joint], look.joint_position ?? 0);
      }
      assert.equal(grip.position[grip.name.indexOf("right_hand_grip")], frame.hands.right_hand.trigger);
    });
  });
}

test("shapes stay with their frames", async () => {
  const { topics } = await decoded(exported("milk_carton_wrap"));
  const [{ markers }] = topics["/markers"].messages, milk = markers.find((marker) => marker.ns === "milk");
  assert.deepEqual([milk.type, milk.header.frame_id, milk.frame_locked], [1, "milk", true]);
  assert.deepEqual([milk.scale.x, milk.scale.y, milk.scale.z], [0.07, 0.07, 0.2]);
  assert.deepEqual(new Set(markers.map((marker) => marker.ns)), new Set(["table", "milk", "right_hand"]));
  assert.ok(markers.every((marker) => marker.color.a > 0 && marker.pose.orientation.w === 1));
});

test("all kinds of shapes are markers", async () => {
  const path = join(folder, "shapes.jsonl");
  const parts = [{ box: { size_m: [1, 2, 3] }, at_m: [0, 0, 1] }, { sphere: { radius_m: 1 } }, { cylinder: { radius_m: 1, length_m: 4 } },
    { capsule: { radius_m: 1, length_m: 4 } }, { hull: { points_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] } }];
  const lines = [{ recording: 1, episode: "shapes", grammar: "contact", ticks_per_second: 10, entities: { "thing": { size_m: [1, 1, 1], parts } } },
    { tick: 0, samples: { "thing": { at_m: [0, 0, 0] } } }, { tick: 5, samples: { "thing": { at_m: [1, 0, 0] } } }, { end_tick: 9 }];
  writeFileSync(path, lines.map((line) => JSON.stringify(line)).join("\n"));
  const { topics } = await decoded(exported(path));
  const [{ markers }] = topics["/markers"].messages;
  assert.deepEqual(markers.map((marker) => marker.type), [1, 2, 3, 3, 2, 2, 11]);
  assert.deepEqual(markers.map((marker) => marker.id), [0, 1, 2, 3, 4, 5, 6]);
  assert.equal(markers[6].points.length, 12);  // four triangles
  assert.deepEqual(markers.slice(4, 6).map((marker) => marker.pose.position.z), [-2, 2]);
  assert.equal(topics["/tf_static"].messages.length, 0);  // it moves
});

test("outlines are points on the shapes, in their frames", async () => {
  const { topics } = await decoded(exported("milk_carton_wrap"));
  const [cloud] = topics["/shapes/milk"].messages, points = new Float32Array(new Uint8Array(cloud.data).buffer);
  assert.deepEqual([cloud.header.frame_id, cloud.height, cloud.point_step], ["milk", 1, 12]);
  assert.equal(points.length, 3 * cloud.width);
  assert.deepEqual(cloud.fields.map((field) => [field.name, field.offset, field.datatype]), [["x", 0, 7], ["y", 4, 7], ["z", 8, 7]]);
  const far = [0, 1, 2].map((axis) => Math.max(...points.filter((_, i) => i % 3 === axis).map(Math.abs)));
  assert.deepEqual(far.map((value) => Math.round(value * 1e6)), [35000, 35000, 100000]);
  for (const name of ["table", "right_hand"]) assert.ok(topics["/shapes/" + name].messages[0].width > 0);
});

test("events are begins and ends with their UUIDs", async () => {
  const { topics } = await decoded(exported("milk_carton_wrap"));
  const run = JSON.parse(prehend("run", "milk_carton_wrap", "--json")).events;
  const edges = topics["/events"].messages.map((message) => ({ ns: message.ns, ...JSON.parse(message.data) }));
  assert.equal(edges.length, 2 * run.length);
  assert.equal(new Set(edges.map((edge) => edge.uuid)).size, run.length);
  for (const edge of edges) {
    const at_s = edge.edge === "begin" ? edge.begin_s : edge.end_s;
    assert.ok(Math.abs(Number(edge.ns) * 1e-9 - at_s) < 1e-6);
    assert.ok(run.some((event) => event.event === edge.event && Math.abs(event.begin_s - edge.begin_s) < 1e-4 && Math.abs(event.end_s - edge.end_s) < 1e-4), edge.event);
  }
});

test("every checksum is right, also from front to back", async () => {
  const path = exported("milk_carton_wrap"), reader = new McapStreamReader({ validateCrcs: true });
  reader.append(readFileSync(path));
  let messages = 0n, footer;
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Message") ++messages;
    if (record.type === "Footer") footer = record;
  }
  assert.ok(reader.done());
  assert.notEqual(footer.summaryCrc, 0);
  const { count } = await decoded(path);
  assert.equal(messages, count);
  const metadata = readFileSync(join(path, "..", "metadata.yaml"), "utf8");
  assert.match(metadata, /^rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n/);
  assert.match(metadata, new RegExp(`message_count: ${count}\n`));
  assert.match(metadata, /relative_file_paths:\n    - "take\.mcap"\n/);
});

test("a bag is the same each time", () => {
  const [a, b] = [exported("milk_carton_wrap"), exported("milk_carton_wrap")].map((path) => readFileSync(path));
  assert.ok(a.equals(b));
});
