# SPDX-License-Identifier: MIT
"""Updates of points side by side (MUD_LANES of mud.h) beside those of the same points one by one, in one run.

    build/venv/bin/python3 benchmarks/lanes.py [--results benchmarks/results]     # a minute

4,096 points on their way along one of the four paths of mud_benchmark, with strains that differ by up to half a per
cent. Rounds run every variant once, so that a disturbance affects all of them equally. One thread: medians of the rounds,
and of their ratios, in processor time of the thread. Two: the fastest rounds by the wall clock, for they are faster only
while the machine is idle.
"""
import argparse
import os
import pathlib
import statistics
import sys
import time

import numpy as np

root = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(root / "python"))
import mud  # noqa: E402 (its folder is known only now)

POINTS, STEPS, SIZES = 4096, 500, (1e-5, 1e-4)
AXIAL, GENERAL = [-100.0, -100.0, -100.0, 0.0, 0.0, 0.0], [-130.0, -90.0, -80.0, -12.0, 9.0, -6.0]
STRAIGHT = ([-1.0, 0.5, 0.5, 0.0, 0.0, 0.0],) * 2
TURN = ([-1.0, 0.4, 0.5, -0.6, 0.4, -0.3], [0.2, -0.5, 0.2, 1.0, -0.8, -0.6])
PATHS = {   # stress, suction, void ratio, first and last direction of strain, suction a unit of strain
    "saturated": (AXIAL, 0.0, 0.735, STRAIGHT, 0.0), "unsaturated": ([-20.0] * 3 + [0.0] * 3, 100.0, 0.8, STRAIGHT, 0.0),
    "saturated, turning": (GENERAL, 0.0, 0.735, TURN, 0.0), "unsaturated, turning": (GENERAL, 100.0, 0.8, TURN, -500.0)}
HEAD = """# Eight points at a time

Microseconds an update of one of 4,096 points, one by one and with `MUD_LANES`, and the ratio of both. Made by `lanes.py`, which says how.

"""


def points(sand, path, size):
    """Stresses, states, strains and suctions of points along a path."""
    stress, suction, void_ratio, (first, last), wets = PATHS[path]
    stress, statev = sand.initial_state(stress, suction, void_ratio)
    random = np.random.default_rng(8)
    rows = []
    for step in range(STEPS):
        angle = 0.5 * np.pi * step / STEPS
        strain = size * (np.cos(angle) * np.array(first) + np.sin(angle) * np.array(last))
        if first == last:
            strain = size * np.array(first)
        suction += size * wets
        if step >= STEPS // 10:
            rows.append((stress, statev, strain, suction))
        answer = sand.update(stress, statev, strain, suction)
        stress, statev = answer.stress, answer.statev
    chosen = [rows[7 * i % len(rows)] for i in range(POINTS)]
    stress, statev, strain, suction = (np.ascontiguousarray([row[k] for row in chosen]) for k in range(4))
    return stress, statev, strain * (1 + 0.01 * (random.random((POINTS, 1)) - 0.5)), suction


def measured(rounds, counts):
    """{(path, size, tangent, threads): (one by one, side by side [us], ratio)}"""
    sand = mud.Material()
    cases = {}
    for path in PATHS:
        for size in SIZES:
            given = points(sand, path, size)
            for tangent in (None, "consistent"):
                for threads in counts:
                    cases[path, size, tangent, threads] = (given, sand.update_batch(*given, tangent), [])
    for _ in range(rounds):
        for (_, _, tangent, threads), (given, out, times) in cases.items():
            row = []
            for lanes in (False, True):
                clock = time.thread_time if threads == 1 else time.perf_counter
                start = clock()
                sand.update_batch(*given, tangent, lanes=lanes, threads=threads, out=out)
                row.append(1e6 * (clock() - start) / POINTS)
            times.append(row)
    found = {}
    for case, (_, _, times) in cases.items():
        if case[-1] == 1:
            found[case] = *(statistics.median(column) for column in zip(*times)), statistics.median(a / b for a, b in times)
        else:
            one, side = (min(column) for column in zip(*times))
            found[case] = one, side, one / side
    return found


def table(found, counts):
    columns = [(tangent, threads) for tangent in (None, "consistent") for threads in counts]
    lines = ["| path, increment | " + " | ".join(f"{tangent or 'no'} tangent, {threads} thread{'s' * (threads > 1)}"
                                                for tangent, threads in columns) + " |",
             "|---" * (1 + len(columns)) + "|"]
    for path in PATHS:
        for size in SIZES:
            cells = ["{:.2f}, {:.2f}: {:.2f}".format(*found[path, size, tangent, threads]) for tangent, threads in columns]
            lines.append(f"| {path}, {size:.0e} | ".replace("e-0", "e-") + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--rounds", type=int, default=15, metavar="N", help="rounds (15)")
    words.add_argument("--threads", type=int, nargs="+", default=[1, 2], help="numbers of threads (1 2); 1 on a busy machine")
    words.add_argument("--results", type=pathlib.Path, metavar="FOLDER", help="where lanes.md is written")
    given = words.parse_args()
    load = os.getloadavg()[0]
    model = [line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")]
    text = table(measured(given.rounds, given.threads), given.threads) + f"\n\n{model[0]}, {len(model)} processors; load before the run {load:.1f}.\n"
    print(text)
    if given.results:
        given.results.mkdir(parents=True, exist_ok=True)
        (given.results / "lanes.md").write_text(HEAD + text, encoding="utf-8")


if __name__ == "__main__":
    main()
