# SPDX-License-Identifier: MIT
"""Whether a scene begins in balance: the stress of layers and slopes, and what is told of a start that is not."""
import re

import numpy as np

from checking import check, root, work
from host_program import start
import tables  # noqa: E402 (checking knows its folder)

LAYERS = """&scene name = 'layers' geometry = 'plane_strain' gravity = 10 fields = '{fields}' /
&mesh r = 0, 1, 2 r_cells = 1, 1 z = -3, -2, -0.5, 0 z_cells = 2, 3, 1 /
&elastic name = 'e' young = 1e4 poisson = 0.3 /
&permeability name = 'k' intrinsic = 1e-12 /
&region material = 'e' void_ratio = 0.5 rho_s = 3 permeability = 'k' /
&region group = 'block_1_2' material = 'e' void_ratio = 1 rho_s = 3 permeability = 'k' /
&region group = 'block_2_2' material = 'e' void_ratio = 1 rho_s = 3 permeability = 'k' {stages} /
&initial stress = 'geostatic' k_0 = 0.4 surface = 0 surcharge = 2 {water} /
&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 zero_displacements = 'yes' /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 2 /
&point name = 'deep' r = 0.5 z = -3 /
"""


def scene(fields="u", water="", stages="", *pairs):
    text = LAYERS.format(**locals())
    for old, new in pairs:
        check(f"the scene has {old!r}", old in text)
        text = text.replace(old, new)
    return text


def told(done):
    return [line for line in done.stderr.splitlines() if "not in balance" in line]


def test_the_weights_of_layers_are_summed():
    # Densities 3/1.5 = 2 above and below, 3/2 = 1.5 in the middle: 2 + 10 (0.5 2 + 1.5 1.5 + d 2) at a depth d below
    # the middle; with water the pores have 1/3 and 1/2 of it.
    for fields, water, above, below in (("u", "", 2 + 10*(0.5*2 + 1.5*1.5), 20), (
            "u-p_w", "p_w_slope = -10", 2 + 10*(0.5*(2 + 1/3) + 1.5*(1.5 + 1/2)), 10*(2 + 1/3))):
        done = start("layers", scene(fields, water))
        check(f"layers of {fields} run without a word", done.returncode == 0 and not told(done), done.stderr)
        rows = tables.columns(work / "layers/histories.csv")
        # At the quadrature point nearest to the bottom; the pressure there is 10 times its depth.
        for row in (0, 1):
            depth = (rows["deep.s_zz"][row]*-1 - above + (20 if water else 0))/(below - (10 if water else 0))
            check(f"{fields}: the stress below three layers, row {row}", 0.75 < depth < 1, rows["deep.s_zz"])
        check(f"{fields}: nothing moves", max(abs(rows["deep.s_zz"][1] - rows["deep.s_zz"][0]),
                                              abs(rows["deep.s_rr"][1] - rows["deep.s_rr"][0])) < 1e-9, rows)


def test_a_layer_that_has_its_own_surface_is_as_it_was():
    # Surfaces and surcharges of the layers by hand say the same.
    by_hand = scene("u", "", "", ("&initial stress = 'geostatic' k_0 = 0.4 surface = 0 surcharge = 2  /",
                                  "&initial stress = 'geostatic' k_0 = 0.4 surface = 0 surcharge = 2 /\n" + "".join(
        f"&initial group = 'block_{i}_{j}' stress = 'geostatic' k_0 = 0.4 surface = {s} surcharge = {q} /\n"
        for i in (1, 2) for j, s, q in ((2, -0.5, 12), (1, -2, 34.5)))))
    done = start("by_hand", by_hand)
    check("by hand runs without a word", done.returncode == 0 and not told(done), done.stderr)
    start("layers", scene())
    one, two = (tables.columns(work / name / "histories.csv")["deep.s_zz"][0] for name in ("by_hand", "layers"))
    check("the same stress", abs(one - two) < 1e-10, (one, two))


