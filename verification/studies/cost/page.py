# SPDX-License-Identifier: MIT
"""Accuracy and its cost: is an estimated error the true one, and what does an error cost in the indentation?"""
import pathlib

import honest
import study

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="a run with controlled steps estimates its true error within a factor of five and meets the accuracy that "
          "was set within a factor of two, with the exceptions that are listed; what an error costs in the indentation",
    kind=("study", "exact"),
    input="twenty-six scenes and four paths of the driver (`honest.py`); the indentation at a suction of 30 "
          "kPa, one contributor at a time on a coarse mesh (`study.py`)",
    reference="a closed form (vibration), else given fine steps on the same mesh",
    seconds=10, quick=6, pictures=("price.png",))
MAKES = (Script("honest.py", ("honest.csv",), 240), Script("given.py", ("given.csv",), 40),
         Script("study.py", ("price.csv",), 90))

LEAST, MOST = 0.2, 5.0
BAND = Tolerance("true over estimated error: what the manual promises", absolute=MOST)
OTHER = Tolerance("estimated over true error, likewise", absolute=1/LEAST)
ASKED = Tolerance("true error over the accuracy: what the manual promises", absolute=2.0)
MEASURED_HERE = ("vibration", "Mandel")
PRESETS = {"accuracy 1e-1": "fast", "accuracy 3e-2": "", "accuracy 1e-2": "balanced (the default)",
           "accuracy 1e-3": "accurate"}
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
            if honest.is_force(row[3]):   # Where equilibrium gives a force its error is far below that of the motion.
                continue
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
    known = [r for r in rows if r["ratio"] and not honest.is_force(r["answer"])]
    forces = [r for r in rows if r["ratio"] and honest.is_force(r["answer"])]
    met = [r for r in known if not minor(r, rows)]
    twice = [r for r in met if float(r["true_error"]) > 2*float(r["accuracy"])]

    def counts(what, those):
        ratios = [float(r["ratio"]) for r in those]
        return what, len(ratios), sum(LEAST <= x <= MOST for x in ratios), sum(x > MOST for x in ratios), sum(x < LEAST for x in ratios)

    return "\n".join((
        tables.markdown(("scene", "accuracy", "steps", "answer", "true error", "estimated", "true/estimated",
                         "in the band"), lines),
        tables.markdown(("answers", "number", "in the band", "true error above five estimates", "estimated too large"),
                        (counts("displacements and pressures", known), counts("forces of supports and thrusts", forces))),
        f"Of {len(met)} displacements and pressures that change by more than 5 % of the largest change of their field "
        f"{len(twice)} have an error of more than twice the accuracy that was set:\n",
        tables.markdown(("scene", "accuracy", "answer", "true error"),
                        [(r["scene"], r["accuracy"], r["answer"], r["true_error"]) for r in twice])))


def scenes_text():
    """Scene by scene: how many answers lie in the band, and what is aimed at: all of them in ten scenes."""
    lines, whole = [], []
    rows = [r for r in of_table("honest.csv") if r["ratio"] and not honest.is_force(r["answer"])]
    names = list(dict.fromkeys(r["scene"] for r in of_table("honest.csv")))
    for name in names:
        ratios = [float(r["ratio"]) for r in rows if r["scene"] == name]
        inside = sum(LEAST <= x <= MOST for x in ratios)
        failed = [r for r in of_table("honest.csv") if r["scene"] == name and not r["ratio"]]
        if inside == len(ratios) and not failed:
            whole.append(name)
        lines.append((name, ", ".join(dict.fromkeys(r["accuracy"] for r in rows if r["scene"] == name)),
                      f"{inside} of {len(ratios)}", f"{min(ratios):.2g} to {max(ratios):.2g}",
                      "yes" if name in whole else "**no**"))
    return (f"The aim is a true error of 0.2 to 5 times the estimate on at least ten scenes. In {len(whole)} of "
            f"{len(names)} scenes it holds for every displacement and pressure at every accuracy that was run:\n\n" +
            tables.markdown(("scene", "accuracies", "answers in the band", "true/estimated", "all of them"), lines))


def given_text():
    """Estimated and true errors of given steps."""
    rows = of_table("given.csv")
    known = [r for r in rows if r["ratio"] and not honest.is_force(r["answer"])]
    within = [r for r in known if LEAST <= float(r["ratio"]) <= MOST]
    above = [float(r["true_error"]) for r in known if float(r["ratio"]) > MOST]
    said = f"\n{len(within)} of {len(known)} displacements and pressures lie in the band. "
    if above:
        said += (f"{len(above)} have an error of more than five times the estimate, and the largest of these errors is "
                 f"{max(above):.2g}. ")
    names = ("scene", "steps that are given", "number", "answer", "true error", "estimated", "true/estimated",
             "in the band")
    return tables.markdown(names, [
        (r["scene"], r["steps_given"], r["steps"], r["answer"], r["true_error"], r["estimated_error"], r["ratio"],
         "yes" if r["ratio"] and LEAST <= float(r["ratio"]) <= MOST else "**no**") for r in rows]) + (
             said + "The others outside are estimated too large.\n")


