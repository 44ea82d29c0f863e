# SPDX-License-Identifier: MIT
"""What mud_host warns about at the start and with --check: a scene without a doubt draws nothing, every doubt its own
sentence, and the run goes on."""
import os
import re
import subprocess
import sys

from checking import build, check, root, work
from host_program import start

sys.path.insert(0, str(root / "common"))
import tables  # noqa: E402

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}
SCENE = f"""&scene name = 'clean' fields = 'u-p_w' pressures = 'quadratic' gravity = 9.81 /
&mesh r = 0, 2 r_cells = 2 z = -2, 0 z_cells = 2 /
&mud name = 'sand' file = '{root}/drivers/materials/toyoura.nml' /
&elastic name = 'rock' young = 1e6 poisson = 0.3 /
&fluids rho_w = 1 /
&permeability name = 'k' intrinsic = 1e-11 /
&region material = 'sand' void_ratio = 0.8 permeability = 'k' /
&region group = 'beam' material = 'rock' void_ratio = 0.1 permeability = 'k' /
&initial p_w_slope = -9.81 stress = 'geostatic' surface = 0 surcharge = 0.5 /
&history name = 'h' times = 0, 1 values = 0, 1 /
&stage name = 'load' analysis = 'quasi_static' duration = 1 dt = 0.5 rho_inf = 0 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_w' /
&load group = 'top' kind = 'pressure' value = 5 history = 'h' /
&point name = 'base' r = 0 z = -2 /
""".replace("'beam'", "'block_1_1'").replace("&mesh r = 0, 2 r_cells = 2", "&mesh r = 0, 1, 2 r_cells = 1, 1")


def warnings(text, *words):
    (work / "scene.nml").write_text(text)
    done = subprocess.run([host, work / "scene.nml", "--output", work / "out", *words], capture_output=True, text=True,
                          env=environment)
    check(f"{words} goes on", done.returncode == 0, done.stderr)
    return [line for line in done.stderr.splitlines() if line.startswith("mud_host: warning: ")]


def test_a_material_in_another_unit_is_refused():
    # Toyoura sand in Pa and in MPa, as its own list says it.
    for unit in ("Pa", "MPa"):
        listed = subprocess.run([build / "drivers/mud_describe", "udsm", root / "drivers/materials/toyoura.nml",
                                 "--unit", unit], capture_output=True, text=True, check=True).stdout.splitlines()[1:]
        values = {line.split()[1]: line.split()[3] for line in listed}
        (work / "sand.nml").write_text("&material\n" + "".join(f"{key} = {value}\n" for key, value in values.items())
                                       + "/\n")
        (work / "scene.nml").write_text(re.sub(r"file = '.*toyoura.nml'", "file = 'sand.nml'", SCENE))
        done = subprocess.run([host, work / "scene.nml", "--check"], capture_output=True, text=True, env=environment)
        check(f"{unit}: refused", done.returncode == 2 and f"scene.nml:3: material 'sand' is in {unit}," in done.stderr
              and len(done.stderr.splitlines()) == 1, done.stderr)


def test_large_strains_are_told_once():
    # A block under p, free to spread: strains (1 - nu^2) p/E along z in the plane, 9.6 and 10.56 %. With shear G = 4000
    # kPa: tau/G/2 is a principal strain of 11 %. A second stage adds nothing.
    block = """&scene name = 'b' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'm' young = 1e4 poisson = 0.25 /
&region material = 'm' void_ratio = 0 /
&stage name = 'one' analysis = 'static' duration = 1 dt = 1 /
&stage name = 'two' analysis = 'static' duration = 1 dt = 1 /
"""
    pressed = "&fix group = 'left' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /\n" \
              "&load group = 'top' kind = 'pressure' value = {} /\n"
    sheared = "&fix group = 'all' field = 'u_z' /\n&fix group = 'bottom' field = 'u_r' /\n" \
              "&load group = 'top' kind = 'shear_r' value = 880 /\n"
    for more, strain in ((pressed.format(1024), ""), (pressed.format(1126.4), "10.56"), (sheared, "11")):
        told = start("strained", block + more).stderr
        check(f"{strain or 'nothing'} told", told.count("the ground is strained") == bool(strain)
              and (f"one, time 1 s: the ground is strained by up to {strain} %" in told) == bool(strain), told)
    # A prescribed tenth is not above a tenth, and ground that joins has not the settlement of what it stands on.
    exact = "&fix group = 'all' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /\n" \
            "&fix group = 'top' field = 'u_z' value = -0.1 /\n"
    joined = block.replace("z = 0, 1 z_cells = 1", "z = 0, 10, 10.5 z_cells = 5, 1").replace(
        "&region material = 'm'", "&region group = 'block_1_2' material = 'm' void_ratio = 0 stages = 'two' /\n"
        "&region group = 'block_1_1' material = 'm'").replace("fields = 'u'", "fields = 'u' gravity = 9.81").replace(
        "young = 1e4", "young = 5e3") + "&fix group = 'all' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /\n"
    for what, text in (("a tenth", block + exact), ("what joins", joined)):
        told = start("strained", text)
        check(f"{what} is not told", told.returncode == 0 and "strained" not in told.stderr, told.stderr)


