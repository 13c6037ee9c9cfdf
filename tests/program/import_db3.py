# SPDX-License-Identifier: Apache-2.0
"""Bags of ROS 2 in SQLite, made by plain Python as rosbag2 of Humble and of Iron lays them out, and grips and joints in
messages: the same cup and hand as in import_arrays.py; damaged files are refused.

    import_db3.py PREHEND
"""
import json
import random
import sqlite3
import struct

from import_arrays import CUP, CUPS, FRAMES, HAND, HANDS, TABLE, TIMES, XYZW, check_damage, expect_carried, expect_refused, folder, import_file, recording, run

T0 = 1_700_000_000_000_000_000


class Cdr:
    """Little endian, aligned from behind its four bytes of head."""

    def __init__(self):
        self.data = b""

    def put(self, form, *values):
        size = struct.calcsize(form)
        for value in values:
            self.data += b"\0" * (-len(self.data) % size) + struct.pack("<" + form, value)
        return self

    def text(self, text):
        self.put("I", len(text) + 1)
        self.data += text.encode() + b"\0"
        return self

    def header(self, ns, frame="world"):
        return self.put("i", ns // 10**9).put("I", ns % 10**9).text(frame)

    def pose(self, p, q):
        return self.put("d", *map(float, p)).put("d", *map(float, q))

    def bytes(self):
        return b"\0\1\0\0" + self.data


UNTURNED = [0, 0, 0, 1]
TYPES = {
    "geometry_msgs/msg/PoseStamped": lambda ns, p, q: Cdr().header(ns).pose(p, q).bytes(),
    "geometry_msgs/msg/PoseWithCovarianceStamped": lambda ns, p, q: Cdr().header(ns).pose(p, q).put("d", *[0.0] * 36).bytes(),
    "geometry_msgs/msg/TransformStamped": lambda ns, p, q: Cdr().header(ns).text("cup_link").pose(p, q).bytes(),
    "nav_msgs/msg/Odometry": lambda ns, p, q: Cdr().header(ns).text("base").pose(p, q).put("d", *[0.0] * 78).bytes(),
}
OWN = ("std_msgs/Header header\nstring note\nmy_msgs/Body[] bodies\n" + "=" * 80 +
       "\nMSG: my_msgs/Body\nstring name\ngeometry_msgs/Pose pose\nfloat32 width\n" + "=" * 80 +
       "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + "=" * 80 +
       "\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n" + "=" * 80 +
       "\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" + "=" * 80 +
       "\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n")


def own(ns, bodies):
    cdr = Cdr().header(ns).text("n").put("I", len(bodies))
    for name, p, q in bodies:
        cdr.text(name).pose(p, q).put("f", 0.1)
    return cdr.bytes()


def joints(ns, **positions):
    cdr = Cdr().header(ns).put("I", len(positions))
    for name in positions:
        cdr.text(name)
    return cdr.put("I", len(positions)).put("d", *positions.values()).put("I", 0, 0).bytes()


def bag(topics, messages, definitions=None):
    """topics: {name: type}; messages: (topic, ns, bytes)."""
    path = folder / "made.db3"
    path.unlink(missing_ok=True)
    db = sqlite3.connect(path)
    db.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL, "
               "offered_qos_profiles TEXT NOT NULL)")
    db.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    db.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    ids = {name: i + 1 for i, name in enumerate(topics)}
    db.executemany("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", [(ids[n], n, t) for n, t in topics.items()])
    if definitions is not None:
        db.execute("CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL, "
                   "encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL)")
        db.executemany("INSERT INTO message_definitions(topic_type, encoding, encoded_message_definition, type_description_hash) "
                       "VALUES(?, 'ros2msg', ?, '')", definitions.items())
    db.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", [(ids[n], ns, d) for n, ns, d in messages])
    db.commit()
    db.close()
    return path.read_bytes()


def ns_at(i):
    return T0 + round(TIMES[i] * 1e9)


def map_of(cup, hand, more=""):
    return f"unit: m\naxes: z_up\nentities:\n{TABLE}  cup: {{from: \"{cup}\", {CUP}}}\n  hand: {{from: \"{hand}\", {HAND}{more}}}\n"


