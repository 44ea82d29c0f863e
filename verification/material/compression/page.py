# SPDX-License-Identifier: MIT
"""Isotropic and K0 compression against the compression line."""
import math
import re

from closed_forms import INTEGRATION, PUBLISHED, P, line_pressure
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="isotropic compression is its scalar equation and ends on the compression line; K0 compression is that of "
          "another implementation",
    kind=("exact", "code-to-code"),
    input="`drivers/cases/isotropic_e8_p50` and `oedometer_e8_p50`, e 0.8 and p' 50 kPa, continued to eps_v 0.15",
    reference="isotropic: d eps_v = dp'/K + A dp'/p' by Runge-Kutta of 4th order in 20000 steps (half the step moves "
              "it by less than 1e-7); line: "
              "p' = (N_l/e)^(1/lambda), eq. (7); K0: the independent implementation in `../reference`",
    seconds=3, quick=2, every_build=True, pictures=("compression.png",))

FAR = (*PUBLISHED, (re.compile(r"eps_v_end = \S+"), "eps_v_end = 0.15"))
PATH = Tolerance("ten times the integration's tolerance of 1e-5", relative=10 * INTEGRATION)
LINE = Tolerance("the path comes near the line from below without reaching it", absolute=0.005)
NOT_CROSSED = Tolerance("the isotropic path does not cross the line; a hundred times the integration's tolerance",
                        absolute=1e-3)
SIX_DIGITS = Tolerance("the reference for K0 has six digits; the driver's increments and the integration leave far "
                       "less than 0.05 %",
                       relative=5e-4)
THREE_DIGITS = Tolerance("the reference has three digits", absolute=0.005)


def isotropic_reference(p, e, strain, steps=20000):
    """Runge-Kutta of 4th order on d ln p'/d eps_v = 1/(p'/K + A), the scalar form of isotropic compression."""
    def rate(ln_p, eps):
        p_now = math.exp(ln_p)
        e_now = (1 + e) * math.exp(-eps) - 1
        k = P["K_0"] * P["p_atm"] * (1 + e_now) / e_now * (p_now / P["p_atm"]) ** (2 / 3)
        delta = 1 - p_now / line_pressure(e_now)
        f = 1 - math.copysign(abs(delta) ** P["theta"], delta)
        kappa = p_now / k * (1 + e_now) / e_now
        a = e_now / (1 + e_now) * (P["lambda"] - kappa) * f
        return 1 / (p_now / k + max(a, 0))
    ln_p, d = math.log(p), strain / steps
    for i in range(steps):
        eps = i * d
        k1 = rate(ln_p, eps)
        k2 = rate(ln_p + d / 2 * k1, eps + d / 2)
        k3 = rate(ln_p + d / 2 * k2, eps + d / 2)
        k4 = rate(ln_p + d * k3, eps + d)
        ln_p += d / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return math.exp(ln_p)


def k0_ratio(run):
    """(p'/p'_line)(1 + 2 eta^2/M^2): 1 on the compression line."""
    return [p / line_pressure(e) * (1 + 2 * (q / p / P["M_c"]) ** 2) for p, q,
            e in zip(run["p_eff"], run["q"], run["e"])]


def check(bench):
    run = bench.driver("isotropic_e8_p50", FAR)
    for strain in (0.02, 0.06, 0.15):
        here = min(range(len(run["e"])), key=lambda i: abs(run["eps_v"][i] - strain))
        bench.near(f"isotropic, p' at eps_v {strain}", run["p_eff"][here], isotropic_reference(50.0, 0.8, strain), PATH,
                   "kPa")
    ratio = [p / line_pressure(e) for p, e in zip(run["p_eff"], run["e"])]
    bench.near("isotropic: on the line at its end, p'/p'_line", ratio[-1], 1, LINE)
    bench.near("isotropic: the line is never crossed by more than", max(max(ratio) - 1, 0), 0, NOT_CROSSED)
    run = bench.driver("oedometer_e8_p50", FAR)
    here = min(range(len(run["e"])), key=lambda i: abs(run["eps_v"][i] - 0.06))
    bench.near("oedometer, sigma_a at eps_v 0.06", run["sigma_a"][here], 16088.2, SIX_DIGITS, "kPa")
    bench.near("oedometer, sigma_r at eps_v 0.06", run["sigma_r"][here], 5401.90, SIX_DIGITS, "kPa")
    bench.near("oedometer: distance from the line at 0.06", k0_ratio(run)[here], 1.58, THREE_DIGITS)


def draw(bench, _, plt):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    for colour, name, label in zip(COLOURS, ("isotropic_e8_p50", "oedometer_e8_p50"), ("isotropic", "K0 (oedometer)")):
        run = bench.driver(name, FAR)
        axes[0].semilogx(run["p_eff"], run["e"], color=colour, label=label)
        axes[1].plot(100 * run["eps_v"], k0_ratio(run), color=colour, label=label)
    e = [0.8 - 0.002 * i for i in range(130)]
    axes[0].semilogx([line_pressure(v) for v in e], e, "k--", lw=1, label="compression line, eq. (7)")
    axes[0].set(xlabel="p' [kPa], logarithmic", ylabel="e [-]", title="compression from 50 kPa", ylim=(0.52, 0.81))
    axes[1].axhline(1, color="black", ls="--", lw=1)
    axes[1].set(xlabel="volumetric strain [%]", ylabel=r"$(p'/\hat{\alpha})(1+2\eta^2/M^2)$", title="1: on the line")
    axes[0].legend()
    bench.save(figure, "compression.png")