DOUBTS = [
    ("tension in MUD", "p_w_slope = -9.81", "p_w = 30", ["tensile at", "points of MUD"]),
    ("pressure and stress in two", "p_w_slope = -9.81 ", "p_w_slope = -9.81 /\n&initial p_w_slope = -9.81 ",
     ["scene.nml:9: this &initial of group 'all' has no effect", "Write them in one"]),
    ("surface below the mesh", "surface = 0", "surface = -1", ["surface = -1 m lies below", "'all' at 0 m"]),
    ("permeability", "intrinsic = 1e-11", "intrinsic = 1.1e-8",
     ["intrinsic = 1.1e-8 of &permeability", "conductivity"]),
    ("stiffness", "young = 1e6", "young = 1.1e9", ["young = 1.1e9 of &elastic", "a modulus in kPa"]),
    ("material with a stress in another unit", "toyoura.nml'", "toyoura.nml' P_a = 5000",
     ["scene.nml:3: ", "P_a", "usual"]),
    ("material in another unit than the scene", "toyoura.nml'", "toyoura.nml' p_atm = 70",
     ["material 'sand' has a p_atm of 70", "scenes are in kPa"]),
    ("large mesh", "r = 0, 1, 2", "r = 0, 1, 1002", ["the mesh is 1002 m large"]),
    ("two supports", "'bottom' field = 'u_r'", "'bottom' field = 'u_r' value = 0.001",
     ["u_r of the node at (0, -2) m has two &fix", "'left' and 'bottom'"]),
    ("curve of nobody", "0.8 permeability", "0.8 retention = 'curve' permeability",
     ["retention of &region has no effect: the scene has no field p_c"]),
    ("key of another law", "1e-11", "1e-11 m = 0.5", ["m of &permeability has no effect with law = 'corey'"]),
    ("floor of constants", "1e-11", "1e-11 law = 'constant' floor = 0.1",
     ["floor of &permeability has no effect with law = 'constant'"]),
    ("parameter behind a switch", "toyoura.nml'", "toyoura.nml' zeta_chi = 10",
     ["scene.nml:3: zeta_chi has no effect with c_chi = 0"]),
    ("parameter of the file behind a switch of the scene", "toyoura.nml'", "hostun_hysteresis.nml' hysteresis = 0",
     ["hostun_hysteresis.nml:35: P_aw has no effect with hysteresis = 0"]),
    ("pressure of a static stage", "'quasi_static'", "'static'",
     ["scene.nml:16: p_w has no effect: the stages in which it acts are static"]),
    ("dashpots of a static stage", "&load", "&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 /\n"
     "&absorbing group = 'right' stages = 'rest' /\n&load", ["&absorbing has no effect: no stage in which it acts"]),
    ("acceleration without a dynamic stage", "'left' field = 'u_r'",
     "'left' field = 'u_r' motion = 'acceleration' value = 1 history = 'h'",
     ["scene.nml:12: the acceleration has no effect: no stage in which it acts"]),
    ("nodes that leave the axis", "'left' field = 'u_r'", "'left' field = 'u_r' value = 1e-3",
     ["scene.nml:12: u_r of nodes at r = 0 is prescribed", "the hoop strain has no bound"]),
    ("support that ends before the run", "'right' field = 'u_r'", "'right' field = 'u_r' until = 0",
     ["scene.nml:13: this &fix has no effect: its stages begin at 0 s and end at 1 s"]),
    ("support that begins after its stages", "&load",
     "&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 /\n"
     "&fix group = 'top' field = 'u_r' stages = 'load' from = 1 /\n&load",
     ["this &fix has no effect", "end at 1 s"]),
    ("support of a stage by times of the stage", "&load", "&stage name = 'rest' analysis = 'static' duration = 1 "
     "dt = 1 /\n&fix group = 'top' field = 'u_r' stages = 'rest' until = 0.5 /\n&load",
     ["this &fix has no effect: its stages begin at 1 s and end at 2 s, none of them between from and until, "
      "which are times of the run"]),
    ("rain on the axis", "&load", "&load group = 'left' kind = 'rain' value = 1e-8 /\n&load",
     ["no rain falls on 'left': none of its edges faces upwards, and it is a seepage face"]),
    ("pressure on the axis", "'top' kind = 'pressure'", "'left' kind = 'pressure'",
     ["scene.nml:17: the load has no effect: all nodes of 'left' lie at r = 0"]),
    ("force away from the axis", "'top' kind = 'pressure'", "'left' kind = 'force_r'",
     ["the load has no effect: all nodes of 'left' lie at r = 0"]),
    ("force along r on a plate that moves vertically", "&load", "&plate name = 'lid' r = 0, 2 z = 1 mass = 1 /\n"
     "&fix group = 'lid' field = 'u_z' /\n&load group = 'lid' kind = 'force_r' value = 1 /\n&load",
     ["scene.nml:19: the force has no effect: the plate 'lid' moves vertically alone"]),
    ("rain on a wall", "&load", "&load group = 'right' kind = 'rain' value = 1e-8 /\n&load",
     ["scene.nml:17: no rain falls on 'right': none of its edges faces upwards"]),
    ("rain from below", "&load", "&load group = 'bottom' kind = 'rain' value = 1e-8 /\n&load",
     ["no rain falls on 'bottom'"]),
    ("speeds of waves that are exchanged", "&load", "&stage name = 'wave' analysis = 'dynamic' duration = 1 dt = 1 /\n"
     "&absorbing group = 'bottom' rho = 2 c_p = 200 c_s = 400 stages = 'wave' /\n&load",
     ["c_p = 200 m/s beside c_s = 400 m/s", "exchanged"]),
    ("inflow of a static stage", "&load", "&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 /\n"
     "&load group = 'top' kind = 'water' value = 1e-6 stages = 'rest' /\n&load",
     ["the inflow has no effect: the stages in which it acts are static"]),
    ("energy of a stage without inertia", "dt = 0.5", "dt = 0.5 created_energy = 0.1",
     ["created_energy of &stage has no effect with analysis = 'quasi_static'"]),
    ("key without its partner", "'bottom' field = 'u_z'", "'bottom' field = 'u_z' datum = 1",
     ["datum of &fix has no effect without value_slope"]),
    ("key beside a file", "name = 'h'", "name = 'h' file = 'h.txt'", ["times of &history has no effect beside file"]),
    ("key of a static stage", "'quasi_static'", "'static'", ["rho_inf of &stage has no effect"]),
    ("key of a field", "'u-p_w'", "'u'", ["p_w_slope of &initial has no effect: the scene has no field p_w"]),
    ("key of a dynamic stage", "0.8 permeability", "0.8 damping = 3 permeability",
     ["damping of &region has no effect: no stage is dynamic"]),
    ("datum of no slope", "p_w_slope = -9.81", "p_w = -3 datum = 1",
     ["datum of &initial has no effect without p_w_slope or p_c_slope or wave"]),
    ("wave of no length", "surcharge = 0.5", "surcharge = 0.5 wave = 0.1",
     ["wave of &initial has no effect without"]),
    ("stress of no suction", "surcharge = 0.5", "surcharge = 0.5 k_0_of = 'effective'",
     ["k_0_of of &initial has no effect"]),
    ("history of no value", "&fix group = 'left' field = 'u_r'", "&fix group = 'left' field = 'u_r' history = 'h'",
     ["history of &fix has no effect without value or value_slope"]),
    ("output of given steps", "dt = 0.5", "dt = 0.5 output_dt = 1",
     ["output_dt of &stage has no effect on steps that"]),
    ("reference of a constant gas", "rho_w = 1", "rho_w = 1 p_ref = 90", ["p_ref of &fluids has no effect"]),
    ("definition of nobody", "&fix group = 'left'", "&retention name = 'x' /\n&fix group = 'left'",
     ["&retention 'x' has no effect", "no group names it as its retention"]),
    ("unit of a density", "rho_w = 1 ", "rho_w = 1000 ", ["scene.nml:5: rho_w = 1000 of &fluids", "Mg/m3 (water 1)"]),
    ("unit of a viscosity", "rho_w = 1 ", "eta_w = 1e-3 ", ["eta_w = 0.001 of &fluids", "kPa s (water 1e-6)"]),
    ("unit of a bulk modulus", "rho_w = 1 ", "k_w = 2.2e9 ", ["k_w = 2.2e9 of &fluids", "kPa (water 2.2e6)"]),
    ("unit of a grain", "void_ratio = 0.1", "void_ratio = 0.1 rho_s = 26.5", ["rho_s = 26.5 of &region", "quartz"]),
    ("region of nothing", "&region group = 'block_1_1'", "&region group = 'block_2_1' material = 'rock' "
     "void_ratio = 0.1 permeability = 'k' /\n&region group = 'block_1_1'",
     ["the region 'all' has no element", "other regions"]),
    ("no stress in sand", "stress = 'geostatic' surface = 0 surcharge = 0.5", "", ["24 points of MUD", "'geostatic'"]),
    ("pressure that grows upwards", "p_w_slope = -9.81", "p_w_slope = 9.81", ["p_w_slope = 9.81 kPa/m grows upwards"]),
    ("boundary pressure that grows upwards", "'top' field = 'p_w'", "'right' field = 'p_w' value_slope = 9.81",
     ["value_slope = 9.81 of p_w kPa/m grows upwards"]),
    ("rain on a given pressure", "&load", "&load group = 'top' kind = 'water' value = 1e-6 /\n&load",
     ["no effect on 2 of the 2 edges of 'top' in stage load", "pressure of water"]),
    ("rain on a pressure that is given as long as the stage lasts", "'top' field = 'p_w'",
     "'top' field = 'p_w' from = -1 until = 99 /\n&load group = 'top' kind = 'water' value = 1e-6",
     ["no effect on 2 of the 2 edges of 'top' in stage load", "pressure of water"]),
    ("history before what it acts on", "&stage", "&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 /\n"
     "&load group = 'top' kind = 'shear_r' value = 0.1 history = 'h' stages = 'load' /\n&stage",
     ["'h' begins at 0 s", "acts from 1 s on, at once with the factor 1, which then stays"]),
    ("gravity's history without gravity", "gravity = 9.81 /", "gravity_history = 'h' /",
     ["gravity_history of &scene has no effect without gravity"]),
    ("history of nobody", " history = 'h'", "", ["&history 'h' has no effect"]),
]


