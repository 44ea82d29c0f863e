# SPDX-License-Identifier: MIT
"""The fit: critical state by regression, a quasi-random search, several starts followed by groups and then by everything
together; what the tests do not determine keeps its prior."""

from __future__ import annotations

import dataclasses
import sys
import time
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from .misfit import Evaluator
from .store import Store
from .task import Task
from .variables import GROUPS, P_CRITICAL, Variable, start_of

STEP = 4e-3  # of a difference quotient, as a share of the bounds: far above the noise of the integration
GROUP_EVALUATIONS = 4  # least squares of one group: it only has to come near
FLAT = 1e-5  # change of the misfit, as a share, at which least squares end: valleys are long and flat
THIN = 3  # rows of the search: every third
FEW = 8  # tests of the search and of the groups, spread over the kinds
SIDE = 0.975  # quantile at which an interval of 95 % ends
PRIOR = 1.0  # standard deviation of the prior in the width of the bounds
PULL = 0.1  # residual of a variable that is the width of its bounds away from its prior: less than a curve notices
NOISE = 1e-2  # residual of a curve that the errors of the simulations may leave, standard deviations
SAID_NOTHING = 0.45  # posterior deviation, as a share of the bounds, beyond which the tests have said nothing: theirs is 0.5
NO_WORSE = 1.01  # and the misfit must not grow by more than this factor where such a parameter keeps its prior
SPREAD = 0.3  # share of the bounds over which the search moves the critical state about its regression
APART = 0.1  # least distance of two starts, rms over the variables as shares of the bounds
TRIED_ON = 1.3  # starts whose misfit is within this factor of the best are fitted to the end
NEARLY = 1.1  # minima within a tenth of the best are told
SAME = 0.02  # minima closer than this (rms over the shares) are one


@dataclasses.dataclass
class Effort:
    """How much the fit may do. Counts, not seconds, so that the answer does not depend on the machine."""

    samples: int = 64  #: points of the quasi-random search
    starts: int = 4  #: best of them, apart from each other, that are followed through the groups
    rounds: int = 1  #: passes through the groups
    trial: int = 12  #: evaluations with Jacobian of every start before the hopeless ones are left
    joint: int = 40  #: evaluations with Jacobian of the joint least squares
    members: int = 96  #: of the ensemble; 0: none


@dataclasses.dataclass
class Minimum:
    """An end of the joint least squares."""

    values: dict[str, float]
    cost: float  #: rms in standard deviations
    jacobian: np.ndarray  #: d residual / d share of the fitted variables, without the prior
    start: int  #: number of its start


@dataclasses.dataclass
class Part:
    """Variables and tests that have nothing to do with the others."""

    variables: list[Variable]
    numbers: list[int]  #: of the tests
    few: list[int]


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
        if test.kind not in ("drained", "undrained") or "e" not in test:  # without volume: nothing of the critical state line
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
    line = [v for v in free if v.name in ("e_c100", "lambda", "alpha_csl")]
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


def trial_sets(task: Task, variables: Sequence[Variable], count: int = 8) -> list[dict[str, float]]:
    """A few sets of variables: the start with the critical state of the tests, and quasi-random ones."""
    from scipy.stats import qmc

    start = {v.name: v.value(v.share(start_of(v.name, task.base))) for v in variables}
    first = {**start, **critical_state(task, variables)}
    if not variables:
        return [first]
    points = qmc.Sobol(len(variables), seed=task.seed).random(count)[1:]
    others = [{v.name: v.value(s) for v, s in zip(variables, point)} for point in points]
    return [first, start, *({**o, **critical_state(task, variables)} for o in others)]


