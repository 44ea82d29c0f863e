# SPDX-License-Identifier: MIT
"""Steps of strain paths and the comparison of their ends."""
import math

from point_walk import Path

AXIAL = (1.0, -0.5, -0.5, 0.0, 0.0, 0.0)     # triaxial compression at constant volume
ACROSS = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0)      # engineering shear 12
DENSE, LOOSE, MIDDLE = 0.735, 0.88, 0.8
STEP = 1e-5                                  # increments of strain, where nothing else is said


def times(factor, direction):
    return tuple(factor * d for d in direction)


def plus(*vectors):
    return tuple(map(sum, zip(*vectors)))


def increments(size, step=STEP):
    return max(1, math.ceil(abs(size) / step - 1e-9))


def straight(path, size, direction=AXIAL, step=STEP):
    """A straight strain step in increments of `step`."""
    return path.go(increments(size, step), times(size, direction)) if size else path


def per_cent(value, reference):
    return 100 * (value / reference - 1)


def last(rows):
    """The last state, None if the path failed."""
    return None if rows[-1]["failed"] else rows[-1]


def deviation(rows, clean):
    """q at the end against the path without events [%]."""
    return per_cent(last(rows).q, last(clean).q) if last(rows) else math.nan


def clean_path(walker, soil, e, to, step=STEP):
    return walker.start(straight(Path(soil, e), to, step=step).row())


def closed(path, points, direction_a=AXIAL, direction_b=ACROSS, step=STEP):
    """A polygon through (a, b), from and back to (0, 0), in increments of `step`."""
    at = (0.0, 0.0)
    for a, b in [*points, (0.0, 0.0)]:
        size = math.hypot(a - at[0], b - at[1])
        if size > 0:
            path.go(increments(size, step), plus(times(a - at[0], direction_a), times(b - at[1], direction_b)))
        at = (a, b)
    return path


def distance(rows, clean):
    """|sigma' - sigma'_clean|/|sigma'_clean| at the end [%]."""
    if not (last(rows) and last(clean)):
        return math.nan
    weights = (1, 1, 1, 2, 2, 2)
    a, b = last(rows)["stress"], last(clean)["stress"]
    return 100 * math.sqrt(sum(w * (x - y) ** 2 for w, x, y in zip(weights, a, b))
                           / sum(w * y * y for w, y in zip(weights, b)))
