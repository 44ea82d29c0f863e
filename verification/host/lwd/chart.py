# SPDX-License-Identifier: MIT
"""Makes chart.csv, chart.png and drops.csv, the chart of Toyoura sand by mud_lwd and the drops of one of its tests;
test.png, the picture of the example of docs/how-to/lwd.md; plates.csv, this example with a plate that lies loose, one
that is tied, and a mass that falls on a spring; and study.csv, the accuracy of a drop on elastic ground and on sand by
mud_study."""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys

from tools import tables
from tools.results import folder

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release")
sys.path.insert(0, str(ROOT / "python"))
os.environ["MUD_LIBRARY_DIR"] = str(BUILD)
from mud.lwd.answers import answers_of  # noqa: E402 (the library is named first)
from mud.lwd.device import device_of  # noqa: E402
from mud.lwd.ground import Layer, Test, scene_of  # noqa: E402
from mud.study.accuracy import Study  # noqa: E402
from mud.study.runs import Scene  # noqa: E402

ACCURACY = 0.05
PLATES = {"loose": (), "tied": ("--tied",), "falling mass": ("--buffer", "354")}
DROP = ("drop", "deflection_mm", "deflection_error_mm", "rebound_mm", "settlement_mm", "settlement_error_mm", "lift_mm",
        "force_kN")
STUDY = ("ground", "fineness", "step_tolerance", "mesh_percent", "steps_percent", "solve_percent", "total_percent",
         "deflection_mm", "seconds", "state")
GROUNDS = {"elastic": (Layer("elastic:30000:0.3"), None), "sand": (Layer("toyoura", 0.8), 30.0)}


def study_of(name, output):
    """Rows of the study `accuracy` of a single drop: every pair of mesh and steps that it tried."""
    layer, suction = GROUNDS[name]
    test = Test(device_of("zorn"), (layer,), suction=suction, seating=0, measured=1)
    path = output / f"{name}.nml"
    path.write_text(scene_of(test), encoding="utf-8")
    scene = Scene(path, output / f"study_{name}", str(BUILD / "host/mud_host"))
    study = Study(scene, ACCURACY)
    study.search()
    for pair in study.pairs:
        error = pair.errors["plate.u_z"]
        deflection = answers_of(test, scene.folder / pair.run.key.folder).deflection
        yield (name, f"{pair.fineness:g}", f"{pair.tolerance:.2g}", *(f"{100 * x:.2g}" for x in (
            error.mesh, error.steps, error.newton + error.stress, error.total)), f"{1e3 * deflection:.4g}",
            f"{pair.run.seconds:.3g}", study.state if pair is study.pairs[-1] else "")


def table(path, head, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([head, *rows])


def main():
    output = folder(__file__)
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "python"), "MUD_HOST": str(BUILD / "host/mud_host")}

    def mud_lwd(*words):
        subprocess.run([sys.executable, "-m", "mud.lwd", *words], check=True, env=environment)

    mud_lwd("chart", "--material", "toyoura", "--void-ratios", "0.7", "0.85",
            "--suctions", "5", "10", "20", "50", "100", "200", "--output", output / "chart")
    for name in ("chart.csv", "chart.png", "e0.7_s20/drops.csv"):
        shutil.copyfile(output / "chart" / name, output / pathlib.Path(name).name)
    rows = []
    for name, words in PLATES.items():
        where = output / name.split()[0]
        mud_lwd("test", "--material", "toyoura", "--void-ratio", "0.8", "--suction", "30", *words, "--output", where)
        told = json.loads((where / "results.json").read_text(encoding="utf-8"))
        drops = tables.rows(where / "drops.csv")
        modulus = [f"{told[key] / 1e3:.{digits}g}" for key, digits in (("modulus", 4), ("error", 2))]
        rows += [(name, *(drop[key] for key in DROP), *modulus) for drop in (drops[0], drops[-1])]
    table(output / "plates.csv", ("plate", *DROP, "modulus_MPa", "modulus_error_MPa"), rows)
    shutil.copyfile(output / "loose/lwd.png", output / "test.png")
    table(output / "study.csv", STUDY, [row for name in GROUNDS for row in study_of(name, output)])


if __name__ == "__main__":
    main()
