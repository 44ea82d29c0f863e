# SPDX-License-Identifier: MIT
"""Known answers of mud_host: the pages of verification/host as the check run takes them."""
from page_checks import run_section


def test_every_page_of_the_host():
    run_section("host")
