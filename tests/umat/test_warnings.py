# SPDX-License-Identifier: MIT
"""PROPS in mixed units and doubtful starts are told once a process: by umat_, MFront (OpenGeoSys), user_mod_, vumat_,
an entry of one's own, mud_init, mud_init_points, and by the updates that lead there."""
import ctypes
import os
import pathlib
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).parents[1] / "support"))
from checking import at_length, build, check, needs_plain_library, root

needs_plain_library()
INTS, DOUBLES, POINTER = ctypes.c_int, ctypes.c_double, ctypes.c_void_p


def host(door, p_atm, mean=-100.0, void_ratio=0.0, d_strain=-1e-6):
    """One small increment at two points of a material whose p_atm alone may be in Pa, or which is all in MPa."""
    mud = ctypes.CDLL(str(build / "umat/libmud.so"))
    n_props, n_state = mud.mud_count(1), mud.mud_count(2)
    props, strain = (DOUBLES*n_props)(), (DOUBLES*7)(d_strain)
    mud.mud_default_props(props, n_props)
    if p_atm < 1.0:
        assert mud.mud_convert_props(props, n_props, DOUBLES(0.001)) == 0
    props[mud.mud_index(1, b"p_atm")] = p_atm
    for _ in range(2):
        stress, state, other = (DOUBLES*20)(mean, mean, mean), (DOUBLES*n_state)(), (DOUBLES*20)()
        new = (DOUBLES*n_state)()
        state[mud.mud_index(2, b"void_ratio")] = void_ratio
        if door == "my_door":
            of_an_entry(mud, props, stress, state, strain, other, new)
        elif door.startswith("mud_"):
            of_c(mud, door, props, stress, void_ratio, state, strain)
        elif door == "umat_":
            factor = DOUBLES(1.0)
            rest = [None]*13
            counts = [ctypes.byref(INTS(x)) for x in (3, 3, 6, n_state)]
            mud.umat_(stress, state, *[None]*9, strain, *[None]*7, *counts, props, ctypes.byref(INTS(n_props)), None,
                      None, ctypes.byref(factor), *rest[:9])
            assert factor.value == 1.0
        elif door == "MFront":
            k, rdt, rest = (DOUBLES*49)(), DOUBLES(1.0), (DOUBLES*7)()
            address = [ctypes.addressof(a) for a in (rest, stress, props, state, strain, other, new)]

            class State(ctypes.Structure):
                _fields_ = [(name, POINTER) for name in
                            ("gradients", "forces", "density", "properties", "internal", "e", "d", "external")]

            class View(ctypes.Structure):
                _fields_ = [("message", POINTER), ("dt", DOUBLES), ("k", POINTER), ("rdt", POINTER), ("speed", POINTER),
                            ("s0", State), ("s1", State)]

            view = View(None, 1.0, ctypes.addressof(k), ctypes.addressof(rdt), None,
                        State(address[0], address[1], None, address[2], address[3]),
                        State(address[4], address[5], None, address[2], address[6]))
            assert mud.MUD_Tridimensional(ctypes.byref(view)) == 1
        elif door == "user_mod_":
            for task in (1, 2):
                numbers = [INTS(x) for x in (task, 1, 0, 1, 1, 1, 1)]
                zero, ends = DOUBLES(0.0), [INTS(0) for _ in range(6)]
                mud.user_mod_(*map(ctypes.byref, numbers), *[ctypes.byref(zero)]*5, props, stress, ctypes.byref(zero),
                              state, strain, other, ctypes.byref(zero), other, None, new, None,
                              *map(ctypes.byref, ends[:5]), None, None, ctypes.byref(ends[5]))
                assert ends[5].value == 0
        else:
            counts = [ctypes.byref(INTS(x)) for x in (1, 3, 3, n_state, 0, n_props, 0)]
            time = [ctypes.byref(DOUBLES(x)) for x in (1.0, 1.0, 1.0)]
            nothing = [None]*40
            arguments = [*counts, *time, *nothing[:3], props, *nothing[:1], strain, *nothing[:5], stress, state,
                         *nothing[:6], other, new, *nothing[:2]]
            mud.vumat_(*arguments)
            assert other[0] == other[0]   # no NaN


