# SPDX-License-Identifier: MIT
"""Triaxial tests on Toyoura sand: the published parameters beside the laboratory and the closed-form steady state."""
import re

import laboratory
import numpy as np
from closed_forms import P, critical_void_ratio, steady_pressure
from tools import tables
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="how far the published parameter set is from six drained tests on Toyoura sand; undrained tests beside the "
          "closed-form steady state",
    kind=("experiment", "code-to-code"),
    input="`drivers/cases/vi_drained_TMD1` ... `TMD6` (isotropic start at 500 kPa, TMD1-3, or 100 kPa, radial stress "
          "held, axial strain to 0.30 in increments of "
          "1e-4) and `undrained_eEEE_pPPPP` (e 0.735, 0.833, 0.907, p' 100 to 3000 kPa, axial strain to 0.25, and "
          "continued to 1); "
          "`drivers/materials/toyoura.nml` (the paper's Tables 2 and 3, theta 0.2), memory rule and guards at their "
          "defaults",
    reference="`verdugo_ishihara_1996_drained_TC.csv`: six digitised tests, origin, DOI and licence (CC-BY-4.0) in its "
              "header; the misfits of an independent "
              "integration of the same equations",
    seconds=10, pictures=("drained.png", "undrained.png", "states.png"))

# Misfits of the independent integration: q [%], eps_v [percentage points].
OTHERS = {"TMD4": (8, 0.46), "TMD5": (15, 0.83), "TMD6": (33, 1.64),
          "TMD1": (7, 0.10), "TMD2": (15, 0.98), "TMD3": (42, 1.90)}
VOID_RATIOS = ("0.735", "0.833", "0.907")
PRESSURES = (100, 1000, 2000, 3000)
FAR = ((re.compile(r"eps_a_end = \S+"), "eps_a_end = 1.0"),)   # natural axial strain
HELD = Tolerance("the driver's promise for a held stress", absolute=1e-10)
WHOLE_PERCENT = Tolerance("the other integration is known in whole per cent, its normalisation of q in part (below)",
                          absolute=1.0)
TWO_DIGITS = Tolerance("the other integration is known to 0.01 points and does not state which rows it used",
                       absolute=0.05)


def check(bench):
    tests = laboratory.read()
    drained = {name: bench.driver(f"vi_drained_{name}") for name in laboratory.TESTS}
    lines = []
    for name, run in drained.items():
        test, error = tests[name], float(run["control_error"].max())
        q, volume = laboratory.misfit(run, test)
        bench.near(f"{name}: radial stress held, of its value", error, 0, HELD)
        bench.near(f"{name}: misfit of q, by another integration", q, OTHERS[name][0], WHOLE_PERCENT, "%")
        bench.near(f"{name}: misfit of eps_v, by another integration", volume, OTHERS[name][1], TWO_DIGITS, "points")
        lines.append((name, test["sigma_r"], test["e_0"], int(laboratory.used(test).sum()), f"{q:.4f}", OTHERS[name][0],
                      f"{volume:.5f}", OTHERS[name][1],
                      f"{error:.2e}"))
    tables.write(bench.output / "misfit.csv", ("test", "sigma_r_kPa", "e_0", "rows", "q_rms_pct", "q_rms_pct_reference",
                                               "eps_v_rms_pp",
                                               "eps_v_rms_pp_reference", "control_error"), lines)
    bench.note("Drained tests: misfit over the laboratory rows from 1 to 25 % axial strain")
    bench.note("   q: rms of q/q_lab - 1;  eps_v: rms difference in percentage points;  ref.: an independent "
               "integration")
    bench.note("   test   sigma_r    e_0   rows |    q [%]   ref.  | eps_v [pp]  ref.  | control error")
    for name, sigma, e, rows, q, other_q, volume, other_volume, error in lines:
        bench.note(f"   {name}  {sigma:5.0f} kPa  {e:.3f}  {rows:3d} | {float(q):8.2f}  {other_q:5d}  |   "
                   f"{float(volume):7.3f}  {other_volume:5.2f}  |  "
                   f"{float(error):.1e}")
    cases = {(e, start): f"undrained_e{e[2:]}_p{start}" for e in VOID_RATIOS for start in PRESSURES}
    undrained = {key: bench.driver(case) for key, case in cases.items()}
    report_undrained(bench, undrained, {key: bench.driver(case, FAR) for key, case in cases.items()})
    return tests, drained, undrained


