# SPDX-License-Identifier: MIT
"""A bound that every state keeps, whatever the path: the stress ratio that its void ratio, pressure and suction allow."""
import math

from catalogue import P_MIN
from closed_forms import P, bonding, critical_void_ratio, lode

BOUND = "stress ratio beyond the bounding surface of its state, or p' below p_min [%]"
TRAIL = 5.0   # %: a state that softens trails behind the surface, which shrinks; the rest is error


def beyond(row):
    """By how much the stress ratio exceeds the largest that its state allows in any direction, or p' falls below p_min [%].

    M^b is written from docs/theory/material.md 3.6; the Lode angle is that of the stress.
    """
    p, s = row.p, row["stress"]
    deviator = [s[0] - p, s[1] - p, s[2] - p, *s[3:]]
    norm = math.sqrt(sum(d * d for d in deviator[:3]) + 2 * sum(d * d for d in deviator[3:]))
    low = max(-100.0, 100 * (1 - p / P_MIN))
    if p <= 0 or norm <= 1e-12 * p:   # without the guards p' may be negative
        return low
    a, b, c, ab, ac, bc = (d / norm for d in deviator)
    third = 3 * math.sqrt(6) * (a * (b * c - bc * bc) - ab * (ab * c - ac * bc) + ac * (ab * bc - b * ac))
    psi = row["e"] - critical_void_ratio(p, bonding(row["suction"], row["e"]))
    largest = P["M_c"] * lode(max(-1.0, min(1.0, third))) * math.exp(P["n_b"] * max(0.0, -psi))
    return max(100 * (math.sqrt(1.5) * norm / p / largest - 1), low)


def bounded(runs):
    return max(beyond(row) for rows in runs.values() for row in rows)