def refused(what, text, code, *words):
    (work / "scene.nml").write_text(text)
    for more in (["--check"], ["--output", work / "out"]):
        done = subprocess.run([host, work / "scene.nml", *more], capture_output=True, text=True, env=environment)
        check(f"{what}: refused by {more[0]}", done.returncode == code and all(word in done.stderr for word in words)
              and len(done.stderr.splitlines()) == 1, f"{done.returncode} {done.stderr}")


# A body that nothing holds is told by the motion and a place; what a tie, a plate or a contact holds is not.
FREE = """&scene name = 'free' geometry = 'plane_strain' /
&mesh r = 0, 1, 2 r_cells = 1, 1 z = 0, 1 z_cells = 1 /
&elastic name = 'rock' young = 1e4 poisson = 0.3 /
&region material = 'rock' void_ratio = 0 /
&stage name = 'push' analysis = 'static' duration = 1 dt = 1 /
&load group = 'top' kind = 'pressure' value = 1 /
"""
LEFT, BOTTOM = "&fix group = 'left' field = 'u_r' /\n", "&fix group = 'bottom' field = 'u_z' /\n"

# A corner that gets through a contact whose mean gaps are open: the top of a tilted block stands 2 mm in a plate at one
# end and 60 mm below it at the other. The default gap presses it.
TILTED = """&scene name = 'tilted' fields = 'u' geometry = 'plane_strain' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'rock' young = 1e4 poisson = 0 /
&region material = 'rock' void_ratio = 0.1 /
&plate name = 'plate' r = 0, 1 z = 1 mass = 1 /
&contact name = 'face' slave = 'top' master = 'plate' gap = 'nodal' penalty = 1e3 /
&stage name = 'push' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-6 /
&fix group = 'plate' field = 'u_z' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'left' field = 'u_z' value = 0.002 /
&fix group = 'right' field = 'u_z' value = -0.06 /
&load group = 'right' kind = 'pressure' value = 1 /
"""


def told_of_penetration(gap):
    (work / "tilted.nml").write_text(TILTED.replace("'nodal'", f"'{gap}'"))
    done = subprocess.run([host, work / "tilted.nml", "--output", work / f"tilted_{gap}"], capture_output=True,
                          text=True, env=environment)
    check(f"tilted block, {gap}: it runs", done.returncode == 0, done.stderr)
    return ([line for line in done.stderr.splitlines() if "penetrated each other" in line],
            float(tables.rows(work / f"tilted_{gap}/contact.csv")[-1]["face.thrust"]))


# Pressures that jump from node to node are told while the run goes on: a column that hardly drains, and its measure.
COLUMN = """&scene name = 'column' fields = 'u-p_w' pressures = 'quadratic' geometry = 'plane_strain' /
&mesh r = 0, 0.25 r_cells = 1 z = 0, 1 z_cells = 8 /
&elastic name = 'soil' young = 1e4 poisson = 0.25 /
&permeability name = 'k' intrinsic = 1e-12 law = 'constant' /
&region material = 'soil' permeability = 'k' void_ratio = 0.8 /
&stage name = 'load' analysis = 'quasi_static' duration = 2e-3 dt = 1e-3 rho_inf = 0 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_w' /
&load group = 'top' kind = 'pressure' value = 100 /
"""