def test_ground_that_is_not_there_does_not_weigh():
    # The middle of the right column joins later: below it weigh 0.5 m of the top, 0.75 to 1 m of what is there.
    later = scene("u", "", "stages = 'later'", ("&initial stress", "&initial group = 'block_1_1' stress"),
                  (" zero_displacements = 'yes' /",
                   " /\n&stage name = 'later' analysis = 'static' duration = 1 dt = 1 /"),
                  ("r = 0.5 z = -3", "r = 1.5 z = -3"))
    done = start("later", later + "&initial group = 'block_2_1' stress = 'geostatic' surface = 0 /\n")
    check("the layer that joins later runs", done.returncode == 0, done.stderr)
    found = -tables.columns(work / "later/histories.csv")["deep.s_zz"][0]
    check("what is not there weighs nothing", 10 + 0.75*20 < found < 10 + 20, found)


def test_what_is_told_of_a_start_that_is_not_in_balance():
    for what, pairs, words in (
            ("a surface 1 m too high", [("surface = 0", "surface = 1")], ["20 kPa away", "Stage rest begins"]),
            ("a surcharge without its load", [("value = 2", "value = 0")], ["2 kPa away", ", 0) m"]),
            ("a load that is more than the surcharge", [("value = 2", "value = 5")], []),
            ("a load that grows from the surcharge", [("value = 2", "value = 2 history = 'h'"),
             ("&point", "&history name = 'h' times = 0, 1 values = 1, 9 /\n&point")], None)):
        for more in (["--check"], []):
            done = start("told", scene("u", "", "", *pairs), *more)
            lines = told(done)
            check(f"{what} {more}: runs", done.returncode == 0, done.stderr)
            check(f"{what} {more}: told", len(lines) == (0 if words is None else 1)
                  and all(word in lines[0] for word in words or []), done.stderr)
    # The stage zeroes its displacements: the histories show nothing of it, the warning does.
    loads = scene("u", "", "", ("&initial stress", "! &initial stress"))
    check("a static stage finds the balance where no stress is given", not told(start("none", loads)))
    done = start("waves", loads.replace("analysis = 'static'", "analysis = 'dynamic'").replace(
        "&fix group = 'bottom' field = 'u_z' /", "&absorbing group = 'bottom' /"), "--check")
    check("weight on dashpots is told", len(told(done)) == 1 and "dashpots of &absorbing hold no weight" in done.stderr,
          done.stderr)


def test_a_slope_begins_in_balance_as_the_page_says():
    page = (root / "docs/how-to/start.md").read_text(encoding="utf-8")
    lines = re.search(r"^## A slope$.*?^```\n(.*?)^```", page, re.MULTILINE | re.DOTALL)[1]
    text = f"""&scene name = 'slope' geometry = 'plane_strain' gravity = 9.81 /
&mesh file = '{root}/verification/host/seepage_face/slope.msh' /
&mud name = 'sand' file = '{root}/drivers/materials/toyoura.nml' /
&region material = 'sand' void_ratio = 0.75 rho_s = 2.65 /
&stage name = 'wait' analysis = 'static' duration = 1 dt = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&point name = 'crest' r = 6 z = 4 /
"""
    moved = {}
    for name, of_page in (("slope", lines), ("level", lines.replace("column = 'ground'", "surface = 4"))):
        done = start(name, text.replace("&stage", of_page + "&stage", 1))
        check(f"{name} runs", done.returncode == 0, done.stderr)
        moved[name] = told(done), tables.columns(work / name / "histories.csv")
    check("columns that follow the slope are nearly in balance",
          re.search(r" 1\d\.?\d* % of", "".join(moved["slope"][0])), moved["slope"][0])
    check("those of the level of the crest are not", re.search(r" 8\d\.?\d* % of", "".join(moved["level"][0])),
          moved["level"][0])
    rows = moved["slope"][1]
    check("the stage finds the balance", abs(rows["crest.s_rr"][1] - rows["crest.s_rr"][0]) > 0.1, rows["crest.s_rr"])
    check("nothing moves afterwards", abs(rows["crest.u_r"][-1]) + abs(rows["crest.u_z"][-1]) < 1e-6, rows["crest.u_r"])


