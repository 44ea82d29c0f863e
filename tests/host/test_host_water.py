# SPDX-License-Identifier: MIT
"""Water that mud_host stores against what goes through its boundaries: no step loses any."""
import os
import re
import subprocess

import h5py

from checking import at_length, build, check, work
import tables  # noqa: E402

environment = {**os.environ, "OMP_NUM_THREADS": "1"}
VOID, HEIGHT, AREA = 0.8, 1.0, 0.1
ALPHA, N = 0.05, 3.0
COLUMN = f"""&scene name = 'w' geometry = 'plane_strain' fields = 'u-p_w-p_c' /
&mesh r = 0, {AREA} r_cells = 1 z = 0, {HEIGHT} z_cells = 8 /
&elastic name = 'soil' young = 1e6 poisson = 0.2 /
&retention name = 'curve' law = 'van_genuchten' alpha = {ALPHA} n = {N} /
&permeability name = 'k' intrinsic = 1e-12 law = 'mualem' m = 0.6667 /
&region material = 'soil' void_ratio = {VOID} permeability = 'k' retention = 'curve' /
&initial p_w = -10 p_c = 10 /
&stage name = 'draw' analysis = 'quasi_static' duration = 1e5 tolerance = 1e-7 max_iterations = 40 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_a' /
&load group = 'top' kind = 'water' value = -1e-6 /
&point name = 'top' r = 0 z = {HEIGHT} /
"""


def run(name, text, *words):
    """Folder of a run, and its standard error."""
    scene = work / f"{name}.nml"
    scene.write_text(text)
    done = subprocess.run([build / "host/mud_host", scene, "--output", work / name, "--quiet", *words],
                          capture_output=True, text=True, env=environment)
    check(f"{name}: runs to its end", done.returncode == 0, done.stderr)
    return work / name, done.stderr


def lost(folder, drawn, saturation=(1 + (ALPHA*10)**N)**(1/N - 1), points="points_draw.csv"):
    """Share of the water drawn from the top that is not missing inside, once what came through supports is known."""
    gone = sum(p["weight"]*(VOID*saturation - p["e"]*p["S_w"]) for p in tables.numbers(folder/points))/(1 + VOID)
    last = tables.numbers(folder/"ledger.csv")[-1]
    return abs(drawn + last["outflow"] - last["outflow_air"] - gone)/drawn


def test_no_water_is_lost_in_the_first_step_of_a_flow():
    # Five equal steps: with a rate of zero before the first, half a step of ten are never stored, a tenth.
    for rho_inf in (0, 0.8):
        folder, _ = run(f"five_{rho_inf}", COLUMN, "--set", "stage.dt=2e4", "--set", "stage.steps=given",
                        "--set", f"stage.rho_inf={rho_inf}")
        share = lost(folder, 1e5*1e-6*AREA)
        check(f"rho_inf {rho_inf}: water drawn in five steps is missing inside", share < 1e-4, share)
    # A first step over the whole stage, which no error is known of, would lose a third.
    folder, _ = run("one", COLUMN, "--set", "stage.dt=1e5")
    share = lost(folder, 1e5*1e-6*AREA)
    check("so is what is drawn in one controlled step", share < 1e-4, share)


@at_length
def test_what_came_through_a_support_is_stored_whatever_the_steps():
    # Drawn beyond what the ground lets through: the top dries, and the flow from below changes in steps that differ by
    # orders. Steps times flows at their ends leave 6e-4 and 2e-4 of it, what is stored Newton's tolerance.
    text = COLUMN.replace("&load", "&fix group = 'bottom' field = 'p_w' hold = 'yes' /\n&load").replace(
        "alpha = 0.05", "alpha = 0.5")
    for tolerance in (1e-2, 1e-3):
        folder, _ = run(f"through_{tolerance}", text, "--step-tolerance", str(tolerance))
        share = lost(folder, 1e5*1e-6*AREA, (1 + 5**N)**(1/N - 1))
        check(f"accuracy {tolerance}: water balances", share < 1e-5, share)


