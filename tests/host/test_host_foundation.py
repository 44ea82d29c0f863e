# SPDX-License-Identifier: MIT
"""Plates that move in the plane: free flight, what holds them, what is refused and why, moments and rotations in the
tables, a tie and a contact that agree, runs that are taken up again."""
import math
import subprocess

from checking import check, root, work
from host_program import ENVIRONMENT, HOST, ran, start
import tables  # noqa: E402 (checking knows its folder)

SCENES = root / "verification/host/foundation"
GROUND = """&scene name='s' geometry='plane_strain' gravity=10 /
&mesh r=-3,-1,1,3 r_cells=4,4,4 z=-3,0 z_cells=4 /
&elastic name='soil' young=1e4 poisson=0.3 /
&region material='soil' void_ratio=0 /
&fix group='bottom' field='u_r' /
&fix group='bottom' field='u_z' /
"""
TIED = "&plate name='raft' motion='plane' group='top_2' center=0,0.5 mass=2 inertia=0.6{more} /\n"
FREE = "&plate name='raft' motion='plane' r=-1,1 z=0 center=0,0.5 mass=2 inertia=0.6 weight='yes'{more} /\n"
PUSH = "&stage name='push' analysis='static' duration=1 dt=0.5 steps='given' tolerance=1e-8 max_iterations=40 /\n"


def run(name, text, *more):
    """The last row of contact.csv."""
    ran(name, text, *more)
    return {key: column[-1] for key, column in tables.columns(work / name / "contact.csv").items()}


def test_a_body_flies_as_newton_says():
    # Under constant forces: parabolas of its centre and of its angle, through more than half a turn.
    text = GROUND.replace(" gravity=10", "") + FREE.format(more=" force=10 force_r=4 moment=12")
    text = text.replace("r=-1,1 z=0 center=0,0.5", "r=-1,1 z=10 center=0,10.5")
    text += "&stage name='fly' analysis='dynamic' duration=0.6 dt=0.01 rho_inf=1 /\n"
    end = run("flight", text)
    for name, acceleration in (("turn", 12 / 0.6), ("u_r", 4 / 2), ("u_z", 10 / 2)):
        check(f"{name} by its acceleration", math.isclose(end[f"raft.{name}"], 0.18 * acceleration, rel_tol=1e-9), end)
    ledger = tables.columns(work / "flight" / "ledger.csv")
    kinetic = 0.5 * 2 * (end["raft.v_r"] ** 2 + end["raft.v_z"] ** 2) + 0.5 * 0.6 * end["raft.v_turn"] ** 2
    check("its energy is that of its mass and inertia", math.isclose(ledger["kinetic"][-1], kinetic, rel_tol=1e-9))
    check("the balance of energy closes", abs(ledger["imbalance"][-1]) < 1e-8 * kinetic, ledger["imbalance"][-1])


def test_what_is_refused():
    wanted = GROUND + TIED.format(more="") + PUSH
    for what, text, code, words in (
            ("axial symmetry", wanted.replace("geometry='plane_strain' ", ""), 2,
             ("motion = 'plane' turns the plate, which axial symmetry has no place for", "geometry = 'plane_strain'")),
            ("no inertia", wanted.replace(" inertia=0.6", ""), 2,
             ("needs center = r, z", "inertia, its moment of inertia")),
            ("no center", wanted.replace(" center=0,0.5", ""), 2, ("needs center = r, z",)),
            ("a center of three numbers", wanted.replace("center=0,0.5", "center=0,0.5,1"), 2, ("are two numbers",)),
            ("an outline of one corner", wanted.replace("group='top_2'", "outline=0,1"), 2,
             ("are two corners or more",)),
            ("two places", wanted.replace("group='top_2'", "group='top_2' r=0,1"), 2, ("give one of the two",)),
            ("nothing to tie", wanted.replace("group='top_2'", "group='all'"), 11, ("has no edges that could move",)),
            ("a rotation of a boundary", wanted + "&fix group='top' field='rotation' /\n", 2,
             ("a rotation and a moment are those of a &plate", "'top' is none")),
            ("a moment on a plate that does not turn", wanted + "&plate name='p' r=2,3 z=1 mass=1 /\n"
             "&load group='p' kind='moment' value=1 /\n", 2, ("'p' is none",)),
            ("a plate that nothing holds along r", GROUND + FREE.format(more="") + PUSH
             + "&contact name='c' slave='top' master='raft' /\n", 13,
             ("against moving along r (x)", "with friction along a plate")),
            ("a body that nothing holds against turning", GROUND.replace("'bottom'", "'raft'")
             + TIED.format(more="") + PUSH, 13, ("against turning",))):
        done = start("refused", text, "--check")
        check(f"{what} is refused", done.returncode == code, (done.returncode, done.stderr))
        for word in words:
            check(f"{what}: {word}", word in done.stderr, done.stderr)


def test_a_tie_and_a_contact_agree():
    # Pressed by its weight the raft stays in contact everywhere; with much friction that is a tie, of means over nodes.
    load = " moment=3 force_r=2"
    tied = run("tied", GROUND + TIED.format(more=load + " weight='yes'") + PUSH)
    pressed = run("pressed", GROUND + FREE.format(more=load) + PUSH
                  + "&contact name='c' slave='top_2' master='raft' penalty=1e8 friction=50 gap='nodal' /\n")
    for name in ("u_z", "u_r", "turn"):
        check(f"{name} of tie and contact", math.isclose(tied[f"raft.{name}"], pressed[f"raft.{name}"], rel_tol=2e-2),
              (tied, pressed))
    for name, value in (("moment", 3), ("load_r", 2), ("load", -20)):
        check(f"{name} is told", tied[f"raft.{name}"] == value, tied)


