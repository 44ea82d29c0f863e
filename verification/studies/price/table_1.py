#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The benchmark of the paper on its own mesh and on one that is graded to the rim of the plate and to the surface:
settlement at all suctions with what mesh, steps and Newton's method leave of it; at 30 kPa error against time, and what
Newton's tolerance changes. Each run ends shortly after its largest settlement. Writes table_1.csv; a run whose row is
there is left.

    table_1.py [--build build/release] [--results FOLDER]

A quarter of an hour of one core.
"""
import argparse
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(ROOT / "common"), str(ROOT / "verification"), str(HERE.parent / "indentation")]
import tables  # noqa: E402
from analysis import SUCTIONS, change, render, scene  # noqa: E402
from tools.results import MISSED, folder as made_in  # noqa: E402

# The mesh of the paper, and one with cells of 3 mm on both sides of the rim and of 4 mm at the surface (paper: 25, 64,
# 30 mm), fewer than twice as many as it. Fineness 1/2, 1, 2 of each.
MESHES = {"paper": {}, "graded": {"r_cells": "8, 14", "r_ratio": "0.7, 1.5", "z_cells": "7, 10",
                                  "z_ratio": "0.76, 0.7"}}
# The accuracy by its setting; "newton": with a hundredth of Newton's tolerance; "paper": given steps, its tolerances.
ACCURACY = {"4e-2": "4e-2", "1e-2": "1e-2", "2.5e-3": "2.5e-3", "newton": "1e-2", "2.5e-3 newton": "2.5e-3"}
NEWTON = "1e-6"
LENGTH = {0: 0.030, 3: 0.024}     # of the impact [s]: beyond the largest settlement
SHORT = 0.018
FRONT = 30                        # kPa: the suction whose front is drawn
NAMES = ("suction", "mesh", "fineness", "setting", "outcome", "elements", "steps", "seconds", "peak", "peak_time",
         "p_w")
LIMIT = 2400                      # s of a run


def text(suction, setting, mesh="paper"):
    """The scene of a run."""
    def adapt(groups):
        change(groups, "mesh", **MESHES[mesh])
        change(groups, "scene", checkpoint_steps=None, threads=1)
        change(groups, "stage:impact", duration=LENGTH.get(suction, SHORT))
        if setting == "paper":
            return
        # What the paper's settings give by hand is left open.
        newton = NEWTON if "newton" in setting else None
        change(groups, "scene", accuracy=ACCURACY[setting])
        change(groups, "stage:impact", dt=None, rho_inf=None, tolerance=newton)
        for name in ("geostatic", "seat"):
            change(groups, "stage:" + name, tolerance=None)
    return render(scene(suction, "u-p_w-p_c", "remedy", adapt))


def wanted():
    """All runs: (suction, mesh, fineness, setting). Finer meshes at 0 and 3 kPa: table_1_fine.py."""
    runs = [(s, "graded", f, "1e-2") for f in (0.5, 1) for s in SUCTIONS]
    runs += [(s, "graded", 0.5, setting) for setting in ("newton", "2.5e-3") for s in SUCTIONS]
    runs += [(s, "paper", 1, "1e-2") for s in SUCTIONS]
    runs += [(FRONT, "paper", f, a) for f in (0.25, 0.5, 1) for a in ("1e-2", "newton", "2.5e-3", "2.5e-3 newton")]
    runs += [(FRONT, "paper", 2, a) for a in ("1e-2", "newton", "2.5e-3")]
    runs += [(FRONT, "paper", f, "4e-2") for f in (0.25, 0.5, 1, 2)]
    runs += [(FRONT, "graded", f, a) for f in (0.5, 1) for a in ("4e-2", "2.5e-3")]
    runs += [(s, "graded", 2, "1e-2") for s in SUCTIONS[:1:-1]]
    runs += [(s, "paper", 1, "paper") for s in SUCTIONS]
    return list(dict.fromkeys(runs))


def run(host, key, folder, limit=LIMIT):
    """Row of a run, of at most limit seconds."""
    suction, mesh, fineness, setting = key
    (folder / "scene.nml").write_text(text(suction, setting, mesh), encoding="utf-8")
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    try:
        done = subprocess.run([host, folder / "scene.nml", "--fineness", f"{fineness:g}", "--output", folder],
                              text=True, capture_output=True, timeout=limit, env={**os.environ, "OMP_NUM_THREADS": "1"})
        outcome, said = str(done.returncode), done.stdout
    except subprocess.TimeoutExpired:
        return (*key, f"more than {limit} s", *[""]*6)
    spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    if done.returncode not in (0, MISSED):
        return (*key, outcome, *[""]*2, f"{spent:.2f}", *[""]*3)
    h = tables.columns(folder / "histories.csv")
    impact = h["time"] >= 2 - 1e-9
    t, u, p = (h[name][impact] for name in ("time", "centre.u_z", "centre.p_w"))
    steps = len(tables.rows(folder / "ledger.csv"))
    return (*key, outcome, said.split(" elements")[0].split()[-1], steps, f"{spent:.2f}",
            f"{-1e3*u.min():.6g}", f"{1e3*(t[u.argmin()] - 2):.5g}", f"{p.max() - p[0]:.5g}")


def make(name, keys, about, limit=LIMIT):
    """Runs what the table `name` of the results has not yet; about: what --help says first."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--results", default=made_in(__file__), type=pathlib.Path)
    args = parser.parse_args()
    table = args.results / name
    have = [tuple(r[n] for n in NAMES) for r in tables.rows(table)] if table.exists() else []
    done = {(int(r[0]), r[1], float(r[2]), r[3]) for r in have}
    host = pathlib.Path(os.environ.get("MUD_HOST") or args.build / "host/mud_host")
    for key in keys:
        if key in done:
            continue
        with tempfile.TemporaryDirectory() as folder:
            row = run(host, key, pathlib.Path(folder), limit)
        have.append(row)
        tables.write(table, NAMES, have)
        print(*row, flush=True)


if __name__ == "__main__":
    make("table_1.csv", wanted(), __doc__.split("\n")[0])
