# SPDX-License-Identifier: MIT
"""Terzaghi's series against the column: pressures and settlement."""
import numpy as np
from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="u and p_w together (S_w = 1, quasi-static, no gravity) give the pressure isochrones and the settlement of "
          "one-dimensional consolidation",
    kind="exact",
    input="`scene.nml`: a column of 1 m, drained on top, 40 cells, rho_inf 0, steps growing by 3 % from 1 ms; linear "
          "and quadratic pressures, K_w = 1e12 kPa and the two "
          "of `terzaghi.csv`",
    reference="Terzaghi's series; `terzaghi.csv` for compressible water, checked by numerical inversion of the "
              "transforms",
    seconds=8, quick=4, pictures=("terzaghi.png",))
MAKES = (Script("terzaghi.py", ("terzaghi.csv",), 3),)

M, CONDUCTIVITY, LOAD, DEPTH = 1.2e4, 1e-12 / 1e-6, 100.0, 1.0   # E (1-nu)/((1+nu)(1-2nu)), k/eta_w
C_V = M * CONDUCTIVITY
SECOND_ORDER = Tolerance("second order in time (rho_inf = 0) and steps of 3 % of the time: (0.03)**2, about 1e-3 of "
                         "the load; the jump at t = 0 is not smooth, so "
                         "the first times are left out; the settlement of this mesh has the same", absolute=1e-3)
LINEAR = Tolerance("linear pressures on cells of up to 0.067 m: h**2/8 p''", absolute=2e-3)


def pressure(below, t, terms=2000):
    """Excess pressure at a depth below the drained top."""
    m = np.pi / 2 * (2 * np.arange(terms) + 1)
    return LOAD * np.array([np.sum(2 / m * np.sin(m * below / DEPTH) * np.exp(-m**2 * C_V * s / DEPTH**2)) for s in t])


def settlement(t, terms=20000):
    m = np.pi / 2 * (2 * np.arange(terms) + 1)
    return LOAD * DEPTH / M * np.array([1 - np.sum(2 / m**2 * np.exp(-m**2 * C_V * s / DEPTH**2)) for s in t])


def check(bench):
    """Histories with linear pressures."""
    results = {}
    for pressures in ("linear",) if bench.quick else ("linear", "quadratic"):
        h = tables.columns(bench.host("scene.nml", [("pressures = 'linear'",
                                                     f"pressures = '{pressures}'")]) / "histories.csv")
        t, allowed = h["time"], LINEAR if pressures == "linear" else SECOND_ORDER
        late = C_V * t / DEPTH**2 > 0.01
        bench.near(f"{pressures} pressure at the base / load", h["base.p_w"][late] / LOAD,
                   pressure(1.0, t[late]) / LOAD,
                   allowed)
        bench.near(f"{pressures} pressure half-way / load", h["middle.p_w"][late] / LOAD, pressure(0.5, t[late]) / LOAD,
                   allowed)
        bench.near(f"{pressures} settlement / final", -h["top.u_z"][late] / (LOAD / M),
                   settlement(t[late]) / (LOAD / M), allowed)
        results[pressures] = h
    # Compressible water: 1 kPa, the load at once.
    rows = [r for r in tables.rows(bench.here / "terzaghi.csv", header_in_comment=True) if r["ramped"] == "0"]
    for case in ("stiff_water", "soft_water"):
        mine = [r for r in rows if r["case"] == case]
        h = tables.columns(bench.host("scene.nml", [("k_w = 1.0e12", f"k_w = {mine[0]['K_w']}"),
                                                    ("value = 100", "value = 1"),
                                                    ("'linear'", "'quadratic'")]) / "histories.csv")
        for place, depth in (("base", 1.0), ("middle", 0.5)):
            at = [r for r in mine if abs(float(r["depth"]) - depth) < 1e-9 and float(r["t"]) < 100]
            value = np.interp([float(r["t"]) for r in at], h["time"], h[place + ".p_w"])
            bench.near(f"{case}: pressure, {place}, {len(at)} times / load", value, [float(r["p_w"]) for r in at],
                       SECOND_ORDER)
        at = [r for r in mine if float(r["depth"]) == 0 and float(r["t"]) < 100]
        value = np.interp([float(r["t"]) for r in at], h["time"], -h["top.u_z"])
        bench.near(f"{case}: settlement / final", value * M, [float(r["settlement"]) * M for r in at], SECOND_ORDER)
    return results["linear"]


def draw(bench, linear, plt):
    figure, axes = plt.subplots(1, 2, figsize=(7.6, 3.2))
    t = linear["time"][1:]
    for place, depth, colour in (("base", 1.0, "C0"), ("middle", 0.5, "C1")):
        axes[0].semilogx(C_V * t, pressure(depth, t) / LOAD, color=colour, label=f"series, depth {depth} m")
        axes[0].semilogx(C_V * t[::12], linear[place + ".p_w"][1::12] / LOAD, "o", ms=3, color=colour)
    axes[1].semilogx(C_V * t, settlement(t) * M / LOAD, color="C2", label="series")
    axes[1].semilogx(C_V * t[::12], -linear["top.u_z"][1::12] * M / LOAD, "o", ms=3, color="C2", label="host")
    axes[1].invert_yaxis()
    for axis, name in zip(axes, ("pressure / load", "settlement / final")):
        axis.set(xlabel="time factor", ylabel=name, xlim=(1e-3, 2))
        axis.legend()
    bench.save(figure, "terzaghi.png")
