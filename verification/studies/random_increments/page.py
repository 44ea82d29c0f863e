# SPDX-License-Identifier: MIT
"""Random increments: failures by size."""
from tools.page import Page, Tolerance

PAGE = Page(
    claim="no increment gives a NaN or runs without end; one that fails passes when it is divided",
    kind="robustness",
    input="4e4 increments (`scripts/random_increments`: 1e6) of all six components, sizes 1e-8 to 1e-1, from random "
          "states, every third with a change of suction",
    reference="limits that hold whatever the answer: finite values, status codes, the state of a failed increment",
    seconds=60)

NONE = Tolerance("tests/umat/contract/test_random.pf: no failure up to 1e-4, below 0.1 % up to 1e-2, none stuck, no value "
                 "that is not finite")


def check(bench):
    """The suite is part of the check run by itself."""
    bench.suite("test_random", NONE)
