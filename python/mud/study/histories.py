# SPDX-License-Identifier: MIT
"""Histories of a run, and how far those of two runs lie apart."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np

from ..host import HostRun

FIELDS = {"u_r": 0, "u_z": 0, "p_w": 1, "p_c": 1}  # unknowns of a named point; kinds that are compared with each other
PLATE = {"u_r": 0, "u_z": 0}
NO_ANSWER = 1e-2  # an answer that changes less, as a share of the largest of its kind, is none
# A change that is none: of displacements over the size of the mesh [-], of pressures [kPa], of forces over the largest.
ROUNDING = (1e-13, 1e-9, 1e-10)
MISSED = 0.1  # what lies between two steps of the rougher run counts from here on, as a share of the largest change


class Histories:
    """Answers of a run over time: unknowns of named points, motion of plates; forces by name."""

    def __init__(self, folder: str | os.PathLike):
        run = HostRun(folder)
        self.values: dict[str, tuple[np.ndarray, np.ndarray]] = {}
        points = run.histories
        self.steps = max(1, len(points["time"]) - 1)
        self._take(points, [n for n in points if n.rsplit(".", 1)[-1] in FIELDS])
        if (run.folder / "contact.csv").exists():
            contact = run.table("contact")
            plates = {n[: -len(".load")] for n in contact if n.endswith(".load")}
            self._take(contact, [n for n in contact if n.rsplit(".", 1)[0] in plates and n.rsplit(".", 1)[-1] in PLATE])
            self.forces = {n: (contact["time"], contact[n]) for n in contact if n.endswith(".thrust")}
        else:
            self.forces = {}
        for table in run.reactions.values():
            for name in table:
                if name.endswith((".force_r", ".force_z")):
                    self._add_force(name, table["time_of_forces"], table[name])
        nodes = [run.table(path.stem) for path in sorted(run.folder.glob("nodes_*.csv"))[:1]]
        self.nodes = len(nodes[0]["r"]) if nodes else 0
        self.size = max((np.ptp(nodes[0][x]) for x in ("r", "z")), default=1.0) if nodes else 1.0

    def _take(self, table, names):
        for name in names:
            if table[name].dtype.kind == "f" and len(table[name]) > 1:
                self.values[name] = _ascending(table["time"], table[name])

    def _add_force(self, name, time, value):
        if value.dtype.kind != "f":
            return
        if name in self.forces:
            before = self.forces[name]
            time, value = np.r_[before[0], time], np.r_[before[1], value]
        self.forces[name] = _ascending(time, value)

    def has(self, name: str) -> bool:
        return name in self.values or name in self.forces

    def history(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Times and values of an answer."""
        return self.values[name] if name in self.values else self.forces[name]

    def change(self, name: str) -> float:
        """Largest change of an answer since its start; of a force, which has no value there, its largest value."""
        value = self.history(name)[1]
        return float(np.max(np.abs(value - (value[0] if name in self.values else 0.0))))

    def moves(self, name: str) -> bool:
        """Whether an answer changes by more than what rounding leaves of one that is zero by symmetry."""
        if name in self.values:
            least = (ROUNDING[0] * self.size, ROUNDING[1])[FIELDS[name.rsplit(".", 1)[-1]]]
        else:
            least = ROUNDING[2] * max(self.change(n) for n in self.forces)
        return self.change(name) > least

    def answers(self) -> list[str]:
        """Unknowns that change, by more than a hundredth of the largest change of their kind."""
        changes = {n: self.change(n) for n in self.values}
        kinds = {n: FIELDS[n.rsplit(".", 1)[-1]] for n in changes}
        largest = [max([x for n, x in changes.items() if kinds[n] == k], default=0.0) for k in (0, 1)]
        return [n for n, x in changes.items() if x > NO_ANSWER * largest[kinds[n]] and self.moves(n)]


def _ascending(time, value):
    last = np.r_[time[1:] > time[:-1], True]  # where a stage ends, its last row counts
    return time[last], value[last]


@dataclass
class Difference:
    """How far two histories lie apart: the largest distance over the largest change of the better one, and where."""

    size: float
    times: np.ndarray
    values: np.ndarray

    def against(self, other: Difference) -> bool:
        """Whether it points the other way than another difference, over its times."""
        return float(np.dot(self.values, np.interp(self.times, other.times, other.values))) < 0


def difference(rough: Histories, good: Histories, name: str) -> Difference:
    """Difference of two histories at the times of the rougher one.

    The better one is taken between its steps by monotone cubics: straight lines would err as much as the steps. What
    the better one shows between two steps of the rougher one, and the rougher one does not, counts where it is large.
    """
    change = good.change(name)
    (t, y), (s, z) = rough.history(name), good.history(name)
    if not change > 0:
        return Difference(0.0 if rough.change(name) == 0 else np.inf, t, 0 * y)
    seen = (t >= s[min(1, len(s) - 1)]) & (t <= s[-1])
    seen[-1] = True
    apart = between(s, z, np.clip(t[seen], s[0], s[-1])) - y[seen]
    # The two steps of the rougher run on either side of every moment of the better one.
    at = np.clip(np.searchsorted(t, s), 1, len(t) - 1)
    around = np.array([y[np.clip(at + k, 0, len(y) - 1)] for k in (-2, -1, 0, 1)])
    outside = np.max(np.maximum(z - around.max(0), around.min(0) - z))
    size = max(np.max(np.abs(apart)), outside if outside > MISSED * change else 0.0) / change
    return Difference(float(size), t[seen], apart)


def distance(rough: Histories, good: Histories, name: str) -> float:
    """Largest distance of two histories, over the largest change of the better one."""
    return difference(rough, good, name).size


def between(x: np.ndarray, y: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Monotone cubics through points (x ascending), at places between the first and the last (Fritsch, Carlson)."""
    if len(x) < 3:
        return np.interp(at, x, y)
    h = np.diff(x)
    d = np.diff(y) / h
    slope = np.empty_like(y)
    w1, w2 = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
    same = d[1:] * d[:-1] > 0
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        slope[1:-1] = np.where(same, (w1 + w2) / (w1 / d[:-1] + w2 / d[1:]), 0.0)
    slope[0], slope[-1] = d[0], d[-1]
    i = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(h) - 1)
    s = (at - x[i]) / h[i]
    return (
        y[i] * (1 + 2 * s) * (1 - s) ** 2
        + h[i] * slope[i] * s * (1 - s) ** 2
        + y[i + 1] * s**2 * (3 - 2 * s)
        - h[i] * slope[i + 1] * s**2 * (1 - s)
    )
