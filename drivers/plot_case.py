# SPDX-License-Identifier: MIT
"""One page for a result of mud_triax (CSV or HDF5): plot_case.py FILE [FILE ...] [--output PICTURE]

Several files are drawn over each other. The panels follow from what the test did: paths of stress and strain always,
pore pressure where it builds up, suction and saturation where suction moves, cycles where there are any.
"""
import argparse
import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.ticker  # noqa: E402
import numpy as np  # noqa: E402

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
sys.dont_write_bytecode = True
import tables  # noqa: E402 (its folder is known only now)

COLOURS = ("#0b3c6f", "#c8553d", "#3a8f6a", "#8a5a9e", "#b58900", "#555555")
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1)))
SMALL = 1e-9  # a range below this share of its scale is constant
plt.rcParams.update({
    "savefig.dpi": 130, "font.size": 9, "axes.titlesize": 10, "axes.grid": True, "grid.color": "#dddddd",
    "grid.linewidth": 0.6, "axes.axisbelow": True, "axes.spines.top": False, "axes.spines.right": False,
    "legend.frameon": False, "lines.linewidth": 1.4, "figure.constrained_layout.use": True})


def read_result(path):
    """(facts, columns) of a result file."""
    if path.suffix in (".h5", ".hdf5"):
        import h5py
        with h5py.File(path) as file:
            return ({k: v.decode() for k, v in file.attrs.items()}, {k: np.array(v, float) for k, v in file.items()})
    facts = {}
    for line in tables.comments(path):
        name, _, text = line.rpartition(": ") if line.startswith("not") else line.partition(": ")
        facts[name] = text
    return facts, tables.columns(path)


def moves(run, name, scale=None):
    return name in run and np.ptp(run[name]) > SMALL * (scale or max(1e-30, np.max(np.abs(run[name]))))


def panels(runs):
    """(title, x column, x label, y column, y label, log x) for what happens in the runs."""
    def any_moves(name, scale=None):
        return any(moves(run, name, scale) for run in runs)

    def strain_like(name):
        return f"{name} [%]"

    shear = any_moves("gamma_13", 1.0)
    strain, stress = ("gamma_13", "sig_13") if shear else ("eps_a", "q")
    stress_label = "shear stress [kPa]" if shear else "deviator stress q [kPa]"
    strain_label = strain_like("shear strain" if shear else "axial strain")
    if not any_moves(strain, 1.0):
        strain, strain_label = "eps_v", strain_like("volumetric strain")
    pages = [("stress and strain", strain, strain_label, stress, stress_label, False)] if any_moves(stress) else []
    if any_moves(stress):
        pages.append(("stress path", "p_eff", "mean effective stress p' [kPa]", stress, stress_label, False))
    if any_moves("eps_v", 1.0):
        pages.append(("volume", strain, strain_label, "eps_v", strain_like("volumetric strain"), False))
    if any_moves("u"):
        pages.append(("pore pressure", strain, strain_label, "u", "excess pore pressure [kPa]", False))
    if any_moves("e"):
        pages.append(("state", "p_eff", "mean effective stress p' [kPa], logarithmic", "e", "void ratio e [-]", True))
    else:
        pages.append(("mean stress", strain, strain_label, "p_eff", "mean effective stress p' [kPa]", False))
    if any_moves("suction"):
        pages.append(("retention", "suction", "suction [kPa]", "s_w", "degree of saturation [-]", False))
        pages.append(("suction", strain, strain_label, "suction", "suction [kPa]", False))
    if any_moves("r_u") and any_moves("cycle"):
        pages.append(("cycles", "cycle", "cycle", "r_u", "pore pressure ratio [-]", False))
        pages.append(("cycles", "cycle", "cycle", strain, strain_label, False))
    pages.append(("state parameter", strain, strain_label, "psi", "state parameter [-]", False))
    pages.append(("cost", strain, strain_label, "n_substep", "substeps since the start", False))
    return pages[:6]


def scaled(run, name):
    return (100 if name.startswith(("eps", "gamma")) else 1) * run[name]


def draw(results, output):
    pages = panels([run for _, run in results])
    figure, axes = plt.subplots(2, 3, figsize=(11.7, 7.4))
    for axis, (title, x, x_label, y, y_label, log) in zip(axes.flat, pages):
        for i, (facts, run) in enumerate(results):
            if x in run and y in run:
                axis.plot(scaled(run, x), scaled(run, y), color=COLOURS[i % 6], ls=LINES[i % 6],
                          lw=0.7 if run["cycle"].max() > 5 else 1.4, label=facts.get("case", ""))
                axis.plot(scaled(run, x)[0], scaled(run, y)[0], "o", color=COLOURS[i % 6], ms=4)
        axis.set_title(title)
        axis.set_xlabel(x_label)
        axis.set_ylabel(y_label)
        if log:
            axis.set_xscale("log")
            for which in (axis.xaxis.set_major_formatter, axis.xaxis.set_minor_formatter):
                which(matplotlib.ticker.LogFormatter(labelOnlyBase=False, minor_thresholds=(2, 0.6)))
    for axis in axes.flat[len(pages):]:
        axis.axis("off")
    facts = results[0][0]
    if len(results) > 1:
        axes.flat[0].legend()
        heading = "\n".join([", ".join(f.get("case", "") for f, _ in results), facts.get("material", "")])
    else:
        heading = "\n".join(filter(None, [facts.get("title") or facts.get("case"), facts.get("material")]))
    changed = [f"{k.split(': ')[-1]} = {v.split(' (')[0]}" for k, v in facts.items() if k.startswith("not the default")]
    ends = [f"{k}: {v}" for k, v in facts.items() if k.startswith("stage ") or k == "stopped"]
    figure.suptitle(heading, fontsize=11)
    figure.supxlabel("; ".join([facts.get("library", ""), *changed, *ends]), fontsize=8, color="#555555", wrap=True)
    figure.savefig(output)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("--output", type=pathlib.Path, help="default: the first file's name with .png")
    options = parser.parse_args()
    results = []
    for path in options.files:
        try:
            results.append(read_result(path))
        except (OSError, IndexError, KeyError, ValueError) as problem:
            sys.exit(f"plot_case: {path}: cannot be read as a result of mud_triax ({problem})")
    output = options.output or options.files[0].with_suffix(".png")
    draw(results, output)
    print(output)


if __name__ == "__main__":
    main()