# A point that is expanded: without the tension cut-off p' falls below zero, which is told once, with its place.
EXPANDED = """&scene name = 'expanded' geometry = 'plane_strain' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&mud name = 'sand' {} /
&region material = 'sand' /
&initial stress = 'uniform' sigma = -20, -20, -20 /
&stage name = 'pull' analysis = 'static' duration = 1 dt = 0.05 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'u_z' value = 0.01 history = 'ramp' /
&history name = 'ramp' times = 0, 1 values = 0, 1 /
"""


def test_no_doubt_no_warning():
    check("no doubt, no warning", warnings(SCENE, "--check") == [], warnings(SCENE, "--check"))
    (work / "h.txt").write_text("0 0\n1 1\n")
    for what, old, new, words in DOUBTS:
        check(f"{what}: the text is there", SCENE.count(old) == 1, old)
        if "fields" in SCENE and what == "key of a field":
            text = SCENE.replace(old, new).replace("&fix group = 'top' field = 'p_w' /\n", "")
        else:
            text = SCENE.replace(old, new)
        told = warnings(text, "--check")
        check(what, any(all(word in line for word in words) for line in told), told)

    # Fluids that cannot leave answer in time alone.
    closed = SCENE.replace("void_ratio = 0.1 permeability = 'k'", "void_ratio = 0.1 drainage = 'undrained'")
    for analysis, count in (("static", 1), ("quasi_static", 0)):
        told = [line for line in warnings(closed.replace("'quasi_static'", f"'{analysis}'"), "--check")
                if "scene.nml:8: the region 'block_1_1' keeps its fluids" in line and "as drained ground" in line]
        check(f"undrained ground in {analysis} stages", len(told) == count, told)

    # A base that is 1 mm down when displacements are zeroed goes down once more; held, let go, not moved yet or back at
    # 0, it does not.
    zeroed = SCENE.replace("&stage name = 'load'", "&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 "
                           "zero_displacements = 'yes' /\n&stage name = 'load'")
    for keys, count in (("value = -0.001", 1), ("value = -0.001 history = 'h'", 1), ("hold = 'yes'", 0),
                        ("value = -0.001 until = 1", 0), ("value = -0.001 until = 1.5", 1),
                        ("value = -0.001 from = 1", 0), ("value = -0.001 from = 0.5", 1),
                        ("value = -0.001 stages = 'rest' /\n&fix group = 'bottom' field = 'u_z' hold = 'yes' "
                         "stages = 'load'", 0)):
        told = [line for line in warnings(zeroed.replace("'bottom' field = 'u_z'", f"'bottom' field = 'u_z' {keys}"),
                                          "--check") if "counts from there" in line]
        check(f"displacements are zeroed: {keys}", len(told) == count, told)

    # Times of stages add up with rounding: 0.1 + 0.2 lies above 0.3, 0.7 + 0.1 below 0.8.
    for durations, key in (((0.1, 0.2), "from = 0.3"), ((0.7, 0.1), "until = 0.8")):
        stages = "".join(f"&stage name = 'r{k}' analysis = 'static' duration = {d} dt = {d} zero_displacements = "
                         f"'{'yes' if k else 'no'}' /\n" for k, d in enumerate(durations))
        rounded = SCENE.replace("&stage name = 'load'", stages + "&stage name = 'load'")
        told = [line for line in warnings(rounded.replace("'bottom' field = 'u_z'", "'bottom' field = 'u_z' value = "
                                                          f"-0.001 {key}"), "--check") if "counts from there" in line]
        check(f"displacements are zeroed where it begins or ends: {key}", told == [], told)

    # Water of twice the weight, whose pressure stays: without weight, or where it flows, there is no doubt.
    heavier = SCENE.replace("gravity = 9.81 /", "gravity = 9.81 gravity_history = 'g' /\n"
                            "&history name = 'g' times = 0, 1 values = 1, 2 /")
    for what, words, rho, old, new in (("a static stage keeps", 1, 1, "'quasi_static'", "'static'"),
                                       ("a static stage keeps", 0, 0, "'quasi_static'", "'static'"),
                                       ("drained regions keep", 1, 1, "0.8 perm", "0.8 drainage = 'drained' perm"),
                                       ("gravity_history", 0, 1, "none", "")):
        told = [line for line in warnings(heavier.replace(old, new).replace("rho_w = 1", f"rho_w = {rho}"), "--check")
                if what in line]
        check(f"water that gets heavier: {what}", [line.count("from 1 to 2") for line in told] == [1]*words, told)


def test_contacts_of_the_same_boundaries():
    again = "&contact name = 'again' slave = 'top' master = 'plate' penalty = 1e3 /\n"
    stage = "&stage name = 'more' analysis = 'static' duration = 1 dt = 1 /\n"
    doubled = TILTED.replace("&stage", again + "&stage")
    told = [line for line in warnings(doubled, "--check") if "penalties add" in line]
    words = ("'again'", "'face' in line 6")
    check("two contacts of one pair are told", len(told) == 1 and all(word in told[0] for word in words), told)
    apart = (doubled.replace("gap = 'nodal'", "stages = 'push'").replace("'plate' penalty = 1e3 /\n&stage", "'plate' "
             "stages = 'more' /\n&stage").replace("&fix group = 'plate'", stage + "&fix group = 'plate'"))
    told = [line for line in warnings(apart, "--check") if "penalties add" in line]
    check("with stages of their own they are not", "'more'" in apart and told == [], told)


def test_keys_of_mud_that_nothing_asks_for():
    told = warnings(SCENE.replace("toyoura.nml'", "toyoura.nml' P_a = 7 b_1 = 2 e_0 = 0.7"), "--check")
    for key, why in (("P_a", "the scene has no field p_c"), ("b_1", "the scene has no field p_c"),
                     ("e_0", "every &region of the material gives void_ratio")):
        check(f"{key} of &mud has no effect", any(f"{key} of &mud has no effect: {why}" in t for t in told), told)
    told = warnings(SCENE.replace("toyoura.nml'", "toyoura.nml' e_0 = 0.7").replace("void_ratio = 0.8 ", ""), "--check")
    check("e_0 is that of a region without void_ratio", told == [], told)


