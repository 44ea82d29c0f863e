# SPDX-License-Identifier: MIT
"""What an error of Newton's method is measured by where hardly any force is there: a press fit, a plate in free flight,
very small units, very short steps of a flow; and pressures where water cannot drain yet."""
import re
import sys

import numpy as np
import pytest

from checking import at_length, check, light, root, work
from host_program import ran, start

sys.path.insert(0, str(root / "common"))
import tables  # noqa: E402

TOLERANCE = 1e-4   # of Newton's method in these stages, so of the thrusts too
# A plate over a third of a block, both a length wide; it begins at `z` and ends at 0.998 of the height.
PRESSED = """&scene name = 'pressed' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, {third}, {size} r_cells = 2, 3 z = 0, {size} z_cells = 3 /
&elastic name = 'soil' young = {young} poisson = 0.2 /
&region material = 'soil' void_ratio = 0 rho_s = 2 /
&stage name = 's' analysis = 'static' duration = 1 dt = {dt} tolerance = 1e-4 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'bottom' field = 'u_r' /
&plate name = 'p' r = 0, {third} z = {z} mass = 0.001 /
&contact name = 'c' slave = 'top' master = 'p' penalty = {penalty} search_radius = {third} /
&history name = 'h' times = 0, 1 values = 0, 1 /
&fix group = 'p' field = 'u_z' value = {way} history = 'h' /
"""


def thrust(name, start_at, size=1.0, young=2e4, stiff=1e4, dt=1.0):
    """Over young times size, and what was said."""
    text = PRESSED.format(third=size / 3, size=size, young=young, z=start_at * size, dt=dt,
                          penalty=stiff * young / size, way=(0.998 - start_at) * size)
    done = start(name, text)
    check(f"{name} runs", done.returncode == 0, done.stderr)
    return float(tables.rows(work / name / "contact.csv")[-1]["c.thrust"]) / young / size, done.stderr


def test_a_plate_that_begins_inside_presses_as_one_that_is_moved_in():
    for stiff, pressure in ((1e3, "40000"), (1e4, "400000"), (1e6, "4e7")):
        moved, said = thrust(f"moved_{stiff:g}", 1.0, stiff=stiff, dt=0.25)
        check("a plate that only touches is no doubt", "overlap" not in said, said)
        inside, said = thrust(f"inside_{stiff:g}", 0.998, stiff=stiff)
        # Linear soil: the way there does not matter. Each of the four steps and the one leave the tolerance at most.
        check(f"penalty {stiff:g}: the same thrust", abs(inside / moved - 1) < 5 * TOLERANCE, (inside, moved))
        check(f"penalty {stiff:g}: depth and pressure are told", "overlap by up to 0.002 m" in said
              and f"presses there with {pressure} kPa" in said, said)
    text = PRESSED.format(third=1 / 3, size=1, young=2e4, z=0.998, dt=1, penalty=2e8, way=0)
    done = start("checked", text, "--check")
    check("--check tells it as well", "overlap by up to 0.002 m" in done.stderr, done.stderr)


def test_the_advice_on_a_plate_without_weight_leads_to_its_settlement():
    # A plate of 0.4 m2 with 30 kN on a layer of 1.5 m that cannot widen: 75 kPa over a modulus of 1.2 times Young's.
    loaded = """&scene name = 'loaded' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 0.4 r_cells = 2 z = 0, 1.5 z_cells = 3 /
&elastic name = 'soil' young = 1e4 poisson = 0.25 /
&region material = 'soil' void_ratio = 0 /
&stage name = 's' analysis = 'static' duration = 1 dt = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&plate name = 'p' r = 0, 0.4 z = {z} mass = 0.001 force = -30 /
&contact name = 'c' slave = 'top' master = 'p' penalty = 1e8 /
"""
    touching = start("touching", loaded.format(z=1.5))
    check("a plate that only touches: the way out is told", touching.returncode == 13
          and "contact alone holds the body of plate p, and surfaces that only touch hold nothing" in touching.stderr
          and "overlap by a millionth of an edge" in touching.stderr, touching.stderr)
    deep = start("deep", loaded.format(z=1.499))
    told = re.search(r"until they overlap by no more than (\S+) m", deep.stderr)
    check("an overlap in a static stage: how little is enough is told", told and "only touch" not in deep.stderr,
          deep.stderr)
    if told:
        done = start("seated", loaded.format(z=1.5 - 0.9 * float(told[1])))
        check("that much runs without a warning", done.returncode == 0 and "overlap" not in done.stderr, done.stderr)
        sunk = float(tables.rows(work / "seated/contact.csv")[-1]["p.u_z"])
        check("to the settlement", abs(sunk / (-75 * 1.5 / 1.2e4) - 1) < 1e-3, sunk)


