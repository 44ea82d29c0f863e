# SPDX-License-Identifier: MIT
"""Effects that pilots of a scene find: what misleads a formula is kept, what does nothing goes, keys win, the run that
follows is the one that a user would have written, the watch sees what pilots miss, restarts, mistakes."""
import os
import re
import shutil
import subprocess
import sys

from checking import at_length, brief, build, check, light, root, work
import tables  # noqa: E402 (checking knows its folder)

sys.path.insert(0, str(root / "verification/studies/effects"))
import scenes  # noqa: E402
from scenes import AUTO, CURVE, DRAINED, WATER, column  # noqa: E402

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}
QUASI_STATIC = "analysis = 'quasi_static'"
SIX_DIGITS = 5e-6   # Rounding of what effects_answers.csv holds, relative.
SOAKED = "void_ratio = 0.8 permeability = 'k' retention = 'c'"


def start(text, name, *more):
    scene = work / f"{name}.nml"
    scene.write_text(text.replace("{materials}", str(root / "drivers/materials")))
    return subprocess.run([host, scene, "--output", work / name, *more], capture_output=True, text=True,
                          env=environment)


def run(text, name, *more):
    """What it prints, and its table of effects (empty without one)."""
    shutil.rmtree(work / name, ignore_errors=True)
    done = start(text, name, *more)
    check(f"{name} runs", done.returncode == 0, done.stderr)
    table = work / name / "effects.csv"
    return done.stdout + done.stderr, {row["effect"]: row for row in tables.rows(table)} if table.exists() else {}


def is_on(what, table, effect, on, by="pilot"):
    row = table.get(effect, {})
    check(f"{what}: {effect} is {'on' if on else 'off'} by {by}",
          row.get("on") == ("on" if on else "off") and row.get("by") == by, row)


# Scenes that bounds by formula spoiled, or that a hurried user would; and what may go. The rest is a page of the
# verification.
QUICK = ("late load",) if brief else ("cantilever", "late load", "fast load on saturated soil") if light else (
    "cantilever", "clamped slab", "pulse", "late load", "stiff layer that hides seepage", "fast load on saturated soil",
    "slow ramp", "consolidation")

# What auto chooses is the scene that a user would have written, byte for byte; what it removes is printed.
wet = dict(times="0, 1000", laws=WATER.format(k="1e-10") + "\n" + CURVE, region=SOAKED,
           more=DRAINED + "\n&fix group = 'top' field = 'p_a' /")

# `without` is the key of the effect, by hand.
slow = dict(stage="analysis = 'dynamic' duration = 1 dt = 0.05", times="0, 1")

# Every effect is one key, and its word in `without` is that key: the same bytes, and another answer than with it.
FADE = "&strength material = 'sand' parameter = 'M_c' history = 'fade' /"
TOUCH = "&contact name = 'c' slave = 'top' master = 'plate' drainage = 'state' penalty = 1e6 " \
        "tangential_penalty = 1e6 friction = 0.4 /"
