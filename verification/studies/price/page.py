# SPDX-License-Identifier: MIT
"""What --price estimates, against runs on finer meshes."""
import math
import pathlib
import textwrap

import study

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="no error of the mesh that `--price` estimates is less than a third of that against a mesh four times as fine; "
          "quoted times are within a factor of two",
    kind=("study",),
    input="`study.py`: nine scenes of the verification: consolidation, waves, drainage, rain, contacts",
    reference="the same scenes on meshes of twice and four times their cells, with the same steps",
    seconds=8, quick=8)
MAKES = (Script("study.py", ("results.csv", "times.csv"), 200),)

FACTOR = Tolerance("a factor of three", absolute=math.log10(3.0))
MADE = Tolerance("a count of the table: what is too small beyond a factor of three", absolute=0.0)


def committed(name):
    return tables.rows(pathlib.Path(__file__).parent / name)


def check(bench):
    rows, _ = study.compare(bench.program("host/mud_host"), "terzaghi/scene", bench.folder())
    for _, answer, _, state, _, _, ratio in rows:
        if state == "ok":
            bench.near(f"Terzaghi, {answer}: logarithm of the estimated over the true error of the mesh",
                       math.log10(float(ratio)), 0.0, FACTOR)
    bench.near("estimates of the table that are too small by more than three",
               sum(float(r["ratio"]) < 1/3 for r in committed("results.csv")), 0, MADE)
    return None


def texts(bench):
    answers, times = committed("results.csv"), committed("times.csv")
    inside = sum(1/3 < float(r["ratio"]) < 3 for r in answers)
    low = sum(float(r["ratio"]) < 1/3 for r in answers)
    near = sum(0.5 < float(r["ratio"]) < 2 for r in times)
    counts = (f"Of {len(answers)} estimates {inside} are within a factor of three, {low} too small by more, "
              f"{len(answers) - inside - low} too large by more. Of {len(times)} times {near} are within a factor of two.")
    return {"README.md": {
        "answers": tables.markdown(("scene", "answer", "fineness", "state", "estimated", "true", "ratio"),
                                   [tuple(r[n] for n in study.ANSWERS) for r in answers]),
        "times": tables.markdown(("scene", "fineness", "quoted [s]", "taken [s]", "ratio"),
                                 [tuple(r[n] for n in study.TIMES) for r in times]),
        "counts": textwrap.fill(counts, 118)}}
