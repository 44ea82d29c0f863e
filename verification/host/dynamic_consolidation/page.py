# SPDX-License-Identifier: MIT
"""Dynamic consolidation of a half space in closed form: displacements at the surface and 1 m below."""
import numpy as np
from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="inertia of the mixture, flow and, as an option, seepage inertia of a saturated elastic soil give the waves "
          "of the closed form",
    kind="exact",
    input="`scene.nml`: k 1e-8 m2, a triangular pulse of 10 kPa until 0.02 s, a column of 8 m with K_w = 1e12 kPa, 200 "
          "cells, Taylor-Hood, rho_inf 0.9, dt 1e-4 s, to 0.06 s",
    reference="the convolution integral of a half space of incompressible water and grains (below); exact modes of a "
              "column for compressible water in "
              "`dynamic_consolidation.csv`",
    seconds=11, quick=6, pictures=("dynamic_consolidation.png",))
MAKES = (Script("dynamic_consolidation.py", ("dynamic_consolidation.csv",), 18),)

M, K_OVER_ETA, POROSITY, RHO_S, RHO_W, LOAD = 1.2e4, 1e-8 / 1e-6, 0.8 / 1.8, 2.7, 1.0, 10.0
RHO = (1 - POROSITY) * RHO_S + POROSITY * RHO_W
FRONT = Tolerance("cells of 0.05 m against a pulse 2 m long, 100 steps up its front; the front itself is a kink: half "
                  "as many cells give 2.1e-3, half the step no less",
                  absolute=2e-3)


def pulse(t):
    return LOAD * np.interp(t, [0, 0.01, 0.02], [0, 1, 0], left=0, right=0)


def displacement(depth, times, seepage_inertia, panels=4000):
    """The convolution integral; midpoint rule over the smooth part, its error below 1e-6."""
    a = (RHO - RHO_W if seepage_inertia else RHO) / M
    b = 1 / (K_OVER_ETA * M)
    arrival = np.sqrt(a) * depth
    out = np.zeros(len(times))
    for i, t in enumerate(times):
        if t <= arrival:
            continue
        s = arrival + (np.arange(panels) + 0.5) * (t - arrival) / panels
        kernel = np.exp(-b * s / (2 * a)) * np.i0(b / (2 * a) * np.sqrt(np.maximum(s**2 - a * depth**2, 0)))
        out[i] = np.sum(pulse(t - s) * kernel) * (t - arrival) / panels / (np.sqrt(a) * M)
    return out


def check(bench):
    """Time, displacement and closed form by seepage inertia and place."""
    curves = {}
    for inertia in ("yes",) if bench.quick else ("yes", "no"):
        h = tables.columns(bench.host("scene.nml", [("seepage_inertia = 'yes'",
                                                     f"seepage_inertia = '{inertia}'")]) / "histories.csv")
        for place, depth in (("surface", 0.0), ("deep", 1.0)):
            exact = displacement(depth, h["time"], inertia == "yes")
            curves[inertia, place] = h["time"], -h[place + ".u_z"], exact
            bench.near(f"seepage inertia {inertia}, {place}: displacement / largest",
                       -h[place + ".u_z"] / np.max(exact), exact / np.max(exact), FRONT)
    return curves


def draw(bench, curves, plt):
    figure, axes = plt.subplots(1, 2, figsize=(7.6, 3.2))
    for axis, inertia in zip(axes, ("yes", "no")):
        for (kind, place), (t, u, exact) in curves.items():
            if kind == inertia:
                colour = "C0" if place == "surface" else "C1"
                axis.plot(t, exact * 1e3, color=colour, label=f"closed form, {place}")
                axis.plot(t[::15], u[::15] * 1e3, "o", ms=3, color=colour)
        axis.set(xlabel="time [s]", ylabel="displacement [mm]", title=f"seepage inertia: {inertia}")
        axis.legend()
    bench.save(figure, "dynamic_consolidation.png")