class Fit:
    """Runs a task. ``variables`` are those that are moved, ``kept`` those that keep their prior because the tests say nothing
    about them, ``minima`` the ends of the starts, best first, ``history`` what each step left as misfit."""

    def __init__(
        self,
        task: Task,
        effort: Effort,
        workers: int = 0,
        write: Callable[[str], None] | None = say,
        store: Store | None = None,
    ):
        self.task, self.effort = task, effort
        self.variables = task.variables()
        self.kept: list[Variable] = []
        self.evaluator = Evaluator(task.fitted(), task.base, task.fixed_variables, workers, store)
        self.curves = sum(len(item.use.scatter) for item in task.fitted())
        self.history: list[tuple[str, float]] = []
        self.minima: list[Minimum] = []
        self.parts = self._parts()
        total = 0.0
        for part in self.parts:
            n, share = len(part.variables), len(part.few) / len(task.fitted())
            total += share * (effort.samples + effort.starts * effort.rounds * GROUP_EVALUATIONS * (n + 6))
            total += (effort.starts * effort.trial + effort.joint) * (n + 1) * len(part.numbers) / len(task.fitted())
        self.progress = Progress(total, write)

    def _parts(self) -> list[Part]:
        """Retention apart from the mechanical tests: it alone speaks of the retention tests, and saturated tests do not
        depend on it; where unsaturated tests do, the retention tests still tell it best."""
        items = self.task.fitted()
        parts = []
        for apart in (True, False):
            mine = [v for v in self.variables if (v.group == "retention") is apart]
            numbers = [i for i, item in enumerate(items) if (item.test.kind == "retention") is apart]
            if mine and numbers:
                parts.append(Part(mine, numbers, few_of(items, numbers)))
        return parts

    def run(self) -> dict[str, float]:
        """The variables at the optimum."""
        values = {v.name: v.value(v.share(start_of(v.name, self.task.base))) for v in self.variables}
        values.update(critical_state(self.task, self.variables))
        self.minima = []
        for part in self.parts:
            values = self._run_part(part, values)
        return {v.name: values[v.name] for v in (*self.variables, *self.kept)}

    def _run_part(self, part: Part, values: dict[str, float]) -> dict[str, float]:
        effort = self.effort
        word = "retention, " if part.variables[0].group == "retention" and len(self.parts) > 1 else ""
        starts, ends = self._search(part, values, word), []
        for number, start in enumerate(starts):
            cost = np.inf
            for _ in range(effort.rounds):
                for group in GROUPS:
                    mine = [v for v in part.variables if v.group == group]
                    if mine:
                        found = self._least_squares(
                            mine, start, GROUP_EVALUATIONS, f"{word}start {number + 1}, {group}", part.few, THIN
                        )
                        start, cost = found.values, found.cost
            ends.append((cost, number, start))
        self.history.append((f"{word}groups", min(ends)[0]))
        tried = []
        for _, number, start in ends:
            evaluations = effort.trial if len(ends) > 1 else effort.joint
            found = self._least_squares(
                part.variables, start, evaluations, f"{word}start {number + 1}", part.numbers, 1
            )
            tried.append(dataclasses.replace(found, start=number + 1))
        best = min(m.cost for m in tried)
        if len(tried) > 1:
            self.history.append((f"{word}starts tried", best))
            tried = [
                dataclasses.replace(
                    self._least_squares(
                        part.variables, m.values, effort.joint, f"{word}start {m.start}, together", part.numbers, 1
                    ),
                    start=m.start,
                )
                for m in tried
                if m.cost <= TRIED_ON * best
            ]
        tried.sort(key=lambda m: (m.cost, m.start))
        self.history.append((f"{word}together", tried[0].cost))
        tried = self._keep_prior(part, self._less_pulled(part, tried, word), word)
        if any(v.group != "retention" for v in part.variables) or len(self.parts) == 1:
            self.minima = self._apart(part, [m for m in tried if m.cost <= NEARLY * tried[0].cost])
        return tried[0].values

    def _apart(self, part: Part, minima: Sequence[Minimum]) -> list[Minimum]:
        """Minima that are not the same."""
        found: list[Minimum] = []
        for m in minima:
            if all(_distance(part.variables, m.values, other.values) > SAME for other in found):
                found.append(m)
        return found

    def _less_pulled(self, part: Part, minima: list[Minimum], word: str) -> list[Minimum]:
        """Where curves lie so close to the tests that the pull of the fit is stronger than the prior, minima are fitted again
        with the pull of the prior, so that they do not lie beside their own intervals."""
        best = minima[0]
        pull = np.sqrt(self.variance(self.evaluator.residuals([best.values], part.numbers)[0], part)) / PRIOR
        if pull >= PULL:
            return minima
        again = [
            dataclasses.replace(
                self._least_squares(
                    part.variables, m.values, self.effort.joint, f"{word}start {m.start}, closer", part.numbers, 1, pull
                ),
                start=m.start,
            )
            for m in minima
            if m.cost <= NEARLY * best.cost
        ]
        again.sort(key=lambda m: (m.cost, m.start))
        self.history.append((f"{word}with less pull to the prior", again[0].cost))
        return again

    def _keep_prior(self, part: Part, minima: list[Minimum], word: str) -> list[Minimum]:
        """Gives those variables their prior back about which the tests say nothing, and fits the others again. One after the
        other: two that are only determined together stay. If the misfit grows by it, nothing changes."""
        best = minima[0]
        residual = self.evaluator.residuals([best.values], part.numbers, 1)[0]
        variance = self.variance(residual, part)
        rest, jacobian, kept = list(part.variables), best.jacobian, []
        while len(rest) > 1:
            deviations = np.sqrt(np.diag(posterior(jacobian, variance)))
            worst = int(np.argmax(deviations))
            if deviations[worst] < SAID_NOTHING:
                break
            kept.append(rest.pop(worst))
            jacobian = np.delete(jacobian, worst, axis=1)
        if not kept:
            return minima
        prior = {v.name: start_of(v.name, self.task.base) for v in kept}
        again = [
            dataclasses.replace(
                self._least_squares(
                    rest,
                    {**m.values, **prior},
                    self.effort.joint,
                    f"{word}start {m.start}, again",
                    part.numbers,
                    1,
                    min(PULL, np.sqrt(variance) / PRIOR),
                ),
                start=m.start,
            )
            for m in minima
            if m.cost <= NEARLY * best.cost
        ]
        again.sort(key=lambda m: (m.cost, m.start))
        if again[0].cost > NO_WORSE * best.cost:
            return minima
        self.history.append((f"{word}without what the tests say nothing about", again[0].cost))
        part.variables = rest
        self.kept += kept
        self.variables = [v for v in self.variables if v not in kept]
        return again

    def _search(self, part: Part, values: Mapping[str, float], word: str) -> list[dict[str, float]]:
        """The best of the start and of Sobol points, apart from each other; every other one moves the critical state too, about
        what the ends of the tests tell."""
        from scipy.stats import qmc

        free = part.variables
        sets = [dict(values)]
        if self.effort.samples > 1:
            # The first of a power of two, which is balanced, is the start itself.
            points = qmc.Sobol(len(free), seed=self.task.seed).random(self.effort.samples)[1:]
            for k, point in enumerate(points):
                spread = SPREAD if k % 2 else 0.0
                places = {
                    v.name: (
                        float(np.clip(v.share(values[v.name]) + spread * (s - 0.5), 0, 1)) if v.group == GROUPS[0] else s
                    )
                    for v, s in zip(free, point)
                }
                sets.append({**values, **{v.name: v.value(places[v.name]) for v in free}})
        residuals: list[np.ndarray] = []
        for first in range(0, len(sets), 8):
            residuals += self.evaluator.residuals(sets[first : first + 8], part.few, THIN)
            best = min(self._rms(r, part.few) for r in residuals)
            self._tell(f"{word}search", len(sets[first : first + 8]), best, part.few)
        costs = [self._rms(r, part.few) for r in residuals]
        order = np.argsort(costs, kind="stable")
        self.history += [(f"{word}start", costs[0]), (f"{word}search", costs[order[0]])]
        chosen: list[dict[str, float]] = []
        for i in order:
            if len(chosen) < self.effort.starts and all(_distance(free, sets[i], c) > APART for c in chosen):
                chosen.append(sets[i])
        return chosen

    def _least_squares(
        self,
        mine: Sequence[Variable],
        values: Mapping[str, float],
        evaluations: int,
        what: str,
        tests: Sequence[int],
        thin: int,
        strength: float = PULL,
    ) -> Minimum:
        """Least squares in some variables on some tests and rows, with a weak pull to the prior of the variables."""
        from scipy.optimize import least_squares

        prior = np.array([v.share(start_of(v.name, self.task.base)) for v in mine])
        pull = strength * np.eye(len(mine))
        seen = [np.nan]  # the misfit of the last evaluation, for the progress

        def at(shares: np.ndarray) -> dict[str, float]:
            return {**values, **{v.name: v.value(s) for v, s in zip(mine, shares)}}

        def residual(shares: np.ndarray) -> np.ndarray:
            answer = self.evaluator.residuals([at(shares)], tests, thin)[0]
            seen[0] = self._rms(answer, tests)
            self._tell(what, 1, seen[0], tests)
            return np.concatenate([answer, pull @ (shares - prior)])

        def jacobian(shares: np.ndarray) -> np.ndarray:
            answer = self.jacobian(mine, at(shares), tests, thin)
            self._tell(what, len(mine) + 1, seen[0], tests)
            return np.concatenate([answer, pull])

        start = np.clip([v.share(values[v.name]) for v in mine], 1e-3, 1 - 1e-3)
        answer = least_squares(
            residual, start, jacobian, bounds=(0, 1), max_nfev=evaluations, ftol=FLAT, xtol=FLAT, gtol=1e-6
        )
        n = len(mine)
        return Minimum(at(answer.x), self._rms(answer.fun[:-n], tests), answer.jac[:-n], 0)

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

    def _curves(self, tests: Sequence[int]) -> int:
        return sum(len(self.evaluator.items[i].use.scatter) for i in tests)

    def _rms(self, residual: np.ndarray, tests: Sequence[int]) -> float:
        return rms(residual, self._curves(tests))

    def variance(self, residual: np.ndarray, part: Part) -> float:
        """``spread_of`` a part, without the weights of its tests, over the largest one: that bounds the variance of a fit whose
        tests weigh differently. residual : of its tests."""
        items = [item for item in (self.evaluator.items[i] for i in part.numbers) for _ in item.use.scatter]
        ends = np.cumsum([len(item.use.rows) for item in items])
        heaviest = max((item.weight for item in items), default=1.0)
        curves = [curve / item.weight for curve, item in zip(np.split(residual, ends), items) if item.weight > 0]
        return heaviest**2 * spread_of(curves, len(part.variables))

    def _tell(self, what: str, sets: int, cost: float, tests: Sequence[int]) -> None:
        self.progress.step(what, sets * len(tests) / len(self.evaluator.items), cost)


