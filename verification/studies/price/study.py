#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What mud_host --price estimates, against meshes four times as fine as the scene's: errors of meshes and times. Writes
results.csv and times.csv.

    study.py [--build build/release] [--results FOLDER]

Five minutes of one core. A scene whose rows are there is left.
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
sys.path[:0] = [str(HERE), str(ROOT / "common"), str(ROOT / "verification"), str(HERE.parent / "indentation")]
import table_1  # noqa: E402
import tables  # noqa: E402
from tools.results import MISSED, folder as made_in  # noqa: E402

SCENES = {name: f"verification/host/{name}.nml" for name in (
    "contact/bar", "contact/drain", "dynamic_consolidation/scene", "layered_site/scene", "liakopoulos/scene",
    "seepage_face/rain", "terzaghi/scene", "waves/column", "waves/layers")}
# Nothing was chosen on these. Soil is MUD in the last three.
NEW = {"slope": "verification/studies/price/slope.nml", "rain on layers": "verification/studies/price/rain_layers.nml",
       "curved sides": "verification/studies/price/ring.nml", "dropped plate": "verification/host/contact/fall.nml",
       "Mandel": "verification/studies/cost/scenes/mandel.nml", "shaken sand": "verification/studies/price/shaken.nml",
       "footing on sand": "verification/studies/cost/scenes/sand.nml",
       "indentation": "build/verification/studies/price/indentation.nml"}
# Scenes whose own steps are for references.
WORDS = {name: ("--accuracy", "1e-2") for name in ("dropped plate", "Mandel", "footing on sand")}
FINE = (2, 4)                     # Fineness of the runs to compare with; errors against the last one.
ANSWERS = ("scene", "answer", "fineness", "state", "estimated", "true", "ratio")
TIMES = ("scene", "fineness", "quoted", "seconds", "ratio", "code")
LIMIT = 600        # s of a run
environment = {**os.environ, "OMP_NUM_THREADS": "1"}


class Failed(Exception):
    """A run that did not end."""


def run(host, scene, folder, *words):
    """Wall time of a run [s] and its exit code."""
    start = time.perf_counter()
    done = subprocess.run([host, ROOT / {**SCENES, **NEW}[scene], "--quiet", "--output", folder, *WORDS.get(scene, ()),
                           *words], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                          timeout=LIMIT)
    if done.returncode not in (0, MISSED):
        raise Failed(f"{' '.join(map(str, words)) or 'the run'}: exit code {done.returncode}")
    return time.perf_counter() - start, done.returncode


def indentation():
    """The benchmark at 30 kPa up to its largest settlement."""
    path = ROOT / NEW["indentation"]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(table_1.text(table_1.FRONT, "1e-2"), encoding="utf-8")


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
        seconds, code = run(host, scene, folder / f"fine{fineness}", "--fineness", str(fineness))
        times.append((scene, fineness, f"{quoted[fineness]:.3g}", f"{seconds:.3g}", f"{quoted[fineness]/seconds:.3g}",
                      code))
    own, fine = (tables.columns(folder / name / "histories.csv") for name in ("own", f"fine{FINE[-1]}"))
    rows = []
    for answer in answers:
        name = answer["answer"]
        if name not in own:
            continue
        # Neither the start nor the first step, where a load may act at once.
        apart = np.abs(own[name] - np.interp(own["time"], fine["time"], fine[name]))[2:]
        true, estimate = np.max(apart)/float(answer["range"]), float(answer["mesh_error"])
        rows.append((scene, name, f"{finest:g}", answer["state"], f"{estimate:.3g}", f"{true:.3g}",
                     f"{estimate/true:.3g}"))
    return rows, times


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--results", default=made_in(__file__), type=pathlib.Path)
    args = parser.parse_args()
    indentation()
    host = pathlib.Path(os.environ.get("MUD_HOST") or args.build / "host/mud_host")
    kept = [tables.rows(args.results / name) if (args.results / name).exists() else [] for name in ("results.csv",
                                                                                                   "times.csv")]
    answers, times = ([tuple(r.values()) for r in rows] for rows in kept)
    for scene in [*SCENES, *NEW]:
        if scene in {row[0] for row in answers}:
            continue
        try:
            with tempfile.TemporaryDirectory() as folder:
                some, others = compare(host, scene, pathlib.Path(folder))
        except (Failed, subprocess.TimeoutExpired) as failure:
            some, others = [(scene, str(failure).replace(",", ";")[-60:], *[""]*5)], []
        answers += some
        times += others
        tables.write(args.results / "results.csv", ANSWERS, answers)
        tables.write(args.results / "times.csv", TIMES, times)
        print(scene, "done", flush=True)


if __name__ == "__main__":
    main()
