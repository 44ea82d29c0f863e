# SPDX-License-Identifier: MIT
"""Keys of a scene that no page of the verification uses, against answers known in closed form."""
from checking import check, root, work
from host_program import ran, start
import tables  # noqa: E402 (checking knows its folder)

# E = 1e4 kPa, nu = 0.25: G = 4000 kPa, constrained modulus M = 12000 kPa. A block of 1 m in plane strain.
SHEAR, CONSTRAINED = 4000.0, 12000.0
BLOCK = """&scene name = 'block' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'soil' young = 1.0e4 poisson = 0.25 /
&region material = 'soil' void_ratio = 0 /
&stage name = 's' analysis = 'static' duration = {} dt = {} tolerance = 1e-12 /
&point name = 'corner' r = 1 z = 1 /
"""
ROUNDING = 1e-12   # of a linear problem with a few unknowns, relative


def run(text, name, *words):
    """The last row of its histories, and its folder."""
    ran(name, text, *words)
    return tables.numbers(work / name / "histories.csv"), work / name


def near(what, value, wanted):
    check(what, abs(float(value) - wanted) <= ROUNDING * abs(wanted), f"{value} for {wanted}")


once = BLOCK.format(1, 1)

# A plate makes the three nodes of the top one unknown, so that 2 kN a node are 6 kN on 1 m2.
held = "&fix group = 'all' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /\n"


def test_shear_on_an_edge_over_the_shear_modulus():
    rows, _ = run(once + "&fix group = 'all' field = 'u_z' /\n&fix group = 'bottom' field = 'u_r' /\n"
                  "&load group = 'top' kind = 'shear_r' value = 10 /\n", "shear_r")
    near("shear along r: 10 kPa over G", rows[-1]["corner.u_r"], 10 / SHEAR)
    rows, _ = run(once + "&fix group = 'all' field = 'u_r' /\n&fix group = 'left' field = 'u_z' /\n"
                  "&load group = 'right' kind = 'shear_z' value = 10 /\n", "shear_z")
    near("shear along z: 10 kPa over G", rows[-1]["corner.u_z"], 10 / SHEAR)
    plate = "&plate name = 'lid' group = 'top' mass = 1 /\n"
    rows, folder = run(once + held + plate + "&load group = 'top' kind = 'force_z' value = -2 /\n", "force_z")
    near("forces on nodes: 6 kN over M", rows[-1]["corner.u_z"], -6 / CONSTRAINED)
    row = tables.numbers(folder / "contact.csv")[-1]
    near("a joined plate tells its motion", row["lid.u_z"], -6 / CONSTRAINED)
    weightless = once.replace("fields = 'u'", "fields = 'u' gravity = 10").replace("void_ratio", "rho_s = 0 void_ratio")
    rows, _ = run(weightless + held
                  + "&plate name = 'lid' group = 'top' mass = 0.3 weight = 'yes' force = -3 /\n", "lid")
    near("a joined plate has its force and its weight", rows[-1]["corner.u_z"], -(3 + 0.3 * 10) / CONSTRAINED)
    rows, _ = run(once + held + plate + "&fix group = 'lid' field = 'u_z' value = -1e-3 /\n", "group")
    near("the name of a joined plate is a group", rows[-1]["corner.u_z"], -1e-3)


def test_tied_plates_have_the_mass_of_both():
    # A tie of their boundaries makes one body of two plates: 10 and 10 Mg move as 20 Mg do, by the same equations.
    tied = BLOCK.format(0.01, 0.001).replace("'static'", "'dynamic'") + "&tie first = 'left' second = 'right' /\n"
    left = "&plate name = 'left_plate' group = 'left' mass = {} force = -3 /\n"
    whole, _ = run(tied + left.format(20), "whole")
    halves, _ = run(tied + left.format(10) + "&plate name = 'other' group = 'right' mass = 10 /\n", "halves")
    near("two tied plates move as one of their mass", halves[-1]["corner.u_z"], float(whole[-1]["corner.u_z"]))


def test_a_support_holds_until_it_is_released():
    # A support that goes after 1 s leaves an elastic block to its load of 12 kPa, over M.
    rows, _ = run(BLOCK.format(2, 0.5) + held + "&fix group = 'top' field = 'u_z' value = -2e-3 until = 1 /\n"
                  "&load group = 'top' kind = 'pressure' value = 12 /\n", "until")
    moved = {float(row["time"]): float(row["corner.u_z"]) for row in rows}
    near("a support holds up to `until`", moved.get(1.0, 0), -2e-3)
    near("and releases it afterwards", moved.get(1.5, 0), -1e-3)


def test_a_support_from_the_end_of_a_stage_on_is_not_there_before():
    # Stages of 0.1 and 0.2 s end at 0.30000000000000004 s: still the load of 12 kPa alone, over M.
    stages = "".join(f"&stage name = '{name}' analysis = 'static' duration = {d} dt = {d} tolerance = 1e-12 /\n"
                     for name, d in (("s2", 0.2), ("s3", 0.1)))
    rows, _ = run(BLOCK.format(0.1, 0.1) + stages + held + "&load group = 'top' kind = 'pressure' value = 12 /\n"
                  "&fix group = 'top' field = 'u_z' value = -2e-3 from = 0.3 /\n", "from")
    moved = [float(row["corner.u_z"]) for row in rows[-2:]]
    near("a support from the end of a stage on is not there before", moved[0], -1e-3)
    near("and is there in the next stage", moved[1], -2e-3)