def test_two_bodies_that_overlap_are_pressed_together():
    # The same through a body in place of a plate: the blocks of one mesh, held apart by 1 mm less than nothing.
    for name, gap, told in (("apart", 0.0, False), ("fit", -0.5e-3, True)):
        done = start(name, SPLIT.format(gap=1 + gap))
        check(f"{name} runs", done.returncode == 0, done.stderr)
        check(f"{name}: overlap told {told}", ("overlap" in done.stderr) == told, done.stderr)
    # Closed form: uniaxial strain in the block, M = E (1 - nu)/((1 + nu)(1 - 2 nu)) = 2.2222e4, shortened by 0.5 mm
    # of 1 m over 0.4 m.
    wanted = 2e4 * 0.8 / (1.2 * 0.6) * 0.5e-3 * 0.4
    found = float(tables.rows(work / "fit/contact.csv")[-1]["c.thrust"])
    check("the press fit carries the closed form", abs(found / wanted - 1) < 1e-3, (found, wanted))


SPLIT = """&scene name = 'split' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 0.4 r_cells = 2 z = 0, 1 z_cells = 3 /
&elastic name = 'soil' young = 2e4 poisson = 0.2 /
&region material = 'soil' void_ratio = 0 rho_s = 2 /
&stage name = 's' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-4 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&plate name = 'p' outline = 0, {gap}, 0.4, {gap} mass = 0.001 /
&contact name = 'c' slave = 'top' master = 'p' penalty = 1e8 /
&fix group = 'p' field = 'u_z' /
"""


def test_units_and_sizes_do_not_change_an_answer():
    for start_at in (1.0, 0.998):
        one, _ = thrust("unit", start_at)
        for size, young in ((1e-4, 2e4), (1e-4, 2e-3), (1.0, 2e-3), (1e-6, 2e-9)):
            other, _ = thrust("small", start_at, size, young)
            # The same iterations; where one of them ends may differ by rounding, so by a share of the tolerance.
            check(f"{size} m, {young} kPa, from {start_at}", abs(other / one - 1) < 0.01 * TOLERANCE, (other, one))


# A plate rests while nothing changes, on ground whose surface is at `top`.
RESTING = """&scene name = 'resting' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 0.5, 1 r_cells = 2, 2 z = {base}, {top} z_cells = 2 /
&elastic name = 'soil' young = 2e4 poisson = 0.3 /
&region material = 'soil' void_ratio = 0 viscosity = 2e3 /
&stage name = 's' analysis = 'quasi_static' duration = 2 dt = 0.1 tolerance = 1e-6 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&plate name = 'p' r = 0, 0.5 z = {face} mass = 1 force = -5 /
&contact name = 'c' slave = 'top' master = 'p' penalty = 1e6 /
"""


@pytest.mark.parametrize("top", (100, -37.25, 1000))
def test_a_plate_rests_on_ground_at_any_height(top):
    # Gaps are differences of heights: their rounding, times the penalty, is no force that is left open.
    sunk = {}
    for at in (0, top):
        done = start("resting", RESTING.format(base=at - 1, top=at, face=f"{at - 1e-6:.17g}"))
        check(f"surface at {at} m runs", done.returncode == 0, done.stderr)
        sunk[at] = float(tables.rows(work / "resting/contact.csv")[-1]["p.u_z"])
    # The height of the face is rounded too, to a part of 1e-13 m: 1e-8 of the settlement.
    check("to the same settlement", abs(sunk[top] / sunk[0] - 1) < 1e-6, sunk)


