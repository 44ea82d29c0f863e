# SPDX-License-Identifier: MIT
"""Which effects a scene calls for, found by mud_study."""
import pathlib

import study

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="`mud_study effects` keeps what changes an answer, in scenes made so that a hurried user would leave it out, and "
          "leaves out what does not",
    kind=("study",),
    input="`scenes.py`: traps that hide an effect, and scenes that need few",
    reference="what is known of each scene: its traps were made on purpose",
    seconds=25, quick=4)
MAKES = (Script("study.py", ("results.csv",), 60), Script("cost.py", ("cost.csv",), 150))

NONE = Tolerance("every decision is known beforehand", absolute=0.0)
QUICK = ("clamped slab", "pulse")


def committed():
    return tables.rows(pathlib.Path(__file__).parent / "results.csv")


def check(bench):
    for scene in study.ALL:
        if bench.quick and scene.name not in QUICK:
            continue
        rows = study.rows_of(scene, bench.build, bench.folder())
        bench.below(f"{scene.name}: decisions that are wrong", sum(r[-1] not in ("", r[2]) for r in rows), NONE)
    return None


def texts(bench):
    rows, lines = committed(), []
    for scene in study.ALL:
        here = [r for r in rows if r["scene"] == scene.name]
        on = [r["effect"] for r in here if r["on"] == "on" and r["by"] == "pilot"]
        off = [r["effect"] for r in here if r["on"] == "off" and r["by"] == "pilot"]
        strongest = max((r for r in here if r["influence"]), key=lambda r: float(r["influence"]), default=None)
        most = f"{strongest['effect']}: {100*float(strongest['influence']):.2g} % of {strongest['answer']}" if strongest else ""
        lines.append((scene.name, scene.what, ", ".join(on), ", ".join(off), most))
    wrong = sum(r["wanted"] not in ("", r["on"]) for r in rows)
    known = sum(bool(r["wanted"]) for r in rows)
    cost = tables.rows(pathlib.Path(__file__).parent / "cost.csv")
    most = max(float(r["share"]) for r in cost)
    priced = tables.markdown(
        ("scene", "pilots", "their time [s]", "run quoted at [s]", "run [s]", "share", "left out"),
        [(r["scene"], r["pilots"], r["spent"], r["quoted"], r["run"], f"{100*float(r['share']):.2g} %",
          r["off"].replace(" ", ", ").replace("_", " ")) for r in cost])
    return {"README.md": {"cost": priced + f"\nThe largest share is {100*most:.2g} %.\n", "effects": tables.markdown(
        ("scene", "what misleads, or what is plain", "kept", "left out", "the strongest"), lines) + (
        f"\nOf {known} decisions that are known beforehand {wrong} are wrong.\n")}}
