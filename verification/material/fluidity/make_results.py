# SPDX-License-Identifier: MIT
"""Measures what the page states and writes results.csv."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from recorded import make  # noqa: E402

if __name__ == "__main__":
    make(__file__)