def report_undrained(bench, runs, further):
    bench.note("Undrained tests: p' and q [kPa] at 25 %, continued to natural strain 1,")
    bench.note("   and the steady state p'_c = (N_c/e)^(1/lambda) - alpha_csl, q_c = M_c p'_c")
    bench.note("     e    p'_0 |  at 25 %: p'        q |  continued: p'      q |  closed: p'_c     q_c | q/q_c - 1: at "
               "25 %, continued")
    lines = []
    for (void_ratio, start), run in runs.items():
        longer, pressure = further[void_ratio, start], steady_pressure(float(void_ratio))
        deviator, end = P["M_c"] * pressure, int(np.argmin(np.abs(run["eps_a"] - 0.25)))
        values = (run["p_eff"][end], run["q"][end], longer["p_eff"][-1], longer["q"][-1], pressure, deviator)
        off = [100 * (values[i] / deviator - 1) for i in (1, 3)]
        bench.note(f"   {void_ratio}  {start:4d} |   {values[0]:8.2f} {values[1]:8.2f} |   {values[2]:8.2f} "
                   f"{values[3]:8.2f} |"
                   f"   {values[4]:8.2f} {values[5]:8.2f} |   {off[0]:+8.2f} %   {off[1]:+7.3f} %")
        lines.append((void_ratio, start, *(f"{v:.4f}" for v in values), *(f"{v:.4f}" for v in off)))
    tables.write(bench.output / "steady_state.csv", ("e", "p_0_kPa", "p_25pct_kPa", "q_25pct_kPa", "p_continued_kPa",
                                                     "q_continued_kPa", "p_closed_kPa",
                                                     "q_closed_kPa", "q_off_25pct_pct", "q_off_continued_pct"), lines)


def draw(bench, results, plt):
    tests, drained, undrained = results
    with plt.rc_context({"axes.spines.top": False, "axes.spines.right": False, "lines.linewidth": 1.6,
                         "savefig.dpi": 160}):
        bench.save(drained_picture(drained, tests, plt), "drained.png", dpi=160)
        bench.save(undrained_picture(undrained, plt), "undrained.png")
        bench.save(states_picture(drained, undrained, tests, plt), "states.png", dpi=160)


def drained_picture(runs, tests, plt):
    figure, axes = plt.subplots(2, 2, figsize=(9.5, 7), sharex=True)
    for column, group in enumerate((("TMD4", "TMD5", "TMD6"), ("TMD1", "TMD2", "TMD3"))):
        top, bottom = axes[0, column], axes[1, column]
        for colour, name in zip(COLOURS, group):
            run, test = runs[name], tests[name]
            label = f"$e_0$ = {test['e_0']:.3f}"
            top.plot(100 * run["eps_a"], run["q"], color=colour, label=label)
            top.plot(test["eps_a"], test["q"], "o", color=colour, ms=4, mfc="white")
            bottom.plot(100 * run["eps_a"], laboratory.volumetric_strain(run), color=colour, label=label)
            bottom.plot(test["eps_a"], test["eps_v"], "o", color=colour, ms=4, mfc="white")
        top.set_title(f"drained, radial stress {tests[group[0]]['sigma_r']:.0f} kPa")
        top.set_ylim(bottom=0)
        bottom.axhline(0, color="#888888", lw=0.8)
        bottom.set_xlabel("axial strain [%]")
        handles, labels = top.get_legend_handles_labels()
        handles += [plt.Line2D([], [], color="#555555"),
                    plt.Line2D([], [], color="#555555", marker="o", ls="", ms=4, mfc="white")]
        top.legend(handles, labels + ["model", "laboratory"], loc="lower right", ncols=2)
    limits = [f(a.get_ylim()[i] for a in axes[1]) for i, f in ((0, min), (1, max))]
    for axis in axes[1]:
        axis.set_ylim(*limits)
        axis.set_xlim(0, 30)
        axis.annotate("contraction", (0.02, 0.97), xycoords="axes fraction", va="top", color="#777777")
        axis.annotate("dilation", (0.02, 0.03), xycoords="axes fraction", va="bottom", color="#777777")
    axes[0, 0].set_ylabel("deviator stress q [kPa]")
    axes[1, 0].set_ylabel("volumetric strain [%]")
    figure.suptitle("Toyoura sand, drained triaxial compression: MUD with its published parameters, "
                    "and Verdugo & Ishihara (1996)")
    return figure