def test_a_long_path_is_whole():
    # A path of more than 256 characters: messages name it to its end, and a mesh beside the scene is looked for there.
    folder = work
    while len(str(folder)) < 300:
        folder /= "d" * 40
    folder.mkdir(parents=True)
    (folder / "scene.nml").write_text(SCENE.replace("&mesh r = 0, 1, 2 r_cells = 1, 1 z = -2, 0 z_cells = 2 /",
                                                    "&mesh file = 'absent.msh' /"))
    done = subprocess.run([host, folder / "scene.nml", "--check"], capture_output=True, text=True, env=environment)
    check("a mesh is looked for beside the scene", f"{folder}/absent.msh" in done.stderr, done.stderr)
    (folder / "scene.nml").write_text(SCENE.replace("duration = 1", "durations = 1"))
    done = subprocess.run([host, folder / "scene.nml", "--check"], capture_output=True, text=True, env=environment)
    check("a message names the scene to its end", f"{folder}/scene.nml:11" in done.stderr, done.stderr)


# Keys whose condition the program alone knows, as `:p_c` where they are declared: many in a scene, each with a reason.
IDLE = """&scene name = 'idle' geometry = 'plane_strain' fields = '{fields}' pressures = 'linear'
 saturation_rate = 'full' seepage_inertia = 'no' initial_flow = 'drain' gravity = {gravity} lanes = 'yes' /
&mesh r = 0, 1, 2 r_cells = 1, 1 z = 0, 1 z_cells = 1 /
&elastic name = 'rock' young = 1e6 poisson = 0.3 /
&fluids k_w = 2e6 rho_w = 1 eta_w = 1e-6 gas = '{gas}' {air} rho_a = 0.001 eta_a = 2e-8 henry = 0 /
&retention name = 'c' /
&permeability name = 'k' intrinsic = 1e-11 law = '{law}' {relative} /
&region group = 'block_1_1' material = 'rock' void_ratio = 0.5 drainage = '{drainage}' {pores} damping = 0
 stiffness_damping = 0 viscosity = 0 /
&region material = 'rock' void_ratio = 0.5 drainage = '{drainage}' {pores} /
&initial stress = 'geostatic' k_0_of = 'net' {start} /
&stage name = 's' analysis = '{analysis}' duration = 1 {steps} /
&tie first = 'left' second = 'right' pressures = 'no' /
&plate name = 'lid' r = 0, 2 z = 1 mass = 1 weight = 'yes' /
&contact name = 'face' slave = 'top' master = 'lid' drainage = 'fixed' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'lid' field = 'u_z' /
"""
POROUS = "retention = 'c' permeability = 'k'"
CURVE = "s_min = 0 s_max = 1 b = 3 c = 2 floor = 1e-4"
SCENES = {   # What differs from this scene.
    "": dict(fields="u-p_w-p_c", gravity=9.81, gas="constant", air="k_a = 100", law="corey", relative=CURVE,
             drainage="coupled", pores=POROUS, start="p_w = 0 p_w_slope = 0", analysis="static",
             steps="dt = 1 output_dt = 1 dt_max = 1"),
    "power": dict(law="power", relative="a = 0 b = 3 c = 2"), "mualem": dict(law="mualem", relative="m = 0.5"),
    "constant": dict(law="constant", relative="k_rw = 1 k_ra = 1"),
    "quasi": dict(analysis="quasi_static", steps="dt_growth = 2 dt_max = 1"),
    "dynamic": dict(analysis="dynamic", steps="dt = 1"), 
    "no_air": dict(fields="u-p_w", start="p_c = 0 p_c_slope = 0 saturation = 1"), "dry": dict(fields="u"),
    "light": dict(gravity=0), "ideal": dict(gas="ideal", air="p_ref = 100"),
    "table": dict(start="water_table = 0"), "moving": dict(start="v_z = 1 wave = 1 wave_number = 1"),
    "drained": dict(drainage="drained", pores="retention = 'c'")}
TOLD = [   # The differences of a scene, why keys of it have no effect, these keys.
    ("", "every stage is static", "scene.saturation_rate scene.initial_flow fluids.k_w fluids.eta_w fluids.k_a "
     "fluids.eta_a fluids.henry permeability.s_min permeability.s_max permeability.b permeability.c permeability.floor "
     "region.viscosity"),
    ("", "no stage is dynamic", "region.damping region.stiffness_damping scene.seepage_inertia"),
    ("", "on steps that are given", "stage.output_dt stage.dt_max"),
    ("moving", "the run begins with stage s", "initial.v_z initial.wave"),
    ("", "this processor is older than x86-64-v3", "scene.lanes"),
    ("power", "every stage is static", "permeability.a permeability.b permeability.c"),
    ("mualem", "every stage is static", "permeability.m"),
    ("constant", "every stage is static", "permeability.k_rw permeability.k_ra"),
    ("quasi", "on controlled steps", "stage.dt_growth"), ("light", "without gravity", "plate.weight"),
    ("quasi no_air", "no field p_c", "scene.saturation_rate fluids.gas fluids.k_a fluids.rho_a fluids.eta_a "
     "fluids.henry permeability.s_min permeability.s_max permeability.b permeability.c permeability.floor "
     "region.retention initial.p_c initial.p_c_slope initial.saturation initial.k_0_of"),
    ("quasi no_air power", "no field p_c", "permeability.a permeability.b"),
    ("quasi no_air mualem", "no field p_c", "permeability.m"),
    ("quasi no_air constant", "no field p_c", "permeability.k_ra"), ("no_air ideal", "no field p_c", "fluids.p_ref"),
    ("dynamic dry constant", "no field p_w", "scene.pressures scene.seepage_inertia scene.initial_flow fluids.k_w "
     "fluids.rho_w fluids.eta_w region.permeability region.drainage initial.p_w initial.p_w_slope tie.pressures "
     "contact.drainage permeability.k_rw"),
    ("dry table", "no field p_w", "initial.water_table"),
    ("quasi drained", "no &region has drainage", "scene.initial_flow fluids.eta_w fluids.eta_a")]


def conditions_of_sources():
    """(key, condition) of every key whose condition the program alone knows."""
    text = "".join(re.sub(r"&\n\s*", "", path.read_text()) for path in sorted((root / "host").rglob("*.f90")))
    return {(key, condition) for key, rest in re.findall(r"call k%\w+\('(\w+)'(.*)", text)
            for words in re.findall(r"'((?:[\w=|]+ )*:[\w: ]+)'", rest) for condition in re.findall(r":\w+", words)}


