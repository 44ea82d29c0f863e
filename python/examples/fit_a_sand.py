# SPDX-License-Identifier: MIT
"""Fits two parameters of a sand to two of its tests, and looks at a third one: fit_a_sand.py [FOLDER]

Few parameters and few evaluations, so that it takes seconds; calibration/README.md shows whole calibrations.
"""

import pathlib
import sys

from mud.calibration import Effort, calibrate, make_task, summary, write_material, write_report

if __name__ == "__main__":  # the fit starts processes
    tables = pathlib.Path(__file__).resolve().parents[2] / "calibration" / "data"
    task = make_task(
        "my_sand",
        [
            {
                "file": "karlsruhe_fine_sand_drained_TC.csv",
                "kind": "drained",
                "first": 0.01,
                "only": ["TMD12", "TMD20", "TMD13"],
            }
        ],
        folder=tables,
        held_out=["TMD13"],
        known={"phi_c": 33.1},
        start="karlsruhe",
        groups=["hardening"],
        reference="Wichtmann & Triantafyllidis (2016)",
    )
    result = calibrate(task, Effort(samples=4, starts=1, joint=3), workers=1, write=None)
    for line in summary(result.misfits):
        print(f"{line['set']}: {line['text']}")
    print("\n".join(result.diagnosis.sentences))
    if len(sys.argv) > 1:
        folder = pathlib.Path(sys.argv[1])
        print(write_material(result, folder / "materials"))
        print(write_report(result, folder / "my_sand"))