def told(errors):
    """Volume [m3], share and sign of the water that a run says its stages have lost."""
    return [(float(v), float(s)/100, kind) for v, kind, s in re.findall(
        r"(\S+) m3 of water are (missing|made) in the ground, (\S+) % of what", errors)]


def test_water_that_a_stage_loses_is_told_whatever_lost_it():
    # Small corrections end Newton's method here: the residual that is left is water.
    alpha, n = 0.05, 4
    loose = COLUMN.replace("tolerance = 1e-7", "dt = 1e4 steps = 'given' measure = 'correction' tolerance = 0.1 "
                           "predictor = 'none'").replace(f"alpha = {ALPHA} n = {N}", f"alpha = {alpha} n = {n}")
    folder, errors = run("loose", loose)
    share, said = lost(folder, 1e5*1e-6*AREA, (1 + (alpha*10)**n)**(1/n - 1)), told(errors)
    check("water is lost", share > 0.02, share)
    check("as much is told", len(said) == 1 and abs(said[0][1]/share - 1) < 0.1, (said, share))
    # A restart knows what was lost before it.
    loose = loose.replace("/\n&mesh", "checkpoint_steps = 7 /\n&mesh")
    folder, errors = run("whole", loose)
    _, again = run("whole", loose, "--restart", folder/"checkpoint.h5")
    check("taken up again it tells the same", told(again) == told(errors) != [], (errors, again))
    # Water that moves inside alone, and none at all, are no reason to speak.
    for name, text in (("inside", COLUMN.replace("value = -1e-6", "value = 0").replace("p_w = -10 p_c = 10",
                        "p_w = -10 p_w_slope = 5 p_c = 10 p_c_slope = -5")),
                       ("still", COLUMN.replace("value = -1e-6", "value = 0"))):
        _, errors = run(name, text)
        check(f"{name}: nothing is told", told(errors) == [], errors)


def test_undrained_water_at_rest_does_not_move():
    # Of the pressure of an undrained element what differs from its mean is given, and does not rise.
    text = """&scene name = 'rest' checkpoint_steps = 5 geometry = 'plane_strain' fields = 'u-p_w' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 2 /
&elastic name = 'soil' young = 1e4 poisson = 0.2 /
&region material = 'soil' void_ratio = 0.8 drainage = 'undrained' /
&initial p_w = 10 p_w_slope = -10 /
&stage name = 'wait' analysis = 'quasi_static' duration = 5 dt = 1 steps = 'given' /
&fix group = 'all' field = 'u_r' /
&fix group = 'all' field = 'u_z' /
&point name = 'top' r = 0 z = 1 /
"""
    folder, _ = run("rest", text)
    with h5py.File(folder / "checkpoint.h5") as file:
        moved = file["water_turned"][0]
    check("nothing has moved", 0 < moved < 1e-9*0.8/1.8, moved)


def test_water_that_the_ground_does_not_hold_is_told():
    # The pores give 0.42 m. Of 0.48 m an eighth comes out of water under a tension of gigapascals.
    text = COLUMN.replace(f"alpha = {ALPHA} n = {N}", "alpha = 0.5 n = 3 s_min = 0.05").replace(
        "1e-12 law = 'mualem' m = 0.6667", "8e-12 b = 4 floor = 1e-6 s_min = 0.05").replace(
        "p_w = -10 p_c = 10", "p_w = -1.5 p_c = 1.5").replace("tolerance = 1e-7 ", "").replace(
        "group = 'left' field", "group = 'all' field").replace("'bottom' field = 'u_z'", "'all' field = 'u_z'")
    for name, duration, dry in (("drawn", 3e5, False), ("empty", 4.8e5, True)):
        _, errors = run(name, text.replace("duration = 1e5", f"duration = {duration}"), "--step-tolerance", "1e-2")
        check(f"{name}: told {dry}", ("oven-dry" in errors) == dry, errors)


