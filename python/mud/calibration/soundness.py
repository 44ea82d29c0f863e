# SPDX-License-Identifier: MIT
"""What a fitted material does beyond the rows that were fitted: unloading, earth pressure, and tests that disagree with the
others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..element_test import Stage, TestResult, element_test
from ..errors import MudError
from ..material import Material
from .fit import PRIOR, Fit
from .misfit import scaled
from .simulation import Answer, turns, earth_pressure
from .task import Item

LOADED, UNLOADED = 400.0, 50.0  # [kPa] axial stress of the compression that is looked at: overconsolidation 8
SWELLS = 1.5, 0.002  # a sample swells wrongly if by more than this factor and this void ratio
RECOVERS = 0.5  # share of the compression from UNLOADED to LOADED that no sand recovers
DEVIATIONS = 3.0  # robust standard deviations beyond which a test disagrees with the others
LEAST_RATIO = 0.15  # and a stress must be off by this share,
LEAST_OFF, FAR = 1.0, 1.5  # another quantity by so many deviations of the measurement more than so many times the next test
MAD = 1.4826  # of a normal distribution, its deviation over its median absolute deviation
FEWEST = 4  # tests among which one can disagree


def compressed(material: Material, void_ratio: float, *sigma_a: float) -> TestResult:
    """A sample from UNLOADED, with Jaky's K0, to one axial stress [kPa] after the other without radial strain."""
    stages = [Stage("oedometer", sigma_a_end=end, increment=5.0) for end in sigma_a]
    start = {"sigma_a": UNLOADED, "sigma_r": earth_pressure(material) * UNLOADED}
    return element_test(material, *stages, **start, void_ratio=void_ratio)


def unloading(material: Material, items: Sequence[Item], answers: Mapping[str, Answer]) -> list[str]:
    """Warnings about earth pressure and swelling of a sample that is compressed without radial strain and unloaded."""
    told = []
    for item in items:
        test, answer = item.test, answers[item.test.name]
        if test.kind not in ("oedometer", "isotropic") or answer.stopped:
            continue
        rows = item.use.rows
        stress = test["sigma_a" if test.kind == "oedometer" else "p"][rows]
        begin, end = turns(stress)
        for a, b in zip(begin, end):
            if stress[b] < stress[a]:
                measured, computed = test["e"][rows][b] - test["e"][rows][a], answer.columns["e"][b] - answer.columns["e"][a]
                if computed > SWELLS[0] * max(measured, 0.0) and computed - measured > SWELLS[1]:
                    told.append(
                        f"{test.name}: on unloading from {stress[a]:.0f} to {stress[b]:.0f} kPa the void ratio of the model "
                        f"rises by {computed:.4f}, that of the sample by {measured:.4f}."
                    )
    ratios = [item.test.e_0 for item in items if item.test.kind != "retention" and ("e" in item.test or "e_0" in item.test)]
    if not ratios:
        return told
    e = float(np.median(ratios))
    try:
        run = compressed(material, e, LOADED, UNLOADED)
    except MudError as problem:
        return [*told, f"Compression without radial strain to {LOADED:g} kPa and back stops at e {e:.3f}: {problem}"]
    top, back = run.end_of_stages()[1:]
    k_0, after = (float(run["sigma_r"][i] / run["sigma_a"][i]) for i in (top, back))
    ratio = LOADED / UNLOADED
    if after <= k_0:
        told.append(
            f"K0 does not rise on unloading: {k_0:.2f} at {LOADED:g} kPa, {after:.2f} behind it at {UNLOADED:g} kPa "
            f"(overconsolidation {ratio:g}, void ratio {e:.3f}); sand has about K0 times {ratio:g}^(sin phi), "
            f"{k_0 * ratio ** (1 - earth_pressure(material)):.2f}. Do not use this set for earth pressures after unloading."
        )
    squeezed, recovered = run["e"][0] - run["e"][top], run["e"][back] - run["e"][top]
    if recovered > RECOVERS * squeezed:
        told.append(
            f"The void ratio rises on unloading from {LOADED:g} to {UNLOADED:g} kPa by {recovered:.4f}, "
            f"{100 * recovered / squeezed:.0f} % of what loading took: sand recovers a tenth to a third."
        )
    return told


