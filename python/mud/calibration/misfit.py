# SPDX-License-Identifier: MIT
"""Residuals of a material against tests: scaled by scatter, robust, each curve as much as any other."""

from __future__ import annotations

import dataclasses
import multiprocessing
import os
import signal
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor

import numpy as np

from ..errors import MudError
from ..material import Material
from .simulation import SETTINGS, Answer, simulate
from .store import Store
from .task import Item
from .variables import parameters_of, poisson_residual

ROBUST = 3.0  # residuals beyond so many standard deviations count less (soft l1)
PENALTY = 20.0  # residual of a row that the model did not reach, in standard deviations


# What a worker process works on, set once when it begins.
_items: Sequence[Item] = ()
_base: Mapping[str, float] = {}


def _begin(items: Sequence[Item], base: Mapping[str, float]) -> None:
    global _items, _base
    _items, _base = items, base


def _begin_worker(items: Sequence[Item], base: Mapping[str, float]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt ends the fit, which ends its workers
    _begin(items, base)


def _job(values: Mapping[str, float], number: int, thin: int) -> tuple[np.ndarray, bool]:
    """Residual of one test under one set of variables, and whether it stopped."""
    item = _items[number].under(values)
    try:
        answer = simulate(Material(**{**parameters_of(values, _base), **SETTINGS}), item.test, item.use)
    except MudError as problem:  # the set is refused
        answer = Answer({q: np.full(len(item.use.rows), np.nan) for q in item.use.scatter}, str(problem))
    rows = len(item.use.rows[::thin])
    return np.concatenate(
        [residual_of(item, answer, quantity)[::thin] / np.sqrt(rows) * item.weight for quantity in item.use.scatter]
    ), bool(answer.stopped)


class Evaluator:
    """Evaluates sets of variables on tests, in parallel: one test under one set is a job for a worker process.

    Processes and not threads, because element tests of one process wait for each other. The answer does not depend on their
    number.
    """

    def __init__(
        self,
        items: Sequence[Item],
        base: Mapping[str, float],
        fixed: Mapping[str, float],
        workers: int = 0,
        store: Store | None = None,
    ):
        self.items, self.base, self.fixed, self.store = items, base, fixed, store
        self.simulations = 0  #: single tests that were run
        self.failures: dict[str, int] = {}  #: test -> how often it stopped or was refused
        count = workers or os.cpu_count() or 1
        _begin(items, base)
        method = "fork" if "fork" in multiprocessing.get_all_start_methods() else "spawn"
        self._pool = (
            ProcessPoolExecutor(count, multiprocessing.get_context(method), _begin_worker, (items, base))
            if count > 1
            else None
        )

    def close(self) -> None:
        """Ends the workers."""
        if self._pool:
            self._pool.shutdown(cancel_futures=True)

    def material(self, values: Mapping[str, float], **settings: float | str) -> Material:
        """The material of a set of variables."""
        return Material(**{**parameters_of({**self.fixed, **values}, self.base), **settings})

    def residuals(
        self, sets: Sequence[Mapping[str, float]], numbers: Sequence[int] | None = None, thin: int = 1
    ) -> list[np.ndarray]:
        """Residual vectors of several sets of variables on tests by their number, and behind them what keeps Poisson's ratio;
        thin : only every row of this number counts."""
        numbers = range(len(self.items)) if numbers is None else numbers
        jobs = [({**self.fixed, **values}, number, thin) for values in sets for number in numbers]
        parts = [self.store.get(job) if self.store else None for job in jobs]
        todo = [i for i, part in enumerate(parts) if part is None]
        if self._pool and todo:
            found = list(self._pool.map(_job, *zip(*(jobs[i] for i in todo)), chunksize=4))
        else:
            _begin(self.items, self.base)
            found = [_job(*jobs[i]) for i in todo]
        for i, part in zip(todo, found):
            parts[i] = part
        if self.store:
            self.store.put([jobs[i] for i in todo], found)
        self.simulations += len(jobs)
        for (_, number, _), (_, stopped) in zip(jobs, parts):
            if stopped:
                name = self.items[number].test.name
                self.failures[name] = self.failures.get(name, 0) + 1
        count = len(numbers)
        return [
            np.concatenate(
                [
                    *(part for part, _ in parts[i * count : (i + 1) * count]),
                    poisson_residual(parameters_of({**self.fixed, **values}, self.base)),
                ]
            )
            for i, values in enumerate(sets)
        ]


    def answers(self, sets: Sequence[Mapping[str, float]], items: Sequence[Item]) -> list[list[Answer]]:
        """The model at the rows of tests, for several sets of variables: [set][test]. Nothing of it is kept."""
        jobs = [
            (self.material(values, **SETTINGS), one.test, one.use)
            for values in sets
            for one in (item.under(values) for item in items)
        ]
        self.simulations += len(jobs)
        found = list(self._pool.map(simulate, *zip(*jobs), chunksize=4)) if self._pool else [simulate(*j) for j in jobs]
        return [found[i * len(items) : (i + 1) * len(items)] for i in range(len(sets))]


def scaled(item: Item, answer: Answer, quantity: str) -> np.ndarray:
    """(model - laboratory) over the standard deviation of what was measured; NaN where the model did not come."""
    measured = item.test[quantity][item.use.rows]
    absolute, share = item.use.scatter[quantity]
    return (answer.columns[quantity] - measured) / np.hypot(absolute, share * measured)


def residual_of(item: Item, answer: Answer, quantity: str) -> np.ndarray:
    """The same, robust (soft l1: linear beyond ROBUST) and with a penalty for what is missing."""
    z = scaled(item, answer, quantity)
    missing = ~np.isfinite(z)
    z = np.where(missing, PENALTY, z) / ROBUST
    return np.sign(z) * np.sqrt(2 * (np.sqrt(1 + z * z) - 1)) * ROBUST


@dataclasses.dataclass
class Misfit:
    """How far one test is missed; NaN where a kind of test has no such quantity."""

    name: str
    kind: str
    held_out: bool
    q: float = np.nan  #: rms of q/q_lab - 1 over 1 to 20 % axial strain [%]; see LIQUID
    p: float = np.nan  #: undrained: rms of p/p_lab - 1 [%]
    eps_v: float = np.nan  #: rms difference over the same rows [percentage points]
    e: float = np.nan  #: largest difference of void ratio [-]
    e_loading: float = np.nan  #: the same, of the first loading alone
    S_w: float = np.nan  #: rms difference [-]
    r_u: float = np.nan  #: cyclic: rms difference of the pore pressure ratio [-]
    sigma_r: float = np.nan  #: oedometer with radial stress: rms difference of it [kPa]
    G: float = np.nan  #: rms of G_max/G_lab - 1 [%], or of the difference of G/G_max in hundredths
    damping: float = np.nan  #: rms difference of the damping ratio in hundredths
    N: float = np.nan  #: factor by which the cycles to liquefaction are missed, rms of its logarithm
    stopped: str = ""


LIQUID = 0.02  # share of the largest q or p' of a test by which what is smaller is divided
RANGE = (0.0099, 0.2501)  # axial strain over which q and eps_v are told


def misfit_of(item: Item, answer: Answer, last: float = 0.2001) -> Misfit:
    """The misfit of a test. last : largest axial strain that counts."""
    test, rows = item.test, item.use.rows
    told = Misfit(test.name, test.kind, test.held_out, stopped=answer.stopped)

    def rms(values: np.ndarray) -> float:
        return float(np.sqrt(np.mean(np.square(values)))) if len(values) else np.nan

    def relative(quantity: str, used: np.ndarray) -> np.ndarray:
        """Differences over the laboratory's values. A sample that liquefies comes to 0: differences there are over LIQUID."""
        lab, model = test[quantity][rows][used], answer.columns[quantity][used]
        floor = LIQUID * np.max(np.abs(test[quantity][rows]))
        return np.where(np.abs(lab) > floor, model / np.where(np.abs(lab) > floor, lab, 1) - 1, (model - lab) / floor)

    if test.kind in ("drained", "undrained"):
        used = (np.abs(test["eps_a"][rows]) >= RANGE[0]) & (np.abs(test["eps_a"][rows]) <= last)
        told.q = 100 * rms(relative("q", used))
        if test.kind == "undrained":
            told.p = 100 * rms(relative("p", used))
        elif "eps_v" in item.use.scatter:
            told.eps_v = 100 * rms(answer.columns["eps_v"][used] - test["eps_v"][rows][used])
    elif test.kind in ("oedometer", "isotropic"):
        off = np.abs(answer.columns["e"] - test["e"][rows])
        stress = test["sigma_a" if test.kind == "oedometer" else "p"][rows]
        told.e, told.e_loading = float(np.max(off)), float(np.max(off[: int(np.argmax(stress)) + 1]))
        if "sigma_r" in item.use.scatter:
            told.sigma_r = rms(answer.columns["sigma_r"] - test["sigma_r"][rows])
    elif test.kind == "retention":
        told.S_w = rms(answer.columns["S_w"] - test["S_w"][rows])
    elif test.kind == "stiffness":
        told.G = 100 * rms(answer.columns["G_max"] / test["G_max"][rows] - 1)
    elif test.kind == "modulus":
        if "G_ratio" in item.use.scatter:
            told.G = 100 * rms(answer.columns["G_ratio"] - test["G_ratio"][rows])
        if "damping" in item.use.scatter:
            told.damping = 100 * rms(answer.columns["damping"] - test["damping"][rows])
    elif test.kind == "liquefaction":
        told.N = float(10 ** rms(answer.columns["log_N"] - test["log_N"][rows]))
    else:
        if "eps_v" in item.use.scatter:
            told.eps_v = 100 * rms(answer.columns["eps_v"] - test["eps_v"][rows])
        if "r_u" in item.use.scatter:
            told.r_u = rms(answer.columns["r_u"] - test["r_u"][rows])
    return told
