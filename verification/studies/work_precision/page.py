# SPDX-License-Identifier: MIT
"""Work and precision of the integration schemes: picture and tables from the committed results."""
import collections
import math

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="the cost of accuracy with the default scheme and with each of the three that can be named; their measured "
          "orders on smooth paths and across kinks",
    kind=("study", "code-to-code"),
    input="eight paths, each straight part one increment, tolerances 1e-2 to 1e-10 (`work_precision.csv`); fixed "
          "substeps (`orders.csv`): made by `scripts/benchmark`",
    reference="`reference.csv`: ends of the paths by the independent implementation in `../../material/reference`, "
              "Dormand-Prince 8(5,3) at 1e-12, with its uncertainty",
    seconds=2, quick=1, pictures=("work_precision.png",))
MAKES = (Script("make_reference.py", ("reference.csv",), 5),)

TITLES = {"undrained_e735_p100": "undrained, e 0.735, p' 100", "undrained_e833_p2000": "undrained, e 0.833, p' 2000",
          "undrained_e907_p100": "undrained, e 0.907, p' 100", "extension_e833_p100": "extension, e 0.833, p' 100",
          "oedometer_e8_p50": "oedometer, e 0.8, p' 50", "isotropic_e8_p50": "isotropic, e 0.8, p' 50",
          "unsaturated_e8_p20": "unsaturated, e 0.8, p' 20, p$_c$ 100", "figure_1_threshold": "Fig. 1, rule threshold"}
REACHED = Tolerance("F is smooth within 1e-4 of the compression line, which the reference does not have: up to 1e-7 of "
                    "the stress where a path crosses it", absolute=1e-7)
STYLE = {"auto": ("D-", "black", "automatic (default)"), "ME21": ("o-", "tab:blue", "modified Euler 2(1)"),
         "BS32": ("s-", "tab:orange", "Bogacki-Shampine 3(2)"),
         "DP54": ("^-", "tab:green", "Dormand-Prince 5(4)")}



def check(bench):
    """Every path and scheme comes to the reference; tests/umat/contract/test_order.pf holds orders on smooth paths.

    Modified Euler alone needs more substeps at 1e-9 than an increment may have: it is held at 1e-7.
    """
    for row in tables.rows(bench.here / "work_precision.csv"):
        if float(row["tolerance"]) == (1e-7 if row["scheme"] == "ME21" else 1e-9):
            bench.below(f"{row['path']}, {row['scheme']}: error at a tolerance of {float(row['tolerance']):.0e}",
                        float(row["error"]) if row["status"] == "0" else math.nan, REACHED)


def texts(bench):
    work, orders = (tables.rows(bench.here / f"{name}.csv") for name in ("work_precision", "orders"))
    return {"tables.md": {"work": work_table(work), "orders": order_table(orders)}}


def draw(bench, _, plt):
    table = tables.rows(bench.here / "work_precision.csv")
    figure, axes = plt.subplots(2, 4, figsize=(13, 6.4), sharex=True, sharey=True)
    for axis, path in zip(axes.flat, TITLES):
        for scheme, (marker, colour, label) in STYLE.items():
            mine = [row for row in table if (row["path"], row["scheme"]) == (path, scheme)]
            good = [row for row in mine if row["status"] == "0"]
            axis.loglog([int(row["rates"]) for row in good], [float(row["error"]) for row in good], marker,
                        color=colour, label=label, markersize=4, linewidth=1.1)
            usual = [row for row in good if row["tolerance"] == "1.0E-05"]
            axis.loglog([int(row["rates"]) for row in usual], [float(row["error"]) for row in usual], marker[0],
                        color=colour, markersize=9, fillstyle="none")
        axis.axhline(float(mine[0]["uncertainty"]), color="grey", linestyle=":", linewidth=1)
        axis.set_title(TITLES[path], fontsize=9)
        axis.grid(True, which="major", linewidth=0.4)
    axes.flat[0].legend(fontsize=8, loc="upper right")
    figure.supxlabel("rate evaluations on the whole path", fontsize=10)
    figure.supylabel("relative error of the stress at the end", fontsize=10)
    bench.save(figure, "work_precision.png")


def work_table(table):
    """Error and rate evaluations by tolerance."""
    lines = []
    for path in TITLES:
        for scheme in STYLE:
            mine = {row["tolerance"]: row for row in table if (row["path"], row["scheme"]) == (path, scheme)}
            cells = []
            for tolerance in ("1.0E-03", "1.0E-05", "1.0E-07", "1.0E-09"):
                row = mine[tolerance]
                cells.append(f"{float(row['error']):.0e}, {row['rates']}" if row["status"] == "0" else "-")
            bad = [f"{float(t):.0e} (code {row['status']})" for t, row in mine.items() if row["status"] != "0"]
            lines.append((path, scheme, *cells, ", ".join(bad)))
    return tables.markdown(("path", "scheme", "1e-3", "1e-5", "1e-7", "1e-9", "refused at"), lines)


def order_table(table):
    """Slope by least squares over the finest five halvings whose error is above 1e-12."""
    cases = collections.defaultdict(list)
    for row in table:
        cases[row["case"], row["scheme"]].append((int(row["substeps"]), float(row["error"])))
    lines = []
    for (case, scheme), points in cases.items():
        used = [(math.log2(n), math.log2(error)) for n, error in points if error > 1e-12][-5:]
        x, y = (sum(column)/len(used) for column in zip(*used))
        slope = sum((a - x)*(b - y) for a, b in used)/sum((a - x)**2 for a, b in used)
        lines.append((case, scheme, f"{2**used[0][0]:.0f} to {2**used[-1][0]:.0f}",
                      f"{2**used[0][1]:.1e} to " f"{2**used[-1][1]:.1e}",
                      f"{-slope:.2f}"))
    return tables.markdown(("case", "scheme", "substeps", "error", "mean slope"), lines)
