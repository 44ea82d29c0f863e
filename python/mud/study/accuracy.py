# SPDX-License-Identifier: MIT
"""Errors of a scene, measured: runs on meshes and with tolerances that differ, and the differences of their histories.

A pair (F, a) is a run with F times the cells along each axis and steps of tolerance a. Its errors are

- mesh: what the difference of (F, a) and (F/2, a) leaves, and those of coarser meshes before it;
- steps: what the difference of (F/2, a) and (F/2, sqrt(10) a) leaves, on the coarser mesh, for a sixth of the time;
- Newton, stress integration: difference of the cheapest run and the same with a tenth of these tolerances.

Their sum is the error told. Pairs are refined until the sum of every answer is below what is asked.
"""

from __future__ import annotations

import contextlib
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from .histories import difference, distance
from .runs import LOOSEST, BudgetUsedUp, Failed, Key, Run, Scene, write_csv

HALF_DECADE = 10**0.5
NOISE = 4 / 3  # differences that fall by less from mesh to mesh show no limit
# Differences that fall by r leave last/(r - 1). One ratio shows r poorly: beyond the first of these it counts as far as
# the ratio before it agrees, up to the second. They are orders 2 and 4 of meshes, and 1 of steps.
MESH, STEPS = (4.0, 16.0), (HALF_DECADE, HALF_DECADE)
MOST = 2.0  # times the last difference, however slowly they fall
UNKNOWN_MESH, UNKNOWN_STEPS = 0.5, 0.75  # of the last difference, where no ratio is known
USUAL_MESH, USUAL_STEPS = 1.5, 0.8  # orders in the cells and the tolerance, to choose the next pair
ENOUGH = 0.9  # of what is asked: a pair that is expected to hold so much is worth its runs
LEAST_FINER = 1.01  # how much less steps err at least, from one tolerance to the next: of as many, rounding moves some
SMALL = 1 / 30  # of what is asked: steps that err less on one mesh are not measured again on the next
FINEST_OF_FILE = 8  # times the cells of a mesh of a file: mud_host splits triangles thrice
SOLVE_SHARE = 1 / 3  # of what is asked: from here on Newton's method and the stress integration are tightened

NO_ANSWER = -1  # a run whose answers do not change, or are not there
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


