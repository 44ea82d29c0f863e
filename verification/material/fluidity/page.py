# SPDX-License-Identifier: MIT
"""Fluidity: cycles after liquefaction with and without it, beside strain cycles of the laboratory, and what they depend on."""
import math

import numpy as np

import recorded
from tools import tables
from tools.bench import ROOT
from tools.page import Page, Script, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="with fluidity stress cycles strain liquefied sand ten times as far on the same stress path, and neither tolerance nor increment nor scheme "
          "decides how far; strain cycles of 1 % leave p' below 0.15 of its start from the second on, for which `c_ell` was chosen",
    kind=("fitted", "regression", "study"),
    input="undrained triaxial stress and strain cycles of `karlsruhe_cyclic`, simple shear at constant volume of the default set; `c_ell` 0 and 600, "
          "`ell_max`, `p_ell`, `r_ell` at their defaults",
    reference="Wichtmann & Triantafyllidis (2016), p' at the reversals of TCUE1, TCUE2 and TCUE4 (`tcue_reversals.csv`), by which `c_ell` was chosen",
    seconds=24, quick=7, pictures=("fluidity.png",))
MAKES = (Script("make_results.py", ("results.csv",), 22),)

KARLSRUHE = ROOT / "drivers/materials/karlsruhe_cyclic.nml"
WITHOUT, WITH = "without", "with fluidity"
ELL = {WITHOUT: "   c_ell = 0.0\n", WITH: "   c_ell = 600.0\n"}
STRAINED = {"TCUE1": (200.0, 0.944), "TCUE2": (200.0, 0.804), "TCUE4": (100.0, 0.812)}   # p' [kPa], e
CYCLES = (1, 2, 3, 4, 6, 10)   # whose largest p' at a reversal is told
STRESSED = (100.0, 0.761, 40.0)   # TCUI19: p', e, q
AFTER = (1, 2, 4, 6, 8)           # cycles after liquefaction
SHEARED = (3, 10, 20, 100)        # cycles of simple shear
AGAIN = Tolerance("the recorded value has 5 digits; other compilers round otherwise, and a turn is met to 1 % of the amplitude", relative=0.03,
                  absolute=1e-3)
LITTLE = Tolerance("a hundred times what the tolerance of 1e-4 leaves of a substep", relative=0.01)
SAME_PATH = Tolerance("p' at the turns: elastic strains are small beside plastic ones, not nothing", relative=0.05)
TARGET = Tolerance("0.15 of the start is the least that is asked, and `c_ell` was chosen to keep it: with 300 the second cycle of TCUE2 has 0.187",
                   absolute=0.0)
# Other numerics: lines of &material, increment.
NUMERICS = {"increment 5e-5": ("", 5e-5), "tolerance 1e-4": ("   tolerance = 1e-4\n", 1e-4), "tolerance 1e-7": ("   tolerance = 1e-7\n", 1e-4),
            "modified Euler": ("   scheme = 1\n", 1e-4), "Bogacki-Shampine": ("   scheme = 2\n", 1e-4),
            "Dormand-Prince": ("   scheme = 3\n", 1e-4), "rule classic": ("   memory_rule = 'classic'\n", 1e-4)}


# Where strain drifts: with the set, with the strength of compression in extension, without fabric.
DRIFTS = {"": "", ", c 1": "   c = 1.0\n", ", c_z 0": "   c_z = 0.0\n"}
CLOSED = Tolerance("with equal strength on both sides nothing tells compression from extension: a thousandth of the drift with the set", absolute=2e-3)


def stress_cycles(name, more="", increment=1e-4, cycles=28):
    p, e, q = STRESSED
    return (f"&case\n   name = 'cycles'\n/\n&material\n   file = '{KARLSRUHE}'\n{ELL[name]}{more}/\n&initial\n   p_eff = {p}\n   void_ratio = {e}\n/\n"
            f"&stage\n   control = 'undrained'\n   cycle_by = 'q'\n   amplitude = {q}\n   cycles = {cycles}\n"
            f"   increment = {increment}\n   output_interval = {increment}\n/\n")


