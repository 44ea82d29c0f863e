# SPDX-License-Identifier: MIT
"""A rough footing on sand: bearing pressure by the default tolerance against a tight one, before and after."""
import math

from tools import tables
from tools.page import Page, Tolerance

PAGE = Page(
    claim="bearing pressures by the default tolerance are those of tight ones, and tolerances down to 1e-8 converge",
    kind="regression",
    input="`scene.nml`: radius 0.5 m, loose dry sand (e 0.907), weight, surcharge 2 kPa, static, 144 elements, 5 steps of 1 mm",
    reference="the same scene with the tolerance 1e-8",
    seconds=15, quick=15)

AREA, SETTLEMENT = math.pi * 0.5**2, 0.005
TWO_PER_CENT = Tolerance("what an engineer asks of a bearing pressure", relative=0.02)
VISIBLE = Tolerance("against all forces the weight hides the error: if this measure were as good, the page would prove nothing",
                    absolute=-0.05)


def pressure(bench, *changes):
    """At the last step, by the work of the supports [kPa]."""
    ledger = tables.columns(bench.host("scene.nml", changes) / "ledger.csv")
    work, time = ledger["supports"], ledger["time"]
    return (work[-1] - work[-2]) / ((time[-1] - time[-2]) * SETTLEMENT * AREA)


def check(bench):
    tight = pressure(bench, ("tolerance=1.0e-3", "tolerance=1.0e-8"))
    bench.near("default tolerance", pressure(bench), tight, TWO_PER_CENT, "kPa")
    before = pressure(bench, ("'auto'", "'forces'"))
    bench.below("5 % less the error of the measure against all forces", -abs(before / tight - 1), VISIBLE)
    bench.note(f"against all forces: {before:.1f} kPa, against what changes, 1e-8: {tight:.1f} kPa")