FLIGHT = """&scene name = 'flight' geometry = 'plane_strain' fields = 'u' gravity = {gravity} /
&mesh r = 0, 0.4, 2 r_cells = 2, 3 z = -2, 0 z_cells = 4 /
&elastic name = 'soil' young = 3e4 poisson = 0.3 /
&region material = 'soil' void_ratio = 0.6 /
&plate name = 'plate' r = 0, 0.4 z = {gap} mass = 0.4 {weight} /
&initial group = 'plate' v_z = -0.5 /
{ground}
&contact name = 'face' slave = 'top' master = 'plate' penalty = 1e7 search_radius = 0.4 /
&stage name = 'fly' analysis = 'dynamic' duration = {time} /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
"""


@pytest.mark.parametrize("accuracy", ("1e-1",) if light else ("1e-1", "1e-2", "1e-3"))
@pytest.mark.parametrize("gap", (0.004, 0.02, 0.15))
def test_a_plate_in_free_flight_lands(accuracy, gap):
    # Without weight it meets the ground, at rest and without a force, after gap/0.5 s.
    text = FLIGHT.format(gravity=0, gap=gap, weight="", ground="", time=gap / 0.5 + 2e-3)
    name = f"flight_{accuracy}_{gap}"
    done = start(name, text, "--step-tolerance", accuracy)
    check("it runs to its end", done.returncode == 0, done.stderr)
    contact = tables.columns(work / name / "contact.csv")
    lands = contact["time"][np.argmax(contact["face.thrust"] > 0)]
    check("it flies freely and lands in time", contact["face.thrust"].max() > 0
          and abs(lands - gap / 0.5) < 1e-3, (lands, gap / 0.5))
    before = contact["time"] < gap / 0.5 - 1e-5
    check("its velocity stays", np.abs(contact["plate.v_z"][before] + 0.5).max() < 1e-6,
          np.abs(contact["plate.v_z"][before] + 0.5).max())


def test_a_plate_with_a_force_on_it_lands():
    # Thrown upwards against 9.81 m/s2, given as a force: back at the height it left, 0.5/9.81 s later each way.
    text = FLIGHT.format(gravity=0, gap=1e-3, weight=f"force = {-0.4 * 9.81}", ground="", time=0.11).replace(
        "v_z = -0.5", "v_z = 0.5")
    if ran("thrown", text, "--step-tolerance", "1e-2"):
        contact = tables.columns(work / "thrown/contact.csv")
        lands = contact["time"][np.argmax(contact["face.thrust"] > 0)]
        wanted = (0.5 + np.sqrt(0.25 + 2 * 9.81 * 1e-3)) / 9.81
        check("it comes back by the parabola", abs(lands - wanted) < 1e-3, (lands, wanted))


def test_a_tied_plate_whose_ground_moves_far_needs_no_digits_that_rounding_takes():
    # The springs of the tie leave 1e9 kN/m3 times the rounding of 3 m, far more than a millionth of the light load.
    text = """&scene name = 'tied' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 1 r_cells = 4 z = 0, 1 z_cells = 4 /
&elastic name = 'm' young = 1e4 poisson = 0.25 /
&region material = 'm' void_ratio = 0 /
&stage name = 'one' analysis = 'static' duration = 1 dt = 1 /
&plate name = 'p' group = 'top' penalty = 1e9 motion = 'plane' mass = 1 center = 0.5, 1 inertia = 1 /
&fix group = 'p' field = 'u_z' /
&fix group = 'p' field = 'rotation' /
&fix group = 'bottom' field = 'u_r' value = {} /
&load group = 'right' kind = 'pressure' value = 1e-3 /
"""
    for way, tolerance in ((3, 1e-6), (0.01, 1e-9)):
        if ran(f"tied_{way}", text.format(way), "--set", f"stage.tolerance={tolerance}"):
            steps = tables.numbers(work / f"tied_{way}/ledger.csv")
            check(f"tied_{way}: in one step", len(steps) == 1, len(steps))


SHEARED = """&scene name = 'sheared' geometry = 'plane_strain' fields = 'u-p_w' gravity = 9.81 /
&mesh r = 0, 0.4 r_cells = 1 z = -2, 0 z_cells = 2 /
&mud name = 'sand' e_0 = 0.75 tangent = 3 /
&permeability name = 'k' intrinsic = 2e-12 law = 'constant' /
&region material = 'sand' permeability = 'k' /
&initial p_w_slope = -9.81 stress = 'geostatic' surcharge = 40 k_0 = 0.5 /
&history name = 's' times = 0, 1, 2 values = 0, 1, 0 /
&stage name = 'shear' analysis = 'quasi_static' duration = 0.2 /
&tie first = 'left' second = 'right' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'top' field = 'p_w' /
&load group = 'top' kind = 'pressure' value = 40 /
&load group = 'top' kind = 'shear_r' value = 6 history = 's' /
&point name = 'top' r = 0 z = 0 /
"""


