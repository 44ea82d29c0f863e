# SPDX-License-Identifier: MIT
"""Strength in compression, extension and simple shear against the closed form."""
import math

from closed_forms import INTEGRATION, PUBLISHED, P, lode, steady_pressure
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="strength in compression, extension and simple shear depends on the Lode angle as M_c g",
    kind="exact",
    input="`drivers/cases/lode_compression`, `lode_extension` (constant p' to strain 1), `lode_simple_shear` (constant "
          "volume to shear strain 2); "
          "e 0.833, p' 1116 kPa, near the critical state line so that the ends are reached",
    reference="at a steady state r = sqrt(2/3) g(n) M n with n the direction of the strain rate: q/p' = M_c g(cos 3t), "
              "cos 3t = 1, -1, 0",
    seconds=2, quick=1, every_build=True, pictures=("lode.png",))

TESTS = {"lode_compression": 1, "lode_extension": -1, "lode_simple_shear": 0}   # name: cos 3t
REACHED = Tolerance("simple shear reaches its end: ten times the integration's tolerance", relative=10 * INTEGRATION)
AXES = Tolerance("simple shear reaches its end: ten times the integration's tolerance", absolute=10 * INTEGRATION)
NEARLY = Tolerance("at constant p' psi still has -3e-4 and -4e-4 to go, and M exp(-n_b psi) then is 0.04 to 0.05 % "
                   "above M", relative=2e-3)


def check(bench):
    """Stress ratio at the end of every test."""
    ends = {}
    for name, cos3t in TESTS.items():
        run = bench.driver(name, PUBLISHED)
        if cos3t:
            ends[name] = abs(run["q"][-1]) / run["p_eff"][-1]
        else:
            normal = [run[f"sig_{i}"][-1] - run["p_eff"][-1] for i in ("11", "22", "33")]
            shear = run["sig_13"][-1]
            ends[name] = math.sqrt(1.5 * (sum(v * v for v in normal) + 2 * shear * shear)) / run["p_eff"][-1]
            bench.near("simple shear: stress and strain rate share their axes, max s_ii/tau",
                       max(map(abs, normal)) / shear, 0, AXES)
            bench.near("simple shear: p'", run["p_eff"][-1], steady_pressure(0.833), REACHED, "kPa")
        bench.near(f"{name}: q/p'", ends[name], P["M_c"] * lode(cos3t), NEARLY if cos3t else REACHED)
    return ends


def draw(bench, ends, plt):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.4))
    axes[1].remove()
    polar = figure.add_subplot(1, 2, 2, projection="polar")
    angles = [2 * math.pi * i / 360 for i in range(361)]
    polar.plot(angles, [P["M_c"] * lode(math.cos(3 * a)) for a in angles], "k-", lw=1)
    for (name, cos3t), colour in zip(TESTS.items(), COLOURS):
        run = bench.driver(name, PUBLISHED)
        if cos3t:
            eta, strain = abs(run["q"]) / run["p_eff"], abs(run["eps_a"])
        else:
            p = run["p_eff"]
            eta = (1.5 * (sum((run[f"sig_{k}"] - p) ** 2 for k in ("11", "22", "33"))
                          + 2 * run["sig_13"] ** 2)) ** 0.5 / p
            strain = run["gamma_13"]
        label = name.removeprefix("lode_").replace("_", " ")
        axes[0].plot(strain, eta, color=colour, label=label)
        axes[0].axhline(P["M_c"] * lode(cos3t), color=colour, ls=":", lw=1)
        polar.plot([math.acos(cos3t) / 3], [ends[name]], "o", color=colour, label=label)
    axes[0].legend(loc="lower right")
    axes[0].set(xlabel="axial strain or shear strain [-]", ylabel="q/p' [-]", title="dotted: M g")
    polar.set_title("deviatoric plane: M g and the ends of the tests")
    bench.save(figure, "lode.png")
