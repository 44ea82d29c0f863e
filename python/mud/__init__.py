# SPDX-License-Identifier: MIT
"""MUD in Python: a bounding-surface model for unsaturated soil, its element tests, and results of its finite-element host::

    import mud
    sand = mud.Material("toyoura")
    test = mud.element_test(sand, mud.Stage("drained", eps_a_end=0.2), p_eff=100.0, void_ratio=0.8)
    mud.plot_test(test, "drained.png")          # needs matplotlib

``mud.parameters`` and ``mud.states`` are the library's registry. ``mud.calibration`` (needs SciPy) fits parameters to
laboratory tests. Points follow the library's convention (tension positive, engineering shear), element tests that of the
laboratory (compression positive); both say so.
"""

from . import _native
from .element_test import Stage, TestResult, element_test, run_case
from .errors import IncrementError, InputError, MudError, TestStopped, Unchangeable, UnknownName
from .host import HostRun
from .material import Material, Response, material_file, materials
from .plots import plot_histories, plot_test
from .points import BatchResponse, MaterialList
from .registry import Parameter, Registry, StateVariable, parameters, state, states

#: Version of the library, which is that of the package.
__version__: str = _native.text_of(_native.mud.mud_version)[1]

__all__ = [
    "BatchResponse",
    "HostRun",
    "IncrementError",
    "InputError",
    "Material",
    "MaterialList",
    "MudError",
    "Parameter",
    "Registry",
    "Response",
    "Stage",
    "StateVariable",
    "TestResult",
    "TestStopped",
    "Unchangeable",
    "UnknownName",
    "element_test",
    "material_file",
    "materials",
    "parameters",
    "plot_histories",
    "plot_test",
    "run_case",
    "state",
    "states",
]
