# SPDX-License-Identifier: MIT
"""Degree of saturation with hydraulic hysteresis: Hostun sand, closed loops, cycles in driver and host."""
import math

import numpy as np

from tools import tables
from tools.bench import CASES, ROOT, parameters
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="between a main drying and a main wetting curve the degree of saturation follows the scanning rule with its "
          "turning points, in the driver and in the host; loops close; fitted to Hostun sand it leaves an rms of 0.016",
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
RK_STEPS = 800         # of the reference, of equal ratio along a branch

RULE = Tolerance("what the reference's steps leave", absolute=1e-9)
MEETS = Tolerance("what the fit leaves over all points is 0.0159, and digits of the fit", absolute=1.65e-2)
MEETS_LOOP = Tolerance("0.0069 by the same fit", absolute=7.4e-3)
CLOSES = Tolerance("the tenth cycle against the second: a loop closes at its turning point, up to rounding",
                   absolute=1e-12)
INSIDE = Tolerance("an inner loop leaves no trace, up to rounding", absolute=1e-12)
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


def branch(start, to, p):
    """S_w where a branch ends that begins at (x, S_w) and goes to x, kept between the main curves at every step."""
    (first, s), drying = start, to > start[0]
    h = math.log(to / first) / RK_STEPS

    def per_step(share, s):
        x = first * math.exp(h * share)
        return h * x * rate(x, s, drying, p)

    for i in range(RK_STEPS if h else 0):
        k1 = per_step(i, s)
        k2 = per_step(i + 0.5, s + k1 / 2)
        k3 = per_step(i + 0.5, s + k2 / 2)
        k4 = per_step(i + 1, s + k3)
        s += (k1 + 2 * k2 + 2 * k3 + k4) / 6
        x = first * math.exp(h * (i + 1))
        lower = main_curve(x, p["P_aw"], p["n_w"], p["m_w"], p)
        s = min(max(s, lower), main_curve(x, p["P_a"], p["n_x"], p["m_x"], p))
    return s


def in_loop(turns, x, p):
    """S_w at x on the branch of the last turning point: it ends at the one before, inside the branch that it left."""
    s = branch(turns[-1], x, p)
    if len(turns) == 1:
        return s
    (_, begin), (close, end) = turns[-1], turns[-2]
    way = branch(turns[-1], close, p) - begin
    s = begin + (s - begin) * (end - begin) / way
    left = in_loop(turns[:-1], x, p)
    return max(s, left) if x > turns[-1][0] else min(s, left)


def follow(xs, s, p):
    """Saturations along suctions x, all above zero, from one that lies on the main drying curve."""
    path, turns, drying, joined = [s], [], True, (xs[0], s)   # joined: where the branch without a turning point goes on
    for a, b in zip(xs, xs[1:]):
        if b == a:
            path.append(s)
            continue
        if (b > a) != drying:
            turns.append((a, s))
            drying = b > a
        while len(turns) > 1 and (b >= turns[-2][0] if drying else b <= turns[-2][0]):
            joined = turns[-2]
            turns = turns[:-2]
        s = in_loop(turns, b, p) if turns else branch(joined, b, p)
        if not turns:
            joined = b, s
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
    second, tenth = loops[60:2 * 60 + 1], loops[9 * 60:10 * 60 + 1]
    bench.near("ten cycles: they close", tenth, second, CLOSES)
    inner = bench.driver_text(case([1.0, 2.5, 1.2, 2.0, 1.5, 1.8, 1.6, 2.2, 1.2, 2.5, 3.0]), "inner")["s_w"]
    plain = bench.driver_text(case([1.0, 2.5, 1.2, 2.5, 3.0]), "plain")["s_w"]
    bench.near("loops inside a loop: S_w where they are closed", inner[-3:], plain[-3:], INSIDE)
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
    axes[1].set(xlabel="suction [kPa]", ylabel="S$_w$ [-]", title="ten cycles are one loop, which dissipates")
    axes[2].semilogx(rows["soil.p_c"], rows["soil.S_w"], color=COLOURS[0])
    axes[2].set(xlabel="suction [kPa], logarithmic", ylabel="S$_w$ [-]", title="suction cycles in the host")
    bench.save(figure, "hysteresis.png")
