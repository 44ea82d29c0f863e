# SPDX-License-Identifier: MIT
"""The calibration from task to result."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence

from ..errors import InputError
from ..material import Material
from .diagnosis import Diagnosis, diagnose
from .ensemble import Ensemble, make_ensemble
from .fit import Effort, Fit, Minimum, say, trial_sets
from .misfit import Misfit, misfit_of
from .screen import screen
from .simulation import SETTINGS, Answer, simulate
from .soundness import unloading
from .store import Store
from .task import Item, Task, in_kpa

UNDERSTOOD = "understood in"  # so begins the note of a name that had to be understood


@dataclasses.dataclass
class Calibration:
    """What a calibration found."""

    task: Task
    material: Material  #: with the library's own numerical settings
    values: dict[str, float]  #: variables that were fitted
    answers: dict[str, Answer]  #: model at the rows of every test, by its name
    misfits: list[Misfit]  #: of every test, held-out ones too
    diagnosis: Diagnosis | None  #: None: nothing was fitted
    history: list[tuple[str, float]]  #: misfit after each step
    simulations: int
    seconds: float
    cpu_seconds: float  #: of this process and its workers
    workers: int
    beside: list[Misfit] | None = None  #: the same of another material, if wanted
    beside_name: str = ""
    minima: list[Minimum] = dataclasses.field(default_factory=list)  #: within a tenth of the best misfit, best first
    ensemble: Ensemble | None = None  #: sets that fit nearly as well, and their bands
    notes: list[str] = dataclasses.field(default_factory=list)  #: what was cut, left out or begun later, before the fit

    def item(self, name: str) -> Item:
        """A test with what counts of it."""
        return next(item for item in self.task.items if item.test.name == name)


def calibrate(
    task: Task,
    effort: Effort | None = None,
    workers: int = 0,
    write: Callable[[str], None] | None = say,
    beside: str | None = None,
    unfinished: str | os.PathLike | None = None,
) -> Calibration:
    """Fits a material to the tests of a task that are not held out.

    effort : how much the search may do; the default is a whole calibration. workers : processes, 0: one a core; the answer does
    not depend on it. write : takes lines of progress with the time left, None: silent, and so is the library on sets that are
    tried. beside : material whose misfit is reported too. unfinished : file for what was evaluated, from which an interrupted fit
    goes on; removed when the fit is done. Reproducible: the same task, seed and library give the same parameters.
    """
    try:
        import scipy  # noqa: F401
    except ImportError as problem:
        raise ImportError("mud_calibrate needs SciPy: pip install 'mud-soil[calibrate]'") from problem
    begin, used = time.monotonic(), _cpu()
    if not any(not item.test.held_out for item in task.items):
        raise InputError(
            "every test is held out: nothing is left to fit. To compare a material with the tests and fit nothing, evaluate it"
        )
    if not any(item.weight > 0 for item in task.fitted()):
        raise InputError("every test that is not held out has the weight 0: nothing is left to fit")
    if not task.variables():
        raise InputError("there is nothing to fit: every parameter that these tests depend on is known")
    with remarks_of_the_library(write is not None):
        screened = screen(task, trial_sets(task, task.variables()))
        task, notes = screened.task, [*_notes(task, task.base), *screened.notes]
        if write:
            for note in notes:
                write(note)
        store = Store(unfinished, task.fitted(), task.base) if unfinished else None
        fit, done = Fit(task, effort or Effort(), workers, write, store), False
        if store and store.read and write:
            write(f"goes on from {store.path}: {store.read} evaluations of an interrupted fit")
        try:
            values = fit.run()
            task.items = [item.under(values) for item in task.items]
            answers = answers_of(fit.evaluator.material(values, **SETTINGS), task.items)
            ensemble = make_ensemble(fit, values, answers)
            found = diagnose(fit, values, answers, ensemble)
            done = True
        finally:
            fit.evaluator.close()
            if store:
                store.close(done)
    other = in_kpa(Material(beside, **SETTINGS)) if beside else None
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
        fit.minima,
        ensemble,
        notes,
    )


@contextlib.contextmanager
def remarks_of_the_library(wanted: bool) -> Iterator[None]:
    """Unless wanted the library says nothing on standard error, nor does that of a worker that begins meanwhile."""
    before = os.environ.get("MUD_MESSAGES")
    if not wanted:
        os.environ["MUD_MESSAGES"] = "off"
    try:
        yield
    finally:
        os.environ.pop("MUD_MESSAGES", None)
        if before is not None:
            os.environ["MUD_MESSAGES"] = before


def evaluate(task: Task, material: str | os.PathLike | Material, beside: str | None = None) -> Calibration:
    """Fits nothing: a material against every test of a task, held out or not, for ``write_report``."""
    begin, used = time.monotonic(), _cpu()
    sand = in_kpa(material if isinstance(material, Material) else Material(material))
    answers = answers_of(sand.changed(**SETTINGS), task.items)
    other = in_kpa(Material(beside, **SETTINGS)) if beside else None
    return Calibration(
        task,
        sand,
        {},
        answers,
        misfits_of(task.items, answers),
        None,
        [],
        len(task.items),
        time.monotonic() - begin,
        _cpu() - used,
        1,
        misfits_of(task.items, answers_of(other, task.items)) if other else None,
        beside or "",
        notes=[
            *_notes(task, sand),
            *(f"{name} stopped: {answer.stopped}" for name, answer in answers.items() if answer.stopped),
            *unloading(sand, task.items, answers),
        ],
    )


def _notes(task: Task, sand: Mapping[str, float]) -> list[str]:
    """What the tables' defaults left out, the tests of one sentence together, and what they lack. sand : parameters."""
    told: dict[str, list[str]] = {}
    sources = dict.fromkeys((item.test.source, pair) for item in task.items for pair in item.test.understood)
    for source, (given, meant) in sources:
        told.setdefault(f"{UNDERSTOOD} {source}: '{given}' is {meant}", [])
    for item in task.items:
        if item.use.note:
            told.setdefault(item.use.note, []).append(item.test.name)
        if item.test.kind == "retention" and not {"e", "e_0"} & set(item.test.columns) and sand["Omega"] > 0:
            blind = f"no void ratio, with which the curve moves: e_0 of the material, {sand['e_0']:g}, is taken; give e or e_0"
            told.setdefault(blind, []).append(item.test.name)
    return [f"{', '.join(names)}: {note}." if names else f"{note}." for note, names in told.items()]


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
