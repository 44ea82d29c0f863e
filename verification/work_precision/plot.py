"""work_precision.png and the tables of README.md from work_precision.csv and orders.csv of this folder (or of FOLDER)."""
import collections
import csv
import math
import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

HERE = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
TITLES = {"undrained_e735_p100": "undrained, e 0.735, p' 100", "undrained_e833_p2000": "undrained, e 0.833, p' 2000",
          "undrained_e907_p100": "undrained, e 0.907, p' 100", "extension_e833_p100": "extension, e 0.833, p' 100",
          "oedometer_e8_p50": "oedometer, e 0.8, p' 50", "isotropic_e8_p50": "isotropic, e 0.8, p' 50",
          "unsaturated_e8_p20": "unsaturated, e 0.8, p' 20, p$_c$ 100", "figure_1_threshold": "Fig. 1, rule threshold"}
STYLE = {"ME21": ("o-", "tab:blue", "modified Euler 2(1)"), "BS32": ("s-", "tab:orange", "Bogacki-Shampine 3(2)"),
         "DP54": ("^-", "tab:green", "Dormand-Prince 5(4)")}


def rows(name):
    with open(HERE / name, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def picture(table):
    figure, axes = plt.subplots(2, 4, figsize=(13, 6.4), sharex=True, sharey=True, constrained_layout=True)
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
    figure.savefig(HERE / "work_precision.png", dpi=110)


def work_table(table):
    print("| path | scheme | 1e-3 | 1e-5 | 1e-7 | 1e-9 | refused at |\n|---|---|---|---|---|---|---|")
    for path in TITLES:
        for scheme in STYLE:
            mine = {row["tolerance"]: row for row in table if (row["path"], row["scheme"]) == (path, scheme)}
            cells = []
            for tolerance in ("1.0E-03", "1.0E-05", "1.0E-07", "1.0E-09"):
                row = mine[tolerance]
                cells.append(f"{float(row['error']):.0e}, {row['rates']}" if row["status"] == "0" else "-")
            bad = [f"{float(t):.0e} (code {row['status']})" for t, row in mine.items() if row["status"] != "0"]
            print(f"| {path} | {scheme} | {' | '.join(cells)} | {', '.join(bad)} |")


def order_table(table):
    """Slope by least squares over the finest five halvings whose error is above 1e-12."""
    cases = collections.defaultdict(list)
    for row in table:
        cases[row["case"], row["scheme"]].append((int(row["substeps"]), float(row["error"])))
    print("\n| case | scheme | substeps | error | mean slope |\n|---|---|---|---|---|")
    for (case, scheme), points in cases.items():
        used = [(math.log2(n), math.log2(error)) for n, error in points if error > 1e-12][-5:]
        x, y = (sum(column)/len(used) for column in zip(*used))
        slope = sum((a - x)*(b - y) for a, b in used)/sum((a - x)**2 for a, b in used)
        print(f"| {case} | {scheme} | {2**used[0][0]:.0f} to {2**used[-1][0]:.0f} | {2**used[0][1]:.1e} to "
              f"{2**used[-1][1]:.1e} | {-slope:.2f} |")


work = rows("work_precision.csv")
picture(work)
work_table(work)
order_table(rows("orders.csv"))
