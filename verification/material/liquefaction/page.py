# SPDX-License-Identifier: MIT
"""Cyclic mobility and liquefaction."""
import math
import re

from closed_forms import PUBLISHED, ROUNDING, P, critical_void_ratio
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="long cyclic tests run to their end, and their results are those of the model and not of the integrator",
    kind=("code-to-code", "conservation"),
    input="without an elastic domain: `drivers/cases/cyclic_q_e833_p100` (q of 25 kPa to r_u 0.95), "
          "`cyclic_q_e833_p100_mobility` (60 cycles), "
          "`cyclic_tau_e860_p100` (simple "
          "shear of 15 kPa to a double amplitude of 5 %), `cyclic_strain_e907_p100` (400 strain cycles of 0.1 %)",
    reference="the same test by Dormand-Prince at 1e-8 in increments of 2e-6; limits that hold whatever the path: "
              "p_min, the bounding surface, e",
    seconds=10, quick=8, every_build=True, pictures=("liquefaction.png",))

SAME_CYCLE = Tolerance("a count")
STEEP = Tolerance("r_u is steep there: an increment of 1e-5 is 0.06 % of the strain, and three are allowed",
                  relative=2e-3)
REVERSAL = Tolerance("the driver meets reversals to 1e-7 of the amplitude", absolute=25e-7)
STOP = Tolerance("a stage stops at the first increment beyond its mark: r_u changes by less in one", absolute=0.01)
AMPLITUDE = Tolerance("a stage stops at the first increment beyond its mark, which is 5e-5 at most; ten of them",
                      absolute=5e-4)
CUT_OFF = Tolerance("below p_min the tension cut-off holds p': rounding, with room for the units", absolute=1e-9)
BOUND = Tolerance("beyond the surface softening brings the ratio back, though not immediately; it was never observed beyond",
                  absolute=0.05)
ROUNDED = Tolerance("a few thousand roundings", absolute=ROUNDING)


def check(bench):
    run = bench.driver("cyclic_q_e833_p100", PUBLISHED)
    finer = bench.driver("cyclic_q_e833_p100", (*PUBLISHED, (re.compile(r"increment = \S+"), "increment = 2e-6"),
                                                (re.compile(r"(?m)^   file = .*$"),
                                                 r"\g<0>\n   tolerance = 1e-8\n   " r"scheme = 3")))
    bench.near("cycles to r_u 0.95, by another integrator", int(run["cycle"][-1]), int(finer["cycle"][-1]), SAME_CYCLE)
    bench.near("strain there", run["eps_a"][-1], finer["eps_a"][-1], STEEP)
    turns = [q for q in run["q"] if abs(abs(q) - 25) < 1]
    bench.near("reversals at 25 kPa", max(abs(abs(q) - 25) for q in turns if abs(q) > 24.999), 0, REVERSAL, "kPa")
    bench.near("r_u where it stops", run["r_u"][-1], 0.95, STOP)
    shear = bench.driver("cyclic_tau_e860_p100", PUBLISHED)
    last = [g for g, c in zip(shear["gamma_13"], shear["cycle"]) if c >= shear["cycle"][-1] - 1]
    bench.near("simple shear stops at a double amplitude of", max(last) - min(last), 0.05, AMPLITUDE)
    run = bench.driver("cyclic_strain_e907_p100", PUBLISHED)
    p_min = 0.101325
    bench.near("400 cycles of liquefied sand: all are done", int(run["cycle"][-1]), 400, SAME_CYCLE)
    bench.near("p' falls to p_min and not below", min(run["p_eff"]), p_min, CUT_OFF, "kPa")
    eta = max(abs(q) / p for q, p in zip(run["q"], run["p_eff"]))
    bound = P["M_c"] * math.exp(-P["n_b"] * (0.907 - critical_void_ratio(p_min)))
    bench.near("|q|/p' beyond the bounding surface", max(eta / bound - 1, 0), 0, BOUND)
    bench.near("the void ratio stays", max(run["e"]) - min(run["e"]), 0, ROUNDED)


def draw(bench, _, plt):
    figure, axes = plt.subplots(2, 3, figsize=(12, 7))
    run = bench.driver("cyclic_q_e833_p100_mobility", PUBLISHED)
    axes[0, 0].plot(run["p_eff"], run["q"], color=COLOURS[0], lw=0.6)
    axes[0, 0].set(xlabel="p' [kPa]", ylabel="q [kPa]", title="e 0.833, stress cycles of 25 kPa, 60 cycles")
    axes[1, 0].plot(100 * run["eps_a"], run["q"], color=COLOURS[0], lw=0.4)
    axes[1, 0].set(xlabel="axial strain [%]", ylabel="q [kPa]", title="cyclic mobility", xlim=(-12, 1))
    run = bench.driver("cyclic_tau_e860_p100", PUBLISHED)
    axes[0, 1].plot(run["sig_33"], run["sig_13"], color=COLOURS[1], lw=0.8)
    axes[0, 1].set(xlabel="vertical effective stress [kPa]", ylabel="shear stress [kPa]", title="e 0.86, simple shear")
    axes[1, 1].plot(100 * run["gamma_13"], run["sig_13"], color=COLOURS[1], lw=0.8)
    axes[1, 1].set(xlabel="shear strain [%]", ylabel="shear stress [kPa]", title="to a double amplitude of 5 %")
    run = bench.driver("cyclic_strain_e907_p100", PUBLISHED)
    axes[0, 2].plot(run["p_eff"], run["q"], color=COLOURS[2], lw=0.6)
    axes[0, 2].set(xlabel="p' [kPa]", ylabel="q [kPa]", title="e 0.907, strain cycles of 0.1 %, 400 cycles")
    axes[1, 2].semilogy(run["cycle"], run["p_eff"], ".", ms=1, color=COLOURS[2])
    axes[1, 2].set(xlabel="cycle", ylabel="p' [kPa], logarithmic", title="liquefied: p' near p_min")
    bench.save(figure, "liquefaction.png", dpi=90)
