# SPDX-License-Identifier: MIT
"""What the pages of the verification share. `tables`, the reader of CSV tables, is that of all scripts in common/."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "common"))
import tables  # noqa: E402, F401 (its folder is known only now)
