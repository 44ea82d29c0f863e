# SPDX-License-Identifier: MIT
"""One page for a result of mud_triax: plot_case.py FILE [FILE ...] [--output PICTURE]

Several files are drawn over each other. The panels follow from what the test did: paths of stress and strain always,
pore pressure where it builds up, suction and saturation where suction moves, cycles where there are any.
"""
import argparse
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path += [str(ROOT / "common"), str(ROOT / "python/mud")]
sys.dont_write_bytecode = True
import tables  # noqa: E402 (its folder is known only now)
import plots  # noqa: E402 (of the package, alone: a page needs no library)


def read_result(path):
    """(facts, columns) of a result file."""
    facts = {}
    for line in tables.comments(path):
        name, _, text = line.rpartition(": ") if line.startswith("not") else line.partition(": ")
        facts[name] = text
    return facts, tables.columns(path)


@plots.style()
def draw(results, output):
    plt = plots.pyplot()
    labels = [facts.get("case", f"result {i}") for i, (facts, _) in enumerate(results, 1)]
    labels = [f"{label} ({i})" if labels.count(label) > 1 else label for i, label in enumerate(labels, 1)]
    runs = dict(zip(labels, (run for _, run in results)))
    units = [re.search(r"effective \[(\w+)\]|$", facts.get("conventions", ""))[1] or "kPa" for facts, _ in results]
    if len(set(units)) > 1:
        told = ", ".join(f"{label} in {unit}" for label, unit in zip(labels, units))
        sys.exit(f"plot_case: the stresses have different units: {told}; draw those of one unit together")
    figure = plots.draw(plt, runs, plots.panels(list(runs.values()))[:6], units[0])
    facts = results[0][0]
    title = ", ".join(labels) if len(results) > 1 else facts.get("title") or facts.get("case")
    if len(results) > 1:
        plots.key(plt, figure, labels)
    changed = [f"{k.split(': ')[-1]} = {v.split(' (')[0]}" for k, v in facts.items() if k.startswith("not the default")]
    ends = [f"{k}: {v}" for k, v in facts.items() if k.startswith("stage ") or k == "stopped"]
    figure.suptitle("\n".join(filter(None, [title, facts.get("material")])), fontsize=11)
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
