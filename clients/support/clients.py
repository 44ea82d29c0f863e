# SPDX-License-Identifier: MIT
"""What the checks of all foreign programs share: the library, the expected answers, installation, comparison."""
import csv
import ctypes
import json
import os
import pathlib
import shutil
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parents[2]
build = pathlib.Path(os.environ.get("MUD_BUILD_DIR", root / "build/release"))
home = pathlib.Path(os.environ.get("MUD_CLIENTS_DIR", root / "build/clients"))  # programs and results of the checks
library_file = build / "umat/libmud.so"
# Environment in which a Python imports the package of the tree.
python_package = {"PYTHONPATH": str(root / "python"), "MUD_LIBRARY_DIR": str(build)}
COMPONENTS = ("11", "22", "33", "12", "13", "23")
SKIPPED = 77
DIGITS = 1e-9  # relative: prescribed strain passes through matrix products of the host, ten digits and more survive
MUD_PROPS, MUD_STATEV = 1, 2
counted = {"passed": 0, "failed": 0}


def commit():
    """What git calls the present tree."""
    done = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=root, capture_output=True, text=True)
    return done.stdout.strip() or "a tree without git"


def mud():
    library = ctypes.CDLL(str(library_file))
    library.mud_index.argtypes = [ctypes.c_int, ctypes.c_char_p]
    library.mud_default_props.argtypes = [ctypes.POINTER(ctypes.c_double), ctypes.c_int]
    return library


def props(**changes):
    """PROPS in their order up to the last that every interface takes (without hysteresis): the defaults of the library of
    the day, but for the changes."""
    library = mud()
    values = (ctypes.c_double*library.mud_count(MUD_PROPS))()
    if library.mud_default_props(values, len(values)) != 0:
        sys.exit("mud_default_props failed")
    for name, value in changes.items():
        index = library.mud_index(MUD_PROPS, name.encode())
        if index < 0:
            sys.exit(f"PROPS have no entry {name}")
        values[index] = value
    return values[:library.mud_index(MUD_PROPS, b"hysteresis")]


def statev(**presets):
    """Zeros, which the first update initialises, but for the presets (void_ratio, suction); as many as a point without
    hysteresis needs."""
    library = mud()
    values = [0.0]*library.mud_prepared_statev(prepare(props()))
    for name, value in presets.items():
        index = library.mud_index(MUD_STATEV, name.encode())
        if index < 0:
            sys.exit(f"STATEV have no entry {name}")
        values[index] = value
    return values


def describe(host):
    """What mud_describe prints for a host: the default material as that program reads it."""
    command = [build / "drivers/mud_describe", host]
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=60).stdout


def prepare(values):
    """A prepared material of PROPS."""
    library = mud()
    prepared = (ctypes.c_double*library.mud_prepared_size())()
    array = (ctypes.c_double*len(values))(*values)
    if library.mud_prepare(array, len(array), prepared, len(prepared), None, 0) != 0:
        sys.exit("mud_prepare failed")
    return prepared


def saturation(suction, void_ratio):
    """Degree of saturation of the default material."""
    library, prepared = mud(), prepare(props())
    library.mud_saturation.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_double] + [ctypes.c_void_p]*3
    answer = ctypes.c_double()
    if library.mud_saturation(prepared, suction, void_ratio, ctypes.byref(answer), None, None) != 0:
        sys.exit("mud_saturation failed")
    return answer.value


def expected(case, stages=(), **numbers):
    """Columns of a case of clients/cases, by the mud_triax of the day: a row for every increment. numbers: for the
    words that stand between @ in the case; stages: end and increment of axial strain of drained ones, for @stages@."""
    folder = work_folder("expected")
    out, program = folder / f"{case}.csv", build / "drivers/mud_triax"
    text = (root / f"clients/cases/{case}.nml").read_text().replace("../../drivers", str(root / "drivers"))
    for name, value in numbers.items():
        text = text.replace(f"@{name}@", repr(value))
    text = text.replace("@stages@", "".join(
        f"&stage\n   control = 'drained'\n   eps_a_end = {end!r}\n   increment = {increment!r}\n/\n"
        for end, increment in stages))
    file = folder / f"{case}.nml"
    file.write_text(text)
    subprocess.run([program, file, "--output", out, "--quiet"], check=True, timeout=60)
    lines = [line for line in out.read_text().splitlines() if line[0] != "#"]
    rows = list(csv.reader(lines))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def strains(table):
    """Strains of every row, tension positive, 11, 22, 33, 12, 13, 23, shear as engineering strain."""
    names = [("eps_" if a[0] == a[1] else "gamma_") + a for a in COMPONENTS]
    return [[-x for x in row] for row in zip(*(table[name] for name in names))]


def stresses(table):
    """Effective stresses of every row, tension positive, components as the strains."""
    return [[-x for x in row] for row in zip(*(table["sig_" + a] for a in COMPONENTS))]


