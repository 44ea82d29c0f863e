# SPDX-License-Identifier: MIT
"""Writes reference.csv: ends of the paths of docs/theory/integration.md section 6.1 by verification/material/reference
(full matrices, DOP853), with their own uncertainty: the largest change of either stress if the tolerance is ten times larger or the method is LSODA."""
import sys

import numpy as np
from tools.bench import ROOT
from tools.results import folder

sys.path.insert(0, str(ROOT / "verification/material/reference"))
from mud_reference import isotropic, oedometric, segment, undrained  # noqa: E402
from reference_rates import I3, Params  # noqa: E402

# name: p', e, suction, strain of every straight part (compression positive)
PATHS = {
    "undrained_e735_p100": (100, 0.735, 0, [undrained(0.25)]),
    "undrained_e833_p2000": (2000, 0.833, 0, [undrained(0.25)]),
    "undrained_e907_p100": (100, 0.907, 0, [undrained(0.25)]),
    "extension_e833_p100": (100, 0.833, 0, [undrained(-0.10)]),
    "oedometer_e8_p50": (50, 0.8, 0, [oedometric(0.06)]),
    "isotropic_e8_p50": (50, 0.8, 0, [0.02*I3]),
    "unsaturated_e8_p20": (20, 0.8, 100, [undrained(0.10)]),
    "figure_1_threshold": (100, 0.735, 0, [undrained(0.10), undrained(-1.5e-4), undrained(0.05015)]),
}


def end_of(p, e, suction, parts, **options):
    state = isotropic(p, e, suction) if suction else isotropic(p, e)
    for part in parts:
        segment(state, part, 0.0, Params(), **options)
    return np.array([state.sig[0, 0], state.sig[1, 1]])


with open(folder(__file__) / "reference.csv", "w", encoding="utf-8") as file:
    file.write("# ends of the paths of docs/theory/integration.md section 6.1 by make_reference.py, independent of the library; kPa, compression "
               "positive\n")
    file.write("path,sigma_a,sigma_r,uncertainty\n")
    for name, path in PATHS.items():
        best = end_of(*path, rtol=1e-12)
        others = [end_of(*path, rtol=1e-11), end_of(*path, rtol=1e-11, method="LSODA", max_step=0.02)]
        doubt = max(np.abs(other/best - 1).max() for other in others)
        file.write(f"{name},{best[0]:.15g},{best[1]:.15g},{doubt:.1e}\n")
        print(name, best, f"{doubt:.1e}", flush=True)
