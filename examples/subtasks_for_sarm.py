# SPDX-License-Identifier: Apache-2.0
"""Sub-tasks of `prehend episode label .. --to csv -o tasks.csv` as the columns that LeRobot's SARM reads in meta/episodes.

    subtasks_for_sarm.py tasks.csv OUT [sparse.csv]

writes OUT.csv, and OUT.parquet where Python has duckdb or pyarrow: a row per episode, lists of names, times and frames. A second
table gives the sparse columns other sub-tasks than the dense ones. The order of episodes is that of the table; join the columns to
those of your data set's meta/episodes by it. Not loaded by LeRobot here.
"""
import csv
import json
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


main()
