# SPDX-License-Identifier: MIT
"""Fits parameters of MUD to laboratory tests; needs SciPy (extra ``calibrate``), pictures need matplotlib.

from mud.calibration import calibrate, make_task, write_material, write_report
task = make_task("my_sand", [{"file": "triaxial.csv", "kind": "drained"}], held_out=["T3"], known={"phi_c": 33.1})
result = calibrate(task)
write_material(result, Path("materials"))
write_report(result, Path("my_sand"))
"""

from .calibrate import Calibration, answers_of, calibrate, evaluate, misfits_of
from .ensemble import Band, Ensemble
from .fit import Effort, Minimum
from .misfit import Misfit, misfit_of
from .report import summary, write_material, write_report
from .simulation import Answer, Use, simulate, use_of
from .tables import LaboratoryTest, read_table
from .task import Item, Task, make_task, read_task

__all__ = [
    "Answer",
    "Band",
    "Calibration",
    "Effort",
    "Ensemble",
    "Item",
    "LaboratoryTest",
    "Minimum",
    "Misfit",
    "Task",
    "Use",
    "answers_of",
    "calibrate",
    "evaluate",
    "make_task",
    "misfit_of",
    "misfits_of",
    "read_table",
    "read_task",
    "simulate",
    "summary",
    "use_of",
    "write_material",
    "write_report",
]
