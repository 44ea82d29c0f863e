# SPDX-License-Identifier: MIT
"""Degree of saturation with hydraulic hysteresis: Hostun sand, closed loops, cycles in driver and host."""
import math

import numpy as np

from tools import tables
from tools.bench import CASES, ROOT, parameters
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="between a main drying and a main wetting curve the degree of saturation follows the scanning rule, in the "
          "driver and in the host; fitted to the loops of Hostun sand it leaves an rms of 0.016",
    kind=("exact", "study"),
    input="the suctions of the laboratory at constant volume; ten cycles between two suctions; `scene.nml`, suction "
          "cycles of a block of sand",
    reference="the scanning rule integrated apart from the library (Runge-Kutta, docs/theory/material.md section "
              "2.1.1); the laboratory: Lins, Zou & Schanz (2007), `calibration/data`",
    seconds=6, quick=6, pictures=("hysteresis.png",))

DATA = ROOT / "calibration/data/hostun_sand_retention_loops.csv"
FITTED = CASES.parent / "materials/hostun_hysteresis.nml"
HOSTUN = {name: parameters(FITTED)[name] for name in ("P_a", "n_x", "m_x", "P_aw", "n_w", "m_w", "S_min", "S_max", "b_d",
                                                      "b_w", "Omega")}
LOOP = slice(16, 37)   # points 17 to 37 of the laboratory: the scanning loop
RK_STEPS = 400         # of the reference, between two rows

RULE = Tolerance("what the reference's steps leave", absolute=1e-9)
MEETS = Tolerance("what the fit leaves over all points is 0.0158 with 40 steps between two points; digits of the fit",
                  absolute=1.7e-2)
MEETS_LOOP = Tolerance("0.0073 by the same fit", absolute=7.8e-3)
CLOSES = Tolerance("the tenth cycle against the ninth: the start has faded", absolute=1e-9)
LOSES = Tolerance("a loop dissipates", absolute=0.0)
NODE = Tolerance("suction is that of the node, saturation that of the quadrature point beside it",
                 absolute=2e-5)


def main_curve(x, air_entry, n, m, p):
    return p["S_min"] + (p["S_max"] - p["S_min"]) * math.log(math.e + (x / air_entry) ** n) ** -m


def suction_of(s, air_entry, n, m, p):
    """Suction of a main curve at a saturation."""
    share = (s - p["S_min"]) / (p["S_max"] - p["S_min"])
    return air_entry * max(math.exp(share ** (-1 / m)) - math.e, 0.0) ** (1 / n)


def slope(x, air_entry, n, m, p):
    power = (x / air_entry) ** n
    inside = math.e + power
    return -(p["S_max"] - p["S_min"]) * m * math.log(inside) ** (-m - 1) * n * power / (x * inside)


def rate(x, s, drying, p):
    """dS_w/dx of the rule."""
    if drying:
        on = suction_of(s, p["P_a"], p["n_x"], p["m_x"], p)
        return (x / on) ** p["b_d"] * slope(on, p["P_a"], p["n_x"], p["m_x"], p)
    on = suction_of(s, p["P_aw"], p["n_w"], p["m_w"], p)
    return (on / x) ** p["b_w"] * slope(on, p["P_aw"], p["n_w"], p["m_w"], p)


def follow(xs, s, p):
    """Saturations along suctions x, all above zero, from one that lies in the band."""
    path = [s]
    for a, b in zip(xs, xs[1:]):
        h, drying = (b - a) / RK_STEPS, b > a
        for i in range(RK_STEPS if h else 0):
            x = a + i * h
            k1 = rate(x, s, drying, p)
            k2 = rate(x + h / 2, s + h / 2 * k1, drying, p)
            k3 = rate(x + h / 2, s + h / 2 * k2, drying, p)
            k4 = rate(x + h, s + h * k3, drying, p)
            s += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            lower = main_curve(x + h, p["P_aw"], p["n_w"], p["m_w"], p)
            s = min(max(s, lower), main_curve(x + h, p["P_a"], p["n_x"], p["m_x"], p))
        path.append(s)
    return np.array(path)