WHOLE = """&scene name = 'whole' fields = 'u-p_w-p_c' gravity = 9.81 seepage_inertia = 'yes' /
&mesh r = 0, 0.2 r_cells = 1 z = -0.2, 0 z_cells = 1 /
&mud name = 'sand' file = '{materials}/toyoura.nml' hysteresis = 1 fabric = 1 bonding = 1 isotropic = 1 lode = 1
     memory_rule = 'return_point' rho_e = 2e-5 /
&permeability name = 'k' intrinsic = 1e-10 /
&region material = 'sand' retention = 'material' permeability = 'k' void_ratio = 0.7 damping = 5 /
{fade}
&history name = 'fade' times = 0, 0.006 values = 1, 0.99 /
&initial p_w = -30 p_c = 30 stress = 'uniform' sigma = -20, -20, -20 /
&history name = 'cycles' times = 0, 0.002, 0.004, 0.006 values = 0, 1, 0.6, 1 /
&plate name = 'plate' r = 0, 0.1 z = -1e-6 mass = 0.01 force = -8 history = 'cycles' /
{contact}
&absorbing group = 'right' /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_w' value = -30 /
&fix group = 'top' field = 'p_c' value = 30 /
&stage name = 'shake' analysis = 'dynamic' duration = 0.006 dt = 1e-3 rho_inf = 0 created_energy = 1e9 /
&point name = 'centre' r = 0 z = 0 /
&point name = 'base' r = 0 z = -0.2 /
""".replace("{contact}", TOUCH).replace("{fade}", FADE)
WET = (("&fix group = 'top' field = 'p_c' value = 30 /", ""), ("fields = 'u-p_w-p_c'", "fields = 'u-p_w'"))
KEYS = {
    "inertia": (("'dynamic'", "'quasi_static'"), ("'yes'", "'no'")),
    "relative_acceleration": (("'yes'", "'no'"),),
    "p_w": (*WET, ("&fix group = 'top' field = 'p_w' value = -30 /", ""),
            ("fields = 'u-p_w'", "fields = 'u'"), ("'yes'", "'no'"), ("'state'", "'fixed'")),
    "p_c": WET,
    "gravity": (("gravity = 9.81", "gravity = 0"),),
    "contact": ((TOUCH, ""),),
    "damping": (("damping = 5", "damping = 0"),),
    "absorbing": (("&absorbing group = 'right' /", ""),),
    "contact_drainage": (("'state'", "'fixed'"),),
    "friction": (("friction = 0.4", "friction = 0"),),
    "strength": ((FADE, ""),),
    "void_ratio_in_retention": (("lode = 1", f"lode = 1 Omega = 0 P_a = {5.0 * 0.7**-2.0:.16e}"),),
    "hysteresis": (("hysteresis = 1", "hysteresis = 0"),),
    "bonding": (("bonding = 1", "bonding = 0"),),
    "fabric": (("fabric = 1", "fabric = 0"),),
    "isotropic": (("isotropic = 1", "isotropic = 0"),),
    "lode": (("lode = 1", "lode = 0"),),
    "memory_rule": (("'return_point'", "'classic'"),),
    "elastic_domain": (("rho_e = 2e-5", "rho_e = 0"),),
}
FACE = """&scene name = 'face' geometry = 'plane_strain' fields = 'u-p_w' gravity = 10 /
&mesh r = 0, 1 r_cells = 2 z = 0, 1 z_cells = 1 /
&elastic name = 'soil' young = 1.0e4 poisson = 0.25 /
&permeability name = 'k' intrinsic = 2.0e-10 law = 'constant' /
&region material = 'soil' void_ratio = 1 permeability = 'k' /
&stage name = 's' analysis = 'quasi_static' duration = 10 dt = 1 rho_inf = 0 /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'p_w' value = 4 /
&initial p_w_slope = -10 /
&fix group = 'right' field = 'p_w' kind = 'seepage' value = 1 /
&load group = 'top' kind = 'rain' value = 4e-3 /
&point name = 'top' r = 0 z = 1 /
"""

# A pulse on a slow load, between the steps of the pilots, and so small beside what its history was before the run that
# they do not end there: they cannot see it, the watch does; `stop` ends the run.
missed = dict(times="-1, 0, 5, 5.012, 5.02, 5.028", values="2000, 0, 0.05, 0.05, 1, 0.05",
              stage="duration = 10 dt = 0.004")

# Where the named points are prescribed, the forces of the supports that move are the answers; where nothing changes
# there is nothing to judge by, and nothing goes.
pushed = (
    "&scene name = 'push' fields = 'u' effects = 'auto' /\n&mesh r = 0, 0.5, 2 r_cells = 2, 3 z = -2, 0 z_cells = 3 /\n"
    "&mud name = 'sand' e_0 = 0.735 /\n&region material = 'sand' /\n"
    "&initial stress = 'uniform' sigma = -20, -20, -20 /\n&history name = 'ramp' times = 0, 1 values = 0, 1 /\n"
    "&stage name = 'push' analysis = 'static' duration = 1 dt = 0.1 /\n&fix group = 'left' field = 'u_r' /\n"
    "&fix group = 'right' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /\n"
    "&fix group = 'top_1' field = 'u_z' value = -0.005 history = 'ramp' /\n"
    "&load group = 'top_2' kind = 'pressure' value = 20 /\n&point name = 'plate' r = 0 z = 0 /\n")