def recipe(title):
    """The blocks of a recipe that are groups of a scene."""
    page = (root / "docs/how-to/README.md").read_text(encoding="utf-8")
    section = re.search(rf"^## {re.escape(title)}$(.*?)^## ", page, re.MULTILINE | re.DOTALL)[1]
    return re.findall(r"^```\n(.*?)^```", section, re.MULTILINE | re.DOTALL)


GROUND = """&mesh r = 0, 0.15, 1.2 r_cells = 2, 4 z = -1.2, 0 z_cells = 6 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
"""
ELASTIC = """&scene name = 'ground' gravity = 9.81 /
&elastic name = 'e' young = 3e4 poisson = 0.3 /
&region material = 'e' void_ratio = 0.6 rho_s = 2.65 /
&initial stress = 'geostatic' surface = 0 /
"""


def test_recipes_of_pulses_and_machines_run_as_they_stand():
    given, falling = recipe("Drop something: a half sine")
    drops = ELASTIC + GROUND + "&fix group = 'right' field = 'u_r' /\n" + given
    moved = {}
    # The mass takes the place of the force.
    mass = drops.replace(" force = -7 history = 'fall'", "").replace(given.splitlines()[0] + "\n", "") + falling
    for name, text in (("half_sine", drops), ("falling_mass", mass)):
        done = start(name, text)
        check(f"{name} runs", done.returncode == 0 and not told(done), done.stderr)
        rows = tables.columns(work / name / "contact.csv")
        moved[name] = [-rows["plate.u_z"][(rows["time"] > t) & (rows["time"] < t + 0.03)].min() for t in (0, 0.06)]
    # pi/2 (1 - nu^2) sigma r/E of a rigid plate under 7 kN: 0.71 mm; of 1.2 m a little less.
    check("the plate settles as much in both drops", all(4e-4 < x < 9e-4 for x in moved["half_sine"]), moved)
    # Waves that the sides throw back are still there.
    check("the mass that falls does as much, once", 4e-4 < moved["falling_mass"][0] < 9e-4
          and abs(moved["falling_mass"][1]) < 0.5*moved["falling_mass"][0], moved)
    machine, = recipe("Run a machine on its foundation")
    sides = "&fix group = 'right' field = 'u_r' stages = 'rest' /\n"
    done = start("machine", ELASTIC + GROUND + sides + machine, "--set", "stage[2].duration=0.08")
    check("the machine runs", done.returncode == 0 and not told(done), done.stderr)
    swing = tables.columns(work / "machine/contact.csv")["block.u_z"]
    check("its block swings", 1e-5 < np.ptp(swing) < 1e-2, np.ptp(swing))


def test_the_recipe_of_a_water_table_is_at_rest():
    water, = recipe("Begin with a water table")
    text = water + GROUND.replace("-1.2, 0", "-4, 0") + f"""
&mud name = 'sand' file = '{root}/drivers/materials/toyoura.nml' /
&region material = 'sand' void_ratio = 0.75 rho_s = 2.65 retention = 'material' permeability = 'k' /
&permeability name = 'k' intrinsic = 1e-11 /
&fix group = 'right' field = 'u_r' /
&stage name = 'wait' analysis = 'quasi_static' duration = 3600 /
&point name = 'low' r = 0 z = -3 /
&point name = 'high' r = 0 z = -1 /
"""
    done = start("table", text)
    check("it runs", done.returncode == 0, done.stderr)
    rows = tables.columns(work / "table/histories.csv")
    # 1 m of water below the table, and above it the suction of as much: 9.81 kPa.
    for name, p_w in (("low", 9.81), ("high", -9.81)):
        check(f"p_w {name}", np.all(abs(rows[f"{name}.p_w"] - p_w) < 0.02), rows[f"{name}.p_w"][[0, -1]])
        # Where the soil is saturated a negative suction has no effect, and nothing holds it exactly.
        near = 0.05 if name == "low" else 0.02
        check(f"p_c {name}", np.all(abs(rows[f"{name}.p_c"] + p_w) < near), rows[f"{name}.p_c"][[0, -1]])
        check(f"{name} does not move", np.all(abs(rows[f"{name}.u_z"]) < 1e-6), rows[f"{name}.u_z"][-1])


