# SPDX-License-Identifier: MIT
"""A test and its errors: four runs of its scene, which differ in mesh, steps and tolerances."""

from __future__ import annotations

import csv
import json
import math
import pathlib
import time
from dataclasses import dataclass

from ..study.accuracy import HALF_DECADE
from ..study.runs import Scene
from .answers import Answers, answers_of
from .ground import Test, scene_of, write_record

FINENESS, TOLERANCE = 1.0, 0.03
# Processor time of the four runs, over that of the last.
SHARES = (0.15, 0.25, 0.25, 1.0)
UNITS = {"modulus": ("MN/m2", 1e-3), "influence": ("m", 1.0)}
MILLIMETRES = ("mm", 1e3)


@dataclass
class Error:
    """Of an answer, in its unit."""

    mesh: float
    steps: float
    solve: float  # Newton's method and the integration of the stress

    @property
    def total(self) -> float:
        return self.mesh + self.steps + self.solve


@dataclass
class Measured:
    """A test that was computed."""

    test: Test
    answers: Answers
    errors: dict[str, Error]
    warnings: list[str]
    folder: pathlib.Path  # of the finest run
    seconds: float  # processor time of all runs

    def told(self, name: str) -> str:
        """An answer with its error, in the unit of the tables."""
        unit, factor = unit_of(name)
        value, error = self.answers.numbers()[name] * factor, self.errors[name].total * factor
        return f"{value:.4g} +- {error:.2g} {unit}"


def unit_of(name: str) -> tuple[str, float]:
    """Unit of an answer in tables, and the factor that leads to it."""
    return UNITS.get(name.split(".")[-1], MILLIMETRES)


def measure(test: Test, folder: pathlib.Path, host="", quiet=False, fineness=FINENESS, tolerance=TOLERANCE) -> Measured:
    """Runs what is missing, the cheapest first; finished runs in the folder are found again.

    mesh: half of what fineness and half of it differ by; steps: what the tolerance and root(10) times it differ by, on
    the coarser mesh; solve: what a tenth of the tolerances of Newton's method and of the stresses changes there.
    """
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "scene.nml"
    if test.device.record:
        write_record(test.device, folder / "force.txt")
    _write(path, scene_of(test))
    scene = Scene(path, folder / "runs", host, quiet=quiet)
    half, loose = fineness / 2, tolerance * HALF_DECADE
    keys = ((half, loose, 0, 0), (half, tolerance, 0, 0), (half, loose, 1, int(test.wet)), (fineness, tolerance, 0, 0))
    runs = []
    began, done = time.monotonic(), 0.0
    for i, key in enumerate(keys):
        made = scene.made
        runs.append(scene.run(*key, keep=i == len(keys) - 1))
        if scene.made > made:
            done += SHARES[i]
            left = (time.monotonic() - began) / done * sum(SHARES[i + 1 :])
            if i < len(keys) - 1:
                scene.say(f"   {i + 1} of {len(keys)} runs; about {left:.0f} s left")
    rough, coarse, tight, fine = (answers_of(test, scene.folder / run.key.folder) for run in runs)
    told = [a.numbers() for a in (rough, coarse, tight, fine)]
    errors = {
        name: Error(
            abs(told[3][name] - told[1][name]) / 2,
            abs(told[1][name] - told[0][name]),
            abs(told[2][name] - told[0][name]),
        )
        for name in told[3]
    }
    last = scene.folder / runs[-1].key.folder
    return Measured(test, fine, errors, _warnings(test, fine, runs[-1]), last, scene.spent)


def _write(path, text):
    """Only what is new: the time of a file that stays is that of its runs."""
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def _warnings(test, answers, run):
    found = list(run.warnings)
    if run.localised and run.localised not in " ".join(found):
        found.append(f"{run.localised}: displacements there depend on the cells")
    if answers.tension > 0.05 * test.device.stress:
        found.append(
            f"the plate pulls at the ground with {answers.tension:.2g} kPa on its way back, and its weight is "
            f"{test.device.mass * 9.81 / (math.pi * test.device.radius**2):.2g} kPa: a plate that lies loose would "
            "leave the ground there. The peak is before that; rebound and settlement are those of a plate that stays."
        )
    return found


def write_tables(measured: Measured, folder: pathlib.Path) -> None:
    """results.csv, drops.csv, histories.csv, and results.json for the chart."""
    answers, errors = measured.answers, measured.errors
    with open(folder / "results.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(("answer", "value", "unit", "error", "mesh", "steps", "solve"))
        for name, value in answers.numbers().items():
            unit, factor = unit_of(name)
            e = errors[name]
            table.writerow(
                (
                    name,
                    f"{value * factor:.6g}",
                    unit,
                    *(f"{x * factor:.2g}" for x in (e.total, e.mesh, e.steps, e.solve)),
                )
            )
    with open(folder / "drops.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(
            ("drop", "kind", "deflection_mm", "error_mm", "modulus_MPa", "error_MPa", "peak_at_ms", "velocity_mm_s")
            + ("s_over_v_ms", "rebound_mm", "settlement_mm")
        )
        for i, drop in enumerate(answers.drops):
            table.writerow(
                (
                    i + 1,
                    "measured" if drop.measured else "seating",
                    f"{1e3 * drop.deflection:.5g}",
                    f"{1e3 * errors[f'{drop.name}.deflection'].total:.2g}",
                    f"{drop.modulus / 1e3:.5g}",
                    f"{errors[f'{drop.name}.modulus'].total / 1e3:.2g}",
                    f"{1e3 * drop.at:.4g}",
                    f"{1e3 * drop.velocity:.4g}",
                    f"{1e3 * drop.deflection / drop.velocity:.4g}",
                    f"{1e3 * drop.rebound:.4g}",
                    f"{1e3 * drop.settlement:.4g}",
                )
            )
    first = measured.test.starts[0]
    history = answers.history
    seen = history["time"] >= first - 1e-9
    with open(folder / "histories.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        pressures = [name for name in history if name.startswith("p_")]
        table.writerow(("time_ms", "force_kN", "deflection_mm", *(f"{name}_kPa" for name in pressures)))
        start = history["deflection"][seen][0]
        for i in seen.nonzero()[0]:
            table.writerow(
                (
                    f"{1e3 * (history['time'][i] - first):.6g}",
                    f"{history['force'][i]:.6g}",
                    f"{1e3 * (history['deflection'][i] - start):.6g}",
                    *(f"{history[name][i]:.6g}" for name in pressures),
                )
            )
    told = {
        "modulus": answers.modulus,
        "error": errors["modulus"].total,
        "deflection": answers.deflection,
        "saturation": answers.saturation,
        "void_ratio": answers.void_ratio,
        "suction": answers.suction,
        "warnings": measured.warnings,
    }
    part = folder / "results.json.part"
    part.write_text(json.dumps(told, indent=1), encoding="utf-8")
    part.replace(folder / "results.json")
