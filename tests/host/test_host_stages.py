# SPDX-License-Identifier: MIT
"""Ground that joins and leaves between stages: what is refused and why, runs that are taken up again, water that new
ground brings, gravity that grows, the ground of every moment in the files of fields."""
import math
import subprocess

import h5py
from checking import check, root, work
from host_program import ENVIRONMENT, HOST, ran, start
import tables  # noqa: E402 (checking knows its folder)

SCENES = root / "verification/host/stages"


def run(name, text, *more):
    return tables.columns(work / name / "histories.csv") if ran(name, text, *more) else None


def scene(name, *pairs):
    """A scene of the page, with other words; each of them stands in it."""
    text = (SCENES / f"{name}.nml").read_text(encoding="utf-8")
    for old, new in pairs:
        check(f"{name}.nml has {old!r}", old in text)
        text = text.replace(old, new)
    return text


def test_what_is_refused():
    layers, cut = scene("embankment"), scene("water")
    later = scene("embankment", ("&initial", "! &initial"),
                  ("&region  material = 'soil'  void_ratio = 0.8  rho_s = 2.7 /", "&region group = 'block_1_1' "
                   "material = 'soil' void_ratio = 0.8 rho_s = 2.7 stages = 'one', 'two', 'three' /"))
    for what, text, code, words in (
            ("a stage that does not exist", scene("water", ("stages = 'rest' /\n&initial",
                                                              "stages = 'rust' /\n&initial")),
             11, ("there is no stage 'rust'",)),
            ("a stage without ground", later,
             2, ("no &region is part of the ground in stage 'rest'",)),
            ("a load on ground that is not there yet", layers + "&load group = 'top' kind = 'pressure' value = 1 /\n",
             11, ("&load acts in stage 'rest' on group 'top'", "name the stages in which it acts")),
            ("an absorbing boundary that leaves", cut + "&absorbing group = 'top' /\n",
             11, ("&absorbing acts in stage 'cut' on group 'top'",)),
            ("a contact with ground that leaves", cut + "&plate name = 'p' r = 0, 1 z = 5.1 mass = 1 /\n"
             "&contact name = 'c' slave = 'top' master = 'p' stages = 'cut', 'drain' /\n",
             11, ("&contact acts in stage 'cut' on group 'top'",)),
            ("a rigid body on ground that leaves", cut + "&plate name = 'p' group = 'top' mass = 1 /\n",
             11, ("&plate acts in stage 'cut' on group 'top'",)),
            ("a stress in ground that joins", scene("embankment", ("&initial group = 'block_1_1'  stress",
                                                                    "&initial stress")),
             2, ("&region with group 'block_1_2', which joins in a later stage and comes without stress",)),
            ("the flow of a start that lacks ground", scene("water", (
                "fields = 'u-p_w'", "fields = 'u-p_w' initial_flow = 'subtract'")),
             2, ("initial_flow = 'subtract'", "leave one of them out"))):
        done = start("refused", text, "--check")
        check(f"{what} is refused", done.returncode == code, (done.returncode, done.stderr))
        for word in words:
            check(f"{what}: {word}", word in done.stderr, done.stderr)
    done = start("taken", layers + "&load group = 'top' kind = 'pressure' value = 1 stages = 'three' /\n", "--check")
    check("a load that names the stages of its ground is taken", done.returncode == 0, done.stderr)


def test_a_run_is_taken_up_within_a_stage_and_at_its_end():
    # After the second step of the cut of four, where what left still holds up a half of its force, and after the last.
    begin = scene("water", ("duration = 1e7  dt = 10  dt_growth = 1.3", "duration = 100  dt = 25"))
    until_cut = begin.replace("&fix     group = 'block_1_2'  field = 'p_w'  stages = 'drain' /\n", "")
    until_cut = until_cut[:until_cut.index("&stage   name = 'drain'")] + until_cut[until_cut.index("&point"):]
    for steps, of_scene in ((3, until_cut), (5, begin)):
        text = of_scene.replace("gravity = 10", f"gravity = 10 checkpoint_steps = {steps}")
        name, folder = f"taken_up_{steps}", work / f"taken_up_{steps}"
        run(name, text)
        before = {path.name: path.read_bytes() for path in folder.glob("*.csv")}
        check("there is something to compare", "ledger.csv" in before, sorted(before))
        done = start(name, text, "--restart", folder / "checkpoint.h5")
        check(f"taken up after step {steps}", done.returncode == 0, done.stderr)
        for file in ("histories.csv", "ledger.csv", "reactions_cut.csv"):
            check(f"taken up after step {steps}: same bytes of {file}", (folder / file).read_bytes() == before[file])


