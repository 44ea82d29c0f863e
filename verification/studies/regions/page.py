# SPDX-License-Identifier: MIT
"""The indentation with an outer half that has fewer unknowns and less state: what it costs, saves and changes."""
import pathlib

import study

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="an outer half of the indentation's mesh that is drained, or elastic and drained, has fewer unknowns, smaller "
          "matrices and less state; how that changes the results",
    kind=("study", "regression"),
    input="`scene.nml`, the paper's indentation at suction 30 kPa on a mesh of two halves, with five outer halves (`study.py`)",
    reference="the outer half of sand with water and air that flow; for the regression `results.csv`",
    seconds=40, quick=0)
MAKES = (Script("study.py", ("results.csv",), 20),)

COUNT = Tolerance("a count")
SAME = Tolerance("rounding of another machine, and its growth within Newton's tolerance of 1e-3 in 168 steps", relative=1e-3)
CHECKED = ("sand, coupled", "elastic, drained")
EXACT = ("unknowns", "state of the points [MB]", "matrices of the elements [MB]")
ANSWERS = ("largest indentation [mm]", "last indentation [mm]", "largest rise of p_w [kPa]")


def committed():
    return {row["outer half"]: row for row in tables.rows(pathlib.Path(__file__).parent / "results.csv")}


def check(bench):
    rows = committed()
    for case in CHECKED:
        row = dict(zip(study.COLUMNS, study.run(bench.build, case)))
        for name in EXACT:
            bench.near(f"{case}: {name}", float(row[name]), float(rows[case][name]), COUNT)
        for name in ANSWERS:
            bench.near(f"{case}: {name}", float(row[name]), float(rows[case][name]), SAME)
    return None


def shown(row, whole, name):
    """A number, and by how much it differs from that of the whole."""
    if row is whole:
        return row[name]
    return f"{row[name]} ({100*(float(row[name])/float(whole[name]) - 1):+.2g} %)"


def texts(bench):
    rows = committed()
    whole = rows["sand, coupled"]
    return {"README.md": {"halves": tables.markdown(study.COLUMNS, [
        (case, *(shown(row, whole, name) for name in study.COLUMNS[1:])) for case, row in rows.items()])}}