# Moist ground under rain, of which all enters, is loaded at once, or drawn from at once.
RAINY = """&scene name = 'rainy' geometry = 'plane_strain' fields = 'u-p_w-p_c' gravity = 10 /
&mesh r = 0, 1 r_cells = 2 z = -1, 0 z_cells = 3 /
&elastic name = 'soil' young = 2e4 poisson = 0.3 /
&retention name = 'curve' law = 'van_genuchten' alpha = 0.05 n = 2 /
&permeability name = 'k' intrinsic = 1e-10 /
&region material = 'soil' retention = 'curve' permeability = 'k' void_ratio = 0.7 /
&initial p_w = -10 p_w_slope = -10 p_c = 10 p_c_slope = 10 stress = 'geostatic' surface = 0 surcharge = 10 /
&stage name = 's' analysis = 'quasi_static' duration = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 10 /
&load group = 'top' kind = 'rain' value = 1e-6 ponding = 0.01 /
"""


def test_a_sudden_change_draws_no_water_through_the_surface():
    # What a node gains or loses is stored where its suction changes, the air outside at rest: by a slope without that,
    # rounding of the first iterates held dry nodes at the pressure of a pond, through which litres came in.
    for name, sudden in (("load", "&load group = 'top' kind = 'pressure' value = 20 /\n"),
                         ("draw", "&fix group = 'left' field = 'p_w' value = -3 from = 0.5 /\n")):
        for tolerance in ("1e-2", "1e-3"):
            folder, said = run(f"{name}_{tolerance}", RAINY + sudden, "--step-tolerance", tolerance)
            check(f"{name}, {tolerance}: no node keeps a limit", "left its limit" not in said, said)
            rows = tables.numbers(folder / "reactions_s.csv")
            check(f"{name}, {tolerance}: nothing runs off or comes in", not any(row["top.outflow_w"] for row in rows),
                  min(row["top.outflow_w"] for row in rows))
            if name == "load":
                last = tables.numbers(folder / "ledger.csv")[-1]
                share = (last["outflow_air"] - last["outflow"]) / 1e-6
                check(f"{tolerance}: the rain is what has come in", abs(share - 1) < 1e-3, share)


def test_tied_nodes_have_one_balance_of_water():
    # Sides that are tied have the answers of sides that are held: nodes that share their pressures are counted once,
    # and share the air pressure that one of them is given.
    held = "&fix group = 'left' field = 'u_r' /\n&fix group = 'right' field = 'u_r' /\n"
    tied = "&tie first = 'left' second = 'right' pressures = 'yes' /\n&fix group = 'bottom' field = 'u_r' /\n"
    rain = "&load group = 'top' kind = 'rain' value = 1e-6 ponding = 0.01 /\n"
    for name, load in (("rain", rain), ("air", "&fix group = 'top' field = 'p_a' value = 3 /\n"),
                       ("rain_and_air", rain.replace("top", "top_1") + "&fix group = 'top_2' field = 'p_a' /\n"),
                       ("suction", "&fix group = 'top' field = 'p_c' value = 8 /\n")):
        found = []
        for sides in (held, tied):
            text = RAINY.replace(held, sides).replace(rain, load)
            text = text.replace("r = 0, 1 r_cells = 2", "r = 0, 0.5, 1 r_cells = 1, 1")
            folder, said = run(f"{name}_{sides == tied}", text, "--set", "stage.duration=1e3", "--set", "stage.dt=1e2")
            check(f"{name}: no water is made", "of water are" not in said, said)
            flows = tables.numbers(folder / "reactions_s.csv")[-1].items()
            volumes = tables.numbers(folder / "ledger.csv")[-1]
            found.append([[sum(v for k, v in flows if k.endswith(what)) for what in ("outflow_w", "outflow_a")],
                          [volumes[what] for what in ("outflow", "outflow_air")]])
        for what, one, other in zip(("flows", "volumes"), *found):
            misses = max(abs(a - b) for a, b in zip(one, other))
            check(f"{name}: {what}", misses < 1e-5 * max(map(abs, one)), (one, other))