WET = """&scene name = 'wet' geometry = 'plane_strain' fields = 'u-p_w-p_c' gravity = 10 /
&mesh r = 0, 1 r_cells = 1 z = -4, 0 z_cells = 4 /
&elastic name = 'e' young = 1e4 poisson = 0.3 /
&retention name = 'c' law = 'van_genuchten' alpha = 0.1 n = 2 /
&permeability name = 'k' intrinsic = 1e-12 law = 'constant' /
&region material = 'e' permeability = 'k' retention = 'c' void_ratio = 0.6 rho_s = 2.5 /
&initial p_w = -20 p_w_slope = -10 p_c = 20 p_c_slope = 10 stress = 'geostatic' surface = 0 /
&stage name = 's' analysis = 'quasi_static' duration = 10 dt = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
"""


def lines_of(name, text, *more):
    """What is warned of, with --check and in a run."""
    checked, ran = start(name, text, "--check"), start(name, text, *more)
    warned = [[line for line in done.stderr.splitlines() if line.startswith("mud_host: warning: ")]
              for done in (checked, ran)]
    check(f"{name}: --check", checked.returncode == 0, checked.stderr)
    check(f"{name}: told by the run as by --check", warned[0] == warned[1][:len(warned[0])], warned)
    return warned[0]


def test_air_that_nobody_asked_for():
    check("suction that balances the tension of water is no doubt", lines_of("air", WET) == [])
    for old, words in (("p_c = 20 p_c_slope = 10 ", "p_a = p_w + p_c = -20 kPa at z = 0 m"),
                       ("p_c = 20 p_c_slope = 10 ", "Did you mean p_c = 20, p_c_slope = 10?"),
                       ("p_w = -20 p_w_slope = -10 ", "Did you mean p_w = -20, p_w_slope = -10?"),
                       (" p_c_slope = 10", "= 40 kPa at z = -4 m")):
        check(f"{old!r} stands there", old in WET)
        told_of = [line for line in lines_of("air", WET.replace(old, "")) if "the air begins with p_a" in line]
        check(f"without {old!r}", len(told_of) == 1 and words in told_of[0], told_of)
    asked = WET.replace("p_c = 20 p_c_slope = 10 ", "")
    for line in ("&fix group = 'top' field = 'p_a' value = -20 /", "&load group = 'top' kind = 'air' value = 1e-9 /"):
        check(f"{line} asks for it", not any("the air begins" in one for one in lines_of("air", asked + line)))
    check("air above the pressure of water is meant", not any("the air begins" in one for one in lines_of(
        "air", WET.replace("p_w = -20 p_w_slope = -10 p_c = 20 p_c_slope = 10", "p_w = 30 p_c = 5"))))


