"""Sensitivity of the misfit with Verdugo & Ishihara (1996) to h_0 and A_0: sensitivity.py [--build DIR]

Runs the six drained tests with one of the two scaled, writes sensitivity.csv and sensitivity.png beside this file's table
(README.md). Nothing is tuned: the published values stay the library's.
"""
import argparse
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "scripts"))
from run_demo import DRAINED, DRIVERS, misfit, read_laboratory, read_material, run_case  # noqa: E402

FACTORS = (0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0)


def misfits(driver, folder, tests, parameter, value):
    """{test: (q [%], eps_v [points])}"""
    found = {}
    for name in DRAINED:
        text = (DRIVERS / "cases" / f"vi_drained_{name}.nml").read_text(encoding="utf-8")
        text = re.sub(r"file = '[^']*'", f"file = '{DRIVERS / 'materials' / 'toyoura.nml'}'\n   {parameter} = {value}", text)
        case = folder / f"{name}.nml"
        case.write_text(text, encoding="utf-8")
        found[name] = misfit(run_case(driver, case, folder / f"{name}.csv"), tests[name])
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "build" / "verification", help="of the picture")
    options = parser.parse_args()
    driver = options.build.resolve() / "drivers" / "mud_triax"
    tests, material = read_laboratory(), read_material()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for parameter in ("h_0", "A_0"):
            for factor in FACTORS:
                value = round(factor * material[parameter], 6)
                found = misfits(driver, pathlib.Path(folder), tests, parameter, value)
                mean = [sum(f[i] for f in found.values()) / len(found) for i in (0, 1)]
                rows.append([parameter, value, factor, *(f"{found[n][0]:.2f}" for n in DRAINED), f"{mean[0]:.2f}",
                             *(f"{found[n][1]:.3f}" for n in DRAINED), f"{mean[1]:.3f}"])
                print(*rows[-1])
    header = ["parameter", "value", "factor", *(f"q_{n}_pct" for n in DRAINED), "q_mean_pct",
              *(f"eps_v_{n}_points" for n in DRAINED), "eps_v_mean_points"]
    with open(HERE / "sensitivity.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *rows])

    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(2, 2, figsize=(10, 7), sharex=True)
    for column, parameter in enumerate(("h_0", "A_0")):
        mine = [row for row in rows if row[0] == parameter]
        for i, name in enumerate(DRAINED):
            label = f"{name}, {tests[name]['sigma_r']:.0f} kPa, $e_0$ {tests[name]['e_0']}"
            axes[0, column].plot([r[2] for r in mine], [float(r[3 + i]) for r in mine], "o-", ms=3, label=label)
            axes[1, column].plot([r[2] for r in mine], [float(r[10 + i]) for r in mine], "o-", ms=3)
        for row, k in ((0, 9), (1, 16)):
            axes[row, column].plot([r[2] for r in mine], [float(r[k]) for r in mine], "k--", label="mean of the six")
            axes[row, column].axvline(1, color="#888888", lw=0.8)
        axes[1, column].set_xlabel(f"{parameter} over its published value")
    axes[0, 0].set_ylabel("misfit of q [%]")
    axes[1, 0].set_ylabel("misfit of the volumetric strain [points]")
    axes[1, 1].legend(*axes[0, 1].get_legend_handles_labels(), fontsize=7, loc="upper right")
    options.output.mkdir(parents=True, exist_ok=True)
    figure.savefig(options.output / "sensitivity.png", dpi=130)
    print(options.output / "sensitivity.png")


if __name__ == "__main__":
    main()