# A consolidation of 1000 s whose pilot with inertia would take some 100,000 steps: it goes on as the scene says,
# without inertia. The weight, which the keys do not ask for, changes much: it is printed as added.
AIR = """&scene name = 'air' geometry = 'plane_strain' effects = 'auto' /
&mesh r = 0, 0.2 r_cells = 1 z = -2, 0 z_cells = 8 /
&elastic name = 's' young = 4e3 poisson = 0.3 /
&retention name = 'vg' law = 'van_genuchten' alpha = 0.05 n = 2 s_min = 0.1 /
&permeability name = 'k' intrinsic = 2e-14 law = 'mualem' m = 0.5 s_min = 0.1 /
&region material = 's' retention = 'vg' permeability = 'k' void_ratio = 0.7 /
&initial p_w = -20 p_c = 20 /
&history name = 'a' times = 0, 500, 505, 520, 525 values = 0, 0, 1, 1, 0 /
&stage name = 'run' duration = 1000 /
&fix group = 'top' field = 'p_a' value = 15 history = 'a' /
&load group = 'top' kind = 'pressure' value = 15 history = 'a' /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&point name = 't' r = 0 z = 0 /
&point name = 'm' r = 0 z = -1 /
"""

# Where regions leave `drainage` open, pilots decide for each whether its water flows: that under the load, not that far
# off. The run is the one with drainage by hand; a region with a support of its own keeps its flow; the watch sees what
# pilots miss.


def plots(keys=AUTO, far="permeability = 'k'", stage=f"{QUASI_STATIC} duration = 2 dt = 0.02", more=""):
    return scenes.PLOTS.format(keys, far, stage, more)


def test_effects_runs_nothing_else():
    for scene in scenes.TRAPS + scenes.EASY:
        if scene.name not in QUICK:
            continue
        name = scene.name.replace(" ", "_")
        _, table = run(scene.text, name, "--effects", "--quiet")
        check(f"{name}: --effects runs nothing else", not (work / name / "histories.csv").exists())
        for effect in scene.keeps:
            is_on(name, table, effect, True)
        for effect in scene.drops:
            is_on(name, table, effect, False)


def test_beam_its_tip_as_by_the_theory_of_slender_beams_to_2():
    # The weight of the slender beam bends it: its tip goes down by w L**4/(8 E I), a load of 600 kPa along it or not.
    unit_weight = 2.4 / 1.01 * 9.81
    deflection = unit_weight * 0.2 * 10**4 / (8 * 3.0e7 / (1 - 0.2**2) * 0.2**3 / 12)
    run(scenes.CANTILEVER, "beam")
    tip = tables.numbers(work / "beam/histories.csv")[-1]["tip.u_z"]
    check("beam: its tip, as by the theory of slender beams to 2 %",
          abs(-tip / deflection - 1) < 0.02, (tip, deflection))
    said, table = run(column("gravity = 0", "duration = 1000 dt = 10", **wet), "wet")
    for effect in ("p_w", "p_c"):
        is_on("wet", table, effect, False)
        check(f"wet: {effect} is told", re.search(rf"^ *{effect} +off +pilot ", said, re.MULTILINE), said)
    check("wet: pilots' cost is told", re.search(r"\d+ pilots in \S+ s", said) and " s for pilots, " in said, said)
    inertia = table["inertia in load"]["on"] == "on"
    kind = "dynamic" if inertia else "quasi_static"
    run(column("gravity = 0 fields = 'u'", f"analysis = '{kind}' duration = 1000 dt = 10",
               times="0, 1000", region="void_ratio = 0.8").replace(AUTO, ""), "dry")
    for file in ("histories.csv", "ledger.csv"):
        check(f"wet: {file} as by hand, byte for byte",
              (work / "wet" / file).read_bytes() == (work / "dry" / file).read_bytes())


