# SPDX-License-Identifier: MIT
"""What people read from a run of mud_host: reactions, flow and thrust of every group against statics and Darcy; loads
and supports that change with z; retention from files; a run that goes on with more stages or for longer."""
import os
import subprocess

import numpy as np

from checking import build, check, root, work
import tables  # noqa: E402 (checking knows its folder)

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}
ROUNDING = 1e-9   # of linear problems with hundreds of unknowns, at a Newton tolerance of 1e-12

# Two by three metres of saturated soil in plane strain, G = 4000 kPa.
BLOCK = """&scene name = 'block' geometry = 'plane_strain' fields = '{fields}' gravity = {gravity} {more} /
&mesh r = 0, 2 r_cells = 2 z = 0, 3 z_cells = 3 /
&elastic name = 'soil' young = 1.0e4 poisson = {poisson} /
&fluids k_w = 1e15 k_a = 1e15 eta_a = 2e-8 /
&permeability name = 'k' intrinsic = 2.0e-10 law = 'constant' floor = 0 /
&region material = 'soil' void_ratio = 1 permeability = 'k' /
&stage name = 's' analysis = '{analysis}' duration = 1 dt = {dt} tolerance = 1e-11 rho_inf = 0 /
&point name = 'corner' r = 2 z = 3 /
&point name = 'foot' r = 2 z = 0 /
"""


def block(fields="u", gravity=0, poisson=0.25, analysis="static", dt=1, more=""):
    return BLOCK.format(**locals())


def start(text, name, *words):
    scene, folder = work / f"{name}.nml", work / name
    scene.write_text(text)
    return subprocess.run([host, scene, "--output", folder, "--quiet", *words], capture_output=True, text=True,
                          env=environment), folder


def run(text, name, *words):
    """Its folder."""
    done, folder = start(text, name, *words)
    check(f"{name} runs", done.returncode == 0, done.stderr)
    return folder


def last(folder, table="reactions_s.csv"):
    return tables.numbers(folder / table)[-1]


def near(what, value, wanted, size=1.0):
    check(what, abs(value - wanted) <= ROUNDING * max(abs(wanted), size), f"{value} for {wanted}")


# Statics: weight, a pressure that grows downwards as that of water, and shear. Each corner has two supports, and what
# holds it is counted once.
HELD = "&fix group = 'left' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /\n" \
    "&fix group = 'bottom' field = 'u_r' /\n"

# A metre of soil of k/eta_w 2e-4 m2/(kPa s), water of 10 kPa/m, the pressure at its base given, at rest after 1e6 s.
# What follows is Darcy's law over one metre: the flow is 2e-4 times the difference of p_w + 10 z.
COLUMN = """&scene name = 'column' geometry = 'plane_strain' fields = '{fields}' pressures = 'quadratic' gravity = 10 /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'soil' young = 1.0e4 poisson = 0.25 /
&fluids k_w = 1e15 /
&permeability name = 'k' intrinsic = 2.0e-10 law = 'constant' floor = 0 /
&region material = 'soil' void_ratio = 1 permeability = 'k' {retention} /
&stage name = 's' analysis = 'quasi_static' duration = 1e6 dt = 1e6 tolerance = 1e-9 rho_inf = 0 /
&fix group = 'all' field = 'u_r' /
&fix group = 'all' field = 'u_z' /
&fix group = 'bottom' field = 'p_w' value = {base} /
&initial p_w_slope = -10 {suction} /
"""
FACE = "&fix group = 'top' field = 'p_w' kind = 'seepage' {} /\n"
RAIN = "&load group = 'top' kind = 'rain' value = {} {} /\n"
SIDES = (   # what acts on top, pressure at the base; flow out of the top and the base, nodes at the limit
    ("a face that water leaves", FACE.format(""), 25, 2e-4 * (25 - 10), -3e-3, 3),
    ("a face that lets none in", FACE.format(""), 4, 0, 0, 0),
    ("a face below 0.5 m of water", FACE.format("value = 5"), 25, 2e-4 * (25 - 15), -2e-3, 3),
    ("rain that enters", RAIN.format(1e-3, ""), 4, 0, 1e-3, 0),
    ("rain that runs off", RAIN.format(2e-3, ""), 4, 2e-3 - 2e-4 * (10 - 4), 1.2e-3, 3),
    ("rain on a pond of 0.2 m", RAIN.format(2e-3, "ponding = 0.2"), 4, 2e-3 - 2e-4 * (12 - 4), 1.6e-3, 3),
    ("rain that fills no pond of 0.5 m", RAIN.format(2e-3, "ponding = 0.5"), 4, 0, 2e-3, 0),
    ("rain where water rises", RAIN.format(1e-3, ""), 25, 1e-3 + 3e-3, -3e-3, 3),
    ("rain on a face: the lower limit", RAIN.format(2e-3, "ponding = 0.5") + FACE.format(""), 4, 0.8e-3, 1.2e-3, 3),
)