def worst(row):
    """Largest of the errors of the answers: peak, p_w and history."""
    return max(float(row[name] or 0) for name in ("peak", "p_w", "history"))


def price_rows(suction, mesh):
    """Rows of a table with errors; the first reference is that of the errors."""
    return [r for r in of_table("price.csv") if (r["suction"], r["mesh"]) == (str(suction), mesh) and r["peak"]
            and (r["contributor"], r["setting"]) != study.OF_ALL]


def fine_row(suction, mesh):
    """The reference of a part of the table."""
    return next(r for r in of_table("price.csv") if (r["suction"], r["mesh"]) == (str(suction), mesh)
                and (r["contributor"], r["setting"]) == study.OF_ALL)


def on_front(row):
    """Whether nothing in its part of the table that is settings alone has less of both error and time."""
    beside = [r for r in price_rows(row["suction"], row["mesh"]) if r["contributor"] != "reference"]
    return row["contributor"] != "reference" and not any(
        float(r["seconds"]) < float(row["seconds"]) and worst(r) <= worst(row) for r in beside)


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
        r = fine_row(suction, mesh)
        parts.append(f"Suction {suction} kPa, {mesh} mesh; reference: peak {r['peak']} mm at {r['peak_time']} ms, p_w "
                     f"{r['p_w']} kPa ({r['seconds']} s)\n\n" + tables.markdown(
                         ("contributor", "setting", "steps", "iterations", "rates [1e6]", "factorisations", "CPU [s]",
                          "of the paper's", "error of the peak", "of its time", "of p_w", "of the history", "front"),
                         [(r["contributor"], r["setting"], r["steps"], r["iterations"], f"{float(r['rates'])/1e6:.2f}",
                           r["factorisations"], r["seconds"], share(r), r["peak"], r["peak_time"], r["p_w"],
                           r["history"], "yes" if on_front(r) else "") for r in price_rows(suction, mesh)]))
    return "\n".join(parts)


def presets_text():
    lines = []
    for suction, mesh in parts_of_price():
        for r in price_rows(suction, mesh):
            if PRESETS.get(r["setting"]):
                key = r["setting"].replace("accuracy ", "`accuracy = ") + "`"
                lines.append((PRESETS[r["setting"]], key, suction, mesh, r["steps"], r["peak"], r["p_w"], r["history"],
                              r["seconds"], share(r)))
    return tables.markdown(("preset", "key", "suction [kPa]", "mesh", "steps", "error of the peak", "of p_w",
                            "of the history", "CPU [s]", "of the paper's settings"), lines)


def texts(bench):
    return {"README.md": {"scenes": scenes_text(), "honest": honest_text(), "given": given_text(),
                          "price": price_text(), "presets": presets_text()}}


def draw(bench, results, plt):
    from tools.pictures import COLOURS as colours
    shown = {"step": ("o-", 0, "step alone"), "together": ("s-", 1, "step and stress tolerance"),
             "accuracy": ("D-", 2, "accuracy asked for"), "paper": ("*", 3, "the paper's settings"),
             "stress": ("v", 4, "stress tolerance alone"), "newton": ("x", 0, "Newton's tolerance alone"),
             "linear": ("1", 1, "fresh factors"), "quadrature": ("P", 3, "3 points"),
             "pressures": ("h", 4, "linear pressures")}
    there = parts_of_price()
    figure, axes = plt.subplots(1, len(there), figsize=(10, 4.2), sharey=True, squeeze=False)
    for axis, (suction, mesh) in zip(axes.flat, there):
        for kind, (style, colour, label) in shown.items():
            points = sorted((float(r["seconds"]), 100*worst(r)) for r in price_rows(suction, mesh)
                            if r["contributor"] == kind and (kind == "paper" or "rho_inf 0.8" not in r["setting"]))
            if points:
                axis.loglog(*zip(*points), style, color=colours[colour], label=label,
                            markersize=9 if style == "*" else 5)
        axis.set_title(f"{suction} kPa, {mesh} mesh", fontsize=9)
        axis.set_xlabel("CPU time [s]")
        axis.set_xticks([1, 2, 4, 8, 16, 32], ["1", "2", "4", "8", "16", "32"], minor=False)
        axis.set_xticks([], minor=True)
    for axis in axes[:, 0]:
        axis.set_ylabel("largest error of the answers [%]")
    # Of the part with most kinds of points, beside the axes so that it hides none.
    most = max(axes.flat, key=lambda a: len(a.get_legend_handles_labels()[0]))
    figure.legend(*most.get_legend_handles_labels(), fontsize=7.5, loc="outside lower center", ncols=5)
    bench.save(figure, "price.png")
