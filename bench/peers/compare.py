#!/usr/bin/python3
"""Distance transforms side by side: Sidestep, ITK (SignedMaurer), SciPy (distance_transform_edt).

The same grids, interleaved in one run, one thread each; medians of CPU time, and how many times as
long as Sidestep's full transform each took *in the same round* (the median of those ratios). What
Sidestep and SciPy answer is compared cell by cell.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
import scipy
from scipy import ndimage


class Worker:
    """A process that transforms grids on request (worker.h)."""

    def __init__(self, path):
        self.process = subprocess.Popen([path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline().strip()
        if not answer:
            sys.exit(f"{self.process.args[0]} failed at '{line}'")
        return answer


class SciPy:
    """Two unsigned transforms make a signed one."""

    def load(self, cells):
        self.filled = cells != 0

    def run(self):
        begin = time.process_time()
        self.distance = ndimage.distance_transform_edt(~self.filled)
        self.distance -= ndimage.distance_transform_edt(self.filled)
        return 1e3 * (time.process_time() - begin)


def furnished_room(n):
    """The scene of furnished_room.h, as an array [z][y][x]."""
    cells = np.zeros((n, n, n), np.uint8)

    def add(lower, upper):
        x, y, z = (slice(*(int(np.floor(m * n / 3.84)) for m in pair)) for pair in zip(lower, upper))
        cells[z, y, x] = 1

    add((2.4, 1.0, 0.72), (3.2, 2.8, 0.80))
    for x in (2.4, 3.12):
        for y in (1.0, 2.72):
            add((x, y, 0), (x + 0.08, y + 0.08, 0.72))
    add((0.32, 1.32, 0), (0.40, 2.52, 2.0))
    for y in (1.32, 2.44):
        add((0.32, y, 0), (0.92, y + 0.08, 2.0))
    for z in (0.0, 0.64, 1.28, 1.92):
        add((0.32, 1.32, z), (0.92, 2.52, z + 0.08))
    add((1.76, 0.40, 0), (2.06, 0.70, 1.80))
    return cells


def compare(n, rounds, workers, folder):
    cells = furnished_room(n)
    path = os.path.join(folder, f"room{n}")
    cells.tofile(path)
    for worker in workers.values():
        worker.ask(f"grid {path} {n}")
    peer = SciPy()
    peer.load(cells)

    runs = {
        "sidestep full": lambda: float(workers["sidestep"].ask("run full")),
        "sidestep bounded10": lambda: float(workers["sidestep"].ask("run bounded10")),
        "itk": lambda: float(workers["itk"].ask("run full")),
        "scipy": peer.run,
    }
    for run in runs.values():  # warm
        run()
    times = {name: [] for name in runs}
    for round_index in range(rounds):
        for name, run in runs.items():
            # Short ones are taken several times, so that one interruption does not decide.
            repeats = 9 if name.startswith("sidestep") else 1
            times[name].append(statistics.median(run() for _ in range(repeats)))

    workers["sidestep"].ask("run full")
    workers["sidestep"].ask(f"save {path}")
    ours = np.fromfile(path, np.float32).reshape(cells.shape)
    ratios = {
        name: statistics.median(t / s for t, s in zip(times[name], times["sidestep full"]))
        for name in runs
    }
    return {
        "cells": n,
        "rounds": rounds,
        "median_ms": {name: statistics.median(values) for name, values in times.items()},
        "ratio_to_sidestep_full": ratios,
        "max_difference_to_scipy_cells": float(np.abs(ours - peer.distance).max()),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--workers", required=True, help="folder of the worker programs")
    parser.add_argument("--cells", type=int, nargs="+", default=[96, 256], help="cells along an edge")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--json", metavar="FILE", help="write the figures here as well")
    options = parser.parse_args()

    workers = {name: Worker(os.path.join(options.workers, name + "_worker")) for name in ("sidestep", "itk")}
    results = []
    print(f"{'cells':>6}  {'transform':<20}{'median ms':>12}{'ratio':>10}")
    with tempfile.TemporaryDirectory() as folder:
        for n in options.cells:
            result = compare(n, options.rounds, workers, folder)
            results.append(result)
            for name, median_ms in result["median_ms"].items():
                print(f"{n:>6}  {name:<20}{median_ms:>12.3f}{result['ratio_to_sidestep_full'][name]:>10.2f}", flush=True)
            print(f"{n:>6}  largest difference between Sidestep and SciPy: "
                  f"{result['max_difference_to_scipy_cells']:.2g} cells")
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({"scipy": scipy.__version__, "results": results}, file, indent=2)
            file.write("\n")


if __name__ == "__main__":
    main()
