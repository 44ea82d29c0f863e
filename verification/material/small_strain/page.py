# SPDX-License-Identifier: MIT
"""Secant shear modulus and damping of the first cycle against shear strain, beside Darendeli's curves."""
import math

import recorded
from point_steps import ACROSS, MIDDLE, times
from point_walk import Path, Soil, Walker
from tools.bench import ROOT, parameters
from tools.page import Page, Script
from tools.pictures import COLOURS

PAGE = Page(
    claim="what the published set and `karlsruhe_cyclic` give for G/G_max and damping against shear strain, beside Darendeli's curves "
          "for sand at 1 atm",
    kind=("experiment", "fitted", "regression"),
    input="one drained cycle of simple shear about p' 100 kPa, e 0.8: shear strain +-gamma, normal stresses held; secant between the turns, "
          "damping = area of the loop/(2 pi G gamma^2); G_max by eq. (3)",
    reference="Darendeli (2001), mean curves: PI 0, OCR 1, mean effective stress 1 atm, 1 Hz, 10 cycles; an empirical model of resonant column and "
              "torsional shear tests",
    seconds=4, quick=1, pictures=("small_strain.png",))
MAKES = (Script("make_results.py", ("results.csv",), 3),)

SIZES = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
LITERATURE = "Darendeli"
CYCLIC = "karlsruhe_cyclic"
SET = parameters(ROOT / f"drivers/materials/{CYCLIC}.nml")
P_ATM = 101.325
G_0 = {CYCLIC: SET["G_0"]}   # of the others 125, the published one


def soils():
    return {**recorded.soils(), CYCLIC: Soil(properties=tuple(SET.items()))}


def largest_modulus(name):
    """Eq. (3) [kPa]"""
    return G_0.get(name, 125) * P_ATM * (2.97 - MIDDLE) ** 2 / (1 + MIDDLE) * math.sqrt(100 / P_ATM)


def cycle(soil, size, parts=100):
    """Rows along the first cycle after the first quarter."""
    path = Path(soil, MIDDLE).lead("ssseee").go(max(20, math.ceil(size / 2e-5)), times(size, ACROSS)).row()
    for sign in (-1, 1):
        for _ in range(2 * parts):
            path.go(max(1, math.ceil(size / parts / 2e-5)), times(sign * size / parts, ACROSS)).row()
    return path


def stiffness_damping(name, rows, size):
    """(G/G_max, damping [%]) of the soil of that name."""
    tau, gamma = [row["stress"][3] for row in rows], [row["strain"][3] for row in rows]
    modulus = (max(tau) - min(tau)) / (2 * size)
    work = sum(0.5 * (a + b) * (d - c) for a, b, c, d in zip(tau, tau[1:], gamma, gamma[1:]))
    return modulus / largest_modulus(name), 100 * work / (2 * math.pi * modulus * size ** 2)


def darendeli(size, pressure=1.0, cycles=10, frequency=1.0):
    """(G/G_max, damping [%]) of Darendeli (2001) for PI 0, OCR 1; pressure in atm."""
    strain, reference, a = 100 * size, 0.0352 * pressure ** 0.3483, 0.9190
    ratio = 1 / (1 + (strain / reference) ** a)
    area = 4 * (strain - reference * math.log((strain + reference) / reference)) / (strain ** 2 / (strain + reference)) - 2
    masing = 100 / math.pi * area   # a = 1; corrected for the curvature a:
    c = (-1.1143 * a * a + 1.8618 * a + 0.2523, 0.0805 * a * a - 0.0710 * a - 0.0095, -0.0005 * a * a + 0.0002 * a + 0.0003)
    masing = c[0] * masing + c[1] * masing ** 2 + c[2] * masing ** 3
    least = 0.8005 * pressure ** -0.2889 * (1 + 0.2919 * math.log(frequency))
    return ratio, least + (0.6329 - 0.0057 * math.log(cycles)) * ratio ** 0.1 * masing


def measure(bench):
    walker, found = Walker(bench.build), {}
    runs = {(size, name): walker.start(cycle(soil, size)) for size in SIZES for name, soil in soils().items()}
    for k, quantity in enumerate(("G/G_max", "damping [%]")):
        for size in SIZES:
            found[f"{quantity} at {size:.0e}", LITERATURE] = darendeli(size)[k]
            for name in soils():
                found[f"{quantity} at {size:.0e}", name] = stiffness_damping(name, runs[size, name].result(), size)[k]
    return found


def check(bench):
    measured = measure(bench)
    recorded.compare(bench, measured)
    return measured


def texts(bench):
    return {"README.md": {"values": recorded.table(bench, (LITERATURE, *soils()))}}


def draw(bench, _, plt):
    walker = Walker(bench.build)
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    sizes = [10 ** (-6 + k / 4) for k in range(17)]
    curves = {LITERATURE: [darendeli(size) for size in sizes]}
    for name, soil in soils().items():
        runs = walker.run_all([cycle(soil, size) for size in sizes])
        curves[name] = [stiffness_damping(name, rows, size) for rows, size in zip(runs, sizes)]
    for (name, values), colour, style in zip(curves.items(), ("black", *COLOURS), ("--", "-", "-", "-")):
        for axis, k in zip(axes, (0, 1)):
            axis.semilogx(sizes, [v[k] for v in values], style, color=colour, label=name)
    axes[0].set(xlabel="shear strain amplitude [-]", ylabel="G/G_max [-]", ylim=(0, 1.05))
    axes[1].set(xlabel="shear strain amplitude [-]", ylabel="damping [%]", ylim=(0, None))
    axes[0].legend()
    bench.save(figure, "small_strain.png")
