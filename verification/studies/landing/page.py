# SPDX-License-Identifier: MIT
"""Bodies that fall on soil: a step ends where the contact closes; speed, thrust and settlement against fine steps."""
import math
import pathlib
import textwrap

import numpy as np

import study

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="where bodies fall on soil the first landing has the speed of free fall, since a step ends where the contact closes; "
          "peak thrust and settlement come to those of fine steps as the tolerance falls",
    kind=("exact", "study"),
    input="`study.py`: plates and deformable blocks, 2 mm to 20 cm above elastic soil and MUD, tolerances 1e-1, 1e-2 and 1e-3",
    reference="free fall; given steps of 4e-6 s on elastic soil, 2e-5 s on MUD, on the same mesh",
    seconds=20, quick=4, pictures=("landing.png",))
MAKES = (Script("study.py", ("results.csv", "picture.csv"), 560),)

ASKED = Tolerance("the largest error of these answers at 1e-3 in the table is 0.023", absolute=0.03)
LANDS = Tolerance("the step that closes the contact ends where it closes", absolute=0.002)
QUICK = ("block on MUD, 2 mm",)
FULL = QUICK + ("plate on elastic soil, 2 mm", "block on elastic soil, 2 mm")


def committed():
    return tables.rows(pathlib.Path(__file__).parent / "results.csv")


def is_first(row):
    """Whether an answer belongs to the first landing, or is the settlement."""
    return row["answer"] in ("speed 1", "thrust 1", "settlement")


def check(bench):
    rows = committed()
    for scene in study.scenes():
        if scene.name not in (QUICK if bench.quick else FULL):
            continue
        folder = bench.folder()
        study.run(bench.program("host/mud_host"), scene, folder, "", "--step-tolerance", "1e-3", "--quiet")
        found = study.answers(scene, folder)
        bench.near(f"{scene.name}: speed of the first landing over that of free fall",
                   found["speed 1"]/math.sqrt(2*study.GRAVITY*scene.height), 1.0, LANDS)
        for answer in ("thrust 1", "settlement"):
            fine = float(next(r["reference"] for r in rows if r["scene"] == scene.name and r["answer"] == answer))
            bench.near(f"{scene.name}: {answer} over that of fine steps", found[answer]/fine, 1.0, ASKED)
    return None


def draw(bench, results, plt):
    rows = committed()
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    lines = tables.rows(pathlib.Path(__file__).parent / "picture.csv")
    for name, look in (("fine", "k-"), (study.TOLERANCES[0], "r--")):
        some = [r for r in lines if r["run"] == name]
        left.plot([float(r["time"]) for r in some], [float(r["thrust"]) for r in some], look, lw=0.8,
                  label="given fine steps" if name == "fine" else f"tolerance {name}")
    left.set(xlabel="time [s]", ylabel="thrust [kN]", title=study.PICTURE)
    left.legend()
    for first, look, label in ((True, "ko", "first landing, settlement"), (False, "r.", "later landings")):
        some = [r for r in rows if is_first(r) == first and float(r["error"]) > 0]
        right.loglog([float(r["tolerance"]) for r in some], [float(r["error"]) for r in some], look, label=label)
    right.loglog([1e-3, 1e-1], [1e-3, 1e-1], "k-", lw=0.8)
    right.set(xlabel="tolerance", ylabel="error", title="every answer of every scene")
    right.legend()
    figure.tight_layout()
    bench.save(figure, "landing.png")


def texts(bench):
    rows = committed()
    lines, runs = [], {}
    for row in rows:
        runs.setdefault((row["scene"], row["tolerance"]), []).append(row)
    for (scene, tolerance), some in runs.items():
        of = {row["answer"]: row["error"] for row in some}
        later = {kind: max((float(r["error"]) for r in some if r["answer"] in (f"{kind} 2", f"{kind} 3")), default=None)
                 for kind in ("speed", "thrust")}
        lines.append((scene, tolerance, some[0]["steps"], some[0]["repeated"], of["speed 1"], of["thrust 1"],
                      of["settlement"], *("" if later[kind] is None else f"{later[kind]:.2g}" for kind in later)))
    head = ("scene", "tolerance", "steps", "repeated", "speed", "thrust", "settlement", "later speeds", "later thrusts")
    said = []
    for tolerance in study.TOLERANCES:
        some = [float(r["error"]) for r in rows if r["tolerance"] == tolerance and r["answer"] in ("thrust 1", "settlement")]
        said.append(f"At {tolerance} the thrust of the first landing and the settlement err by {np.median(some):.2g} in the "
                    f"median and by {max(some):.2g} at most.")
    return {"README.md": {"landings": tables.markdown(head, lines), "counts": textwrap.fill(" ".join(said), 118)}}
