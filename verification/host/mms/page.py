# SPDX-License-Identifier: MIT
"""Manufactured solutions: judged by the suite that compiles them into the host."""
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="the host solves the coupled equations of u, p_w and p_c with the order of its elements and of its time "
          "integration, axisymmetric with the axis r = 0 in the domain, and "
          "in plane strain",
    kind="manufactured",
    input="`manufactured.f90`: every field is chosen, the loads that make it a solution are derived",
    reference="the chosen fields; the module itself against `samples.csv`, derived another way with 60 digits",
    seconds=20)
MAKES = (Script("make_mms.py", ("manufactured.f90", "samples.csv"), 6),)

NONE = Tolerance("tests/host/run/test_manufactured.pf asks for orders 3, 2 and 2 within 0.2: meshes and steps that are "
                 "not infinitely fine")


def check(bench):
    """The suite is part of the check run by itself."""
    bench.suite("test_manufactured", NONE)
