# SPDX-License-Identifier: MIT
"""Uses the installed package as a stranger would: version, an update, an element test.

usage: try_package.py VERSION, with the Python that has the package. The library of element tests is loaded when a test
first asks for it: updates need neither it nor LAPACK.
"""
import pathlib
import sys

import mud
import numpy as np

assert mud.__version__ == sys.argv[1], (mud.__version__, sys.argv[1])
assert "site-packages" in mud.__file__, f"not the installed package: {mud.__file__}"
sand = mud.Material("toyoura")
stress, state = sand.initial_state(np.array([-100.0, -100.0, -100.0, 0.0, 0.0, 0.0]), void_ratio=0.735)
answer = sand.update(stress, state, np.array([-1e-4, 5e-5, 5e-5, 0.0, 0.0, 0.0]), tangent="consistent")
assert answer.report.status == 0 and answer.dsig_deps.shape == (6, 6)
maps = pathlib.Path("/proc/self/maps")
assert not maps.exists() or not any(name in maps.read_text() for name in ("libmud_triax", "liblapack"))
test = mud.element_test(sand, mud.Stage("undrained", eps_a_end=0.01), p_eff=100.0, void_ratio=0.735)
# The published increments and an independent integration: verification/material/reference.
assert abs(test["p_eff"][-1] / 147.354 - 1.0) < 1e-3 and abs(test["q"][-1] / 219.587 - 1.0) < 1e-3, test["q"][-1]
print(f"mud {mud.__version__}: p' {test['p_eff'][-1]:.3f} kPa, q {test['q'][-1]:.3f} kPa")