def test_every_key_without_effect_is_told_with_its_reason():
    conditions = {"every stage is static": ":time", "no stage is dynamic": ":dynamic", "on steps that": ":controlled",
                  "on controlled steps": ":given", "without gravity": ":gravity", "no field p_c": ":p_c",
                  "no field p_w": ":p_w", "no &region has drainage": ":flow", "this processor": ":lanes",
                  "the run begins with": ":moving"}
    said = {}
    for which, why, keys in TOLD:
        if which not in said:
            values = {k: v for name in ["", *which.split()] for k, v in SCENES[name].items()}
            said[which] = warnings(IDLE.format(**values), "--check")
        for group, key in (key.split(".") for key in keys.split()):
            check(f"{which}: {key} of &{group}", any(f"{key} of &{group} has no effect" in line and why in line
                                                     for line in said[which]), said[which])
    check("dt_max limits controlled steps", not any("dt_max" in line for line in said["quasi"]), said["quasi"])
    tried = {(key.split(".")[1], condition) for _, why, keys in TOLD for key in keys.split()
             for words, condition in conditions.items() if why.startswith(words)}
    tried |= {("dt_max", ":grows")}
    left = conditions_of_sources() - tried
    check("and each condition of a key is tried", not left and len(tried) > 50, sorted(left))


def test_an_incompressible_viscous_water_is_no_doubt():
    # What is meant: an incompressible water, a second cycle of a history that has begun before.
    meant = SCENE.replace("rho_w = 1 ", "k_w = 1e12 eta_w = 1e-4 ")
    check("an incompressible, viscous water is no doubt", warnings(meant, "--check") == [], warnings(meant, "--check"))


def test_the_regions_are_there():
    # Which of two regions an element belongs to is said, or refused; the order of the groups decides nothing.
    refused("two regions of one element", SCENE.replace("&region material", "&region group = 'all' material"), 11,
            "'block_1_1' and 'all'", "have 4 elements in common", "without group")
    ground = "&region material = 'sand' void_ratio = 0.8 permeability = 'k' /\n"
    beam = "&region group = 'block_1_1' material = 'rock' void_ratio = 0.1 permeability = 'k' /\n"
    check("the regions are there", ground + beam in SCENE)
    for name, text in (("one", SCENE), ("two", SCENE.replace(ground + beam, beam + ground))):
        (work / "scene.nml").write_text(text)
        done = subprocess.run([host, work / "scene.nml", "--quiet", "--output", work / name], capture_output=True,
                              text=True, env=environment)
        check(f"order {name} runs", done.returncode == 0, done.stderr)
    check("the region without a group has the rest, wherever it stands",
          (work / "one/histories.csv").read_bytes() == (work / "two/histories.csv").read_bytes())
    refused("a body without a support", FREE, 13, "Stage push: nothing holds the body of node 1 of element 1, (0, 0) m",
            "u_r")
    refused("a body that slides", FREE + LEFT, 13, "against moving along z (y)")
    refused("a body that slides sideways", FREE + BOTTOM, 13, "against moving along r (x)")
    refused(
        "a body that turns", FREE +LEFT +"&fix group = 'left' field = 'u_z' /\n".replace("'left'", "'corner'"),
        11, "no group 'corner'")
    refused("a body that turns about a line of supports", FREE + BOTTOM.replace("u_z", "u_r") + BOTTOM.replace(
        "u_z", "u_r"), 13, "against moving along z (y)")
    # Held along r at one z and along z at one r it turns about the corner where the two lines meet.
    pinned = FREE + BOTTOM.replace("u_z", "u_r") + LEFT.replace("u_r", "u_z")
    refused("a body that turns about a corner", pinned, 13, "against turning; add a &fix of u_z or u_r")
    check("held at a third line it does not turn", warnings(pinned + LEFT, "--check") == [], pinned)
    refused("a plate without a contact", FREE + LEFT + BOTTOM + "&plate name = 'p' r = 0, 1 z = 2 mass = 1 /\n", 13,
            "nothing holds the body of plate p")
    # Two plates on one boundary would be one body with one mass: that of one of them would be lost.
    lid = "&plate name = 'lid' group = 'top' mass = 1 /\n"
    for group in ("top", "right"):
        refused(f"a plate on '{group}' beside one on 'top'",
                FREE + LEFT + BOTTOM + lid + f"&plate name = 'p' group = '{group}' mass = 1 /\n", 11,
                f"its boundary '{group}' shares node", "with that of the plate 'lid'")
    for what, text in (("held", FREE + LEFT + BOTTOM), ("in axial symmetry", FREE.replace("'plane_strain'",
                                                                                         "'axisymmetric'") + BOTTOM),
                       ("dynamic", FREE.replace("'static'", "'dynamic'")),
                       ("held by a contact", FREE + LEFT + "&plate name = 'p' r = 0, 2 z = 0 face = 'up' mass = 1 /\n"
                        "&contact name = 'c' slave = 'bottom' master = 'p' /\n&fix group = 'p' field = 'u_z' /\n")):
        check(f"a body that is {what} is no doubt", warnings(text, "--check") == [], text)

    # A byte-order mark is skipped, in a scene and in a history.
    (work / "h.txt").write_bytes(b"\xef\xbb\xbf0 0\n1 1\n")
    (work / "marked.nml").write_bytes(b"\xef\xbb\xbf" + SCENE.replace("times = 0, 1 values = 0, 1",
                                                                      "file = 'h.txt'").encode())
    done = subprocess.run([host, work / "marked.nml", "--quiet", "--output", work / "marked"], capture_output=True,
                          text=True, env=environment)
    check("a byte-order mark is skipped", done.returncode == 0 and (work / "marked/histories.csv").read_bytes()
          == (work / "one/histories.csv").read_bytes(), done.stderr)


