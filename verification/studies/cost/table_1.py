# SPDX-License-Identifier: MIT
"""The sixteen analyses of the paper's Table 1 with its settings and with an accuracy, and a fine reference of each.

    verification/run studies/cost --make --only table_1.py [--pass ANALYSIS... [--only SETTING]]

One analysis (`s0030_remedy`) after the other: the paper's settings, then the accuracies, so that times which are
compared are of the same minutes. Without names those at 0, 30 and 1000 kPa with the remedy, and fine steps and 1e-3 at
30 kPa: five minutes; all sixteen by name take twenty. Writes table_1.csv. Resumable: a run whose row is there is left.
The answers are of the first 30 ms: what follows the separation is chaotic.
"""
import os
import re
import resource
import subprocess
import sys
import time

import study
import tables
from tools import results
from analysis import SUCTIONS, change, label, render, scene

FOLDER = study.build.parent / "cost/table_1"
SERIES = ("remedy", "as_published")
ACCURACIES = ("1e-1", "3e-2", "1e-2")
SETTINGS = ("paper", *ACCURACIES)
FINEST = "1e-3"
REFERENCE = "reference"
NIGHTLY = tuple(f"{label(s, 'u-p_w-p_c')}_remedy" for s in (30, 0, 1000))
ANALYSES = [(f"{label(s, 'u-p_w-p_c')}_{series}", s, series) for s in SUCTIONS for series in SERIES]
NAMES = ("name", "setting", "outcome", "steps", "iterations", "rates", "factorisations", "user_s", "wall_s",
         *study.ANSWERS, "largest_mm")


def adapt(groups, setting):
    """What a setting changes of the paper's."""
    change(groups, "scene", checkpoint_steps=None, threads=1)
    if setting == REFERENCE:
        fine = study.REFERENCE
        change(groups, "mud", tolerance=fine.stress, scheme=fine.scheme)
        change(groups, "stage:impact", duration=study.DURATION, dt=fine.dt, rho_inf=fine.rho_inf, tolerance=fine.newton)
    elif setting != "paper":
        # What the paper's settings give by hand is left open.
        change(groups, "scene", accuracy=setting)
        change(groups, "stage:impact", dt=None, rho_inf=None, tolerance=None)
        for name in ("geostatic", "seat"):
            change(groups, "stage:" + name, tolerance=None)


def run(name, suction, series, setting):
    """The row of a run, to be completed."""
    folder = FOLDER / name / setting
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.nml").write_text(render(scene(suction, "u-p_w-p_c", series, lambda g: adapt(g, setting))),
                                      encoding="utf-8")
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime, time.monotonic()
    done = subprocess.run([study.host, folder / "scene.nml", "--output", folder], text=True, capture_output=True,
                          env={**os.environ, "OMP_NUM_THREADS": "1"})
    spent = (f"{resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before:.2f}", f"{time.monotonic() - begin:.2f}")
    (folder / "log.txt").write_text(done.stdout + done.stderr, encoding="utf-8")
    if done.returncode:
        said = " ".join(done.stderr.split())[:90].replace(",", ";")
        return (name, setting, f"exit {done.returncode}: {said}", *[""]*4, *spent, *[""]*5)
    counts = re.search(r"(\d+) steps, (\d+) iterations.*?, (\d+) rate evaluations.*?, (\d+) factorisations",
                       done.stdout).groups()
    return (name, setting, "0", *counts, *spent, *(f"{v:.7g}" for v in study.answers(folder)[:3]), "", "")


def completed(row):
    """The row with the largest displacement without that of the seat, as in the indentation's own table, and with the
    error of its history, where the histories are kept."""
    mine, fine = (FOLDER / row[0] / s / "histories.csv" for s in (row[1], REFERENCE))
    if row[2] != "0" or not mine.exists():
        return row
    if not row[-1]:
        h = tables.columns(mine)
        u = h["centre.u_z"][h["time"] >= 2 - 1e-9]
        row = (*row[:-1], f"{1e3*(u[0] - u.min()):.7g}")
    if not row[-2] and row[1] != REFERENCE and fine.exists():
        row = (*row[:-2], f"{study.errors(study.answers(mine.parent), study.answers(fine.parent))[3]:.2g}", row[-1])
    return row


def main(words):
    settings = SETTINGS
    if "--only" in words:
        at = words.index("--only")
        settings, words = (words[at + 1],), words[:at] + words[at + 2:]
    table = results.folder(__file__) / "table_1.csv"
    have = [tuple(r.get(n, "") for n in NAMES) for r in tables.rows(table)] if table.exists() else []
    left = [(*a, s) for a in ANALYSES if a[0] in (words or NIGHTLY) for s in settings]
    if not words and settings == SETTINGS:
        left += [(*a, s) for a in ANALYSES if a[0] == NIGHTLY[0] for s in (REFERENCE, FINEST)]
    left = [(*a, s) for *a, s in left if (a[0], s) not in [r[:2] for r in have]]
    for i, analysis in enumerate(left):
        have.append(run(*analysis))
        have = [completed(r) for r in have]
        tables.write(table, NAMES, have)
        print(*have[-1], f"{i + 1} of {len(left)}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