def test_moments_and_rotations_in_the_tables():
    # The rotation that a moment makes asks for that moment when it is prescribed; so do the displacements.
    loads = ("&load group='raft' kind='moment' value=3 /\n&load group='raft' kind='force_r' value=2 /\n"
             "&load group='raft' kind='force_z' value=-5 /\n")
    free = run("free_raft", GROUND + TIED.format(more="") + PUSH + loads)
    told = tables.columns(work / "free_raft" / "reactions_push.csv")
    check("the moment of the load", math.isclose(told["raft.load_turn"][-1], 3, rel_tol=1e-12), told)
    supports = "".join(f"&fix group='raft' field='{field}' value={float(free['raft.' + name])!r} history='up' /\n"
                       for field, name in (("rotation", "turn"), ("u_r", "u_r"), ("u_z", "u_z")))
    held = run("held_raft", GROUND + TIED.format(more="") + PUSH + supports
               + "&history name='up' times=0,1 values=0,1 /\n")
    told = tables.columns(work / "held_raft" / "reactions_push.csv")
    check("the rotation is what was prescribed", math.isclose(held["raft.turn"], free["raft.turn"], rel_tol=1e-12))
    for name, value in (("moment", 3), ("force_r", 2), ("force_z", -5)):
        check(f"{name} of the support", math.isclose(told[f"raft.{name}"][-1], value, rel_tol=1e-6), told)


def test_a_rotated_frame_of_loads():
    # A force beside the centre is a force at the centre and a moment: the raft with its centre moved answers alike.
    one = run("centre_above", GROUND + TIED.format(more=" force=-4 force_r=2 moment=3") + PUSH)
    # From (0.5, -0.3) the arm to (0, 0.5) is (-0.5, 0.8). It turns with the raft: by the angle, beside one.
    arm_r, arm_z = -0.5, 0.8
    moment = 3 + arm_r * (-4) - arm_z * 2
    moved = TIED.format(more=f" force=-4 force_r=2 moment={moment}").replace("0,0.5", "0.5,-0.3")
    two = run("centre_moved", GROUND + moved + PUSH)
    turn = one["raft.turn"]
    for name, wanted in (("turn", turn), ("u_r", one["raft.u_r"] + arm_z * turn),
                         ("u_z", one["raft.u_z"] - arm_r * turn)):
        check(f"{name} by the arm", math.isclose(two[f"raft.{name}"], wanted, rel_tol=1e-3), (one, two))


def test_a_run_is_taken_up_bitwise():
    text = (SCENES / "rocking.nml").read_text(encoding="utf-8").replace("duration=2.5", "duration=0.4")
    run("rocking", text.replace("gravity=9.81", "gravity=9.81 checkpoint_steps=170"))
    whole = (work / "rocking" / "contact.csv").read_bytes()
    done = subprocess.run([HOST, work / "rocking.nml", "--restart", work / "rocking" / "checkpoint.h5", "--quiet"],
                          capture_output=True, text=True, env=ENVIRONMENT)
    check("it is taken up", done.returncode == 0, done.stderr)
    check("to the same bytes", (work / "rocking" / "contact.csv").read_bytes() == whole)


def test_displacements_begin_anew_with_those_of_the_plate():
    text = GROUND + TIED.format(more=" weight='yes'") + PUSH.replace("dt=0.5", "dt=0.5 zero_displacements='yes'")
    text += PUSH.replace("'push'", "'again'")
    done = start("anew", text)
    check("anew runs", done.returncode == 0, done.stderr)
    table = tables.columns(work / "anew" / "contact.csv")
    check("the weight has settled it", table["raft.u_z"][1] < -1e-4, table["raft.u_z"])
    check("then it stays, and so does the ground", abs(table["raft.u_z"][-1]) < 1e-9 * abs(table["raft.u_z"][1]),
          table["raft.u_z"])


def test_springs_of_a_tie_ask_for_no_steps():
    # Shaken after its weight has settled it: neither zeroed displacements nor stiffer springs make the body vibrate.
    text = GROUND.replace("gravity=10", "gravity=10 step_tolerance=3e-2") + "&initial stress='geostatic' k_0=0.5 /\n"
    text += TIED.format(more=" weight='yes' moment=4 history='wave'{penalty}") + "&point name='edge' r=1 z=0 /\n"
    text += "&history name='wave' times=0,1,1.05,1.15,1.2 values=0,0,1,-1,0 /\n"
    text += "&stage name='rest' analysis='static' duration=1 dt=1 zero_displacements='yes' /\n"
    text += "&stage name='shake' analysis='dynamic' duration=0.3 /\n"
    steps, ends = {}, {}
    for penalty in ("1e8", "1e10"):
        done = start(f"shaken_{penalty}", text.replace("{penalty}", f" penalty={penalty}"))
        check(f"{penalty} runs", done.returncode in (0, 20), done.stderr)
        table = tables.columns(work / f"shaken_{penalty}" / "contact.csv")
        steps[penalty], ends[penalty] = len(table["time"]), abs(table["raft.turn"]).max()
    check("the steps are as many", abs(steps["1e10"] / steps["1e8"] - 1) < 0.1, steps)
    check("the rotations are alike", abs(ends["1e10"] / ends["1e8"] - 1) < 1e-2, ends)
