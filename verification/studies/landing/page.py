# SPDX-License-Identifier: MIT
"""Bodies that fall on soil: speed, thrust and settlement against what was asked for."""
import math
import pathlib
import textwrap

import study

from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="where bodies fall on soil the first landing has the speed, the peak thrust and the settlement of fine steps: within "
          "three times the accuracy asked for, or the run ends with exit code 20",
    kind=("exact", "study"),
    input="`study.py`: plates and deformable blocks, 2 mm to 20 cm above elastic soil and MUD, at 1e-1, 1e-2 and 1e-3",
    reference="free fall; given steps of 4e-6 s on elastic soil, 2e-5 s on MUD, on the same mesh",
    seconds=20, quick=4, pictures=("landing.png",))
MAKES = (Script("study.py", ("results.csv", "picture.csv"), 560),)

ASKED = Tolerance("the accuracy asked for, 1e-1", absolute=0.1)
LANDS = Tolerance("the step that closes the contact ends where it closes; accuracy 1e-1", absolute=0.001)
MADE = Tolerance("a count of the table", absolute=0.0)
QUICK = ("block on MUD, 2 mm",)
FULL = QUICK + ("plate on elastic soil, 2 mm", "block on elastic soil, 2 mm")


def committed():
    return tables.rows(pathlib.Path(__file__).parent / "results.csv")


def is_first(row):
    """Whether an answer belongs to the first landing, or is the settlement."""
    return row["answer"] in ("speed 1", "thrust 1", "settlement")


def missed(row):
    """Beyond the accuracy asked for, by more than the reference itself may be off."""
    return float(row["error"]) > float(row["accuracy"]) + float(row["reference_off"])


def check(bench):
    rows = committed()
    for scene in study.scenes():
        if scene.name not in (QUICK if bench.quick else FULL):
            continue
        folder = bench.folder()
        study.run(bench.program("host/mud_host"), scene, folder, "", "--accuracy", "1e-1", "--quiet")
        found = study.answers(scene, folder)
        bench.near(f"{scene.name}: speed of the first landing over that of free fall",
                   found["speed 1"]/math.sqrt(2*study.GRAVITY*scene.height), 1.0, LANDS)
        for answer in ("thrust 1", "settlement"):
            fine = float(next(r["reference"] for r in rows if r["scene"] == scene.name and r["answer"] == answer))
            bench.near(f"{scene.name}: {answer} over that of fine steps", found[answer]/fine, 1.0, ASKED)
    beyond = [r for r in rows if is_first(r) and r["exit"] == "0"
              and float(r["error"]) > 3*float(r["accuracy"]) + float(r["reference_off"])]
    bench.near("first landings beyond three times the accuracy in runs that end with exit code 0", len(beyond), 0, MADE)
    return None


def draw(bench, results, plt):
    rows = committed()
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    lines = tables.rows(pathlib.Path(__file__).parent / "picture.csv")
    for name, look in (("fine", "k-"), (study.ACCURACIES[0], "r--")):
        some = [r for r in lines if r["run"] == name]
        left.plot([float(r["time"]) for r in some], [float(r["thrust"]) for r in some], look, lw=0.8,
                  label="given fine steps" if name == "fine" else f"accuracy {name}")
    left.set(xlabel="time [s]", ylabel="thrust [kN]", title=study.PICTURE)
    left.legend()
    for first, look, label in ((True, "ko", "first landing, settlement"), (False, "r.", "later landings")):
        some = [r for r in rows if is_first(r) == first and float(r["error"]) > 0]
        right.loglog([float(r["accuracy"]) for r in some], [float(r["error"]) for r in some], look, label=label)
    right.loglog([1e-3, 1e-1], [1e-3, 1e-1], "k-", lw=0.8)
    right.set(xlabel="accuracy asked for", ylabel="error", title="every answer of every scene")
    right.legend()
    figure.tight_layout()
    bench.save(figure, "landing.png")


def texts(bench):
    rows = committed()
    lines, runs = [], {}
    for row in rows:
        runs.setdefault((row["scene"], row["accuracy"]), []).append(row)
    for (scene, accuracy), some in runs.items():
        of = {row["answer"]: row["error"] for row in some}
        later = {kind: max((float(r["error"]) for r in some if r["answer"] in (f"{kind} 2", f"{kind} 3")), default=None)
                 for kind in ("speed", "thrust")}
        lines.append((scene, accuracy, some[0]["steps"], some[0]["exit"], some[0]["estimated"], of["speed 1"], of["thrust 1"],
                      of["settlement"], *("" if later[kind] is None else f"{later[kind]:.2g}" for kind in later)))
    head = ("scene", "asked", "steps", "exit code", "estimate", "speed", "thrust", "settlement", "later speeds", "later thrusts")
    first = [r for r in rows if is_first(r)]
    then = [r for r in rows if not is_first(r)]
    silent = [r for r in then if float(r["error"]) > 3*float(r["accuracy"]) + float(r["reference_off"]) and r["exit"] == "0"]
    told = len([1 for some in runs.values() if some[0]["exit"] != "0"])
    counts = (f"Of {len(first)} answers of first landings {sum(missed(r) for r in first)} miss the accuracy; of {len(then)} of "
              f"later ones {sum(missed(r) for r in then)}, of which {len(silent)} by more than three times in a run that ends "
              f"with exit code 0. {told} of {len(runs)} runs end with exit code 20.")
    return {"README.md": {"landings": tables.markdown(head, lines), "counts": textwrap.fill(counts, 118)}}
