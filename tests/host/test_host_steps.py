# SPDX-License-Identifier: MIT
"""Controlled steps of mud_host: one norm of the error of a step against step_tolerance; they end at the breaks of what
acts and where contacts close, and are the same after a restart. What the steps leave together is measured here against
fine given steps: a run does not know it."""
import os
import shutil
import subprocess

import numpy as np

from checking import at_length, build, check, root, work
import tables  # noqa: E402

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}
VIBRATION = root / "verification/host/vibration/scene.nml"
TERZAGHI = root / "verification/host/terzaghi/scene.nml"
RESTART = root / "tests/host/scenes/restart.nml"
RAIN = root / "verification/studies/cost/scenes/rain.nml"


def run(scene, out, *words):
    return subprocess.run([host, scene, "--output", out, *words], capture_output=True, text=True, env=environment)


def written(name, text):
    scene = work / f"{name}.nml"
    scene.write_text(text.replace("'../../..", f"'{root}"))
    return scene


def history(folder, name):
    return tables.columns(folder / "histories.csv")[name]


def apart(folder, fine, name):
    """Largest difference of a history to that of fine steps, over its range."""
    known = np.interp(history(folder, "time"), history(fine, "time"), history(fine, name))
    return np.max(np.abs(history(folder, name) - known))/np.ptp(known)


FOOTING = '''&scene name = 'push' fields = 'u' /
&mesh r = 0, 0.5, 2 r_cells = 2, 3 z = -2, 0 z_cells = 3 /
&mud name = 'sand' e_0 = 0.735 /
&region material = 'sand' /
&initial stress = 'uniform' sigma = -20, -20, -20 /
&history name = 'ramp' times = 0, 1 values = 0, 1 /
&stage name = 'push' analysis = 'static' duration = 1 /
&fix group = 'left' field = 'u_r' / &fix group = 'right' field = 'u_r' / &fix group = 'bottom' field = 'u_z' /
&fix group = 'top_1' field = 'u_z' value = -0.005 HISTORY /
&load group = 'top_2' kind = 'pressure' value = 20 /
&point name = 'plate' r = 0 z = 0 /
POINT'''
RAMP = FOOTING.replace("HISTORY", "history = 'ramp'").replace("POINT", "")
SWING = VIBRATION.read_text().replace("rho_inf = 0.8", "")
DRAIN = TERZAGHI.read_text().replace("   dt_growth = 1.03\n   dt_max = 1\n", "") \
    .replace("duration = 100", "duration = 20")

# A plate of 50 kg falls from 2 cm on elastic soil: flight is exact, so is its speed at the impact; force and settlement
# follow as accurately as was asked for. The reference takes steps of 1e-5 s.
DROP = """&scene name = 'drop' fields = 'u' /
&mesh r = 0, 0.3, 1 r_cells = 2, 2 z = -1, 0 z_cells = 3 z_ratio = 0.8 /
&elastic name = 'soil' young = 1e4 poisson = 0.3 /
&region material = 'soil' void_ratio = 0.7 drainage = 'dry' damping = 20 /
&stage name = 'fall' analysis = 'dynamic' duration = 0.08 STEPS /
&fix group = 'left' field = 'u_r' / &fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_r' / &fix group = 'bottom' field = 'u_z' /
&plate name = 'plate' r = 0, 0.3 z = 0.02 mass = 0.05 force = -0.4905 /
&contact name = 'face' slave = 'top' master = 'plate' penalty = 1e6 search_radius = 0.5 /
&point name = 'centre' r = 0 z = 0 /
"""


def landing(folder):
    """Largest speed [m/s] and thrust [kN], and settlement [m] until the plate has been thrown back."""
    rows = tables.columns(folder / "contact.csv")
    return np.array([-min(rows["plate.v_z"]), max(abs(rows["face.thrust"])), -min(history(folder, "centre.u_z"))])


# A bar that moves and meets a wall where its stage begins: its first step is judged like any other.
BAR = (root / "verification/host/contact/bar.nml").read_text().replace("rho_inf = 0.8", "").replace("dt = 2.0e-6", "") \
    .replace("duration = 1.5e-3", "duration = 4e-4").replace("z_cells = 50", "z_cells = 25")


