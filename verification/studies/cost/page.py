# SPDX-License-Identifier: MIT
"""Accuracy and its cost: is an estimated error the true one, and what does an error cost in the indentation?"""
import pathlib

import honest
import numpy as np
import study

from tools import tables
from tools.page import Page, Tolerance

PAGE = Page(
    claim="a run with controlled steps estimates its true error within a factor of five and meets the accuracy that was "
          "set within a factor of two, with the exceptions that are listed; what an error costs in the indentation",
    kind=("study", "exact"),
    input="sixteen scenes and four paths of the driver (`honest.py`); the indentation at suctions of 0, 30 and 1000 "
          "kPa, one contributor at a time on a coarse mesh, a user's choices on that of the benchmark (`study.py`)",
    reference="a closed form (vibration), else given fine steps on the same mesh",
    seconds=10, quick=6, pictures=("price.png",))

LEAST, MOST = 0.2, 5.0
BAND = Tolerance("true over estimated error: what the manual promises", absolute=MOST)
OTHER = Tolerance("estimated over true error, likewise", absolute=1/LEAST)
ASKED = Tolerance("true error over the accuracy: what the manual promises", absolute=2.0)
MEASURED_HERE = ("vibration", "Mandel")
MESHES = {"full": "mesh of the benchmark", "coarse": "coarse mesh"}
SMALL_CHANGE = 0.05   # of the largest change of the field among the named points


def check(bench):
    honest.build = pathlib.Path(bench.build)
    for name in MEASURED_HERE:
        rows = honest.scene_rows(name, ("1e-2",), bench.output / "runs")
        if any("failed" in r[3] for r in rows):
            raise RuntimeError(str(rows))
        for row in rows:
            true, estimate = float(row[5]), float(row[6])
            bench.below(f"{name}, {row[3]}: true over estimated", true/estimate, BAND)
            bench.below(f"{name}, {row[3]}: estimated over true", estimate/true, OTHER)
            bench.below(f"{name}, {row[3]}: true over asked", true/1e-2, ASKED)
    return None


def of_table(path):
    return tables.rows(pathlib.Path(__file__).parent / path)


def minor(row, rows):
    """Whether an answer hardly changes beside another of its field in the same run."""
    field = row["answer"].split(".")[-1][0]
    beside = [float(r["change"]) for r in rows if r["scene"] == row["scene"] and r["accuracy"] == row["accuracy"]
              and r["change"] and r["answer"].split(".")[-1][0] == field]
    return float(row["change"]) < SMALL_CHANGE*max(beside)


def honest_text():
    rows = of_table("honest.csv")
    lines = []
    for r in rows:
        if not r["ratio"]:
            lines.append((r["scene"], r["accuracy"], r["steps"], r["answer"], "", "", "", ""))
            continue
        inside = LEAST <= float(r["ratio"]) <= MOST
        name = r["answer"] + (" (hardly changes)" if minor(r, rows) else "")
        lines.append((r["scene"], r["accuracy"], r["steps"], name, r["true_error"], r["estimated_error"], r["ratio"],
                      "yes" if inside else "**no**"))
    known = [r for r in rows if r["ratio"]]
    within = sum(LEAST <= float(r["ratio"]) <= MOST for r in known)
    above = [r for r in known if float(r["ratio"]) > MOST]
    met = [r for r in known if not minor(r, rows)]
    twice = [r for r in met if float(r["true_error"]) > 2*float(r["accuracy"])]
    return tables.markdown(("scene", "accuracy", "steps", "answer", "true error", "estimated", "true/estimated",
                            "in the band"), lines) + (
        f"\n{within} of {len(known)} answers lie in the band; {len(above)} have an error of more than five times the "
        f"estimate, the others outside are estimated too large. Of {len(met)} answers that change by more than 5 % of "
        f"the largest change of their field {len(twice)} have an error of more than twice the accuracy that was set"
        + "".join(f"; {r['scene']} {r['accuracy']} {r['answer']} ({r['true_error']})" for r in twice) + ".\n")


def worst(row):
    """Largest of the errors of peak and history."""
    return max(float(row["peak"]), float(row["history"] or 0))