class Study:
    """The search for the cheapest run that holds an accuracy; `state` and `sentence` say how it ended. The last pair is
    the finest: what a rougher one told is contradicted where that tells more."""

    def __init__(self, scene: Scene, accuracy: float, goals: list[str] | None = None):
        self.scene, self.accuracy, self.state, self.sentence = scene, accuracy, "", ""
        self.goals = goals or np.ravel(scene.list_of("scene")[0].get("goals", [])).tolist()
        self.pairs: list[Pair] = []
        self.finest = FINEST_OF_FILE if "file" in scene.list_of("mesh")[0] else np.inf
        # Straight paths of linear soil without time have no error by steps.
        stages, fields = scene.list_of("stage"), str(scene.list_of("scene")[0].get("fields", "u")).lower()
        self.steps_matter = (
            fields != "u" or bool({"mud", "umat", "contact"} & set(scene.groups))
            or any(str(stage.get("analysis")).lower() == "dynamic" for stage in stages)
            or any(region.get("viscosity") for region in scene.list_of("region"))
        )
        self.tight = 0  # tenths of the tolerances of Newton and the stress integration, of all runs
        self.solve: dict[str, tuple[float, float]] = {}  # errors by Newton and the stress integration, by answer
        self.expected_solve: dict[str, tuple[float, float]] = {}  # the same where they cannot be measured

    # Runs ---------------------------------------------------------------------------------------------------------

    def run(self, fineness, tolerance, newton=0, stress=0, keep=False) -> Run:
        run = self.scene.run(fineness, tolerance, self.tight + newton, self.tight + stress, keep=keep)
        if run.localised:
            raise _Localised(run)
        return run

    def known(self, fineness, tolerance) -> Run | None:
        """A run that was made, the tightest, to see how fast differences fall."""
        keys = (Key.of(fineness, tolerance, n, n) for n in range(self.tight, -1, -1))
        return next((self.scene.runs[key] for key in keys if key in self.scene.runs), None)

    # Errors -------------------------------------------------------------------------------------------------------

    def measure(self, fineness, tolerance):
        """The errors of a pair; makes the runs that are missing, the cheapest first."""
        half, loose = fineness / 2, looser(tolerance)
        before, known_steps, rough = self.pairs[-1] if self.pairs else None, {}, None
        if before and before.tolerance <= tolerance and before.fineness < fineness:
            known_steps = {n: e.steps for n, e in before.errors.items() if e.steps < SMALL * self.accuracy}
        if not before or set(known_steps) != set(before.errors):
            rough = self.run(half, loose)
        coarse = self.run(half, tolerance)
        self.answers(coarse)
        if not self.solve:
            self.measure_solve(half, loose)
        fine = self.run(fineness, tolerance, keep=True)
        if fine.histories.nodes == coarse.histories.nodes:
            raise Failed("finer meshes have the same nodes")
        errors = {}
        for name in self.answers(fine):
            steps = self.of_steps(rough, coarse, name) if rough else known_steps.get(name, np.inf)
            mesh, order = self.of_mesh(coarse, fine, steps, name)
            newton, stress = self.solve.get(name, (max((x for x, _ in self.solve.values()), default=0.0), 0.0))
            errors[name] = Error(fine.histories.change(name), steps, mesh, newton, stress, order)
        self.pairs.append(Pair(fineness, tolerance, errors, fine))

    def answers(self, run: Run) -> list[str]:
        for goal in self.goals:
            if not run.histories.has(goal):
                there = ", ".join([*run.histories.values, *run.histories.forces])
                raise Failed(f"there is no answer {goal}; there are {there}", NO_ANSWER)
        names = [g for g in self.goals if run.histories.moves(g)] if self.goals else run.histories.answers()
        if not names:
            words = "no named point, plate or goal changes in the runs; give the scene a &point where something moves"
            raise Failed(words, NO_ANSWER)
        return names

    def of_steps(self, rough, coarse, name):
        """Error by the steps, from tolerances on the coarser mesh. Where other things keep steps short (dt_max, kinks,
        growth) their number grows by less than it should, and with its square what a difference says of the error."""
        differences, unseen = [difference(rough.histories, coarse.histories, name)], 1.0
        if self.steps_matter:
            finer = (coarse.histories.steps / rough.histories.steps) ** 2
            if not differences[0].size and finer <= 1:
                return 1.0  # The same steps say nothing.
            unseen = (HALF_DECADE - 1) / (min(max(finer, LEAST_FINER), HALF_DECADE) - 1)
        rougher = self.known(rough.key.fineness, looser(rough.key.tolerance))
        if rougher and rougher is not rough:
            differences.append(difference(rougher.histories, rough.histories, name))
        return unseen * left(differences, UNKNOWN_STEPS, STEPS)

    def of_mesh(self, coarse, fine, steps, name):
        """Error by the mesh, and its order."""
        differences, fineness = [difference(coarse.histories, fine.histories, name)], fine.key.fineness / 2
        while found := self.of_halving(fineness, fine.key.tolerance, name):
            differences, fineness = [*differences, found], fineness / 2
        if len(differences) < 2:
            return left(differences, UNKNOWN_MESH, MESH), USUAL_MESH
        last, ratio = differences[0].size, differences[1].size / max(differences[0].size, 1e-300)
        noise = ratio <= NOISE and last <= 2 * steps  # steps of two meshes are not the same
        return last if noise else left(differences, UNKNOWN_MESH, MESH), float(np.clip(np.log2(ratio + 1e-3), 0.5, 2))

    def of_halving(self, fineness, tolerance, name):
        """Difference of half the cells and a mesh, at the tolerance that is nearest; nothing if none is known."""
        tolerances = {key.tolerance for key in self.scene.runs}
        for a in sorted(tolerances, key=lambda a: abs(np.log(a / tolerance))):
            pair = self.known(fineness / 2, a), self.known(fineness, a)
            if all(pair) and pair[0].histories.nodes < pair[1].histories.nodes:
                if all(run.histories.has(name) for run in pair):
                    return difference(pair[0].histories, pair[1].histories, name)
        return None

    def measure_solve(self, fineness, tolerance):
        """Newton and stress integration, on the cheapest run; told apart only where their sum matters."""
        base = self.run(fineness, tolerance)
        names = self.answers(base)
        try:
            both = newton = self.run(fineness, tolerance, 1, 1)
            if self.scene.list_of("mud"):
                if max((distance(base.histories, both.histories, n) for n in names), default=0) > self.accuracy / 10:
                    newton = self.run(fineness, tolerance, 1, 0)
            self.solve = {n: (distance(base.histories, newton.histories, n),
                              distance(newton.histories, both.histories, n)) for n in names}
        except Failed as failure:
            # What cannot be measured is no zero: a third of what ten times the tolerance left, or of what may be left.
            self.scene.say(f"   a tenth of the tolerances cannot be run: {failure}")
            self.solve = self.expected_solve or {n: (SOLVE_SHARE * self.accuracy, 0.0) for n in names}

    # Search -------------------------------------------------------------------------------------------------------

    def search(self):
        try:
            self.state, self.sentence = self._search()
        except BudgetUsedUp:
            self.state = BUDGET
            self.sentence = "the budget ends before the next run does; the same command with more goes on"
        except _Localised as found:
            self.state, self.sentence = LOCALISED, found.run.localised

    def _search(self):
        failure = "" if self.pairs else self._begin()
        if failure:
            return FAILS, failure
        while True:
            pair = self.pairs[-1]
            self.scene.say(f"fineness {pair.fineness:g}, step tolerance {pair.tolerance:.2g}: {pair.worst} "
                           f"{sum_of(pair.errors[pair.worst])}")
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
        coarse, first = can_halve(self.scene), None
        for fineness, times in ((1.0, 1), (2.0, 1), (2.0, 1 / HALF_DECADE), (2.0, 0.1), (2.0, HALF_DECADE)):
            if fineness == 1 and not coarse:
                continue
            try:
                if coarse == 2 and fineness == 1:
                    with contextlib.suppress(Failed):  # for the order of the mesh
                        self.run(0.25, tolerance)
                self.measure(fineness, min(times * tolerance, LOOSEST / HALF_DECADE))
                return ""
            except Failed as failure:
                first = first or failure
                # A scene that is refused with its own cells is refused at every tolerance.
                if failure.code == NO_ANSWER or failure.code in REFUSED and fineness == 2:
                    break
        if first.code in REFUSED:
            raise InputError(str(first))
        return str(first)

    def _stands_still(self):
        """Whether the last refinements of one kind made the error of the worst answer fall by less than a quarter, or
        the last two pairs tell more than one before them."""
        worst, totals = self.pairs[-1].worst, [p.total for p in self.pairs]
        if len(totals) > 3 and min(totals[-2:]) > NOISE * min(totals[1:-2]):
            return True
        chain = [p for p in self.pairs if worst in p.errors]
        for part, finer in (
            ("mesh", lambda p, q: q.fineness > p.fineness),
            ("steps", lambda p, q: q.tolerance < p.tolerance),
        ):
            errors = [getattr(p.errors[worst], part) for p in chain]
            falls = [a / max(b, 1e-300) for a, b, p, q in zip(errors, errors[1:], chain, chain[1:]) if finer(p, q)]
            # Large errors fall late: they may stand still once more.
            needed = 2 if errors[-1] < 0.2 else 3
            if len(falls) >= needed and max(falls[-needed:]) <= NOISE and errors[-1] > self.accuracy / 2:
                return True
        return False

    def _following(self, pair):
        """The cheapest pair that is expected to hold the accuracy, else the one that comes nearest for its price."""
        cost, scene = Cost(scene_runs(self.scene)), self.scene
        solve = max(e.newton + e.stress for e in pair.errors.values())
        if solve > SOLVE_SHARE * self.accuracy and self.tight < 2:
            scene.say(f"Newton's method and the stress integration leave {share(solve)}: a tenth of their tolerances")
            self.tight += 1
            self.expected_solve = {n: (x / 3, y / 3) for n, (x, y) in self.solve.items()}
            self.solve = {}
            less = {n: replace(e, newton=e.newton / 3, stress=e.stress / 3) for n, e in pair.errors.items()}
            pair = replace(pair, errors=less)  # what is expected; what was measured stays
            if pair.total <= ENOUGH * self.accuracy:
                return (pair.fineness, pair.tolerance), None
        tries, dear = [], False
        for f in (x for x in (pair.fineness, 2 * pair.fineness) if x <= self.finest):
            for a in pair.tolerance * np.array([HALF_DECADE, 1, 1 / HALF_DECADE, 0.1]):
                keys = [self.key(*x) for x in ((f / 2, looser(a)), (f / 2, a), (f, a))]
                missing = [k for k in keys if k not in scene.runs]
                if a > LOOSEST / HALF_DECADE * 1.01 or not missing or any(k in scene.failed for k in missing):
                    continue
                seconds = sum(cost(k.fineness, k.tolerance) for k in missing)
                dear = dear or seconds > scene.left
                if seconds <= scene.left:
                    tries.append((self.foreseen(pair, f, a), seconds, f, float(a)))
        held = [x for x in tries if x[0] < ENOUGH * self.accuracy]
        tries = held or [x for x in tries if x[0] < ENOUGH * pair.total]
        if not tries:
            if dear:
                return None, (BUDGET, "every run that would come nearer ends after the budget")
            failed = [str(x) for x in scene.failed.values()]
            return None, (FAILS, failed[-1] if failed else "no run that mud_host can make comes nearer")
        rank = (lambda x: x[1]) if held else lambda x: np.log(x[0] / pair.total) + 0.15 * np.log(max(x[1], 1e-3))
        total, seconds, f, a = min(tries, key=rank)
        scene.say(f"next: fineness {f:g}, step tolerance {a:.2g}, about {seconds:.2g} s, {scene.left:.0f} s left; "
                  f"expected {share(total)}")
        return (f, a), None

    def key(self, fineness, tolerance) -> Key:
        """Of a run with the tolerances of Newton and the stress integration as they are now."""
        return Key.of(fineness, tolerance, self.tight, self.tight)

    def foreseen(self, pair, f, a):
        """Total of the worst answer that is expected of another pair."""
        steps = (a / pair.tolerance) ** USUAL_STEPS
        return max(e.mesh * (pair.fineness / f) ** e.order + e.steps * steps + e.newton + e.stress
                   for e in pair.errors.values())

    def expected(self, accuracy):
        """The cheapest pair that is expected to hold an accuracy, its total and time; at most 16 times the cells."""
        cost, pair = Cost(scene_runs(self.scene)), self.pairs[-1]
        tries = [
            (cost(f, a), f, a, self.foreseen(pair, f, a))
            for f in pair.fineness * 2.0 ** np.arange(0, 5)
            for a in pair.tolerance * HALF_DECADE ** np.arange(1, -9, -1.0)
            if a < LOOSEST / 2 and f <= self.finest
        ]
        seconds, f, a, total = min((x for x in tries if x[3] < ENOUGH * accuracy), default=(None,) * 4)
        return (f, a, total, seconds) if seconds else None


