# SPDX-License-Identifier: MIT
"""The calibration from task to result."""

from __future__ import annotations

import dataclasses
import os
import time
from collections.abc import Callable, Sequence

from ..errors import InputError
from ..material import Material
from .diagnosis import Diagnosis, diagnose
from .fit import Effort, Fit, say
from .misfit import Misfit, misfit_of
from .simulation import SETTINGS, Answer, simulate
from .task import Item, Task


@dataclasses.dataclass
class Calibration:
    """What a calibration found."""

    task: Task
    material: Material  #: with the library's own numerical settings
    values: dict[str, float]  #: variables that were fitted
    answers: dict[str, Answer]  #: model at the rows of every test, by its name
    misfits: list[Misfit]  #: of every test, held-out ones too
    diagnosis: Diagnosis
    history: list[tuple[str, float]]  #: misfit after each step
    simulations: int
    seconds: float
    cpu_seconds: float  #: of this process and its workers
    workers: int
    beside: list[Misfit] | None = None  #: the same of another material, if wanted
    beside_name: str = ""

    def item(self, name: str) -> Item:
        """A test with what counts of it."""
        return next(item for item in self.task.items if item.test.name == name)


def calibrate(
    task: Task,
    effort: Effort | None = None,
    workers: int = 0,
    write: Callable[[str], None] | None = say,
    beside: str | None = None,
) -> Calibration:
    """Fits a material to the tests of a task that are not held out.

    effort : how much the search may do; the default is a whole calibration. workers : processes, 0: one a core; the answer does
    not depend on it. write : takes lines of progress with the time left, None: silent. beside : material whose misfit is reported
    too. Reproducible: the same task, seed and library give the same parameters.
    """
    try:
        import scipy  # noqa: F401
    except ImportError as problem:
        raise ImportError("mud_calibrate needs SciPy: pip install 'mud-soil[calibrate]'") from problem
    begin, used = time.monotonic(), _cpu()
    fit = Fit(task, effort or Effort(), workers, write)
    if not fit.variables:
        raise InputError("there is nothing to fit: every parameter that these tests depend on is known")
    try:
        values = fit.run()
        answers = answers_of(fit.evaluator.material(values, **SETTINGS), task.items)
        found = diagnose(fit, values, answers)
    finally:
        fit.evaluator.close()
    other = Material(beside, **SETTINGS) if beside else None
    return Calibration(
        task,
        fit.evaluator.material(values),
        values,
        answers,
        misfits_of(task.items, answers),
        found,
        fit.history,
        fit.evaluator.simulations,
        time.monotonic() - begin,
        _cpu() - used,
        workers or os.cpu_count() or 1,
        misfits_of(task.items, answers_of(other, task.items)) if other else None,
        beside or "",
    )


def answers_of(material: Material, items: Sequence[Item]) -> dict[str, Answer]:
    """The model's answers to tests."""
    return {item.test.name: simulate(material, item.test, item.use) for item in items}


def misfits_of(items: Sequence[Item], answers: dict[str, Answer]) -> list[Misfit]:
    """Misfit of every test."""
    return [misfit_of(item, answers[item.test.name]) for item in items]


def _cpu() -> float:
    """Processor time of this process and of the workers that have ended [s]."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system
