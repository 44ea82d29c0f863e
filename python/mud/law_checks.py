# SPDX-License-Identifier: MIT
"""What can be asked of any law at a point: each check is a function of the law and gives findings.

Every check runs in a process of its own (``law_under_test.apart``). A path is a list of strain increments.
"""

from __future__ import annotations

import ctypes
import sys
import textwrap
import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .law_under_test import Answer, Ended, Law, apart
from .namelist import quoted

PASS, NOTE, FAULT, UNJUDGED = "pass", "note", "fault", "not judged"
_EPS = 1e-30


@dataclass
class Finding:
    """The outcome of one check. ``curves``: label -> (x, y), for its picture; ``case``: text for mud_triax."""

    check: str
    verdict: str
    sentence: str
    value: float | None = None
    curves: dict[str, tuple[list[float], list[float]]] = field(default_factory=dict)
    axes: tuple[str, str] = ("", "")
    case: str = ""


@dataclass
class Setting:
    """Where the checks begin and how far they go."""

    stress: np.ndarray  # six components, tension positive
    reach: float = 1e-2  # largest strain of a path
    increments: int = 100
    direction: tuple[float, ...] = (0.35, 0.35, -1.0, 0.3, 0.2, -0.1)

    @property
    def step(self) -> np.ndarray:
        return np.array(self.direction) * self.reach / self.increments

    @property
    def size(self) -> float:
        """Of stresses: what differences are compared with."""
        return max(float(np.abs(self.stress).max()), _EPS)


class Refusal(Exception):
    """The law refused an increment of a path that a check needs."""


def norm(a: Any) -> float:
    return float(np.sqrt((np.asarray(a) ** 2).sum()))


@dataclass
class Point:
    """A point on its way: stress, state, strain so far."""

    stress: np.ndarray
    state: np.ndarray
    strain: np.ndarray
    time: float = 0.0
    tangent: np.ndarray | None = None

    def copy(self) -> Point:
        return Point(self.stress.copy(), self.state.copy(), self.strain.copy(), self.time, self.tangent)


def step(law: Law, point: Point, d_strain: np.ndarray, dt: float = 1.0, rotation: np.ndarray | None = None) -> Answer:
    """One increment from a point, at its time."""
    return law.call(point.stress, point.state, d_strain, point.strain, rotation, dt, point.time)


def start_of(law: Law, at: Setting) -> Point:
    """A point before its first call."""
    return Point(at.stress.copy(), law.begin(), np.zeros(6))


def begin(law: Law, at: Setting) -> Point:
    """A point after the call without strain that hosts make first."""
    return go(law, start_of(law, at), [np.zeros(6)])


def go(law: Law, point: Point, path: Iterable[np.ndarray], dt: float = 1.0) -> Point:
    """The point after a path; the one given is not changed."""
    point = point.copy()
    for i, d_strain in enumerate(path):
        answer = step(law, point, d_strain, dt)
        if answer.refused:
            how = f"was refused (PNEWDT {answer.pnewdt:g})" if answer.cut else "gave numbers that are not finite"
            raise Refusal(f"increment {i + 1} of a path {how}")
        point = Point(answer.stress, answer.state, point.strain + d_strain, point.time + dt, answer.tangent)
    return point


def way(law: Law, point: Point, path: Iterable[np.ndarray]) -> list[Point]:
    """All points of a path, the first included."""
    points = [point]
    for d_strain in path:
        points.append(go(law, points[-1], [d_strain]))
    return points


def deviator(stress: np.ndarray) -> float:
    s = np.array(stress, dtype=float)
    s[:3] -= s[:3].mean()
    return float(np.sqrt(1.5 * ((s[:3] ** 2).sum() + 2.0 * (s[3:] ** 2).sum())))


def straight(at: Setting, n: int | None = None, factor: float = 1.0) -> list[np.ndarray]:
    return [factor * at.step] * (at.increments if n is None else n)


# --- the checks -------------------------------------------------------------------------------------------------------