class _Localised(Exception):
    def __init__(self, run):
        super().__init__(run.localised)
        self.run = run


class Cost:
    """Time of a run c F^p a^-q from the runs made; p and q are drawn to 2.3 and 0.35 where these do not show them."""

    def __init__(self, runs):
        rows = [(1, np.log(r.key.fineness), -np.log(r.key.tolerance), np.log(max(r.seconds, 1e-3)), r.key.fineness)
                for r in runs]
        rows = np.array([*rows, (0, 0.3, 0, 0.3 * 2.3, 1), (0, 0, 0.3, 0.3 * 0.35, 1)])
        weight = rows[:, 4:] ** 0.5
        fit = np.linalg.lstsq(rows[:, :3] * weight, rows[:, 3] * weight[:, 0], rcond=None)[0]
        self.fit = np.array([fit[0], np.clip(fit[1], 1, 3.5), np.clip(fit[2], 0.1, 0.7)])
        # Through the largest run, where the orders had to be bounded.
        last = max(rows[:-2], key=lambda row: row[3])
        self.fit[0] += last[3] - self.fit @ last[:3]

    def __call__(self, fineness, tolerance):
        return float(np.exp(self.fit @ (1, np.log(fineness), -np.log(tolerance))))


def scene_runs(scene):
    """Runs that show what meshes and steps cost."""
    return [r for k, r in scene.runs.items() if k.newton <= k.stress]


