# SPDX-License-Identifier: MIT
"""Cycles to liquefaction in undrained simple shear against the cyclic stress ratio."""
import math

import numpy as np

import recorded
from tools.bench import MATERIAL
from tools.page import Page, Script, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="what the published set gives for the cycles to liquefaction in undrained simple shear",
    kind="regression",
    input="simple shear at constant volume, cycles of the shear stress of CSR times the vertical effective stress; sigma_v 100 kPa, K0 0.5, e 0.8",
    reference="none: no laboratory test is available for this state of Toyoura sand; the numbers are stated, and compared with those that were recorded",
    seconds=20, quick=2, pictures=("cyclic_resistance.png",))
MAKES = (Script("make_results.py", ("results.csv",), 20),)

RATIOS = (0.04, 0.08, 0.12, 0.16, 0.20, 0.30)
CYCLES = {0.04: 100, 0.08: 40}   # else 20: the stress path then repeats itself
VERTICAL = 100.0
MARKS = {"r_u of the mean stress 0.8": ("p", 0.8), "r_u of the vertical stress 0.8": ("v", 0.8), "r_u of the vertical stress 0.95": ("v", 0.95),
         "double amplitude 7.5 %": ("d", 0.075)}
HALF = Tolerance("a mark is met within a half cycle; where r_u barely reaches it, rounding may shift it by one", absolute=1.0)


def case(name, ratio, cycles):
    return (f"&case\n   name = 'resistance'\n/\n&material\n   file = '{MATERIAL}'\n{recorded.DRIVER[name]}/\n"
            f"&initial\n   sigma_a = {VERTICAL}\n   sigma_r = {0.5 * VERTICAL}\n   void_ratio = 0.8\n/\n"
            f"&stage\n   control = 'simple_shear_constant_volume'\n   cycle_by = 'tau'\n   amplitude = {ratio * VERTICAL}\n   cycles = {cycles}\n"
            "   increment = 2e-5\n   output_interval = 5e-5\n/\n")


def half_cycles(run):
    """Number of half cycles before every row, 0.5 for each turn passed."""
    tau = run["sig_13"]
    turn = np.sign(np.diff(tau, prepend=tau[0]))
    moving = turn[turn != 0]
    changes = np.concatenate([[False], moving[1:] != moving[:-1]])
    count = np.zeros(len(tau))
    count[turn != 0] = 0.5 * np.cumsum(changes)
    return np.maximum.accumulate(count)


def reached(run):
    """mark -> cycles until it is met, NaN: never."""
    n, gamma = half_cycles(run), run["gamma_13"]
    double = np.zeros(len(n))
    for i, half in enumerate(np.unique(n)):   # largest minus smallest strain of the last two half cycles
        part = (n >= half - 0.5) & (n <= half)
        double[n == half] = gamma[part].max() - gamma[part].min()
    series = {"p": 1 - run["p_eff"] / run["p_eff"][0], "v": 1 - run["sigma_a"] / run["sigma_a"][0], "d": double}
    found = {}
    for mark, (which, level) in MARKS.items():
        there = np.flatnonzero(series[which] >= level)
        found[mark] = n[there[0]] + 0.25 if len(there) else math.nan
    found["largest r_u of the mean stress"] = series["p"].max()
    found["largest double amplitude [%]"] = 100 * double.max()
    return found


def measure(bench, ratios=RATIOS):
    found = {}
    for ratio in ratios:
        for name in recorded.PARAMETERS:
            for mark, value in reached(bench.driver_text(case(name, ratio, CYCLES.get(ratio, 20)))).items():
                found[f"CSR {ratio:.2f}, {mark}", name] = value
    return found


def check(bench):
    measured = measure(bench, (0.16,) if bench.quick else RATIOS)
    cycles = {key: value for key, value in measured.items() if "largest" not in key[0]}
    recorded.compare(bench, cycles, HALF, "cycles")
    recorded.compare(bench, {key: value for key, value in measured.items() if key not in cycles},
                     Tolerance("read at rows 5e-5 of strain apart, where r_u moves by 1 %", relative=0.02), "largest values")
    return measured


def texts(bench):
    return {"README.md": {"values": recorded.table(bench, tuple(recorded.PARAMETERS), "cycles until a mark, and largest values")}}


def draw(bench, measured, plt):
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2))
    for name, colour in zip(recorded.PARAMETERS, COLOURS):
        for mark, style in zip(list(MARKS)[:2], ("o-", "s--")):
            points = [(measured[f"CSR {r:.2f}, {mark}", name], r) for r in RATIOS]
            points = [p for p in points if not math.isnan(p[0])]
            axes[0].semilogx([p[0] for p in points], [p[1] for p in points], style, color=colour, ms=4, label=f"{name.split(' (')[0]}: {mark}")
    axes[0].set(xlabel="cycles", ylabel="cyclic stress ratio [-]", title="cycles until r_u is 0.8")
    axes[0].legend(fontsize=7)
    for axis, ratio in zip(axes[1:], (0.08, 0.20)):
        run = bench.driver_text(case(recorded.DEFAULT, ratio, 20))
        axis.plot(run["sigma_a"], run["sig_13"], color=COLOURS[1], lw=0.7)
        axis.set(xlabel="vertical effective stress [kPa]", ylabel="shear stress [kPa]", title=f"CSR {ratio:.2f}, default, 20 cycles")
    bench.save(figure, "cyclic_resistance.png")
