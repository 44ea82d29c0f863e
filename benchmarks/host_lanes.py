# SPDX-License-Identifier: MIT
"""The host with and without lanes (`lanes = 'yes'` of &scene), in one run.

    build/venv/bin/python3 benchmarks/host_lanes.py [--results benchmarks/results]     # 10 minutes

Runs with and without take turns. Processor seconds of whole runs, medians of the rounds, and the median of their
ratios; wall time by the fastest round, for it is that of an idle machine only.
"""
import argparse
import os
import pathlib
import re
import statistics
import subprocess
import tempfile
import time

root = pathlib.Path(__file__).resolve().parents[1]
SCENES = {   # scene, and keys that are set in it
    "static footing on MUD": ("verification/host/footing/scene.nml",),
    "site under an earthquake": ("verification/host/site/scene.nml",),
    "host.nml, 300 steps": ("benchmarks/host.nml", "stage[pulse].duration=0.009"),
    "the same, consistent tangent": ("benchmarks/host.nml", "stage[pulse].duration=0.009", "mud.tangent=3"),
    "host.nml, all 1333 steps": ("benchmarks/host.nml",),
}
HEAD = """# The host with and without lanes

Processor seconds of whole runs without and with `lanes = 'yes'`, and the ratio of both; the share of the time without
that the material takes; the same ratio of wall times. Made by `host_lanes.py`, which says how.

| scene | threads | without, with: ratio | share of the material | ratio by the wall |
|---|---|---|---|---|
"""


def run(host, scene, keys, work):
    """Processor and wall seconds of a run, and the share of the material in what it says of its own time."""
    command = [host, root / scene, "--output", work, "--verbose", *(word for key in keys for word in ("--set", key))]
    before, start = os.times(), time.perf_counter()
    done = subprocess.run(command, text=True, check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    wall, after = time.perf_counter() - start, os.times()
    material, whole = (float(re.search(rf"^ *{phase} +([\d.]+) s", done.stdout, re.M)[1])
                       for phase in ("material", "in all"))
    return sum(after[2:4]) - sum(before[2:4]), wall, material / whole


def rows(host, rounds, work):
    for name, (scene, *keys) in SCENES.items():
        for threads in (1, 2):
            found = {"no": [], "yes": []}
            for _ in range(rounds):
                for lanes, column in found.items():
                    column.append(run(host, scene, [*keys, f"scene.threads={threads}", f"scene.lanes={lanes}"], work))
            without, side = found["no"], found["yes"]
            times = [statistics.median(row[0] for row in column) for column in (without, side)]
            ratio = statistics.median(a[0] / b[0] for a, b in zip(without, side))
            share = statistics.median(row[2] for row in without)
            wall = min(row[1] for row in without) / min(row[1] for row in side)
            yield f"| {name} | {threads} | {times[0]:.2f}, {times[1]:.2f}: {ratio:.2f} | {share:.2f} | {wall:.2f} |"


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--host", type=pathlib.Path, default=root / "build/release/host/mud_host")
    words.add_argument("--rounds", type=int, default=5, metavar="N", help="rounds (5)")
    words.add_argument("--results", type=pathlib.Path, metavar="FOLDER", help="where host_lanes.md is written")
    given = words.parse_args()
    load = os.getloadavg()[0]
    model = re.findall(r"^model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.M)
    lines = []
    with tempfile.TemporaryDirectory() as work:
        for line in rows(given.host.resolve(), given.rounds, pathlib.Path(work)):
            print(line, flush=True)
            lines.append(line)
    text = HEAD + "\n".join(lines) + f"\n\n{model[0]}, {len(model)} processors; load before the run {load:.1f}.\n"
    if given.results:
        (given.results / "host_lanes.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
