#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Told and true errors of `mud_study accuracy`, scene by scene: the truth is a run with finer meshes, steps and
tolerances than any of the study. Usage: study.py [SCENE.nml ...] [--accuracy A] [--budget S] [--work FOLDER]"""
import argparse
import csv
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.insert(0, str(ROOT / "python"))
from mud.study.accuracy import Study  # noqa: E402
from mud.study.histories import distance  # noqa: E402
from mud.study.runs import BudgetUsedUp, Failed, Scene  # noqa: E402

STUDIES = ROOT / "verification/studies"
SCENES = [STUDIES / "cost/scenes" / f"{x}.nml" for x in "drop footing harmonic mandel push rain sand".split()]
SCENES += [STUDIES / "price" / f"{x}.nml" for x in ("strip", "slope", "shaken", "ring", "rain_layers")]
HEAD = ("scene", "asked", "state", "fineness", "step_tolerance", "answer", "told", "true", "told_over_true",
        "least_ratio", "most_ratio", "seconds", "study_over_run")


def truth(scene, pair, budget):
    """The finest run that the budget allows: four times the cells, or twice, with a tenth of the tolerance."""
    for cells, tolerance in ((4, 0.1), (2, 0.1)):
        fine = Scene(scene.path, scene.folder / "truth", scene.host, budget, quiet=True)
        try:
            return fine.run(pair.fineness * cells, max(pair.tolerance * tolerance, 1e-7), 1, int("mud" in scene.groups))
        except (Failed, BudgetUsedUp):
            continue
    return None


def row(path, asked, budget, folder):
    scene = Scene(path, folder / path.stem, budget=budget, quiet=True)
    result = Study(scene, asked).search()
    if not result.pairs:
        return (path.stem, asked, result.state, *[""] * 10)
    pair = result.last
    seconds, times = pair.run.seconds, scene.spent / max(pair.run.processor, 1e-3)
    reference = truth(scene, pair, budget)
    worst = max(pair.errors, key=lambda n: pair.errors[n].total)
    told = pair.errors[worst].total
    head = (path.stem, asked, result.state, pair.fineness, f"{pair.tolerance:.2g}")
    if reference is None:
        return (*head, worst, f"{told:.3g}", *[""] * 4, f"{seconds:.3g}", f"{times:.2g}")
    true = {n: distance(pair.run.histories, reference.histories, n) for n in pair.errors}
    ratios = {n: pair.errors[n].total / max(true[n], 1e-12) for n in true}
    large = [r for n, r in ratios.items() if max(true[n], pair.errors[n].total) > 1e-4] or [1.0]
    # The answer that is worst in truth counts, too.
    return (*head, worst, f"{told:.3g}", f"{max(true.values()):.3g}", f"{told / max(max(true.values()), 1e-12):.2g}",
            f"{min(large):.2g}", f"{max(large):.2g}", f"{seconds:.3g}", f"{times:.2g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--accuracy", type=float, default=1e-2)
    parser.add_argument("--budget", type=float, default=600.0)
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("study"))
    parser.add_argument("--output", type=pathlib.Path, default=HERE / "results.csv")
    args = parser.parse_args()
    with open(args.output, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(HEAD)
        for path in args.scenes or SCENES:
            told = row(path.resolve(), args.accuracy, args.budget, args.work)
            table.writerow(told)
            file.flush()
            print(*told, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
