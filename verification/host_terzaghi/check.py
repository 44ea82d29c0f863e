"""Terzaghi's series against the column: pressures and settlement."""
import csv
import pathlib
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(here.parent))
import numpy as np  # noqa: E402
from host_tools import Checks, arguments, figure, read, run  # noqa: E402

M, CONDUCTIVITY, LOAD, DEPTH = 1.2e4, 1e-12 / 1e-6, 100.0, 1.0   # E (1-nu)/((1+nu)(1-2nu)), k/eta_w
C_V = M * CONDUCTIVITY


def pressure(below, t, terms=2000):
    """Excess pressure at a depth below the drained top."""
    m = np.pi / 2 * (2 * np.arange(terms) + 1)
    return LOAD * np.array([np.sum(2 / m * np.sin(m * below / DEPTH) * np.exp(-m**2 * C_V * s / DEPTH**2)) for s in t])


def settlement(t, terms=20000):
    m = np.pi / 2 * (2 * np.arange(terms) + 1)
    return LOAD * DEPTH / M * np.array([1 - np.sum(2 / m**2 * np.exp(-m**2 * C_V * s / DEPTH**2)) for s in t])


args = arguments(__doc__)
checks = Checks("terzaghi")
results = {}
# Second order in time (rho_inf = 0) and steps of 3 % of the time: (0.03)**2, about 1e-3 of the load; the jump at t = 0
# is not smooth, so the first times are left out. Settlement of a coarse mesh: the same.
allowed = {"quadratic": 1e-3, "linear": 2e-3}   # linear pressures on cells of up to 0.067 m: h**2/8 p"
for pressures in ("linear",) if args.quick else ("linear", "quadratic"):
    h = read(run(here / "scene.nml", [("pressures = 'linear'", f"pressures = '{pressures}'")]) / "histories.csv")
    t = h["time"]
    late = C_V * t / DEPTH**2 > 0.01
    checks.near(f"{pressures} pressure at the base / load", h["base.p_w"][late] / LOAD, pressure(1.0, t[late]) / LOAD, allowed[pressures])
    checks.near(f"{pressures} pressure half-way / load", h["middle.p_w"][late] / LOAD, pressure(0.5, t[late]) / LOAD, allowed[pressures])
    checks.near(f"{pressures} settlement / final", -h["top.u_z"][late] / (LOAD / M), settlement(t[late]) / (LOAD / M), allowed[pressures])
    results[pressures] = h
# Compressible water, against terzaghi.csv (1 kPa, the load at once).
with open(here / "terzaghi.csv", encoding="utf-8") as lines:
    rows = [r for r in csv.DictReader(line.lstrip("# ") for line in lines if not line.startswith(("# T", "# m")))
            if r["ramped"] == "0"]
for case in ("stiff_water", "soft_water"):
    mine = [r for r in rows if r["case"] == case]
    modulus = mine[0]["K_w"]
    h = read(run(here / "scene.nml", [("k_w = 1.0e12", f"k_w = {modulus}"), ("value = 100", "value = 1"),
                                     ("'linear'", "'quadratic'")]) / "histories.csv")
    for place, depth in (("base", 1.0), ("middle", 0.5)):
        at = [r for r in mine if abs(float(r["depth"]) - depth) < 1e-9 and float(r["t"]) < 100]
        value = np.interp([float(r["t"]) for r in at], h["time"], h[place + ".p_w"])
        checks.near(f"{case}: pressure, {place}, {len(at)} times / load", value, [float(r["p_w"]) for r in at], 1e-3)
    at = [r for r in mine if float(r["depth"]) == 0 and float(r["t"]) < 100]
    value = np.interp([float(r["t"]) for r in at], h["time"], -h["top.u_z"])
    checks.near(f"{case}: settlement / final", value * M, [float(r["settlement"]) * M for r in at], 1e-3)
if args.plot:
    fig, axes = figure(2)
    t = results["linear"]["time"][1:]
    for place, depth, colour in (("base", 1.0, "C0"), ("middle", 0.5, "C1")):
        axes[0].semilogx(C_V * t, pressure(depth, t) / LOAD, color=colour, label=f"series, depth {depth} m")
        axes[0].semilogx(C_V * t[::12], results["linear"][place + ".p_w"][1::12] / LOAD, "o", ms=3, color=colour)
    axes[1].semilogx(C_V * t, settlement(t) * M / LOAD, color="C2", label="series")
    axes[1].semilogx(C_V * t[::12], -results["linear"]["top.u_z"][1::12] * M / LOAD, "o", ms=3, color="C2", label="host")
    axes[1].invert_yaxis()
    for axis, name in zip(axes, ("pressure / load", "settlement / final")):
        axis.set(xlabel="time factor", ylabel=name, xlim=(1e-3, 2))
        axis.legend()
    fig.savefig(here / "terzaghi.png", dpi=130)
checks.end()
