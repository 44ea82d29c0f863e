# SPDX-License-Identifier: MIT
"""Wetting and drying where only the bonding variable changes."""
from closed_forms import PUBLISHED, ROUNDING, P, bonding, critical_void_ratio
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="at constant effective stress suction acts through the bonding variable alone: drying causes no "
          "strain, wetting on the compression line causes collapse along it",
    kind="exact",
    input="`drivers/cases/drying_constant_stress` (p' 100 kPa, e 0.8, suction 1 to 500 kPa) and `wetting_on_the_line` "
          "(e 0.8 on the compression line at "
          "suction 200 kPa, wetted to zero); six effective stresses held as linear constraints",
    reference="drying lifts the lines of eqs (7), (8): psi = e - N_c f (p' + alpha_csl)^(-lambda) and no strain; on "
              "the compression line F = 1 and the rate "
              "integrates to e = N_l f(zeta(e, p_c)) p'^(-lambda)",
    seconds=2, quick=1, every_build=True, pictures=("bonding.png",))

NOTHING = Tolerance("neither elastic nor plastic strain occurs")
ROUNDED = Tolerance("a few thousand roundings", absolute=ROUNDING)
COLLAPSE = Tolerance("ten times the integration's tolerance of 1e-5", absolute=1e-4)
COLLAPSED = Tolerance("ten times the integration's tolerance of 1e-5", relative=1e-4)


def line_void_ratio(suction, e, p):
    """e = N_l f(e, p_c) p'^-lambda from a first guess: a contraction, for f hardly depends on e."""
    for _ in range(60):
        e = P["N_l"] * bonding(suction, e) * p ** -P["lambda"]
    return e


def check(bench):
    run = bench.driver("drying_constant_stress", PUBLISHED)
    bench.near("drying at constant stress: strain", max(max(map(abs, run[k])) for k in ("eps_a", "eps_v")), 0, NOTHING)
    psi = [e - critical_void_ratio(100.0, bonding(s, e)) for e, s in zip(run["e"], run["suction"])]
    bench.near("drying at constant stress: state parameter", max(abs(a - b) for a, b in zip(psi, run["psi"])), 0,
               ROUNDED)
    run = bench.driver("wetting_on_the_line", PUBLISHED)
    p, e, off = run["p_eff"][0], run["e"][0], 0.0
    for suction, there in zip(run["suction"], run["e"]):
        e = line_void_ratio(suction, e, p)
        off = max(off, abs(there / e - 1))
    bench.near("wetting on the line: it stays on the line, e/e_line", off, 0, COLLAPSE)
    bench.near("wetting on the line: void ratio when saturated", run["e"][-1], P["N_l"] * p ** -P["lambda"], COLLAPSED)


def draw(bench, _, plt):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    run = bench.driver("wetting_on_the_line", PUBLISHED)
    line = [line_void_ratio(s, e, run["p_eff"][0]) for s, e in zip(run["suction"], run["e"])]
    axes[0].plot(run["suction"], run["e"], color=COLOURS[0], label="model")
    axes[0].plot(run["suction"], line, "k--", lw=1, label="closed form")
    axes[0].set(xlabel="suction [kPa]", ylabel="e [-]", title="wetting under constant effective stress, on the line")
    axes[0].invert_xaxis()
    axes[0].legend()
    run = bench.driver("drying_constant_stress", PUBLISHED)
    axes[1].plot(run["suction"], run["psi"], color=COLOURS[0], label="model")
    axes[1].plot(run["suction"], [e - critical_void_ratio(100.0, bonding(s, e)) for e,
                                  s in zip(run["e"], run["suction"])],
                 "k--", lw=1, label="closed form")
    axes[1].set(xlabel="suction [kPa]", ylabel="state parameter [-]", title="drying under constant effective stress")
    axes[1].legend()
    bench.save(figure, "bonding.png")
