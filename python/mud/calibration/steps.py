# SPDX-License-Identifier: MIT
"""The path of a test without the noise of its record: rows that are equal or step back within it."""

from __future__ import annotations

import numpy as np

FEW = 10  # steps; fewer say nothing of scatter
RECURS = 0.1  # share of neighbouring steps of opposite sign from which on a record scatters
DEVIATIONS, ROBUST = 6.0, 1.4826  # deviations that noise may reach; deviation of a median absolute difference
USUAL, REACH, MOST = 3.0, 0.01, 0.02  # usual steps, shares of the whole reach that a step back may have as noise
ROUNDING = 1e-9  # of the reach


def scatter_of(values: np.ndarray) -> float:
    """Six deviations of the steps from their neighbours' median, where steps change their sign again and again; else 0."""
    steps = np.diff(values)
    moving = steps[steps != 0]
    if len(moving) < FEW or np.mean(moving[1:] * moving[:-1] < 0) <= RECURS:
        return 0.0
    local = np.median(np.lib.stride_tricks.sliding_window_view(np.pad(moving, 2, mode="edge"), 5), axis=1)
    return min(DEVIATIONS * ROBUST * float(np.median(np.abs(moving - local))), MOST * float(np.ptp(values)))


def noise_of(values: np.ndarray) -> float:
    """By how much the values of a record may step back without a meaning: three usual steps, at most 1 % of the reach, and
    its scatter, at most 2 %."""
    size = np.abs(np.diff(values))
    usual = float(np.median(size[size > 0])) if np.any(size > 0) else 0.0
    return min(USUAL * usual, REACH * float(np.ptp(values))) + scatter_of(values)


def path_of(values: np.ndarray, noise: np.ndarray, equal_stay: bool = False) -> tuple[np.ndarray, np.ndarray, float]:
    """(rows that go on, rows among them behind which the path turns by more than noise, largest step back that was left out).

    noise : (rows,). The first of equal rows stays; with ``equal_stay`` all of them do.
    """
    tiny = ROUNDING * float(np.ptp(values))
    begun = np.flatnonzero(np.abs(values - values[0]) > noise[0])
    way = np.sign(values[begun[0]] - values[0]) if len(begun) else 1.0
    kept, turns, i = [0], [], 1
    while i < len(values):
        ahead = way * (values[i] - values[kept[-1]])
        if ahead > tiny or equal_stay and ahead == 0:
            kept.append(i)
        elif ahead < -max(noise[kept[-1]], tiny):
            turns.append(kept[-1])  # from there on again, the other way
            way, i = -way, kept[-1]
        i += 1
    rows = np.array(kept)
    left = np.setdiff1d(np.arange(len(values)), rows)
    behind = np.abs(values[left] - values[rows[np.searchsorted(rows, left) - 1]])
    return rows, np.array(turns, dtype=int), float(behind.max(initial=0.0))


def without_noise(values: np.ndarray, by_stress: bool, equal_stay: bool) -> tuple[np.ndarray, np.ndarray, float]:
    """``path_of`` a strain, or of the logarithm of a stress: there the last of equal rows stays, when the sample has settled,
    and what was left out is a share."""
    if not by_stress:
        return path_of(values, np.full(len(values), noise_of(values)), equal_stay)
    positive = values[values > 0]
    stress = np.maximum(values, 0.1 * float(positive.min()) if len(positive) else 1.0)[::-1]
    noise = np.maximum(noise_of(np.log(stress)), scatter_of(stress) / stress)  # a share, or as large at every stress
    kept, turns, back = path_of(np.log(stress), noise, equal_stay)
    last = len(values) - 1
    return last - kept[::-1], last - turns[::-1], back