def test_the_weight_is_that_of_6_m2():
    folder = run(
        block(gravity=10) +HELD +
        "&load group = 'right' kind = 'pressure' value = 0 value_slope = -10 datum = 3 /\n"
        "&load group = 'top' kind = 'shear_r' value = 7 /\n&load group = 'top' kind = 'pressure' value = 5 /\n",
        "statics")
    row = last(folder)
    near("thrust of water, 10 kPa/m over 3 m: to the left", row["right.load_r"], -45.0)
    near("loads of one group in one column", row["top.load_r"], 14.0)
    near("and in the other", row["top.load_z"], -10.0)
    near("supports along r hold what acts", row["left.force_r"] + row["bottom.force_r"], 45.0 - 14.0)
    points = tables.numbers(folder / "points_s.csv")
    weight = 10 * 2.65 * sum(p["weight"] / (1 + p["e"]) for p in points)
    near("the base carries weight and load", row["bottom.force_z"], weight + 10.0)
    check("the weight is that of 6 m2", abs(weight - 0.5 * 2.65 * 6 * 10) < 0.01 * weight, weight)
    near("forces of a static stage are those of its end", row["time_of_forces"], row["time"])
    check("a column a group and direction", list(row) == [
        "time", "time_of_forces", "left.force_r", "bottom.force_z", "bottom.force_r", "right.load_r", "right.load_z",
        "top.load_r", "top.load_z"], list(row))
    row = last(run(block().replace("'plane_strain'", "'axisymmetric'") + HELD
                   + "&load group = 'right' kind = 'pressure' value = 2 value_slope = 1 datum = 1 /\n", "ring"))
    near("around the axis: 2 pi R times the integral of 1 + z", row["right.load_r"], -2 * np.pi * 2 * (3 + 4.5))
    row = last(run(block() + HELD + "&load group = 'right' kind = 'force_z' value = -1 value_slope = -2 datum = 3 /\n",
                   "forces"))
    near("forces on nodes at heights of 0, 0.5 .. 3", row["right.load_z"], -sum(1 + 2 * (z / 2 - 3) for z in range(7)))


def test_a_load_that_varies_along_an_edge_bends():
    # nu = 0 and a pressure linear in z: u_r = -r p/E, u_z = r^2 slope/(2 E) solve the equations exactly.
    text = block(poisson=0) + ("&load group = 'right' kind = 'pressure' value = 20 value_slope = -6 datum = 1 /\n"
                               "&fix group = 'left' field = 'u_r' /\n&fix group = 'left' field = 'u_z' /\n")
    row = last(run(text, "bending"), "histories.csv")
    near("where the load is smaller", row["corner.u_r"], -2 * (20 - 6 * 2) / 1e4, 1e-3)
    near("where the load is larger", row["foot.u_r"], -2 * (20 + 6) / 1e4, 1e-3)
    near("and the block bends", row["corner.u_z"], -6 * 4 / 2e4, 1e-3)