def test_hands_what_is_absent_by_hand_is_not_tried():
    # Keys win, and the table says so.
    _, table = run(column("gravity = 0 fields = 'u-p_w'", "analysis = 'quasi_static' duration = 1000 dt = 10", **{
        **wet, "more": DRAINED}), "hands")
    is_on("hands", table, "p_w", True, "hand")
    is_on("hands", table, "inertia in load", False, "hand")
    check("hands: what is absent by hand is not tried", table["gravity"]["influence"] == ""
          and table["gravity"]["remark"] == "not tried: by hand", table["gravity"])
    check("hands: its influence is told all the same", float(table["p_w"]["influence"]) >= 0, table["p_w"])
    by_word = column("gravity = 0 without = 'inertia'", **slow).replace(AUTO, "")
    by_key = by_word.replace(" without = 'inertia'", "").replace("'dynamic'", "'quasi_static'")
    run(by_word, "by_word")
    run(by_key, "by_key")
    check("without inertia: as quasi_static, byte for byte",
          (work / "by_word/histories.csv").read_bytes() == (work / "by_key/histories.csv").read_bytes())
    heavy = column("without = 'gravity' gravity = 9.81", **slow, more="&initial stress = 'geostatic' surface = 1 /")
    done = start(heavy.replace(AUTO, ""), "weightless")
    check("without gravity, but geostatic: refused with the reason",
          done.returncode == 2 and "gravity" in done.stderr and "geostatic" in done.stderr, done.stderr)
    run(WHOLE, "whole")
    whole = (work / "whole/histories.csv").read_bytes()
    for word in list(KEYS)[:2 if brief else 6 if light else None]:
        by_key = WHOLE
        for old, new in KEYS[word]:
            check(f"{word}: '{old}' is in the scene", old in by_key)
            by_key = by_key.replace(old, new)
        run(WHOLE.replace("gravity = 9.81", f"without = '{word}' gravity = 9.81"), "by_word")
        run(by_key, "by_key")
        without = (work / "by_word/histories.csv").read_bytes()
        check(f"without {word}: as by its key, byte for byte", without == (work / "by_key/histories.csv").read_bytes())
        check(f"without {word}: another answer", without != whole)
    said = start(WHOLE.replace("gravity = 9.81", "without = 'wind' gravity = 9.81"), "words").stderr
    words = max(re.findall(r"[\w|]+", said), key=len).split("|")
    check("the words of without are these effects", set(words) == {*KEYS, "seepage_face"}, said)
    run(FACE, "face")
    run(FACE.replace("gravity = 10", "without = 'seepage_face' gravity = 10"), "by_word")
    run(FACE.replace("kind = 'seepage'", "kind = 'value'").replace("'rain'", "'water'"), "by_key")
    without = (work / "by_word/histories.csv").read_bytes()
    check("without seepage_face: as by its keys, byte for byte",
          without == (work / "by_key/histories.csv").read_bytes())
    check("without seepage_face: another answer", without != (work / "face/histories.csv").read_bytes())
    said, table = run(column("gravity = 0", **missed), "missed")
    row = table["inertia in load"]
    is_on("missed", table, "inertia in load", False)
    check("missed: one warning, repeated at the end",
          said.count("inertia in load is off, as its pilot has found") == 2, said)
    check("missed: when", 5.012 < float(row["crossed_at"]) < 5.03, row)
    check("missed: the largest is noted, and above the limit", float(row["largest_seen"]) > float(row["limit"]), row)
    done = start(column("gravity = 0 effects_on_warning = 'stop'", **missed), "stopped")
    check("stopped: exit code 19, and what to set",
          done.returncode == 19 and "analysis = 'dynamic'" in done.stderr, done.stderr)


