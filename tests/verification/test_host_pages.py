# SPDX-License-Identifier: MIT
"""Known answers of mud_host: the pages of verification/host as the check run takes them."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
from checking import finish  # noqa: E402
from page_checks import run_section  # noqa: E402

run_section("host")
finish()