def test_water_at_rest_does_not_flow():
    # A support linear in z: simple shear, u_r = 1e-3 + 2e-3 z; and the pressure of water at rest, which does not flow.
    row = last(run(block() + "&fix group = 'all' field = 'u_r' value = 1e-3 value_slope = 2e-3 datum = 0 /\n"
                   "&fix group = 'all' field = 'u_z' /\n", "shear"), "histories.csv")
    near("prescribed along a line", row["corner.u_r"], 7e-3, 1e-3)
    near("a strain of 2e-3 times G", row["corner.s_rz"], 4000 * 2e-3)
    still = block("u-p_w", 10, analysis="quasi_static", dt=0.5) + (
        "&fix group = 'all' field = 'u_r' /\n&fix group = 'all' field = 'u_z' /\n"
        "&initial p_w = 30 p_w_slope = -10 /\n&fix group = 'left' field = 'p_w' value_slope = -10 datum = 3 /\n"
        "&fix group = 'right' field = 'p_w' value = {} value_slope = -10 datum = 3 /\n")
    row = last(run(still.format(0), "rest"))
    check("water at rest does not flow", abs(row["left.outflow_w"]) + abs(row["right.outflow_w"]) < 1e-12, row)
    row = last(run(still.format(8), "flow"))
    near("Darcy: k/eta_w times 8 kPa over 2 m, height of 3 m", row["left.outflow_w"], 2e-4 * 8 / 2 * 3, 1e-6)
    near("and in on the other side", row["right.outflow_w"], -2e-4 * 8 / 2 * 3, 1e-6)
    folder = run(still.format(0).replace("&fix group = 'right' field = 'p_w' value = 0 value_slope = -10 datum = 3 /",
                                         "&load group = 'right' kind = 'water' value = 1e-4 value_slope = 2e-5 /"),
                 "inflow")
    near("an inflow linear in z comes out again", last(folder)["left.outflow_w"], 3 * 1e-4 + 4.5 * 2e-5, 1e-6)
    near("and has a column", last(folder)["right.inflow_w"], 3 * 1e-4 + 4.5 * 2e-5, 1e-6)
    for fields, retention, suction in (("u-p_w", "", ""), ("u-p_w-p_c", "retention = 'flat'", "p_c_slope = 10")):
        text = COLUMN
        if retention:
            text += "&retention name = 'flat' law = 'table' suction = 0, 1e6 saturation = 0.6, 0.6 /\n"
        for number, (what, acts, base, top, bottom, nodes) in enumerate(SIDES):
            if retention and "0.5 m" in what:
                continue   # its gas would have to be compressed, which takes longer
            folder = run(text.format(**locals()) + acts, f"side_{len(fields)}_{number}")
            row = last(folder)
            near(f"{what}, {fields}: out of the top", row["top.outflow_w"], top, 1e-3)
            near(f"{what}, {fields}: out of the base", row["bottom.outflow_w"], bottom, 1e-3)
            check(f"{what}, {fields}: nodes at the limit", row["top.at_limit"] == nodes, row)
            ledger = last(folder, "ledger.csv")
            near(f"{what}, {fields}: what runs off never entered", ledger["outflow"] - ledger["outflow_air"], 0, 1e3)


def test_water_into_a_drained_region_is_not_that_of_a_support_of_the_air():
    # Half a metre of coupled soil above drained ground, p_w at its top 5 kPa above rest; p_a is given
    # everywhere, where it asks for air alone. Darcy: 2e-4 times 5 kPa over half a metre.
    text = """&scene name = 'column' geometry = 'plane_strain' fields = 'u-p_w-p_c' gravity = 10 /
&mesh r = 0, 1 r_cells = 1 z = 0, 0.5, 1 z_cells = 1, 1 /
&elastic name = 'soil' young = 1.0e4 poisson = 0.25 /
&fluids k_w = 1e15 /
&retention name = 'flat' law = 'table' suction = 0, 1e6 saturation = 0.6, 0.6 /
&permeability name = 'k' intrinsic = 2.0e-10 law = 'constant' floor = 0 /
&region material = 'soil' void_ratio = 1 permeability = 'k' retention = 'flat' /
&region group = 'block_1_1' material = 'soil' void_ratio = 1 retention = 'flat' drainage = 'drained' /
&stage name = 's' analysis = 'quasi_static' duration = 1e6 dt = 1e6 tolerance = 1e-9 rho_inf = 0 /
&fix group = 'all' field = 'u_r' /
&fix group = 'all' field = 'u_z' /
&fix group = 'top' field = 'p_w' value = -5 /
&fix group = 'all' field = 'p_a' /
&initial p_w_slope = -10 p_c_slope = 10 /
"""
    row = last(run(text, "drained"))
    near("the support of the water lets it in", row["top.outflow_w"], -2e-4 * 5 / 0.5, 1e-3)
    near("that of the air none out", row["all.outflow_w"], 0, 1e-3)
    check("and takes all of the air", row["top.outflow_a"] == 0, row)
    # Weight moves water and air: on a face where the water may leave, air is that of its support.
    seeps = text.replace("p_w_slope = -10 p_c_slope = 10", "p_w = -5 p_c = 15").replace(
        "drainage = 'drained' /", "permeability = 'k' /").replace("value = -5", "kind = 'seepage'")
    row = last(run(seeps.replace("1e6 dt = 1e6", "10 dt = 10"), "seeping"))
    check("nor does a seepage face take it", row["top.outflow_a"] == 0 and row["all.outflow_a"] != 0, row)


