# SPDX-License-Identifier: MIT
"""Noise on element-test paths: how far it moves the response of each memory rule away from the path without noise, and at what cost."""
import report
from tools.page import Page, Script

PAGE = Page(
    claim="noise on a path: distance from the clean path, cost and failures of each memory rule; the elastic domain; "
          "why an elastic domain belongs to the default rule `return_point`",
    kind="study",
    input="a point of Toyoura sand at p' 100 kPa, e 0.735 or 0.907, sheared at constant volume or with the lateral "
          "effective stresses held, straight or turning into simple "
          "shear, saturated or at suction 100 kPa; some 2000 noisy paths (the CSV files, which name the commit that "
          "made them)",
    reference="the same path without noise and without elastic domain, Dormand-Prince at tolerance 1e-9",
    seconds=3, quick=1, pictures=("single.png", "many.png", "transverse.png"))
MAKES = (Script("study.py", ("*.csv",), 220),)


def check(bench):
    """What the tables say is checked for every page that has texts."""


def texts(bench):
    return {"README.md": report.texts(bench.here)}


def draw(bench, _, plt):
    report.pictures(bench, plt)