def strain_cycles(name, p, e, more="", increment=2e-4):
    return (f"&case\n   name = 'cycles'\n/\n&material\n   file = '{KARLSRUHE}'\n{ELL[name]}{more}/\n&initial\n   p_eff = {p}\n   void_ratio = {e}\n/\n"
            f"&stage\n   control = 'undrained'\n   cycle_by = 'eps_a'\n   amplitude = 0.01\n   cycles = {max(CYCLES)}\n"
            f"   increment = {increment}\n   output_interval = {increment}\n/\n")


def shear_cycles(name, cycles):
    return (f"&case\n   name = 'shear'\n/\n&material\n{ELL[name]}/\n&initial\n   sigma_a = 100\n   sigma_r = 50\n   void_ratio = 0.8\n/\n"
            f"&stage\n   control = 'simple_shear_constant_volume'\n   cycle_by = 'tau'\n   amplitude = 20\n   cycles = {cycles}\n"
            "   increment = 1e-4\n   output_interval = 1e-4\n/\n")


def turns(series):
    """Rows at which a series turns, and its last one."""
    way = np.sign(np.diff(series))
    for i in range(1, len(way)):
        way[i] = way[i] or way[i - 1]
    return np.append(np.flatnonzero(way[1:] * way[:-1] < 0) + 1, len(series) - 1)


def widths(run, strain):
    """Strain between the turns of each cycle, and p' at its second turn."""
    at = turns(run[strain])   # the stress may turn on the way, where p' nearly vanishes
    pairs = list(zip(at[:-1:2], at[1::2]))
    return [100 * abs(run[strain][b] - run[strain][a]) for a, b in pairs], [float(run["p_eff"][b]) for _, b in pairs]


def drift(run):
    """Change of the axial strain from one crest to the next, at the end [%]; the last row is no turn."""
    at = turns(run["eps_a"])
    return 100 * (run["eps_a"][at[-2]] - run["eps_a"][at[-4]])


def liquefied(run):
    """Number of cycles to r_u 0.95."""
    there = np.flatnonzero(run["p_eff"] <= 0.05 * run["p_eff"][0])
    return int(run["cycle"][there[0]]) if len(there) else 0