@at_length
def test_a_tighter_accuracy_ends_no_run_that_a_looser_one_carries():
    # The first step of a flow is the square of the accuracy, 1e-8 of the stage at 1e-4: rates of strain are then what
    # rounding leaves of displacements, divided by 2e-9 s.
    answers = {}
    for accuracy in ("1e-2", "1e-3", "1e-4"):
        if ran(f"sheared_{accuracy}", SHEARED, "--step-tolerance", accuracy):
            answers[accuracy] = tables.columns(work / f"sheared_{accuracy}/histories.csv")["top.u_r"][-1]
    check("all three end, and agree to the looser one", len(answers) == 3 and np.ptp(list(answers.values()))
          < 1e-2 * abs(answers["1e-4"]), answers)


# A sudden load on part of ground that cannot drain in a step.
SUDDEN = """&scene name = 'sudden' fields = 'u-p_w' {pressures} /
&mesh r = 0, 1, 5 r_cells = 4, 5 r_ratio = 1, 1.5 z = -5, 0 z_cells = 8 z_ratio = 0.75 /
&elastic name = 'soil' young = 2e4 poisson = 0.2 /
&permeability name = 'k' intrinsic = 2e-13 law = 'constant' /
&region material = 'soil' void_ratio = 0.7 permeability = 'k' /
&stage name = 'load' analysis = 'quasi_static' duration = 5e-3 dt = 1e-3 steps = 'given' /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_w' /
&load group = 'top_1' kind = 'pressure' value = 50 /
"""


def test_pressures_are_linear_unless_a_scene_asks_for_quadratic_ones():
    for name, pressures, said in (("default", "", False), ("linear", "pressures = 'linear'", False),
                                  ("quadratic", "pressures = 'quadratic'", True)):
        done = start(name, SUDDEN.format(pressures=pressures))
        check(f"{name} runs", done.returncode == 0, done.stderr)
        check(f"{name}: alternating pressures told {said}, with what helps", said == (
            "alternate from node to node" in done.stderr and "set pressures = 'linear'" in done.stderr), done.stderr)
        nodes = tables.columns(work / name / "nodes_load.csv")
        on_axis = nodes["p_w"][(nodes["r"] < 1e-9) & (nodes["z"] < 0)]
        # Compression below a load makes no suction; quadratic pressures that alternate do.
        check(f"{name}: suction under a load {said}", (on_axis.min() < -1) == said, on_axis)
    same = [(work / name / "nodes_load.csv").read_bytes() for name in ("default", "linear")]
    check("linear is the default", same[0] == same[1])


# A plate of 0.3 m on sand with water 0.15 m below its surface, half an hour of rain, then half a pulse.
WET = """&scene name = 'wet' fields = 'u-p_w-p_c' gravity = 9.81 step_tolerance = 1e-2 /
&mesh r = 0, 0.15, 1 r_cells = 2, 3 r_ratio = 1, 1.5 z = -1, -0.3, 0 z_cells = 2, 4 z_ratio = 0.76, 0.9 /
&mud name = 'sand' file = '{root}/drivers/materials/toyoura.nml' /
&permeability name = 'k' intrinsic = 1e-11 /
&region material = 'sand' retention = 'mud' permeability = 'k' rho_s = 2.65 void_ratio = 0.78 /
&initial p_w = -1.4715 p_w_slope = -9.81 p_c = 1.4715 p_c_slope = 9.81 stress = 'geostatic' k_0 = 0.5 /
&history name = 'pulse' times = 1802, 1802.008, 1802.016 values = 0, 1, 0 /
&plate name = 'plate' r = 0, 0.15 mass = 0.015 weight = 'yes' force = -6 history = 'pulse' /
&contact name = 'face' slave = 'top' master = 'plate' stages = 'seat', 'impact' /
&stage name = 'geostatic' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-8 zero_displacements = 'yes' /
&stage name = 'rain' analysis = 'quasi_static' duration = 1800 /
&stage name = 'seat' analysis = 'static' duration = 1 dt = 1 max_iterations = 50 /
&stage name = 'impact' analysis = 'dynamic' duration = 0.009 {steps} /
&fix group = 'plate' field = 'u_z' hold = 'yes' stages = 'geostatic', 'rain' /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_a' /
&load group = 'top' kind = 'rain' value = 4e-6 stages = 'rain' /
&point name = 'centre' r = 0 z = 0 /
"""