def test_tied_pressures_that_begin_apart_are_one():
    # Two halves begin with their own water: tied nodes have the same pressures from the start, and keep them.
    text = RAINY[:RAINY.index("&load")].replace("gravity = 10 ", "").replace("r = 0, 1 r_cells = 2",
                                                                           "r = 0, 0.5, 1 r_cells = 1, 1")
    first = next(line for line in text.splitlines() if line.startswith("&initial"))
    halves = [f"&initial group = 'block_{i}_1' p_w = {-5 * i} p_c = {5 * i} /" for i in (1, 2)]
    text = text.replace(first, "\n".join(halves)).replace("&fix group = 'left' field = 'u_r' /\n", "")
    text = text.replace("&fix group = 'right' field", "&fix group = 'all' field")
    text += "&tie first = 'left' second = 'right' pressures = 'yes' /\n"
    text += "&point name = 'left' r = 0 z = 0 /\n&point name = 'right' r = 1 z = 0 /\n"
    folder, _ = run("apart", text, "--set", "stage.duration=1e3", "--set", "stage.dt=1e2")
    for row in tables.numbers(folder / "histories.csv"):
        for field in ("p_w", "p_c"):
            check(f"{field} at {row['time']} s", row[f"left.{field}"] == row[f"right.{field}"], row)


REST = """&scene name = 'rest' geometry = 'plane_strain' fields = 'u-p_w-p_c' gravity = 9.81 /
&mesh r = 0, 0.2 r_cells = 1 z = 0, 1 z_cells = 10 /
&elastic name = 'soil' young = 1e4 poisson = 0.25 /
&retention name = 'r' law = 'van_genuchten' alpha = 0.1 n = 2 /
&permeability name = 'k' intrinsic = 1e-12 /
&region material = 'soil' retention = 'r' permeability = 'k' void_ratio = 0.8 /
&initial water_table = 1 stress = 'geostatic' surface = 1 /
&fix group = 'left' field = 'u_r' / &fix group = 'right' field = 'u_r' / &fix group = 'bottom' field = 'u_z' /
"""


def test_water_at_rest_keeps_no_step_short_and_draws_no_word():
    # A saturated column in balance: a step is met before any correction, whatever holds the pressures. What an air
    # pressure is held by is no residual; what moves is rounding, of which nothing is missing and no face lets any in.
    top = "&fix group = 'top' field = 'p_w' {} /\n"
    for name, fixes, dt in (("water", top + top.replace("p_w", "p_c"), ""),
                            ("air", top + "&fix group = 'bottom' field = 'p_a' /\n", ""),
                            ("face", top.replace("{}", "kind = 'seepage'"), "dt = 1000")):
        stage = f"&stage name = 'rest' analysis = 'quasi_static' duration = 1e5 {dt} /\n"
        folder, errors = run(f"rest_{name}", REST + fixes.format("", "") + stage)
        steps = len(tables.columns(folder / "ledger.csv")["time"])
        check(f"{name}: steps grow to a share of the stage", steps <= 100, steps)
        check(f"{name}: no word", errors == "", errors)


def test_what_holds_an_air_pressure_is_no_residual():
    # Air flows through a column at a suction of 20 kPa from 5 to 0 kPa: with another measure of the error the same.
    ends = []
    for measure in ("auto", "residual"):
        folder, _ = run(f"blown_{measure}", REST.replace("water_table = 1", "p_w = -20 p_c = 20") + f"""
&fix group = 'top' field = 'p_a' value = 5 / &fix group = 'bottom' field = 'p_a' / &point name = 'base' r = 0 z = 0 /
&stage name = 'blow' analysis = 'quasi_static' duration = 1e4 dt = 1000 measure = '{measure}' max_iterations = 20 /
""")
        ends.append(tables.columns(folder / "histories.csv")["base.p_w"][-1])
    check("both measures find one water pressure", abs(ends[1] - ends[0]) < 1e-3*abs(ends[0]), ends)