def at_reversals(p, half):
    """The larger p' of both reversals of a cycle over the one at the start, by cycle."""
    return {n: max(p[half == 2 * n - 1].max(), p[half == 2 * n].max()) / p[0] for n in range(1, int(half.max()) // 2 + 1)}


def of_laboratory(bench, test):
    rows = [row for row in tables.rows(bench.here / "tcue_reversals.csv") if row["test"] == test]
    rows = [row for row in rows if int(row["half_cycle"]) != 1]   # the start stands twice
    half = np.array([max(int(row["half_cycle"]) - 1, 0) for row in rows])
    return at_reversals(np.array([float(row["p_kPa"]) for row in rows]), half)


def of_model(run):
    at = np.append(0, turns(run["eps_a"]))
    return at_reversals(run["p_eff"][at], np.arange(len(at)))


def measure(bench, quick=False):
    found = {}
    for name in ELL:
        run = bench.driver_text(stress_cycles(name))
        turned = run
        wide, p = widths(run, "eps_a")
        begin = liquefied(run)
        found["TCUI19: cycles to r_u 0.95", name] = begin
        for n in AFTER:
            found[f"TCUI19: double amplitude, cycle {n} after it [%]", name] = wide[begin + n - 1]
        found["TCUI19: p' at the last turn [kPa]", name] = p[begin + max(AFTER) - 1]
        for text, more in DRIFTS.items():
            if name == WITH or not more:
                found[f"TCUI19{text}: drift to compression, a cycle [%]", name] = drift(bench.driver_text(stress_cycles(name, more)) if more else turned)
        for test, (p, e) in list(STRAINED.items())[:1 if quick else None]:
            largest = of_model(bench.driver_text(strain_cycles(name, p, e)))
            for n in CYCLES:
                found[f"{test}: largest p'/p'_0 at a reversal, cycle {n}", name] = largest[n]
        marks = SHEARED[:2] if quick else SHEARED
        wide, _ = widths(bench.driver_text(shear_cycles(name, max(marks) + 1)), "gamma_13")
        for n in marks:
            found[f"simple shear, CSR 0.20: double amplitude, cycle {n} [%]", name] = wide[n - 1]
    return found


def check(bench):
    found = measure(bench, bench.quick)
    recorded.compare(bench, found, AGAIN)
    last = f"TCUI19: double amplitude, cycle {AFTER[-1]} after it [%]"
    bench.near("TCUI19: p' at the last turn, with against without", found["TCUI19: p' at the last turn [kPa]", WITH],
               found["TCUI19: p' at the last turn [kPa]", WITHOUT], SAME_PATH)
    for text in (", c 1",):
        bench.near(f"TCUI19{text}: drift a cycle with fluidity [%]", found[f"TCUI19{text}: drift to compression, a cycle [%]", WITH], 0.0, CLOSED)
    for text, (more, increment) in list(NUMERICS.items())[:2 if bench.quick else None]:
        run = bench.driver_text(stress_cycles(WITH, more, increment))
        wide, _ = widths(run, "eps_a")
        if text != "rule classic":   # another rule liquefies in another cycle
            bench.near(f"TCUI19, {text}: double amplitude, cycle {AFTER[-1]} after liquefaction [%]", wide[liquefied(run) + AFTER[-1] - 1],
                       found[last, WITH], LITTLE)
        else:
            bench.near(f"TCUI19, {text}: double amplitude, cycle {AFTER[-1]} after liquefaction [%]", wide[liquefied(run) + AFTER[-1] - 1],
                       found[last, WITH], Tolerance("it liquefies from another stress", relative=0.2))
    for test, (p, e) in list(STRAINED.items())[:1 if bench.quick else None]:
        held = max(value for n, value in of_model(bench.driver_text(strain_cycles(WITH, p, e))).items() if n >= 2)
        bench.near(f"{test}: largest p'/p'_0 at a reversal from the second cycle on, above 0.15", max(held - 0.15, 0.0), 0.0, TARGET)
    return found


def texts(bench):
    values = recorded.read(bench)
    lines, told = [], {test: of_laboratory(bench, test) for test in STRAINED}
    for quantity in dict.fromkeys(q for q, _ in values):
        test, _, cycle = quantity.partition(": largest p'/p'_0 at a reversal, cycle ")
        measured = recorded.shown(told[test][int(cycle)]) if cycle else ""
        lines.append((quantity, measured, *(recorded.shown(values.get((quantity, name))) for name in ELL)))
    return {"README.md": {"values": tables.markdown(("", "laboratory", *ELL), lines)}}


def draw(bench, found, plt):
    figure, axes = plt.subplots(2, 2, figsize=(11, 8.2))
    for axis, name, colour in zip(axes[0], (WITHOUT, WITH), COLOURS):
        run = bench.driver_text(stress_cycles(name))
        axis.plot(100 * run["eps_a"], run["q"], color=colour, lw=0.6)
        axis.set(xlabel="axial strain [%]", ylabel="q [kPa]", title=f"TCUI19: {name}")
        axes[1, 0].plot(run["p_eff"], run["q"], color=colour, lw=0.6, label=name)
    axes[1, 0].set(xlabel="p' [kPa]", ylabel="q [kPa]", title="TCUI19: both stress paths")
    axes[1, 0].legend()
    for test, colour in zip(STRAINED, COLOURS):
        lab = of_laboratory(bench, test)
        axes[1, 1].semilogy(list(lab), list(lab.values()), "o", ms=4, color=colour, label=f"{test}, laboratory")
        for name, style in ((WITHOUT, ":"), (WITH, "-")):
            model = of_model(bench.driver_text(strain_cycles(name, *STRAINED[test])))
            axes[1, 1].semilogy(list(model), list(model.values()), style, color=colour, label=f"{test}, {name}")
    axes[1, 1].axhline(0.15, color="k", lw=0.5)
    axes[1, 1].set(xlabel="cycle", ylabel="larger p' of its reversals over the first, logarithmic", title="strain cycles of 1 %", ylim=(1e-3, 10))
    axes[1, 1].legend(fontsize=7, ncols=3)
    bench.save(figure, "fluidity.png")
