# SPDX-License-Identifier: MIT
"""Gravity that follows a &history: columns, a spin-up, a flight and a plate, each against its closed form."""
import subprocess

from checking import check, work
from host_program import ENVIRONMENT, HOST, ran
import tables  # noqa: E402 (checking knows its folder)

G, HEIGHT, RHO = 9.81, 2.0, 2.0
SOFT, STIFF = 1e4, 1e7   # kPa; a column that strains by 1e-6 keeps its density to 1e-6.
SCENE = """&scene name = 'g' geometry = 'plane_strain' {scene} /
&mesh r = 0, 1 r_cells = 1 z = 0, 2 z_cells = 4 /
&elastic name = 's' young = {young} poisson = 0 /
&history name = 'n' times = {times} values = {values} /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&point name = 'top' r = 0 z = 2 /
&point name = 'base' r = 0 z = 0 /
"""
FOOT = "&fix group = 'bottom' field = 'u_z' /\n"
DRY = f"&region material = 's' void_ratio = 0 rho_s = {RHO} /\n"


def run(name, text, *more):
    return tables.numbers(work / name / "histories.csv") if ran(name, text, *more) else []


def factor(time, times, values):
    """The history at a time: straight lines between its pairs."""
    for (t0, v0), (t1, v1) in zip(zip(times, values), zip(times[1:], values[1:])):
        if time <= t1:
            return v0 + (v1 - v0)*(time - t0)/(t1 - t0)
    return values[-1]


def scene(keys, young, times, values, more):
    listed = [", ".join(f"{x:.17g}" for x in xs) for xs in (times, values)]
    return SCENE.format(scene=keys, young=young, times=listed[0], values=listed[1]) + more


# As in a centrifuge: geostatic stress at 1 g is in balance, then the weight grows to 50 g. What settles is the
# increase, and at the end the stress at the base is fifty times as large.
N = 50.0


def test_the_column_settles_with_its_weight_at_s():
    # A column under its weight that grows and falls again: u_z(top) = -N rho g H**2/(2 E), without Poisson's ratio; the
    # elements are quadratic as the solution is.
    times, values = (0, 1, 2), (0, 1, 0.25)
    for analysis, tolerance in (("static", 1e-5), ("quasi_static", 1e-5)):
        rows = run(analysis, scene(f"gravity = {G} gravity_history = 'n'", STIFF, times, values, DRY + FOOT
                                   + f"&stage name = 'spin' analysis = '{analysis}' duration = 2 dt = 0.25 "
                                   "tolerance = 1e-9 /\n"))
        for row in rows[1:]:
            wanted = -factor(row["time"], times, values)*RHO*G*HEIGHT**2/2/STIFF
            check(f"{analysis}: the column settles with its weight at {row['time']} s",
                  abs(row["top.u_z"]/wanted - 1) < tolerance, (row["top.u_z"], wanted))
    forces = tables.numbers(work / "static/reactions_spin.csv")
    wanted = factor(2, times, values)*RHO*G*HEIGHT
    check("the support carries the weight of the moment", abs(forces[-1]["bottom.force_z"]/wanted - 1) < 1e-5,
          (forces[-1]["bottom.force_z"], wanted))
    spin = scene(f"gravity = {N*G} gravity_history = 'n'", STIFF, (0, 1, 11), (1/N, 1/N, 1), DRY + FOOT
                 + "&initial stress = 'geostatic' surface = 2 k_0 = 0 /\n"
                 "&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-9 /\n"
                 "&stage name = 'spin' analysis = 'static' duration = 10 dt = 2.5 tolerance = 1e-9 /\n")
    rows = run("spin", spin)
    weight = N*RHO*G*HEIGHT
    check("spin-up: the initial stress balances 1 g", abs(rows[1]["top.u_z"]) < 1e-8*weight*HEIGHT/STIFF, rows[1])
    wanted = -(1 - 1/N)*weight*HEIGHT/2/STIFF
    check("spin-up: what settles is the increase of the weight", abs(rows[-1]["top.u_z"]/wanted - 1) < 1e-4,
          (rows[-1]["top.u_z"], wanted))

    # A run that is taken up on the way has the gravity of its moment.
    text = spin.replace("gravity = ", "checkpoint_steps = 3 gravity = ")
    run("whole", text)
    kept = work / "whole/checkpoint.h5"
    before = (work / "whole/histories.csv").read_bytes()
    run("whole", text, "--restart", kept)
    check("restart: same bytes", (work / "whole/histories.csv").read_bytes() == before)
    (work / "other.nml").write_text(text.replace("11 values = 0.02, 0.02, 1", "11 values = 0.02, 0.02, 0.9"))
    done = subprocess.run([HOST, work / "other.nml", "--restart", kept, "--check"], capture_output=True, text=True,
                          env=ENVIRONMENT)
    check("restart with another weight so far: refused with its history", done.returncode == 17
          and "&history in line " in done.stderr, done.stderr)


