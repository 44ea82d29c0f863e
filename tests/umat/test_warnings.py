# SPDX-License-Identifier: MIT
"""PROPS in mixed units are warned of by the entries that are no UMAT: MFront (OpenGeoSys), user_mod_, vumat_."""
import ctypes
import os
import pathlib
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).parents[1] / "support"))
from checking import build, check, needs_plain_library

needs_plain_library()
INTS, DOUBLES, POINTER = ctypes.c_int, ctypes.c_double, ctypes.c_void_p


def host(door, p_atm):
    """One small increment at two points of a material whose p_atm alone may be in Pa."""
    mud = ctypes.CDLL(str(build / "umat/libmud.so"))
    n_props, n_state = mud.mud_count(1), mud.mud_count(2)
    props, strain = (DOUBLES*n_props)(), (DOUBLES*7)(-1e-6)
    mud.mud_default_props(props, n_props)
    props[mud.mud_index(1, b"p_atm")] = p_atm
    for _ in range(2):
        stress, state, other = (DOUBLES*20)(-100, -100, -100), (DOUBLES*n_state)(), (DOUBLES*20)()
        new = (DOUBLES*n_state)()
        if door == "MFront":
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
            assert other[0] < -99.0   # no NaN


def test_warns_once_of_p_atm_in_pa_among_kpa():
    plain = {name: value for name, value in os.environ.items() if not name.startswith("MUD_")}

    for door in ("MFront", "user_mod_", "vumat_"):
        done = subprocess.run([sys.executable, __file__, door, "101325"], capture_output=True, text=True, env={
            **plain, "MUD_BUILD_DIR": str(build)})
        check(f"{door} warns once of p_atm in Pa among kPa", done.returncode == 0 and done.stderr.count("\n") == 1 and
              f"remark of {door} at" in done.stderr and "do all PROPS have the unit of stress of p_atm?" in done.stderr,
              done.stdout + done.stderr)
        done = subprocess.run([sys.executable, __file__, door, "101.325"], capture_output=True, text=True, env={
            **plain, "MUD_BUILD_DIR": str(build)})
        check(f"{door} says nothing of p_atm in kPa", done.returncode ==
              0 and done.stderr == "", done.stdout + done.stderr)


if __name__ == '__main__':
    host(sys.argv[1], float(sys.argv[2]))