def undrained_picture(runs, plt):
    figure, axes = plt.subplots(2, 3, figsize=(11, 7))
    for column, void_ratio in enumerate(VOID_RATIOS):
        top, bottom = axes[0, column], axes[1, column]
        pressure = steady_pressure(float(void_ratio))
        deviator = P["M_c"] * pressure
        for colour, start in zip(COLOURS, PRESSURES):
            run = runs[void_ratio, start]
            top.plot(100 * run["eps_a"], run["q"], color=colour, label=f"{start} kPa")
            bottom.plot(run["p_eff"], run["q"], color=colour)
            bottom.plot(run["p_eff"][0], 0, "|", color=colour, ms=9, mew=2, clip_on=False)
        right = 1.08 * max(run["p_eff"].max() for (e, _), run in runs.items() if e == void_ratio)
        line = np.array([0, right])
        bottom.plot(line, P["M_c"] * line, color="#777777", lw=1, ls="--", label="$q = M_c\\,p'$")
        bottom.plot(pressure, deviator, "*", color="black", ms=11, zorder=5, label="steady state, closed form")
        top.axhline(deviator, color="black", lw=0.9, ls=":", label="steady state, closed form")
        top.set_title(f"undrained, e = {void_ratio}")
        top.set_xlabel("axial strain [%]")
        top.set_xlim(0, 25)
        top.set_ylim(bottom=0)
        bottom.set_xlabel("mean effective stress p' [kPa]")
        bottom.set_xlim(0, right)
        bottom.set_ylim(0, 1.08 * max(run["q"].max() for (e, _), run in runs.items() if e == void_ratio))
    axes[0, 0].set_ylabel("deviator stress q [kPa]")
    axes[1, 0].set_ylabel("deviator stress q [kPa]")
    axes[0, 0].legend(title="consolidated at", loc="lower right")
    axes[1, 0].legend(loc="upper left")
    figure.suptitle("Toyoura sand, undrained triaxial compression: MUD with its published parameters")
    return figure


def states_picture(drained, undrained, tests, plt):
    figure, axis = plt.subplots(figsize=(8, 5.5))
    pressure = np.geomspace(20, 6000, 400)
    critical = critical_void_ratio(pressure)
    axis.plot(pressure, critical, color="black", lw=2.2, label="critical state line, closed form")
    for run in drained.values():
        axis.plot(run["p_eff"], run["e"], color=COLOURS[0])
    for test in tests.values():
        axis.plot(test["p"], test["e"], "o", color=COLOURS[0], ms=3, mfc="white", mew=0.7)
        axis.plot(test["p"][-1], test["e"][-1], "o", color=COLOURS[0], ms=6)
    for run in undrained.values():
        axis.plot(run["p_eff"], run["e"], color=COLOURS[1], lw=1.3, alpha=0.8)
        axis.plot(run["p_eff"][0], run["e"][0], "|", color=COLOURS[1], ms=9, mew=2)
        axis.plot(run["p_eff"][-1], run["e"][-1], "D", color=COLOURS[1], ms=4, zorder=5)
    axis.set_xscale("log")
    axis.set_xticks((20, 50, 100, 200, 500, 1000, 2000, 5000))
    axis.xaxis.set_major_formatter(plt.ScalarFormatter())
    axis.xaxis.set_minor_formatter(plt.NullFormatter())
    axis.set_xlim(20, 6000)
    axis.set_xlabel("mean effective stress p' [kPa], logarithmic")
    axis.set_ylabel("void ratio e [-]")
    extra = [plt.Line2D([], [], color=COLOURS[0]),
             plt.Line2D([], [], color=COLOURS[0], marker="o", ls="", ms=3, mfc="white", mew=0.7),
             plt.Line2D([], [], color=COLOURS[0], marker="o", ls="", ms=6),
             plt.Line2D([], [], color=COLOURS[1], marker="|", ms=9, mew=2),
             plt.Line2D([], [], color=COLOURS[1], marker="D", ls="", ms=4)]
    handles, labels = axis.get_legend_handles_labels()
    axis.legend(handles + extra, labels + ["drained, model to 30 %", "drained, laboratory", "its last point",
                                           "undrained, model, from the bar", "its end at 25 %"], loc="lower left")
    axis.set_title("Toyoura sand: paths towards the critical state")
    return figure