def test_water_outside_without_its_load():
    lake = WET.replace("u-p_w-p_c", "u-p_w").replace("p_w = -20 p_w_slope = -10 p_c = 20 p_c_slope = 10",
                                                     "p_w = 30 p_w_slope = -10").replace(" retention = 'c'", "")
    lake = lake.replace("&retention name = 'c' law = 'van_genuchten' alpha = 0.1 n = 2 /\n", "")
    water = "&fix group = 'top' field = 'p_w' value = 30 /\n"
    found = [line for line in lines_of("lake", lake + water) if "its weight is missing" in line]
    check("3 m of water without weight", len(found) == 1
          and "up to 30 kPa stands on 1 of the 1 edges of 'top'" in found[0], found)
    for what, more in (("its pressure", "&load group = 'top' kind = 'pressure' value = 30 /\n"),
                       ("a held surface", "&fix group = 'top' field = 'u_z' /\n"),
                       ("a held history", "")):
        text = lake + (water if more else water.replace("value = 30", "hold = 'yes'")) + more
        check(f"{what} is no doubt", not any("weight is missing" in line for line in lines_of("lake", text)))
    # In axial symmetry the axis holds itself, and a drain there has no surface.
    drain = water.replace("'top'", "'left'").replace("value = 30", "value = 30 value_slope = -10")
    for geometry, support, count in (("axisymmetric", "", 0), ("plane_strain", "", 1),
                                     ("plane_strain", "&fix group = 'left' field = 'u_r' /\n", 0)):
        text = lake.replace("&fix group = 'left' field = 'u_r' /\n", "").replace("plane_strain", geometry)
        found = [line for line in lines_of("drain", text + support + drain) if "weight is missing" in line]
        check(f"a drain on the left, {geometry} {support}", len(found) == count, found)
    grows = lake + "&history name = 'h' times = 0, 5 values = 0, -1 /\n" + water.replace(
        "value = 30", "value = -20 history = 'h'")
    check("a level that rises", any("up to 20 kPa" in line for line in lines_of("lake", grows)))


SHAKEN = """&scene name = 'base' geometry = 'plane_strain' /
&mesh r = 0, 1 r_cells = 1 z = 0, 4 z_cells = 2 /
&elastic name = 'e' young = 5e4 poisson = 0.25 /
&region material = 'e' void_ratio = 0 rho_s = 2 /
&history name = 'h' times = {} values = {} /
{}&stage name = 'shake' analysis = 'dynamic' duration = 0.2 dt = 0.01 /
&fix group = 'all' field = 'u_z' /
&fix group = 'bottom' field = 'u_r' value = 0.02 history = 'h' {} /
"""
STRUCK = "begins in stage shake with a velocity of "


LAKE = """&scene name = 'lake' geometry = 'plane_strain' fields = 'u-p_w' gravity = 10 /
&mesh r = 0, 1 r_cells = 2 z = -3, 0 z_cells = 12 /
&elastic name = 'e' young = 2e4 poisson = 0.3 /
&permeability name = 'k' intrinsic = 1e-12 /
&region material = 'e' void_ratio = 0.6 permeability = 'k' rho_s = 2.6 /
&initial p_w = 30 p_w_slope = -10 stress = {stress} /
&stage name = 'flow' analysis = 'quasi_static' duration = 100 dt = 10 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_w' value = 30 /
&load group = 'top' kind = 'pressure' value = {load} /
&point name = 'top' r = 0 z = 0 /
"""


def test_ground_below_a_lake_begins_in_balance_or_it_is_told():
    # 3 m of water stand on the ground. Its weight was there before: without it in &initial the surface springs down.
    for name, stress, load, is_told in (("lake", "'geostatic' surcharge = 30", 30, False),
                                        ("bare", "'geostatic'", 30, True), ("weightless", "'none'", 30, True),
                                        ("loaded", "'geostatic' surcharge = 30",
                                         "30 /\n&load group = 'top' kind = 'pressure' value = 15", False)):
        text = LAKE.format(stress=stress, load=load)
        for words in ((), ("--check",)):
            done = start(name, text, *words)
            check(f"{name} {words}: runs", done.returncode == 0, done.stderr)
            check(f"{name} {words}: told {is_told}", bool(told(done)) == is_told, done.stderr)
    bare = start("bare", LAKE.format(stress="'geostatic'", load=30))
    check("as much as is missing", "are 30 kPa away" in bare.stderr, bare.stderr)


def test_a_motion_that_begins_with_a_velocity():
    for times, values, rest, more, words in (
            ("0, 0.1, 0.2", "0, 1, 0", "", "", STRUCK + "0.2 m/s, and the ground with 0"),
            ("0, 0.01, 0.1, 0.2", "0, 0.001, 1, 0", "", "", None),
            ("0, 0.1, 0.2", "0, 1, 0", "", "motion = 'acceleration'", None),
            ("0, 1, 1.1", "0, 0, 1", "&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 /\n", "",
             STRUCK + "0.2 m/s"),
            ("0, 2", "0, 1", "&stage name = 'before' analysis = 'dynamic' duration = 0.1 dt = 0.01 /\n", "",
             "begins in stage before with a velocity of 0.01 m/s")):
        said = lines_of("shaken", SHAKEN.format(times, values, rest, more))
        found = [line for line in said if "it is struck" in line]
        check(f"{times} {values} {rest} {more}", (len(found), words is None or words in found[0])
              == (int(words is not None), True), found)