def price_rows(suction, mesh):
    """Rows of a table with errors; the first reference is that of the errors."""
    return [r for r in of_table("price.csv") if (r["suction"], r["mesh"]) == (str(suction), mesh) and r["peak"]
            and (r["contributor"], r["setting"]) != ("reference", "rho_inf 0")]


def share(row):
    """Of the time of the paper's settings, where these were run."""
    paper = [r for r in price_rows(row["suction"], row["mesh"]) if r["contributor"] == "paper"]
    return f"{float(row['seconds'])/float(paper[0]['seconds']):.2f}" if paper else ""


def parts_of_price():
    """Suction and mesh of every part of the table."""
    return list(dict.fromkeys((int(r["suction"]), r["mesh"]) for r in of_table("price.csv")))


def price_text():
    parts = []
    for suction, mesh in parts_of_price():
        first = next(r for r in of_table("price.csv") if (r["suction"], r["mesh"]) == (str(suction), mesh)
                     and r["contributor"] == "reference")
        parts.append(f"Suction {suction} kPa, {MESHES[mesh]}; reference: peak {first['peak']} mm at "
                     f"{first['peak_time']} ms, p_w {first['p_w']} kPa ({first['seconds']} s)\n\n" + tables.markdown(
                         ("contributor", "setting", "steps", "iterations", "rates [1e6]", "factorisations", "CPU [s]",
                          "of the paper's", "error of the peak", "of its time", "of p_w", "of the history"),
                         [(r["contributor"], r["setting"], r["steps"], r["iterations"], f"{float(r['rates'])/1e6:.2f}",
                           r["factorisations"], r["seconds"], share(r), r["peak"], r["peak_time"], r["p_w"],
                           r["history"]) for r in price_rows(suction, mesh)]))
    return "\n".join(parts)


def presets_text():
    names = {"accuracy 1e-1": "fast", "accuracy 1e-2": "balanced (the default)", "accuracy 1e-3": "accurate"}
    lines = []
    for suction, mesh in parts_of_price():
        for r in price_rows(suction, mesh):
            if r["contributor"] == "accuracy":
                key = r["setting"].replace("accuracy ", "`accuracy = ") + "`"
                lines.append((names[r["setting"]], key, suction, mesh, r["steps"], r["peak"], r["p_w"], r["history"],
                              r["seconds"], share(r)))
    return tables.markdown(("preset", "key", "suction [kPa]", "mesh", "steps", "error of the peak", "of p_w",
                            "of the history", "CPU [s]", "of the paper's settings"), lines)


def texts(bench):
    return {"README.md": {"honest": honest_text(), "price": price_text(), "presets": presets_text()}}


def draw(bench, results, plt):
    from tools.pictures import COLOURS
    shown = {"step": ("o-", 0, "step alone"), "together": ("s-", 1, "step and stress tolerance"),
             "accuracy": ("D-", 2, "accuracy asked for"), "paper": ("*", 3, "the paper's settings"),
             "stress": ("v", 4, "stress tolerance alone"), "quadrature": ("P", 3, "3 points")}
    there = parts_of_price()
    figure, axes = plt.subplots(1, len(there), figsize=(3.4*len(there) + 1, 3.2), sharey=True)
    for axis, (suction, mesh) in zip(axes if len(there) > 1 else [axes], there):
        for kind, (style, colour, label) in shown.items():
            points = sorted((float(r["seconds"]), 100*worst(r)) for r in price_rows(suction, mesh)
                            if r["contributor"] == kind and (kind == "paper" or "rho_inf 0.8" not in r["setting"]))
            if points:
                axis.loglog(*zip(*points), style, color=COLOURS[colour], label=label,
                            markersize=9 if style == "*" else 5)
        axis.set_title(f"{suction} kPa, {MESHES[mesh]}", fontsize=9)
        axis.set_xlabel("CPU time [s]")
        axis.set_xticks([1, 2, 4, 8, 16, 32], ["1", "2", "4", "8", "16", "32"], minor=False)
        axis.set_xticks([], minor=True)
    first = axes[0] if len(there) > 1 else axes
    first.set_ylabel("error of peak and history [%]")
    # Of the part with most kinds of points.
    most = max(np.atleast_1d(axes), key=lambda a: len(a.get_legend_handles_labels()[0]))
    first.legend(*most.get_legend_handles_labels(), fontsize=6.5)
    bench.save(figure, "price.png")
