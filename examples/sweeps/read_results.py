#!/usr/bin/env python3
"""Reads what `sidestep sweep` wrote: read_results.py out/sweep/smoke/results.db

Needs Debian's python3-pandas, and python3-h5py for traces. The columns are in docs/database.md.
"""
import pathlib
import sqlite3
import sys

import pandas

path = pathlib.Path(sys.argv[1])
runs = pandas.read_sql("SELECT * FROM results", sqlite3.connect(path))
runs["goal"] = runs.outcome == "goal"
print(runs.groupby(["scenario", "knowledge"])[["goal", "min_clearance_m", "time_to_goal_s"]].mean())
print(runs[~runs.goal][["id", "seed", "outcome", "touched", "command"]].head().to_string())

for trace in runs.trace.dropna().head(1):  # where the sweep's file says `traces: all`
    import h5py

    with h5py.File(path.parent / trace) as recording:
        q = recording["control/q"]
        print(f"{trace}: {q.shape[0]} ticks of {q.shape[1]} joints")