def observations(curves: Sequence[np.ndarray]) -> float:
    """Independent observations in curves of residuals: their rows over the sum of their common autocorrelation up to the lag
    at which it is not positive any more. Errors of a model follow each other along a curve, which then counts once; errors
    of a measurement do not, and then every row counts."""
    total, time = sum(float(c @ c) for c in curves), 1.0
    for lag in range(1, max(map(len, curves))):
        together = sum(float(c[lag:] @ c[:-lag]) for c in curves)
        if not together > 0:
            break
        time += 2 * together / total
    return sum(max(1.0, len(c) / time) for c in curves)


def spread_of(curves: Sequence[np.ndarray], variables: int) -> float:
    """Variance that belongs to a sum of squares over curves: RSS/(n - p) of n independent observations and p fitted variables,
    wider by Student's t. Where the fit leaves less than one observation over, the scatter that was told counts, or a larger
    misfit, with half of the observations used up; so does that scatter where the fit agrees with it and t is wider.

    curves : residuals in standard deviations over the root of the number of rows.
    """
    from scipy.stats import norm, t

    squares, n = sum(float(c @ c) for c in curves), observations(curves)
    most = 2 * max(squares, len(curves)) / n
    if n >= variables + 1:
        left = squares / (n - variables) * (t.ppf(SIDE, n - variables) / norm.ppf(SIDE)) ** 2
        most = min(most, left) if squares <= len(curves) else left
    return max(float(most), NOISE**2)


def posterior(jacobian: np.ndarray, variance: float) -> np.ndarray:
    """Covariance of the shares: tests and prior."""
    n = jacobian.shape[1]
    return np.linalg.inv(jacobian.T @ jacobian / variance + np.eye(n) / PRIOR**2)


def _distance(variables: Sequence[Variable], a: Mapping[str, float], b: Mapping[str, float]) -> float:
    """rms over the variables, as shares of their bounds."""
    return float(np.sqrt(np.mean([(v.share(a[v.name]) - v.share(b[v.name])) ** 2 for v in variables])))


def few_of(items: Sequence, numbers: Sequence[int]) -> list[int]:
    """At most FEW of these tests, as many of each kind as its share of all, spread over the order of the tables."""
    kinds = list(dict.fromkeys(items[i].test.kind for i in numbers))
    chosen: list[int] = []
    for kind in kinds:
        mine = [i for i in numbers if items[i].test.kind == kind]
        count = min(len(mine), max(1, round(FEW * len(mine) / len(numbers))))
        chosen += [mine[i] for i in np.unique(np.linspace(0, len(mine) - 1, count).round().astype(int))]
    return chosen