FLOATS = """&scene name = 'floats' geometry = 'plane_strain' gravity = 10 /
&mesh r = 0, 1 r_cells = 1 z = 0, 1, 2, 3 z_cells = 1, 1, 1 /
&elastic name = 's' young = 1e4 poisson = 0.2 /
&region material = 's' void_ratio = 0.8 rho_s = 2.7 /
&region group = 'block_1_2' material = 's' void_ratio = 0.8 rho_s = 2.7 stages = 'one' /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&stage name = 'one' analysis = 'static' duration = 1 dt = 1 /
&stage name = 'two' analysis = 'static' duration = 1 dt = 1 /
"""
JOINS = f"""&scene name = 'joins' geometry = 'axisymmetric' /
&mesh file = '{root}/verification/host/contact/blocks.msh' /
&elastic name = 's' young = 1e4 poisson = 0 /
&region group = 'lower' material = 's' void_ratio = 0 /
&region group = 'upper' material = 's' void_ratio = 0 stages = 'two' /
&fix group = 'upper_top' field = 'u_z' stages = 'two' /
&fix group = 'axis' field = 'u_r' /
&fix group = 'lower_bottom' field = 'u_z' /
&stage name = 'one' analysis = 'static' duration = 1 dt = 1 /
&stage name = 'two' analysis = 'static' duration = 1 dt = 1 /
"""


def test_a_body_needs_a_support_while_its_ground_is_there():
    done = start("floats", FLOATS, "--check")
    check("what stands on ground that leaves is named", done.returncode == 13 and
          "Stage two: nothing holds the body of node" in done.stderr, (done.returncode, done.stderr))
    done = start("joins", JOINS, "--check")
    check("what joins later needs none before", done.returncode == 0, (done.returncode, done.stderr))

    # Advice that would be refused: the stress of sand that joins later is not asked for, that of the rest is.
    sand = JOINS.replace("&elastic name = 's' young = 1e4 poisson = 0 /", "&mud name = 's' e_0 = 0.8 /").replace(
        "void_ratio = 0", "void_ratio = 0.8")
    for what, stress, bare in (("no stress", "", True), ("ground of the start has stress",
                               "&initial group = 'lower' stress = 'uniform' sigma = -20, -20, -20 /\n", False)):
        done = start("bare", sand + stress, "--check")
        check(f"sand that joins: {what}", done.returncode == 0 and
              ("without effective stress" in done.stderr) == bare, (done.returncode, done.stderr))


def test_weights_come_and_go_evenly_over_a_stage():
    # Three layers join with a stage and leave with the next, in two steps each: elastic, so that half the weight
    # settles half as far.
    rows = run("evenly", scene("embankment", *((f"stages = {names} /", "stages = 'one' /") for names in (
        "'one', 'two', 'three'", "'two', 'three'", "'three'"))))
    if rows is None:
        return
    full = rows["z2.u_z"][rows["time"] == 2][0]
    # 3 m of (2.7*10)/1.8 kN/m3 on 2 m with a constrained modulus of 1.346e7 kPa.
    check("their weight", abs(full/(-45*2/1.346e7) - 1) < 1e-3, full)
    for time, share in ((1.5, 0.5), (2.5, 0.5), (3, 0)):
        now = rows["z2.u_z"][rows["time"] == time][0]
        check(f"share of the weight at {time} s", abs(now/full - share) < 1e-4, (now, full))


