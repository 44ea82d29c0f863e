# SPDX-License-Identifier: MIT
"""The fit: critical state by regression, a quasi-random search, groups one after the other, then everything together."""

from __future__ import annotations

import dataclasses
import sys
import time
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from .misfit import Evaluator
from .task import Task
from .variables import GROUPS, P_CRITICAL, Variable, start_of

STEP = 4e-3  # of a difference quotient, as a share of the bounds: far above the noise of the integration
GROUP_EVALUATIONS = 4  # least squares of one group: it only has to come near
FLAT = 1e-5  # change of the misfit, as a share, at which least squares end: valleys are long and flat
THIN = 3  # rows of the search: every third
FEW = 8  # tests of the search and of the groups, spread over the kinds


@dataclasses.dataclass
class Effort:
    """How much the fit may do. Counts, not seconds, so that the answer does not depend on the machine."""

    samples: int = 64  #: points of the quasi-random search
    starts: int = 2  #: best of them that are followed through the groups
    rounds: int = 1  #: passes through the groups
    joint: int = 40  #: evaluations with Jacobian of the joint least squares


class Progress:
    """Lines with what is done and the time left."""

    def __init__(self, total: float, write: Callable[[str], None] | None):
        self.total, self.done, self.begin, self.write, self.last = total, 0, time.monotonic(), write, 0.0

    def step(self, what: str, sets: float, cost: float) -> None:
        """``sets`` more sets of variables were evaluated."""
        self.done += sets
        now = time.monotonic() - self.begin
        if self.write and (now - self.last > 1.0 or self.done == sets):
            self.last = now
            left = now / self.done * max(self.total - self.done, 0)
            self.write(f"{what}: misfit {cost:.3f}, {now:.0f} s, at most {left:.0f} s left")


def say(text: str) -> None:
    """Progress on standard error."""
    print(f"mud_calibrate: {text}", file=sys.stderr, flush=True)


def rms(residual: np.ndarray, curves: int) -> float:
    """Misfit in standard deviations: mean over the curves of the (robust) mean square, its root."""
    return float(np.sqrt(np.sum(residual**2) / curves))


def critical_state(task: Task, variables: Sequence[Variable]) -> dict[str, float]:
    """Start of the critical state: the line through the ends of the shear tests, each weighted by how little its volume still
    changes, and their stress ratio. Empty if no shear test was measured far enough."""
    from scipy.optimize import least_squares

    ends = []
    for item in task.fitted():
        test = item.test
        if test.kind not in ("drained", "undrained"):
            continue
        rows = item.use.rows
        strain, e, p, q = (test[name][rows] for name in ("eps_a", "e", "p", "q"))
        if len(rows) < 4 or abs(strain[-1]) < 0.1:
            continue
        slope = abs((e[-1] - e[-3]) / (strain[-1] - strain[-3])) / (1 + e[-1])  # d eps_v/d eps_a
        ends.append((p[-1], e[-1], q[-1] / p[-1], np.exp(-slope / 0.03)))
    free = [v for v in variables if v.group == GROUPS[0]]
    if len(ends) < 3 or not free:
        return {}
    p, e, eta, weight = np.array(ends).T
    found: dict[str, float] = {}
    line = [v for v in free if v.name != "M_c"]
    if len(line) == 3:

        def off(shares: np.ndarray) -> np.ndarray:
            e_c, slope, shift = (v.value(s) for v, s in zip(line, shares))
            # A weak pull to the middle: three ends do not tell the curvature of the line.
            return np.concatenate(
                [weight * (e_c * ((p + shift) / (P_CRITICAL + shift)) ** -slope - e) / 0.02, 0.1 * (shares - 0.5)]
            )

        answer = least_squares(off, [v.share(start_of(v.name, task.base)) for v in line], bounds=(0, 1))
        found = {v.name: v.value(s) for v, s in zip(line, answer.x)}
    if any(v.name == "M_c" for v in free):
        found["M_c"] = float(np.sum(weight * eta) / np.sum(weight))
    return found


