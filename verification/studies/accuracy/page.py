# SPDX-License-Identifier: MIT
"""Errors that mud_study tells beside true ones."""
import os
import pathlib

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="the total error that `mud_study accuracy` tells of its worst answer lies between a third and five times the true "
          "one, and a study that ends as met has met what was asked",
    kind=("study",),
    input="scenes of the page cost and of `verification/studies/price` (`study.py`)",
    reference="a run with four times the cells of the final run (twice where that takes longer than the study may), a tenth "
              "of its step tolerance and of the tolerance of Newton's method",
    seconds=20, quick=4)
MAKES = (Script("study.py", ("results.csv",), 1400),)

WITHIN = Tolerance("between a third and five times the true error: a factor of four either way of 1.3", absolute=4.0)
QUICK, FULL = ("strip",), ("strip", "mandel")


def committed():
    return tables.rows(pathlib.Path(__file__).parent / "results.csv")


def check(bench):
    # Its package and the host of this build are looked for by name.
    os.environ["MUD_HOST"] = str(bench.program("host/mud_host"))
    os.environ["MUD_LIBRARY_DIR"] = str(bench.build)
    import study
    for name in QUICK if bench.quick else FULL:
        path = next(p for p in study.SCENES if p.stem == name)
        found = dict(zip(study.HEAD, study.row(path, 1e-2, 120.0, bench.folder())))
        bench.note(f"{name}: {found['state']}, told {found['told']}, true {found['true']}")
        bench.below(f"{name}: told over true", float(found["told_over_true"]) / 1.3, WITHIN)
        bench.below(f"{name}: true over told", 1.3 / float(found["told_over_true"]), WITHIN)
    return None


def texts(bench):
    rows = committed()
    known = [r for r in rows if r["told_over_true"]]
    within = sum(1 / 3 <= float(r["told_over_true"]) <= 5 for r in known)
    met = [r for r in rows if r["state"] == "met"]
    beyond = sum(bool(r["true"]) and float(r["true"]) > 2 * float(r["asked"]) for r in met)
    table = tables.markdown(
        ("scene", "asked", "state", "fineness", "step tolerance", "worst answer", "told", "true", "told over true", "s",
         "study over run"),
        [(r["scene"], r["asked"], r["state"], r["fineness"], r["step_tolerance"], r["answer"], r["told"], r["true"],
          r["told_over_true"], r["seconds"], r["study_over_run"]) for r in rows])
    return {"README.md": {"errors": table + (
        f"\n{len(met)} of {len(rows)} studies end as met. Of {len(known)} whose truth is known {within} lie between a third "
        f"and five times the true error; {beyond} that ended as met are beyond twice what was asked.\n")}}