def test_a_support_that_takes_back_and_a_plate_below_a_buffer():
    # hold means the values of the stage's start, also where it begins later. A mass on a spring presses what is below.
    block = """&scene name = 'b' geometry = 'plane_strain' gravity = 9.81 /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'e' young = 1e4 poisson = 0.2 /
&region material = 'e' void_ratio = 0 /
&stage name = 'one' analysis = 'static' duration = 1 dt = 1 /
&stage name = 'two' analysis = 'dynamic' duration = 0.1 dt = 0.01 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
"""
    for more, told in (("from = 1.05", True), ("stages = 'two'", False), ("from = 1 stages = 'two'", False)):
        said = lines_of("back", block + f"&fix group = 'top' field = 'u_z' hold = 'yes' {more} /\n")
        check(f"hold {more}", any("takes 'top' back at 1.05 s" in line for line in said) == told, said)
    said = lines_of("below", block + "&plate name = 'lo' group = 'top' mass = 0.1 /\n"
                    "&plate name = 'up' r = 0, 1 z = 2 mass = 0.1 weight = 'yes' /\n"
                    "&fix group = 'up' field = 'u_z' hold = 'yes' stages = 'one' /\n"
                    "&buffer upper = 'up' lower = 'lo' stiffness = 100 /\n")
    check("a plate below a buffer", not any("nothing presses" in line for line in said), said)


def test_a_velocity_that_the_first_stage_takes_away_is_told():
    # A mass that falls, behind a stage that finds the balance of the weight: its velocity is gone when it falls.
    text = """&scene name = 'fall' gravity = 9.81 /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'e' young = 1e4 poisson = 0.2 /
&region material = 'e' void_ratio = 0 /
&plate name = 'mass' r = 0, 0.5 z = 1.1 mass = 0.1 /
&initial stress = 'geostatic' surface = 1 k_0 = 0.25 /
&initial group = 'mass' {} /
{}&stage name = 'drop' analysis = 'dynamic' duration = 0.01 dt = 1e-3 /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'mass' field = 'u_z' hold = 'yes' stages = 'rest' /
"""
    rest = "&stage name = 'rest' analysis = '{}' duration = 1 dt = 1 /\n"
    told = lambda text: [line for line in lines_of("fall", text) if "leaves it at rest" in line]  # noqa: E731
    for kind in ("static", "quasi_static"):
        said = told(text.format("v_z = -2", rest.format(kind)))
        check(f"behind a {kind} stage", len(said) == 1 and "fall.nml:7: v_z of &initial has no effect" in said[0]
              and "begins with stage rest" in said[0], said)
    check("a wave as well", len(told(text.format("wave = 1 wave_number = 2", rest.format("static")))) == 1)
    check("none is no doubt", not told(text.format("", rest.format("static"))))
    check("one that the first stage keeps is no doubt",
          not told(text.format("v_z = -2", rest.format("dynamic"))))


