# SPDX-License-Identifier: MIT
"""What accuracy costs, scene by scene."""
import pathlib

import study

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="`mud_study price` names the run that holds 10, 3 and 1 % and what it takes; a smaller error never has the coarser run",
    kind=("study",),
    input="six scenes of this manual (`study.py`)",
    reference="errors measured by pairs of runs; how far those are true: [accuracy](../accuracy/README.md)",
    seconds=10, quick=3)
MAKES = (Script("study.py", ("results.csv", "price.png"), 200),)

NONE = Tolerance("the table says it of itself", absolute=0.0)


def committed():
    return tables.rows(pathlib.Path(__file__).parent / "results.csv")


def check(bench):
    for name in ("strip",) if bench.quick else ("strip", "mandel"):
        rows = [dict(zip(study.HEAD, row)) for row in study.rows_of(name, bench.build, bench.folder(), 60)]
        above = sum(r["state"] == "met" and float(r["total"]) > float(r["accuracy"]) for r in rows)
        bench.below(f"{name}: runs whose total is above what they are named for", above, NONE)
        met = [r for r in rows if r["state"] == "met"]
        coarser = sum(float(b["fineness"]) < float(a["fineness"]) and float(b["step_tolerance"]) >= float(a["step_tolerance"])
                      for a, b in zip(met, met[1:]))
        bench.below(f"{name}: smaller errors by coarser runs", coarser, NONE)
    return None


def texts(bench):
    lines = []
    for name in study.SCENES:
        cells = []
        for r in (r for r in committed() if r["scene"] == name):
            how, none = "" if r["state"] == "met" else "about ", "no run is known"
            if r["state"] == "localised":
                none = "shear localises"
            cells.append(f"{how}{float(r['seconds']):.2g} s (F {float(r['fineness']):g}, a {float(r['step_tolerance']):.2g}: "
                         f"{100*float(r['total']):.2g} %)" if r["seconds"] else none)
        lines.append((name, *cells))
    return {"README.md": {"price": tables.markdown(("scene", "10 %", "3 %", "1 %"), lines)}}
