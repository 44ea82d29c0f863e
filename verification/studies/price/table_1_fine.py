#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The benchmark of the paper at 0 and 3 kPa on the finest meshes that were run: table_1_fine.csv, beside table_1.csv.

    verification/run studies/price --make --only table_1_fine.py

An hour and ten minutes of one core.
"""
from table_1 import make

FINE = [(3, "graded", 2, "1e-2"), (0, "graded", 2, "1e-2"), (3, "graded", 4, "1e-2")]
LIMIT = 10000   # s of a run

if __name__ == "__main__":
    make("table_1_fine.csv", FINE, __doc__.split("\n")[0], LIMIT)
