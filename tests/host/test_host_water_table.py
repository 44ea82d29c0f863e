# SPDX-License-Identifier: MIT
"""A start with a water table: pressures of water at rest above and below it, in balance with the weight. Host theory,
section 8."""
import numpy as np
import pytest

from checking import check, work
from host_program import ran, start
import tables  # noqa: E402 (checking knows its folder)

# 5 m of ground whose water stands 2 m below the surface.
GROUND = """&scene name = 'ground' geometry = 'plane_strain' fields = '{fields}' gravity = 9.81 {scene} /
&mesh r = 0, 1 r_cells = 1 z = -5, -2, 0 z_cells = 6, 8 /
&elastic name = 'e' young = 1e4 poisson = 0.3 /
{retention}&permeability name = 'k' intrinsic = 1e-12 /
&fluids rho_w = 0.998 /
&region material = 'e' permeability = 'k' {of_region} void_ratio = 0.6 rho_s = 2.65 /
&initial {water} stress = 'geostatic' surface = 0 surcharge = 3 /
&stage name = 's' analysis = 'quasi_static' duration = 1e4 dt = 1e3 tolerance = 1e-8 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
{more}&load group = 'top' kind = 'pressure' value = 3 /
&point name = 'top' r = 0 z = 0 /
&point name = 'table' r = 0 z = -2 /
&point name = 'bottom' r = 0 z = -5 /
"""
WEIGHT = 0.998*9.81
CURVE = "&retention name = 'c' law = 'van_genuchten' alpha = 0.1 n = 2 /\n"


def ground(water, fields="u-p_w-p_c", scene="", more=""):
    dry = fields != "u-p_w-p_c"
    return GROUND.format(water=water, fields=fields, scene=scene, more=more, retention="" if dry else CURVE,
                         of_region="" if dry else "retention = 'c'")


@pytest.mark.parametrize("fields", ["u-p_w-p_c", "u-p_w"])
def test_the_water_rests_on_both_sides_of_its_table(fields):
    # Steps of 1000 s at 1e-5 m/s would let centimetres flow if a gradient were left. With p_c the air settles under
    # its own weight, 0.012 kPa per metre.
    close = 0.06 if fields == "u-p_w-p_c" else 1e-4
    done = start("rest", ground("water_table = -2", fields))
    check(f"{fields}: the start draws no warning", done.returncode == 0 and not done.stderr, done.stderr)
    rows = tables.columns(work / "rest/histories.csv")
    for point, z in (("top", 0), ("table", -2), ("bottom", -5)):
        for row in (0, -1):
            p_w = rows[f"{point}.p_w"][row]
            check(f"{fields}: p_w of {point}, row {row}", abs(p_w - WEIGHT*(-2 - z)) < close, p_w)
            if fields == "u-p_w-p_c":
                check(f"{fields}: air at {point}, row {row}", abs(p_w + rows[f"{point}.p_c"][row]) < close,
                      rows[f"{point}.p_c"])
    # Those shares of 10 MPa over 5 m.
    check(f"{fields}: nothing moves", np.ptp(rows["top.u_z"]) < 5*close/1e4, rows["top.u_z"])
    outflow = tables.columns(work / "rest/ledger.csv")["outflow"]
    check(f"{fields}: nothing flows", max(abs(np.array(outflow))) < 5*close/1e4, outflow)


def test_it_says_the_same_as_pressures_by_hand():
    by_hand = (f"p_w = 0 p_w_slope = {-WEIGHT:.6f} p_c = 0 p_c_slope = {WEIGHT:.6f} datum = -2")
    starts = []
    for name, water in (("table", "water_table = -2"), ("hand", by_hand)):
        if not ran(name, ground(water)):
            return
        starts.append(tables.columns(work / name / "points_s.csv"))
    for column in ("s_zz", "s_rr", "S_w"):
        check(f"{column} is the same", np.allclose(starts[0][column], starts[1][column], rtol=1e-9, atol=1e-9))


def test_the_suction_grows_no_further_than_is_said():
    text = ground("water_table = -2 largest_suction = 12", scene="initial_flow = 'subtract'")
    if ran("limit", text):
        rows = tables.columns(work / "limit/histories.csv")
        check("suction at the top, 19.6 kPa of water below it", abs(rows["top.p_c"][0] - 12) < 1e-9, rows["top.p_c"])
        check("below the table nothing changes", abs(rows["bottom.p_w"][0] - 3*WEIGHT) < 1e-9, rows["bottom.p_w"])


def test_gravity_is_that_of_the_start():
    # A centrifuge that begins at half its speed of weight.
    text = ground("water_table = -2", scene="gravity_history = 'spin'",
                  more="&history name = 'spin' times = 0, 2e4 values = 0.5, 0.5 /\n")
    if ran("spin", text):
        rows = tables.columns(work / "spin/histories.csv")
        check("half the weight", abs(rows["bottom.p_w"][0] - 1.5*WEIGHT) < 1e-9, rows["bottom.p_w"])


def test_what_contradicts_a_water_table_is_refused():
    for water, words in (("water_table = -2 p_w = 3", "leave out p_w, p_w_slope, p_c, p_c_slope and datum"),
                         ("water_table = -2 p_c_slope = 10", "or water_table"),
                         ("water_table = -2 datum = 1", "water_table gives p_w and p_c of water at rest")):
        done = start("refused", ground(water))
        check(f"{water} is refused", done.returncode == 2 and words in done.stderr, done.stderr)
    done = start("refused", ground("water_table = -2").replace("gravity = 9.81", ""))
    check("without gravity it is refused", done.returncode == 2 and "water_table needs gravity" in done.stderr,
          done.stderr)
    for keys, fields, words in (("p_w = 0 largest_suction = 5", "u-p_w",
                                 "largest_suction of &initial has no effect without"),
                                ("water_table = -2", "u", "water_table of &initial has no effect: the scene has no")):
        done = start("idle", ground(keys, fields), "--check")
        check(f"{keys} of {fields} is told", words in done.stderr, done.stderr)
