# SPDX-License-Identifier: MIT
"""Effects that the key `without` takes out: the scene that results is the one that a user would have written, byte for
byte."""
import os
import re
import subprocess

from checking import brief, build, check, light, root, work

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}


def start(text, name, *more):
    scene = work / f"{name}.nml"
    scene.write_text(text.replace("{materials}", str(root / "drivers/materials")))
    return subprocess.run([host, scene, "--output", work / name, *more], capture_output=True, text=True,
                          env=environment)


def run(text, name, *more):
    done = start(text, name, *more)
    check(f"{name} runs", done.returncode == 0, done.stderr)
    return (work / name / "histories.csv").read_bytes()


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

COLUMN = """&scene name = 'column' fields = 'u' {keys} /
&mesh r = 0, 0.2 r_cells = 1 z = 0, 1 z_cells = 5 /
&elastic name = 'soil' young = 1e4 poisson = 0.25 /
&region material = 'soil' void_ratio = 0.8 /
&history name = 'h' times = 0, 0.5, 1 values = 0, 1, 1 /
&stage name = 'load' analysis = 'quasi_static' duration = 1 dt = 0.05 rho_inf = 0 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 12 history = 'h' /
&point name = 'top' r = 0 z = 1 /
"""


def test_each_word_of_without_is_its_key():
    whole = run(WHOLE, "whole")
    for word in list(KEYS)[:2 if brief else 6 if light else None]:
        by_key = WHOLE
        for old, new in KEYS[word]:
            check(f"{word}: '{old}' is in the scene", old in by_key)
            by_key = by_key.replace(old, new)
        without = run(WHOLE.replace("gravity = 9.81", f"without = '{word}' gravity = 9.81"), "by_word")
        check(f"without {word}: as by its key, byte for byte", without == run(by_key, "by_key"))
        check(f"without {word}: another answer", without != whole)
    said = start(WHOLE.replace("gravity = 9.81", "without = 'wind' gravity = 9.81"), "words").stderr
    words = max(re.findall(r"[\w|]+", said), key=len).split("|")
    check("the words of without are these effects", set(words) == {*KEYS, "seepage_face"}, said)
    face = run(FACE, "face")
    without = run(FACE.replace("gravity = 10", "without = 'seepage_face' gravity = 10"), "by_word")
    check("without seepage_face: as by its keys, byte for byte",
          without == run(FACE.replace("kind = 'seepage'", "kind = 'value'").replace("'rain'", "'water'"), "by_key"))
    check("without seepage_face: another answer", without != face)


def test_what_cannot_be_without_is_refused_with_the_reason():
    heavy = COLUMN.format(keys="without = 'gravity' gravity = 9.81") + "&initial stress = 'geostatic' surface = 1 /\n"
    done = start(heavy, "weightless")
    check("without gravity, but geostatic",
          done.returncode == 2 and "gravity" in done.stderr and "geostatic" in done.stderr, done.stderr)
    wet = COLUMN.format(keys="without = 'gravity' gravity = 9.81").replace("'u'", "'u-p_w'").replace(
        "void_ratio = 0.8", "void_ratio = 0.8 permeability = 'k'") + "&permeability name = 'k' intrinsic = 1e-10 /\n"
    check("without gravity", start(wet, "dry", "--check").returncode == 0)
    done = start(wet + "&initial water_table = 0 /\n", "table", "--check")
    check("without gravity, but the pressures of a water table",
          done.returncode == 2 and "a water table" in done.stderr, done.stderr)
    both = WHOLE.replace("gravity = 9.81", "without = 'p_c' gravity = 9.81").replace(
        "group = 'top' field = 'p_w' value = -30", "group = 'top' field = 'p_a' value = 0")
    done = start(both, "air")
    check("without p_c, where p_a and p_c prescribe p_w",
          done.returncode == 2 and "prescribe p_w: give p_w and one of these" in done.stderr, done.stderr)
    done = start(COLUMN.format(keys="without = 'friction'"), "none", "--check")
    check("what the scene does not have is told", done.returncode == 0 and
          "without = 'friction' of &scene has no effect" in done.stderr, done.stderr)
