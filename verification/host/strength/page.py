# SPDX-License-Identifier: MIT
"""Strength that falls with time: where a strip, a vertical cut and a sample of MUD fail under loads that stay."""
from tools import tables
from tools.page import Page, Tolerance

PAGE = Page(
    claim="ground whose strength falls under loads that stay fails where limit analysis says so: a strip load, a vertical cut that was "
          "dug, a triaxial sample of MUD",
    kind="exact",
    input="`strip.nml`: 100 kPa on 1 m of half width, s_u 50 kPa; `cut.nml`: 5 m deep, 20 kN/m3, s_u 50 kPa, as ground that leaves; both "
          "with the Tresca UMAT of the tests; `sample.nml`: loose, q/p' = 0.75, M_c 1.25",
    reference="strip: (2 + pi) s_u (Prandtl); cut: 3.78 s_u/unit weight, between bounds of limit analysis, 3.772 and 3.786 (Lyamin & Sloan "
              "2002); sample: q/p' = M_c",
    seconds=15, quick=4)

STRIP, CUT = 2 + 3.14159265358979, 3.78
STRIP_MESH = Tolerance("the pressure ends within the cell at the edge, 1.5 cm of 1 m, and cells below it leave 1 %", relative=0.02)
CUT_MESH = Tolerance("the bounds are 0.4 % apart; a mesh is too strong by the cells at the toe, 13 cm of 5 m", relative=0.02)
FINER = Tolerance("a kinematic mesh is too strong: a finer one fails earlier", absolute=0)
SAMPLE = Tolerance("the stress ratio meets its bound where strains grow without end; the last step is cut to 1e-5 of the stage",
                   relative=1e-4)
COARSE = [("z_ratio=0.8,1.2", "z_ratio=0.8,1")]


def last_factor(bench, scene, start, duration, least, *changes):
    """Factor on the strength at the last time with equilibrium."""
    if scene != "sample.nml":
        changes = [("'tresca.so'", f"'{bench.program('tests/umats/tresca.so').resolve()}'"), *changes]
    rows = tables.columns(bench.host(scene, changes, expect=14) / "histories.csv")
    return 1 - (1 - least) * (rows["time"][-1] - start) / duration


def check(bench):
    bench.near("sample: M_c times the last factor, q/p'", 1.25 * last_factor(bench, "sample.nml", 0, 1, 0.2), 0.75, SAMPLE)
    bench.near("strip: load over the last strength", 100 / 50 / last_factor(bench, "strip.nml", 1, 1, 0.2), STRIP, STRIP_MESH)
    if bench.quick:
        return
    fine, coarse = (20 * 5 / 50 / last_factor(bench, "cut.nml", 2, 1, 0.4, *changes) for changes in ((), COARSE))
    bench.near("cut: weight times depth over the last strength", fine, CUT, CUT_MESH)
    bench.below("cut: what the finer mesh carries above the coarser", fine - coarse, FINER)
