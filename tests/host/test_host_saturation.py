# SPDX-License-Identifier: MIT
"""Soil with hydraulic hysteresis starts from a given degree of saturation, in the driver and in the host; a run of
regions with different drainage, taken up again, gives the same bytes, turning points of suction included; a drainage
that does not exist is refused."""
import subprocess

from checking import build, check, root, work
import tables  # noqa: E402 (checking knows its folder)

HOST, DRIVER = build / "host/mud_host", build / "drivers/mud_triax"
MATERIAL = root / "drivers/materials/toyoura.nml"
DRY_END, WET_END = 0.754, 0.517   # S_w of main drying and main wetting at 8 kPa and e 0.8, rounded


def start(program, text, name, *more):
    path = work / f"{name}.nml"
    path.write_text(text)
    results = work / (name + (".csv" if program == DRIVER else ""))
    return subprocess.run([program, path, "--quiet", "--output", results, *more], capture_output=True, text=True)


def drying(preset, hysteresis=1):
    """A test of one point under constant net stress: dried by 0.1 kPa, then wetted to where it came from."""
    return f"""&case name = 's' /
&material file = '{MATERIAL}' hysteresis = {hysteresis} /
&initial p_eff = 100 void_ratio = 0.8 suction = 8 {preset} /
&stage control = 'constant_net_stress' suction_end = 8.1 increment = 0.05 output_interval = 0.1 /
&stage control = 'constant_net_stress' suction_end = 8 increment = 0.05 output_interval = 0.1 /
"""


def saturation(text, name):
    done = start(DRIVER, text, name)
    check(f"{name} runs", done.returncode == 0, done.stderr)
    return tables.columns(work / f"{name}.csv")["s_w"]


SCENE = """&scene name = 'regions' geometry = 'plane_strain' fields = 'u-p_w-p_c' checkpoint_steps = 3 /
&mesh r = 0, 0.1 r_cells = 1 z = 0, 0.1, 0.2, 0.3, 0.4 z_cells = 1, 1, 1, 1 /
&mud name = 'sand' file = '{material}' hysteresis = 1 /
&permeability name = 'k' intrinsic = 1e-11 /
&region group = 'block_1_1' material = 'sand' void_ratio = 0.8 drainage = 'dry' /
&region group = 'block_1_2' material = 'sand' void_ratio = 0.8 drainage = 'drained' retention = 'material' /
&region group = 'block_1_3' material = 'sand' void_ratio = 0.8 drainage = 'undrained' retention = 'material' /
&region group = 'block_1_4' material = 'sand' void_ratio = 0.8 drainage = 'coupled' retention = 'material'
        permeability = 'k' /
&initial p_w = -8 p_c = 8 stress = 'uniform' sigma = -50, -50, -50 {preset} /
&history name = 'h' times = 0, 1 values = 1, 1.2 /
&stage name = 'load' analysis = 'quasi_static' duration = 1 dt = 0.2 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_a' /
&fix group = 'top' field = 'p_w' value = -8 history = 'h' /
&load group = 'top' kind = 'pressure' value = 50 history = 'h' /
&point name = 'top' r = 0 z = 0.4 /
&point name = 'middle' r = 0 z = 0.2 /
""".replace("{material}", str(MATERIAL))


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix == ".csv"}


def test_driver_without_a_preset_it_starts_on_the_main_drying_curve():
    main, between = saturation(drying(""), "main"), saturation(drying("saturation = 0.62"), "between")
    check("driver: without a preset it starts on the main drying curve", abs(main[0] - DRY_END) < 1e-3, main)
    check("driver: it starts from the preset", abs(between[0] - 0.62) < 1e-12, between)
    check("driver: between the main curves it dries less than on one",
          0 < between[0] - between[1] < 0.7 * (main[0] - main[1]), (main, between))
    done = start(DRIVER, drying("saturation = 0.9"), "outside")
    check("driver: a preset above main drying is refused, with what is allowed", done.returncode == 2
          and all(word in done.stderr for word in ("saturation", "0.9", str(DRY_END), str(WET_END))), done.stderr)
    done = start(DRIVER, drying("saturation = 0.62", 0), "single")
    check("driver: a preset without hysteresis is refused, with the remedy", done.returncode == 2
          and "hysteresis = 1" in done.stderr, done.stderr)