def disagreeing(fit: Fit, jacobian: np.ndarray, answers: Mapping[str, Answer]) -> list[str]:
    """Sentences on fitted tests that the others contradict: what they are missed by where the fit does not look at them.

    jacobian : d residual/d share at the optimum, of all fitted tests in their order. The answer without a test is that of one
    linear step, with the prior.
    """
    items = fit.evaluator.items
    residual, places, first = [], [], 0
    for item in items:
        z = np.concatenate([scaled(item, answers[item.test.name], q) for q in item.use.scatter])
        weights = np.concatenate([np.full(len(item.use.rows), item.weight / np.sqrt(len(item.use.rows)))] * len(item.use.scatter))
        residual.append(np.nan_to_num(z * weights))
        places.append(slice(first, first + len(z)))
        first += len(z)
    whole, n = np.concatenate(residual), jacobian.shape[1]
    normal, gradient = jacobian[:first].T @ jacobian[:first] + np.eye(n) / PRIOR**2, jacobian[:first].T @ whole
    told = []
    for kind in dict.fromkeys(item.test.kind for item in items):
        for quantity in next(i for i in items if i.test.kind == kind).use.scatter:
            mine = [i for i, item in enumerate(items) if item.test.kind == kind and quantity in item.use.scatter]
            if len(mine) < FEWEST:
                continue
            off = []
            for i in mine:
                own = jacobian[places[i]]
                step = -np.linalg.solve(normal - own.T @ own, gradient - own.T @ residual[i])
                off.append(_without(items[i], answers, quantity, own @ step))
            off = np.array(off)
            ratios, deviations = off.T
            for k, i in enumerate(mine):
                others = np.delete(off, k, axis=0)
                middle = np.median(others[:, 0])
                spread = MAD * np.median(np.abs(others[:, 0] - middle))
                share = ratios[k] / middle - 1
                if quantity in ("q", "p"):
                    odd = abs(ratios[k] - middle) > DEVIATIONS * spread and abs(share) > LEAST_RATIO
                    what = f"its {quantity} is {ratios[k]:.2f} times what the other tests predict (theirs: {others[:, 0].min():.2f} to {others[:, 0].max():.2f})"
                else:
                    middle = np.median(others[:, 1])
                    spread = MAD * np.median(np.abs(others[:, 1] - middle))
                    odd = deviations[k] > middle + DEVIATIONS * spread and deviations[k] > LEAST_OFF + FAR * others[:, 1].max()
                    what = (
                        f"its {quantity} is off the prediction of the other tests by {deviations[k]:.1f} deviations of the "
                        f"measurement (theirs: {others[:, 1].min():.1f} to {others[:, 1].max():.1f})"
                    )
                if odd:
                    told.append(
                        f"{items[i].test.name} disagrees with the other {kind} tests: {what}. Is it of this sand, and are its "
                        "units right? Leave it out (only, held_out) and compare."
                    )
    return told


def _without(item: Item, answers: Mapping[str, Answer], quantity: str, change: np.ndarray) -> tuple[float, float]:
    """(factor from the model to the laboratory, rms in deviations) where the residuals of a test change by that."""
    rows = len(item.use.rows)
    place = list(item.use.scatter).index(quantity)
    z = scaled(item, answers[item.test.name], quantity)
    z = z + change[place * rows : (place + 1) * rows] * np.sqrt(rows) / item.weight
    measured = item.test[quantity][item.use.rows]
    absolute, share = item.use.scatter[quantity]
    model = measured + z * np.hypot(absolute, share * measured)
    good = np.isfinite(model)
    model, measured, z = model[good], measured[good], z[good]
    size = float(model @ model)
    return (float(model @ measured) / size if size > 0 else 1.0), float(np.sqrt(np.mean(z**2))) if len(z) else 0.0
