# SPDX-License-Identifier: MIT
"""Air that cannot escape: Skempton's B, finite compression, driver against host, cycles of a nearly saturated sand."""
import math

import numpy as np

import recorded
from tools import tables
from tools.bench import MATERIAL
from tools.page import Page, Script, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="a sample that keeps its water and its air: Skempton's B against saturation and back pressure, compression by 200 kPa, the "
          "same in driver and host; cycles to liquefaction of a nearly saturated sand",
    kind="exact",
    input="`water = 'constant'`, `air = 'constant'`: elastic soil under all-round pressure, S_w 0.5 to 0.999, back pressure 0 to 400 kPa; "
          "`host.nml`, an undrained element; Toyoura sand in stress cycles of 25 kPa at 100 kPa",
    reference="Boyle's and Henry's laws, solved by bisection apart from the programs; the slope of that in closed form",
    seconds=40, quick=3, pictures=("air.png",))

MAKES = (Script("make_results.py", ("results.csv",), 20),)

TOP, HENRY, WATER = 101.325, 0.02, 2.2e6   # kPa, -, kPa
YOUNG, POISSON, RATIO = 3e4, 0.2, 0.8
BULK = YOUNG / 3 / (1 - 2 * POISSON)
POROSITY = RATIO / (1 + RATIO)
SATURATIONS, BACK = (0.5, 0.8, 0.9, 0.95, 0.99, 0.999), (0.0, 100.0, 400.0)
SAND = (1.0, 0.999, 0.99, 0.97, 0.95, 0.9, 0.8)

SECANT = Tolerance("the square of 0.05 kPa over that of the pressures; stresses are met to 1e-10 of 50 kPa, over 0.1 kPa",
                   absolute=1e-6)
FINITE = Tolerance("the driver meets stresses to 1e-10", relative=1e-6)
HOST = Tolerance("the host integrates rates in 100 steps by the trapezoidal rule; of the change", relative=1e-6)
ONE = Tolerance("the ratio is met within a cycle; rounding may shift it by one", absolute=1.0)
TREND = Tolerance("stiffer or less air leaves the soil less room to contract", absolute=0)


def suction_stays(s):
    """A table whose suction is nothing beside all pressures: S_w from 1 to 0.4 within 1e-6 kPa."""
    return f"&retention law='table' suction=0,{1e-6} saturation=1,0.4 /\n", 1e-6 * (1 - s) / 0.6


def pressed(bench, s, back, end, henry=HENRY):
    retention, suction = suction_stays(s)
    return bench.driver_text(
        f"&case name='press' /\n&material law='elastic' young={YOUNG} poisson={POISSON} /\n{retention}"
        f"&initial p_eff=50 void_ratio={RATIO} suction={suction!r} air_pressure={back} henry={henry} k_w={WATER} /\n"
        f"&stage control='isotropic' water='constant' air='constant' p_end={50 + back + end!r} increment={abs(end) / 4!r} /\n")


def skempton(s, back):
    """Slope of the pore pressure against the total stress."""
    fluid = (1 - s + HENRY * s) / (TOP + back) + (1 - HENRY) * s / WATER
    return 1 / (1 + POROSITY * BULK * fluid)


def closed(s, back, change):
    """Pore pressure after a change of the total mean stress: the strain is found by bisection."""
    content = (TOP + back) * RATIO * (1 - s + HENRY * s)

    def pressure(e):
        low, high = -TOP, 1e6
        for _ in range(200):
            p = (low + high) / 2
            room = e - (1 - HENRY) * s * RATIO * math.exp(-(p - back) / WATER)
            low, high = (p, high) if (TOP + p) * room < content else (low, p)
        return p

    low, high = -0.1, 0.1
    for _ in range(200):
        strain = (low + high) / 2
        p = pressure((1 + RATIO) * math.exp(-strain) - 1)
        low, high = (strain, high) if BULK * strain + p - back < change else (low, strain)
    return p


def check_skempton(bench):
    found = {}
    for s in SATURATIONS[3:5] if bench.quick else SATURATIONS:
        for back in BACK[1:2] if bench.quick else BACK:
            up, down = (pressed(bench, s, back, d)["u"][-1] for d in (0.05, -0.05))
            found[s, back] = (up - down) / 0.1
    keys = list(found)
    bench.near("Skempton's B: S_w 0.5 to 0.999, back pressure 0 to 400 kPa", [found[k] for k in keys], [skempton(*k) for k in keys], SECANT)
    least = pressed(bench, 1 - 1e-9, 0.0, 0.05, henry=0)["u"][-1] / 0.05
    bench.near("Skempton's B without air: 1/(1 + n K/K_w)", least, 1 / (1 + POROSITY * BULK / WATER),
               Tolerance("1e-9 of the pores is air, of 101 kPa: n K 1e-9/101", absolute=1e-6))
    for s, back in ((0.9, 100.0), (0.95, 0.0)):
        bench.near(f"S_w {s}, back pressure {back:g} kPa: pore pressure after 200 kPa", pressed(bench, s, back, 200.0)["p_a"][-1] - back,
                   closed(s, back, 200.0) - back, FINITE, "kPa")
    return found