def triaxial(name):
    """The triaxial test of clients/NAME/triaxial.py, in an own environment, against mud_triax: axial and radial stress."""
    here, table, folder = root / "clients" / name, expected("triaxial"), work_folder(name)
    python = venv(name, (here / "requirements.txt").read_text().split())
    (folder / "strains.json").write_text(json.dumps(table["eps_a"][1:]))
    (folder / "stresses.json").unlink(missing_ok=True)
    code = run([python, here / "triaxial.py", "strains.json", "stresses.json"], folder / "log", cwd=folder, timeout=1800,
               env={**os.environ, **python_package, "OMP_NUM_THREADS": "1"})
    rows = json.loads((folder / "stresses.json").read_text()) if code == 0 else []
    wanted = [[-a, -r] for a, r in zip(table["sigma_a"], table["sigma_r"])][1:]
    compare("triaxial, drained, unloaded and reloaded", [row[:2] for row in rows], wanted)


# A column of ground with weight [m, kN/m3, -, kPa]: what ground.py of a client is given.
GROUND = {"height": 4.0, "weight": 9.81*2.65/1.8, "k_0": 0.5, "surcharge": 10.0, "added": 40.0, "steps": 20}


def ground(told):
    """What ground.py of a client told of its column (None: it failed): nothing happens in the first step, and the
    horizontal stress of a point then follows the vertical one as in mud_triax from the same K_0 stress."""
    if told is None:
        verdict(False, "ground under K_0 stress", "the program failed")
        return
    first, last = told["first"], told["last"]
    verdict(first["iterations"] == 1 and first["moved"] <= 1e-8, "ground under K_0 stress rests in one iteration",
            f"{first['iterations']} iterations, displacement {first['moved']:.1e} m")
    (horizontal, vertical), (end, above) = first["stress"], last["stress"]
    table = expected("ground", sigma_a=-vertical, sigma_r=-horizontal, sigma_a_end=-above)
    compare("and its horizontal stress follows the surcharge as in mud_triax", [[end]], [[-table["sigma_r"][-1]]], 2e-4)


def start(name):
    """clients/NAME/ground.py in an own environment."""
    here, folder = root / "clients" / name, work_folder(name)
    (folder / "ground.json").write_text(json.dumps(GROUND))
    (folder / "rested.json").unlink(missing_ok=True)
    python = venv(name, (here / "requirements.txt").read_text().split())
    code = run([python, here / "ground.py", "ground.json", "rested.json"], folder / "ground.log", cwd=folder,
               timeout=600, env={**os.environ, **python_package, "OMP_NUM_THREADS": "1"})
    ground(json.loads((folder / "rested.json").read_text()) if code == 0 else None)


def work_folder(name):
    folder = home / "work" / name
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def compare(what, got, wanted, relative=DIGITS, places=None):
    """Rows of numbers against rows of numbers: the largest difference over the largest number wanted."""
    got, wanted = [list(row) for row in got], [list(row) for row in wanted]
    if places is not None:
        wanted = [[row[i] for i in places] for row in wanted]
    if len(got) != len(wanted) or any(len(a) != len(b) for a, b in zip(got, wanted)):
        return verdict(False, what, f"{len(got)} rows came, {len(wanted)} were expected")
    scale = max(abs(x) for row in wanted for x in row)
    # A NaN fails: it is not less than anything.
    differences = [abs(a - b) for x, y in zip(got, wanted) for a, b in zip(x, y)]
    largest = max(differences) if all(d == d for d in differences) else float("nan")
    verdict(largest <= relative*scale, what,
            f"{len(got)} rows, largest difference {largest:.1e} of {scale:.6g}, allowed {relative*scale:.1e}")


def verdict(good, what, told=""):
    counted["passed" if good else "failed"] += 1
    print(f"{'ok    ' if good else 'FAILED'} {what}: {told}", flush=True)


def finish():
    print(f"{counted['passed']} passed, {counted['failed']} failed", flush=True)
    sys.exit(1 if counted["failed"] or not counted["passed"] else 0)


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def run(command, log, **more):
    """Runs a program into a log; a failure shows its end."""
    with open(log, "w") as out:
        code = subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                              **more).returncode
    if code != 0:
        print(f"exit code {code} of {' '.join(map(str, command))}; the log ends:")
        print("\n".join(pathlib.Path(log).read_text(errors="replace").splitlines()[-15:]))
    return code


def venv(name, packages):
    """Python of an own environment with packages from the index of Python packages."""
    folder = home / name
    python = folder / "bin/python3"
    stamp = folder / "packages"
    wanted = " ".join(packages)
    if not (stamp.exists() and stamp.read_text() == wanted):
        if may_not_install():
            skip(f"{wanted} not installed")
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", *packages], check=True)
        stamp.write_text(wanted)
    return python


def debian(packages):
    """Makes sure that Debian packages are there; without the right to install them it says what to type."""
    def there(package):
        told = subprocess.run(["dpkg-query", "-W", "-f", "${Status}", package], capture_output=True, text=True).stdout
        return told.endswith("ok installed")

    if not shutil.which("dpkg-query"):
        skip("needs a Debian system")
    missing = [p for p in packages if not there(p)]
    if not missing:
        return
    command = ["apt-get", "install", "-y", "--no-install-recommends", *missing]
    if may_not_install() or os.geteuid() != 0:
        skip(f"missing; type: {' '.join(command)}")
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def may_not_install():
    return os.environ.get("MUD_CLIENTS_INSTALL") == "no"
