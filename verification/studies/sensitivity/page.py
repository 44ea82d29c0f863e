# SPDX-License-Identifier: MIT
"""How the misfit with the drained tests of Verdugo & Ishihara (1996) moves with h_0 and A_0."""
import re

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="h_0 governs the misfit of q, A_0 that of the volumetric strain; nothing is tuned, the published "
          "values remain those of the library",
    kind=("study", "regression"),
    input="the six drained tests of `../../material/verdugo_ishihara` with h_0 or A_0 times 0.5 to 2 "
          "(`sensitivity.csv`)",
    reference="the committed results: the row of the published values is run again",
    seconds=3, pictures=("sensitivity.png",))
MAKES = (Script("scale_parameters.py", ("sensitivity.csv",), 5),)

PRINTED = Tolerance("the file has two decimals: half a unit of the last, and rounding", absolute=0.00501)
PRINTED_VOLUME = Tolerance("the file has three decimals: half a unit of the last, and rounding", absolute=0.000501)


def check(bench):
    import scale_parameters
    rows = tables.rows(bench.here / "sensitivity.csv")
    published = next(row for row in rows if row["factor"] == "1.0")
    for name, (q, volume) in scale_parameters.misfits(bench, "h_0", scale_parameters.P["h_0"]).items():
        bench.near(f"as published, {name}: misfit of q", q, float(published[f"q_{name}_pct"]), PRINTED, "%")
        bench.near(f"as published, {name}: misfit of eps_v", volume, float(published[f"eps_v_{name}_points"]),
                   PRINTED_VOLUME, "points")
    return rows


def texts(bench):
    rows = tables.rows(bench.here / "sensitivity.csv")
    parts = [[r for r in rows if r["parameter"] == name] for name in ("h_0", "A_0")]
    lines = [(re.sub(r"\.0$", "", h["factor"]) + " (published)" * (h["factor"] == "1.0"), h["q_mean_pct"],
              h["eps_v_mean_points"], a["q_mean_pct"],
              a["eps_v_mean_points"]) for h, a in zip(*parts)]
    return {"README.md": {"means": tables.markdown(("factor", "h_0: q [%]", "eps_v [points]", "A_0: q [%]",
                                                    "eps_v [points]"), lines)}}


def draw(bench, rows, plt):
    import laboratory
    tests = laboratory.read()
    figure, axes = plt.subplots(2, 2, figsize=(10, 7), sharex=True)
    for column, parameter in enumerate(("h_0", "A_0")):
        mine = [row for row in rows if row["parameter"] == parameter]
        factors = [float(row["factor"]) for row in mine]
        for line, key, unit in ((0, "q", "pct"), (1, "eps_v", "points")):
            for name, test in tests.items():
                axes[line, column].plot(factors, [float(row[f"{key}_{name}_{unit}"]) for row in mine], "o-", ms=3,
                                        label=f"{name}, {test['sigma_r']:.0f} kPa, $e_0$ {test['e_0']}")
            axes[line, column].plot(factors, [float(row[f"{key}_mean_{unit}"]) for row in mine], "k--",
                                    label="mean of the six")
            axes[line, column].axvline(1, color="#888888", lw=0.8)
        axes[1, column].set_xlabel(f"{parameter} over its published value")
    axes[0, 0].set_ylabel("misfit of q [%]")
    axes[0, 1].legend(fontsize=7, loc="upper right")
    axes[1, 0].set_ylabel("misfit of the volumetric strain [points]")
    bench.save(figure, "sensitivity.png")