def test_restart_runs():
    # A run that is taken up again finds the same, and remembers what it has seen.
    text = column("gravity = 0 checkpoint_steps = 1500", **missed)
    run(text, "again")
    files = {path.name: path.read_bytes() for path in (work / "again").iterdir() if path.suffix == ".csv"}
    kept = work / "again/checkpoint.h5"
    done = start(text, "again", "--restart", kept)
    check("restart: runs", done.returncode == 0, done.stderr)
    for name, content in files.items():
        if name != "effects.csv":
            check(f"restart: {name}", (work / "again" / name).read_bytes() == content)
    row = {row["effect"]: row for row in tables.rows(work / "again/effects.csv")}["inertia in load"]
    check("restart: what was seen before is in the table",
          row["crossed_at"] and float(row["largest_seen"]) > 0, row)


@at_length
def test_ablate_gravity_was_put_in():
    # The whole scene without each effect, and with those that it does not have.
    _, table = run(column("gravity = 0", "analysis = 'quasi_static' duration = 1 dt = 0.1", times="0, 1").replace(
        AUTO, ""), "ledger", "--ablate", "--quiet")
    check("ablate: gravity was put in",
          table["gravity"]["in_scene"] == "no" and float(table["gravity"]["influence"]) > 0.1, table)
    check("ablate: so was inertia",
          table["inertia in load"]["in_scene"] == "no" and table["inertia in load"]["influence"] != "", table)

    # Of an effect every answer is told; those of one effect are the rows of the other table.
    answers = tables.rows(work / "ledger/effects_answers.csv")
    for effect in ("gravity", "inertia in load"):
        rows = {row["answer"]: float(row["influence"]) for row in answers if row["effect"] == effect}
        worst = max(rows, key=rows.get)
        check(f"ablate: answers of {effect}, the worst as in the table", len(rows) > 1
              and (worst, rows[worst]) == (table[effect]["answer"], float(table[effect]["influence"])), rows)


@at_length
def test_wetted_hysteresis_is_not_tried_by_effects():
    # Hysteresis, which a scene does not have unless it says so, is put in by --ablate alone, and never by auto.
    wetted = column(
    "gravity = 0",
    "analysis = 'quasi_static' duration = 1 dt = 0.25",
    load=0,
    cells=1,
    soil=scenes.SAND,
    laws=WATER.format(
        k="1e-11"),
        region="void_ratio = 0.8 retention = 'material' permeability = 'k'",
         more=scenes.STRESS.format(100) + """
&initial p_w = -30 p_c = 30 /
&history name = 'w' times = 0, 1 values = 1, 0.5 /
&fix group = 'all' field = 'p_a' /
&fix group = 'all' field = 'p_w' value = -30 history = 'w' /""")
    _, table = run(wetted, "wetted", "--effects", "--quiet")
    is_on("wetted", table, "hysteresis", False, "hand")
    check("wetted: hysteresis is not tried by --effects", table["hysteresis"]["influence"] == "", table["hysteresis"])
    _, table = run(wetted.replace(AUTO, "fields = 'u-p_w-p_c'"), "wetted_ledger", "--ablate", "--quiet")
    check("ablate: hysteresis was put in, and matters where soil is wetted", table["hysteresis"]["in_scene"] == "no"
          and float(table["hysteresis"]["influence"] or 0) > 0.01, table["hysteresis"])
    _, table = run(pushed, "pushed", "--effects")
    check("a prescribed plate: its force is the answer", table["lode"]["answer"] == "top_1.force_z"
          and float(table["lode"]["influence"]) > 0.01, table["lode"])
    is_on("a prescribed plate", table, "lode", True, by=table["lode"]["by"])
    _, table = run(pushed.replace("value = -0.005 ", ""), "still", "--effects")
    check("a scene at rest: nothing to judge by", all(row["influence"] == "" for row in table.values()), table)
    check("a scene at rest: nothing goes", all((row["on"] == "on") == (row["in_scene"] == "yes")
                                               for row in table.values()), table)


