# SPDX-License-Identifier: MIT
"""A term of one file and one line of the registry runs in a scene of the host: springs to ground under a plate."""
import subprocess

from checking import build, check, work
from host_program import ENVIRONMENT
import tables  # noqa: E402 (checking knows its folder)

HOST = build / "tests/planted/mud_host"
YOUNG, POISSON, FORCE, STIFFNESS, WIDTH, HEIGHT = 1e4, 0.25, -30.0, 2e3, 0.5, 2.0
MODULUS = YOUNG*(1 - POISSON)/((1 + POISSON)*(1 - 2*POISSON))   # no strain along r
COLUMN = MODULUS*WIDTH/HEIGHT   # kN over m, of a slice of 1 m
TOP_NODES = 3   # of the one cell under the plate, whose nodes move as one
MASS = 4.0
#: A plate on an elastic column: one unknown.
SCENE = f"""&scene name = 'column' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, {WIDTH} r_cells = 1 z = 0, {HEIGHT} z_cells = 2 /
&elastic name = 'soil' young = {YOUNG} poisson = {POISSON} /
&region material = 'soil' rho_s = 1e-5 void_ratio = 0 /
&plate name = 'plate' group = 'top' mass = {MASS} force = {FORCE} /
&spring group = 'top' stiffness = {STIFFNESS} /
&stage name = 'press' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-10 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&point name = 'top' r = 0 z = {HEIGHT} /
"""


def run(name, text, *words):
    file = work / f"{name}.nml"
    file.write_text(text)
    return subprocess.run([HOST, file, "--output", work / name, "--quiet", *words], capture_output=True, text=True,
                          env=ENVIRONMENT)


def settlement(name, text):
    done = run(name, text)
    check(f"{name}: it runs", done.returncode == 0, done.stderr)
    return tables.numbers(work / name / "histories.csv")[-1]["top.u_z"] if done.returncode == 0 else None


def test_springs_carry_their_share_of_a_load():
    # The plate's one unknown has the stiffness of the column and of a spring at each of its three nodes.
    u = settlement("with", SCENE)
    wanted = FORCE/(COLUMN + TOP_NODES*STIFFNESS)
    check("the plate settles by the closed form", abs(u/wanted - 1) < 1e-9, (u, wanted))
    last = tables.numbers(work / "with/ledger.csv")[-1]
    stored = 0.5*(COLUMN + TOP_NODES*STIFFNESS)*wanted**2
    check("the ledger knows what they store", abs(last["skeleton"]/stored - 1) < 1e-9, (last["skeleton"], stored))
    # In a stage that its key does not name nothing holds the plate but the column.
    first = "&stage name = 'first' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-10 /\n"
    u = settlement("only", SCENE.replace("&stage", first + "&stage").replace("&spring", "&spring stages = 'first'"))
    check("without them the column carries it", abs(u/(FORCE/COLUMN) - 1) < 1e-9, u)


def test_a_plate_on_springs_vibrates_with_their_stiffness():
    # A column of hardly any mass: the plate swings about its rest by a cosine, at rest again after a period.
    period = 6.283185307179586*(MASS/(COLUMN + TOP_NODES*STIFFNESS))**0.5
    text = SCENE.replace("analysis = 'static' duration = 1 dt = 1",
                         f"analysis = 'dynamic' duration = {period} dt = {period/400} rho_inf = 1 created_energy = 1")
    done = run("swing", text)
    check("the plate swings", done.returncode == 0, done.stderr)
    rows = tables.numbers(work / "swing/histories.csv") if done.returncode == 0 else [{"top.u_z": 0}]*2
    rest = FORCE/(COLUMN + TOP_NODES*STIFFNESS)
    # Steps of a 400th of the period shorten it by (2 pi/400)**2/12.
    check("half a period after its start it is twice as far as at rest",
          abs(min(row["top.u_z"] for row in rows)/(2*rest) - 1) < 1e-3, rest)
    check("and a period after it is back", abs(rows[-1]["top.u_z"]/rest) < 1e-3, rows[-1]["top.u_z"])


def test_its_keys_are_keys_of_the_scene():
    template = subprocess.run([HOST, "--template"], capture_output=True, text=True, env=ENVIRONMENT).stdout
    check("the template has them", "&spring" in template and "stiffness" in template, template[-500:])
    done = run("wrong", SCENE.replace("stiffness", "stifness"))
    check("a misspelt one is told the nearest", done.returncode == 2 and "stiffness" in done.stderr, done.stderr)
    done = run("nowhere", SCENE.replace("&spring group = 'top'", "&spring group = 'roof'"))
    check("a group that the mesh lacks is refused", done.returncode == 11 and "'roof'" in done.stderr, done.stderr)
    done = run("never", SCENE.replace("&spring group", "&spring stages = 'later' group"))
    check("and a stage", done.returncode == 11 and "there is no stage 'later'" in done.stderr, done.stderr)