def test_ground_that_leaves_above_dashpots_alone_is_told():
    # In a dynamic stage the rest of the column rises for ever; a static one before it, or a support, holds it.
    text = """&scene name = 'pit' gravity = 10 /
&mesh r = 0, 1 r_cells = 1 z = -1, -0.5, 0 z_cells = 1, 1 /
&elastic name = 'e' young = 1e4 poisson = 0.2 /
&region group = 'block_1_1' material = 'e' void_ratio = 0 rho_s = 2 /
&region group = 'block_1_2' material = 'e' void_ratio = 0 rho_s = 2 stages = {} /
&initial stress = 'geostatic' surface = 0 k_0 = 0.25 /
&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 /
&stage name = 'dig' analysis = 'static' duration = 1 dt = 1 /
&stage name = 'shake' analysis = 'dynamic' duration = 0.01 dt = 1e-3 /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' stages = 'rest', 'dig'{} /
&absorbing group = 'bottom' /
"""
    told = lambda text: [line for line in lines_of("pit", text) if "drifts for ever" in line]  # noqa: E731
    said = told(text.format("'rest', 'dig'", ""))
    check("it leaves while dashpots hold the rest", len(said) == 1 and "the dynamic stage shake" in said[0]
          and "the dashpots of &absorbing" in said[0], said)
    check("it leaves before", not told(text.format("'rest'", "")))
    check("a support carries the rest", not told(text.format("'rest', 'dig'", ", 'shake'")))


def test_pulses_that_are_over_and_plates():
    text = """&scene name = 'lwd' gravity = 10 /
&mesh r = 0, 0.2, 1 r_cells = 1, 1 z = -1, 0 z_cells = 2 /
&elastic name = 'e' young = 3e4 poisson = 0.3 /
&region material = 'e' void_ratio = 0 rho_s = 2 /
&initial stress = 'geostatic' surface = 0 k_0 = 0.4 /
&history name = 'pulse' times = {times} values = 0, 1, 0 /
&plate name = 'p' r = 0, 0.2 mass = 0.02 weight = 'yes' force = -7 history = 'pulse' /
&contact name = 'c' slave = 'top' master = 'p' /
&stage name = 'rest' analysis = 'static' duration = 2 dt = 0.5 /
&stage name = 'impact' analysis = 'dynamic' duration = 0.04 dt = 5e-3 /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
"""
    said = lambda name, text, word: [line for line in lines_of(name, text) if word in line]  # noqa: E731
    meant = text.format(times="2, 2.009, 2.018")
    check("a pulse at its time is no doubt", lines_of("lwd", meant) == [], lines_of("lwd", meant))
    early = said("lwd", text.format(times="0, 0.009, 0.018"), "is over at")
    check("a pulse of the plate in the stage before", len(early) == 1 and
          "is over at 0.018 s, before stage impact begins at 2 s" in early[0], early)
    load = meant.replace("&stage name = 'rest'", "&history name = 'q' times = 0, 0.01, 0.02 values = 0, 2, 0 /\n"
                         "&load group = 'top_2' kind = 'pressure' value = 1 history = 'q' {}/\n&stage name = 'rest'")
    check("a pulse of a load in the stage before", len(said("lwd", load.format(""), "is over at")) == 1)
    check("one that is limited to the stage", len(said("lwd", load.format("stages = 'impact' "), "begins at 0 s")) == 1)
    check("a slow load of the stage before is no doubt",
          not said("lwd", load.format("").replace("0, 0.01, 0.02", "0, 1, 1.9"), "is over at"))
    # 7e3 on a circle of 0.2 m are 55,704 kPa.
    newton = said("lwd", meant.replace("force = -7", "force = -7e3").replace("dt = 5e-3", "dt = 5e-3 cuts = 30"),
                  "forces are in kN")
    check("a force in N", len(newton) == 1 and "is 55704.2 kPa on its 0.125664 m2" in newton[0], newton)
    up = meant.replace("force = -7", "force = 7").replace("'yes'", "'no'")
    check("a plate that is pulled up", len(said("lwd", up, "nothing presses the plate 'p' down")) == 1)
    held = up + "&fix group = 'p' field = 'u_z' value = -1e-4 /\n"
    check("one that a &fix moves is no doubt", not said("lwd", held, "nothing presses"))