@at_length
def test_a_support_that_two_stages_move_is_one_answer():
    twice = pushed + ("&stage name = 'further' analysis = 'static' duration = 1 dt = 0.1 /\n"
                      "&fix group = 'top_1' field = 'u_z' value = -0.005 history = 'ramp' stages = 'further' /\n")
    twice = twice.replace("history = 'ramp' /\n&load", "history = 'ramp' stages = 'push' /\n&load")
    run(twice, "twice", "--effects", "--quiet")
    names = [row["answer"] for row in tables.rows(work / "twice/effects_answers.csv") if row["effect"] == "lode"]
    check("a support that two stages move is one answer", names.count("top_1.force_z") == 1, names)

    # A node of two supports belongs to the one named last, in the pilots as in the tables of reactions.
    shared = twice.replace("&load group = 'top_2'", "&fix group = 'top_2' field = 'u_z' /\n&load group = 'top_2'")
    shared = shared.replace("effects = 'auto'", "effects = 'auto' gravity = 0")
    run(shared.replace("effects = 'auto' ", ""), "shared", "--quiet")
    forces = [float(row["top_1.force_z"]) for stage in ("push", "further")
              for row in tables.rows(work / f"shared/reactions_{stage}.csv")]
    run(shared, "shared_ledger", "--ablate", "--quiet")
    answers = {(row["effect"], row["answer"]): row for row in tables.rows(work / "shared_ledger/effects_answers.csv")}
    span = float(answers["lode", "top_1.force_z"]["range"])
    check("the answer of a support is its column of reactions_STAGE.csv",
          abs(span - (max(forces) - min(forces))) <= SIX_DIGITS*span, (span, min(forces), max(forces)))


@at_length
def test_small_pilots_ran():
    # Pilots may take ten seconds of any scene: a small one is decided too,
    # and is then the scene that a user would write.
    small = column("gravity = 0", "duration = 10 dt = 0.1", times="0, 10").replace(AUTO, "effects = 'auto'")
    said, table = run(small, "small")
    check("small: pilots ran", "pilots in" in said, said)
    is_on("small", table, "inertia in load", False)
    check("small: inertia was put in", table["inertia in load"]["in_scene"] == "no"
          and table["inertia in load"]["influence"] != "", table)
    by_hand = small.replace("effects = 'auto'", "").replace("duration = 10", "analysis = 'quasi_static' duration = 10")
    run(by_hand, "small_by_hand")
    check("small: as by hand, byte for byte",
          (work / "small/histories.csv").read_bytes() == (work / "small_by_hand/histories.csv").read_bytes())
    if not light:
        said, table = run(AIR, "air")
        is_on("air", table, "inertia in run", False)
        is_on("air", table, "p_c", True)
        is_on("air", table, "gravity", True)
        check("air: the weight is printed as added", "Added: gravity, which the scene does not have" in said
              and "acts at once" in said and table["gravity"]["in_scene"] == "no", said)
        steps = re.search(r"^(\d+) steps", said, re.MULTILINE)
        check("air: a few hundred steps, without inertia", steps and int(steps[1]) < 400, said)

    large = small.replace("r_cells = 1", "r_cells = 4").replace("duration = 10 dt = 0.1", "duration = 10 dt = 0.014")
    said, table = run(large, "large")
    is_on("large", table, "inertia in load", False)
    check("large: pilots ran within the share", re.search(r"of these \S+ s for pilots", said) and
          "No effect is left out" not in said, said)
    said, table = run(small, "small_asked", "--effects")
    check("small: --effects runs pilots all the same", table["inertia in load"]["influence"] != "", table)


