# SPDX-License-Identifier: MIT
"""Devices: the pulse that a drop gives, the plate, and the formula that makes a modulus of a deflection."""

from __future__ import annotations

import math
import os
import pathlib
from dataclasses import dataclass, replace

import numpy as np

from .._csv import rows_of
from ..errors import InputError

G = 9.81
FLEXIBLE, RIGID = 2.0, math.pi / 2  # shape factors of a plate under uniform stress, and of a rigid one [-]


@dataclass(frozen=True)
class Device:
    """What falls on what. Forces in kN, masses in Mg, lengths in m, times in s."""

    name: str
    standard: str  # where the test is described
    peak: float  # of the force [kN]
    pulse: float  # duration of the half sine [s]
    radius: float  # of the plate [m]
    mass: float  # that rests on the ground: plate and guide [Mg]
    shape: float  # f of the formula [-]
    poisson: float  # nu of the formula [-]
    record: str = ""  # file with the measured force, in place of the half sine
    words: str = ""

    @property
    def stress(self) -> float:
        """Largest mean stress under the plate [kPa]."""
        return self.peak / (math.pi * self.radius**2)

    def modulus(self, deflection: float) -> float:
        """f (1 - nu^2) sigma r/s [kPa], of a deflection [m]."""
        return self.shape * (1 - self.poisson**2) * self.stress * self.radius / deflection

    def force(self, time: np.ndarray) -> np.ndarray:
        """Force on the plate, downwards, at times since the start of a drop [kN]."""
        if self.record:
            t, f = force_of(self.record)
            return np.interp(time, t, f)
        return np.where((time > 0) & (time < self.pulse), self.peak * np.sin(np.pi * time / self.pulse), 0.0)


# E_vd = 1.5 r sigma/s with sigma = 0.1 MN/m2 and r = 150 mm: 22.5/s, s in mm. 1.5 is f (1 - nu^2) with f = 2 and nu =
# 0.5; 0.1 MN/m2 on the plate are 7.07 kN.
NOMINAL = 100.0 * math.pi * 0.15**2
DEVICES = {
    "zorn": Device(
        "zorn",
        "TP BF-StB B 8.3; ASTM E2835",
        NOMINAL,
        0.017,
        0.15,
        0.015,
        FLEXIBLE,
        0.5,
        words="10 kg from 0.72 m on steel springs, plate of 300 mm, deflection by an accelerometer on the plate",
    ),
    "prima": Device(
        "prima",
        "ASTM E2583",
        NOMINAL,
        0.018,
        0.15,
        0.015,
        RIGID,
        0.35,
        words="10 kg on rubber buffers, load cell, plate of 300 mm, deflection by a geophone; peak and pulse are yours",
    ),
}


def device_of(name: str, record: str | os.PathLike | None = None, **values: float | None) -> Device:
    """A device with values of one's own; those that are None stay. Raises InputError for values that none has."""
    if name not in DEVICES:
        raise InputError(f"there is no device {name}; there are {', '.join(DEVICES)}")
    device = replace(DEVICES[name], **{key: value for key, value in values.items() if value is not None})
    for key in ("peak", "pulse", "radius", "mass", "shape"):
        if not getattr(device, key) > 0:
            raise InputError(f"{key} of the device is {getattr(device, key):g}; it is above 0")
    if not 0 <= device.poisson <= 0.5:
        raise InputError(f"Poisson's ratio of the formula is {device.poisson:g}; it lies from 0 to 0.5")
    if record is None:
        return device
    t, f = force_of(record)
    return replace(device, record=str(pathlib.Path(record).resolve()), peak=float(f.max()), pulse=float(t[-1] - t[0]))


def record_of(path: str | os.PathLike) -> dict[str, np.ndarray]:
    """A record of a device: a CSV table with the columns time [ms], force [kN], deflection [mm], the last two
    downwards positive; one of them may be missing."""
    rows = [cells for _, cells in rows_of(path)]
    head = [cell.strip().lower() for cell in rows[0]] if rows else []
    if "time" not in head or not {"force", "deflection"} & set(head):
        raise InputError(
            f"{path}: the first line of a record is time,force,deflection (or two of them, time first); its units are "
            f"ms, kN and mm; here it is {','.join(head) or 'empty'}"
        )
    try:
        values = np.array([[float(cell) for cell in row] for row in rows[1:]])
        columns = {name: values[:, i] for i, name in enumerate(head) if name in ("time", "force", "deflection")}
    except (ValueError, IndexError) as problem:
        raise InputError(f"{path}: every line has {len(head)} numbers, divided by commas: {problem}") from problem
    if len(values) < 3 or not np.all(np.isfinite(values)) or np.any(np.diff(columns["time"]) <= 0):
        raise InputError(f"{path}: a record has three lines or more, all numbers finite, times that ascend")
    return columns


def force_of(path) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] from 0 and forces [kN] of a record, 0 at both ends."""
    record = record_of(path)
    if "force" not in record:
        raise InputError(f"{path}: the record has no column force")
    t, f = (record["time"] - record["time"][0]) / 1e3, record["force"]
    if not f.max() > 0 or np.abs(f[[0, -1]]).max() > 0.05 * f.max():
        raise InputError(f"{path}: the force is downwards positive [kN], and begins and ends below 5 % of its peak")
    f = f.copy()
    f[[0, -1]] = 0.0  # what is left would be a jump between two drops
    return t, f
