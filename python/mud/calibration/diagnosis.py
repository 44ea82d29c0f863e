# SPDX-License-Identifier: MIT
"""What the tests determine: sensitivity, confidence, correlations, bounds, and whether the model stays in its range."""

from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Mapping, Sequence

import numpy as np

from ..material import Material
from .ensemble import Ensemble
from .fit import Fit, posterior
from .misfit import scaled
from .simulation import SETTINGS, Answer
from .soundness import disagreeing, unloading
from .task import Task
from .variables import PINNED, PINNED_WITH, Variable, meaning_of, poisson_ratio, start_of

CONFIDENT = 1.96  # standard deviations of a 95 % interval
UNDETERMINED = 2.0  # a 95 % interval that reaches from half to twice the value (of a share of the bounds: half of them)
FLAT = 0.05  # [standard deviations of a curve] a change by 10 % that moves the curves by less is not felt
CORRELATED = 0.95
NEAR_BOUND = 0.01  # share of the bounds
DRAWN = 0.005  # share of the misfit, or of the scatter of measurements, that a value beyond a bound takes away at least
STEP = 8e-3  # of the differences at the optimum, to both sides
POISSON = (0.0, 0.45)
SOFTEST = 0.05  # 1 - c_h e below it: the hardening law is at its guard
# Parameters that may matter and are not fitted here: what these tests say about them is told as well.
WATCHED = (
    "G_0",
    "K_0",
    "c",
    "c_z",
    "z_max",
    "theta",
    "n_b",
    "n_d",
    "A_0",
    "h_0",
    "c_h",
    "M_c",
    "e_c100",
    "lambda",
    "alpha_csl",
    "e_l10",
)


@dataclasses.dataclass
class Finding:
    """What the tests say about one variable."""

    variable: Variable
    value: float
    fitted: bool
    low: float  #: 95 % interval; NaN where it was not fitted
    high: float
    sensitivity: float  #: how far a change by 10 % moves the curves, rms in standard deviations of what was measured
    determined: bool
    at_bound: str = ""  #: "lower", "upper" or nothing
    drawn: bool = False  #: beyond that bound the misfit would fall


@dataclasses.dataclass
class Diagnosis:
    findings: list[Finding]
    names: list[str]  #: of the matrix
    matrix: np.ndarray  #: correlations of the fitted variables
    sentences: list[str]  #: plain words
    warnings: list[str]