def test_a_wet_surface_bears_an_impact():
    # Where the last air leaves the pores the suction has no balance that holds it, and the air's a double root.
    deepest = {}
    for name, steps in (("chosen", ""), *(() if light else (("given", "dt = 1e-4 steps = 'given'"),))):
        if ran(f"wet_{name}", WET.format(root=root, steps=steps)):
            histories = tables.columns(work / f"wet_{name}/histories.csv")
            deepest[name] = histories["centre.u_z"].min()
            check(f"{name}: hundreds of steps, not thousands", len(histories["time"]) < 1000, len(histories["time"]))
    if not light:
        check("chosen and given steps agree", len(deepest) == 2
              and abs(deepest["chosen"] / deepest["given"] - 1) < 0.02, deepest)


# Rain on dry sand above a closed base, in a rigid skeleton: all of it stays in the pores.
DRY = """&scene name = 'dry' geometry = 'plane_strain' fields = 'u-p_w-p_c' gravity = 9.81 /
&mesh r = 0, 0.2 r_cells = 1 z = -0.9, 0 z_cells = 30 /
&elastic name = 'sand' young = 1e5 poisson = 0.3 /
&retention name = 'curve' law = 'van_genuchten' alpha = 1.2 n = 4 s_min = 0.04 /
&permeability name = 'k' intrinsic = 8e-12 law = 'corey' b = 4 floor = 1e-6 s_min = 0.04 /
&region material = 'sand' void_ratio = 0.65 permeability = 'k' retention = 'curve' /
&initial p_w = -18 p_c = 18 /
&stage name = 'rest' analysis = 'quasi_static' duration = 1e-6 dt = 1e-6 steps = 'given' /
&stage name = 'rain' analysis = 'quasi_static' duration = 600 dt = 6 steps = 'given' /
&fix group = 'all' field = 'u_r' /
&fix group = 'all' field = 'u_z' /
&fix group = '{aired}' field = 'p_a' /
&load group = 'top' kind = 'water' value = 1.2e-5 stages = 'rain' /
"""


def water_gained(name):
    """Water that the rain has left in the pores [m3]."""
    volumes = []
    for stage in ("rest", "rain"):
        at = tables.columns(work / name / f"points_{stage}.csv")
        volumes.append(np.sum(at["weight"] * at["e"] / (1 + at["e"]) * at["S_w"]))
    return volumes[1] - volumes[0]


@pytest.mark.parametrize("aired", ["all", "top"])
def test_rain_on_dry_sand_stays_there(aired):
    # Suctions of dry sand are steep, and air flows a thousand times as easily as water: what its gradients of p_w and
    # p_c would move, if they did not cancel, is no measure of the water's balance.
    if ran(f"dry_{aired}", DRY.format(aired=aired)):
        share = water_gained(f"dry_{aired}") / (1.2e-5 * 0.2 * 600)
        check(f"air at {aired}: the water that has entered is there", abs(share - 1) < 2e-3, share)


# A column through which air is pressed upwards while a little water enters at its top.
BLOWN = """&scene name = 'blown' geometry = 'plane_strain' fields = 'u-p_w-p_c' /
&mesh r = 0, 0.3 r_cells = 1 z = -1, 0 z_cells = 12 /
&elastic name = 'sand' young = 1e5 poisson = 0.3 /
&retention name = 'curve' law = 'van_genuchten' alpha = 0.3 n = 3 /
&permeability name = 'k' intrinsic = 1e-12 /
&region material = 'sand' void_ratio = 0.6 permeability = 'k' retention = 'curve' /
&initial p_w = -10 p_c = 10 /
&stage name = 'rest' analysis = 'quasi_static' duration = 1e-6 dt = 1e-6 steps = 'given' /
&stage name = 'rain' analysis = 'quasi_static' duration = 8e4 tolerance = {tolerance} /
&fix group = 'all' field = 'u_r' /
&fix group = 'all' field = 'u_z' /
&fix group = 'top' field = 'p_a' /
&fix group = 'bottom' field = 'p_a' value = 60 stages = 'rain' /
&load group = 'top' kind = 'water' value = 1e-8 stages = 'rain' /
"""


