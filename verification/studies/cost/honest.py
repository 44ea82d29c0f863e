# SPDX-License-Identifier: MIT
"""Is the estimated error of an answer the true one? Runs scenes with an accuracy, and with given fine steps on the same
mesh as the reference, and writes honest.csv. Resumable: a scene whose rows are there is left.

    python3 verification/studies/cost/honest.py [SCENE...]     MUD_BUILD_DIR: the build, default build/release
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

here = pathlib.Path(__file__).resolve().parent
root = here.parents[2]
sys.path.append(str(root / "common"))
import tables  # noqa: E402

build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release")
TABLE = here / "honest.csv"
NAMES = ("scene", "accuracy", "steps", "answer", "true_error", "estimated_error", "ratio")
HOST = "verification/host/"
# Name: scene, changes of both runs, changes of the reference alone (its steps), accuracies.
SCENES = {
    "vibration": (HOST + "vibration/scene.nml", [("rho_inf = 0.8", "")], [("dt = 0.005", "dt = 2e-4")],
                  ("1e-1", "1e-2", "1e-3")),
    "vibration_undamped": (HOST + "vibration/scene.nml", [("rho_inf = 0.8", "rho_inf = 1")],
                           [("dt = 0.005", "dt = 2e-4")], ("1e-1", "1e-2", "1e-3")),
    "vibration_damped": (HOST + "vibration/scene.nml", [("rho_inf = 0.8", "rho_inf = 0")],
                         [("dt = 0.005", "dt = 1e-4")], ("1e-1", "1e-2", "1e-3")),
    "falling_plate": (HOST + "contact/fall.nml", [("rho_inf = 0.8", ""), ("duration = 0.006", "duration = 0.003")],
                      [("dt = 1.0e-5", "dt = 1e-6")], ("1e-1", "1e-2")),
    "bar_impact": (HOST + "contact/bar.nml", [("rho_inf = 0.8", ""), ("duration = 1.5e-3", "duration = 6e-4")],
                   [("dt = 2.0e-6", "dt = 5e-7")], ("1e-1", "1e-2")),
    "terzaghi": (HOST + "terzaghi/scene.nml", [("dt_max = 1\n", "\n")],
                 [("dt = 1.0e-3", "dt = 1e-5"), ("dt_growth = 1.03", "dt_growth = 1.005")], ("1e-1", "1e-2", "1e-3")),
    "terzaghi_equal_order": (HOST + "terzaghi/scene.nml", [
        ("dt_max = 1\n", "\n"), ("pressures = 'linear'", "pressures = 'quadratic'")],
        [("dt = 1.0e-3", "dt = 1e-5"), ("dt_growth = 1.03", "dt_growth = 1.005")], ("1e-1", "1e-2")),
    "dynamic_consolidation": (HOST + "dynamic_consolidation/scene.nml", [], [("dt = 1.0e-4", "dt = 2e-5")],
                              ("1e-1", "1e-2")),
    "liakopoulos": (HOST + "liakopoulos/scene.nml", [], [(r"dt_growth = \S+", "dt_growth = 1.01")], ("1e-1", "1e-2")),
    "three_fields_of_mud": ("tests/host/scenes/restart.nml", [("checkpoint_steps = 2", "")],
                            [("dt = 1.0e-3", "dt = 2e-4"), ("dt_growth = 1.3", "dt_growth = 1")], ("1e-1", "1e-2")),
    "indentation": ("verification/studies/indentation/indent_s030.nml", [], [], ("1e-1", "1e-2")),
}


def changed(text, changes):
    for old, new in changes:
        assert re.search(old, text), old
        text = re.sub(old, new, text)
    return text


def run(text, beside, folder, *words):
    """Output on the terminal; the scene lies beside the original for the moment, so that relative paths hold."""
    scene = beside / f".honest_{os.getpid()}.nml"
    scene.write_text(text, encoding="utf-8")
    try:
        done = subprocess.run([build / "host/mud_host", scene, "--output", folder, "--quiet", *words], text=True,
                              capture_output=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    finally:
        scene.unlink()
    return done.stderr if done.returncode else ""


def study(name):
    path, both, reference, accuracies = SCENES[name]
    beside = (root / path).parent
    text = changed((root / path).read_text(encoding="utf-8"), both)
    # The controlled run of the indentation chooses what the paper's settings give by hand; the reference keeps those.
    free = text
    if name == "indentation":
        free = changed(text, [("   rho_inf = 0.8\n", ""), ("   tolerance = 1.0e-3\n", ""), ("   dt = 3.0e-5\n", "")])
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        fine, out = pathlib.Path(scratch) / "fine", pathlib.Path(scratch) / "out"
        if said := run(changed(text, reference), beside, fine):
            return [(name, "reference", 0, "failed: " + said.strip()[:80].replace(",", ";"), "", "", "")]
        exact = tables.columns(fine / "histories.csv")
        for accuracy in accuracies:
            if said := run(free, beside, out, "--accuracy", accuracy):
                rows.append((name, accuracy, 0, "failed: " + said.strip()[:80].replace(",", ";"), "", "", ""))
                continue
            found = tables.columns(out / "histories.csv")
            for answer in tables.rows(out / "answers.csv"):
                at, change = answer["answer"], float(answer["largest_change"])
                true = np.max(np.abs(found[at] - np.interp(found["time"], exact["time"], exact[at]))) / change
                estimate = float(answer["estimated_error"])
                rows.append((name, accuracy, len(found["time"]) - 1, at, f"{true:.2g}", f"{estimate:.2g}",
                             f"{true / estimate:.2g}" if estimate > 0 else ""))
    return rows


def main():
    have = [tuple(row[n] for n in NAMES) for row in tables.rows(TABLE)] if TABLE.exists() else []
    for name in sys.argv[1:] or SCENES:
        if any(row[0] == name for row in have):
            continue
        have += [tuple(map(str, row)) for row in study(name)]
        tables.write(TABLE, NAMES, have)
        print(name, flush=True)


if __name__ == "__main__":
    main()
