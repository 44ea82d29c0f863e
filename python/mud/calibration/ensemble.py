# SPDX-License-Identifier: MIT
"""Sets of parameters that fit nearly as well, and what they predict: intervals of parameters, bands of curves.

The sets are drawn from normal distributions about the minima (prior and Jacobian) and weighted by their own misfit. The
model is not exact: its error, taken from the fitted tests, widens the distribution of parameters and is added to the bands.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from .fit import PRIOR, Fit, Minimum, posterior
from .misfit import scaled
from .simulation import Answer
from .task import Item
from .variables import start_of

LEAST_EFFECTIVE = 0.25  # share of the members that must count: below it weights are evened out, and the page says so
TRIES = 100  # draws until one lies inside the bounds
LEVEL = 0.90  # of the bands
NODES = 9  # of the model error for each member
NORMAL = 1.6449  # half of a 90 % interval in standard deviations
PAIRS = 1e-12  # a weight below it is none


@dataclasses.dataclass
class Band:
    """Of one quantity of one test: at the rows that count."""

    low: np.ndarray
    high: np.ndarray
    inside: float  #: share of the laboratory's points that lie in it


@dataclasses.dataclass
class Ensemble:
    members: list[dict[str, float]]
    weights: np.ndarray  #: sum 1
    effective: float  #: number of members that count, (sum w)^2/sum w^2
    evened: float  #: exponent of the weights, 1 if they are as they came
    errors: dict[tuple[str, str], float]  #: (kind, quantity) -> model error over the scatter of the measurement
    bands: dict[str, dict[str, Band]]  #: by test and quantity

    def interval(self, name: str, minima: Sequence[Minimum] = (), level: float = 0.95) -> tuple[float, float]:
        """Interval of a variable: weighted quantiles, and every minimum that was told."""
        values = np.array([member[name] for member in self.members])
        ends = [m.values[name] for m in minima]
        low, high = (quantile(values, self.weights, q) for q in ((1 - level) / 2, (1 + level) / 2))
        return min([low, *ends]), max([high, *ends])

    def coverage(self, items: Sequence[Item], held_out: bool) -> dict[str, tuple[float, int]]:
        """Share of the points inside their band, and how many there are, by quantity and of all ("")."""
        counts: dict[str, list[float]] = {}
        for item in items:
            if item.test.held_out is held_out:
                for quantity, band in self.bands[item.test.name].items():
                    n = len(item.use.rows)
                    for key in (quantity, ""):
                        told = counts.setdefault(key, [0.0, 0.0])
                        told[0] += band.inside * n
                        told[1] += n
        return {key: (inside / n, int(n)) for key, (inside, n) in counts.items()}


def make_ensemble(fit: Fit, values: Mapping[str, float], answers: Mapping[str, Answer]) -> Ensemble | None:
    """Draws, weights and runs the members on every test of the task. None without members or minima."""
    count, minima = fit.effort.members, fit.minima
    part = next((p for p in fit.parts if p.variables and p.variables[0].name in _names(minima)), None)
    if not count or not minima or part is None:
        return None
    # What the tests say nothing about is uncertain too: it moves with its prior, and so do predictions that depend on it.
    kept = [v for v in fit.kept if (v.group == "retention") is (part.variables[0].group == "retention")]
    variables = [*part.variables, *kept]
    prior = np.array([v.share(start_of(v.name, fit.task.base)) for v in variables])
    best = fit.evaluator.residuals([values], part.numbers)[0]
    curves = sum(len(fit.evaluator.items[i].use.scatter) for i in part.numbers)
    variance = fit.variance(best, part)
    centres = np.array([[v.share(m.values[v.name]) for v in variables] for m in minima])
    beyond = [fit.jacobian(kept, values, part.numbers)] if kept else []
    spreads = [posterior(np.hstack([m.jacobian, *beyond]), variance) for m in minima]
    chances = np.array([m.cost**2 for m in minima])
    chances = np.exp(-0.5 * curves * (chances - chances.min()) / variance)
    chances = 0.5 * chances / chances.sum() + 0.5 / len(minima)
    places = _draw(np.random.default_rng(fit.task.seed), count, centres, spreads, chances)
    fixed = {name: value for name, value in values.items() if name not in {v.name for v in variables}}
    members = [{**fixed, **{v.name: v.value(s) for v, s in zip(variables, place)}} for place in places]
    members[0] = dict(values)
    places[0] = [v.share(values[v.name]) for v in variables]
    residuals = fit.evaluator.residuals(members, part.numbers)
    target = np.array([-0.5 * float(r @ r) / variance for r in residuals])
    target -= 0.5 * np.sum(((places - prior) / PRIOR) ** 2, axis=1)
    weights, evened = _weights(target - _log_density(places, centres, spreads, chances))
    chosen = [i for i in range(count) if weights[i] > PAIRS]
    members, weights = [members[i] for i in chosen], weights[chosen] / weights[chosen].sum()
    errors = model_errors(fit, answers)
    items = fit.task.items
    runs = fit.evaluator.answers(members, items)
    bands = {
        item.test.name: {
            quantity: _band(item, quantity, [run[k] for run in runs], weights, errors[item.test.kind, quantity])
            for quantity in item.use.scatter
        }
        for k, item in enumerate(items)
        if all((item.test.kind, quantity) in errors for quantity in item.use.scatter)
    }
    for item in items:
        bands.setdefault(item.test.name, {})
    return Ensemble(members, weights, float(1 / np.sum(weights**2)), evened, errors, bands)


def _names(minima: Sequence[Minimum]) -> set[str]:
    return set(minima[0].values) if minima else set()


def model_errors(fit: Fit, answers: Mapping[str, Answer]) -> dict[tuple[str, str], float]:
    """What the fitted curves are missed by, over the scatter of the measurement: of nine tenths of the rows, as a normal
    deviation, with the degrees of freedom that the fit has used up."""
    used = fit.curves / max(fit.curves - len(fit.variables), 0.5 * fit.curves)
    found: dict[tuple[str, str], list[np.ndarray]] = {}
    for item in fit.task.fitted():
        for quantity in item.use.scatter:
            z = np.abs(scaled(item, answers[item.test.name], quantity))
            found.setdefault((item.test.kind, quantity), []).append(z[np.isfinite(z)])
    return {
        key: max(1.0, np.sqrt(used) * float(np.quantile(np.concatenate(z), LEVEL)) / NORMAL)
        for key, z in found.items()
        if sum(map(len, z))
    }


def quantile(values: np.ndarray, weights: np.ndarray, share: float) -> float:
    """Of weighted values: the smallest below which at least this share lies."""
    order = np.argsort(values)
    place = np.searchsorted(np.cumsum(weights[order]), share * weights.sum())
    return float(values[order][min(int(place), len(values) - 1)])


def _draw(
    random: np.random.Generator, count: int, centres: np.ndarray, spreads: Sequence[np.ndarray], chances: np.ndarray
) -> np.ndarray:
    """Places within the bounds, 0 to 1."""
    places = np.empty((count, centres.shape[1]))
    for i in range(count):
        k = int(random.choice(len(chances), p=chances))
        factor = np.linalg.cholesky(spreads[k])
        for _ in range(TRIES):
            places[i] = centres[k] + factor @ random.standard_normal(centres.shape[1])
            if np.all((places[i] >= 0) & (places[i] <= 1)):
                break
        places[i] = np.clip(places[i], 0, 1)
    return places


def _log_density(
    places: np.ndarray, centres: np.ndarray, spreads: Sequence[np.ndarray], chances: np.ndarray
) -> np.ndarray:
    """Of the mixture that was drawn from, up to what the bounds cut off."""
    parts = []
    for centre, spread, chance in zip(centres, spreads, chances):
        off = places - centre
        distance = np.einsum("ij,jk,ik->i", off, np.linalg.inv(spread), off)
        parts.append(np.log(chance) - 0.5 * (distance + np.linalg.slogdet(spread)[1]))
    return np.logaddexp.reduce(parts, axis=0)


def _weights(logarithms: np.ndarray) -> tuple[np.ndarray, float]:
    """Weights of their logarithms, evened out by an exponent where too few members would count."""
    exponent = 1.0
    while True:
        weights = np.exp(exponent * (logarithms - logarithms.max()))
        weights /= weights.sum()
        if 1 / np.sum(weights**2) >= LEAST_EFFECTIVE * len(weights) or exponent < 1e-3:
            return weights, exponent
        exponent *= 0.8


def _band(item: Item, quantity: str, runs: Sequence[Answer], weights: np.ndarray, error: float) -> Band:
    """Of the members and the error of the model beside each; members that stopped do not count at the rows they miss."""
    from scipy.stats import norm

    absolute, share = item.use.scatter[quantity]
    nodes = norm.ppf((np.arange(NODES) + 0.5) / NODES)
    nodes *= np.sqrt(NODES / np.sum(nodes**2))  # the deviation of the nodes is 1
    curves = np.array([run.columns[quantity] for run in runs])
    low, high = np.full(curves.shape[1], np.nan), np.full(curves.shape[1], np.nan)
    for row in range(curves.shape[1]):
        good = np.isfinite(curves[:, row])
        if not good.any():
            continue
        y = curves[good, row]
        values = (y[:, None] + error * np.hypot(absolute, share * y)[:, None] * nodes).ravel()
        weight = np.repeat(weights[good], NODES)
        low[row], high[row] = (quantile(values, weight, q) for q in ((1 - LEVEL) / 2, (1 + LEVEL) / 2))
    measured = item.test[quantity][item.use.rows]
    return Band(low, high, float(np.mean((measured >= low) & (measured <= high))))