def test_a_failure_names_sand_without_stress():
    # Sand without stress: where Newton's method fails for it, the cause is named.
    bare = SCENE.replace("stress = 'geostatic' surface = 0 surcharge = 0.5", "")
    bare = bare.replace("dt = 0.5", "dt = 0.5 cuts = 0")
    bare = bare.replace("value = 5 history", "value = 5000 history").replace("'quasi_static'", "'static'").replace(
        " rho_inf = 0", "")
    (work / "scene.nml").write_text(bare)
    done = subprocess.run([host, work / "scene.nml", "--quiet", "--output", work / "out"],
                          capture_output=True, text=True, env=environment)
    check("a failure names sand without stress", done.returncode in (13, 14, 15)
          and "points of MUD began without effective stress" in done.stderr, f"{done.returncode} {done.stderr}")

    told, thrust = told_of_penetration("nodal")
    check("a penetration without pressure is told once, with its place and share of the edge",
          len(told) == 1 and "contact face" in told[0] and "near (0.5" in told[0] and "% of an edge" in told[0], told)
    check("mean gaps let the corner through", thrust == 0, thrust)
    told, thrust = told_of_penetration("combined")
    check("combined gaps press the corner, and tell nothing", not told and thrust != 0, (told, thrust))
    for what, text, said in (("quadratic pressures without drainage", COLUMN, 1),
                             ("linear pressures without drainage",
                              COLUMN.replace("pressures = 'quadratic'", ""), 0),
                             ("quadratic pressures that drain", COLUMN.replace("1e-12", "1e-8"), 0)):
        (work / "scene.nml").write_text(text)
        done = subprocess.run([host, work / "scene.nml", "--output", work / "out", "--quiet"], capture_output=True,
                              text=True, env=environment)
        lines = [line for line in done.stderr.splitlines() if "alternate from node to node" in line]
        check(f"{what}: warned {said} times", done.returncode == 0 and len(lines) == said, done.stderr)
        check(f"{what}: the measure is named", not said or "pressures = 'linear'" in lines[0], lines)
    for what, keys, said in (("with the cut-off", "", 0), ("without it", "cutoff = 0", 1)):
        (work / "scene.nml").write_text(EXPANDED.format(keys))
        done = subprocess.run([host, work / "scene.nml", "--output", work / "out", "--quiet"], capture_output=True,
                              text=True, env=environment)
        lines = [line for line in done.stderr.splitlines() if "the mean effective stress p' at (" in line]
        check(f"{what}, p' below zero is told {said} times", len(lines) == said and done.returncode == 0,
              f"{done.returncode} {done.stderr}")


def test_small_mesh():
    small = SCENE.replace("r = 0, 1, 2", "r = 0, 1e-4, 2e-4").replace("z = -2, 0", "z = -2e-4, 0").replace("z = -2 /",
                                                                                                         "z = -2e-4 /")
    check("small mesh", any("the mesh is 2e-4 m large" in line for line in warnings(small, "--check")), small)
    same = SCENE.replace("&fix group = 'bottom' field = 'u_r' /", "&fix group = 'bottom' field = 'u_r' value = 0 /\n"
                         "&fix group = 'left' field = 'u_r' stages = 'load' /")
    check("two supports of one value are no doubt", warnings(same, "--check") == [], warnings(same, "--check"))
    # A history of 1 s goes on for 1e-5 s before the stage in which it acts: that is no jump.
    begun = SCENE.replace("&stage", "&stage name = 'rest' analysis = 'static' duration = 1e-5 dt = 1e-5 /\n&stage")
    told = warnings(begun.replace("history = 'h'", "history = 'h' stages = 'load'"), "--check")
    check("a history that has hardly begun is no doubt", not any("at once" in line for line in told), told)
    # Water at z = 0 of a falling level and air above it both ask for 0 there, whatever the history.
    level = SCENE.replace("&fix group = 'top' field = 'p_w'", "&history name = 'fall' times = 0, 1 values = 1, 0.5 /\n"
                          "&fix group = 'right' field = 'p_w' value_slope = -10 datum = {} history = 'fall' /\n"
                          "&fix group = 'top' field = 'p_w'")
    check("values that agree at the nodes they share are no doubt", warnings(level.format(0), "--check") == [],
          warnings(level.format(0), "--check"))
    check("those that do not are", ["p_w of the node at (2, 0) m has two &fix" in line
                                    for line in warnings(level.format(-1), "--check")] == [True],
          warnings(level.format(-1), "--check"))
    # Of two limits the smaller one counts, whichever is written last.
    check("nor is a limit beside another", not any("two &fix" in line for line in warnings(level.format(
        "-1 kind = 'seepage'").replace("'top' field = 'p_w'", "'top' field = 'p_w' kind = 'seepage'"), "--check")))
    doubtful = SCENE.replace("surface = 0", "surface = 0 sigma = 1, 1, 1").replace("dt = 0.5", "dt = 0.05")
    check("told at the start of a run", len(warnings(doubtful)) == 1)
    check("told by a quiet run as well", len(warnings(doubtful, "--quiet")) == 1)


def test_an_iterate_that_strains_soil_by_more_than_one_is_no_convergence():
    # No law is asked there: the iteration fails, not the material.
    pulled = """&scene name = 'pulled' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'soil' young = 1.0e4 poisson = 0.25 /
&region material = 'soil' void_ratio = 0 /
&stage name = 's' analysis = 'static' duration = 1 dt = 1 cuts = 0 /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'left' field = 'u_r' /
&fix group = 'top' field = 'u_z' value = 2 /
"""
    done = start("pulled", pulled)
    check("exit code 14 and where", done.returncode == 14
          and "the material of element 1, point 1, is strained by more than 1 in the step" in done.stderr, done.stderr)


def test_a_material_outside_its_tests_is_told():
    def told(keys):
        text = SCENE.replace("toyoura.nml'", "toyoura.nml' " + keys)
        return [line for line in warnings(text, "--check") if "fitted to" in line]

    inside = "tested_e_min = 0.7 tested_e_max = 0.9 tested_p_min = 0.1 tested_p_max = 50"
    check("inside is no doubt", told(inside) == [])
    loose = told("tested_e_min = 0.6 tested_e_max = 0.75")
    check("a void ratio", len(loose) == 1
          and "scene.nml:7: material 'sand' begins outside what it was fitted to at 24 of 24 points: the "
          "void ratio is 0.8, in its tests 0.6 to 0.75." in loose[0], loose)
    low = told("tested_p_min = 100 tested_p_max = 800")
    check("a stress", len(low) == 1 and "kPa, in its tests 100 to 800" in low[0], low)
    # Of the 24 points those below the surface alone have less than 2 kPa: fewer than a tenth of them.
    check("a few points below the surface are none", told("tested_p_min = 0.5 tested_p_max = 800") == [])
    (work / "scene.nml").write_text(SCENE.replace("toyoura.nml'", "toyoura.nml' tested_e_min = 1 tested_e_max = 0.5"))
    done = subprocess.run([host, work / "scene.nml", "--check"], capture_output=True, text=True, env=environment)
    check("a range upside down is refused", done.returncode == 2 and "at most tested_e_max" in done.stderr, done.stderr)