def check_host(bench):
    for said, henry in (("", 0.0), (", with Henry", HENRY)):
        run = tables.columns(bench.host("host.nml", [("k_w = 2.2e6", f"k_w = 2.2e6  henry = {henry}")]) / "histories.csv")
        test = bench.driver_text(
            "&case name='host' /\n&material law='elastic' young=3e4 poisson=0.2 /\n&retention law='van_genuchten' alpha=0.5 n=3 /\n"
            f"&initial p_net=50 void_ratio=0.8 suction=1 air_pressure=200 k_w=2.2e6 henry={henry} /\n"
            "&stage control='isotropic' water='constant' air='constant' p_end=300 increment=0.5 /\n")
        for name, host, driver in (("water pressure", run["top.p_w"], test["p_a"] - test["suction"]),
                                   ("suction", run["top.p_c"], test["suction"]), ("mean effective stress", -run["top.s_rr"], test["p_eff"])):
            bench.near(f"host against driver, 50 kPa{said}: {name}", host[-1] - host[0], driver[-1] - driver[0], HOST, "kPa")


def cycles(bench, s, back):
    """Cycles to a pore pressure of 0.8 of the confining stress, NaN: not in 60."""
    stage = "cycle_by='q' amplitude=25 cycles=60 stop_r_u=0.8 increment=2e-5 output_interval=1e-4 /\n"
    start, closing = "p_eff=100", "control='undrained'"
    if s < 1:
        suction = 0.02 * math.sqrt(math.exp(1 / s) - math.e) / 0.833**2
        start, closing = f"p_net=100 suction={suction!r} air_pressure={back} k_w={WATER}", "control='drained' water='constant' air='constant'"
    run = bench.driver_text(f"&case name='sand' /\n&material file='{MATERIAL}' P_a=0.02 b_1=0 b_2=0 /\n&initial void_ratio=0.833 {start} /\n&stage {closing} {stage}")
    return run["cycle"][-1] if run["r_u"].max() >= 0.8 else math.nan


def measure(bench, saturations=SAND, pressures=BACK[1:]):
    return {(f"S_w {s:g}", f"back pressure {back:g} kPa"): cycles(bench, s, back) for s in saturations for back in pressures}


def check_sand(bench):
    found = measure(bench, (1.0, 0.95), BACK[1:2]) if bench.quick else measure(bench)
    recorded.compare(bench, found, ONE, "sand, cycles to r_u 0.8")
    if bench.quick:
        return found
    columns = [[found[f"S_w {s:g}", f"back pressure {back:g} kPa"] for s in SAND] for back in BACK[1:]]
    counted = [[1e9 if math.isnan(n) else n for n in column] for column in columns]
    bench.near("sand: steps towards less water in which the cycles fall", sum(a > b for c in counted for a, b in zip(c, c[1:])), 0, TREND)
    bench.near("sand: saturations at which the higher back pressure takes more cycles", sum(b > a for a, b in zip(*counted)), 0, TREND)
    return found


def check(bench):
    """What the picture shows."""
    found = check_skempton(bench)
    check_host(bench)
    return found, check_sand(bench)


def texts(bench):
    return {"README.md": {"cycles": recorded.table(bench, tuple(f"back pressure {back:g} kPa" for back in BACK[1:]), "saturation")}}


def draw(bench, found, plt):
    skemptons, sand = found
    figure, axes = plt.subplots(1, 2, figsize=(9.5, 3.6), layout="constrained")
    s = np.linspace(0.5, 1, 400)
    for back, colour in zip(BACK, COLOURS):
        axes[0].plot(s, [skempton(x, back) for x in s], color=colour, lw=1, label=f"back pressure {back:g} kPa")
        axes[0].plot(*zip(*[(k[0], b) for k, b in skemptons.items() if k[1] == back]), "o", color=colour, ms=4)
    axes[0].set(xlabel="degree of saturation", ylabel="Skempton's B", title="Closed form (lines), driver (points)")
    axes[0].legend(fontsize=8)
    for back, colour in zip(BACK[1:], COLOURS):
        points = [(s, sand[f"S_w {s:g}", f"back pressure {back:g} kPa"]) for s in SAND]
        axes[1].plot(*zip(*points), "o-", color=colour, ms=4, lw=1, label=f"back pressure {back:g} kPa")
    axes[1].set(xlabel="degree of saturation", ylabel="cycles to $r_u$ = 0.8", title="Toyoura sand, 100 kPa, q = 25 kPa")
    axes[1].legend(fontsize=8)
    bench.save(figure, "air.png")