def test_a_pressure_that_follows_from_two_others_has_no_limit():
    # p_a = 0 and p_c = 6 kPa of the top ask for p_w = -6 kPa there, below the limit of a face and above water at rest:
    # Darcy's 2e-4 times 4 kPa go in, whether a face or rain would let go of p_w or not. Rain has no part in it.
    text = COLUMN.format(fields="u-p_w-p_c", retention="retention = 'flat'", suction="p_c_slope = 10", base=0) + \
        "&retention name = 'flat' law = 'table' suction = 0, 1e6 saturation = 0.6, 0.6 /\n" \
        "&fix group = 'top' field = 'p_a' /\n&fix group = 'top' field = 'p_c' value = 6 /\n"
    for name, acts, off in (("face", FACE.format(""), 0), ("rain", RAIN.format(1e-3, ""), 1e-3)):
        folder = run(text + acts, f"follows_{name}")
        row = last(folder)
        near(f"beside {name}: into the top", row["top.outflow_w"], off - 8e-4, 1e-3)
        near(f"beside {name}: out of the base", row["bottom.outflow_w"], 8e-4, 1e-3)
        check(f"beside {name}: no node has a limit", row["top.at_limit"] == 0, row)
        top = {node["p_w"] for node in tables.numbers(folder / "nodes_s.csv") if node["z"] == 1}
        check(f"beside {name}: p_w follows", len(top) == 1 and abs(top.pop() + 6) < 1e-12, top)


def test_rain_counts_per_horizontal_area():
    # Rain counts per horizontal area: none falls on a wall, none from below.
    row = last(run(COLUMN.format(fields="u-p_w", retention="", suction="", base=4)
                   + RAIN.format(1e-3, "").replace("'top'", "'right'") + RAIN.format(1e-3, ""), "wall"))
    near("no rain on a wall", row["right.inflow_w"], 0, 1e-3)
    near("all of it on what is level", row["top.inflow_w"], 1e-3, 1e-3)


def test_the_storm_wets_and_dries():
    # Taken up between two steps, while the face of rain turns from one side to the other: the same bytes.
    storm = COLUMN.format(fields="u-p_w", retention="", suction="", base=4) \
        .replace("gravity = 10", "gravity = 10 checkpoint_steps = 9") \
        .replace("duration = 1e6 dt = 1e6", "duration = 16 dt = 1").replace("k_w = 1e15", "k_w = 1e3") + \
        RAIN.format(2e-3, "history = 'h'") + "&history name = 'h' times = 0, 4, 10, 12, 16 values = 0, 1, 0, 1, 1 /\n"
    folder = run(storm, "storm")
    limits = [row["top.at_limit"] for row in tables.numbers(folder / "reactions_s.csv")]
    check("the storm wets and dries", limits[8:9] != limits[-1:] and len(set(limits)) > 1, limits)
    kept = {path.name: path.read_bytes() for path in folder.glob("*.csv")}
    done, _ = start(storm, "storm", "--restart", folder / "checkpoint.h5")
    check("storm: taken up", done.returncode == 0, done.stderr)
    check("storm: the same bytes", all((folder / name).read_bytes() == content for name, content in kept.items()))


def test_friction_is_taken_up_while_a_block_is_stopped():
    incline = (root / "verification/host/friction/incline.nml").read_text() \
        .replace("'incline.msh'", f"'{root}/verification/host/friction/incline.msh'") \
        .replace("gravity = 10", "gravity = 10 checkpoint_steps = 28").replace("duration = 0.1 ", "duration = 0.01 ") \
        .replace("duration = 0.2 ", "duration = 0.006 ")
    folder = run(incline, "incline")
    check("it slides at the end", last(folder, "contact.csv")["b.sliding"] == 9)
    kept = {path.name: path.read_bytes() for path in folder.glob("*.csv")}
    done, _ = start(incline, "incline", "--restart", folder / "checkpoint.h5")
    check("incline: taken up", done.returncode == 0, done.stderr)
    check("incline: the same bytes", all((folder / name).read_bytes() == content for name, content in kept.items()))
    for key in ("friction = -1", "cohesion = -1", "tangential_penalty = -1"):
        done, _ = start(incline.replace("tangential_penalty = 1e7 ", "").replace("friction = 0.2", key), "refused")
        check(f"{key}: refused", done.returncode == 2 and key.split()[0] in done.stderr, done.stderr)