def diagnose(
    fit: Fit, values: Mapping[str, float], answers: Mapping[str, Answer], ensemble: Ensemble | None = None
) -> Diagnosis:
    """Looks at the optimum of a fit. answers : of every test, by name. ensemble : tells the intervals of its variables."""
    kept = {v.name for v in fit.kept}
    watched = [_variable(name) for name in WATCHED if name not in [v.name for v in fit.variables] and name not in kept]
    everything = {**{v.name: start_of(v.name, fit.task.base) for v in watched}, **values}
    mechanical = {item.test.kind for item in fit.task.fitted()} - {"retention"}
    if not mechanical:
        watched = []
    watched = [*fit.kept, *watched]
    both = [*fit.variables, *watched]
    jacobian = _central(fit, both, everything)
    curves = fit.curves
    n = len(fit.variables)
    now = fit.evaluator.residuals([everything])[0]
    covariance, scatter = np.zeros((n, n)), np.ones(n)
    for part in fit.parts:
        mine = [i for i, v in enumerate(fit.variables) if v in part.variables]
        variance = fit.variance(fit.evaluator.residuals([everything], part.numbers)[0], part)
        own = _central(fit, [fit.variables[i] for i in mine], everything, part.numbers)
        covariance[np.ix_(mine, mine)] = posterior(own, variance)
        scatter[mine] = variance
    deviations = np.sqrt(np.diag(covariance))
    findings = []
    for i, variable in enumerate(both):
        share = variable.share(everything[variable.name])
        tenth = _share_of_tenth(variable, everything[variable.name])
        felt = float(np.linalg.norm(jacobian[:, i]) * tenth / np.sqrt(curves))
        if i < n:
            low, high = (variable.value(float(np.clip(share + s * CONFIDENT * deviations[i], 0, 1))) for s in (-1, 1))
            if ensemble and len({member[variable.name] for member in ensemble.members}) > 1:
                low, high = ensemble.interval(variable.name, fit.minima)
            wide = (
                high / max(low, 1e-12) > UNDETERMINED**2
                if variable.log
                else high - low > (variable.upper - variable.lower) / 2
            )
            bound = "lower" if share < NEAR_BOUND else "upper" if share > 1 - NEAR_BOUND else ""
            slope = float(jacobian[:, i] @ now)
            gain = slope**2 * covariance[i, i] / scatter[i]  # if the others may follow
            drawn = (slope > 0) == (bound == "lower") and gain > DRAWN * max(float(now @ now), curves)
            value, determined = everything[variable.name], not wide and felt >= FLAT
            findings.append(Finding(variable, value, True, low, high, felt, determined, bound, drawn))
        else:
            determined = felt >= FLAT and variable.name not in kept
            findings.append(Finding(variable, everything[variable.name], False, np.nan, np.nan, felt, determined))
    scale = np.outer(deviations, deviations)
    matrix = np.divide(covariance, scale, out=np.zeros_like(covariance), where=scale > 0)
    names = [v.name for v in fit.variables]
    pairs = [
        (names[i], names[j], float(matrix[i, j])) for i in range(n) for j in range(i) if abs(matrix[i, j]) > CORRELATED
    ]
    return Diagnosis(
        findings,
        names,
        matrix,
        [*_several(fit), *_sentences(findings, pairs, fit.task)],
        [*_warnings(findings, fit, everything, answers), *disagreeing(fit, jacobian[:, :n], answers)],
    )


def _several(fit: Fit) -> list[str]:
    """Minima that are nearly as good as the best, and where they differ."""
    if len(fit.minima) < 2:
        return []
    best, *others = fit.minima
    told = []
    for other in others:
        far = sorted(
            (v for v in fit.variables if v.name in best.values),
            key=lambda v: -abs(v.share(best.values[v.name]) - v.share(other.values[v.name])),
        )[:3]
        told.append(
            f"Another minimum fits nearly as well (misfit {other.cost:.3f}, the best {best.cost:.3f}): "
            + ", ".join(f"{v.name} {other.values[v.name]:.4g} in place of {best.values[v.name]:.4g}" for v in far)
            + "."
        )
    return told


def _variable(name: str) -> Variable:
    from .variables import VARIABLES
    from ..registry import parameters

    if name in VARIABLES:
        return VARIABLES[name]
    entry = parameters[name]
    return Variable(name, "", entry.lower, entry.upper, False, entry.unit)


def _share_of_tenth(variable: Variable, value: float) -> float:
    if variable.log:
        return float(np.log(1.1) / np.log(variable.upper / variable.lower))
    return 0.1 * abs(value) / (variable.upper - variable.lower)


def _central(
    fit: Fit, variables: list[Variable], values: Mapping[str, float], tests: Sequence[int] | None = None
) -> np.ndarray:
    base = [v.share(values[v.name]) for v in variables]
    ends = [(min(s + STEP, 1.0), max(s - STEP, 0.0)) for s in base]
    sets = [{**values, v.name: v.value(end)} for v, pair in zip(variables, ends) for end in pair]
    residuals = fit.evaluator.residuals(sets, tests)
    return np.stack(
        [(residuals[2 * i] - residuals[2 * i + 1]) / (pair[0] - pair[1]) for i, pair in enumerate(ends)], axis=1
    )


