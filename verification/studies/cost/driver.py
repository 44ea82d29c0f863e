# SPDX-License-Identifier: MIT
"""Is the error that mud_triax measures with an accuracy the true one? Paths of one point against fine increments, a
tight tolerance and another scheme. Writes driver.csv. Ten seconds.

    verification/run studies/cost --make --only driver.py
"""
import os
import pathlib
import re
import subprocess
import sys

import numpy as np

root = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(root / "common"), str(root / "verification")]
import tables  # noqa: E402
from tools import results  # noqa: E402

build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release")
NAMES = ("path", "accuracy", "increments", "answer", "change", "true_error", "measured_error", "ratio")
# Material's keys, start, stage.
PATHS = {
    "drained": ("p_eff = 100 void_ratio = 0.833", "control = 'drained' eps_a_end = 0.05"),
    "undrained": ("p_eff = 100 void_ratio = 0.833", "control = 'undrained' eps_a_end = 0.05"),
    "stress cycles": ("p_eff = 100 void_ratio = 0.735",
                              "control = 'undrained' cycle_by = 'q' amplitude = 15 cycles = 2"),
    "constant water": ("p_eff = 100 void_ratio = 0.8 suction = 50",
                               "control = 'drained' water = 'constant' eps_a_end = 0.02"),
}


def path_rows(name, accuracies=("3e-2", "1e-3")):
    """The history of a path of the driver against increments of 2e-6, tolerance 1e-10, another scheme: at the rows that
    both write, which are the ends of the ways where stress turns."""
    start, stage = PATHS[name]
    folder = results.current(build.parent / "cost/driver", build)
    folder.mkdir(parents=True, exist_ok=True)
    case, out = folder / "case.nml", folder / "out.csv"
    cycles = "cycle_by" in stage

    def call(more, given, *words):
        case.write_text(f"&material file = '{root}/drivers/materials/toyoura.nml' {more} /\n&initial {start} /\n"
                        f"&stage {stage} output_interval = 1e-3 {given} /\n", encoding="utf-8")
        done = subprocess.run([build / "drivers/mud_triax", case, "--output", out, *words], text=True,
                              capture_output=True, check=True)
        rows = tables.columns(out)
        if cycles:   # between the ends of ways the rows of two runs are not the same
            turns = np.r_[True, np.diff(np.sign(np.diff(rows["q"]))) != 0, True]
            rows = {name: values[turns] for name, values in rows.items()}
        return done.stdout, rows

    _, exact = call("tolerance = 1e-10 scheme = 3", "increment = 2e-6", "--quiet")
    rows = []
    for accuracy in accuracies:
        said, found = call("", "", "--accuracy", accuracy)
        increments = int(re.search(r"(\d+) increments", said)[1])
        for answer, error, change in re.findall(r"^ +(\w+) (\S+) % of (\S+)(?: kPa)?$", said, re.MULTILINE):
            if answer in ("p_eff", "q", "eps_v", "suction") and float(change) > 0 and float(error) > 0:
                true = np.max(np.abs(found[answer] - exact[answer]))/float(change)
                rows.append((name, accuracy, increments, answer, f"{float(change):.3g}", f"{true:.2g}",
                             f"{float(error)/100:.2g}", f"{true/float(error)*100:.2g}"))
    return rows


if __name__ == "__main__":
    tables.write(results.folder(__file__) / "driver.csv", NAMES, [row for name in PATHS for row in path_rows(name)])
