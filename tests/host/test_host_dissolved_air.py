# SPDX-License-Identifier: MIT
"""Air that the water of a scene dissolves: what a flow carries of it, and soil that nothing leaves, coupled or not."""
from checking import check, work
from host_program import ran
import tables  # noqa: E402 (checking knows its folder)

HENRY = 0.1   # Five times that of water, so that its terms are plain.
SOIL = f"""&elastic name = 'soil' young = 3e4 poisson = 0.2 /
&fluids gas = 'ideal' k_w = 2.2e6 henry = {HENRY} /
&retention name = 'curve' law = 'van_genuchten' alpha = 0.5 n = 3 /
&permeability name = 'k' intrinsic = 1e-11 law = 'corey' /
"""
#: A column between two pressures of the water, with the same air pressure of 11 kPa: no gradient moves the free air.
FLOW = "&scene name = 'flow' geometry = 'plane_strain' fields = 'u-p_w-p_c' /\n" + SOIL + """
&mesh r = 0, 0.1 r_cells = 1 z = 0, 1 z_cells = 6 /
&region material = 'soil' retention = 'curve' permeability = 'k' void_ratio = 0.8 /
&initial p_w = 10 p_c = 1 /
&stage name = 'flow' analysis = 'quasi_static' duration = 1e6 dt = 1e3 dt_growth = 1.3 dt_max = 1e5 rho_inf = 0
       tolerance = 1e-8 /
&fix group = 'all' field = 'u_r' /
&fix group = 'all' field = 'u_z' /
&fix group = 'bottom' field = 'p_w' value = 10 /
&fix group = 'bottom' field = 'p_c' value = 1 /
&fix group = 'top' field = 'p_w' value = 9 /
&fix group = 'top' field = 'p_c' value = 2 /
&point name = 'middle' r = 0 z = 0.5 /
"""
#: An element under all-round pressure whose boundaries are closed.
CLOSED = "&scene name = 'closed' fields = 'u-p_w-p_c' /\n" + SOIL + """
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&region material = 'soil' retention = 'curve' permeability = 'k' void_ratio = 0.8 /
&initial stress = 'uniform' sigma = -50.924481699134174, -50.924481699134174, -50.924481699134174 p_w = 199 p_c = 1 /
&history name = 'ramp' times = 0, 1 values = 250, 300 /
&stage name = 'press' analysis = 'quasi_static' duration = 1 dt = 0.05 tolerance = 1e-6 rho_inf = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 1 history = 'ramp' /
&load group = 'right' kind = 'pressure' value = 1 history = 'ramp' /
&point name = 'top' r = 0 z = 1 /
"""


def test_a_steady_flow_carries_its_air():
    # Where p_a is the same everywhere no free air flows: what leaves is h times the water that leaves, at either end.
    if not ran("flow", FLOW):
        return
    last = tables.numbers(work / "flow/reactions_flow.csv")[-1]
    water = last["top.outflow_w"]
    check("water flows", water > 1e-10, last)
    for group in ("top", "bottom"):
        water, air = last[f"{group}.outflow_w"], last[f"{group}.outflow_a"]
        check(f"{group}: the air of the water", abs(air/water/HENRY - 1) < 1e-5, (air, water))


def test_closed_soil_is_an_undrained_element():
    # All is uniform, so that a coupled region with closed boundaries keeps its fluids as an undrained element does.
    rows = {}
    kept = CLOSED.replace("permeability = 'k' void", "drainage = 'undrained' void")
    for name, text in (("coupled", CLOSED), ("undrained", kept)):
        rows[name] = tables.numbers(work / name / "histories.csv")[-1] if ran(name, text) else None
    if all(rows.values()):
        for column in ("top.p_w", "top.p_c", "top.s_zz"):
            one, two = rows["coupled"][column], rows["undrained"][column]
            check(f"closed and undrained: {column}", abs(one/two - 1) < 1e-7, (one, two))


def test_a_saturated_undrained_element_has_no_air_to_balance():
    # Pores full of water that dissolves no air: nothing says what the suction is, so it stays, and the water carries
    # the load as it does in a scene without air.
    rows = {}
    for fields, pressures in (("u-p_w", "p_w = 199"), ("u-p_w-p_c", "p_w = 199 p_c = 0")):
        text = CLOSED.replace("permeability = 'k' void", "drainage = 'undrained' void").replace(
            f" henry = {HENRY}", "").replace("p_w = 199 p_c = 1", pressures).replace("u-p_w-p_c", fields)
        if fields == "u-p_w":
            text = text.replace(" retention = 'curve'", "")
        rows[fields] = tables.numbers(work / fields / "histories.csv")[-1] if ran(fields, text) else None
    if all(rows.values()):
        for column in ("top.p_w", "top.s_zz", "top.u_z"):
            one, two = rows["u-p_w"][column], rows["u-p_w-p_c"][column]
            check(f"with and without air: {column}", abs(one/two - 1) < 1e-6, (one, two))
        check("it has no suction", rows["u-p_w-p_c"]["top.p_c"] == 0.0, rows["u-p_w-p_c"])


def test_a_tight_tolerance_is_met_at_any_step():
    # What the rounding of saturation leaves of its rate grows as steps shrink; it is no error of Newton's method.
    for dt in (0.05, 0.002):
        name = f"tight_{dt}"
        text = CLOSED.replace("permeability = 'k' void", "drainage = 'undrained' void").replace(
            "tolerance = 1e-6", "tolerance = 1e-8")
        if ran(name, text.replace("dt = 0.05", f"dt = {dt}")):
            rows = tables.numbers(work / name / "ledger.csv")
            check(f"steps of {dt} s: none is cut, the last may be rounding", len(rows) <= round(1/dt) + 1, len(rows))
