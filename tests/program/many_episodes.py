# SPDX-License-Identifier: Apache-2.0
"""many_episodes.py BASE COUNT OUT [whole]: an episode file with COUNT episodes, copies of those of BASE under UUIDs of their own.

Episodes of a real size in seconds instead of hours: frames of recordings are copied (of all with `whole`), those of simulated
episodes are left out. Pages get their checksums (docs/episodes.md, "Tables").
"""
import shutil
import sqlite3
import sys
import uuid

import xxhash

PAGE = 2048


def sum_pages(path):
    """The checksum of each page, in its last 8 bytes."""
    with open(path, "r+b") as file:
        place = 0
        while page := file.read(PAGE):
            file.seek(place + PAGE - 8)
            file.write(xxhash.xxh3_64_intdigest(page[:-8], seed=place).to_bytes(8, "little"))
            place += PAGE
            file.seek(place)


def multiply(base, count, out, whole=False):
    shutil.copyfile(base, out)
    database = sqlite3.connect(out)
    database.execute("PRAGMA synchronous=OFF")
    rows = lambda sql, *of: database.execute(sql, of).fetchall()
    originals = []
    for episode in rows("SELECT * FROM episode WHERE status <> 'recording' ORDER BY id"):
        keeps = whole or episode[9] == "none"
        originals.append((episode, [(event, rows("SELECT * FROM event_role WHERE event = ?", event[0]),
                                     rows("SELECT * FROM event_value WHERE event = ?", event[0]))
                                    for event in rows("SELECT * FROM event WHERE episode = ? ORDER BY id", episode[0])],
                          rows("SELECT * FROM chunk WHERE episode = ?", episode[0]) if keeps else [],
                          rows("SELECT * FROM part WHERE episode = ? ORDER BY id", episode[0]) if keeps else []))
    insert = lambda table, its: database.executemany(f"INSERT INTO {table} VALUES({', '.join('?' * len(its[0]))})", its) if its else None
    number, event_number = originals[-1][0][0], rows("SELECT coalesce(max(id), 0) FROM event")[0][0]
    for i in range(count - len(originals)):
        episode, events, chunks, parts = originals[i % len(originals)]
        number += 1
        insert("episode", [(number, str(uuid.uuid5(uuid.NAMESPACE_OID, f"{episode[1]} {i}")), *episode[2:])])
        for event, roles, values in events:
            event_number += 1
            insert("event", [(event_number, number, *event[2:])])
            insert("event_role", [(event_number, *row[1:]) for row in roles])
            insert("event_value", [(event_number, *row[1:]) for row in values])
        insert("chunk", [(number, *row[1:]) for row in chunks])
        insert("part", [(None, number, *row[2:]) for row in parts])
    database.commit()
    database.close()
    sum_pages(out)


if __name__ == "__main__":
    multiply(sys.argv[1], int(sys.argv[2]), sys.argv[3], "whole" in sys.argv[4:])
