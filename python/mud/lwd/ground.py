# SPDX-License-Identifier: MIT
"""The scene of a test: ground, plate and drops as mud_host reads them."""

from __future__ import annotations

import math
import pathlib
from dataclasses import dataclass, field

from ..errors import InputError
from ..material import material_file
from .device import G, Device, force_of

SEATING, MEASURED = 3, 3  # drops of the standards
DEPTHS = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0)  # of points on the axis, over the plate's radius
CELL, GROWTH = 0.3, 0.45  # cell at the plate over its radius; growth of cells over the distance from it [-]
PENALTY, STIFFER = 1e8, 100.0  # of the contact by default [kN/m3]; over Young's modulus and radius on hard ground [-]
MOST_PERMEABLE, HEAVIEST_GRAINS = 1e-6, 10.0  # beyond which a number has another unit [m2], [Mg/m3]
LOOSEST = 10.0  # void ratio, beyond which it is in per cent [-]
FRAMES = 1e-3  # fields of the last drop are written so often [s]
BEFORE = 5e-4  # a mass that falls is this near to its buffer when the drop begins [s]
SOFTEST = 1e3  # Young's modulus of an elastic layer, below it of a wrong unit: plates would sink by more than 20 mm [kPa]


@dataclass(frozen=True)
class Layer:
    """A material of the library or a file, or an elastic one; thickness [m], inf: down to the base."""

    material: str  # name, file, or elastic:YOUNG[:POISSON] [kPa, -]
    void_ratio: float = 0.6
    thickness: float = math.inf

    @property
    def elastic(self) -> tuple[float, float] | None:
        """Young's modulus [kPa] and Poisson's ratio of an elastic layer."""
        if not self.material.startswith("elastic:"):
            return None
        try:
            young, *given = (float(x) for x in self.material.split(":")[1:])
            (poisson,) = given or (0.3,)
        except ValueError:
            young, poisson = -1.0, 0.0
        if not (0 < young < math.inf and 0 <= poisson < 0.5):
            raise InputError(f"{self.material}: an elastic layer is elastic:YOUNG or elastic:YOUNG:POISSON, in kPa")
        if young < SOFTEST:
            raise InputError(
                f"{self.material}: Young's modulus is {young:g} kPa, too soft for any of these devices ({SOFTEST:g} kPa or "
                f"more); it is given in kPa: {young:g} MPa are elastic:{1000 * young:g}"
            )
        return young, poisson


@dataclass(frozen=True)
class Test:
    """A test that is to be computed."""

    __test__ = False  # not a test of pytest

    device: Device
    layers: tuple[Layer, ...]
    suction: float | None = None  # uniform [kPa]
    water_table: float | None = None  # depth [m]
    rain: float = 0.0  # [mm/h]
    rain_hours: float = 0.0
    permeability: float = 1e-11  # intrinsic [m2]
    k_0: float = 0.5
    rho_s: float = 2.65  # of the grains [Mg/m3]
    seating: int = SEATING
    measured: int = MEASURED
    interval: float = 0.1  # from drop to drop [s]
    width: float = 2.4  # of the ground that is computed [m]
    depth: float = 2.4  # down to a base that does not move [m]
    tied: bool = False  # the plate is joined to the ground; else it presses only
    absorbing: bool = True  # sides that let waves out
    fixed: bool = field(default=False, repr=False)  # sides held instead: to show what they change

    def __post_init__(self):
        device, wet = self.device, self.wet
        if not wet and (self.suction, self.water_table) != (None, None):
            raise InputError("elastic ground is dry: it takes no suction and no water table")
        if wet and (self.suction is None) == (self.water_table is None):
            raise InputError("give the suction [kPa] or the depth of the water table [m]: one of the two")
        for what, value, least, words in (
            ("suction", self.suction, 0, "kPa; ground below water has --water-table"),
            ("water table", self.water_table, 0, "m below the surface; a plate stands on ground, not in water"),
            ("rain", self.rain, 0, "mm/h"),
            ("duration of the rain", self.rain_hours, 0, "h"),
            ("K_0", self.k_0, 0, ""),
        ):
            if value is not None and not least <= value < math.inf:
                raise InputError(f"the {what} is {value:g}; it is {least} or more {words}".rstrip())
        for what, value, most, unit in (
            ("permeability", self.permeability, MOST_PERMEABLE, " m2, of 10 m/s of water"),
            ("density of the grains", self.rho_s, HEAVIEST_GRAINS, " Mg/m3"),
            *(("void ratio", layer.void_ratio, LOOSEST, ": it is no per cent") for layer in self.layers),
            *(("thickness of a layer", layer.thickness, math.inf, "") for layer in self.layers[:-1]),
        ):
            if not 0 < value < most:
                below = f" and below {most:g}{unit}" if unit else ""
                raise InputError(f"the {what} is {value:g}; it is above 0{below}")
        # A recorded or given pulse; of a mass that falls that on a rigid base, the shortest.
        pulse = device.on_rigid_base()[1] if device.buffer else device.pulse
        if not 1.5 * pulse < self.interval < math.inf:
            raise InputError(
                f"drops follow each other after {self.interval:g} s, and a pulse lasts {pulse:.3g} s: "
                "at least one and a half times as long"
            )
        if not 6 * device.radius <= min(self.width, self.depth) < math.inf:
            raise InputError("width and depth of the ground are at least six radii of the plate")
        if sum(layer.thickness for layer in self.layers[:-1]) >= self.depth:
            raise InputError(f"the layers reach below the base, at {self.depth:g} m: give a larger depth")
        if (self.rain > 0) != (self.rain_hours > 0):
            raise InputError("rain needs its rate in mm/h and its duration in hours: --rain and --rain-hours")
        if self.rain > 0 and self.layers[0].elastic:
            raise InputError("rain falls on soil: the upper layer is elastic, and lets no water in")
        if self.measured < 1 or self.seating < 0:
            raise InputError("at least one drop is measured, and the number of seating drops is 0 or more")

    @property
    def drops(self) -> list[str]:
        """Names of the stages of the drops."""
        return [f"drop_{i + 1}" for i in range(self.seating + self.measured)]

    @property
    def wet(self) -> bool:
        return any(layer.elastic is None for layer in self.layers)

    @property
    def starts(self) -> list[float]:
        """Times of the run at which drops begin [s]."""
        first = 2.0 + 3600 * self.rain_hours + self.lead
        return [first + i * (self.lead + self.interval) for i in range(len(self.drops))]

    @property
    def lead(self) -> float:
        """Time of a stage before each drop, in which a mass falls [s]."""
        return max(0.0, self.device.flight - BEFORE)

    @property
    def depths(self) -> list[float]:
        """Of the points on the axis above the base [m]."""
        return [x * self.device.radius for x in DEPTHS if x * self.device.radius < 0.99 * self.depth]


