#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the scenes that need few effects once more, each with more cells and more steps, as `effects = 'auto'` chooses and with
everything; writes times.csv. Four minutes of one core.

    times.py [--build build/release] [--results FOLDER] [--commit COMMIT]
"""
import argparse
import csv
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(HERE), str(ROOT / "verification")]
import scenes  # noqa: E402
from tools import tables  # noqa: E402
from tools.results import MISSED, folder as made_in  # noqa: E402

COLUMNS = ("scene", "elements", "steps", "off", "unknowns", "unknowns with everything", "seconds", "of these pilots",
           "seconds with everything", "changes", "share allowed", "commit")
STEPS = 640   # of the scenes with given steps: pilots take 32 times as long ones
DEFAULT = "effects = 'auto'"
# Cells along r and z, and what else changes. With controlled steps pilots save fewer of them; a load within a second of 200 would need
# steps that are not given.
LARGER = {
    "slow ramp": (8, 80, ((DEFAULT, f"{DEFAULT} effects_pilot_share = 0.4"),)),
    "slow ramp, wet": (8, 80, (("accuracy = 1e-2", ""), ("duration = 1000", f"duration = 1000 dt = {1000 / STEPS}"))),
    "slow ramp, saturated": (8, 80, (("accuracy = 1e-2", ""), ("duration = 1000", f"duration = 1000 dt = {1000 / STEPS}"))),
    "thin sheet": (8, 80, (("accuracy = 1e-2", ""), ("duration = 10", f"duration = 10 dt = {10 / STEPS}"))),
    "far soil": ("16, 16, 12", 16, (("dt = 0.02", f"dt = {2 / STEPS}"),)),
    "consolidation": (8, 80, (("times = 0, 1 ", "times = 0, 50 "), ("accuracy = 1e-2", ""),
                              ("duration = 200", f"duration = 200 dt = {200 / STEPS}"))),
}


def larger(scene):
    r, z, edits = LARGER[scene.name]
    text = scene.text.replace(scenes.AUTO, DEFAULT)
    text = re.sub(r"r_cells = [\d, ]*\d", f"r_cells = {r}", re.sub(r"z_cells = \d+", f"z_cells = {z}", text))
    for old, new in (("geometry =", "threads = 1 geometry ="), *edits):
        if old not in text:
            raise ValueError(f"{scene.name} has no '{old}'")
        text = text.replace(old, new, 1)
    return text


def everything_of(text):
    """Every effect with any influence stays."""
    return re.sub(DEFAULT + r"( effects_pilot_share = \S+)?",
                  DEFAULT + " effects_tolerance = 1e-6 effects_pilot_share = 1e6", text)


def run(host, text, folder):
    """Seconds of one core, what it prints, histories and table of effects."""
    path = folder / "scene.nml"
    path.write_text(text, encoding="utf-8")
    began = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([str(host), str(path), "--output", str(folder)], capture_output=True, text=True,
                          env={**os.environ, "OMP_NUM_THREADS": "1"})
    if done.returncode not in (0, MISSED):
        raise RuntimeError(done.stderr.strip())
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - began
    return seconds, done.stdout, tables.columns(folder / "histories.csv"), tables.rows(folder / "effects.csv")


def apart(one, other):
    """Largest distance of displacement histories at the named points, as a share of the largest range."""
    columns = [name for name in one if name.endswith((".u_r", ".u_z"))]
    scale = max(np.ptp(one[name]) for name in columns)
    return max(float(np.max(np.abs(np.interp(one["time"], other["time"], other[name]) - one[name]))) for name in columns) / scale


def compare(host, scene, commit):
    text = larger(scene)
    with tempfile.TemporaryDirectory() as folder:
        seconds, said, auto, table = run(host, text, pathlib.Path(folder))
    with tempfile.TemporaryDirectory() as folder:
        everything, told, full, _ = run(host, everything_of(text), pathlib.Path(folder))
    sizes = [re.search(r": (\d+) elements, \d+ nodes, (\d+) unknowns", words) for words in (said, told)]
    clock, pilots = (re.search(words, said) for words in (r"in all +(\S+) s", r"of these (\S+) s for pilots"))
    share = float(pilots[1]) / float(clock[1]) if pilots else 0.0
    for_pilots = re.search(r"of these (\S+) s for pilots", told)
    everything *= 1 - float(for_pilots[1]) / float(re.search(r"in all +(\S+) s", told)[1])
    allowed = re.search(r"effects_pilot_share = (\S+)", text)
    off = ", ".join(row["effect"] for row in table if row["influence"] and row["on"] == "off")
    return (scene.name, sizes[0][1], re.search(r"^(\d+) steps", said, re.M)[1], off, sizes[0][2], sizes[1][2], f"{seconds:.2f}",
            f"{share * seconds:.2f}", f"{everything:.2f}", f"{apart(full, auto):.2g}", allowed[1] if allowed else "0.1",
            commit)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--results", default=made_in(__file__), type=pathlib.Path)
    parser.add_argument("--commit", default="", help="of the program")
    args = parser.parse_args()
    rows = []
    for scene in scenes.EASY:
        rows.append(compare(args.build / "host/mud_host", scene, args.commit))
        print(*rows[-1], sep=" | ", flush=True)
    with open(args.results / "times.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows)


if __name__ == "__main__":
    main()
