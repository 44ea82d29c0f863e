# SPDX-License-Identifier: MIT
"""What `effects = 'auto'` with its defaults decides in ten scenes of 20 to 2000 elements, and what it costs."""
import pathlib

import study

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="with its defaults `effects = 'auto'` decides ten scenes of 20 to 2000 elements rightly, and costs at most 1.1 times the "
          "run that a user would have written and ten seconds",
    kind=("robustness", "study"),
    input="`study.py`: ten scenes that leave open fields, gravity or inertia",
    reference="the choice that the physics of each scene asks for, and the run with the same choice by hand",
    seconds=30, quick=8)
MAKES = (Script("study.py", ("results.csv",), 40),)

COUNT = Tolerance("a count")
SAME = Tolerance("a scene with its effects chosen is the scene with the same keys by hand", absolute=0.0)
BOUND = Tolerance("1.1 times the run by hand and ten seconds, of which the table has the times", absolute=1.0)
QUICK = ("pulse on a column", "column shaken at its base")


def committed():
    return tables.rows(pathlib.Path(__file__).parent / "results.csv")


def check(bench):
    # Decisions are made again; times belong to the machine that made the table.
    for scene in study.scenes():
        if scene.name in QUICK or not bench.quick and scene.name in ("slow footing, dry", "footing, saturated"):
            row = dict(zip(study.COLUMNS, study.compare(bench.program("host/mud_host"), scene)))
            bench.near(f"{scene.name}: decided rightly", float(row["right"] == "yes"), 1.0, COUNT)
            bench.below(f"{scene.name}: apart from the run by hand", float(row["differs by"]), SAME)
    for row in committed():
        bench.near(f"{row['scene']}: decided rightly, committed", float(row["right"] == "yes"), 1.0, COUNT)
        bench.below(f"{row['scene']}: time over its bound", float(row["auto [s]"]) / float(row["bound [s]"]), BOUND)
    return None


def texts(bench):
    rows = committed()
    return {"README.md": {"scenes": tables.markdown(tuple(rows[0]), [tuple(row.values()) for row in rows])}}
