# SPDX-License-Identifier: MIT
"""The paper's Fig. 1: a small reversal at axial strain 0.1 with every memory rule."""
import variants
from tools import tables
from tools.page import Page, Script, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="the test of the paper's Fig. 1 with every memory rule is that of two other implementations; no variant of "
          "the untreated rule gives the paper's picture",
    kind="code-to-code",
    input="`drivers/cases/fig1_uninterrupted`, `_as_published`, `_classic`, `_threshold`, `_repositioning`, `_return_point`: "
          "e 0.735, p' 100 kPa, undrained triaxial "
          "compression in increments of 1e-5; at axial strain 0.10 back by 0.015 % and forward again",
    reference="the independent implementation in `../reference` (five digits); `variants.py`, the equations in "
              "triaxial space written once more. The paper's "
              "curves are not available as numbers",
    seconds=7, quick=5, every_build=True, pictures=("fig1.png",))
MAKES = (Script("variants.py", ("variants.csv",), 20),)

RULES = ("uninterrupted", "as_published", "classic", "threshold", "repositioning", "return_point")
# q at 0.10, at the turn, back at 0.10, at 0.105, 0.12, 0.15 [kPa], as far as the reference has it.
MARKS = {"uninterrupted": {0.105: 3015.6, 0.12: 3242.0, 0.15: 3492.1},
         "classic": {0.105: 2936.0, 0.12: 3139.7, 0.15: 3396.6},
         "threshold": {"0.10": 2920.0, "the turn": 2845.0, "0.10 again": 2848.0, 0.105: 2943.1, 0.12: 3178.0,
                       0.15: 3456.4},
         "repositioning": {0.105: 2943.1}, "return_point": {0.105: 2946.5}}
FIVE_DIGITS = Tolerance("the reference has five digits, and the integration's 1e-5 a substep adds up over a test",
                        relative=2e-4)


def deviators(bench, rule):
    """q by the name of the place or by the strain."""
    run = bench.driver(f"fig1_{rule}")
    last = run["stage"][-1]

    def q_at(strain, stage):
        here = [i for i, s in enumerate(run["stage"]) if s == stage]
        return run["q"][min(here, key=lambda i: abs(run["eps_a"][i] - strain))]
    values = {"0.10": q_at(0.10, 1)}
    if rule != "uninterrupted":
        values.update({"the turn": q_at(0.09985, 2), "0.10 again": q_at(0.10, last)})
    return {**values, **{s: q_at(s, last) for s in (0.105, 0.12, 0.15)}}


def check(bench):
    for rule, marks in MARKS.items():
        values = deviators(bench, rule)
        for mark, q in marks.items():
            bench.near(f"{rule}: q at {mark}", values[mark], q, FIVE_DIGITS, "kPa")
    for switches, rule in (({"interrupted": False}, "uninterrupted"), ({}, "classic")):
        q = variants.run(**switches, parts=1)[0]
        bench.near(f"{rule}: q at 0.105 by the equations of triaxial space", deviators(bench, rule)[0.105], q[1],
                   FIVE_DIGITS, "kPa")


def draw(bench, _, plt):
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.6))
    for i, rule in enumerate(RULES):
        run = bench.driver(f"fig1_{rule}")
        for axis in axes[:2]:
            axis.plot(100 * run["eps_a"], run["q"], color=("black", *COLOURS)[i], label=rule.replace("_", " "),
                      ls=("-", "--", "-", "-.", ":", "--")[i], lw=(1.8, 1, 1.2, 1.4, 1.8, 1.4)[i])
    axes[0].set(xlabel="axial strain [%]", ylabel="q [kPa]", xlim=(0, 15), ylim=(0, 3600), title="the whole test")
    axes[1].set(xlabel="axial strain [%]", ylabel="q [kPa]", xlim=(9.97, 10.6), ylim=(2820, 3040),
                title="the reversal of 0.015 % at 10 %")
    axes[1].legend()
    rows = tables.rows(bench.here / "variants.csv")
    jumps = [float(row["jump_0.105_pct"]) for row in rows]
    axes[2].barh(range(len(rows)), jumps, color=[COLOURS[1] if j > 0 else COLOURS[0] for j in jumps])
    axes[2].set_yticks(range(len(rows)), [row["variant"] for row in rows])
    axes[2].invert_yaxis()
    axes[2].axvline(0, color="black", lw=0.8)
    axes[2].set(xlabel="q at 10.5 % against the variant's own\nuninterrupted path [%]",
                title="variants of the untreated rule")
    bench.save(figure, "fig1.png", dpi=90)