class Place(ctypes.Structure):
    """mud_place of mud.h."""
    _fields_ = [("entry", ctypes.c_char*24), *((name, POINTER) for name in ("step", "increment", "element", "point"))]


def of_an_entry(mud, props, stress, state, strain, other, new):
    """An entry of one's own, written on mud_increment_at: at element 8; then a strain that is too large."""
    material, place, element = (DOUBLES*mud.mud_prepared_size())(), Place(b"my_door"), INTS(8)
    place.element = ctypes.addressof(element)
    assert mud.mud_prepare(props, len(props), material, len(material), None, 0) == 0
    zero, report = DOUBLES(0.0), (INTS*64)()
    for size in (1, 4.0/strain[0]):
        larger = (DOUBLES*6)(*(size*x for x in strain[:6]))
        code = mud.mud_increment_at(ctypes.byref(place), material, stress, state, len(state), zero, larger, zero, 0,
                                    other, new, None, report)
        assert (code == 0) == (size == 1)
    if os.environ.get("REFUSE"):
        assert mud.mud_refuse(ctypes.byref(place), report, b". Nothing was computed", other, 6) == code
        assert (other[0] == other[0]) == (os.environ.get("MUD_NO_PNEWDT") == "keep")


def of_c(mud, door, props, stress, void_ratio, state, strain):
    """A start by mud.h, one point or an array of one, and an update of the same kind."""
    from mud import _native
    material = (DOUBLES*mud.mud_prepared_size())()
    assert mud.mud_prepare(props, len(props), material, len(material), None, 0) == 0
    number, suction = DOUBLES(void_ratio), DOUBLES(0.0)
    if door == "mud_init":
        assert mud.mud_init(material, stress, suction, number, DOUBLES(0.0), state, len(state), None, 0) == 0
        assert mud.mud_update(material, stress, state, len(state), strain, suction, 0, stress, state, None, None) == 0
        return
    points = _native.Points(n=1, nstatev=len(state))
    for name, array in {"stress0": stress, "stress1": stress, "statev0": state, "statev1": state, "dstrain": strain,
                        "void_ratio": number}.items():
        setattr(points, name, ctypes.addressof(array))
    assert mud.mud_init_points(material, 1, ctypes.byref(points), None) == 0
    assert mud.mud_update_points(material, 1, ctypes.byref(points), None) == 0


plain = {name: value for name, value in os.environ.items() if not name.startswith("MUD_")}


def told(*words, **more):
    """Lines on standard error of a process that is this host."""
    done = subprocess.run([sys.executable, __file__, *map(str, words)], capture_output=True, text=True,
                          env={**plain, "MUD_BUILD_DIR": str(build), "PYTHONPATH": str(root / "python"), **more})
    check(f"{words} ends well", done.returncode == 0, done.stdout + done.stderr)
    return done.stderr.splitlines()


DOORS = ("umat_", "MFront", "user_mod_", "vumat_", "my_door", "mud_init", "mud_init_points")


def test_warns_once_of_p_atm_in_pa_among_kpa():
    for door in DOORS[1:5]:
        lines = told(door, 101325)
        check(f"{door} warns once of p_atm in Pa among kPa", len(lines) == 1 and f"remark of {door} at" in lines[0] and
              "do all PROPS have the unit of stress of p_atm?" in lines[0], lines)
        check(f"{door} says nothing of p_atm in kPa", told(door, 101.325) == [])


