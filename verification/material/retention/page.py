# SPDX-License-Identifier: MIT
"""Retention curve and constant water content."""
from closed_forms import PUBLISHED, ROUNDING, saturation
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="the degree of saturation follows the retention curve, with the void ratio in it, also where the water "
          "content is held",
    kind="exact",
    input="`drivers/cases/drying_constant_volume` (suction 0 to 1000 kPa, no strain) and `constant_water` (drained "
          "compression, then isotropic, S_w e held "
          "and suction free)",
    reference="eqs (23), (24): p* = p_c e^Omega, S_w = S_min + (S_max - S_min)[ln(exp(1) + (p*/P_a)^n_x)]^(-m_x)",
    seconds=1, quick=1, every_build=True, pictures=("retention.png",))

ROUNDED = Tolerance("a few thousand roundings", absolute=ROUNDING)
HELD = Tolerance("the driver meets the water content to 1e-10 in every increment, without adding up", absolute=1e-9)


def check(bench):
    for name, title in (("drying_constant_volume", "drying at constant volume"),
                        ("constant_water", "constant water content")):
        run = bench.driver(name, PUBLISHED)
        off = max(abs(s - saturation(p, e)) for s, p, e in zip(run["s_w"], run["suction"], run["e"]))
        bench.near(f"{title}: S_w", off, 0, ROUNDED)
    water = [s * e for s, e in zip(run["s_w"], run["e"])]
    bench.near("constant water content: S_w e over its start", max(abs(w / water[0] - 1) for w in water), 0, HELD)


def draw(bench, _, plt):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    run = bench.driver("drying_constant_volume", PUBLISHED)
    axes[0].semilogx(run["suction"][1:], run["s_w"][1:], color=COLOURS[0], label="model, e 0.8")
    for e, style in ((0.6, ":"), (0.8, "--"), (1.0, "-.")):
        axes[0].semilogx(run["suction"][1:], [saturation(s, e) for s in run["suction"][1:]], "k", ls=style, lw=1,
                         label=f"closed form, e {e}")
    axes[0].set(xlabel="suction [kPa], logarithmic", ylabel="S$_w$ [-]", title="retention curve, eqs (23), (24)")
    axes[0].legend()
    run = bench.driver("constant_water", PUBLISHED)
    axes[1].plot(run["e"], run["s_w"], color=COLOURS[0], label="model")
    axes[1].plot(run["e"], [run["s_w"][0] * run["e"][0] / e for e in run["e"]], "k--", lw=1, label="S$_w$ e constant")
    axes[1].set(xlabel="e [-]", ylabel="S$_w$ [-]", title="constant water content, drained then isotropic")
    axes[1].legend()
    bench.save(figure, "retention.png")