# Nothing happens for 9.5 s, then a load grows for 0.1 s on soil that drains in seconds: the flow begins with the load
# and not with the root of time.
LATE = """&scene name = 'late' geometry = 'plane_strain' fields = 'u-p_w' step_tolerance = 1e-2 /
&mesh r = 0, 0.1 r_cells = 1 z = 0, 1 z_cells = 8 /
&elastic name = 'soil' young = 1.0e4 poisson = 0.25 /
&permeability name = 'k' intrinsic = 1e-11 law = 'constant' /
&region material = 'soil' void_ratio = 0.8 permeability = 'k' /
&stage name = 'load' analysis = 'quasi_static' duration = 10 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_w' /
&history name = 'h' times = 0, 9.5, 9.6 values = 0, 0, 1 /
&load group = 'top' kind = 'pressure' value = 10 history = 'h' /
&point name = 'middle' r = 0 z = 0.5 /
"""


def test_a_load_that_begins_to_grow_is_not_sudden():
    done = run(written("late", LATE), work / "late")
    fine = run(written("late_fine", LATE.replace("duration = 10", "duration = 10 dt = 2e-3 steps = 'given'")),
               work / "late_fine")
    check("late load: runs", done.returncode == fine.returncode == 0, done.stderr + fine.stderr)
    check("late load: the pressure is right", apart(work / "late", work / "late_fine", "middle.p_w") < 1e-2,
          apart(work / "late", work / "late_fine", "middle.p_w"))
    check("late load: few steps", len(history(work / "late", "time")) < 100, len(history(work / "late", "time")))


# Sand under stress at rest until 1.2 s: what it moves by is the rounding of its forces, 1e-19 m. Steps were as short as
# may be, 1e-8 of the stage.
REST = """&scene name = 'rest' geometry = 'plane_strain' fields = 'FIELDS' /
&mesh r = 0, 0.5, 2 r_cells = 1, 2 z = -1.7, 0 z_cells = 3 /
&mud name = 's' e_0 = 0.709 /
&permeability name = 'k' intrinsic = 3e-11 law = 'constant' /
&region material = 's' WATER /
&initial stress = 'uniform' sigma = -57.62, -57.62, -57.62 /
&history name = 'h' times = 0, 1.2, 1.5 values = 0, 0, 1 /
&stage name = 'a' analysis = 'KIND' duration = 1.5 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'bottom' field = 'u_r' /
&load group = 'top' kind = 'pressure' value = 57.62 /
&load group = 'top_1' kind = 'pressure' value = 5 history = 'h' /
&point name = 'c' r = 0 z = 0 /
"""


def test_rest_takes_few_steps():
    for kind in ("quasi_static", "dynamic"):
        for fields, water in (("u-p_w", "permeability = 'k'"), ("u", "drainage = 'dry'")):
            text = REST.replace("KIND", kind).replace("FIELDS", fields).replace("WATER", water)
            if fields == "u-p_w":
                text += "&fix group = 'top' field = 'p_w' /\n"
            name = f"rest_{kind}_{fields}"
            done = run(written(name, text), work / name, "--step-tolerance", "3e-2")
            check(f"sand at rest, {kind}, {fields}: runs", done.returncode == 0, done.stderr)
            times = history(work / name, "time")
            check(f"sand at rest, {kind}, {fields}: few steps", np.sum(times < 1.2) < 100, np.sum(times < 1.2))


# A wave that is too fast for the steps alternates from step to step and is undamped (rho_inf 0.9, seepage inertia,
# water that is hardly pressed together).
PULSE = root / "verification/host/dynamic_consolidation/scene.nml"


@at_length
def test_waves_too_fast_for_the_steps_do_not_shorten_them_without_end():
    done = run(PULSE, work / "pulse", "--step-tolerance", "1e-2")
    check("pulse on saturated soil: runs to its end", done.returncode == 0, done.stderr)
    steps = len(history(work / "pulse", "time")) - 1
    check("pulse on saturated soil: steps", steps < 400, steps)


@at_length
def test_ten_times_the_tolerance_ten_times_the_error_of_a_vibration():
    # A step errs by the third power of its length: the local error is tolerance**1.5, so that the sum is in proportion
    # to the tolerance, and the steps to its root. Nine periods add up.
    scene = written("swing", SWING)
    run(written("fine", SWING.replace("dt = 0.005", "dt = 2e-4")), work / "fine")
    errors, steps = {}, {}
    for tolerance in ("1e-1", "1e-2", "1e-3"):
        out = work / f"swing{tolerance}"
        done = run(scene, out, "--step-tolerance", tolerance)
        check(f"vibration, {tolerance}: runs", done.returncode == 0, done.stderr)
        errors[tolerance], steps[tolerance] = apart(out, work / "fine", "top.u_z"), len(history(out, "time"))
        rows = tables.columns(out / "ledger.csv")["step_error"]
        check(f"vibration, {tolerance}: every step errs by its tolerance at most",
              0 < np.max(rows) < 1.3*float(tolerance)**1.5 or np.argmax(rows) < 10, (np.max(rows), np.argmax(rows)))
    check("vibration: the root of ten times the steps", 2.5 < steps["1e-3"]/steps["1e-2"] < 4, steps)
    check("vibration: a tenth of the error", 5 < errors["1e-2"]/errors["1e-3"] < 20, errors)
    told = run(scene, work / "told", "--step-tolerance", "1e-2").stdout
    check("vibration: what kept its steps short is told, and that errors are not known",
          "kept short by" in told and "error of the displacements (" in told
          and "The errors of these answers are not known; \"mud_study accuracy" in told, told)