PULSES = (SCENE.replace("times = 0, 1 values = 0, 1", "kind = 'triangle' period = 0.1 repeats = {repeats}")
          .replace("duration = 1 dt = 0.5", "duration = {repeats}e-1 dt = 0.05 steps = 'given'"))
# Ripples of a fiftieth of the range turn as often.
RIPPLES = ", ".join(f"{0.05*i:g}" for i in range(24)), ", ".join(f"{0.5 + 0.02*(i % 2):g}" for i in range(24))


def told_of_cycles(text):
    return [line for line in warnings(text, "--quiet") if "settlement that cycles accumulate" in line]


def test_a_load_that_turns_more_than_twenty_times_is_told_once():
    # Eleven triangles have eleven tops and ten feet between them, ten have nineteen turns.
    told = told_of_cycles(PULSES.format(repeats=11))
    check("eleven pulses are told once", len(told) == 1 and "history 'h' has turned 21 times" in told[0] and
          "40 to 90 times" in told[0] and "drained_cycles/README.md" in told[0], told)
    check("ten are not", told_of_cycles(PULSES.format(repeats=10)) == [])
    elastic = PULSES.format(repeats=11).replace("material = 'sand'", "material = 'rock'")
    check("elastic ground is not told of", told_of_cycles(elastic) == [])
    ripples = PULSES.format(repeats=12).replace("kind = 'triangle' period = 0.1 repeats = 12",
                                                f"times = 0, {RIPPLES[0][3:]}, 1.2 values = 0, {RIPPLES[1][5:]}, 1")
    check("nor a load that ripples", told_of_cycles(ripples) == [])


SWINGING = f"""&scene name = 'free' fields = 'u' gravity = 9.81 /
&mesh r = 0, 1 r_cells = 1 z = -1.8, 0 z_cells = 2 /
&mud name = 'sand' file = '{root}/drivers/materials/toyoura.nml' /
&elastic name = 'rock' young = 9e4 poisson = 0.2 /
&region material = 'sand' void_ratio = 0.8 rho_s = 2.65 /
&initial stress = 'geostatic' surface = 0 surcharge = 25 /
&plate name = 'block' group = 'top' mass = 8 force = -78.54 /
&stage name = 'rest' analysis = 'static' duration = 1 zero_displacements = 'yes' /
&stage name = 'free' analysis = 'dynamic' duration = 2.4 dt = 0.005 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 5 stages = 'free' /
"""


def test_ground_that_swings_more_than_twenty_times_is_told_once():
    # The block swings freely, with no history and about 11 periods a second.
    told = told_of_cycles(SWINGING)
    check("a free vibration is told once", len(told) == 1 and " m has turned 21 times" in told[0] and
          "the ground at (" in told[0], told)
    check("a short one is not", told_of_cycles(SWINGING.replace("duration = 2.4", "duration = 0.6")) == [])
    # With 5 % of damping swings have fallen below a quarter of the largest displacement after ten.
    check("nor one that dies away", told_of_cycles(SWINGING.replace("rho_s = 2.65", "rho_s = 2.65 damping = 30")) == [])
    check("nor elastic ground", told_of_cycles(SWINGING.replace("material = 'sand'", "material = 'rock'")) == [])
    # The weight of the block and of the ground settles it by more than it swings.
    settled = SWINGING.replace("zero_displacements = 'yes'", "").replace("surcharge = 25", "surcharge = 5")
    check("nor does a settlement before hide it", len(told_of_cycles(settled)) == 1, told_of_cycles(settled))
    machine = """&plate name = 'mass' r = 0, 0.5 z = 1 mass = 2.2 force = -33 /
&buffer upper = 'mass' lower = 'block' stiffness = 1.8e4 tension = 'yes' stages = 'free' /
&fix group = 'mass' field = 'u_z' stages = 'rest' /
"""
    on_spring = SWINGING.replace("&load group = 'top' kind = 'pressure' value = 5 stages = 'free' /\n", machine)
    check("a mass that is let go on a buffer is", len(told_of_cycles(on_spring)) == 1, on_spring)


def test_a_restart_tells_no_warning_twice():
    # The strain is told at the end of the first stage, in step 1; the checkpoint is that of step 2 of 3.
    scene = work / "taken_up.nml"
    scene.write_text("""&scene name = 'b' geometry = 'plane_strain' fields = 'u' checkpoint_steps = 2 /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'm' young = 1e4 poisson = 0.25 /
&region material = 'm' void_ratio = 0 /
&stage name = 'one' analysis = 'static' duration = 1 dt = 1 /
&stage name = 'two' analysis = 'static' duration = 1 dt = 0.5 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 1126.4 /
""")
    whole, taken_up = (subprocess.run([host, scene, "--output", work / "taken_up", *words], capture_output=True,
                                      text=True, env=environment)
                       for words in ((), ("--restart", work / "taken_up/checkpoint.h5")))
    check("a run tells it once", whole.stderr.count("the ground is strained") == 1, whole.stderr)
    check("one that is taken up does not", taken_up.returncode == 0 and "strained" not in taken_up.stderr,
          taken_up.stderr)
    ends = [done.stdout.partition("Warnings of this run:")[2] for done in (whole, taken_up)]
    check("the end of both repeats it", ends[0].count("the ground is strained") == 1 and ends[0] == ends[1], ends)


def test_turns_are_counted_over_a_restart():
    text = PULSES.format(repeats=11).replace("gravity = 9.81", "gravity = 9.81 checkpoint_steps = 21")
    start("turns", text)
    done = start("turns", text, "--restart", work / "turns/checkpoint.h5")
    check("a run that is taken up knows the turns before", "has turned 21 times" in done.stderr, done.stderr)
