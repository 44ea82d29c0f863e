#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Told and true errors of `mud_study accuracy` over the scenes of scenes.py. The truth is a closed form, or a run with
finer mesh, steps and tolerances than any of the study. Finished rows are kept: the same command goes on.
Usage: study.py [NAME ...] [--budget S] [--truth S] [--work FOLDER]"""
import argparse
import os
import pathlib
import sys

import f90nml
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "verification"), str(ROOT / "common")]
import scenes  # noqa: E402
import tables  # noqa: E402
from mud.study.accuracy import Cost, Study, scene_runs  # noqa: E402
from mud.study.effects import write_scene  # noqa: E402
from mud.study.histories import distance  # noqa: E402
from mud.study.runs import BudgetUsedUp, Failed, Key, Scene, list_of  # noqa: E402
from tools import results  # noqa: E402

HEAD = ("scene", "asked", "state", "fineness", "step_tolerance", "answer", "told", "mesh", "steps", "newton", "stress",
        "true", "truth", "seconds", "study_over_run")
FINER = ((4, 0.1), (4, 0.316), (2, 0.1), (2, 0.316))     # cells and tolerances of the truth, the best that can be paid


def written(scene, folder):
    """The file of a scene."""
    path = folder / "scene.nml"
    folder.mkdir(parents=True, exist_ok=True)
    if scene.text:
        path.write_text(scene.text, encoding="utf-8")
        return path
    groups = f90nml.read(ROOT / scene.file)
    if scene.duration:
        list_of(groups, "stage")[-1]["duration"] = scene.duration
    write_scene(groups, path, (ROOT / scene.file).parent)
    return path


def truth(scene, study, pair, seconds):
    """The true error of every answer, and what it is known from; nothing where no finer run ends within its seconds."""
    found = pair.run.histories
    if scene.exact:
        true = {}
        for name, exact in scene.exact.items():
            t, y = found.history(name)
            true[name] = np.max(np.abs(y - exact(t)))/np.max(np.abs(exact(t)))
        return true, "closed form"
    cost = Cost(scene_runs(study.scene))
    for cells, times in FINER:
        fineness, tolerance = pair.fineness*cells, max(pair.tolerance*times, 1e-7)
        fine = Scene(study.scene.path, study.scene.folder / "truth", study.scene.host, seconds, quiet=True)
        key = Key.of(fineness, tolerance, 1 + study.tight, (1 + study.tight)*("mud" in fine.groups))
        if cost(fineness, tolerance) > seconds and not (fine.folder / key.folder / "run.json").exists():
            continue
        try:
            run = fine.run(key.fineness, key.tolerance, key.newton, key.stress)
            return {n: distance(found, run.histories, n) for n in pair.errors}, f"F {fineness:g}, a {tolerance:.2g}"
        except (Failed, BudgetUsedUp):
            seconds -= fine.used
    return None, ""


def row(scene, budget, seconds, folder, host=""):
    """A row of the table."""
    folder = folder / scene.name.replace(" ", "_").replace(",", "")
    runs = Scene(written(scene, folder), folder, host, budget, quiet=True)
    study = Study(runs, scene.asked, list(scene.goals) or None)
    study.search()
    if not study.pairs:
        return (scene.name, scene.asked, study.state, *[""]*12)
    pair = study.pairs[-1]
    spent = runs.spent
    true, known = truth(scene, study, pair, seconds)
    e = pair.errors[pair.worst]
    return (scene.name, scene.asked, study.state, f"{pair.fineness:g}", f"{pair.tolerance:.2g}", pair.worst,
            *(f"{x:.3g}" for x in (e.total, e.mesh, e.steps, e.newton, e.stress)),
            f"{max(true.values()):.3g}" if true else "", known, f"{pair.run.seconds:.3g}",
            f"{spent/max(pair.run.seconds, 1e-3):.2g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--budget", type=float, default=60.0, help="processor time of a study [s]")
    parser.add_argument("--truth", type=float, default=40.0, help="of a truth [s]")
    parser.add_argument("--work", type=pathlib.Path)
    args = parser.parse_args()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    made = results.folder(__file__)
    path = made / "results.csv"
    kept = {r["scene"]: tuple(r.values()) for r in tables.rows(path)} if path.exists() else {}
    for scene in scenes.SCENES:
        if scene.name in kept if not args.names else scene.name not in args.names:
            continue
        kept[scene.name] = row(scene, args.budget, args.truth, args.work or made)
        tables.write(path, HEAD, [kept[s.name] for s in scenes.SCENES if s.name in kept])
        print(*kept[scene.name], sep=", ", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