def test_without_gravity_its_history_goes_too():
    # What is left is the load alone: u_z = -p H/E.
    load = "&load group = 'top' kind = 'pressure' value = 100 history = 'n' /\n"
    rows = run("weightless", scene(f"gravity = {G} gravity_history = 'n' without = 'gravity'", 1e4, (0, 1, 2),
                                   (0, 1, 1), DRY + FOOT + load + "&stage name = 'spin' analysis = 'static' "
                                   "duration = 2 dt = 0.25 tolerance = 1e-9 /\n"))
    check("without gravity the load alone acts", abs(rows[-1]["top.u_z"]/(-100*HEIGHT/1e4) - 1) < 1e-8, rows[-1])


def test_spin_up_stresses_grow_by_the_factor():
    # A quadrature point near the base bears the weight above it: 50 times that at 1 g there.
    points = [tables.numbers(work / f"spin/points_{stage}.csv") for stage in ("rest", "spin")]
    for one, two in zip(*points):
        check("spin-up: stresses grow by the factor", abs(two["s_zz"]/one["s_zz"]/N - 1) < 1e-3, (one, two))


def test_spin_up_water_at_rest_at_n_g():
    # The water of a saturated column follows: slowly, its pressure is that of water at rest at N g.
    rows = run(
        "water",
        scene(
            f"fields = 'u-p_w' gravity = {N*G} gravity_history = 'n'", STIFF, (0, 1e4, 2e4),
            (0, 1, 1),
            f"&permeability name = 'k' intrinsic = 1e-9 law = 'constant' /\n"
            f"&region material = 's' permeability = 'k' void_ratio = 0.8 /\n{FOOT}"
            "&fix group = 'top' field = 'p_w' /\n&stage name = 'spin' analysis = 'quasi_static' "
            "duration = 2e4 dt = 500 /\n"))
    check("spin-up: water at rest at N g", abs(rows[-1]["base.p_w"]/(N*G*HEIGHT) - 1) < 1e-3, rows[-1]["base.p_w"])


def test_flight_the_fall_under_a_growing_weight():
    # In flight under g t/T every node falls by g t**3/(6 T), and the weight's work becomes kinetic energy.
    rows = run("flight", scene(f"gravity = {G} gravity_history = 'n'", STIFF, (0, 1), (0, 1), DRY
                               + "&stage name = 'fall' analysis = 'dynamic' duration = 1 dt = 0.005 rho_inf = 1 /\n"))
    check("flight: the fall under a growing weight", abs(rows[-1]["top.u_z"]/(-G/6) - 1) < 1e-4, rows[-1]["top.u_z"])
    last = tables.numbers(work / "flight/ledger.csv")[-1]
    wanted = 0.5*RHO*HEIGHT*(G/2)**2
    check("flight: kinetic energy", abs(last["kinetic"]/wanted - 1) < 1e-4, (last["kinetic"], wanted))
    check("flight: it is the work of the weight", abs(last["gravity"]/last["kinetic"] - 1) < 1e-4, last)


def test_a_plates_weight_follows_at_s():
    # The weight of a plate is part of it: the thrust of its contact is m N g.
    run("plate", scene(f"gravity = {G} gravity_history = 'n'", SOFT, (0, 2), (1, 3), FOOT
                       + "&region material = 's' void_ratio = 0 rho_s = 1e-9 /\n"
                       "&plate name = 'p' r = 0, 1 z = 2 mass = 0.5 weight = 'yes' /\n"
                       "&contact name = 'c' slave = 'top' master = 'p' penalty = 1e6 /\n"
                       "&stage name = 'spin' analysis = 'static' duration = 2 dt = 0.25 tolerance = 1e-5 /\n"))
    for row in tables.numbers(work / "plate/contact.csv"):
        wanted = 0.5*G*factor(row["time"], (0, 2), (1, 3))
        check(f"a plate's weight follows at {row['time']} s", abs(row["c.thrust"]/wanted - 1) < 1e-5,
              (row["c.thrust"], wanted))
