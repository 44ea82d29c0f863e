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
MOST = 1e4  # stress below a plate, of a wrong unit rather than of a device [kPa]
SHORTEST, LIGHTEST, HEAVIEST, HIGHEST = 1e-3, 1e-4, 1.0, 10.0  # likewise pulse [s], masses [Mg], height of fall [m]
FLEXIBLE, RIGID = 2.0, math.pi / 2  # shape factors of a plate under uniform stress, and of a rigid one [-]


@dataclass(frozen=True)
class Device:
    """What falls on what. Forces in kN, masses in Mg, lengths in m, times in s. What is 0 is not known."""

    name: str
    standard: str  # where the test is described
    peak: float  # of the half sine [kN]; without a load cell that of the formula, also beside a record
    pulse: float  # duration of the half sine [s]
    radius: float  # of the plate [m]
    mass: float  # that rests on the ground: plate and guide [Mg]
    shape: float  # f of the formula [-]
    poisson: float  # nu of the formula [-]
    cell: bool  # a load cell measures the force of the formula
    fall_mass: float  # that falls [Mg]
    fall: float  # its height [m]
    buffer: float = 0.0  # stiffness of the spring that it meets [kN/m]; 0: the pulse is given
    damping: float = 0.0  # of a dashpot beside the spring [kN s/m]
    record: str = ""  # file with the measured force, in place of the half sine
    words: str = ""

    @property
    def area(self) -> float:
        return math.pi * self.radius**2

    def modulus(self, deflection: float, peak: float | None = None) -> float:
        """f (1 - nu^2) sigma r/s [kPa], of a deflection [m] and, where a load cell measures it, the peak force [kN]."""
        force = peak if self.cell and peak is not None else self.peak
        return self.shape * (1 - self.poisson**2) * force / self.area * self.radius / deflection

    def force(self, time: np.ndarray) -> np.ndarray:
        """Force that is given, downwards, at times since the start of a drop [kN]."""
        if self.record:
            t, f = force_of(self.record)
            return np.interp(time, t, f)
        return np.where((time > 0) & (time < self.pulse), self.peak * np.sin(np.pi * time / self.pulse), 0.0)

    @property
    def largest(self) -> float:
        """Largest force on the plate [kN]; of a mass that falls that on a rigid base."""
        if self.buffer:
            return self.on_rigid_base()[0]
        return float(force_of(self.record)[1].max()) if self.record else self.peak

    @property
    def flight(self) -> float:
        """Time of the fall [s]; 0 where the pulse is given."""
        return math.sqrt(2 * self.fall / G) if self.buffer else 0.0

    def on_rigid_base(self) -> tuple[float, float]:
        """Peak force [kN] and duration [s] of the pulse of mass and spring, of a plate that does not move."""
        sag, omega = self.fall_mass * G / self.buffer, math.sqrt(self.buffer / self.fall_mass)
        speed = G * self.flight
        return self.buffer * (sag + math.hypot(sag, speed / omega)), (
            math.pi + 2 * math.atan(sag * omega / speed)
        ) / omega


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
        False,
        0.01,
        0.72,
        words="10 kg from 0.72 m on steel springs, plate of 300 mm, deflection by an accelerometer on the plate",
    ),
    "prima": Device(
        "prima",
        "ASTM E2583",
        0.0,
        0.0,
        0.15,
        0.0,
        RIGID,
        0.35,
        True,
        0.0,
        0.0,
        words="a mass on rubber buffers, load cell, plate of 300 mm, deflection by a geophone",
    ),
}
OPTIONS = {"peak": "--peak", "pulse": "--pulse", "radius": "--radius", "mass": "--plate-mass", "shape": "--shape",
           "fall_mass": "--fall-mass", "fall": "--fall", "buffer": "--buffer", "damping": "--buffer-damping"}


def device_of(name: str, record: str | os.PathLike | None = None, **values: float | None) -> Device:
    """A device with values of one's own; those that are None stay. Raises InputError for values that none has, and for
    those that are missing."""
    if name not in DEVICES:
        raise InputError(f"there is no device {name}; there are {', '.join(DEVICES)}")
    given = {key: value for key, value in values.items() if value is not None}
    for key, value in given.items():
        if key != "poisson" and not (math.isfinite(value) and (value > 0 or (key == "damping" and value == 0))):
            raise InputError(f"{key} of the device is {value:g} ({OPTIONS[key]}); it is above 0")
    device = replace(DEVICES[name], **given)
    if not 0 <= device.poisson <= 0.5:
        raise InputError(f"Poisson's ratio of the formula is {device.poisson:g}; it lies from 0 to 0.5")
    falls = [key for key in ("fall_mass", "fall", "buffer", "damping") if key in given]
    pulse = [key for key in ("pulse", *([] if not device.cell else ["peak"])) if key in given]
    if falls and (pulse or record is not None):
        other = "--force" if record is not None else OPTIONS[pulse[0]]
        raise InputError(
            f"{OPTIONS[falls[0]]} lets a mass fall on a buffer, which makes the pulse, and {other} gives the pulse: "
            "leave one of the two out"
        )
    if pulse and record is not None:
        raise InputError(f"--force gives the measured pulse, and {OPTIONS[pulse[0]]} another: leave one of the two out")
    if falls and not device.buffer:
        raise InputError(f"{OPTIONS[falls[0]]} needs the stiffness of the buffer in kN/m: --buffer")
    needed = ("fall_mass", "fall") if device.buffer else () if record is not None else ("peak", "pulse")
    missing = [OPTIONS[key] for key in (*needed, "mass") if not getattr(device, key)]
    if missing:
        raise InputError(
            f"the device {name} needs {', '.join(missing)}: its force depends on the height of fall and on "
            "the buffers that are set, and its load cell shows it. Give --peak and --pulse, or --force FILE with the "
            "measured force, or --fall-mass, --fall and --buffer for a mass that falls on a spring; and --plate-mass, "
            "what rests on the ground"
        )
    if record is not None:
        t, f = force_of(record)
        record = str(pathlib.Path(record).resolve())
        device = replace(device, record=record, pulse=float(t[-1] - t[0]), peak=device.peak or float(f.max()))
    stress, pulse = device.largest / device.area, device.on_rigid_base()[1] if device.buffer else device.pulse
    for what, good in (
        (f"the plate presses with up to {stress:.3g} kPa", stress <= MOST),
        (f"the pulse lasts {1e3 * pulse:.3g} ms", pulse >= SHORTEST),
        (f"{1e3 * device.mass:.3g} kg rest on the ground", LIGHTEST <= device.mass <= HEAVIEST),
        (f"{1e3 * device.fall_mass:.3g} kg fall", device.fall_mass <= HEAVIEST),
        (f"the mass falls from {device.fall:g} m", device.fall <= HIGHEST),
    ):
        if not good:
            raise InputError(
                f"{what}, as in no device: forces are in kN, times in ms, the radius in mm, the fall in m, masses in kg and "
                "the buffer in kN/m"
            )
    return device


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