def test_a_run_is_given_a_step_tolerance_and_no_accuracy():
    for words, said in ((("--accuracy", "1e-2"), "--step-tolerance sets the local tolerance"),
                        (("--step-tolerance", "0"), "step_tolerance"), (("--step-tolerance", "fine"), "not a number"),
                        (("--step-tolerance", "2"), "outside")):
        done = run(TERZAGHI, work / "none", *words)
        check(f"{words}: refused", done.returncode == 2 and said in done.stderr, done.stderr)
    for key, said in (("accuracy = 1e-2", "step_tolerance"), ("mesh = 'auto'", "mud_study accuracy"),
                      ("budget = 9", "mud_study accuracy"), ("ordering = 'metis'", "leave it out"),
                      ("effects = 'auto'", "mud_study effects")):
        scene = written("old", TERZAGHI.read_text().replace("&scene\n", f"&scene\n   {key}\n"))
        done = run(scene, work / "none")
        check(f"{key}: told with the word of today", done.returncode == 2 and said in done.stderr
              and "old.nml:" in done.stderr, done.stderr)


def test_a_record_of_401_breaks_a_step_ends_at_the_one_that_matters():
    # A record of many breaks: steps end at those that a straight line over them would miss, and at no others.
    wiggle = [0.5*i/400 for i in range(401)]
    flat = [1 + 1e-5*(-1)**i for i in range(401)]
    flat[123] = 0.2
    record = "\n".join(f"{t:.6g} {v:.7g}" for t, v in zip(wiggle, flat))
    (work / "record.txt").write_text(record + "\n")
    text = VIBRATION.read_text().replace("stages = 'press'\n", "history = 'record'\n").replace("rho_inf = 0.8", "") \
        .replace("analysis = 'static'\n   duration = 1\n", "analysis = 'static'\n   duration = 1e-9\n") \
        + f"&history name = 'record' file = '{work / 'record.txt'}' /\n"
    done = run(written("record", text), work / "record", "--step-tolerance", "1e-1")
    times = tables.columns(work / "record/ledger.csv")["time"] if done.returncode == 0 else np.array([9.0])
    check("a record of 401 breaks: a step ends at the one that matters", np.min(np.abs(times - wiggle[123])) < 1e-9,
          (done.stderr, times))
    check("a record of 401 breaks: not at every one", len(times) < 300, len(times))


@at_length
def test_given_steps_stay():
    # What the scene sets by hand stays: steps, Newton's tolerance.
    done = run(written("hand", TERZAGHI.read_text().replace("dt = 1.0e-3", "dt = 1.0e-3\n   steps = 'given'")),
               work / "hand", "--step-tolerance", "1e-1")
    run(TERZAGHI, work / "plain")
    check("given steps stay", (work / "hand/ledger.csv").read_bytes() == (work / "plain/ledger.csv").read_bytes()
    )

    # Without dt a stage is controlled, and without a tolerance at 1e-3: six decades of time in few steps.
    free = TERZAGHI.read_text().replace("   dt = 1.0e-3\n   dt_growth = 1.03\n   dt_max = 1\n", "")
    done = run(written("free", free), work / "free")
    free, plain = work / "free", work / "plain"
    t, p = history(free, "time"), history(free, "base.p_w")
    # Given steps begin with 1e-3 s: what is before is between nothing and all.
    known = np.interp(t, history(plain, "time"), history(plain, "base.p_w"))
    true = np.max(np.abs(p - known)[t >= 1e-3])/np.ptp(p)
    check("consolidation without dt", done.returncode == 0 and len(
        t) < 400 and true < 2e-3, (done.stderr, len(t), true))
    check("consolidation without dt: the tolerance is told",
          "Stage consolidation: steps are controlled, tolerance 0.001." in done.stdout, done.stdout)
    check("given steps: no tolerance is told", "are controlled" not in run(TERZAGHI, work / "told", "--check").stdout)
    done = run(written("rain", RAIN.read_text().replace("   dt = 100\n", "")), work / "rain",
               "--step-tolerance", "1e-3")
    check("rain without dt, 1e-3", done.returncode == 0, done.stderr)
    done = run(written("none", TERZAGHI.read_text().replace("dt = 1.0e-3", "steps = 'given'")), work / "none")
    check("given steps need dt", done.returncode == 2 and "needs dt" in done.stderr, done.stderr)
    forces = {}
    for name, words in (("1e-1", ("--step-tolerance", "1e-1")), ("1e-2", ("--step-tolerance", "1e-2")), ("fine", ())):
        text = RAMP if words else RAMP.replace("duration = 1 ", "duration = 1 dt = 0.01 tolerance = 1e-6 ")
        done = run(written(f"push{name}", text), work / f"push{name}", *words)
        check(f"prescribed displacement, {name}: runs", done.returncode == 0, done.stderr)
        forces[name] = tables.columns(work / f"push{name}/reactions_push.csv")["top_1.force_z"]
    for name in ("1e-1", "1e-2"):
        miss = abs(forces[name][-1]/forces["fine"][-1] - 1)
        check(f"prescribed displacement, {name}: force", miss < 0.5*float(name), (miss, len(forces[name])))
    check("static steps: more for a smaller tolerance", 4 < len(forces["1e-1"]) < len(forces["1e-2"]) < 40,
          {name: len(force) for name, force in forces.items()})


