# SPDX-License-Identifier: MIT
"""Cyclic preloading: cycles of Karlsruhe fine sand with and without it, beside the laboratory's, and what they depend on."""
import math

import numpy as np

import recorded
from point_walk import Path, Soil, Walker
from tools import tables
from tools.bench import ROOT, parameters
from tools.page import Page, Script, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="what cyclic preloading changes in undrained and drained cycles of Karlsruhe fine sand, beside six cyclic tests; neither tolerance "
          "nor increment nor scheme decides the number of cycles",
    kind=("fitted", "experiment", "regression"),
    input="undrained triaxial stress cycles about an isotropic stress, drained cycles, drained simple shear; `karlsruhe` without the option, "
          "`karlsruhe_cyclic` with it",
    reference="Wichtmann & Triantafyllidis (2016), cycles to r_u 0.95 (`calibration/data/karlsruhe_fine_sand_cyclic_TC.csv`); "
              "states at reversals of TCUI1 (`tcui1_reversals.csv`); Darendeli (2001) for sand",
    seconds=8, quick=3, pictures=("preloading.png",))
MAKES = (Script("make_results.py", ("results.csv",), 15),)

MATERIALS = ROOT / "drivers/materials"
WITHOUT, WITH = "karlsruhe", "karlsruhe_cyclic"
TESTS = {row["test"]: row for row in tables.rows(ROOT / "calibration/data/karlsruhe_fine_sand_cyclic_TC.csv")}
HELD_OUT = ("TCUI4", "TCUI20")
MOST = 1000   # cycles; a sample that stands longer counts as standing
COUNT = Tolerance("rounding of another machine may move the half cycle in which the mark is met; the counts are up to a hundred times larger",
                  absolute=1.0, relative=0.01)
ONE = Tolerance("a mark is met in one cycle or the next", absolute=1.0)
AGAIN = Tolerance("the recorded value has 5 digits; other compilers round otherwise", relative=5e-3, absolute=1e-5)
# Other numerics, same test: lines of &material, increment.
NUMERICS = {"increment 2e-5": ("", 2e-5), "tolerance 1e-4": ("   tolerance = 1e-4\n", 1e-4), "tolerance 1e-7": ("   tolerance = 1e-7\n", 1e-4),
            "modified Euler": ("   scheme = 1\n", 1e-4), "Dormand-Prince": ("   scheme = 3\n", 1e-4)}


def case(name, test, more="", increment=1e-4, cycles=MOST, every=0.1):
    p = float(test["p_0_kPa"])
    return (f"&case\n   name = 'cycles'\n/\n&material\n   file = '{MATERIALS / name}.nml'\n{more}/\n"
            f"&initial\n   p_eff = {p}\n   void_ratio = {test['e_0']}\n/\n"
            f"&stage\n   control = 'undrained'\n   cycle_by = 'q'\n   amplitude = {2 * float(test['csr']) * p}\n   cycles = {cycles}\n"
            f"   stop_r_u = 0.95\n   increment = {increment}\n   output_interval = {every}\n/\n")


def times(factor, strain):
    return tuple(factor * x for x in strain)


def cycles_to(run):
    return float(run["cycle"][-1]) if run["r_u"][-1] >= 0.95 else math.nan


def soil(name):
    return Soil(properties=tuple(parameters(MATERIALS / f"{name}.nml").items()))


def shear_loop(size, name, e=0.85, parts=50):
    """Second cycle of drained simple shear."""
    path = Path(soil(name), e).lead("ssseee")
    across = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0)
    steps = max(1, math.ceil(size / parts / 2e-5))
    for i, part in enumerate((1, -2, 2, -2)):
        for _ in range(abs(part) * parts):
            path.go(steps, times(math.copysign(size, part) / parts, across))
            if i >= 2:
                path.row()
        if i == 1:
            path.row()
    return path


def modulus_damping(rows, size, name, e=0.85):
    values = parameters(MATERIALS / f"{name}.nml")
    largest = values["G_0"] * values["p_atm"] * (2.97 - e) ** 2 / (1 + e) * math.sqrt(100 / values["p_atm"])   # eq. (3)
    tau, gamma = [row["stress"][3] for row in rows], [row["strain"][3] for row in rows]
    modulus = (max(tau) - min(tau)) / (2 * size)
    work = sum(0.5 * (a + b) * (d - c) for a, b, c, d in zip(tau, tau[1:], gamma, gamma[1:]))
    return modulus / largest, 100 * work / (2 * math.pi * modulus * size ** 2)


def biased(name, marks, e=0.8):
    """Drained triaxial cycles q = -30 +- 10 kPa: axial strain at the ends of cycles."""
    path = Path(soil(name), e).lead("ssseee").go(30, (-30.0, 0, 0, 0, 0, 0)).row("0")
    for i in range(1, max(marks) + 1):
        path.go(10, (10.0, 0, 0, 0, 0, 0)).go(20, (-20.0, 0, 0, 0, 0, 0)).go(10, (10.0, 0, 0, 0, 0, 0))
        if i in marks:
            path.row(str(i))
    return path