@at_length
def test_an_absorbing_boundary_says_dynamic():
    # Keys that act with inertia alone say `dynamic`; a body that nothing holds needs it.
    _, table = run(column("gravity = 0", "duration = 0.05 dt = 0.001", more="&absorbing group = 'bottom' /"), "leaves",
                   "--effects", "--quiet")
    check("an absorbing boundary says dynamic", table["inertia in load"]["in_scene"] == "yes", table["inertia in load"])
    falling = (
    f"&scene name = 'f' geometry = 'plane_strain' {AUTO} gravity = 9.81 /\n&mesh r = 0, 1 r_cells = 1 z = 0, 1 "
    "z_cells = 2 /\n&elastic name = 's' young = 1e4 poisson = 0.3 /\n&region material = 's' void_ratio = 0 /\n"
    "&stage name = 'fall' duration = 0.1 dt = 0.01 /\n&point name = 'top' r = 0 z = 1 /\n")
    _, table = run(falling, "falling")
    is_on("a falling body", table, "inertia in fall", True)
    check(
    "a falling body: why",
    "nothing holds the body" in table["inertia in fall"]["remark"],
     table["inertia in fall"])
    fall = tables.numbers(work / "falling/histories.csv")[-1]["top.u_z"]
    check("a falling body: it falls by g t**2/2", abs(fall / (-9.81 * 0.1**2 / 2) - 1) < 1e-6, fall)


@at_length
def test_without_suction_bonding_changes_nothing():
    # What changes no answer has the influence 0, not the noise of pilots:
    # there is no suction that the curve could follow.
    saturated = column("gravity = 0 fields = 'u-p_w-p_c' accuracy = 1e-2", f"{QUASI_STATIC} duration = 1", times="0, 1",
                       soil=scenes.SAND, cells=2, laws=WATER.format(k="1e-9"),
                       region="void_ratio = 0.8 retention = 'material' permeability = 'k'",
                       more="&initial stress = 'uniform' sigma = -100, -100, -100 p_w = 5 /\n"
                            "&load group = 'top' kind = 'pressure' value = 105 /\n"
                            "&fix group = 'all' field = 'p_w' value = 5 /\n&fix group = 'all' field = 'p_c' /")
    _, table = run(saturated, "saturated", "--effects", "--quiet")
    check("without suction bonding changes nothing", float(table["bonding"]["influence"] or 1) == 0, table["bonding"])
    is_on("saturated", table, "bonding", False)


@at_length
def test_kept_as_by_hand_byte_for_byte():
    # Water that cannot leave needs no permeability, but is there: the soil would settle 400 times as much without it.
    kept = column("gravity = 0", f"{QUASI_STATIC} duration = 10 dt = 1",
                  region="void_ratio = 0.8 drainage = 'undrained'")
    _, table = run(kept, "kept")
    is_on("kept", table, "p_w", True)
    run(kept.replace(AUTO, "fields = 'u-p_w'"), "kept_by_hand")
    check("kept: as by hand, byte for byte", (work / "kept/histories.csv").read_bytes()
          == (work / "kept_by_hand/histories.csv").read_bytes())
    done = start(kept.replace("region material", "region group = 'block_1_1' material").replace(
        "z = 0, 1 z_cells = 8", "z = 0, 0.5, 1 z_cells = 4, 4").replace(
        "&stage", "&region group = 'block_1_2' material = 'soil' void_ratio = 0.8 /\n&stage"), "no_flow")
    check("beside it flowing water needs a permeability", done.returncode ==
          2 and "permeability is missing" in done.stderr, done.stderr)