def point_of(depth: float) -> str:
    """Name of the point on the axis at a depth [m]."""
    return f"d{1000 * depth:.0f}"


def cells(near: float, far: float, smallest: float) -> tuple[int, float]:
    """Even number of cells between two distances from the plate [m], and the ratio of each to the one before."""
    n = math.log((smallest + GROWTH * far) / (smallest + GROWTH * near)) / math.log(1 + GROWTH)
    n = max(2, 2 * math.ceil(n / 2))
    return n, ((smallest + GROWTH * far) / (smallest + GROWTH * near)) ** (1 / n)


def write_record(device: Device, path: pathlib.Path) -> None:
    """The force of a record as a factor on its peak, for &history."""
    t, f = force_of(device.record)
    path.write_text("".join(f"{a:.9g} {b:.9g}\n" for a, b in zip(t, f / f.max())), encoding="utf-8")


def scene_of(test: Test) -> str:
    """The text of the scene; a recorded force stands in force.txt beside it."""
    device = test.device
    moving = [x for name in test.drops for x in ([f"fall{name[4:]}"] * bool(device.buffer) + [name])]
    drops = quoted(moving)
    wet, rain = test.wet, test.rain > 0 and test.wet
    # The plate is set before the rain: ground that heaves or settles under a plate that is held would meet it anyhow.
    calm = ["rest", "seat", *["rain"] * rain]
    lines = [
        "! A light falling weight deflectometer on unsaturated soil, written by mud_lwd. Units m, s, kPa, Mg.",
        f"&scene name = 'lwd' fields = '{'u-p_w-p_c' if wet else 'u'}' gravity = {G}"
        + " initial_flow = 'subtract'" * (wet and not rain and test.suction is not None)
        + " threads = 1 goals = 'plate.u_z' /",
        *mesh_of(test),
        *regions_of(test),
    ]
    if wet:
        water = (
            f"p_w = {-test.suction:g} p_c = {test.suction:g}"
            if test.water_table is None
            else f"water_table = {-test.water_table:g}"
        )
        lines += [
            f"&permeability name = 'k' intrinsic = {test.permeability:g} /",
            f"&initial {water} stress = 'geostatic' surface = 0 k_0 = {test.k_0:g} /",
        ]
        if test.layers[0].elastic is None:
            lines.append(f"&fix group = 'top_2' field = 'p_a' stages = {drops} /")
    else:
        lines.append(f"&initial stress = 'geostatic' surface = 0 k_0 = {test.k_0:g} /")
    lines.append("&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 zero_displacements = 'yes' /")
    lines.append("&stage name = 'seat' analysis = 'static' duration = 1 /")
    if rain:
        lines += [
            f"&stage name = 'rain' analysis = 'quasi_static' duration = {3600 * test.rain_hours:g} /",
            f"&load group = 'top' kind = 'rain' value = {test.rain / 3.6e6:g} stages = 'rain' /",
        ]
    for name in test.drops:
        if device.buffer:
            lines.append(f"&stage name = 'fall{name[4:]}' analysis = 'dynamic' duration = {test.lead:.9g} /")
        often = f" output_dt = {FRAMES:g}" if name == test.drops[-1] else ""
        lines.append(f"&stage name = '{name}' analysis = 'dynamic' duration = {test.interval:g}{often} /")
    lines += [
        *plate_of(test, [*calm[1:], *moving]),
        *masses_of(test, calm),
        "&fix group = 'left' field = 'u_r' /",
        "&fix group = 'bottom' field = 'u_z' /",
        f"&fix group = 'right' field = 'u_r' stages = {quoted(calm + moving * test.fixed)} /",
    ]
    if test.absorbing and not test.fixed:
        lines.append(f"&absorbing group = 'right' stages = {drops} /")
    lines += [f"&point name = '{point_of(d)}' r = 0 z = {-d:g} /" for d in test.depths]
    return "\n".join(lines) + "\n"