def _sentences(findings: list[Finding], pairs: list[tuple[str, str, float]], task: Task) -> list[str]:
    told = []
    for finding in findings:
        name = finding.variable.name
        if finding.fitted and not finding.determined:
            told.append(
                f"These tests do not determine {name}: the 95 % interval is {finding.low:.3g} to {finding.high:.3g}"
                + (
                    f", and a change by 10 % moves the curves by {finding.sensitivity:.2f} standard deviations."
                    if finding.sensitivity < FLAT
                    else "."
                )
            )
        elif not finding.fitted and not finding.determined:
            told.append(
                f"These tests do not determine {name}: a change by 10 % moves the curves by {finding.sensitivity:.3f} "
                f"standard deviations. It keeps the value {finding.value:.4g} of "
                f"{'material ' + pathlib.Path(task.start).stem if task.start else 'the library'}."
            )
    told += [
        f"{a} and {b} are only determined together (correlation {c:+.3f}): another pair fits equally well."
        for a, b, c in pairs
    ]
    return told


def _warnings(
    findings: list[Finding], fit: Fit, values: Mapping[str, float], answers: Mapping[str, Answer]
) -> list[str]:
    told = [
        f"{f.variable.name} = {f.value:.4g} is at its {f.at_bound} bound ({f.variable.lower:g} to {f.variable.upper:g}): a "
        "better fit of these tests with this model needs a value outside the bounds."
        for f in findings
        if f.at_bound and f.drawn
    ]
    material = fit.evaluator.material(values)
    told += unloading(fit.evaluator.material(values, **SETTINGS), fit.task.items, answers)
    for item in fit.task.items:
        answer = answers[item.test.name]
        if answer.stopped:
            told.append(f"{item.test.name} stopped: {answer.stopped}")
        elif item.test.kind != "retention":
            told += _out_of_range(item.test.name, material, answer)
    for name, count in sorted(fit.evaluator.failures.items()):
        told.append(
            f"{name} stopped under {count} of the sets that were tried; rows that were not reached counted as misfit."
        )
    for item in fit.task.items:
        if answers[item.test.name].stopped:
            continue
        for quantity in item.use.scatter:
            z = scaled(item, answers[item.test.name], quantity)
            if np.sqrt(np.mean(z**2)) > 5:
                told.append(
                    f"{item.test.name}: {quantity} is off by {np.sqrt(np.mean(z**2)):.1f} standard deviations (rms): the "
                    "model cannot represent it, or the test is unusual."
                )
    return told


def _out_of_range(name: str, material: Material, answer: Answer) -> list[str]:
    told = []
    e, p = answer.columns.get("e"), answer.columns.get("p")
    if e is None or p is None:
        return told
    if np.min(1 - material["c_h"] * e) < SOFTEST:
        told.append(
            f"{name}: 1 - c_h e falls to {np.min(1 - material['c_h']*e):.3f}: the hardening law is close to its limit 0."
        )
    poisson = poisson_ratio(material, e, p)
    if np.min(poisson) < POISSON[0] or np.max(poisson) > POISSON[1]:
        told.append(
            f"{name}: elastic Poisson's ratio runs from {np.min(poisson):.2f} to {np.max(poisson):.2f}, sand has "
            f"{POISSON[0]:g} to {POISSON[1]:g}."
        )
    if np.min(p) < 2 * 1e-3 * material["p_atm"]:
        told.append(f"{name}: p' falls to {np.min(p):.3g} kPa, next to the tension cut-off.")
    return told


def origin_of(name: str, diagnosis: Diagnosis, task: Task) -> str:
    """Where the value of a parameter of the library comes from, for the material file."""
    if name in task.origins:
        return task.origins[name]
    pinned = PINNED.get(name, name)
    found = next((f for f in diagnosis.findings if f.variable.name == pinned and f.fitted), None)
    with_it = PINNED_WITH.get(name, ())
    follows = next((f.variable.name for f in diagnosis.findings if f.variable.name in with_it and f.fitted), None)
    if found is not None:
        text = "fitted" if pinned == name else f"fitted as {pinned} = {found.value:.4g} ({meaning_of(pinned)})"
        text += f", 95 % {found.low:.3g} to {found.high:.3g}"
        return (
            text
            + ("" if found.determined else ", not determined by these tests")
            + (f", at its {found.at_bound} bound" if found.at_bound else "")
        )
    if follows is not None:
        return f"{pinned} of the start kept while {follows} was fitted"
    return f"of material {pathlib.Path(task.start).stem}" if task.start else "default of the library"
