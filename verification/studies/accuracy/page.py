# SPDX-License-Identifier: MIT
"""Errors that mud_study tells beside true ones."""
import os
import pathlib

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="the total error that `mud_study accuracy` tells of its worst answer is no less than a third of the true one and "
          "seldom more than five times it, and a study that ends as met is not beyond twice what was asked",
    kind=("study", "exact"),
    input="42 scenes of `scenes.py`: texts of its own and files of this manual",
    reference="a closed form, else a run with two or four times the cells of the final run and less than a third of its step "
              "tolerance and of the other tolerances",
    seconds=20, quick=4)
MAKES = (Script("study.py", ("results.csv",), 3600, alone=True),)

WITHIN = Tolerance("between a third and five times the true error: a factor of four either way of 1.3", absolute=4.0)
QUICK, FULL = ("strip",), ("strip", "mandel", "sudden bar")
LEAST, MOST = 1/3, 5.0


def committed():
    return tables.rows(pathlib.Path(__file__).parent / "results.csv")


def check(bench):
    # Its package and the host of this build are looked for by name.
    os.environ["MUD_HOST"] = str(bench.program("host/mud_host"))
    os.environ["MUD_LIBRARY_DIR"] = str(bench.build)
    import scenes
    import study
    for scene in scenes.SCENES:
        if scene.name in (QUICK if bench.quick else FULL):
            found = dict(zip(study.HEAD, study.row(scene, 120.0, 120.0, bench.folder())))
            ratio = float(found["told"])/float(found["true"])
            bench.note(f"{scene.name}: {found['state']}, told {found['told']}, true {found['true']}")
            bench.below(f"{scene.name}: told over true", ratio/1.3, WITHIN)
            bench.below(f"{scene.name}: true over told", 1.3/ratio, WITHIN)
    return None


def ratio_of(row):
    return float(row["told"])/max(float(row["true"]), 1e-12)


def texts(bench):
    import scenes
    rows, what = committed(), {s.name: s.what for s in scenes.SCENES}
    known = [r for r in rows if r["true"]]
    met = [r for r in rows if r["state"] == "met"]
    inside = [r for r in known if LEAST <= ratio_of(r) <= MOST]
    small, large = ([r for r in known if below(ratio_of(r))] for below in (lambda x: x < LEAST, lambda x: x > MOST))
    beyond = [r for r in met if r["true"] and float(r["true"]) > 2*float(r["asked"])]
    long = [r for r in met if float(r["seconds"]) >= 2 and float(r["asked"]) <= 0.01]
    dear = [r for r in long if float(r["study_over_run"]) > 3]
    others = sorted({r["state"] for r in rows} - {"met"})
    per_cent = lambda x: f"{100*float(x):.2g}" if x else ""  # noqa: E731
    table = tables.markdown(
        ("scene", "what it is", "asked", "state", "F", "a", "worst answer", "told", "mesh", "steps", "Newton", "stress", "true",
         "known from", "told over true", "run [s]", "study over run"),
        [(r["scene"], what.get(r["scene"], ""), per_cent(r["asked"]), r["state"], r["fineness"], r["step_tolerance"], r["answer"],
          *(per_cent(r[x]) for x in ("told", "mesh", "steps", "newton", "stress", "true")), r["truth"],
          f"{ratio_of(r):.2g}" if r["true"] else "", r["seconds"], r["study_over_run"]) for r in rows])
    names = lambda rows: "" if not rows else " (" + "; ".join(r["scene"] for r in rows) + ")"  # noqa: E731
    end = [r for r in known if r["state"] == "met"]
    lines = [
        f"{len(met)} of {len(rows)} studies end as met" + "".join(
            f", {sum(r['state'] == x for r in rows)} as \"{x}\"{names([r for r in rows if r['state'] == x])}" for x in others) + ".",
        f"Of {len(known)} whose truth is known {len(inside)} tell between a third and five times the true error"
        f"{f' ({100*len(inside)/len(known):.0f} %)' if known else ''}; "
        f"{len(small)} less than a third{names(small)}, {len(large)} more than five times{names(large)}.",
        f"Of the {len(end)} of them that end as met {sum(r in inside for r in end)} are between a third and five times.",
        f"Of those that end as met {len(beyond)} are beyond twice what was asked{names(beyond)}.",
        f"Of {len(long)} studies of 1 % whose final run takes two seconds or more {len(dear)} cost more than three times that run"
        f"{names(dear)}."]
    return {"README.md": {"errors": table, "counts": "\n".join(f"- {line}" for line in lines) + "\n"}}
