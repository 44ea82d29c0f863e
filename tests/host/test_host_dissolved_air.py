# SPDX-License-Identifier: MIT
"""Air that the water of a scene dissolves: what a flow carries of it, and soil that nothing leaves, coupled or not; a
gas whose density and stiffness follow its pressure."""
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


#: A gas a hundred times as heavy as air at 50 kPa everywhere: its weight alone drives it.
HEAVY = """&scene name = 'heavy' geometry = 'plane_strain' fields = 'u-p_w-p_c' gravity = 9.81 /
&mesh r = 0, 0.2 r_cells = 1 z = 0, 1 z_cells = 10 /
&fluids gas = 'ideal' rho_a = 0.12 rho_w = 1e-9 /
&elastic name = 'soil' young = 1e9 poisson = 0 /
&retention name = 'r' law = 'power' a = 0.005 b = 1 /
&permeability name = 'k' intrinsic = 1e-12 law = 'constant' k_rw = 1e-9 k_ra = 1 /
&region material = 'soil' retention = 'r' permeability = 'k' void_ratio = 0.8 rho_s = 0 /
&initial p_w = -50 p_c = 100 /
&stage name = 'flow' analysis = 'quasi_static' duration = 10 dt = 1 tolerance = 1e-8 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'all' field = 'p_a' value = 50 /
&fix group = 'all' field = 'p_c' value = 100 /
"""
#: A wave in a column of little saturation: an ideal gas of 20 kPa is as stiff as a gas of that modulus.
WAVE = """&scene name = 'wave' geometry = 'plane_strain' fields = 'u-p_w-p_c' /
&mesh r = 0, 0.5 r_cells = 1 z = 0, 10 z_cells = 20 /
&fluids {gas} /
&elastic name = 'soil' young = 1e3 poisson = 0.3 /
&retention name = 'r' law = 'power' a = 0.005 b = 1 /
&permeability name = 'k' intrinsic = 1e-14 law = 'constant' /
&region material = 'soil' retention = 'r' permeability = 'k' void_ratio = 0.8 /
&initial p_w = -20 p_c = 20 stress = 'uniform' sigma = -18, -18, -18 /
&history name = 'h' kind = 'haversine' period = 0.05 /
&stage name = 'a' analysis = 'dynamic' duration = 0.6 dt = 1e-3 tolerance = 1e-6 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&absorbing group = 'bottom' /
&load group = 'top' kind = 'pressure' value = 0.01 history = 'h' /
&point name = 'top' r = 0 z = 10 /
"""


def test_an_ideal_gas_is_as_heavy_as_its_pressure_makes_it():
    # k/eta_a (rho_a g (1 + p_a/p_ref))^2 over 0.2 m3 for 10 s: what the ledger says of seepage.
    if not ran("heavy", HEAVY):
        return
    known = 1e-12/1.8e-8*(0.12*9.81*(1 + 50/101.325))**2*0.2*10
    seepage = tables.columns(work / "heavy/ledger.csv")["seepage"][-1]
    check("dissipated by the flow of a heavy gas", abs(seepage/known - 1) < 1e-3, (seepage, known))


def test_an_absorbing_side_has_the_stiffness_of_an_ideal_gas():
    ends = []
    for name, gas in (("ideal", "gas = 'ideal' p_ref = 20"), ("constant", "k_a = 20")):
        if not ran(f"wave_{name}", WAVE.format(gas=gas)):
            return
        ends.append(tables.columns(work / f"wave_{name}/histories.csv")["top.u_z"][-1])
    check("the drift that the dashpots leave is one", abs(ends[0]/ends[1] - 1) < 1e-4, ends)
