# SPDX-License-Identifier: MIT
"""Errors of a scene, measured: runs on meshes and with tolerances that differ, and the differences of their histories.

A pair (F, a) is a run with F times the cells along each axis and steps of tolerance a. Its errors are

- mesh: half the distance of (F, a) and (F/2, a); where a third mesh shows the order, what that leaves of it;
- steps: distance of (F/2, a) and (F/2, sqrt(10) a), on the coarser mesh, for a sixth of the time;
- Newton, stress integration: distance of the cheapest run and the same with a tenth of these tolerances.

Their sum is the error told. Pairs are refined until the sum of every answer is below what is asked.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass, field, replace

import numpy as np

from ..errors import InputError
from .histories import distance
from .runs import LOOSEST, BudgetUsedUp, Failed, Key, Run, Scene

HALF_DECADE = 10**0.5
NOISE = 4 / 3  # distances that fall by less from mesh to mesh show no limit
# Share of the last distance that is told, however fast distances fall, and most times it: one ratio shows r poorly.
LEAST, MOST = 1 / 3, 2.0
LEAST_STEPS, MOST_STEPS = 1 / 2, 1.5  # the same of the steps, whose order in the tolerance is 1 at most
UNKNOWN_ORDER = 0.5  # of the distance of two meshes is told: orders from 1 to 3.3 leave all of it to a ninth
USUAL_MESH, USUAL_STEPS = 1.5, 0.8  # orders in the cells and the tolerance, to choose the next pair
SMALL = 1 / 30  # of what is asked: steps that err less on one mesh are not measured again on the next
SOLVE_SHARE = 1 / 3  # of what is asked: from here on Newton's method and the stress integration are tightened

REFUSED = (2, 10, 11, 12, 13)  # exit codes of mud_host: what the scene says cannot be run

MET, LOCALISED, NOT_CONVERGING, BUDGET, FAILS = "met", "localised", "does not converge", "budget used up", "runs fail"
EXIT_CODES = {MET: 0, FAILS: 3, LOCALISED: 21, NOT_CONVERGING: 22, BUDGET: 23}


@dataclass
class Error:
    """Errors of an answer, as shares of its largest change."""

    change: float
    steps: float
    mesh: float
    newton: float = 0.0
    stress: float = 0.0
    order: float = USUAL_MESH  # of the mesh
    falls: bool = True  # distances fall from mesh to mesh, as far as is known

    @property
    def total(self) -> float:
        return self.steps + self.mesh + self.newton + self.stress


@dataclass
class Pair:
    """A pair that was measured."""

    fineness: float
    tolerance: float
    errors: dict[str, Error]
    run: Run

    @property
    def worst(self) -> str:
        return max(self.errors, key=lambda n: self.errors[n].total)

    @property
    def total(self) -> float:
        return self.errors[self.worst].total


@dataclass
class Result:
    """How a study ended."""

    state: str
    sentence: str
    pairs: list[Pair] = field(default_factory=list)

    @property
    def last(self) -> Pair:
        """The finest pair: what a rougher one told is contradicted where this one tells more."""
        return self.pairs[-1]


class Study:
    """The search for the cheapest run that holds an accuracy."""

    def __init__(self, scene: Scene, accuracy: float, goals: list[str] | None = None):
        self.scene, self.accuracy = scene, accuracy
        given = scene.list_of("scene")[0].get("goals", [])
        self.goals = goals or ([given] if isinstance(given, str) else list(given))
        self.pairs: list[Pair] = []
        self.tight = 0  # tenths of the tolerances of Newton and the stress integration, of all runs
        self.solve: dict[str, tuple[float, float]] = {}  # errors by Newton and the stress integration, by answer
        self.expected_solve: dict[str, tuple[float, float]] = {}  # the same where they cannot be measured

    # Runs ---------------------------------------------------------------------------------------------------------

    def run(self, fineness, tolerance, newton=0, stress=0, keep=False) -> Run:
        has_mud = bool(self.scene.list_of("mud"))
        run = self.scene.run(
            fineness, tolerance, self.tight + newton, (self.tight + stress) * has_mud, keep=keep and not newton
        )
        if run.localised:
            raise _Localised(run)
        return run

    def known(self, fineness, tolerance) -> Run | None:
        """A run that was made, the tightest, to see how fast distances fall."""
        has_mud = bool(self.scene.list_of("mud"))
        keys = (_key(fineness, tolerance, n, n * has_mud) for n in range(self.tight, -1, -1))
        return next((self.scene.runs[key] for key in keys if key in self.scene.runs), None)

    # Errors -------------------------------------------------------------------------------------------------------

    def measure(self, fineness, tolerance):
        """The errors of a pair; makes the runs that are missing, the cheapest first."""
        half, loose = fineness / 2, looser(tolerance)
        before = self.pairs[-1] if self.pairs else None
        known_steps = {}
        if before and before.tolerance <= tolerance and before.fineness < fineness:
            known_steps = {n: e.steps for n, e in before.errors.items() if e.steps < SMALL * self.accuracy}
        rough = None
        if not before or set(known_steps) != set(before.errors):
            rough = self.run(half, loose)
        coarse = self.run(half, tolerance)
        if not self.solve:
            self.measure_solve(half, loose)
        fine = self.run(fineness, tolerance, keep=True)
        if fine.histories.nodes == coarse.histories.nodes:
            raise _SameMesh
        errors = {}
        for name in self.answers(fine):
            steps = known_steps.get(name, np.inf) if rough is None else self.of_steps(rough, coarse, half, loose, name)
            mesh, order, falls = self.of_mesh(coarse, fine, steps, name)
            newton, stress = self.solve.get(name, (max((x for x, _ in self.solve.values()), default=0.0), 0.0))
            change = fine.histories.change(name)
            errors[name] = Error(change, steps, mesh, newton, stress, order, falls)
        if not errors:
            raise Failed(
                "no named point, plate or goal changes in the runs; give the scene a &point where something moves"
            )
        self.pairs.append(Pair(fineness, tolerance, errors, fine))

    def answers(self, run: Run) -> list[str]:
        if not self.goals:
            return run.histories.answers()
        for goal in self.goals:
            if goal not in run.histories.values and goal not in run.histories.forces:
                there = ", ".join([*run.histories.values, *run.histories.forces])
                raise Failed(f"there is no answer {goal}; there are {there}")
        return [g for g in self.goals if run.histories.change(g) > 0]

    def of_steps(self, rough, coarse, half, loose, name):
        """Error by the steps; where a third tolerance shows how fast distances fall, what that leaves of it."""
        last = distance(rough.histories, coarse.histories, name)
        rougher = self.known(half, looser(loose))
        if rougher is None or looser(loose) <= loose * 1.01:
            return last
        ratio = distance(rougher.histories, rough.histories, name) / max(last, 1e-300)
        return last * float(np.clip(1 / max(ratio - 1, 1e-3), LEAST_STEPS, MOST_STEPS))

    def of_mesh(self, coarse, fine, steps, name):
        """Error by the mesh, its order, and whether distances fall. Distances that fall by r leave last/(r - 1)."""
        last = distance(coarse.histories, fine.histories, name)
        fineness, tolerance = fine.key.fineness, fine.key.tolerance
        pairs = [
            (self.known(fineness / 4, a), self.known(fineness / 2, a))
            for a in sorted({key.tolerance for key in self.scene.runs}, key=lambda a: abs(np.log(a / tolerance)))
        ]
        pair = next(((a, b) for a, b in pairs if a and b and a.histories.nodes < b.histories.nodes), None)
        if pair is None or not all(name in run.histories.values or name in run.histories.forces for run in pair):
            return UNKNOWN_ORDER * last, USUAL_MESH, True
        ratio = distance(pair[0].histories, pair[1].histories, name) / max(last, 1e-300)
        order = float(np.clip(np.log2(max(ratio, 1e-3)), 0.5, 2))
        if ratio <= NOISE and last <= 2 * steps:  # steps of two meshes are not the same
            return last, order, True
        return last * float(np.clip(1 / max(ratio - 1, 1e-3), LEAST, MOST)), order, ratio > NOISE

    def measure_solve(self, fineness, tolerance):
        """Newton and stress integration, on the cheapest run; told apart only where their sum matters."""
        base = self.run(fineness, tolerance)
        names = self.answers(base)
        try:
            both = self.run(fineness, tolerance, 1, 1)
            self.solve = {n: (distance(base.histories, both.histories, n), 0.0) for n in names}
            if self.scene.list_of("mud") and max((x for x, _ in self.solve.values()), default=0) > self.accuracy / 10:
                newton = self.run(fineness, tolerance, 1, 0)
                self.solve = {
                    n: (distance(base.histories, newton.histories, n), distance(newton.histories, both.histories, n))
                    for n in names
                }
        except Failed as failure:
            # What cannot be measured is no zero: a third of what ten times the tolerance left, or of what may be left.
            self.scene.say(f"   a tenth of the tolerances cannot be run: {failure}")
            self.solve = self.expected_solve or {n: (SOLVE_SHARE * self.accuracy, 0.0) for n in names}

    # Search -------------------------------------------------------------------------------------------------------

    def search(self) -> Result:
        try:
            state, sentence = self._search()
        except BudgetUsedUp:
            state, sentence = BUDGET, "the budget ends before the next run does; the same command with more goes on"
        except _Localised as found:
            state = LOCALISED
            sentence = (
                f"{found.run.localised}; displacements there depend on the cell and have no limit that finer meshes "
                "reach: state the cell with the answer, or give the region a viscosity"
            )
        return Result(state, sentence, self.pairs)

    def _search(self):
        failure = "" if self.pairs else self._begin()
        if failure:
            return FAILS, failure
        while True:
            pair = self.pairs[-1]
            self._tell(pair)
            if pair.total <= self.accuracy:
                return MET, f"the total is below {share(self.accuracy)}"
            if self._stands_still():
                return NOT_CONVERGING, (
                    f"{pair.worst} changes as much from mesh to mesh, or from tolerance to tolerance, as before: "
                    "no finer run of these comes nearer"
                )
            following, why = self._following(pair)
            if following is None:
                return why
            try:
                self.measure(*following)
            except Failed as problem:
                self.scene.say(f"\n{problem}")

    def _begin(self):
        """The first pair that can be measured; else why none can."""
        # Of whole half decades, so that runs serve studies of several accuracies.
        tolerance = min(10 ** (round(2 * np.log10(self.accuracy)) / 2), LOOSEST / HALF_DECADE)
        coarse = can_halve(self.scene)
        first = None
        for fineness, a in (
            *(((1.0, tolerance),) if coarse else ()),
            (2.0, tolerance),
            (2.0, tolerance / HALF_DECADE),
            (2.0, tolerance / 10),
            (2.0, min(tolerance * HALF_DECADE, LOOSEST / HALF_DECADE)),
        ):
            try:
                if coarse == 2 and fineness == 1 and not self.known(0.25, a):
                    self._try(0.25, a)
                self.measure(fineness, a)
                return ""
            except Failed as failure:
                first = first or failure
            except _SameMesh:
                pass
        if first and first.code in REFUSED:
            raise InputError(str(first))
        return str(first or "finer meshes have the same nodes")

    def _try(self, *key):
        """A run for the order of the mesh, which need not come to its end."""
        try:
            self.run(*key)
        except Failed:
            pass

    def _stands_still(self):
        """Whether the last refinements of one kind made the error of the worst answer fall by less than a quarter, or
        the last two pairs tell more than one before them."""
        worst = self.pairs[-1].worst
        totals = [p.total for p in self.pairs]
        if len(totals) > 3 and min(totals[-2:]) > NOISE * min(totals[1:-2]):
            return True
        for part, kind in (("mesh", "fineness"), ("steps", "tolerance")):
            chain = [p for p in self.pairs if worst in p.errors]
            steps = []
            for a, b in zip(chain, chain[1:]):
                if getattr(a, kind) != getattr(b, kind):
                    steps.append(getattr(a.errors[worst], part) / max(getattr(b.errors[worst], part), 1e-300))
            last = getattr(chain[-1].errors[worst], part)
            if len(steps) >= 3 and max(steps[-3:]) <= NOISE and last > self.accuracy / 2:
                return True
            if len(steps) >= 2 and max(steps[-2:]) <= NOISE and self.accuracy / 2 < last < 0.2:
                return True
        return False

    def _following(self, pair):
        """The cheapest pair that is expected to hold the accuracy, else the one that comes nearest for its price."""
        cost, scene = Cost(scene_runs(self.scene)), self.scene
        solve = max(e.newton + e.stress for e in pair.errors.values())
        tighter = solve > SOLVE_SHARE * self.accuracy and self.tight < 2
        if tighter:
            scene.say(f"Newton's method and the stress integration leave {share(solve)}: a tenth of their tolerances")
            self.tight += 1
            before, self.solve = self.solve, {}
            self.expected_solve = {n: (x / 3, y / 3) for n, (x, y) in before.items()}
            less = {n: replace(e, newton=e.newton / 3, stress=e.stress / 3) for n, e in pair.errors.items()}
            pair = replace(pair, errors=less)  # what is expected; what was measured stays
            if pair.total <= 0.9 * self.accuracy:
                return (pair.fineness, pair.tolerance), None
        tries, dear = [], False
        for f in (pair.fineness, 2 * pair.fineness):
            for a in (pair.tolerance * HALF_DECADE, pair.tolerance, pair.tolerance / HALF_DECADE, pair.tolerance / 10):
                if a > LOOSEST / HALF_DECADE * 1.01 or (f, a) == (pair.fineness, pair.tolerance):
                    continue
                keys = [self.key(*x) for x in ((f / 2, looser(a)), (f / 2, a), (f, a))]
                missing = [k for k in keys if k not in scene.runs]
                if not missing or any(k in scene.failed for k in missing):
                    continue
                seconds = sum(cost(k.fineness, k.tolerance) for k in missing)
                worst = self.foreseen(pair, f, a)
                if seconds > scene.left:
                    dear = True
                else:
                    tries.append((worst, seconds, f, a))
        held = [x for x in tries if x[0] < 0.9 * self.accuracy]
        if not held:
            tries = [x for x in tries if x[0] < 0.9 * pair.total]
        if not tries:
            if dear:
                return None, (BUDGET, "every run that would come nearer ends after the budget")
            failed = [str(x) for x in scene.failed.values()]
            return None, (FAILS, failed[-1] if failed else "no run that is left comes nearer")
        if held:
            best = min(held, key=lambda x: x[1])
        else:
            best = min(tries, key=lambda x: np.log(x[0] / pair.total) + 0.15 * np.log(max(x[1], 1e-3)))
        left = f", {scene.left:.0f} s left" if scene.left < float("inf") else ""
        scene.say(
            f"next: fineness {best[2]:g}, step tolerance {best[3]:.2g}, about {best[1]:.2g} s{left}; "
            f"expected {share(best[0])}"
        )
        return best[2:], None

    def key(self, fineness, tolerance) -> Key:
        """Of a run with the tolerances of Newton and the stress integration as they are now."""
        return _key(fineness, tolerance, self.tight, self.tight * bool(self.scene.list_of("mud")))

    def finenesses(self):
        """Meshes of the front: that of the finest pair, half of it and twice."""
        return [self.pairs[-1].fineness * x for x in (0.5, 1, 2)]

    def foreseen(self, pair, f, a):
        """Total of the worst answer that is expected of another pair."""
        return max(
            e.mesh * (pair.fineness / f) ** e.order
            + e.steps * (a / pair.tolerance) ** USUAL_STEPS
            + e.newton
            + e.stress
            for e in pair.errors.values()
        )

    def front(self, fineness):
        """Time and expected error of runs on a mesh."""
        cost, pair = Cost(scene_runs(self.scene)), self.pairs[-1]
        steps = pair.tolerance * HALF_DECADE ** np.arange(2, -3, -1)
        return [(cost(fineness, a), self.foreseen(pair, fineness, a)) for a in steps if a < LOOSEST / 2]

    def expected(self, accuracy):
        """The cheapest pair that is expected to hold an accuracy, its total and time; at most 16 times the cells."""
        cost, pair = Cost(scene_runs(self.scene)), self.pairs[-1]
        tries = [
            (cost(f, a), f, a, self.foreseen(pair, f, a))
            for f in pair.fineness * 2.0 ** np.arange(0, 5)
            for a in pair.tolerance * HALF_DECADE ** np.arange(1, -9, -1.0)
            if a < LOOSEST / 2
        ]
        held = [x for x in tries if x[3] < 0.9 * accuracy]
        if not held:
            return None
        seconds, f, a, total = min(held)
        return f, a, total, seconds

    def _tell(self, pair):
        e = pair.errors[pair.worst]
        self.scene.say(f"fineness {pair.fineness:g}, step tolerance {pair.tolerance:.2g}: {pair.worst} {sum_of(e)}")


class _Localised(Exception):
    def __init__(self, run):
        super().__init__(run.localised)
        self.run = run


class _SameMesh(Exception):
    pass


class Cost:
    """Time of a run c F^p a^-q from the runs made; p and q are drawn to 2.3 and 0.35 where these do not show them."""

    def __init__(self, runs):
        rows = [
            (1, np.log(r.key.fineness), -np.log(r.key.tolerance), np.log(max(r.processor, 1e-3)), r.key.fineness)
            for r in runs
        ]
        rows = np.array([*rows, (0, 0.3, 0, 0.3 * 2.3, 1), (0, 0, 0.3, 0.3 * 0.35, 1)])
        weight = rows[:, 4:] ** 0.5
        fit = np.linalg.lstsq(rows[:, :3] * weight, rows[:, 3] * weight[:, 0], rcond=None)[0]
        self.fit = np.array([fit[0], np.clip(fit[1], 1, 3.5), np.clip(fit[2], 0.1, 0.7)])
        # Through the largest run, where the orders had to be bounded; by the clock, as the budget is.
        last, largest = max(zip(rows[:-2], runs), key=lambda pair: pair[0][3])
        self.fit[0] += last[3] - self.fit @ last[:3] + np.log(largest.seconds / max(largest.processor, 1e-3))

    def __call__(self, fineness, tolerance):
        return float(np.exp(self.fit @ (1, np.log(fineness), -np.log(tolerance))))


def scene_runs(scene):
    """Runs that show what meshes and steps cost."""
    return [r for k, r in scene.runs.items() if k.newton <= k.stress or not k.newton]


def looser(tolerance):
    return min(tolerance * HALF_DECADE, LOOSEST)


def _key(fineness, tolerance, newton, stress):
    return Key(float(f"{fineness:.6g}"), float(f"{tolerance:.4g}"), newton, stress)


def can_halve(scene) -> int:
    """Whether half the cells along each axis are a mesh of the same family: 0, 1, or 2 where a quarter is, too."""
    mesh = scene.list_of("mesh")[0]
    if "file" in mesh:
        return 0
    can = 2
    for axis in ("r_cells", "z_cells"):
        cells = mesh.get(axis, 1)
        cells = cells if isinstance(cells, list) else [cells]
        if len(cells) > 1 or cells[0] > 1:  # an axis of one cell is a column: nothing is refined by halving others
            can = min(can, 2 if min(cells) >= 4 else int(min(cells) >= 2))
    return can if any(np.ravel(mesh.get(a, 1)).max() > 1 for a in ("r_cells", "z_cells")) else 0


def share(x: float) -> str:
    """A share in per cent, two digits."""
    return f"{100 * x:.0f} %" if x >= 1 else f"{100 * x:.2g} %"


def sum_of(e: Error) -> str:
    """The line of an answer."""
    return (
        f"total {share(e.total)} = mesh {share(e.mesh)} + steps {share(e.steps)} + Newton {share(e.newton)} + "
        f"stress integration {share(e.stress)}"
    )


def write_table(path, pair: Pair):
    """accuracy.csv: the largest first; change in the unit of the answer, errors as shares of it."""
    rows = sorted(pair.errors.items(), key=lambda item: -item[1].total)
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("answer", "change", "steps", "mesh", "newton", "stress", "total"))
        for name, e in rows:
            writer.writerow((name, *(f"{x:.4g}" for x in (e.change, e.steps, e.mesh, e.newton, e.stress, e.total))))