def measure(bench, marks=(10, 100, 1000)):
    found, walker = {}, Walker(bench.build)
    for name in (WITHOUT, WITH):
        for test, row in TESTS.items():
            found[f"{test}: cycles to r_u 0.95", name] = cycles_to(bench.driver_text(case(name, row)))
        for size in (1e-4, 1e-3):
            rows = walker.start(shear_loop(size, name)).result()
            found[f"G/G_max at {size:.0e}", name], found[f"damping at {size:.0e} [%]", name] = modulus_damping(rows, size, name)
        rows = walker.start(biased(name, marks)).result()
        for row in rows[1:]:
            found[f"q = -30 +- 10: axial strain after {row['label']} [%]", name] = 100 * (row["strain"][0] - rows[0]["strain"][0])
    return found


def check(bench):
    marks = (10,) if bench.quick else (10, 100, 1000)
    found = measure(bench, marks)
    cycles = {key: value for key, value in found.items() if key[0].endswith("r_u 0.95")}
    recorded.compare(bench, cycles, COUNT, "cycles")
    recorded.compare(bench, {key: value for key, value in found.items() if key not in cycles}, AGAIN, "moduli and strains")
    for text, (more, increment) in NUMERICS.items():
        for test in ("TCUI10", "TCUI19"):
            value = cycles_to(bench.driver_text(case(WITH, TESTS[test], more, increment)))
            bench.near(f"{test}, {text}: cycles", value, found[f"{test}: cycles to r_u 0.95", WITH], ONE)
    return found


def texts(bench):
    values = recorded.read(bench)
    lines = []
    for test, row in TESTS.items():
        key = f"{test}: cycles to r_u 0.95"
        lines.append((test + (" (held out)" if test in HELD_OUT else ""), row["p_0_kPa"], row["e_0"], row["csr"], row["N"],
                      *(recorded.shown(values[key, name]) for name in (WITHOUT, WITH))))
    rest = {key: values[key] for key in values if "r_u 0.95" not in key[0]}
    return {"README.md": {
        "cycles": tables.markdown(("test", "p' [kPa]", "e", "q/2p'", "laboratory", WITHOUT, WITH), lines),
        "values": tables.markdown(("", WITHOUT, WITH), [
            (quantity, *(recorded.shown(values[quantity, name]) for name in (WITHOUT, WITH)))
            for quantity in dict.fromkeys(key[0] for key in rest)])}}


def draw(bench, found, plt):
    figure, axes = plt.subplots(2, 2, figsize=(11, 8.2))
    reversals = tables.columns(bench.here / "tcui1_reversals.csv")
    for axis, name, title in zip(axes[0], (WITH, WITHOUT), ("with cyclic preloading", "without")):
        run = bench.driver_text(case(name, TESTS["TCUI1"], increment=2e-5, every=2e-5))
        axis.plot(run["p_eff"], run["q"], color=COLOURS[0], lw=0.5, label=name)
        axis.plot(reversals["p_kPa"], reversals["q_kPa"], "o", ms=2.5, color=COLOURS[1], label="laboratory, at reversals")
        axis.set(xlabel="p' [kPa]", ylabel="q [kPa]", title=f"TCUI1, {title}", xlim=(0, 210), ylim=(-35, 50))
        axis.legend(loc="upper center", ncols=2)
    for name, mark in ((WITHOUT, "s"), (WITH, "^")):
        points = [(found[f"{t}: cycles to r_u 0.95", name], float(r["csr"])) for t, r in TESTS.items()]
        axes[1, 0].semilogx(*zip(*points), mark, label=name)
    axes[1, 0].semilogx([float(r["N"]) for r in TESTS.values()], [float(r["csr"]) for r in TESTS.values()], "o", mfc="none", color="k",
                        label="laboratory")
    for test, row in TESTS.items():
        axes[1, 0].annotate(f"{test}, e {row['e_0']}", (float(row["N"]), float(row["csr"])), fontsize=7, xytext=(4, 4),
                            textcoords="offset points")
    axes[1, 0].set(xlabel="cycles to r_u 0.95, logarithmic", ylabel="q/(2 p')", title="cyclic resistance", xlim=(0.8, 1500))
    axes[1, 0].legend()
    run = bench.driver_text(case(WITH, TESTS["TCUI1"], increment=2e-5, every=2e-5))
    ends = [np.flatnonzero(run["cycle"] == i)[-1] for i in range(1, int(run["cycle"].max()) + 1)]
    axes[1, 1].plot(np.arange(1, len(ends) + 1), run["p_eff"][ends], color=COLOURS[0], label=WITH)
    axes[1, 1].plot(0.5 * reversals["half_cycle"], reversals["p_kPa"], "o", ms=2.5, color=COLOURS[1], label="laboratory")
    axes[1, 1].set(xlabel="cycle", ylabel="p' [kPa]", title="TCUI1: decay of p'")
    axes[1, 1].legend()
    bench.save(figure, "preloading.png")