def case(suctions):
    """A case of mud_triax: suctions one after the other at constant volume, a row at each."""
    text = (CASES / "drying_constant_volume.nml").read_text(encoding="utf-8")
    head, stage = text[:text.index("&stage")], text[text.index("&stage"):]
    head = head.replace("../materials", str(CASES.parent / "materials"))
    values = "".join(f"   {name} = {value}\n" for name, value in (HOSTUN | {"hysteresis": 1, "bonding": 0}).items())
    head = head.replace("&material\n", "&material\n" + values)
    head = head.replace("p_eff = 2000.0", f"p_eff = 2000.0\n   suction = {suctions[0]}")
    stage = stage.replace("increment = 1e-3", "increment = 0.05")
    stage = stage.replace("output_interval = 1e-3", "output_interval = 1")
    return head + "".join(stage.replace("suction_end = 1000.0", f"suction_end = {s}") for s in suctions[1:])


def check(bench):
    measured = tables.columns(DATA)
    suctions, s_w = measured["suction_kPa"], measured["S_w"]
    run = bench.driver_text(case(suctions[1:]), "hostun")["s_w"]
    first = main_curve(suctions[1], HOSTUN["P_a"], HOSTUN["n_x"], HOSTUN["m_x"], HOSTUN)
    bench.near("Hostun sand: S_w along the suctions of the laboratory", run, follow(suctions[1:], first, HOSTUN), RULE)
    off = np.concatenate(([HOSTUN["S_max"]], run)) - s_w
    bench.below("Hostun sand: rms of S_w over all points", math.sqrt(np.mean(off**2)), MEETS)
    bench.below("Hostun sand: rms of S_w over the scanning loop", math.sqrt(np.mean(off[LOOP]**2)), MEETS_LOOP)

    cycles = [1.0] + [x for _ in range(10) for x in (*np.linspace(1.05, 2.5, 30), *np.linspace(2.45, 1.0, 30))]
    loops = bench.driver_text(case(cycles), "loops")["s_w"]
    ninth, tenth = loops[8 * 60:9 * 60 + 1], loops[9 * 60:10 * 60 + 1]
    bench.near("ten cycles: they close", tenth, ninth, CLOSES)
    x = np.array(cycles[9 * 60:])
    work = float(np.sum((x[1:] + x[:-1]) / 2 * np.diff(tenth)))
    bench.below("ten cycles: integral of p_c dS_w over the last", work, LOSES, "kPa")

    rows = tables.columns(bench.host("scene.nml") / "histories.csv")
    sand = parameters() | {"P_aw": 2.0, "n_w": parameters()["n_x"], "m_w": parameters()["m_x"], "b_d": 3.7, "b_w": 2.9}
    xs = rows["soil.p_c"] * rows["soil.e"] ** sand["Omega"]
    wanted = follow(xs, main_curve(xs[0], sand["P_a"], sand["n_x"], sand["m_x"], sand), sand)
    bench.near("suction cycles in the host: S_w", rows["soil.S_w"], wanted, NODE)
    return measured, run, cycles, loops, rows


def draw(bench, results, plt):
    measured, run, cycles, loops, rows = results
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2))
    axes[0].semilogx(measured["suction_kPa"][1:], measured["S_w"][1:], "k.", label="Lins et al. (2007)")
    axes[0].semilogx(measured["suction_kPa"][1:], run, color=COLOURS[0], label="model")
    axes[0].set(xlabel="suction [kPa], logarithmic", ylabel="S$_w$ [-]", title="Hostun sand")
    axes[0].legend()
    axes[1].plot(cycles, loops, color=COLOURS[0])
    axes[1].set(xlabel="suction [kPa]", ylabel="S$_w$ [-]", title="ten cycles close and dissipate")
    axes[2].semilogx(rows["soil.p_c"], rows["soil.S_w"], color=COLOURS[0])
    axes[2].set(xlabel="suction [kPa], logarithmic", ylabel="S$_w$ [-]", title="suction cycles in the host")
    bench.save(figure, "hysteresis.png")