SUCTIONS = """&scene name = 'wet' geometry = 'plane_strain' fields = 'u-p_w-p_c' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1, 2 z_cells = 2, 2 /
&elastic name = 's' young = 1e8 poisson = 0 /
&retention name = 'r' law = 'van_genuchten' alpha = 0.1 n = 2 /
&permeability name = 'k' intrinsic = 1e-11 law = 'constant' /
&fluids k_w = 2e6 /
&region group = 'block_1_1' material = 's' permeability = 'k' retention = 'r' void_ratio = 0.8 /
&region group = 'block_1_2' material = 's' permeability = 'k' retention = 'r' void_ratio = 0.8 stages = 'two' /
&initial group = 'block_1_2' p_w = -20 p_c = 20 /
&initial group = 'block_1_1' p_w = -5 p_c = 5 stress = 'uniform' sigma = 0, 0, 0 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'all' field = 'p_a' /
&stage name = 'one' analysis = 'static' duration = 1 dt = 1 /
&stage name = 'two' analysis = 'quasi_static' duration = 1e8 dt = 10 dt_growth = 1.5 tolerance = 1e-8 /
&point name = 'low' r = 0 z = 0 /
&point name = 'high' r = 0 z = 2 /
"""


def test_new_ground_brings_its_water():
    # Without gravity the suction becomes the same everywhere, and the water of both blocks is there: the mean of
    # the saturations of 5 and 20 kPa, S = (1 + (0.1 s)**2)**-0.5. Water is lighter in tension by 1e-5.
    rows = run("wet", SUCTIONS)
    if rows is None:
        return
    curve = lambda s: (1 + (0.1*s)**2)**-0.5  # noqa: E731
    wanted = (curve(5) + curve(20))/2
    suction = 10*math.sqrt(wanted**-2 - 1)
    for name in ("low", "high"):
        check(f"{name}: the suction of the water of both", abs(rows[f"{name}.p_c"][-1]/suction - 1) < 1e-3,
              (rows[f"{name}.p_c"][-1], suction))
    check("nothing happens before", abs(rows["low.p_c"][1] - 5) < 1e-9, rows["low.p_c"][1])


LEAKS = """&scene name = 'leaks' geometry = 'plane_strain' fields = 'u-p_w' /
&mesh r = 0, 1, 2 r_cells = 2, 2 z = 0, 1 z_cells = 2 /
&elastic name = 'soil' young = 1e4 poisson = 0.2 /
&permeability name = 'k' intrinsic = 1e-10 /
&region group = 'block_1_1' material = 'soil' void_ratio = 0.5 permeability = 'k' /
&region group = 'block_2_1' material = 'soil' void_ratio = 0.5 drainage = 'drained' stages = {} /
&stage name = 'one' analysis = 'quasi_static' duration = 10 dt = 1 tolerance = 1e-9 /
&stage name = 'two' analysis = 'quasi_static' duration = 10 dt = 1 tolerance = 1e-9 /
&fix group = 'all' field = 'u_r' /
&fix group = 'all' field = 'u_z' /
&load group = 'left' kind = 'water' value = 1e-7 /
&point name = 'left' r = 0 z = 0.5 /
"""


def test_drained_ground_takes_water_while_it_is_there():
    # The ground stands still, so that 1e-7 m/s for 10 s on 1 m2 stay in a third of 1 m3 with k_w = 2.2e6 kPa, 6.6 kPa,
    # unless they flow into the drained ground beside it: then p_w is linear, 1e-7 m/s over 1e-4 m2/(kPa s), 1e-3 kPa.
    held, flows = 1e-7*10*2.2e6*3, 1e-3
    for stages, wanted in (("'one', 'two'", (flows, flows)), ("'one'", (flows, flows + held)),
                           ("'two'", (held, flows))):
        rows = run("leaks", LEAKS.format(stages))
        if rows is None:
            continue
        p_w = rows["left.p_w"][rows["time"] == 10][0], rows["left.p_w"][-1]
        for k in (0, 1):
            check(f"drained ground in {stages}, stage {k + 1}", abs(p_w[k]/wanted[k] - 1) < 1e-3, (p_w, wanted))


