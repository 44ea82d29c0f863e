#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What mud_host --price estimates, against meshes four times as fine as the scene's: errors of meshes and times. Writes
results.csv and times.csv.

    study.py [--build build/release] [--results FOLDER]

Two minutes of one core.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(ROOT / "common")]
import tables  # noqa: E402

SCENES = ("contact/bar", "contact/drain", "dynamic_consolidation/scene", "layered_site/scene", "liakopoulos/scene",
          "seepage_face/rain", "terzaghi/scene", "waves/column", "waves/layers")
FINE = (2, 4)                     # Fineness of the runs to compare with; errors against the last one.
ANSWERS = ("scene", "answer", "fineness", "state", "estimated", "true", "ratio")
TIMES = ("scene", "fineness", "quoted", "seconds", "ratio")
environment = {**os.environ, "OMP_NUM_THREADS": "1"}


def run(host, scene, folder, *words):
    """Wall time of a run [s]."""
    start = time.perf_counter()
    subprocess.run([host, ROOT / f"verification/host/{scene}.nml", "--quiet", "--output", folder, *words], check=True,
                   env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.perf_counter() - start


def compare(host, scene, folder):
    """Rows of the answers and of the times of a scene."""
    run(host, scene, folder / "price", "--price")
    answers = tables.rows(folder / "price/price_answers.csv")
    quoted = {float(r["mesh"]): float(r["seconds"]) for r in tables.rows(folder / "price/price.csv")
              if float(r["steps"]) == 1}
    finest = float(answers[0]["mesh"])
    run(host, scene, folder / "own", "--fineness", f"{finest:g}")
    times = []
    for fineness in FINE:
        seconds = run(host, scene, folder / f"fine{fineness}", "--fineness", str(fineness))
        times.append((scene, fineness, f"{quoted[fineness]:.3g}", f"{seconds:.3g}", f"{quoted[fineness]/seconds:.3g}"))
    own, fine = (tables.columns(folder / name / "histories.csv") for name in ("own", f"fine{FINE[-1]}"))
    rows = []
    for answer in answers:
        name = answer["answer"]
        if name not in own:
            continue
        # Neither the start nor the first step, where a load may act at once.
        apart = np.abs(own[name] - np.interp(own["time"], fine["time"], fine[name]))[2:]
        true, estimate = np.max(apart)/float(answer["range"]), float(answer["mesh_error"])
        rows.append((scene, name, f"{finest:g}", answer["state"], f"{estimate:.3g}", f"{true:.3g}", f"{estimate/true:.3g}"))
    return rows, times


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--results", default=HERE, type=pathlib.Path)
    parser.add_argument("--commit", default="", help="of the program, not used")
    args = parser.parse_args()
    answers, times = [], []
    for scene in SCENES:
        with tempfile.TemporaryDirectory() as folder:
            some, others = compare(args.build / "host/mud_host", scene, pathlib.Path(folder))
        answers += some
        times += others
        print(scene, "done", flush=True)
    tables.write(args.results / "results.csv", ANSWERS, answers)
    tables.write(args.results / "times.csv", TIMES, times)


if __name__ == "__main__":
    main()