def test_refused():
    # What contradicts itself is refused.
    for what, acts, words in (
            ("a face of another field", "&fix group = 'top' field = 'u_z' kind = 'seepage' /", "needs field = 'p_w'"),
            ("a face that is held", FACE.format("hold = 'yes'"), "not hold"),
            ("rain that falls upwards", RAIN.format(-1e-3, ""), "it becomes -0.001 m/s"),
            ("rain whose history is negative", RAIN.format(1e-3, "history = 'h'")
             + "&history name = 'h' times = 0, 1 values = 1, -2 /", "it becomes -0.002 m/s"),
            ("a pond without weight", RAIN.format(1e-3, "ponding = 0.1"), "without gravity"),
            ("a pond of negative depth", RAIN.format(1e-3, "ponding = -0.1"), "ponding"),
            ("rain without water", RAIN.format(1e-3, ""), "no field"),
            ("a flow that is subtracted", FACE.format(""), "initial_flow"),
            ("rain on a flow that is subtracted", RAIN.format(1e-3, ""), "initial_flow")):
        text = COLUMN.format(fields="u" if "without water" in what else "u-p_w",
                             retention="", suction="", base=4) + acts
        if "without water" in what:
            text = text.replace("&fix group = 'bottom' field = 'p_w' value = 4 /", "")
        text = text.replace("gravity = 10", "gravity = 0" if "without weight" in what else
                            "gravity = 10 initial_flow = 'subtract'" if "subtracted" in what else "gravity = 10")
        done, _ = start(text, "refused")
        check(f"{what}: refused",
              done.returncode in (2, 11) and words in done.stderr and len(done.stderr.splitlines()) == 1,
              f"{done.returncode} {done.stderr}")


def test_a_table_of_3001_pairs_is_the_curve():
    # Both fluids, p_w and p_c given on both sides: the flow of each by its own permeability.
    both = block(
    "u-p_w-p_c",
    analysis="quasi_static",
    dt=0.5).replace(
        "law = 'constant'",
        "law = 'constant' k_ra = 0.5") .replace(
            "permeability = 'k' /",
            "permeability = 'k' retention = 'flat' /") + (
                "&retention name = 'flat' law = 'table' suction = 0, 1e6 saturation = 0.6, 0.6 /\n"
                "&initial p_w = -20 p_c = 20 /\n"
                "&fix group = 'all' field = 'u_r' /\n&fix group = 'all' field = 'u_z' /\n"
                "&fix group = 'left' field = 'p_w' value = -20 /\n&fix group = 'left' field = '{}' value = {} /\n"
                "&fix group = 'right' field = 'p_w' value = -14 /\n&fix group = 'right' field = 'p_c' value = 18 /\n")
    for field, value in (("p_c", 20), ("p_a", 0)):
        row = last(run(both.format(field, value), f"fluids_{field}"))
        near(f"water of two fluids, {field} given", row["left.outflow_w"], 2e-4 * 6 / 2 * 3, 1e-6)
        near(f"air of two fluids, {field} given", row["left.outflow_a"], 0.5 * 2e-10 / 2e-8 * 4 / 2 * 3, 1e-6)

    # Retention from a file is that of the lists, and van Genuchten's that of a fine table of it.
    curve = [(p, (1 + (0.1 * p)**1.6)**-0.375 if p > 0 else 1.0) for p in np.linspace(0, 60, 3001)]
    (work / "curve.txt").write_text("# suction saturation\n" + "".join(f"{p:.17g} {s:.17g}\n" for p, s in curve))
    column = both.format("p_c", 40).replace("value = 18", "value = 5")
    laws = {"lists": "law = 'table' suction =\n" + ",\n".join(f"{p:.17g}" for p, _ in curve[::50])
            + " saturation =\n" + ",\n".join(f"{s:.17g}" for _, s in curve[::50]),
            "file": "law = 'table' file = 'curve.txt'",
            "genuchten": "law = 'van_genuchten' alpha = 0.1 n = 1.6"}
    old = "law = 'table' suction = 0, 1e6 saturation = 0.6, 0.6"
    water = {}
    for name, law in laws.items():
        folder = run(column.replace(old, law), f"retention_{name}")
        water[name] = tables.columns(folder / "points_s.csv")["S_w"]
    check("a table of 3001 pairs is the curve", np.abs(water["file"] - water["genuchten"]).max() < 1e-5
          and np.ptp(water["file"]) > 0.1, np.abs(water["file"] - water["genuchten"]).max())
    check("a table of 61 pairs is coarser", 1e-5 < np.abs(water["lists"] - water["genuchten"]).max() < 2e-2)
    for name, law, words in (("alpha", "law = 'van_genuchten' n = 2", "needs alpha"),
                             ("n", "law = 'van_genuchten' alpha = 1 n = 0.9", "above 1"),
                             ("pair", "law = 'table' file = 'bad.txt'", "allowed is 0 to 1"),
                             ("rise", "law = 'table' suction = 0, 5, 9 saturation = 1, 0.5, 0.6", "must not rise"),
                             ("file", "law = 'table' file = 'none.txt'", "cannot be read")):
        (work / "bad.txt").write_text("0 1\n10 1.5\n")
        done, _ = start(column.replace(old, law), f"refused_{name}")
        check(f"refused: {name}", done.returncode == 2 and words in done.stderr, done.stderr)
