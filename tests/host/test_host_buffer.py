# SPDX-License-Identifier: MIT
"""A buffer between two plates: a mass that falls on another through a spring and a dashpot, in closed form; what stands
on a spring; ends and combinations that are refused. Host theory, section 7.8."""
import math

import numpy as np

from checking import check, work
from host_program import ran, start
import tables  # noqa: E402 (checking knows its folder)

# 10 kg at 2 m/s meet 15 kg at rest, which float.
M1, M2, SPEED = 0.010, 0.015, 2.0
REDUCED = M1*M2/(M1 + M2)
STIFFNESS = 250.0
OMEGA = math.sqrt(STIFFNESS/REDUCED)
FALL = """&scene name = 'fall' geometry = 'plane_strain' fields = 'u' {scene} /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'e' young = 1e4 poisson = 0 /
&region material = 'e' void_ratio = 0 /
&plate name = 'mass' r = 0, 0.1 z = 3 mass = {m1} {mass} /
&plate name = 'plate' r = 0, 0.1 z = 2 mass = {m2} /
&buffer upper = 'mass' lower = 'plate' stiffness = {k} {buffer} /
&initial group = 'mass' v_z = {v} /
{stages}&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
"""
DROP = "&stage name = 'drop' analysis = 'dynamic' duration = {} dt = {} rho_inf = {} tolerance = 1e-9 /\n"


def fall(buffer="", scene="", mass="", k=STIFFNESS, v=-SPEED, duration=0.03, dt=2e-5, stages="", rho=1):
    return FALL.format(buffer=buffer, scene=scene, mass=mass, k=k, v=v, m1=M1, m2=M2,
                       stages=stages or DROP.format(duration, dt, rho))


def motion(name, text):
    if not ran(name, text):
        return None
    return tables.columns(work/name/"contact.csv"), tables.columns(work/name/"ledger.csv")


def test_a_mass_that_falls_on_a_spring_gives_a_half_sine():
    # The ends part after half a period of the reduced mass; the force is v sqrt(k m) sin(omega t); 1e-5 is the error of
    # (omega dt)^2/12 and of the step in which the ends part.
    found = motion("half_sine", fall())
    if not found:
        return
    rows, ledger = found
    t, force = rows["time"], M2*-rows["plate.a_z"]
    pulse = math.pi/OMEGA
    exact = np.where(t < pulse, SPEED*math.sqrt(STIFFNESS*REDUCED)*np.sin(OMEGA*t), 0)
    largest = exact.max()
    check("the force is a half sine", np.max(abs(force - exact)[1:]) < 5e-3*largest, np.max(abs(force - exact)))
    check("its peak", abs(force.max()/largest - 1) < 1e-4, (force.max(), largest))
    both = 2*M1*SPEED/(M1 + M2), (M1 - M2)*SPEED/(M1 + M2)
    check("the velocities of an elastic impact", abs(-rows["plate.v_z"][-1] - both[0]) < 1e-3*SPEED
          and abs(-rows["mass.v_z"][-1] - both[1]) < 1e-3*SPEED, (rows["plate.v_z"][-1], rows["mass.v_z"][-1]))
    check("energy is kept", np.max(abs(ledger["imbalance"])) < 1e-3*0.5*M1*SPEED**2, ledger["imbalance"].max())
    check("the spring gives its energy back", abs(rows["work"][-1]) < 1e-3*0.5*M1*SPEED**2, rows["work"][-1])
    check("and has it in between", abs(rows["work"].max()/(0.5*REDUCED*SPEED**2) - 1) < 1e-3, rows["work"].max())


def test_a_dashpot_takes_energy_and_the_ends_part_when_the_force_is_gone():
    # Damping ratio 0.2: x = v/w_d exp(-z w t) sin(w_d t), and the force k x + c x' from c v on; 0 where tan(w_d t) is
    # -2 z sqrt(1 - z^2)/(1 - 2 z^2). It jumps where the ends meet: rho_inf 0 does not ring.
    ratio = 0.2
    damping = 2*ratio*OMEGA*REDUCED
    found = motion("damped", fall(f"damping = {damping:.9f} clearance = 0.002", rho=0, dt=1e-5))
    if not found:
        return
    rows, _ = found
    damped = OMEGA*math.sqrt(1 - ratio**2)
    parts = (math.pi - math.atan(2*ratio*math.sqrt(1 - ratio**2)/(1 - 2*ratio**2)))/damped
    s = rows["time"] - 0.002/SPEED
    x = SPEED/damped*np.exp(-ratio*OMEGA*s)*np.sin(damped*s)
    v = SPEED*np.exp(-ratio*OMEGA*s)*(np.cos(damped*s) - ratio*OMEGA/damped*np.sin(damped*s))
    inside = (s > 1e-4) & (s < parts - 1e-4)
    force, exact = M2*-rows["plate.a_z"], STIFFNESS*x + damping*v
    check("the force of spring and dashpot", np.max(abs(force - exact)[inside]) < 0.01*exact[inside].max(),
          np.max(abs(force - exact)[inside]))
    check("it never pulls", force.min() > -1e-3*force.max(), force.min())
    check("nothing before the clearance is used up", np.all(abs(force[(s < -5e-5) & (s > -0.0009)]) < 1e-9), force[:9])
    check("momentum is kept", abs(M1*rows["mass.v_z"][-1] + M2*rows["plate.v_z"][-1] + M1*SPEED) < 1e-6*M1*SPEED)