def main():
    seeds = []
    for name, make in TYPES.items():
        topic = "/tf_of_cup" if "Transform" in name else "/cup"
        messages = [m for i in range(FRAMES) for m in (
            (topic, ns_at(i) + 7, make(ns_at(i), CUPS[i], XYZW)),
            ("/hand", ns_at(i) + 9, TYPES["geometry_msgs/msg/PoseStamped"](ns_at(i), HANDS[i], UNTURNED)),
            ("/camera", ns_at(i), b"\0\1\0\0" + bytes(50)))]
        content = bag({topic: name, "/hand": "geometry_msgs/msg/PoseStamped", "/camera": "sensor_msgs/msg/Image"}, messages)
        text = map_of("cup_link" if "Transform" in name else "/cup", "/hand")
        expect_carried("take.db3", content, text)
        seeds.append(("take.db3", content, text))
    # tf, and a type of one's own whose definition is in the file.
    def transforms(i):
        cdr = Cdr().put("I", 2)
        return cdr.header(ns_at(i)).text("cup").pose(CUPS[i], XYZW).header(ns_at(i)).text("hand").pose(HANDS[i], UNTURNED).bytes()
    expect_carried("take.db3", bag({"/tf": "tf2_msgs/msg/TFMessage"}, [("/tf", ns_at(i), transforms(i)) for i in range(FRAMES)]),
                   map_of("cup", "hand"))
    bodies = [("/bodies", ns_at(i), own(ns_at(i), [("Cup", CUPS[i], XYZW), ("Hand", HANDS[i], UNTURNED)])) for i in range(FRAMES)]
    own_map = map_of("/bodies[Cup]", "/bodies[Hand]")
    expect_carried("take.db3", bag({"/bodies": "my_msgs/msg/Bodies"}, bodies, {"my_msgs/msg/Bodies": OWN}), own_map)
    expect_refused("take.db3", bag({"/bodies": "my_msgs/msg/Bodies"}, bodies), own_map, "whose definition is not in the file")

    # Grips and joints: a joint state of two fingers, a number.
    fingers = [0.04 if 1 < t < 3.5 else 0.08 for t in TIMES]
    messages = bodies + [("/joint_states", ns_at(i), joints(ns_at(i), arm=1.0, left=fingers[i] / 2, right=-fingers[i] / 2)) for i in range(FRAMES)]
    messages += [("/width", ns_at(i), Cdr().put("d", fingers[i]).bytes()) for i in range(FRAMES)]
    topics = {"/bodies": "my_msgs/msg/Bodies", "/joint_states": "sensor_msgs/msg/JointState", "/width": "std_msgs/msg/Float64"}
    content = bag(topics, messages, {"my_msgs/msg/Bodies": OWN})
    for grip in ('{from: ["/joint_states[left]", "/joint_states[right]"], sum_abs: true, open: 0.08, closed: 0}',
                 '{from: "/joint_states:position[left]", open: 0.04, closed: 0}', '{from: "/joint_states[1]", open: 0.04, closed: 0}',
                 '{from: /width, open: 0.08, closed: 0}', '{from: "/width:data", open: 0.08, closed: 0}'):
        expect_carried("take.db3", content, map_of("/bodies[Cup]", "/bodies[Hand]", ", grip: " + grip))
        triggers = [f["hands"]["hand"]["trigger"] for f in recording() if "hands" in f]
        assert abs(triggers[0]) < 1e-9 and abs(max(triggers) - 0.5) < 1e-9, (grip, triggers[0], max(triggers))
    seeds.append(("take.db3", content, map_of("/bodies[Cup]", "/bodies[Hand]", ", grip: {from: /width, open: 0.08, closed: 0}")))
    for grip, *why in (("/widht", "no topic has '/widht'", "did you mean '/width'?"), ("/joint_states[lefft]", "no message has it"),
                       ("/joint_states", "it has 3 numbers there"), ("/joint_states:pos[left]", "has no number 'pos'", "position"),
                       ("/bodies", "has no number")):
        expect_refused("take.db3", content, map_of("/bodies[Cup]", "/bodies[Hand]", f', grip: {{from: "{grip}", open: 1, closed: 0}}'), *why)
    # The same in MCAP, as an export writes it.
    expect_carried("take.db3", content, map_of("/bodies[Cup]", "/bodies[Hand]", ", grip: {from: /width, open: 0.08, closed: 0}"))
    said = run("episode", "export", folder / "take.jsonl", "--to", "mcap", "-o", folder / "out.mcap")
    assert said.returncode == 0, said.stderr
    beside = (folder / "out.mcap.map.yaml").read_text().replace("import: 1\n", "").replace("episode: ", "# ")
    assert 'grip: {from: "/joint_states[hand_grip]", open: 0, closed: 1}' in beside, beside
    said = import_file("again.mcap", (folder / "out.mcap").read_bytes(), beside)
    assert said.returncode == 0, said.stderr
    again = [f["hands"]["hand"]["trigger"] for f in recording() if "hands" in f]
    assert abs(max(again) - 0.5) < 1e-9 and abs(min(again)) < 1e-9, (min(again), max(again))

    # A bag whose writer still has half of it in a file beside: read, and nothing is left there.
    bag(topics, messages[:len(messages) // 2], {"my_msgs/msg/Bodies": OWN})
    live = sqlite3.connect(folder / "made.db3")
    live.execute("PRAGMA journal_mode=WAL")
    ids = dict(live.execute("SELECT name, id FROM topics"))
    live.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                     [(ids[n], ns, d) for n, ns, d in messages[len(messages) // 2:]])
    live.commit()
    (folder / "take.db3-wal").write_bytes((folder / "made.db3-wal").read_bytes())
    expect_carried("take.db3", (folder / "made.db3").read_bytes(), map_of("/bodies[Cup]", "/bodies[Hand]", ", grip: {from: /width, open: 0.08, closed: 0}"))
    assert not (folder / "take.db3-shm").exists()
    live.close()
    (folder / "take.db3-wal").unlink()

    for content, *why in ((b"x" * 3000, "no SQLite database"), (b"", "no tables"), (content[:5000], "damaged")):
        expect_refused("take.db3", content, own_map, *why)
    db = sqlite3.connect(folder / "other.db3")
    db.execute("CREATE TABLE topics(id INTEGER)")
    db.execute("CREATE VIEW messages AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT 1 AS topic_id, x AS timestamp, x AS data FROM n")
    db.commit()
    db.close()
    expect_refused("take.db3", (folder / "other.db3").read_bytes(), own_map, "no tables 'topics' and 'messages'")
    random.seed(11)
    print(f"{check_damage(seeds, 80)} of 80 damaged bags refused, the others read")


if __name__ == "__main__":
    main()
