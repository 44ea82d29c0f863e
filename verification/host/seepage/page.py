# SPDX-License-Identifier: MIT
"""Seepage discharge by the reactions of mud_host: flow to a well (Thiem) and below a sheet pile (conformal mapping)."""
import numpy as np
from tools import tables
from tools.page import Page, Tolerance

PAGE = Page(
    claim="the discharge that a run writes is that of closed forms: flow to a well in a confined layer, and below a "
          "sheet pile at three depths, with the order of its singularity",
    kind="exact",
    input="`well.nml`: radius 0.2 m, R 20 m, layer 5 m, 30 kPa; `pile.nml`: layer 1 m, pile down to 0.25, 0.5 and 0.75 m, "
          "20 kPa, 4, 8 and 16 cells along the pile and along the gap below it",
    reference="Thiem's formula; complete elliptic integrals by the arithmetic-geometric mean",
    seconds=3, quick=3, pictures=("seepage.png",))

K = 1e-12 / 1e-6   # permeability over viscosity [m2/(kPa s)]
HALF = 10.0        # on either side of the plane of the pile [kPa]
ROUNDING = Tolerance("steady: what flows in flows out; rest of the storage after 1e9 s and Newton's tolerance of 1e-9",
                     relative=1e-6)
WELL = Tolerance("quadratic pressures on 12 cells: 1.1e-4; linear ones on the same cells are 1 % off", relative=2e-4)
FIRST = Tolerance("at the tip the pressure has the root of the distance: the discharge has order 1 on even meshes",
                  absolute=0.1)
PILE = Tolerance("what is left after one extrapolation of order 1", relative=2e-3)
SIZES = (4, 8, 16)
DEPTHS = (0.25, 0.5, 0.75)


def elliptic(modulus):
    """Complete elliptic integral of the first kind."""
    a, b = 1.0, np.sqrt(1 - modulus**2)
    for _ in range(6):
        a, b = (a + b) / 2, np.sqrt(a * b)
    return np.pi / 2 / a


def below_pile(depth):
    """Discharge [m2/s]; the map of the half strip to a half plane puts the tip at cos(pi s/T)."""
    return K * HALF * elliptic(np.cos(np.pi * depth / 2)) / elliptic(np.sin(np.pi * depth / 2))


def flows(bench, scene, changes, names):
    row = tables.columns(bench.host(scene, changes) / "reactions_flow.csv")
    return [row[f"{name}.outflow_w"][-1] for name in names]


def check(bench):
    """Discharges below the pile, by depth and mesh."""
    out, back = flows(bench, "well.nml", [], ("left", "right"))
    bench.near("well: out and in", -back, out, ROUNDING, "m3/s")
    bench.near("well: discharge", out, 2 * np.pi * 5 * K * 30 / np.log(100), WELL, "m3/s")
    found = {}
    for depth in DEPTHS:
        found[depth] = [flows(bench, "pile.nml", [
            ("r_cells = 4, 8", f"r_cells = {n}, {2 * n}"), ("z = -1, -0.5, 0", f"z = -1, {-depth}, 0"),
            ("z_cells = 4, 4", f"z_cells = {n}, {n}")], ("top",))[0] for n in SIZES]
        exact = below_pile(depth)
        errors = np.abs(np.array(found[depth]) / exact - 1)
        bench.note(f"pile {depth} m:", *(f"{e:.2%}" for e in errors), "with", *SIZES, "cells")
        bench.near(f"pile {depth} m: order", np.log2(errors[-2] / errors[-1]), 1, FIRST)
        bench.near(f"pile {depth} m: discharge, extrapolated", 2 * found[depth][-1] - found[depth][-2], exact, PILE, "m2/s")
    return found


def draw(bench, found, plt):
    figure, axis = plt.subplots(figsize=(4.6, 3.2))
    depth = np.linspace(0.05, 0.95, 91)
    axis.plot(depth, [below_pile(s) / (2 * HALF * K) for s in depth], label="closed form")
    for i, n in enumerate(SIZES):
        axis.plot(DEPTHS, [found[s][i] / (2 * HALF * K) for s in DEPTHS], "os^"[i], ms=4, label=f"host, {n} cells")
    axis.set(xlabel="depth of the pile / thickness of the layer", ylabel="discharge / (k h)", title="Flow below a sheet pile")
    axis.legend()
    bench.save(figure, "seepage.png")