def test_plates_that_are_joined_stay_together():
    # In tension as in compression: the distance is a sine of the reduced mass.
    found = motion("joined", fall("tension = 'yes'"))
    if found:
        rows, _ = found
        apart = rows["plate.u_z"] - rows["mass.u_z"]
        exact = SPEED/OMEGA*np.sin(OMEGA*rows["time"])
        check("the distance is a sine", np.max(abs(apart - exact)) < 0.01*np.max(exact), np.max(abs(apart - exact)))


def test_controlled_steps_see_the_impact():
    text = fall("clearance = 0.01", "step_tolerance = 1e-3", stages=(
        "&stage name = 'drop' analysis = 'dynamic' duration = 0.03 /\n"))
    found = motion("controlled", text)
    if found:
        rows, _ = found
        check("the velocity of an elastic impact", abs(-rows["plate.v_z"][-1] - 2*M1*SPEED/(M1 + M2)) < 0.01*SPEED,
              rows["plate.v_z"][-1])


def test_a_run_goes_on_from_a_checkpoint_within_the_impact():
    # 1500 steps, the impact is over after 770: the last checkpoint is that of step 700.
    text = fall().replace("fields = 'u'", "fields = 'u' checkpoint_steps = 700", 1).replace("duration = 0.03",
                                                                                          "duration = 0.026")
    if not ran("whole", text):
        return
    before = (work/"whole/contact.csv").read_bytes()
    if (work/"whole/checkpoint.h5").exists():   # built with HDF5
        again = start("whole", text, "--restart", work/"whole/checkpoint.h5")
        check("the restart runs", again.returncode == 0, again.stderr)
        check("it leaves the same table", (work/"whole/contact.csv").read_bytes() == before)


def test_a_static_stage_asks_for_a_support_of_the_upper_plate():
    text = fall(v=0, stages="&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 /\n").replace(
        "name = 'plate' r = 0, 0.1 z = 2", "name = 'plate' group = 'top'")
    done = start("rest", text)
    check("without one it is refused", done.returncode == 13 and "plate mass" in done.stderr, done.stderr)
    done = start("rest", text + "&fix group = 'mass' field = 'u_z' value = -0.001 /\n")
    check("with one it runs", done.returncode == 0, done.stderr)
    # 0.25 kN on the spring, of which the block of 1e4 kN/m gives way.
    moved = tables.columns(work/"rest/contact.csv")["plate.u_z"][-1]
    check("the spring presses", abs(moved/(-0.001*STIFFNESS/(STIFFNESS + 1e4)) - 1) < 1e-6, moved)


def test_what_a_buffer_cannot_lie_between_is_refused():
    for old, new, words in (("lower = 'plate'", "lower = 'mass'", "upper and lower are both 'mass'"),
                            ("lower = 'plate'", "lower = 'flat'", "lower = 'flat' is defined nowhere"),
                            ("upper = 'mass' ", "", "upper"), ("stiffness = 250.0", "stiffness = -1", "stiffness"),
                            ("stiffness = 250.0", "stiffness = 9 stages = 'no'", "'no'")):
        text = fall()
        check(f"the scene has {old}", old in text)
        done = start("refused", text.replace(old, new))
        check(f"{new or 'no ' + old} is refused", done.returncode in (2, 11) and words in done.stderr, done.stderr)
    # A plate that is joined to the block goes back to zero with it, a mass of its own does not.
    text = fall(stages="&stage name = 'rest' analysis = 'dynamic' duration = 1 dt = 1 zero_displacements = 'yes' /\n")
    joined = text.replace("name = 'plate' r = 0, 0.1 z = 2", "name = 'plate' group = 'top'")
    for what, told in ((text, 0), (joined, 1), (joined.replace("stiffness", "stages = 'other' stiffness"), 0)):
        done = start("zeroed", what + "&stage name = 'other' analysis = 'dynamic' duration = 1 dt = 1 /\n", "--check")
        check("displacements are zeroed", done.returncode == 2*told
              and done.stderr.count("change the force of the buffer") == told, done.stderr)


def test_a_spring_beyond_rounding_is_named_and_not_a_body_that_moves():
    # Beside 1e22 kN/m, of which the scheme takes half, masses and block are rounding: no solution, though all is held.
    done = start("beyond", fall(k="1e22", duration=2e-5, stages=DROP.format(2e-5, "2e-5 cuts = 1", 1)))
    check("the spring is named", done.returncode == 13 and "singular by rounding" in done.stderr
          and "5e21 at plate" in done.stderr and "can move" not in done.stderr, done.stderr)
