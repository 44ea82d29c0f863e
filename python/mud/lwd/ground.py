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
FRAMES = 1e-3  # fields of the last drop are written so often [s]


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
            young, poisson = (*(float(x) for x in self.material.split(":")[1:]), 0.3)[:2]
        except ValueError:
            young, poisson = -1.0, 0.0
        if not (young > 0 and 0 <= poisson < 0.5):
            raise InputError(f"{self.material}: an elastic layer is elastic:YOUNG or elastic:YOUNG:POISSON, in kPa")
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
    interval: float = 0.06  # from drop to drop [s]
    width: float = 2.4  # of the ground that is computed [m]
    depth: float = 2.4  # down to a base that does not move [m]
    absorbing: bool = True  # sides that let waves out
    fixed: bool = field(default=False, repr=False)  # sides held instead: to show what they change

    def __post_init__(self):
        wet = any(layer.elastic is None for layer in self.layers)
        if wet and (self.suction is None) == (self.water_table is None):
            raise InputError("give the suction [kPa] or the depth of the water table [m]: one of the two")
        if not self.interval > 1.5 * self.device.pulse:
            raise InputError(
                f"drops follow each other after {self.interval:g} s, and a pulse lasts {self.device.pulse:g} s: "
                "at least one and a half times as long"
            )
        if min(self.width, self.depth) < 6 * self.device.radius:
            raise InputError("width and depth of the ground are at least six radii of the plate")
        if sum(layer.thickness for layer in self.layers[:-1]) >= self.depth:
            raise InputError(f"the layers reach below the base, at {self.depth:g} m: give a larger depth")
        if self.rain > 0 and not self.rain_hours > 0:
            raise InputError("rain needs its duration in hours")
        if self.rain > 0 and self.layers[0].elastic:
            raise InputError("rain falls on soil: the upper layer is elastic, and lets no water in")
        if self.measured < 1 or self.seating < 0:
            raise InputError("at least one drop is measured")

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
        first = 2.0 + 3600 * self.rain_hours * (self.rain > 0)
        return [first + i * self.interval for i in range(len(self.drops))]

    @property
    def depths(self) -> list[float]:
        """Of the points on the axis [m]."""
        return [x * self.device.radius for x in DEPTHS if x * self.device.radius < self.depth]


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


def scene_of(test: Test, record: str = "force.txt") -> str:
    """The text of the scene; a recorded force stands in the file `record` beside it."""
    device, a = test.device, test.device.radius
    drops = ", ".join(f"'{name}'" for name in test.drops)
    wet, rain = test.wet, test.rain > 0 and test.wet
    calm = ["rest", *(["rain"] if rain else []), "seat"]
    calm_words = ", ".join(f"'{name}'" for name in calm)
    sigma_plate = device.mass * G / (math.pi * a**2)
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
    if rain:
        lines += [
            f"&stage name = 'rain' analysis = 'quasi_static' duration = {3600 * test.rain_hours:g} /",
            f"&load group = 'top' kind = 'rain' value = {test.rain / 3.6e6:g} stages = 'rain' /",
        ]
    lines.insert(
        lines.index(next((x for x in lines if "name = 'rain'" in x), lines[-1])),
        "&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 zero_displacements = 'yes' /",
    )
    shape = f"file = '{record}'" if device.record else f"kind = 'half_sine' period = {device.pulse:g}"
    lines += [
        "&stage name = 'seat' analysis = 'static' duration = 1 /",
        *(f"&stage name = '{name}' analysis = 'dynamic' duration = {test.interval:g} /" for name in test.drops[:-1]),
        f"&stage name = '{test.drops[-1]}' analysis = 'dynamic' duration = {test.interval:g} output_dt = {FRAMES:g} /",
        f"&history name = 'fall' {shape} stages = {drops} /",
        f"&plate name = 'plate' group = 'top_1' mass = {device.mass:g} force = {-device.peak:.9g} history = 'fall' /",
        f"&load group = 'top_1' kind = 'pressure' value = {sigma_plate:.9g} stages = 'seat', {drops} /",
        "&fix group = 'left' field = 'u_r' /",
        "&fix group = 'bottom' field = 'u_z' /",
        f"&fix group = 'right' field = 'u_r' stages = {calm_words}{', ' + drops if test.fixed else ''} /",
    ]
    if test.absorbing and not test.fixed:
        lines.append(f"&absorbing group = 'right' stages = {drops} /")
    lines += [f"&point name = '{point_of(d)}' r = 0 z = {-d:g} /" for d in test.depths]
    return "\n".join(lines) + "\n"


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