@at_length
def test_a_doubtful_start_is_told_once_a_process_by_every_entry():
    # 1.5 kPa is tension of more than p_atm/100. 5.1e4 kPa is above 50 MPa. The default compression line is at
    # e = 25*3000**-0.37 = 1.29 for 3000 kPa, and at 1.67 for half of that.
    for given, words in (((1.5, 0.8), ("mean effective stress of the start is 1.5", "tension: tension is positive here",
                                       "with the sign minus, as -1.5")),
                         ((-5.1e4, 0.2), ("of the start is -51000", "more than 50 MPa", "the unit of p_atm")),
                         ((-3000.0, 1.7), ("void ratio of the start is 1.7", "compression line, which is at 1.29",
                                           "bears less than half of a mean effective stress of 3000")),
                         ((-100.0, 3.1), ("void ratio of the start is 3.1", "shear modulus", "2.97"))):
        for door in DOORS:
            lines = told(door, 101.325, *given)
            check(f"{door} tells of {given}", len(lines) == 1 and f"MUD: remark of {door} at " in lines[0] and
                  all(word in lines[0] for word in words), lines)
    for given in ((0.9, 0.8), (-4.9e4, 0.2), (-3000.0, 1.6), (-10.0, 2.9)):
        for door in DOORS:
            check(f"{door} says nothing of {given}", told(door, 101.325, *given) == [])


def test_python_tells_a_doubtful_start_and_refuses_tension_in_the_same_words():
    script = "import sys, numpy as np, mud; sand = mud.Material(); begin = getattr(sand, sys.argv[1]); " \
             "mean = float(sys.argv[2]); one = [mean]*3 + [0.0]*3; " \
             "begin(np.array([one]*3 if 'batch' in sys.argv[1] else one), void_ratio=%s)"
    tension = "the mean effective stress of the start is 40, tension: tension is positive here"
    for name, mean, e, words, ends in (("initial_state", -80, "3.2", "void ratio of the start is 3.2", True),
                                       ("init_batch", -80, "np.full(3, 3.2)", "void ratio of the start is 3.2", True),
                                       ("init_batch", 40, "None", "mud_init_points at point 0: " + tension, True),
                                       ("initial_state", 40, "None", "InputError: " + tension, False)):
        done = subprocess.run([sys.executable, "-c", script % e, name, str(mean)], capture_output=True, text=True,
                              env={**plain, "MUD_LIBRARY_DIR": str(build), "PYTHONPATH": str(root / "python")})
        check(f"{name} at {mean} with void ratio {e}", (done.returncode == 0) == ends and words in done.stderr and
              done.stderr.count("remark of") == 1, done.stderr)


def test_the_limits_of_a_start_follow_the_unit_of_stress():
    # In MPa 51 is as 51000 in kPa.
    for mean, number in ((-51.0, 1), (-49.0, 0)):
        lines = told("mud_init", 0.101325, mean, 0.2)
        check(f"{mean} MPa is told {number} times", sum("more than 50 MPa" in line for line in lines) == number, lines)


def test_an_update_that_loosens_soil_beyond_the_models_range_is_told():
    # Expansion by 0.3 % from e 2.96 ends at 3.96*exp(0.003) - 1 = 2.972.
    for door, by in (("umat_", "umat_"), ("vumat_", "vumat_"), ("user_mod_", "user_mod_"), ("MFront", "MFront"),
                     ("my_door", "my_door"),
                     ("mud_init", "mud_update"), ("mud_init_points", "mud_update_points")):
        lines = told(door, 101.325, -4000.0, 2.96, 3e-3)
        check(f"{by} tells that the void ratio is beyond", any(
            f"remark of {by} at" in line and "void ratio has come to 2.97" in line for line in lines), lines)


def test_an_entry_of_ones_own_is_heard_once_with_its_place_and_stops_its_host():
    lines = told("my_door", 101.325, REFUSE="yes")
    check("the refusal is said once, of two", len(lines) == 2 and lines[0].startswith(
        "MUD: my_door refused the increment at element 8, status 6: strain increment 11 is 4") and
        ". Nothing was computed. Its stress is NaN" in lines[0], lines)
    check("the process counts both at its end", "set to NaN: 2." in lines[1], lines)
    lines = told("my_door", 101.325, REFUSE="yes", MUD_NO_PNEWDT="keep")
    check("keep leaves the stress, and says so", len(lines) == 1 and "The old stress is kept" in lines[0], lines)
    check("without mud_refuse nothing is said", told("my_door", 101.325) == [])


if __name__ == '__main__':
    host(sys.argv[1], *map(float, sys.argv[2:]))
