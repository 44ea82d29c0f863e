# SPDX-License-Identifier: MIT
"""Undrained triaxial stress cycles beside a test on Ottawa F65 sand."""
import math

import numpy as np

import recorded
from tools.bench import MATERIAL
from tools.page import Page, Script, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="what the published set of Toyoura sand gives in undrained triaxial stress cycles, beside a test on Ottawa F65 sand",
    kind=("experiment", "regression"),
    input="undrained triaxial compression and extension, q = +-65 kPa (CSR 0.325) about an isotropic 100 kPa; e 0.507 as in the test, and 0.65, 0.735, 0.8",
    reference="Ottawa F65 sand, e 0.507, p' 100 kPa, CSR 0.325: r_u = 1 at 18 cycles, 2.5 % double amplitude at 41 (El Ghoraiby, Park & Manzari 2020, "
              "ODC-BY); another sand: no agreement is expected, and nothing was tuned",
    seconds=20, quick=2, pictures=("cyclic_mobility.png",))
MAKES = (Script("make_results.py", ("results.csv",), 15),)

AMPLITUDE, CYCLES, VOID_RATIOS = 65.0, 60, (0.507, 0.65, 0.735, 0.8)
MARKS = {"r_u 0.95": 0.95, "2.5 % double amplitude": 0.025, "5 % double amplitude": 0.05}
HALF = Tolerance("a mark is met within a half cycle", absolute=1.0)
PEAK = Tolerance("read at rows 5e-5 of strain apart", relative=0.02)


def case(name, e, cycles=CYCLES):
    return (f"&case\n   name = 'mobility'\n/\n&material\n   file = '{MATERIAL}'\n{recorded.DRIVER[name]}/\n"
            f"&initial\n   p_eff = 100.0\n   void_ratio = {e}\n/\n"
            f"&stage\n   control = 'undrained'\n   cycle_by = 'q'\n   amplitude = {AMPLITUDE}\n   cycles = {cycles}\n"
            "   increment = 2e-5\n   output_interval = 5e-5\n/\n")


def reached(run):
    cycle, strain, found = run["cycle"], run["eps_a"], {}
    double = np.array([np.ptp(strain[cycle == i]) for i in range(1, int(cycle.max()) + 1)])
    there = np.flatnonzero(run["r_u"] >= 0.95)
    found["r_u 0.95"] = cycle[there[0]] if len(there) else math.nan
    for mark in ("2.5 % double amplitude", "5 % double amplitude"):
        there = np.flatnonzero(double >= MARKS[mark])
        found[mark] = there[0] + 1.0 if len(there) else math.nan
    found["largest r_u"] = run["r_u"].max()
    found[f"double amplitude in cycle {CYCLES} [%]"] = 100 * double[-1]
    found[f"mean axial strain in cycle {CYCLES} [%]"] = 100 * strain[cycle == cycle.max()].mean()
    return found


def measure(bench, void_ratios=VOID_RATIOS):
    found = {}
    for e in void_ratios:
        for name in recorded.PARAMETERS:
            for mark, value in reached(bench.driver_text(case(name, e))).items():
                found[f"e {e}: {mark}", name] = value
    return found


def check(bench):
    measured = measure(bench, (0.507,) if bench.quick else VOID_RATIOS)
    cycles = {key: value for key, value in measured.items() if key[0].split(": ")[1] in MARKS}
    recorded.compare(bench, cycles, HALF, "cycles")
    recorded.compare(bench, {key: value for key, value in measured.items() if key not in cycles}, PEAK, "r_u and strains")
    return measured


def texts(bench):
    return {"README.md": {"values": recorded.table(bench, tuple(recorded.PARAMETERS), "cycle of a mark, and values")}}


def draw(bench, _, plt):
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.4))
    for line, e in zip(axes, (0.507, 0.735)):
        for name, colour, width in zip(recorded.PARAMETERS, ("#9db4d0", COLOURS[1]), (2.5, 0.6)):   # the first is seen beneath the second
            run = bench.driver_text(case(name, e))
            line[0].plot(run["p_eff"], run["q"], color=colour, lw=width, label=name.split(" (")[0])
            line[1].plot(100 * run["eps_a"], run["q"], color=colour, lw=width)
        line[0].set(xlabel="p' [kPa]", ylabel="q [kPa]", title=f"e {e}, {CYCLES} cycles of q = +-{AMPLITUDE:g} kPa")
        line[1].set(xlabel="axial strain [%]", ylabel="q [kPa]")
    axes[0, 0].legend()
    bench.save(figure, "cyclic_mobility.png")