def test_a_flow_of_air_hides_no_water():
    # Newton's method solves the sum of both balances, nearly all of it the air's: the water has an error of its own.
    for tolerance in ("1e-3", "1e-4"):
        name = f"blown_{tolerance}"
        done = start(name, BLOWN.format(tolerance=tolerance))
        check(f"{name} runs", done.returncode == 0, done.stderr)
        share = water_gained(name) / (1e-8 * 0.3 * 8e4)
        check(f"{name}: the water that has entered is there", abs(share - 1) < 2e-3, share)
        check(f"{name}: no loss is told", "m3 of water" not in done.stderr, done.stderr)


@at_length
@pytest.mark.parametrize("aired", ["all", "top"])
def test_water_drawn_from_a_surface_is_missing_below(aired):
    # The surface dries to suctions of 1e4 kPa, thousands of times those that hold the water below. Changes of pressure
    # that are small beside the former are none that Newton's method may leave.
    drawn = DRY.format(aired=aired).replace("alpha = 1.2 n = 4", "alpha = 0.4 n = 3").replace(
        "value = 1.2e-5", "value = -1e-6").replace("duration = 600 dt = 6 steps = 'given'", "duration = 9e4").replace(
        "p_w = -18 p_c = 18", "p_w = -1.5 p_c = 1.5")
    if ran(f"drawn_{aired}", drawn):
        share = water_gained(f"drawn_{aired}") / (-1e-6 * 0.2 * 9e4)
        check(f"air at {aired}: what has left is missing", abs(share - 1) < 2e-3, share)


STAMP = """&scene name = 'stamp' geometry = 'axisymmetric' fields = 'u' /
&mesh r = 0, 0.15, 0.5 r_cells = 3, 3 z = {base}, {top} z_cells = 4 /
&elastic name = 'soil' young = 1e4 poisson = 0.25 /
&region material = 'soil' void_ratio = 0 /
&plate name = 'p' r = 0, 0.15 z = {z} mass = 1e-5 force = -{load} /
&contact name = 'c' slave = 'top' master = 'p' penalty = {penalty} /
&stage name = 's' analysis = 'static' duration = 1 dt = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'bottom' field = 'u_r' /
"""


def stamped(name, height, overlap, load, penalty):
    """Thrust of a loaded plate [kN], None where no answer was found, and what was said."""
    done = start(name, STAMP.format(base=height - 0.5, top=height, z=height - overlap, load=load, penalty=penalty))
    if done.returncode:
        return None, done.stderr
    return float(tables.rows(work / name / "contact.csv")[-1]["c.thrust"]), done.stderr


def test_what_fades_over_a_stage_is_no_measure_of_its_error():
    # An overlap of 1 to 10 micrometres at a penalty of 1e11 to 1e13 kN/m3 presses with up to 1e6 kN until the first
    # step is solved, and is spread over the stage where it is not: an answer is that of the load of 5 kN, or none.
    found = 0
    for penalty in (1e11, 1e12, 1e13):
        for overlap in (1e-6, 1e-5):
            thrust, _ = stamped(f"stamp_{penalty:g}_{overlap:g}", 0.0, overlap, 5.0, penalty)
            found += thrust is not None
            check(f"penalty {penalty:g}, overlap {overlap:g}: the load or nothing", thrust is None or
                  abs(thrust/5 - 1) < 1e-3, thrust)
    check("two of them are found", found >= 2, found)


def test_contact_forces_that_are_rounding_are_told():
    # At z = 10 km places have a rounding of 2e-12 m: 2e-4 kPa at a penalty of 1e8 kN/m3, of pressures of 0.03 kPa.
    for height, load, told in ((0.0, 2e-3, False), (1e4, 5.0, False), (1e4, 2e-3, True)):
        thrust, said = stamped(f"far_{height:g}_{load:g}", height, 1e-9, load, 1e8)
        check(f"{load} kN at {height} m: {thrust} kN, told {told}", thrust is not None and
              ("may be rounding" in said) == told, said)
        check(f"{load} kN at {height} m: right, or told", told or abs(thrust/load - 1) < 1e-3, thrust)
