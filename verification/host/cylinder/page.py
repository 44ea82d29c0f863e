# SPDX-License-Identifier: MIT
"""A thick elastic cylinder under internal pressure (Lame), with the observed order of convergence."""
import numpy as np
from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="linear elasticity in axisymmetry (a slice between smooth plates) with a pressure on a boundary, at the "
          "orders of its elements",
    kind="exact",
    input="`scene.nml`: inner radius 1 m, outer 2 m, 100 kPa inside, nu 0.3, a slice 0.25 m high, 4, 8 and 16 cells "
          "along r",
    reference="Lame's closed form",
    seconds=2, quick=2, every_build=True, pictures=("cylinder.png",))
MAKES = (Script("cylinder.py", ("cylinder.csv",), 1),)

A, B, P, E, NU = 1.0, 2.0, 100.0, 1.0e4, 0.3
FINEST = Tolerance("1.3e-5 measured on this mesh; third order: the next coarser one has 1e-4", absolute=2e-5)
THIRD = Tolerance("quadratic elements: order 3 of displacements (4 at nodes of such a smooth problem), on meshes that "
                  "are not fine", absolute=0.2)
SECOND = Tolerance("quadratic elements: order 2 of stresses, on meshes that are not fine", absolute=0.2)


def displacement(r):
    return (1 + NU) / E * P * A * A / (B * B - A * A) * ((1 - 2 * NU) * r + B * B / r)


def stresses(r):
    c = P * A * A / (B * B - A * A)
    return c * (1 - (B / r) ** 2), c * (1 + (B / r) ** 2)


def check(bench):
    """Nodes and points of the finest mesh."""
    errors = []
    for n in (4, 8, 16):
        out = bench.host("scene.nml", [("r_cells = 8", f"r_cells = {n}"),
                                       ("z_cells = 2", f"z_cells = {max(1, n // 4)}")])
        nodes, points = tables.columns(out / "nodes_load.csv"), tables.columns(out / "points_load.csv")
        s_r, s_t = stresses(points["r"])
        weight = points["weight"] / np.sum(points["weight"])
        errors.append([np.max(np.abs(nodes["u_r"] / displacement(nodes["r"]) - 1)),
                       np.sqrt(np.sum(weight * (points["s_rr"] - s_r) ** 2)) / P,
                       np.sqrt(np.sum(weight * (points["s_tt"] - s_t) ** 2)) / P])
    errors = np.array(errors)
    orders = np.log2(errors[:-1] / errors[1:])
    bench.note("errors of u_r, s_rr, s_tt:", *(f"{e:.2e}" for e in errors[-1]), " orders:",
               *(f"{o:.2f}" for o in orders[-1]))
    bench.below("u_r at the nodes, 16 cells", errors[-1][0], FINEST)
    bench.below("order of u_r: 3 less the order", 3 - orders[-1][0], THIRD)
    bench.near("order of the stresses", orders[-1][1:], 2, SECOND)
    return nodes, points


def draw(bench, results, plt):
    nodes, points = results
    figure, axes = plt.subplots(1, 2, figsize=(7.6, 3.2))
    r = np.linspace(A, B, 200)
    axes[0].plot(r, displacement(r) * 1e3, label="Lame")
    axes[0].plot(nodes["r"], nodes["u_r"] * 1e3, "o", ms=3, label="host")
    axes[0].set(xlabel="r [m]", ylabel="u_r [mm]")
    for value, key, colour in zip(stresses(r), ("s_rr", "s_tt"), ("C0", "C1")):
        axes[1].plot(r, value, color=colour, label=key)
        axes[1].plot(points["r"], points[key], ".", ms=3, color=colour)
    axes[1].set(xlabel="r [m]", ylabel="stress [kPa], tension positive")
    for axis in axes:
        axis.legend()
    bench.save(figure, "cylinder.png")