def first_call(law: Law, at: Setting) -> list[Finding]:
    """STATEV as the host gives them, no strain: nothing moves, and the tangent can be factorised."""
    name = "first call"
    start = law.begin()
    one = law.call(at.stress, start, np.zeros(6))
    if one.refused:
        sentence = "the first call, without strain, is refused or gives a stress or STATEV that is not finite"
        return [Finding(name, FAULT, sentence)]
    out = []
    told = law.told()
    if told is not None and told.non_symmetric == 0 and norm(one.tangent - one.tangent.T) > 1e-6 * norm(one.tangent):
        out.append(Finding(name, FAULT, "D is not symmetric, but the law says it is (IDTASK 5): PLAXIS uses half of it"))
    moved = norm(one.stress - at.stress) / at.size
    if moved > 1e-9:
        out.append(Finding(name, NOTE, "the first call moves the stress without a strain", moved))
    part = one.tangent[np.ix_(law._places(), law._places())]
    if not np.isfinite(part).all() or norm(part) == 0.0 or np.linalg.matrix_rank(part) < len(part):
        out.append(Finding(name, FAULT, "DDSDDE of the first call is zero, singular or not finite: hosts factorise it"))
    elif part.diagonal().min() < 0.0:
        sentence = "DDSDDE of the first call answers a strain by a stress of the other sign (tension is positive)"
        out.append(Finding(name, FAULT, sentence, part.diagonal().min()))
    two = law.call(one.stress, one.state, np.zeros(6))
    moved = norm(two.stress - one.stress) / at.size
    if two.refused or moved > 1e-9:
        out.append(Finding(name, FAULT, "a second call without strain moves the stress", moved))
    return out or [Finding(name, PASS, "zeros in STATEV and no strain leave the stress, with a regular DDSDDE")]


