# SPDX-License-Identifier: Apache-2.0
"""Sub-tasks of `prehend episode label .. --to csv -o tasks.csv` as the columns that LeRobot's SARM reads in meta/episodes, and as
the `language_persistent` of its frames.

    subtasks_for_sarm.py tasks.csv OUT [sparse.csv]

writes OUT.csv, and OUT.parquet where Python has duckdb or pyarrow: a row per episode, lists of names, times and frames. A second
table gives the sparse columns other sub-tasks than the dense ones. The order of episodes is that of the table; join the columns to
those of your data set's meta/episodes by it. OUT.language.json has a line for each frame: `episode_index`, `frame_index`,
`timestamp` and `language_persistent`, the sub-tasks of its episode, each at the timestamp of its first frame (float32). DuckDB makes
Parquet of it:

    copy (from read_json('OUT.language.json', columns = {episode_index: 'BIGINT', frame_index: 'BIGINT', timestamp: 'FLOAT',
        language_persistent: 'STRUCT(role VARCHAR, content VARCHAR, style VARCHAR, "timestamp" FLOAT, camera VARCHAR,
        tool_calls VARCHAR[])[]'})) to 'OUT.language.parquet' (format parquet)

Not loaded by LeRobot here.
"""
import csv
import json
import struct
import sys

COLUMNS = ("names", "start_times", "end_times", "start_frames", "end_frames")


def columns_of(file):
    episodes = {}
    for row in csv.DictReader(open(file, encoding="utf-8", newline="")):
        values = (row["text"] or row["subtask"], float(row["begin_s"]), float(row["end_s"]), int(row["begin_frame"]),
                  int(row["end_frame"]))
        for column, value in zip(COLUMNS, values):
            episodes.setdefault(row["episode"], {name: [] for name in COLUMNS})[column].append(value)
    return episodes


def write_language(tasks, out):
    with open(out, "w", encoding="utf-8") as file:
        for index, columns in enumerate(tasks.values()):
            begins = columns["start_frames"]
            rate_hz = round(begins[-1] / columns["start_times"][-1], 3) if begins[-1] else 1
            at = [struct.unpack("f", struct.pack("f", i / rate_hz))[0] for i in range(columns["end_frames"][-1])]
            said = [{"role": "assistant", "content": name, "style": "subtask", "timestamp": at[begin], "camera": None, "tool_calls": None}
                    for name, begin in zip(columns["names"], begins)]
            for i, time in enumerate(at):
                print(json.dumps({"episode_index": index, "frame_index": i, "timestamp": time, "language_persistent": said}), file=file)


def main():
    dense, out = columns_of(sys.argv[1]), sys.argv[2]
    kinds = {"sparse": columns_of(sys.argv[3]) if len(sys.argv) > 3 else dense, "dense": dense}
    rows = [{"episode_index": i, "episode": name,
             **{f"{kind}_subtask_{column}": table[name][column] for kind, table in kinds.items() for column in COLUMNS}}
            for i, name in enumerate(dense)]
    with open(out + ".csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows({key: json.dumps(value) if isinstance(value, list) else value for key, value in row.items()}
                         for row in rows)
    write_language(dense, out + ".language.json")
    try:
        import pyarrow
        import pyarrow.parquet
        pyarrow.parquet.write_table(pyarrow.Table.from_pylist(rows), out + ".parquet")
    except ImportError:
        try:
            import duckdb
        except ImportError:
            print("no Parquet: Python has neither pyarrow nor duckdb")
            return
        with open(out + ".json", "w", encoding="utf-8") as file:
            json.dump(rows, file)
        duckdb.sql(f"copy (from read_json('{out}.json')) to '{out}.parquet' (format parquet)")


if not 3 <= len(sys.argv) <= 4:
    sys.exit("usage: subtasks_for_sarm.py tasks.csv OUT [sparse.csv]")
try:
    main()
except KeyError as error:
    sys.exit(f"subtasks_for_sarm.py: the table has no column {error}; wanted what 'prehend episode label --to csv -o tasks.csv' writes")
except OSError as error:
    sys.exit(f"subtasks_for_sarm.py: {error.filename}: {error.strerror.lower()}")