def test_nodes_that_share_an_unknown_are_held_by_one_of_them():
    # A rigid plate is joined to the top; its motion is held at the top of one side alone.
    done = start("joined", """&scene name = 'joined' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 5 r_cells = 5 z = 0, 5 z_cells = 5 /
&elastic name = 'soil' young = 2e4 poisson = 0.25 /
&region material = 'soil' void_ratio = 0.65 /
&initial stress = 'uniform' sigma = -50, -50, -50 /
&stage name = 'a' analysis = 'static' duration = 1 dt = 1 /
&plate name = 'p' group = 'top' mass = 1 /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'right' field = 'u_z' /
""")
    check("it is in balance", done.returncode == 0 and told(done) == [], done.stderr)


def test_nodes_of_two_grounds_have_the_pressure_of_the_one_whose_fluids_flow():
    # 20 kPa in the coupled ground below, 5 kPa or none above, whichever &initial is written last: ground that is dry,
    # keeps its fluids or is not there yet says nothing of its neighbour; drained ground that is there opens it.
    for name, above, wanted in (("dry", "drainage = 'dry'", 20), ("closed", "drainage = 'undrained'", 20),
                                ("later", "permeability = 'k' stages = 'fill'", 20),
                                ("later_open", "drainage = 'drained' stages = 'fill'", 20),
                                ("open", "drainage = 'drained'", 5)):
        initials = ["&initial group = 'block_1_1' p_w = 20 /\n",
                    f"&initial group = 'block_1_2' p_w = {0 if name == 'dry' else 5} /\n"]
        for order in (initials, initials[::-1]):
            done = start(name, f"""&scene name = 'two' geometry = 'plane_strain' fields = 'u-p_w' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1, 2 z_cells = 2, 2 /
&elastic name = 'e' young = 1e4 poisson = 0.3 /
&permeability name = 'k' intrinsic = 1e-12 /
&region group = 'block_1_1' material = 'e' void_ratio = 0.5 permeability = 'k' /
&region group = 'block_1_2' material = 'e' void_ratio = 0.5 {above} /
{''.join(order)}&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 /
&stage name = 'fill' analysis = 'static' duration = 1 dt = 1 /
&fix group = 'all' field = 'u_r' /
&fix group = 'all' field = 'u_z' /
""")
            check(f"{name} runs", done.returncode == 0, done.stderr)
            p_w = [row["p_w"] for row in tables.numbers(work / name / "nodes_rest.csv") if row["z"] == 1]
            check(f"{name}: the pressure between them", len(p_w) == 3 and set(p_w) == {wanted}, (order, p_w))


def test_drained_and_undrained_ground_meet_with_pressures_of_their_own():
    # 20 kPa in a block that keeps its fluids, 5 kPa in the drained block above, whichever &initial is written last: the
    # base bears the 20 kPa of what stands on it, the top the 5 kPa below it, and the node between has the drained ones.
    initials = ["&initial group = 'block_1_1' p_w = 20 /\n", "&initial group = 'block_1_2' p_w = 5 /\n"]
    for order in (initials, initials[::-1]):
        done = start("meet", f"""&scene name = 'two' geometry = 'plane_strain' fields = 'u-p_w' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1, 2 z_cells = 1, 1 /
&elastic name = 'e' young = 1e4 poisson = 0.3 /
&permeability name = 'k' intrinsic = 1e-12 /
&region group = 'block_1_1' material = 'e' void_ratio = 0.5 drainage = 'undrained' /
&region group = 'block_1_2' material = 'e' void_ratio = 0.5 drainage = 'drained' /
{''.join(order)}&stage name = 'rest' analysis = 'quasi_static' duration = 1 dt = 1 /
&fix group = 'all' field = 'u_r' /
&fix group = 'all' field = 'u_z' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'u_z' /
""")
        check("it runs", done.returncode == 0, done.stderr)
        row = tables.numbers(work / "meet" / "reactions_rest.csv")[-1]
        forces = row["bottom.force_z"], row["top.force_z"]
        check("base and top", abs(forces[0] - 20) < 1e-9 and abs(forces[1] + 5) < 1e-9, (order, forces))
        p_w = [row["p_w"] for row in tables.numbers(work / "meet" / "nodes_rest.csv") if row["z"] == 1]
        check("the pressure between them", len(p_w) == 3 and set(p_w) == {5}, (order, p_w))
