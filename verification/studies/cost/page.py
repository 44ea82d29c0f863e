# SPDX-License-Identifier: MIT
"""Steps and their cost: what do the steps of a tolerance leave, and what does an error cost in the indentation?"""
import pathlib

import study
import tolerances

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="a tenth of `step_tolerance` leaves about a tenth of the error of the steps, in flows less than the tolerance "
          "itself; what lasts, as a vibration, gathers more; what an error costs in the indentation",
    kind=("study", "exact"),
    input="twenty-six scenes (`tolerances.py`), four paths of the driver (`driver.py`); the indentation at a suction of "
          "30 kPa, one contributor at a time on a coarse mesh (`study.py`)",
    reference="a closed form (vibration), else given fine steps on the same mesh",
    seconds=10, quick=6, pictures=("price.png",))
MAKES = (Script("tolerances.py", ("tolerances.csv",), 240), Script("driver.py", ("driver.csv",), 10),
         Script("study.py", ("price.csv",), 90))

COMMITTED = Tolerance("the table of this page, and a fifth", absolute=1.2)
FALLS = Tolerance("in proportion to the tolerance, within a factor of two", absolute=0.2)
MEASURED_HERE = ("vibration", "Mandel")


def check(bench):
    tolerances.build = pathlib.Path(bench.build)
    for name in MEASURED_HERE:
        rows = tolerances.scene_rows(name, ("1e-2", "1e-3"), bench.output / "runs")
        if any("failed" in r[3] for r in rows):
            raise RuntimeError(str(rows))
        worst_of = {t: max(float(r[5]) for r in rows if r[1] == t) for t in ("1e-2", "1e-3")}
        then = max(float(r["error"]) for r in of_table("tolerances.csv") if (r["scene"], r["tolerance"]) == (name, "1e-2"))
        bench.below(f"{name}: error at 1e-2 over that of the table", worst_of["1e-2"]/then, COMMITTED)
        bench.below(f"{name}: error at 1e-3 over that at 1e-2", worst_of["1e-3"]/worst_of["1e-2"], FALLS)
    return None


def of_table(path):
    return tables.rows(pathlib.Path(__file__).parent / path)


def tolerances_text():
    """The worst answer of every scene at every tolerance."""
    rows = of_table("tolerances.csv")
    lines, ratios = [], []
    for name, tolerance in dict.fromkeys((r["scene"], r["tolerance"]) for r in rows):
        here = [r for r in rows if (r["scene"], r["tolerance"]) == (name, tolerance)]
        if not here[0]["error"]:
            lines.append((name, tolerance, here[0]["steps"], here[0]["answer"], "", ""))
            continue
        one = max(here, key=lambda r: float(r["error"]))
        ratios.append(float(one["error"])/float(tolerance))
        lines.append((name, tolerance, one["steps"], one["answer"], one["error"], f"{ratios[-1]:.2g}"))
    below = sum(r <= 1 for r in ratios)
    return tables.markdown(("scene", "tolerance", "steps", "worst answer", "error", "over the tolerance"), lines) + (
        f"\nIn {below} of {len(ratios)} runs the worst error is below the tolerance; the largest is {max(ratios):.2g} times "
        "the tolerance.\n")


def driver_text():
    """Measured and true errors of the driver's answers."""
    rows = of_table("driver.csv")
    within = sum(0.2 <= float(r["ratio"]) <= 5 for r in rows)
    return tables.markdown(("path", "accuracy", "increments", "answer", "true error", "measured", "true/measured"), [
        (r["path"], r["accuracy"], r["increments"], r["answer"], r["true_error"], r["measured_error"], r["ratio"])
        for r in rows]) + f"\n{within} of {len(rows)} lie within 0.2 and 5; errors below 1e-8 are rounding.\n"


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


def texts(bench):
    return {"README.md": {"tolerances": tolerances_text(), "driver": driver_text(), "price": price_text()}}


def draw(bench, results, plt):
    from tools.pictures import COLOURS as colours
    shown = {"step": ("o-", 0, "step alone"), "together": ("s-", 1, "step and stress tolerance"),
             "tolerance": ("D-", 2, "step_tolerance"), "paper": ("*", 3, "the paper's settings"),
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
        low, high = axis.get_xlim()
        ticks = [2.0**i for i in range(-6, 8) if low <= 2.0**i <= high]
        axis.set_xticks(ticks, [f"{tick:g}" for tick in ticks], minor=False)
        axis.set_xticks([], minor=True)
    for axis in axes[:, 0]:
        axis.set_ylabel("largest error of the answers [%]")
    # Of the part with most kinds of points, beside the axes so that it hides none.
    most = max(axes.flat, key=lambda a: len(a.get_legend_handles_labels()[0]))
    figure.legend(*most.get_legend_handles_labels(), fontsize=7.5, loc="outside lower center", ncols=5)
    bench.save(figure, "price.png")
