# SPDX-License-Identifier: MIT
"""What CHANGELOG.md says of older files is true: they are refused by a message that says why, for every row of its
tables that promises so."""
import ctypes
import os
import re
import subprocess
import sys

from checking import build, check, needs_plain_library, root, work

needs_plain_library()
os.environ["MUD_LIBRARY_DIR"] = str(build)
sys.path.insert(0, str(root / "python"))
import numpy as np  # noqa: E402
import mud  # noqa: E402

PROMISE = re.compile(r"\berror\b|refuse[sd]|\bis -1\b")
START = np.array([-100.0]*3 + [0.0]*3)   # stress [kPa], tension positive
SCENE = """&scene name = 'old' fields = 'u-p_w-p_c' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&stage name = 'a' analysis = 'static' duration = 1 dt = 1 /
&fix group = 'left' field = 'u_r' /
&permeability name = 'k' intrinsic = 1e-12 /
"""
ELASTIC = """&elastic name = 's' young = 1e4 poisson = 0.3 /
&region material = 's' permeability = 'k' void_ratio = 0.8 /
"""
RETENTION = "&retention name = 'r' law = 'power' a = 0.002 b = 1 /\n"
MUD = "&mud name = 's' {} /\n&region material = 's' permeability = 'k' void_ratio = 0.8 {} /\n"


def said(program, name, text, *words):
    (work / name).write_text(text)
    done = subprocess.run([build / program, work / name, *words], capture_output=True, text=True, cwd=work)
    return f"exit code {done.returncode}: {done.stderr}"


def scene(text):
    return said("host/mud_host", "old.nml", SCENE + text, "--check")


def keyed(key):
    return said("host/mud_host", "old.nml", SCENE.replace("name = 'old'", f"name = 'old' {key}") + ELASTIC, "--check")


def case(material):
    return said("drivers/mud_triax", "case.nml", f"&material {material} /\n&initial p_eff = 100 void_ratio = 0.8 /\n"
                "&stage control = 'drained' eps_a_end = 0.01 increment = 1e-3 output_interval = 1e-3 /\n", "--quiet")


def refusal(action):
    """The message of the exception; empty if there is none."""
    try:
        action()
    except mud.MudError as error:
        return str(error)
    return ""


def old_layout():
    sand = mud.Material("toyoura")
    stress, statev = sand.initial_state(START)
    statev[0] = 1
    return refusal(lambda: sand.update(stress, statev, np.array([-1e-4]*3 + [0.0]*3)))


def short_props():
    """mud_validate_props of 45 entries: its code and its sentence."""
    library = ctypes.CDLL(str(build / "umat/libmud.so"))
    text = ctypes.create_string_buffer(600)
    code = library.mud_validate_props((ctypes.c_double * 45)(), 45, text, len(text))
    return f"{code}: {text.value.decode()}"


def short_state():
    """mud_init with hysteresis and the numbers that are enough without it."""
    sand = mud.Material("hostun_hysteresis")
    library, text = ctypes.CDLL(str(build / "umat/libmud.so")), ctypes.create_string_buffer(600)
    stress, statev = (ctypes.c_double * 6)(*START), (ctypes.c_double * 200)()
    pointer, number, count = ctypes.c_void_p, ctypes.c_double, ctypes.c_int
    library.mud_init.argtypes = [pointer, pointer, number, number, number, pointer, count, pointer, count]
    code = library.mud_init(sand._address, stress, 1.0, 0.8, 0.0, statev, PLAIN, text, len(text))
    return f"{code}: {text.value.decode()}"


LAYOUT = re.search(r"STATE_LAYOUT = (\d+)", (root / "umat/core/base/mud_registry.f90").read_text(encoding="utf-8"))[1]
# Numbers of STATEV without hysteresis and with it; entries of PROPS without it.
PLAIN, WITH_HYSTERESIS = mud.states["turns"].index, mud.states["contraction"].index
FEWEST = mud.parameters["hysteresis"].index
# Tried where checkpoints are made.
ELSEWHERE = {"checkpoints of format 4": "tests/host/test_host_output.py"}

text = (root / "CHANGELOG.md").read_text(encoding="utf-8")
rows = [[cell.strip() for cell in line.split(" | ")] for line in text.splitlines() if line.startswith("| ")]
promised = [row[0].lstrip("| ") for row in rows if len(row) > 2 and PROMISE.search(row[2])]


def test_changelog_md_has_rows_that_promise_a_refusal():
    # What the first column of a row says: what the programs say of it today, and what has to be in that.
    CASES = {
        "STATEV layout 1": (old_layout, ["layout", LAYOUT]),
        "`memory_rule` 4 `as_published`": (lambda: case("memory_rule = 4"), ["memory_rule", "from 0 to 3"]),
        "with `hysteresis` = 1 S_w forgot where suction had turned":
            (short_state, ["-2", str(PLAIN), str(WITH_HYSTERESIS)]),
        "`mesh = 'auto'`, `budget`": (lambda: keyed("mesh = 'auto'") + keyed("budget = 9"),
                                      ["mesh is no key", "budget is no key", "mud_study accuracy"]),
        "`effects = 'auto'`, `effects_*`": (lambda: keyed("effects = 'auto'") + keyed("effects_tolerance = 0.1"),
                                            ["effects is no key", "effects_tolerance is no key", "mud_study effects"]),
        "PROPS 45 entries": (short_props, ["-1", "45", str(FEWEST)]),
        "a `&retention` of its own": (lambda: scene(MUD.format("", "retention = 'r'") + RETENTION),
                                      ["retention = 'material'"]),
    }

    check("CHANGELOG.md has rows that promise a refusal", len(promised) >= 3, promised)
    covered = {one for one in promised if any(one.startswith(name) for name in [*CASES, *ELSEWHERE])}
    check("every promise is tried", covered == set(promised), set(promised) - covered)
    for name, (say, words) in CASES.items():
        message = say()
        check(f"{name}: the refusal names what is valid today", all(word in message for word in words), message)