def rest(law: Law, at: Setting) -> list[Finding]:
    """An increment without strain in the middle of a path."""
    mid = go(law, begin(law, at), straight(at, at.increments // 2))
    moved = norm(go(law, mid, [np.zeros(6)]).stress - mid.stress) / at.size
    if moved > 1e-9:
        verdict = FAULT if moved > 1e-3 else NOTE
        return [Finding("rest", verdict, "an increment without strain moves the stress", moved)]
    return [Finding("rest", PASS, "an increment without strain leaves the stress", moved)]


def arrays(law: Law, at: Setting) -> list[Finding]:
    """What the law writes: its own arrays, and nothing else."""
    broken: set[str] = set()
    point = begin(law, at)
    broken.update(law.call(at.stress, law.begin(), np.zeros(6)).broken)
    for d in straight(at):
        answer = step(law, point, d)
        broken.update(answer.broken)
        if answer.refused:
            break
        point = Point(answer.stress, answer.state, point.strain + d, point.time + 1.0)
    if broken:
        return [Finding("arrays", FAULT, "written although it is not the law's to write: " + ", ".join(sorted(broken)))]
    return [Finding("arrays", PASS, "nothing but stress, state and tangent is written")]


def _ends(law: Law, at: Setting, path: list[np.ndarray]) -> np.ndarray:
    return go(law, begin(law, at), path).stress


def _interleaved(law: Law, other: Law, at: Setting, path: list[np.ndarray], path_2: list[np.ndarray]) -> Any:
    a, b = begin(law, at), begin(other, at)
    for one, two in zip(path, path_2):
        a, b = go(law, a, [one]), go(other, b, [two])
    return a.stress, b.stress


def _same(one: np.ndarray, two: np.ndarray) -> bool:
    return bool(np.array_equal(one, two))


def points_side_by_side(law: Law, at: Setting) -> list[Finding]:
    """Two points in turn, and each alone in a process of its own: the same bits."""
    path, path_2 = straight(at), [-0.7 * at.step[[2, 0, 1, 4, 5, 3]]] * at.increments
    alone = apart(_ends, law, at, path), apart(_ends, law, at, path_2)
    both = apart(_interleaved, law, law, at, path, path_2)
    if _same(alone[0], both[0]) and _same(alone[1], both[1]):
        return [Finding("two points", PASS, "two points updated in turn give the bits of each alone")]
    apart_by = max(norm(a - b) for a, b in zip(alone, both)) / at.size
    return [
        Finding(
            "two points",
            FAULT,
            "two points updated in turn disturb each other: something is kept between calls",
            apart_by,
        )
    ]


def two_materials(law: Law, at: Setting) -> list[Finding]:
    """Two materials in turn: PROPS that differ by 0.1 %."""
    other = law.like(props=[p if float(p).is_integer() and abs(p) < 10 else 1.001 * p for p in law.props])
    path = straight(at)
    own = apart(_ends, law, at, path)
    try:
        alone = own, apart(_ends, other, at, path)
    except Refusal:
        return [Finding("two materials", UNJUDGED, "PROPS that differ by 0.1 % are refused")]
    both = apart(_interleaved, law, other, at, path, path)
    if _same(alone[0], alone[1]):
        return [Finding("two materials", UNJUDGED, "PROPS that differ by 0.1 % make no difference")]
    if _same(alone[0], both[0]) and _same(alone[1], both[1]):
        return [Finding("two materials", PASS, "two materials in turn give the bits of each alone")]
    return [Finding("two materials", FAULT, "of two materials in one process the second has properties of the first")]


def _second_half(law: Law, point: Point, path: list[np.ndarray]) -> np.ndarray:
    return go(law, point, path).stress


def _halfway(law: Law, at: Setting, n: int) -> Point:
    return go(law, begin(law, at), straight(at, n))


def continued(law: Law, at: Setting) -> list[Finding]:
    """A restart: stress and STATEV in the middle of a path, taken up by another process."""
    n = at.increments // 2
    whole = apart(_ends, law, at, straight(at, 2 * n))
    taken_up = apart(_second_half, law, apart(_halfway, law, at, n), straight(at, n))
    if _same(whole, taken_up):
        return [Finding("restart", PASS, "stress and STATEV are all that a path needs to go on in another process")]
    return [
        Finding(
            "restart",
            FAULT,
            "a path that is taken up in another process ends elsewhere: the law keeps more than STATEV",
            norm(whole - taken_up) / at.size,
        )
    ]


def threads(law: Law, at: Setting, count: int = 4, rounds: int = 30, bouts: int = 3) -> list[Finding]:
    """Several threads, each with a point of its own; again where nothing is found, since on a busy machine threads may
    run one after the other."""
    paths = [straight(at, 50, 1.0 - 0.15 * i) for i in range(count)]
    law.load()
    alone = [_ends(law, at, path) for path in paths]
    wrong = []

    def work(i: int) -> None:
        for _ in range(rounds):
            try:
                if not _same(_ends(law, at, paths[i]), alone[i]):
                    wrong.append(i)
            except Refusal:
                wrong.append(i)

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    tried = 0
    for _ in range(bouts):
        workers = [threading.Thread(target=work, args=(i,)) for i in range(count)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        tried += count * rounds
        if wrong:
            break
    sys.setswitchinterval(interval)
    if wrong:
        return [
            Finding("threads", FAULT, f"{len(wrong)} of {tried} paths in {count} threads end elsewhere", len(wrong))
        ]
    return [Finding("threads", PASS, f"{tried} paths in {count} threads give the bits of one thread")]


def increments(law: Law, at: Setting) -> list[Finding]:
    """A strain of a tenth of the reach in 1, 10, 100 and 1000 increments, from the start and from a point under way."""
    out, curves = [], {}
    worst, worst_at_ten, whence = 0.0, 0.0, None
    for label, before in (("from the start", 0), ("under way", at.increments // 2)):
        start = go(law, begin(law, at), straight(at, before))
        total = at.step * at.increments / 10
        ends = {}
        for n in (1, 10, 100, 1000):
            try:
                ends[n] = go(law, start, [total / n] * n).stress
            except Refusal:
                if n > 1:
                    raise
        moved = max(norm(ends[1000] - start.stress), 1e-12 * at.size)
        errors = {n: norm(end - ends[1000]) / moved for n, end in ends.items() if n < 1000}
        curves[label] = ([1.0 / n for n in errors], [max(e, 1e-16) for e in errors.values()])
        worst = max(worst, errors.get(1, 0.0))
        if whence is None or errors[10] > worst_at_ten:
            worst_at_ten, whence = errors[10], start
        if 1 not in ends:
            out.append(Finding("increments", NOTE, f"{label}: the strain in one increment is refused"))
    size = at.reach / 100
    verdict = PASS if worst_at_ten < 0.01 else NOTE if worst_at_ten < 0.05 else FAULT
    out.append(
        Finding(
            "increments",
            verdict,
            f"increments of {size:g} are {100 * worst_at_ten:.2g} % off those of {size / 100:g}, "
            f"one of {10 * size:g} {100 * worst:.2g} %",
            worst_at_ten,
            curves,
            ("size of the increments, share of the strain", "difference of the change of stress"),
            case_of(law, whence, [at.step * at.increments / 100] * 10),
        )
    )
    return out


def _differences(law: Law, point: Point, d_strain: np.ndarray, h: float) -> np.ndarray:
    """d stress/d strain increment by central differences of the update."""
    found = np.zeros((6, 6))
    for j in law._places():
        change = np.zeros(6)
        change[j] = h
        up = go(law, point, [d_strain + change]).stress
        down = go(law, point, [d_strain - change]).stress
        found[:, j] = (up - down) / (2 * h)
    return found


_DISGUISES = {
    "its transpose": lambda t: t.T,
    "it with the columns of shear doubled": lambda t: t * np.array([1, 1, 1, 2, 2, 2]),
    "it with the columns of shear halved": lambda t: t * np.array([1, 1, 1, 0.5, 0.5, 0.5]),
    "its negative": lambda t: -t,
}


def tangent(law: Law, at: Setting) -> list[Finding]:
    """DDSDDE beside differences of the update, for increments of four sizes; Newton's method with it."""
    sizes = [at.reach / 10, at.reach / 100, at.reach / 1e3, at.reach / 1e4]
    start = begin(law, at)
    elastic = start.tangent
    loaded = go(law, start, straight(at, at.increments // 2))
    unit = at.step / np.abs(at.step).max()
    errors, worst_other = [], {k: 0.0 for k in _DISGUISES}
    turns, skew = 0.0, 0.0
    # Of a start on the yield surface one of the two ways is elastic.
    least = sizes[-1] * unit
    is_elastic = any(
        norm(_differences(law, start, d, 1e-2 * sizes[-1]) - elastic) < 1e-3 * norm(elastic) for d in (least, -least)
    )
    for size in sizes:
        worst = 0.0
        for point in (start, loaded):
            answer = go(law, point, [size * unit])
            if not np.isfinite(answer.tangent).all():
                return [Finding("tangent", FAULT, f"DDSDDE of an increment of {size:g} is not finite")]
            # A law may treat small changes of direction as none: the differences that come nearest count.
            tried = [_differences(law, point, size * unit, h * size) for h in (1e-4, 1e-3, 1e-2)]
            exact = min(tried, key=lambda t: norm(answer.tangent - t))
            scale = norm(exact) + _EPS
            worst = max(worst, norm(answer.tangent - exact) / scale)
            skew = max(skew, norm(exact - exact.T) / scale)
            if size == sizes[-1]:
                back = go(law, point, [-size * unit])
                turns = max(turns, norm(answer.tangent - back.tangent) / (norm(answer.tangent) + _EPS))
            is_elastic = is_elastic and norm(answer.tangent - elastic) / (norm(elastic) + _EPS) < 1e-6
            for k, f in _DISGUISES.items():
                worst_other[k] = max(worst_other[k], norm(f(answer.tangent) - exact) / scale)
        errors.append(worst)
    curves = {"DDSDDE beside differences": (sizes, [max(e, 1e-16) for e in errors])}
    axes = ("size of the increment", "relative difference")
    named = [k for k, e in worst_other.items() if e < 1e-3 and e < 0.1 * max(errors)]
    falls = errors[0] / max(errors[2], 1e-12)
    iterations = newton(law, loaded, (at.reach / 100) * unit)
    told = law.told()
    if max(errors) < 2e-3:
        kind, verdict = "the derivative of the update (consistent)", PASS
    elif named:
        kind, verdict = f"not the derivative of the update; {named[0]} is", FAULT
    elif is_elastic:
        kind, verdict = "the elastic one: Newton's method converges slowly", NOTE
    elif min(errors[2:]) < 5e-2 and falls > 3:
        kind, verdict = "a continuum tangent: its difference falls with the increment", NOTE
    elif told is not None and told.tangent == 0:
        kind, verdict = "no tangent, as the law itself says (IDTASK 5)", NOTE
    elif turns < 1e-3 and iterations:
        kind, verdict = "one stiffness for loading and unloading: Newton's method converges slowly", NOTE
    else:
        kind, verdict = "neither the derivative of the update nor its limit for small increments", FAULT
    sentence = f"DDSDDE is {kind} (differences {errors[0]:.1e} to {errors[-1]:.1e})"
    if iterations:
        sentence += f"; Newton's method takes {len(iterations) - 1} iterations for an increment of {at.reach / 100:g}"
        curves["Newton's method"] = ([], iterations)
    else:
        sentence += "; Newton's method with it fails"
    # By the stress of one increment, for the iterations of mud_triax --residuals.
    end = go(law, loaded, [(at.reach / 100) * unit])
    case = case_of(law, loaded, [], end.stress - loaded.stress)
    return [Finding("tangent", verdict, sentence, max(errors), curves, axes, case)]


def newton(law: Law, point: Point, d_strain: np.ndarray, most: int = 200) -> list[float]:
    """Residuals of Newton's method for a stress that a known strain increment gives; empty where it fails."""
    target = go(law, point, [d_strain]).stress
    places = law._places()
    guess, residuals, slope = np.zeros(6), [], point.tangent
    scale = norm(target - point.stress) + _EPS
    found = point.stress
    for _ in range(most):
        residual = (target - found)[places]
        residuals.append(norm(residual) / scale)
        if residuals[-1] < 1e-8:
            return residuals
        try:
            guess[places] += np.linalg.solve(slope[np.ix_(places, places)], residual)
            answer = go(law, point, [guess])
        except (np.linalg.LinAlgError, Refusal):
            return []
        found, slope = answer.stress, answer.tangent
    return []


def _rotation(angles: tuple[float, float, float]) -> np.ndarray:
    a, b, c = angles
    x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    y = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    z = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    return x @ y @ z


def turned(vector: np.ndarray, q: np.ndarray, strain: bool) -> np.ndarray:
    """A stress, or a strain with engineering shear, in turned directions: Q v Q'."""
    half = 0.5 if strain else 1.0
    v = np.asarray(vector, dtype=float)
    m = np.array([[v[0], half * v[3], half * v[4]], [half * v[3], v[1], half * v[5]], [half * v[4], half * v[5], v[2]]])
    m = q @ m @ q.T
    return np.array([m[0, 0], m[1, 1], m[2, 2], m[0, 1] / half, m[0, 2] / half, m[1, 2] / half])


Q = _rotation((0.4, -0.7, 1.1))


def _objectivity(law: Law, at: Setting) -> float:
    path = straight(at)
    plain = go(law, begin(law, at), path).stress
    other = go(law, begin(law, _turned_start(at)), [turned(d, Q, True) for d in path]).stress
    moved = norm(plain - at.stress) + _EPS
    return norm(turned(plain, Q, False) - other) / moved


def _turned_start(at: Setting) -> Setting:
    return Setting(turned(at.stress, Q, False), at.reach, at.increments, at.direction)


def conventions(law: Law, at: Setting) -> list[Finding]:
    """A path and the same path turned as a whole: the answers turn with it, if shear strains mean what is assumed."""
    if law.components < 6:
        return [Finding("conventions", UNJUDGED, "only with six components")]
    found = {}
    for order in ("abaqus", "kratos"):
        for tensor in (False, True):
            try:
                found[order, tensor] = _objectivity(law.like(shear_order=order, tensor_shear=tensor), at)
            except Refusal:
                if (order, tensor) == (law.shear_order, law.tensor_shear):
                    raise
                found[order, tensor] = np.inf
    given = found[law.shear_order, law.tensor_shear]
    words = {
        k: ("12, 13, 23" if k[0] == "abaqus" else "12, 23, 13") + (", tensor shear" if k[1] else ", engineering shear")
        for k in found
    }
    best = min(found.values())
    fitting = [words[k] for k, v in found.items() if v < max(1e-6, 10 * best)]
    if given < 1e-6:
        more = "" if len(fitting) == 1 else f" ({' or '.join(fitting)}: no difference)"
        return [
            Finding(
                "conventions",
                PASS,
                f"answers turn with the path: {words[law.shear_order, law.tensor_shear]}{more}",
                given,
            )
        ]
    if best < 1e-3 and best < 0.1 * given:
        return [Finding("conventions", FAULT, f"by its answers the law has {' or '.join(fitting)}", given)]
    start = _turned_start(at)
    case = case_of(law, begin(law, start), [turned(d, Q, True) for d in straight(at)])
    if given < 1e-3:
        sentence = "answers turn with the path but for a rest: substeps or tolerances that depend on the axes"
        return [Finding("conventions", NOTE, sentence, given, case=case)]
    if np.any(law.begin() != 0.0):
        sentence = "answers do not turn with the path: tensors in --statev, which stay as they are, or a mistake"
        return [Finding("conventions", NOTE, sentence, given, case=case)]
    sentence = "answers do not turn with the path: the law is anisotropic, or wrong"
    return [Finding("conventions", FAULT, sentence, given, case=case)]


def drot(law: Law, at: Setting) -> list[Finding]:
    """The body turns between two increments: the host turns the stress, DROT tells the law to turn its tensors."""
    if law.components < 6 or law.kind != "umat":
        return [Finding("DROT", UNJUDGED, "only of a UMAT with six components")]
    mid = go(law, begin(law, at), straight(at))
    path = [-d for d in straight(at, at.increments // 4)]
    plain = go(law, mid, [np.zeros(6), *path]).stress
    body = Point(turned(mid.stress, Q, False), mid.state, mid.strain, mid.time)
    answer = step(law, body, np.zeros(6), rotation=Q)
    if answer.refused:
        return [Finding("DROT", FAULT, "an increment that only turns is refused")]
    start = Point(answer.stress, answer.state, turned(mid.strain, Q, True), mid.time + 1.0)
    other = go(law, start, [turned(d, Q, True) for d in path]).stress
    error = norm(turned(plain, Q, False) - other) / (norm(plain - mid.stress) + _EPS)
    if error < 1e-6:
        return [Finding("DROT", PASS, "a body that turns answers as one at rest", error)]
    if not np.any(law.begin()) and _objectivity(law, at) > 1e-3:
        sentence = "answers differ in turned directions without DROT too (conventions)"
        return [Finding("DROT", UNJUDGED, sentence)]
    return [
        Finding("DROT", FAULT, "tensors of STATEV are not turned with DROT: wrong where bodies turn (NLGEOM)", error)
    ]


def cycles(law: Law, at: Setting, count: int = 20) -> list[Finding]:
    """Symmetric strain cycles of a hundredth of the reach: where they lead."""
    unit = at.step / np.abs(at.step).max() * at.reach / 100
    quarter = [unit / 10] * 10
    point = begin(law, at)
    path = (quarter + [-d for d in quarter * 2] + quarter) * count
    points = way(law, point, path)
    drift = norm(points[-1].stress - point.stress) / at.size
    curves = {"stress path": ([-p.stress[:3].mean() for p in points], [deviator(p.stress) for p in points])}
    verdict = PASS if drift < 2 else NOTE
    return [
        Finding(
            "cycles",
            verdict,
            f"after {count} symmetric strain cycles of {at.reach / 100:g} the stress is {drift:.2g} of the initial one away",
            drift,
            curves,
            ("mean stress, compression positive", "deviator stress"),
            case_of(law, point, path),
        )
    ]


def oscillation(law: Law, at: Setting) -> list[Finding]:
    """A straight path, and the same path that goes back by a hundredth of an increment after every increment."""
    path = straight(at)
    zigzag = [part for d in path for part in (1.01 * d, -0.01 * d)]
    plain = way(law, begin(law, at), path)
    shaken = way(law, begin(law, at), zigzag)
    change = norm(plain[-1].stress - at.stress) + _EPS
    error = norm(plain[-1].stress - shaken[-1].stress) / change
    curves = {
        label: ([norm(p.strain) for p in points], [deviator(p.stress) for p in points])
        for label, points in (("straight", plain), ("with small reversals", shaken[::2]))
    }
    verdict = PASS if error < 0.02 else NOTE if error < 0.05 else FAULT
    return [
        Finding(
            "oscillation",
            verdict,
            f"reversals of {at.reach / at.increments / 100:g} on the way change the end by {100 * error:.2g} %"
            + (": the law forgets its process of loading (overshooting)" if verdict == FAULT else ""),
            error,
            curves,
            ("strain", "deviator stress"),
            case_of(law, begin(law, at), zigzag),
        )
    ]


def noise(law: Law, at: Setting) -> list[Finding]:
    """A straight path with noise in six components of a thousandth of an increment, that adds up to nothing."""
    rng = np.random.default_rng(1)
    size = np.abs(at.step).max() * 1e-3
    jitter = rng.uniform(-size, size, (at.increments + 1, 6))
    jitter[0] = jitter[-1] = 0.0
    path = [d + jitter[i + 1] - jitter[i] for i, d in enumerate(straight(at))]
    plain = go(law, begin(law, at), straight(at)).stress
    error = norm(go(law, begin(law, at), path).stress - plain) / (norm(plain - at.stress) + _EPS)
    verdict = PASS if error < 1e-2 else NOTE if error < 0.05 else FAULT
    return [
        Finding(
            "noise",
            verdict,
            f"noise of a thousandth of an increment changes the end by {100 * error:.2g} %",
            error,
            case=case_of(law, begin(law, at), path),
        )
    ]


def loops(law: Law, at: Setting) -> list[Finding]:
    """Work over small closed strain loops, both ways round: what a loop gives back it has taken."""
    volume = np.array([1, 1, 1, 0, 0, 0]) / 3.0
    shear = np.array([0.5, 0.5, -1, 0, 0, 0])
    start = begin(law, at)
    worst, where, case = 0.0, "", ""
    for size in (at.reach / 1000, at.reach / 100):
        for label, point in (("start", start), ("under way", go(law, start, straight(at, at.increments // 2)))):
            for v, s in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
                legs = [v * size * volume, s * size * shear, -v * size * volume, -s * size * shear]
                work, far = 0.0, 0.0
                p = point
                for leg in legs:
                    for _ in range(50):
                        q = go(law, p, [leg / 50])
                        mean = 0.5 * (p.stress + q.stress) - point.stress
                        work += float(mean @ (leg / 50))
                        p = q
                    far = max(far, abs(float((p.stress - point.stress) @ leg)))
                gain = -work / (0.5 * far + _EPS)
                if gain > worst:
                    worst, where = gain, f"size {size:g}, {label}"
                    case = case_of(law, point, [leg / 50 for leg in legs for _ in range(50)])
    if worst > 1e-2:
        return [
            Finding(
                "energy",
                FAULT,
                f"a closed strain loop gives energy: {100 * worst:.2g} % of what it stores ({where})",
                worst,
                case=case,
            )
        ]
    verdict = PASS if worst < 1e-3 else NOTE
    return [
        Finding("energy", verdict, f"closed strain loops give at most {100 * worst:.2g} % of what they store", worst)
    ]


_LEAPS = {
    "compression": np.array([0, 0, -1.0, 0, 0, 0]),
    "expansion": np.array([1.0, 1, 1, 0, 0, 0]) / 3,
    "simple shear": np.array([0, 0, 0, 1.0, 0, 0]),  # which four components have, too
}


def large_increments(law: Law, at: Setting) -> list[Finding]:
    """Increments of 1 % to 100 %, and one that is not a number: an answer, or a refusal that changes nothing."""
    out, refused, done = [], 0, 0
    for label, unit in _LEAPS.items():
        for size in (0.01, 0.1, 1.0, np.nan):
            d = unit * size
            said = f"{label} of {size:g}" if size == size else f"{label} of NaN"
            try:
                point, answer = apart(_leap_from, law, at, d, seconds=20.0)
            except Ended as end:
                out.append(Finding("large increments", FAULT, f"{said}: {end}"))
                continue
            case = case_of(law, point, [d]) if size == size else ""
            if answer.cut:
                refused += 1
                # The door of PLAXIS has arrays of its own for what comes out.
                if law.kind == "umat" and not (np.array_equal(answer.stress, point.stress) and np.array_equal(answer.state, point.state)):
                    sentence = f"{said}: refused, but stress or STATEV are changed: right only where the host restores them"
                    out.append(Finding("large increments", NOTE, sentence, case=case))
            elif not answer.finite:
                if size == size:
                    sentence = f"{said}: a stress that is not finite, and PNEWDT stays 1"
                    out.append(Finding("large increments", FAULT, sentence, case=case))
            elif size != size:
                out.append(Finding("large increments", FAULT, f"{said}: taken without a word"))
            elif np.array_equal(answer.stress, point.stress):
                sentence = f"{said}: the stress stays as it was, and PNEWDT stays 1: the strain is lost without a word"
                out.append(Finding("large increments", FAULT, sentence, case=case))
            else:
                done += 1
    words = (
        f"{done} done, {refused} refused by PNEWDT"
        if law.kind == "umat"
        else f"{done} done, {refused} refused by IABORT"
    )
    return out or [
        Finding(
            "large increments",
            PASS,
            f"of twelve increments of 1 to 100 % and NaN {words}; none changes what it refuses",
        )
    ]


def _leap_from(law: Law, at: Setting, d: np.ndarray) -> tuple[Point, Answer]:
    point = go(law, begin(law, at), straight(at, at.increments // 2))
    return point, step(law, point, d)


_STRETCH = np.array([1, 1, 1, 0, 0, 0]) / 300.0  # of the reach


def _stretched(law: Law, at: Setting, start: np.ndarray) -> list[float]:
    """Mean stresses, compression positive, of an expansion until it is refused."""
    point, out = Point(start, law.begin(), np.zeros(6)), []
    d = _STRETCH * at.reach
    for _ in range(200):
        answer = step(law, point, d)
        if answer.cut:
            break
        if not answer.finite:
            return [*out, np.nan]
        point = Point(answer.stress, answer.state, point.strain + d, point.time + 1.0)
        out.append(-float(answer.stress[:3].mean()))
    return out


def no_stress(law: Law, at: Setting) -> list[Finding]:
    """A start without stress, and expansion from the start until p' vanishes."""
    out = []
    for label, start in (("from no stress", np.zeros(6)), ("from the initial stress", at.stress)):
        try:
            means = apart(_stretched, law, at, start, seconds=30.0)
        except Ended as end:
            out.append(Finding("tension", FAULT, f"expansion {label}: {end}"))
            continue

        def case(n: int, start: np.ndarray = start) -> str:
            return case_of(law, Point(start, law.begin(), np.zeros(6)), [_STRETCH * at.reach] * n)

        if not means:
            out.append(Finding("tension", NOTE, f"expansion {label} is refused at once"))
        elif means[-1] != means[-1]:
            sentence = f"expansion {label}: a stress that is not finite, and PNEWDT stays 1"
            out.append(Finding("tension", FAULT, sentence, case=case(len(means))))
        else:
            low = min(means)
            said = f"mean stress goes down to {low:.3g}" if low >= 0 else f"tension of {-low:.3g} is carried"
            verdict = PASS if low >= -1e-9 * at.size else NOTE
            out.append(Finding("tension", verdict, f"expansion {label}: {said}", low, case=case(len(means))))
    return out


def plane(law: Law, at: Setting) -> list[Finding]:
    """Four components beside six."""
    if law.kind != "umat" or law.components != 6:
        return [Finding("four components", UNJUDGED, "only of a UMAT with six")]
    path = [d * np.array([1, 1, 1, 1, 0, 0]) for d in straight(at)]
    six = go(law, begin(law, at), path).stress
    try:
        four = apart(_ends, law.like(components=4), at, path)
    except (Ended, Refusal) as end:
        return [Finding("four components", NOTE, f"NTENS 4 does not run: {end}")]
    error = norm(four - six) / (norm(six - at.stress) + _EPS)
    verdict = PASS if error < 1e-9 else NOTE if error < 1e-3 else FAULT
    sentence = "NTENS 4 and 6 agree" if verdict == PASS else "NTENS 4 and 6 differ"
    other = law.like(components=4)
    return [Finding("four components", verdict, sentence, error, case=case_of(other, start_of(other, at), path))]


def rates(law: Law, at: Setting) -> list[Finding]:
    """DTIME a thousand times shorter, and longer."""
    ends = [go(law, begin(law, at), straight(at), dt).stress for dt in (1.0, 1e-3, 1e3)]
    error = max(norm(e - ends[0]) for e in ends[1:]) / (norm(ends[0] - at.stress) + _EPS)
    if error < 1e-12:
        return [Finding("time", PASS, "answers do not depend on DTIME", error)]
    return [Finding("time", NOTE, "the law depends on DTIME", error)]


def speed(law: Law, at: Setting, reference: Law | None = None) -> list[Finding]:
    """Microseconds of an update, beside one of this library."""
    micro = _microseconds(law, at)
    text = f"{micro:.2g} microseconds an update of {at.reach / at.increments:g}"
    if reference is not None:
        other = _microseconds(reference, at)
        text += f"; MUD with its default parameters takes {other:.2g}"
    return [Finding("speed", PASS, text, micro)]


def _microseconds(law: Law, at: Setting, calls: int = 200) -> float:
    """Processor time of an update, each of its calls repeated, least of nine rounds, less that of calls that do
    nothing."""
    real, nothing = law.load(), ctypes.CDLL(None).abs
    took = {"nothing": 0.0, "law": 0.0}

    def timed(*arguments: Any) -> None:
        for name, function in (("nothing", nothing), ("law", real)):
            t = time.thread_time()
            for _ in range(calls):
                function(*arguments)
            took[name] += (time.thread_time() - t) / calls * 1e6

    start, probe, rounds = begin(law, at), law.like(), []
    probe._function = timed
    for _ in range(9):
        took.update(nothing=0.0, law=0.0)
        step(probe, start, at.step)
        rounds.append((took["law"], took["nothing"]))
    return max(min(r[0] for r in rounds) - min(r[1] for r in rounds), 0.0)


CHECKS: dict[str, Callable[..., list[Finding]]] = {
    "first call": first_call,
    "arrays": arrays,
    "rest": rest,
    "conventions": conventions,
    "increments": increments,
    "tangent": tangent,
    "two points": points_side_by_side,
    "two materials": two_materials,
    "restart": continued,
    "threads": threads,
    "DROT": drot,
    "cycles": cycles,
    "oscillation": oscillation,
    "noise": noise,
    "energy": loops,
    "large increments": large_increments,
    "tension": no_stress,
    "four components": plane,
    "time": rates,
    "speed": speed,
}


def case_of(law: Law, start: Point, path: list[np.ndarray], d_stress: np.ndarray | None = None) -> str:
    """A case of mud_triax: the strain increments of a path from a point, or one increment with the strain that a change
    of stress needs. Compression is positive there. Empty where it cannot be one: a model of PLAXIS, tensor shear."""
    if law.kind != "umat" or law.tensor_shear:
        return ""
    # Behind STATEV mud_triax keeps the strain, the number of updates, the void ratio and S_w.
    kept = [*start.state, *-start.strain, round(start.time), 0.8, 1.0]
    lines = [
        "&case name = 'finding' /",
        f"&material law = 'umat' library = {quoted(str(law.library))} symbol = {quoted(law.symbol)} nstatv = {law.n_state}",
        f"   shear_order = '{law.shear_order}' components = {law.components}",
        *([_key("props", law.props)] if len(law.props) else []),
        "/",
        "&initial",
        _key("stress", -start.stress),
        _key("suction", [law.suction]),
        _key("state_variables", kept),
        "/",
    ]
    if d_stress is not None:
        lines += ["&stage control = 'stress_path' stress = 'effective'", _key("d_sigma", -d_stress)]
        lines.append("   increment = 1e6 output_interval = 1e6 /")
    for d_strain, count in _runs(path):
        size = float(np.abs(d_strain).max())
        if size == 0.0:
            continue
        # Rounding makes no increment more, and leaves no row out.
        lines += ["&stage control = 'strain_path'", _key("d_eps", -count * d_strain)]
        lines.append(f"   increment = {1.000001 * size:.12g} output_interval = {0.999999 * size:.12g} /")
    return "\n".join(lines) + "\n"


def _key(name: str, values: Iterable[float]) -> str:
    """A key of a namelist with its numbers, in lines of 120 columns."""
    text = f"   {name} = " + ", ".join(repr(float(v) + 0.0) for v in values)
    return textwrap.fill(text, 120, initial_indent="   ", subsequent_indent=" " * 6)


def _runs(path: list[np.ndarray]) -> list[tuple[np.ndarray, int]]:
    """Equal increments that follow one another, and their number."""
    runs: list[tuple[np.ndarray, int]] = []
    for d in path:
        if runs and np.array_equal(runs[-1][0], d):
            runs[-1] = (d, runs[-1][1] + 1)
        else:
            runs.append((d, 1))
    return runs