def quoted(names) -> str:
    return ", ".join(f"'{name}'" for name in names)


def plate_of(test: Test, stands: list[str]) -> list[str]:
    """The plate and the force on it. It presses on the ground in the stages in which it `stands`, and leaves it where
    it is thrown up, unless it is tied."""
    device, a = test.device, test.device.radius
    lines, thrown = [], ""
    if not device.buffer:
        shape = "file = 'force.txt'" if device.record else f"kind = 'half_sine' period = {device.pulse:g}"
        lines.append(f"&history name = 'fall' {shape} stages = {quoted(test.drops)} /")
        thrown = f" force = {-device.largest:.9g} history = 'fall'"
    if test.tied:
        weight = device.mass * G / device.area
        return [
            *lines,
            f"&plate name = 'plate' group = 'top_1' mass = {device.mass:g}{thrown} /",
            f"&load group = 'top_1' kind = 'pressure' value = {weight:.9g} stages = {quoted(stands)} /",
        ]
    # The contact gives way by a hundredth of what hard ground does.
    hard = STIFFER * test.layers[0].elastic[0] / a if test.layers[0].elastic else 0.0
    stiffer = f" penalty = {hard:g}" if hard > PENALTY else ""
    return [
        *lines,
        f"&plate name = 'plate' r = 0, {a:g} z = 0 mass = {device.mass:g} weight = 'yes'{thrown} /",
        f"&contact name = 'face' slave = 'top_1' master = 'plate'{stiffer} stages = {quoted(stands)} /",
        f"&fix group = 'plate' field = 'u_z' hold = 'yes' stages = 'rest' /",
    ]


def masses_of(test: Test, calm: list[str]) -> list[str]:
    """A mass for each drop: it is held, falls on the buffer, is thrown up, and is caught when the drop is over."""
    lines, device = [], test.device
    for name in test.drops if device.buffer else ():
        mass, falls = f"mass{name[4:]}", [f"fall{name[4:]}", name]
        others = [x for other in test.drops if other != name for x in (f"fall{other[4:]}", other)]
        lines += [
            f"&plate name = '{mass}' r = 0, {device.radius / 2:g} z = {2 + device.fall:g} mass = {device.fall_mass:g}"
            " weight = 'yes' /",
            f"&fix group = '{mass}' field = 'u_z' hold = 'yes' stages = {quoted(calm + others)} /",
            f"&buffer upper = '{mass}' lower = 'plate' stiffness = {device.buffer:g} damping = {device.damping:g}"
            f" clearance = {device.fall:g} stages = {quoted(falls)} /",
        ]
    return lines


def mesh_of(test: Test) -> list[str]:
    """Cells that grow from the rim of the plate and from the surface."""
    a = test.device.radius
    inside, shrink = 4, 0.6
    outside, grow = cells(0, test.width - a, CELL * a)
    breaks = [0.0]
    for layer in test.layers[:-1]:
        breaks.append(breaks[-1] + layer.thickness)
    breaks.append(test.depth)
    down = [cells(x, y, CELL * a) for x, y in zip(breaks, breaks[1:])][::-1]
    return [
        f"&mesh r = 0, {a:g}, {test.width:g} r_cells = {inside}, {outside} r_ratio = {shrink:g}, {grow:.6g}",
        f"      z = {', '.join(f'{-x:g}' for x in reversed(breaks[1:]))}, 0"
        f" z_cells = {', '.join(str(n) for n, _ in down)} z_ratio = {', '.join(f'{1 / q:.6g}' for _, q in down)} /",
    ]


def regions_of(test: Test) -> list[str]:
    """Materials and regions; the first layer is the upper one."""
    lines, known, count = [], {}, len(test.layers)
    for i, layer in enumerate(test.layers):
        if layer.material not in known:
            known[layer.material] = f"m{len(known) + 1}"
            name = known[layer.material]
            if layer.elastic:
                young, poisson = layer.elastic
                lines.append(f"&elastic name = '{name}' young = {young:g} poisson = {poisson:g} /")
            else:
                lines.append(f"&mud name = '{name}' file = '{material_file(layer.material).resolve()}' tangent = 3 /")
        kind = " drainage = 'dry'" if layer.elastic and test.wet else ""
        if not layer.elastic:
            kind = " retention = 'material' permeability = 'k'"
        for column in (1, 2) if count > 1 else ("",):
            group = f"group = 'block_{column}_{count - i}' " if count > 1 else ""
            lines.append(
                f"&region {group}material = '{known[layer.material]}' void_ratio = {layer.void_ratio:g} "
                f"rho_s = {test.rho_s:g}{kind} /"
            )
    return lines