def left(differences, unknown, bounds):
    """What the last of differences, which comes first, leaves after it."""
    last, *before = differences
    if not before:
        return unknown * last.size
    ratios = [b.size / max(a.size, 1e-300) for a, b in zip(differences, before)]
    turns = [a.against(b) for a, b in zip(differences, before)]
    if turns[0]:  # it may be small by chance, and shows no order
        return max(last.size, before[0].size / bounds[0])
    support = max(bounds[0], ratios[1]) if turns[1:] and not turns[1] else bounds[0]
    return last.size * min(1 / max(min(ratios[0], support, bounds[1]) - 1, 1e-3), MOST)


def looser(tolerance):
    return min(tolerance * HALF_DECADE, LOOSEST)


def can_halve(scene) -> int:
    """Whether half the cells along each axis are a mesh of the same family: 0, 1, or 2 where a quarter is, too."""
    mesh = scene.list_of("mesh")[0]
    cells = [np.ravel(mesh.get(axis, 1)) for axis in ("r_cells", "z_cells")]
    # An axis of one cell is a column: nothing is refined by halving others.
    least = [c.min() for c in cells if c.size > 1 or c[0] > 1]
    return 0 if "file" in mesh or not least else min(2, int(np.log2(min(least))))


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
    write_csv(path, ("answer", "change", "steps", "mesh", "newton", "stress", "total"),
              [(name, e.change, e.steps, e.mesh, e.newton, e.stress, e.total) for name, e in rows])
