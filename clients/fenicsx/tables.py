# SPDX-License-Identifier: MIT
"""Writes the tables of README.md from results.json: tables.py [RESULTS], by default results.json of this folder."""
import json
import pathlib
import re
import sys

here = pathlib.Path(__file__).parent


def table(head, rows):
    lines = [head, ["---"]*len(head), *rows]
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in lines)


def agreement(runs):
    """The worst history of every comparison."""
    worst = {}
    for name, value in runs.items():
        if isinstance(value, float):
            what, _, column = name.rpartition(": ")
            if " " in column or not what:  # of all histories
                what, column = name, "all"
            worst[what] = max(worst.get(what, (0.0, "")), (value, column))
    return table(["comparison", "largest difference", "of"],
                 [[what, f"{value:.1e}", f"`{column}`" if "." in column else "the largest value"]
                  for what, (value, column) in worst.items()])


def iterations(runs):
    rows = [r for r in runs["scaling"] if r["ranks"] == 1]
    found = []
    for unknowns in sorted({r["unknowns"] for r in rows}):
        def of(mesh):
            return ", ".join(str(r["iterations"]) for r in sorted(rows, key=lambda r: r["seconds"])
                             if r["mesh"] == mesh and r["unknowns"] == unknowns)
        if of("even"):
            found.append([unknowns, of("even"), of("graded")])
    return table(["unknowns", "even mesh", "graded mesh"], found)


def scaling(runs):
    rows = [r for r in runs["scaling"] if r["mesh"] == "graded" and r["seconds"] == 1.0 and r["unknowns"] > 40000]
    parts = ("points", "assembly", "solver")
    head = ["unknowns", "points", "ranks", "GMRES iterations", *(f"{part} [s]" for part in parts), "together [s]",
            "MB a rank"]
    seconds = {(r["unknowns"], r["ranks"]): sum(r[part] for part in parts) for r in rows}
    small, large = min(seconds)[0], max(seconds)[0]
    told = (f"\n\nTwo ranks are {seconds[small, 1]/seconds[small, 2]:.1f} ({small}) and "
            f"{seconds[large, 1]/seconds[large, 2]:.1f} times ({large}) faster than one; {large/small:.1f} times the "
            f"unknowns on two ranks\ntake {seconds[large, 2]/seconds[small, 1]:.2f} times the seconds of one.")
    return table(head,
                 [[r["unknowns"], r["points_number"], r["ranks"], r["iterations"], *(r[part] for part in parts),
                   round(sum(r[part] for part in parts), 1), r["megabytes"]]
                  for r in sorted(rows, key=lambda r: (r["unknowns"], r["ranks"]))]) + told


runs = json.loads(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else here/"results.json").read_text())["runs"]
page = (here/"README.md").read_text()
for maker in (agreement, iterations, scaling):
    name = maker.__name__
    page = re.sub(rf"(<!-- made: {name} -->\n).*?(<!-- end -->)", lambda m: m[1] + maker(runs) + "\n" + m[2], page,
                  flags=re.S)
(here/"README.md").write_text(page)