class Fit:
    """Runs a task. ``values`` holds the variables, ``history`` what each step left as misfit."""

    def __init__(self, task: Task, effort: Effort, workers: int = 0, write: Callable[[str], None] | None = say):
        self.task, self.effort = task, effort
        self.variables = task.variables()
        self.evaluator = Evaluator(task.fitted(), task.base, task.fixed_variables, workers)
        self.few = few_of(task.fitted())
        self.curves = sum(len(item.use.scatter) for item in task.fitted())
        self.history: list[tuple[str, float]] = []
        n, share = len(self.variables), len(self.few) / len(task.fitted())
        self.progress = Progress(
            share * (effort.samples + effort.starts * effort.rounds * GROUP_EVALUATIONS * (n + 6))
            + effort.joint * (n + 1),
            write,
        )

    def run(self) -> dict[str, float]:
        """The variables at the optimum."""
        task, effort = self.task, self.effort
        values = {v.name: v.value(v.share(start_of(v.name, task.base))) for v in self.variables}
        values.update(critical_state(task, self.variables))
        starts = self._search(values)
        ends = []
        for number, start in enumerate(starts):
            for _ in range(effort.rounds):
                for group in GROUPS:
                    mine = [v for v in self.variables if v.group == group]
                    if mine:
                        start, cost = self._least_squares(
                            mine, start, GROUP_EVALUATIONS, f"start {number + 1}, {group}", True
                        )
            ends.append((cost, number, start))
        self.history.append(("groups", min(ends)[0]))
        values, cost = self._least_squares(self.variables, min(ends)[2], effort.joint, "together", False)
        self.history.append(("together", cost))
        return values

    def _search(self, values: Mapping[str, float]) -> list[dict[str, float]]:
        """The best of the start and of Sobol points for everything but the critical state, which the ends of the tests tell."""
        from scipy.stats import qmc

        free = [v for v in self.variables if v.group != GROUPS[0]]
        sets = [dict(values)]
        if free and self.effort.samples > 1:
            points = qmc.Sobol(len(free), seed=self.task.seed).random(self.effort.samples)[
                1:
            ]  # a power of two, balanced
            sets += [{**values, **{v.name: v.value(s) for v, s in zip(free, point)}} for point in points]
        residuals: list[np.ndarray] = []
        for first in range(0, len(sets), 8):
            residuals += self.evaluator.residuals(sets[first : first + 8], self.few, THIN)
            self._tell("search", len(sets[first : first + 8]), min(self._rms(r, True) for r in residuals), True)
        costs = [self._rms(r, True) for r in residuals]
        best = np.argsort(costs, kind="stable")[: self.effort.starts]
        self.history += [("start", costs[0]), ("search", costs[best[0]])]
        return [sets[i] for i in best]

    def _least_squares(
        self, mine: Sequence[Variable], values: Mapping[str, float], evaluations: int, what: str, coarse: bool
    ) -> tuple[dict[str, float], float]:
        """Least squares in some variables. coarse : on few tests and rows."""
        from scipy.optimize import least_squares

        tests, thin = (self.few, THIN) if coarse else (None, 1)
        seen = [np.nan]  # the misfit of the last evaluation, for the progress

        def at(shares: np.ndarray) -> dict[str, float]:
            return {**values, **{v.name: v.value(s) for v, s in zip(mine, shares)}}

        def residual(shares: np.ndarray) -> np.ndarray:
            answer = self.evaluator.residuals([at(shares)], tests, thin)[0]
            seen[0] = self._rms(answer, coarse)
            self._tell(what, 1, seen[0], coarse)
            return answer

        def jacobian(shares: np.ndarray) -> np.ndarray:
            answer = self.jacobian(mine, at(shares), tests, thin)
            self._tell(what, len(mine) + 1, seen[0], coarse)
            return answer

        start = np.clip([v.share(values[v.name]) for v in mine], 1e-3, 1 - 1e-3)
        answer = least_squares(
            residual, start, jacobian, bounds=(0, 1), max_nfev=evaluations, ftol=FLAT, xtol=FLAT, gtol=1e-6
        )
        return at(answer.x), self._rms(answer.fun, coarse)

    def jacobian(
        self,
        mine: Sequence[Variable],
        values: Mapping[str, float],
        tests: Sequence[int] | None = None,
        thin: int = 1,
        step: float = STEP,
    ) -> np.ndarray:
        """d residual/d share, by differences to the side where there is more room."""
        base = [v.share(values[v.name]) for v in mine]
        steps = [step if s < 0.5 else -step for s in base]
        sets = [dict(values)] + [{**values, v.name: v.value(s + d)} for v, s, d in zip(mine, base, steps)]
        residuals = self.evaluator.residuals(sets, tests, thin)
        return np.stack([(r - residuals[0]) / d for r, d in zip(residuals[1:], steps)], axis=1)

    def _rms(self, residual: np.ndarray, coarse: bool) -> float:
        items = self.evaluator.items
        return rms(residual, sum(len(items[i].use.scatter) for i in (self.few if coarse else range(len(items)))))

    def _tell(self, what: str, sets: int, cost: float, coarse: bool) -> None:
        self.progress.step(what, sets * (len(self.few) / len(self.evaluator.items) if coarse else 1.0), cost)


def few_of(items: Sequence) -> list[int]:
    """Numbers of at most FEW tests, as many of each kind as its share of all, spread over the order of the tables."""
    kinds = list(dict.fromkeys(item.test.kind for item in items))
    chosen: list[int] = []
    for kind in kinds:
        mine = [i for i, item in enumerate(items) if item.test.kind == kind]
        count = min(len(mine), max(1, round(FEW * len(mine) / len(items))))
        chosen += [mine[i] for i in np.unique(np.linspace(0, len(mine) - 1, count).round().astype(int))]
    return chosen