@at_length
def test_plots_what_a_key_says_is_not_asked():
    said, table = run(plots(), "plots")
    is_on("plots", table, "flow in block_1_1", True)
    is_on("plots", table, "flow in block_3_1", False)
    check("plots: what a key says is not asked", "flow in block_2_1" not in table, table)
    run(plots("", "drainage = 'drained'"), "plots_by_hand")
    check("plots: as by hand, byte for byte", (work / "plots/histories.csv").read_bytes()
          == (work / "plots_by_hand/histories.csv").read_bytes())
    run(plots(""), "plots_whole")
    whole_tip, tip = (tables.numbers(work / name / "histories.csv")[-1]["top.u_z"] for name in ("plots_whole", "plots"))
    check("plots: within the tolerance", 0 < abs(tip / whole_tip - 1) < 0.01, (tip, whole_tip))
    _, table = run(plots(more="&fix group = 'right' field = 'p_w' /"), "plots_drain", "--effects", "--quiet")
    is_on("plots that drain beyond", table, "flow in block_3_1", True)
    check("plots that drain beyond: why", "cannot be left out" in table["flow in block_3_1"]["remark"], table)
    struck = plots(more="&history name = 'p' times = -1, 0, 1.02, 1.04, 1.06 values = 2000, 0, 0, 1, 0 /\n"
                        "&load group = 'top_3' kind = 'pressure' value = 100 history = 'p' /")
    said, table = run(struck, "plots_struck")
    check("plots that are struck far off: a warning names the region and the key",
          said.count("flow in block_3_1 is off, as its pilot has found") == 2 and "drainage = 'coupled'" in said, said)
    _, table = run(plots("effects = 'auto'", stage="duration = 2 dt = 0.02"), "plots_open")
    check("plots: a small scene is asked for every effect that is open", all(
        float(table[name]["influence"] or -1) >= 0
        for name in ("inertia in load", "flow in block_1_1", "flow in block_3_1")), table)


@at_length
def test_auto_a_pressure_that_no_region_can_have():
    # What has no effect is told, whoever chooses the fields.
    said, _ = run(column("gravity = 0", **slow, more="&initial p_w = 30 /"), "nothing_holds_it")
    check("auto: a pressure that no region can have", "p_w of &initial has no effect" in said, said)
    said, _ = run(column("gravity = 0 fields = 'u' without = 'p_c'", **
                  slow).replace(AUTO, "effects_on_warning = 'stop'"), "idle")
    check("given: nothing watches", "effects_on_warning of &scene has no effect" in said, said)
    check("without what is not there", "without = 'p_c' of &scene has no effect" in said, said)
    said, _ = run(column("gravity = 0", **wet).replace(AUTO, "fields = 'u-p_w-p_c' without = 'p_w', 'p_c'").replace(
        "&stage name = 'load'", "&stage name = 'load' analysis = 'dynamic'"), "both", "--check")
    check("without two, of which one takes the other along", "no effect" in said
          and "'p_c' of &scene has no" not in said, said)


@at_length
def test_a_boundary_with_p_a_and_p_c_refused_without_p_c_with_the():
    # p_a and p_c of a boundary are its p_w too: without them it would be closed, without a word.
    by_two = column("gravity = 0", f"{QUASI_STATIC} duration = 1000 dt = 100", **{
        **wet, "more": "&fix group = 'top' field = 'p_a' /\n&fix group = 'top' field = 'p_c' value = -5 /"})
    _, table = run(by_two, "by_two", "--effects", "--quiet")
    is_on("a boundary with p_a and p_c", table, "p_c", True)
    done = start(by_two.replace(AUTO, "fields = 'u-p_w-p_c' without = 'p_c'"), "by_two_hand")
    check("a boundary with p_a and p_c: refused without p_c, with the remedy",
          done.returncode == 2 and "prescribe p_w: give p_w" in done.stderr, done.stderr)
    done = start(by_two.replace(AUTO, "fields = 'u-p_w-p_c' without = 'p_w'"), "by_two_dry")
    check("a boundary with p_a and p_c: without water both go", done.returncode == 0, done.stderr)


@at_length
def test_refused():
    # Mistakes.
    for what, text, words in [("no analysis", column("gravity = 0").replace(AUTO, ""),
                               ("needs analysis", "quasi_static")),
                              ("unknown word", column("").replace("'auto'", "'all'"), ("given|auto",)),
                              ("unknown effect", column("without = 'wind'"), ("wind", "gravity|contact")),
                              ("tolerance", column("effects_tolerance = 2"), ("outside",))]:
        done = start(text, "mistake")
        check(f"{what}: refused", done.returncode == 2 and len(done.stderr.splitlines()) == 1, done.stderr)
        for word in words:
            check(f"{what}: says {word}", word in done.stderr, done.stderr)
