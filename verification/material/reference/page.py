# SPDX-License-Identifier: MIT
"""An independent implementation of the model, and the library against its numbers."""
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="rates and paths of the library are those of an implementation that shares no code with it",
    kind="code-to-code",
    input="200 single evaluations of the rates (`paths_rates.csv`), 29 six-component strain paths (`paths.csv`), "
          "numbers for single paths and states (`printed_numbers.csv`)",
    reference="`mud_reference.py`: full 3x3 tensors, tr(n^3) = 3 det n, the direction equation by a scan of the angle "
              "with Brent's method in every bracket, void ratio "
              "in closed form along a segment, Dormand-Prince 8(5,3) with every memory reset located as an event "
              "(LSODA as a second integrator)",
    seconds=5)
MAKES = (Script("make_rates.py", ("paths_rates.csv",), 20),
         Script("make_paths.py", ("paths.csv",), 125),
         Script("printed_numbers.py", ("printed_numbers.csv",), 20))

NONE = Tolerance("tests/umat/contract/test_reference.pf holds rates to 1e-10 and paths to the tolerance asked for, "
                 "each "
                 "with its reason")


def check(bench):
    """The suite is part of the check run by itself."""
    bench.suite("test_reference", NONE)