@at_length
def test_fall_speed_of_the_reference():
    run(written("drop_fine", DROP.replace("STEPS", "dt = 1e-5")), work / "drop_fine")
    exact = landing(work / "drop_fine")
    check("fall: speed of the reference", abs(exact[0]/np.sqrt(2*9.81*0.02) - 1) < 1e-3, exact)
    for tolerance, most in (("1e-2", 5e-2), ("1e-3", 5e-3)):
        done = run(written("drop", DROP.replace("STEPS", "")), work / "drop", "--step-tolerance", tolerance)
        miss = np.abs(landing(work / "drop")/exact - 1)
        check(f"fall, {tolerance}: speed, thrust and settlement", done.returncode == 0 and max(miss) < most,
              (miss, done.stderr))
        # Where the contact closes follows from free fall: a step ends there.
        times = tables.columns(work / "drop/ledger.csv")["time"]
        touch = np.sqrt(2*0.02/9.81)
        check(f"fall, {tolerance}: a step ends at the landing", np.min(np.abs(times - touch)) < 1e-4*touch,
              np.min(np.abs(times - touch)))
    done = run(written("bar", BAR), work / "bar", "--step-tolerance", "1e-2")
    first = tables.columns(work / "bar/ledger.csv")["step_error"][0]
    check("a bar that meets a wall at the start: its first step errs by the tolerance at most",
          done.returncode == 0 and 0 < first < 1.3e-3, (first, done.stderr))


def test_a_step_below_1e_12_of_the_stage():
    # A step that is shorter than 1e-12 of its stage is refused with its cause: it would never come to an end.
    done = run(written("short", DRAIN.replace("dt = 1.0e-3", "dt = 1e-12")), work / "short")
    check("a step below 1e-12 of the stage", done.returncode == 14 and "is below 1e-12 of the stage" in done.stderr
          and "dt_max" in done.stderr, (done.returncode, done.stderr))


def test_steps_end_at_breaks_and_are_the_same_after_a_restart():
    # Steps end where a load history breaks, where a support comes or goes, and at the times of output; and a run that
    # is taken up from a checkpoint takes the same steps, byte for byte.
    text = RESTART.read_text().replace(
        "   fields = 7\n", "   output_dt = 0.125\n").replace(
        "   dt_growth = 1.3\n", "").replace(
        "checkpoint_steps = 2", "checkpoint_steps = 50\n   step_tolerance = 3e-2")
    text += "&fix group = 'bottom' field = 'p_w' value = -20 from = 0.05 until = 0.07 /\n"
    whole, half = work / "whole", work / "half"
    scene = written("again", text)
    done = run(scene, whole)
    check("steps that end at breaks: runs", done.returncode == 0, done.stderr)
    times = tables.columns(whole / "ledger.csv")["time"]
    for landing in (0.05, 0.07, 0.125, 0.25, 0.3, 0.31, 0.32, 0.33):
        check(f"a step ends at {landing} s", np.min(np.abs(times - landing)) < 1e-9, times)
    shutil.copytree(whole, half)
    check("the last checkpoint is not the end", len(times) % 50 not in (0, 1), len(times))
    done = run(scene, half, "--restart", half / "checkpoint.h5")
    check("restart: goes on", done.returncode == 0, done.stderr)
    for file in ("ledger.csv", "histories.csv"):
        check(f"restart: same bytes of {file}", (whole / file).read_bytes() == (half / file).read_bytes())