def test_times_of_a_support_are_exact_after_thirty_years():
    # Half-millisecond steps: the support of 2 ms comes with the one that ends at 2.5 ms, and goes with that of 3.5 ms.
    late = "&stage name = 'late' analysis = 'static' duration = 0.004 dt = 0.0005 tolerance = 1e-12 /\n"
    rows, _ = run(BLOCK.format(1e9, 1e9) + late + held + "&load group = 'top' kind = 'pressure' value = 12 /\n"
                  "&fix group = 'top' field = 'u_z' value = -2e-3 from = 1000000000.002 until = 1000000000.003 /\n",
                  "late")
    there = [float(row["corner.u_z"]) < -1.5e-3 for row in rows[-8:]]
    check("from 2 to 3 ms alone", there == [False]*4 + [True]*2 + [False]*2, there)
    # Every step of 0.3 ms rounds the time by half a spacing: after forty the support of 12 ms still holds.
    rows, _ = run(BLOCK.format(1e9, 1e9) + "&stage name = 'late' analysis = 'static' duration = 0.018 dt = 0.0003 "
                  "tolerance = 1e-12 /\n" + held + "&load group = 'top' kind = 'pressure' value = 12 /\n"
                  "&fix group = 'top' field = 'u_z' value = -2e-3 until = 1000000000.012 /\n", "late_many")
    there = [float(row["corner.u_z"]) < -1.5e-3 for row in rows[-60:]]
    check("through step 40 and no longer", there == [True]*40 + [False]*20, there.count(True))


def test_times_of_a_support_are_those_of_many_steps():
    # A sum of 292 steps of 0.2 s is 58.40000000000029 s: still the last step up to 58.4 s.
    rows, _ = run(BLOCK.format(60, 0.2) + held + "&load group = 'top' kind = 'pressure' value = 12 /\n"
                  "&fix group = 'top' field = 'u_z' value = -2e-3 until = 58.4 /\n", "many")
    moved = [float(row["corner.u_z"]) for row in rows if abs(float(row["time"]) - 58.5) < 0.15]
    near("it holds in step 292", moved[0], -2e-3)
    near("and no longer in the next", moved[1], -1e-3)


def test_checkpoints_by_wall_time():
    # Wall time: shorter than any step, so that there is one after every step; the last one is whole and goes on.
    text = BLOCK.format(1, 0.25).replace("fields = 'u'", "fields = 'u' checkpoint_seconds = 1e-9") + held + \
        "&load group = 'top' kind = 'pressure' value = 10 /\n"
    _, folder = run(text, "seconds")
    check("checkpoints by wall time", (folder / "checkpoint.h5").exists(), sorted(f.name for f in folder.iterdir()))
    before = (folder / "histories.csv").read_bytes()
    run(text, "seconds", "--restart", folder / "checkpoint.h5")
    check("and the run goes on from the last one", (folder / "histories.csv").read_bytes() == before)


def test_search_radius():
    # A plate 0.01 mm above the ground, which it meets within 1 ms; edges
    # farther apart than the search radius do not meet.
    fall = (root / "verification/host/contact/fall.nml").read_text().replace("duration = 0.006", "duration = 0.001")
    for radius, meets in (("0", True), ("1.0e-3", True), ("1.0e-9", False)):
        near_by = fall.replace("penalty = 1.0e7", f"penalty = 1.0e7\n   search_radius = {radius}")
        _, folder = run(near_by, f"radius_{radius}")
        thrust = max(row["soil_plate.thrust"] for row in tables.numbers(folder / "contact.csv"))
        check(f"search radius {radius}", (thrust > 0) == meets, thrust)


def test_a_key_set_from_outside_is_that_of_the_scene():
    # By number, by name, and once more: the last value counts.
    loaded = (once + "&fix group = 'all' field = 'u_z' /\n&fix group = 'bottom' field = 'u_r' /\n"
              "&load group = 'top' kind = 'shear_z' value = 1 /\n&load group = 'top' kind = 'shear_r' value = 1 /\n")
    rows, folder = run(loaded, "set", "--set", "load[2].value=30", "--set", "elastic[soil].young=1",
                       "--set", "elastic[soil].young=2e4")
    near("30 kPa over twice G", rows[-1]["corner.u_r"], 30 / (2 * SHEAR))


def test_steps_end_where_a_file_says():
    ends = (0.125, 0.25, 0.875)
    (work / "ends.txt").write_text("# since the start of the stage\n0.125 0.125\n0.25 0.125\n0.875 0.625\n")
    # After a stage of 1 s; the last step ends with the stage, as the file does not say so.
    text = (BLOCK.format(1, 1).replace("&point", "&stage name = 't' analysis = 'quasi_static' duration = 1 dt = 0.125 "
                                       "steps = 'given' step_ends = 'ends.txt' /\n&point") + held)
    rows, _ = run(text, "ends")
    times = [float(row["time"]) for row in rows]
    check("steps end where the file says", times == [0, 1, *(1 + t for t in ends), 2], times)
    done = start("ends_free", text.replace("steps = 'given'", "steps = 'controlled'"))
    check("controlled steps end where their error says", done.returncode == 2 and "step_ends of &stage t needs" in
          done.stderr, done.stderr)
