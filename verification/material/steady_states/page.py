# SPDX-License-Identifier: MIT
"""Undrained tests that end in the closed-form steady state, and tests that begin there."""
import re

from closed_forms import INTEGRATION, PUBLISHED, P, steady_pressure
from tools.bench import MATERIAL
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="undrained tests end on the critical state line, and a test that begins there stays",
    kind="exact",
    input="`drivers/cases/undrained_e735_p100`, `_p3000`, `undrained_e833_p100`, `_p3000`, continued to a natural "
          "axial strain of 1; six tests that "
          "begin in the steady state (e 0.735, 0.833, 0.907; both ways), sheared by 0.1",
    reference="p'_c = (N_c/e)^(1/lambda) - alpha_csl; q = M_c p'_c in compression, -c M_c p'_c in extension",
    seconds=4, quick=3, every_build=True, pictures=("steady_states.png",))

TESTS = ("undrained_e735_p100", "undrained_e735_p3000", "undrained_e833_p100", "undrained_e833_p3000")
FAR = (*PUBLISHED, (re.compile(r"eps_a_end = \S+"), "eps_a_end = 1.0"))
FIXED_POINT = Tolerance("the steady state is a fixed point (D = 0, R_b = r); rounding starts a stiff motion about it, "
                        "which the error control keeps "
                        "within its tolerance of 1e-5 a substep: ten times that", absolute=10 * INTEGRATION)
ARRIVAL = Tolerance("tests come near exponentially; at strain 1 less than 1e-4 is left for these void ratios",
                    relative=5e-4)


def void_ratio(name):
    return float(f"0.{name[11:14]}")


def check(bench):
    for e in (0.735, 0.833, 0.907):
        p = steady_pressure(e)
        for way, strain in ((1, 0.10), (-1, -0.10)):
            q = way * P["M_c"] * (1 if way > 0 else P["c"]) * p
            run = bench.driver_text(
                f"&material\n file = '{MATERIAL}'\n rho_e = 0.0\n/\n&initial\n void_ratio = {e}\n sigma_a = "
                f"{p + 2 * q / 3!r}\n"
                f" sigma_r = {p - q / 3!r}\n/\n&stage\n control = 'undrained'\n eps_a_end = {strain}\n/\n", "steady")
            worst = max(max(abs(v / p - 1) for v in run["p_eff"]), max(abs(v / q - 1) for v in run["q"]))
            bench.near(f"e {e}: a steady state stays one, {'compression' if way > 0 else 'extension'}", worst, 0,
                       FIXED_POINT)
    for name in TESTS:
        run = bench.driver(name, FAR)
        bench.near(f"{name} arrives, q", run["q"][-1], P["M_c"] * steady_pressure(void_ratio(name)), ARRIVAL, "kPa")


def draw(bench, _, plt):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    for name, colour in zip(TESTS, COLOURS):
        run, e = bench.driver(name, FAR), void_ratio(name)
        axes[0].plot(run["eps_a"], run["q"], color=colour, label=f"e {e}, from {name.split('_p')[1]} kPa")
        axes[1].plot(run["p_eff"], run["q"], color=colour)
        p = steady_pressure(e)
        axes[0].axhline(P["M_c"] * p, color="black", ls=":", lw=1)
        axes[1].plot(p, P["M_c"] * p, "k*", ms=11)
    axes[0].plot([], [], "k:", label="closed form")
    axes[0].legend()
    axes[0].set(xlabel="axial strain, natural [-]", ylabel="q [kPa]", title="undrained compression to strain 1")
    axes[1].set(xlabel="p' [kPa]", ylabel="q [kPa]", title="stars: p'$_c$, M$_c$p'$_c$")
    bench.save(figure, "steady_states.png")