def test_host_four_drainages_in_one_scene_run():
    done = start(HOST, SCENE.format(preset="saturation = 0.62"), "regions")
    check("host: four drainages in one scene run", done.returncode == 0, done.stderr)
    first = tables.columns(work / "regions/histories.csv")["top.S_w"][0]
    check("host: it starts from the preset", abs(first - 0.62) < 0.01, first)
    before = files(work / "regions")
    done = start(HOST, SCENE.format(preset="saturation = 0.62"), "regions", "--restart", work / "regions/checkpoint.h5")
    if (work / "regions/checkpoint.h5").exists():
        check("host: a run of regions that is taken up again", done.returncode == 0, done.stderr)
        after = files(work / "regions")
        for name, content in before.items():
            check(f"host: restart with regions, {name}, byte for byte", after.get(name) == content)
        other = SCENE.format(preset="saturation = 0.62").replace("'undrained'", "'drained'")
        done = start(HOST, other, "regions", "--restart", work / "regions/checkpoint.h5")
        check("host: not with another drainage", done.returncode == 17, (done.returncode, done.stderr))
    done = start(
    HOST,
    SCENE.format(
        preset="saturation = 0.62").replace(
            "hysteresis = 1",
            "hysteresis = 0"),
             "single_curve")
    check("host: a preset without hysteresis is refused, with the remedy", done.returncode != 0
          and "hysteresis = 1" in done.stderr, done.stderr)
    done = start(HOST, SCENE.format(preset="").replace("'undrained'", "'sealed'"), "sealed")
    check("host: an unknown drainage is refused, with the known ones", done.returncode == 2
          and all(word in done.stderr for word in ("sealed", "drainage", "coupled|drained|undrained|dry")), done.stderr)


def test_host_a_run_is_taken_up_again_between_turning_points():
    # The water level rises and falls with a smaller swing each time: at the checkpoint of step 21 suction has
    # turned three times and none of the loops is closed; steps 22 to 30 close them from the inside. With the isotropic
    # memory its margin is below 0 there as well.
    swings = "times = 0, 0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 1 values = 1, 1.5, 0.8, 1.3, 0.95, 1.2, 0.7, 1.6"
    text = SCENE.format(preset="").replace("times = 0, 1 values = 1, 1.2", swings).replace("dt = 0.2", "dt = 0.03333")
    text = text.replace("checkpoint_steps = 3", "checkpoint_steps = 21")
    settled = []
    for name, scene in ("turns", text.replace("hysteresis = 1", "hysteresis = 1 isotropic = 1")), ("memory", text):
        done = start(HOST, scene, name)
        check(f"host, {name}: a scene whose suction turns six times runs", done.returncode == 0, done.stderr)
        rows = tables.columns(work / name / "histories.csv")
        s_w = rows["top.S_w"]
        settled.append(rows["top.u_z"][-1])
        turns = sum((b - a) * (c - b) < 0 for a, b, c in zip(s_w, s_w[1:], s_w[2:]))
        check(f"host, {name}: its saturation turns as often", turns >= 6, s_w)
        before = files(work / name)
        done = start(HOST, scene, name, "--restart", work / name / "checkpoint.h5")
        check(f"host, {name}: it is taken up again between turning points", done.returncode == 0, done.stderr)
        after = files(work / name)
        for file, content in before.items():
            check(f"host, {name}: restart between turning points, {file}, byte for byte", after.get(file) == content)
    check("host: swings of the load settle less with the isotropic memory", 0 > settled[1] > settled[0], settled)
