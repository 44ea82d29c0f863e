# SPDX-License-Identifier: MIT
"""A test and its errors: four runs of its scene, which differ in mesh, steps and tolerances."""

from __future__ import annotations

import csv
import json
import math
import pathlib
import time
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..study.accuracy import HALF_DECADE
from ..study.histories import between
from ..study.runs import LOOSEST, Scene
from .answers import INFLUENCE, Answers, answers_of
from .ground import Test, scene_of, write_record

FINENESS, TOLERANCE = 1.0, 0.03
# Processor time of the four runs, over that of the last.
SHARES = (0.15, 0.25, 0.25, 1.0)
UNITS = {"modulus": ("MN/m2", 1e-3), "influence": ("m", 1.0), "force": ("kN", 1.0)}
RINGS = 0.1  # velocity at the end of a drop, over the largest, above which its settlement is not the last word [-]
MILLIMETRES = ("mm", 1e3)


@dataclass
class Error:
    """Of an answer, or of a history at its times, in its unit."""

    mesh: float | np.ndarray
    steps: float | np.ndarray
    solve: float | np.ndarray  # Newton's method and the integration of the stress

    @classmethod
    def of(cls, rough, coarse, tight, fine) -> Error:
        """Of an answer of four runs."""
        return cls(abs(fine - coarse) / 2, abs(coarse - rough), abs(tight - rough))

    @property
    def total(self) -> float | np.ndarray:
        return self.mesh + self.steps + self.solve


@dataclass
class Measured:
    """A test that was computed."""

    test: Test
    answers: Answers
    errors: dict[str, Error]
    runs: tuple[Answers, ...]  # the four, the finest last
    warnings: list[str]
    folder: pathlib.Path  # of the finest run
    seconds: float  # processor time of all runs

    def told(self, name: str) -> str:
        """An answer with its error, in the unit of the tables."""
        unit, factor = unit_of(name)
        value, error = self.answers.numbers()[name] * factor, self.errors[name].total * factor
        return f"{value:.4g} +- {error:.2g} {unit}"


    def band(self, name: str, since: float) -> Error:
        """Errors of what a history has changed since a time, at the times of the finest run."""
        at = self.answers.history["time"]
        if name == "force" and not self.test.device.buffer:  # it is the input
            return Error(*np.zeros((3, len(at))))
        changes = []
        for run in self.runs:
            time, values = run.history["time"], run.history[name]
            changes.append(between(time, values, at) - between(time, values, np.array([since]))[0])
        return Error.of(*changes)

    def changes(self) -> list[tuple[str, float, Error, str]]:
        """Of every history its name, largest change since the first drop, largest errors and unit."""
        history, told, start = self.answers.history, [], self.test.starts[0]
        seen = history["time"] >= start - 1e-9
        for name in self.histories:
            (unit, factor), band = unit_of(f"history.{name}"), self.band(name, start)
            change = np.abs(history[name][seen] - history[name][seen][0]).max()
            most = (float(factor * part[seen].max()) for part in (band.mesh, band.steps, band.solve))
            told.append((name, float(factor * change), Error(*most), unit))
        return told

    @property
    def histories(self) -> list[str]:
        return [name for name in self.answers.history if name != "time"]


def unit_of(name: str) -> tuple[str, float]:
    """Unit of an answer in tables, and the factor that leads to it."""
    last = name.split(".")[-1]
    return ("kPa", 1.0) if last.startswith("p_") else UNITS.get(last, MILLIMETRES)


def measure(test: Test, folder: pathlib.Path, host="", quiet=False, fineness=FINENESS, tolerance=TOLERANCE) -> Measured:
    """Runs what is missing, the cheapest first; finished runs in the folder are found again.

    mesh: half of what fineness and half of it differ by; steps: what the tolerance and root(10) times it differ by, on
    the coarser mesh; solve: what a tenth of the tolerances of Newton's method and of the stresses changes there.
    """
    for option, value, most in (("--fineness", fineness, 8.0), ("--step-tolerance", tolerance, LOOSEST / HALF_DECADE)):
        if not 1e-6 <= value <= most * (1 + 1e-9):
            raise InputError(f"{option} is {value:g}; it is above 0 and at most {most:.3g}")
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
    found = tuple(answers_of(test, scene.folder / run.key.folder) for run in runs)
    told = [answers.numbers() for answers in found]
    errors = {name: Error.of(*(x[name] for x in told)) for name in told[3]}
    last = scene.folder / runs[-1].key.folder
    return Measured(test, found[-1], errors, found, _warnings(test, found[-1], runs[-1]), last, scene.spent)


def _write(path, text):
    """Only what is new: the time of a file that stays is that of its runs."""
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def _warnings(test, answers, run):
    found = list(run.warnings)
    if run.localised and run.localised not in " ".join(found):
        found.append(f"{run.localised}: displacements there depend on the cells")
    if answers.tension > 0.05 * test.device.largest / test.device.area:
        found.append(
            f"the tied plate pulls at the ground with {answers.tension:.2g} kPa on its way back, and its weight is "
            f"{test.device.mass * 9.81 / test.device.area:.2g} kPa: one that lies loose leaves the ground there. "
            "Rebound and settlement are those of a plate that stays; leave out --tied for one that does not."
        )
    if answers.share > INFLUENCE:
        found.append(
            f"{test.depths[-1]:.3g} m below, the last point above the base, the ground still moves by "
            f"{100 * answers.share:.2g} % of the plate's deflection: the base is within the depth of influence; give a "
            f"larger --depth than {test.depth:g} m"
        )
    last = answers.drops[-1]
    if last.ringing > RINGS:
        found.append(
            f"at the end of the last drop the plate still moves by {100 * last.ringing:.2g} % of its largest velocity: "
            f"settlements are not the last word; give a longer --interval than {1e3 * test.interval:g} ms"
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
        for name, change, e, unit in measured.changes():
            table.writerow(
                (f"history.{name}", f"{change:.6g}", unit, *(f"{x:.2g}" for x in (e.total, e.mesh, e.steps, e.solve)))
            )
    with open(folder / "drops.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(
            ("drop", "kind", "deflection_mm", "deflection_error_mm", "modulus_MPa", "modulus_error_MPa", "peak_at_ms")
            + ("velocity_mm_s", "s_over_v_ms", "rebound_mm", "rebound_error_mm", "settlement_mm", "settlement_error_mm")
            + ("lift_mm", "force_kN", "force_error_kN")
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
                    f"{1e3 * errors[f'{drop.name}.rebound'].total:.2g}",
                    f"{1e3 * drop.settlement:.4g}",
                    f"{1e3 * errors[f'{drop.name}.settlement'].total:.2g}",
                    f"{1e3 * drop.lift:.4g}",
                    f"{drop.force:.5g}",
                    f"{errors[f'{drop.name}.force'].total:.2g}",
                )
            )
    first = measured.test.starts[0]
    history = answers.history
    seen = history["time"] >= first - 1e-9
    with open(folder / "histories.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        columns = []
        for name in measured.histories:
            (unit, factor), band = unit_of(f"history.{name}"), measured.band(name, first)
            columns += [(f"{name}_{unit}", factor * history[name]), (f"{name}_error_{unit}", factor * band.total)]
        table.writerow(("time_ms", *(name for name, _ in columns)))
        for i in seen.nonzero()[0]:
            table.writerow(
                (
                    f"{1e3 * (history['time'][i] - first):.6g}",
                    *(f"{values[i]:.{2 if 'error' in name else 6}g}" for name, values in columns),
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
