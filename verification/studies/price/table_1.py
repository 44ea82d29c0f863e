#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The benchmark of the paper on its own mesh and on finer ones: settlement at all suctions with what mesh, steps and
Newton's method leave of it, and at 30 kPa error against time. Each run ends shortly after its largest settlement.
Writes table_1.csv; a run whose row is there is left.

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
from tools.results import folder as made_in  # noqa: E402

# The accuracy by its setting; "newton": with a hundredth of Newton's tolerance; "paper": given steps, its tolerances.
ACCURACY = {"4e-2": "4e-2", "1e-2": "1e-2", "2.5e-3": "2.5e-3", "newton": "1e-2"}
NEWTON = "1e-6"
LENGTH = {0: 0.030, 3: 0.024}     # of the impact [s]: beyond the largest settlement
SHORT = 0.018
FRONT = 30                        # kPa: the suction whose front is drawn
NAMES = ("suction", "fineness", "setting", "outcome", "elements", "steps", "seconds", "peak", "peak_time", "p_w")
LIMIT = 1200                      # s of a run


def text(suction, setting):
    """The scene of a run."""
    def adapt(groups):
        change(groups, "scene", checkpoint_steps=None, threads=1)
        change(groups, "stage:impact", duration=LENGTH.get(suction, SHORT))
        if setting == "paper":
            return
        # What the paper's settings give by hand is left open.
        newton = NEWTON if setting == "newton" else None
        change(groups, "scene", accuracy=ACCURACY[setting])
        change(groups, "stage:impact", dt=None, rho_inf=None, tolerance=newton)
        for name in ("geostatic", "seat"):
            change(groups, "stage:" + name, tolerance=None)
    return render(scene(suction, "u-p_w-p_c", "remedy", adapt))


def wanted():
    """All runs: (suction, fineness, setting)."""
    runs = [(s, f, "1e-2") for s in SUCTIONS for f in (0.5, 1, 2, 4)]
    runs += [(s, 0.5, setting) for s in SUCTIONS for setting in ("2.5e-3", "newton")]
    runs += [(FRONT, f, a) for f in (0.25, 0.5, 1, 2) for a in ("4e-2", "1e-2", "2.5e-3")]
    runs += [(s, 1, "paper") for s in SUCTIONS] + [(FRONT, 4, "2.5e-3")]
    return sorted(dict.fromkeys(runs), key=lambda r: r[1])


def run(host, suction, fineness, setting, folder):
    """Row of a run."""
    (folder / "scene.nml").write_text(text(suction, setting), encoding="utf-8")
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    try:
        done = subprocess.run([host, folder / "scene.nml", "--fineness", f"{fineness:g}", "--output", folder],
                              text=True, capture_output=True, timeout=LIMIT, env={**os.environ, "OMP_NUM_THREADS": "1"})
        outcome, said = str(done.returncode), done.stdout
    except subprocess.TimeoutExpired:
        return (suction, fineness, setting, f"more than {LIMIT} s", *[""]*6)
    spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    if done.returncode not in (0, 20):
        return (suction, fineness, setting, outcome, *[""]*2, f"{spent:.2f}", *[""]*3)
    h = tables.columns(folder / "histories.csv")
    impact = h["time"] >= 2 - 1e-9
    t, u, p = (h[name][impact] for name in ("time", "centre.u_z", "centre.p_w"))
    steps = len(tables.rows(folder / "ledger.csv"))
    return (suction, fineness, setting, outcome, said.split(" elements")[0].split()[-1], steps, f"{spent:.2f}",
            f"{-1e3*u.min():.6g}", f"{1e3*(t[u.argmin()] - 2):.5g}", f"{p.max() - p[0]:.5g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--results", default=made_in(__file__), type=pathlib.Path)
    args = parser.parse_args()
    table = args.results / "table_1.csv"
    have = [tuple(r[n] for n in NAMES) for r in tables.rows(table)] if table.exists() else []
    done = {(int(r[0]), float(r[1]), r[2]) for r in have}
    host = pathlib.Path(os.environ.get("MUD_HOST") or args.build / "host/mud_host")
    for suction, fineness, setting in wanted():
        if (suction, float(fineness), setting) in done:
            continue
        with tempfile.TemporaryDirectory() as folder:
            row = run(host, suction, fineness, setting, pathlib.Path(folder))
        have.append(row)
        tables.write(table, NAMES, have)
        print(*row, flush=True)


if __name__ == "__main__":
    main()