def test_a_checkpoint_changes_no_answer():
    # What a run writes beside its answers is no part of them: with a checkpoint after every step, and taken up from
    # one in the middle, the tables have the bytes of a run that writes none.
    text = RESTART.read_text().replace("   dt_growth = 1.3\n", "").replace(
        "checkpoint_steps = 2", "checkpoint_steps = 0\n   step_tolerance = 3e-2")
    scene = written("kept", text)
    folders = [work / f"kept_{every}" for every in (0, 1, 50)]
    for folder in folders:
        done = run(scene, folder, "--set", f"scene.checkpoint_steps={folder.name[5:]}")
        check(f"{folder.name}: runs", done.returncode == 0, done.stderr)
    done = run(scene, folders[-1], "--restart", folders[-1] / "checkpoint.h5")
    check("restart: goes on", done.returncode == 0, done.stderr)
    for folder in folders[1:]:
        for file in ("ledger.csv", "histories.csv"):
            check(f"same bytes of {file}", (folder / file).read_bytes() == (folders[0] / file).read_bytes(), folder)


def test_saturated_ground_at_no_suction_begins_under_rain():
    # Its air vanishes in the first step, in which corrections halve. All rain runs off, and the sealed column ends with
    # water at rest: 9.81 kPa at its base.
    done = run(written("wet", """&scene name = 'wet' geometry = 'plane_strain' fields = 'u-p_w-p_c' gravity = 9.81 /
&mesh r = 0, 0.2 r_cells = 1 z = 0, 1 z_cells = 10 /
&elastic name = 'soil' young = 1e4 poisson = 0.25 /
&retention name = 'r' law = 'van_genuchten' alpha = 0.1 n = 2 /
&permeability name = 'k' intrinsic = 1e-12 /
&region material = 'soil' retention = 'r' permeability = 'k' void_ratio = 0.8 /
&initial stress = 'geostatic' surface = 1 /
&stage name = 'wet' analysis = 'quasi_static' duration = 1e5 /
&fix group = 'left' field = 'u_r' / &fix group = 'right' field = 'u_r' / &fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'rain' value = 1e-8 /
&point name = 'base' r = 0 z = 0 /
"""), work / "wet")
    check("it begins, and comes to its end", done.returncode == 0, done.stderr)
    base = history(work / "wet", "base.p_w")[-1] if done.returncode == 0 else 0.0
    check("water at rest below", abs(base - 9.81) < 1e-3*9.81, base)


def test_ground_that_pore_pressures_move_creates_no_energy():
    # Without loads or weight the pores do all work: a water pressure that rises below, a suction that nothing balances.
    column = """&scene name = 'pores' geometry = 'plane_strain' fields = '{fields}' step_tolerance = 1e-3 /
&mesh r = 0, 0.5 r_cells = 1 z = 0, 1 z_cells = 10 /
&elastic name = 'soil' young = 1e4 poisson = 0.25 /
&permeability name = 'k' intrinsic = 1e-12 /
&region material = 'soil' void_ratio = 0.8 permeability = 'k' {more} /
&stage name = 'go' analysis = 'dynamic' duration = 0.02 /
&fix group = 'left' field = 'u_r' / &fix group = 'right' field = 'u_r' / &fix group = 'bottom' field = 'u_z' /
"""
    suction = column.format(fields="u-p_w-p_c", more="retention = 'r'") + """
&retention name = 'r' law = 'van_genuchten' alpha = 0.1 n = 2 /
&initial p_w = -20 p_c = 20 / &fix group = 'top' field = 'p_a' /
"""
    water = column.format(fields="u-p_w", more="") + """
&history name = 'rise' times = 0, 0.002, 1 values = 0, 1, 1 /
&fix group = 'bottom' field = 'p_w' value = 50 history = 'rise' / &fix group = 'top' field = 'p_w' /
"""
    for name, text in (("suction", suction), ("water", water)):
        done = run(written(name, text), work / name)
        check(f"{name}: comes to its end", done.returncode == 0, done.stderr)
        ledger = tables.columns(work / name / "ledger.csv")
        share = np.max(np.abs(ledger["imbalance"]))/np.max(np.abs(ledger["pores"]))
        check(f"{name}: the balance of energy closes", share < 1e-3, share)
