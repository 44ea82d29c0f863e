# SPDX-License-Identifier: MIT
"""What a run of a test says: deflection, modulus, rebound and settlement of every drop, depth of influence."""

from __future__ import annotations

import math
import pathlib
from dataclasses import dataclass, field

import numpy as np

from ..host import HostRun
from ..study.histories import between
from ..study.runs import Failed
from .device import G
from .ground import Test, point_of

INFLUENCE = 0.1  # share of the plate's deflection that the ground still moves at the depth of influence [-]


@dataclass
class Drop:
    """A drop, from the moment at which it begins. Lengths in m, times in s, downwards positive."""

    name: str
    measured: bool  # not a seating drop
    deflection: float  # largest
    at: float  # when
    velocity: float  # largest
    settlement: float  # left at its end
    force: float  # largest [kN]
    modulus: float  # by the formula of the device [kPa]
    lift: float  # largest height above the place before the drop
    ringing: float  # largest velocity in the last tenth of its interval, over the largest of all [-]

    @property
    def rebound(self) -> float:
        return self.deflection - self.settlement


@dataclass
class Answers:
    """Of one run."""

    drops: list[Drop]
    influence: float  # depth at which the ground moves by a tenth of the plate's deflection, last drop [m]
    share: float  # of the plate's deflection at the deepest point, last drop [-]
    tension: float  # largest pull of a tied plate at the ground, which a loose one would not have [kPa]
    saturation: float  # of the ground below the plate, before the drops [-]; nan: no water
    void_ratio: float  # there
    suction: float  # there [kPa]
    history: dict[str, np.ndarray] = field(repr=False, default_factory=dict)  # columns of histories.csv; times ascend

    @property
    def deflection(self) -> float:
        """Mean of the measured drops [m]."""
        return float(np.mean([d.deflection for d in self.drops if d.measured]))

    @property
    def modulus(self) -> float:
        """Of the mean deflection of the measured drops [kPa]."""
        first = next(d for d in self.drops if d.measured)
        return first.modulus * first.deflection / self.deflection

    @property
    def velocity(self) -> float:
        """Mean of the largest velocities of the measured drops [m/s]."""
        return float(np.mean([d.velocity for d in self.drops if d.measured]))

    def numbers(self) -> dict[str, float]:
        """Every answer that has an error, by its name."""
        told = {"modulus": self.modulus, "deflection": self.deflection, "influence": self.influence}
        told["settlement"] = sum(drop.settlement for drop in self.drops)
        for drop in self.drops:
            for name in ("deflection", "modulus", "force", "rebound", "settlement"):
                told[f"{drop.name}.{name}"] = getattr(drop, name)
        return told


def answers_of(test: Test, folder: str | pathlib.Path) -> Answers:
    """Answers of the output folder of a run of mud_host."""
    run = HostRun(folder)
    plate, points, device = run.table("contact"), run.histories, test.device
    time, moved, speed = plate["time"], -plate["plate.u_z"], -plate["plate.v_z"]
    force = _force(test, plate)
    drops = []
    for i, (name, start) in enumerate(zip(test.drops, test.starts)):
        within = _within(time, start, start + test.interval)
        t, s, v = time[within] - start, moved[within] - moved[within][0], speed[within]
        peak, at = _peak(t, s)
        if not peak > 0:
            raise Failed(f"the plate does not go down in {name}: it needs more force, or a longer --interval to rest")
        load = _peak(t, force[within])[0] if device.buffer else device.largest
        late = np.abs(v[t > 0.9 * test.interval])
        drops.append(
            Drop(
                name,
                i >= test.seating,
                peak,
                at,
                float(v.max()),
                float(s[-1]),
                load,
                device.modulus(peak, load),
                float(max(0.0, -s.min())),
                float(late.max() / v.max()),
            )
        )
    start = test.starts[-1]
    within = _within(points["time"], start, start + test.interval)
    deepest = [0.0, *test.depths]
    shares = [1.0]
    for depth in test.depths:
        u = -points[f"{point_of(depth)}.u_z"][within]
        shares.append(float((u - u[0]).max()) / drops[-1].deflection)
    # What the ground gives back to the plate: its inertia, weight and the force of the drop.
    reaction = device.mass * (plate["plate.a_z"] + G) + force
    seen = time >= test.starts[0]
    first = point_of(test.depths[0])
    row = int(np.argmax(points["time"] >= test.starts[0] - 1e-9))
    # Where a stage ends, its last row counts. The table of contacts lacks the row of the beginning.
    last, own = (np.r_[x[1:] > x[:-1], True] for x in (points["time"], time))
    history = {"time": points["time"][last]}
    for name, values in (("force", force), ("deflection", moved - moved[seen][0])):
        history[name] = np.interp(history["time"], time[own], values[own])
    if test.wet:
        for depth in test.depths[:4]:
            for p in ("p_w", "p_c"):
                history[f"{p}_{point_of(depth)}"] = points[f"{point_of(depth)}.{p}"][last]
    return Answers(
        drops,
        _depth_of(deepest, shares, test.depth),
        shares[-1],
        float(max(0.0, -reaction[seen].min() / device.area)) if test.tied else 0.0,
        float(points[f"{first}.S_w"][row]) if test.wet else math.nan,
        float(points[f"{first}.e"][row]),
        float(points[f"{first}.p_c"][row]) if test.wet else math.nan,
        history,
    )


def _force(test, plate):
    """On the plate, downwards, at its times [kN]: the given one, or that of the buffers."""
    time, device, force = plate["time"], test.device, np.zeros_like(plate["time"])
    for name, start in zip(test.drops, test.starts):
        within = _within(time, start - test.lead, start + test.interval)
        if device.buffer:
            mass = f"mass{name[4:]}"
            short = plate["plate.u_z"] - plate[f"{mass}.u_z"] - device.fall
            push = device.buffer * short + device.damping * (plate["plate.v_z"] - plate[f"{mass}.v_z"])
            force[within] = np.where(short > 0, np.maximum(0.0, push), 0.0)[within]
        else:
            force[within] = device.force(time[within] - start)
    return force


def _within(time, start, end):
    """Rows of a drop; of two at its start, where a stage ends, the first."""
    close = 1e-9 * max(1.0, abs(end))
    return (time >= start - close) & (time <= end + close)


def _peak(time, moved):
    """The largest of a history, between its steps, and when."""
    last = np.r_[time[1:] > time[:-1], True]
    time, moved = time[last], moved[last]
    top = int(moved.argmax())
    fine = np.linspace(time[max(top - 1, 0)], time[min(top + 1, len(time) - 1)], 201)
    # A parabola through the three rows about it: monotone cubics have their largest value at a row.
    if 0 < top < len(time) - 1:
        values = np.polyval(
            np.polyfit(time[top - 1 : top + 2] - time[top], moved[top - 1 : top + 2], 2), fine - time[top]
        )
    else:
        values = between(time, moved, fine)
    best = int(values.argmax())
    return float(values[best]), float(fine[best])


def _depth_of(depths, shares, base):
    """Depth at which a share that falls with depth is INFLUENCE [m].

    Between points its logarithm is straight, below the last one the share itself, down to a base that does not move.
    """
    for (d0, s0), (d1, s1) in zip(zip(depths, shares), zip(depths[1:], shares[1:])):
        if s1 <= INFLUENCE < s0:
            return d0 + (d1 - d0) * (math.log(s0) - math.log(INFLUENCE)) / (math.log(s0) - math.log(max(s1, 1e-3)))
    return base - (base - depths[-1]) * INFLUENCE / shares[-1]