def test_gravity_that_grows_after_the_cut():
    # Elastic: the end does not depend on the order of the lifts' weights and of the growth of gravity.
    def spun(name, time, *pairs):
        """The excavation, with a stage at its end in which gravity doubles from a time on."""
        return run(name, scene(
            "excavation", ("gravity = 10", "gravity = 10 gravity_history = 'g'"),
            ("&fix     group = 'left'", f"&history name = 'g' times = 0, {time}, {time + 1} values = 1, 1, 2 /\n"
             "&fix     group = 'left'"),
            ("&point   name = 'base'", "&stage name = 'spin' analysis = 'static' duration = 1 dt = 0.5 "
             "tolerance = 1e-10 /\n&point   name = 'base'"), *pairs))

    lifts = spun("spin_4", 5)
    stage = "&stage   name = 'lift{}'  analysis = 'static'  duration = 1  dt = 0.5  tolerance = 1e-10 /\n"
    once = spun("spin_1", 2, *((stage.format(i), "") for i in (1, 2, 3)),
                *((f"stages = {names} /", "stages = 'rest' /") for names in (
                    "'rest', 'lift1', 'lift2', 'lift3'", "'rest', 'lift1', 'lift2'", "'rest', 'lift1'")))
    if lifts is None or once is None:
        return
    for name in ("base.u_z", "edge.u_r", "edge.u_z", "toe.u_z"):
        check(f"{name}: four lifts as one", abs(lifts[name][-1]/once[name][-1] - 1) < 1e-7,
              (lifts[name][-1], once[name][-1]))
    # Before the growth the heave of the cut, with it the settlement of what is left: gravity has its part.
    check("gravity grew", lifts["base.u_z"][-1] < lifts["base.u_z"][-3] - 1e-5, lifts["base.u_z"][-3:])


def test_sudden_loads_that_grow_over_a_stage_are_taken_up():
    # Six iterations at once, and four are allowed: the load grows over the stage, five steps. After the third of them.
    text = ("""&scene name = 't' fields = 'u' gravity = 9.81 checkpoint_steps = 3 /
&mesh r = 0, 0.5, 2 r_cells = 2, 3 z = -2, 0 z_cells = 4 /
&mud name = 'sand' e_0 = 0.75 /
&region material = 'sand' /
&initial stress = 'geostatic' k_0 = 0.5 surcharge = 0.5 /
&stage name = 's' analysis = 'static' duration = 1 dt = 1 max_iterations = 4 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 0.5 /
&load group = 'top_1' kind = 'pressure' value = 160 /
&point name = 'c' r = 0 z = 0 /
""")
    done = start("sudden", text)
    check("the warning names the stage", done.returncode == 0 and "stage s: its loads act at once" in done.stderr
          and "evenly over the stage" in done.stderr, done.stderr)
    folder = work / "sudden"
    before = (folder / "histories.csv").read_bytes()
    check("steps before and after the checkpoint", len(before.splitlines()) > 5, before)
    done = start("sudden", text, "--restart", folder / "checkpoint.h5")
    check("taken up: same bytes", done.returncode == 0 and (folder / "histories.csv").read_bytes() == before,
          done.stderr)


def test_fields_say_what_is_ground():
    folder = work / "layers"
    if run("layers", scene("embankment")) is None:
        return
    found = []
    for path in sorted(folder.glob("fields_*.h5")):
        with h5py.File(path) as file:
            found.append(int(file["cells/ground"][...].sum()))
    # Two triangles a cell: two cells, then one more with every layer; a picture at the start and at every end.
    check("ground of every moment", sorted(set(found)) == [4, 6, 8, 10], found)
    check("it grows", found == sorted(found), found)
    check("results.xdmf has it", "ground [-]" in (folder / "results.xdmf").read_text())
    done = subprocess.run([HOST, root / "tests/host/scenes/restart.nml", "--output", work / "plain", "--quiet"],
                          capture_output=True, env=ENVIRONMENT)
    check("no such field where nothing joins or leaves", done.returncode == 0
          and "ground" not in (work / "plain/results.xdmf").read_text())
