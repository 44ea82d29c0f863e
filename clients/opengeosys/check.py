# SPDX-License-Identifier: MIT
"""OpenGeoSys through the generic interface of MFront: mechanics, and the unsaturated process with a wetting."""
import csv
import ctypes
import pathlib
import re
import subprocess
import xml.etree.ElementTree

import cases
import clients
import project
import references

PACKAGES = ["ogs==6.5.9"]
# VTK writes a number with 11 digits at least.
DIGITS = 1e-9
WRITTEN = (0, 1, 2, 3, 5, 4)  # files of OpenGeoSys: xx, yy, zz, xy, yz, xz
HEIGHT, VOID_RATIO, STRESS, SUCTION = 1.0, 0.8, 100.0, 30.0  # [m, -, kPa]; of column.nml
PERMEABILITY, END = 1.0e-13, 2.0e5  # [m2, s]
here = pathlib.Path(__file__).parent
python = clients.venv("ogs", PACKAGES)


def named_props():
    library = clients.mud()
    names = (ctypes.c_char_p*library.mud_count(clients.MUD_PROPS)).in_dll(library, "mud_props_names")
    return {name.decode(): value for name, value in zip(names, clients.props())}


def field(path, name):
    """All numbers of a field."""
    for array in xml.etree.ElementTree.parse(path).iter("DataArray"):
        if array.get("Name") == name:
            return [float(x) for x in array.text.split()]


def fields(path, *names):
    """Values of a field at the first node."""
    rows = []
    for array in xml.etree.ElementTree.parse(path).iter("DataArray"):
        if array.get("Name") in names:
            width = int(array.get("NumberOfComponents", 1))
            rows.append((array.get("Name"), [float(x) for x in array.text.split()[:width]]))
    return [dict(rows)[name] for name in names]


def column(cells, steps):
    """Suction and settlement of the top of a column that is wetted from below, at every tenth of the time."""
    folder = clients.work_folder(f"opengeosys/column_{cells}_{steps}")
    project.write_column(folder, cells, HEIGHT)
    text = project.column(clients.library_file, named_props(), VOID_RATIO, -STRESS, start_saturation()*SUCTION, SUCTION,
                          PERMEABILITY, END, steps)
    (folder / "column.prj").write_text(text)
    if clients.run([python.parent / "ogs", "column.prj"], folder / "log.txt", cwd=folder, timeout=900) != 0:
        return []
    rows = []
    for i in range(1, 11):
        file = folder / f"r_{i*steps//10}.vtu"
        rows.append([-field(file, "pressure")[-1], field(file, "displacement")[-1]])
    return rows


def host_column(cells, steps):
    """The same by mud_host."""
    folder = clients.work_folder(f"opengeosys/host_{cells}_{steps}")
    scene = (here / "column.nml").read_text()
    for name, value in (("CELLS", cells), ("STEP", END/steps), ("NET", STRESS - start_saturation()*SUCTION)):
        scene = scene.replace(f"@{name}@", repr(value))
    (folder / "column.nml").write_text(scene)
    command = [clients.build / "host/mud_host", "column.nml", "--output", "out", "--quiet"]
    if clients.run(command, folder / "log.txt", cwd=folder, timeout=900) != 0:
        return []
    with open(folder / "out/histories.csv") as file:
        table = list(csv.DictReader(file))[1:]
    return [[float(table[i*steps//10 - 1][name]) for name in ("top.p_c", "top.u_z")] for i in range(1, 11)]


def start_saturation():
    return clients.saturation(SUCTION, VOID_RATIO)


def run(name, strains, presets, stress, names, suction=None, saturation=1.0):
    folder = clients.work_folder(f"opengeosys/{name}")
    project.write_cube(folder)
    text = project.project(clients.library_file, named_props(), presets, strains, stress, suction, saturation)
    (folder / "cube.prj").write_text(text)
    for old in folder.glob("r_*.vtu"):
        old.unlink()
    if clients.run([python.parent / "ogs", "cube.prj"], folder / "log.txt", cwd=folder, timeout=600) != 0:
        return [[]]*len(names)
    found = [fields(folder / f"r_{i}.vtu", *names) for i in range(1, len(strains))]
    return [list(rows) for rows in zip(*found)]


for host in ("ogs", "ogs-unsaturated"):
    told = clients.describe(host)
    missing = [name for name in named_props() if f'name="{name}"' not in told]
    clients.verdict(not missing and "<material_properties>" in told, f"mud_describe {host} names every parameter",
                    f"missing: {missing}")
table = clients.expected("shear")
rows, = run("shear", clients.strains(table), {"void_ratio": table["e"][0]}, -table["p_eff"][0], ["sigma"])
clients.compare("three shear components, reversed, SMALL_DEFORMATION", rows, clients.stresses(table)[1:], DIGITS,
                WRITTEN)
table = clients.expected("shear_suction")
rows, = run("shear_suction", clients.strains(table), {"void_ratio": table["e"][0], "suction": table["suction"][0]},
            -table["p_eff"][0], ["sigma"])
clients.compare("the same at a preset suction", rows, clients.stresses(table)[1:], DIGITS, WRITTEN)

table = clients.expected("wetting")
pull = [s*p for s, p in zip(table["s_w"], table["suction"])]  # S_w p_c: what total stress has more than effective
total = [[x + p*(i < 3) for i, x in enumerate(row)] for row, p in zip(clients.stresses(table), pull)]
rows, saturation = run("wetting", clients.strains(table), {"void_ratio": table["e"][0]}, total[0][0],
                       ["sigma_total", "saturation"], table["suction"], table["s_w"][0])
clients.compare("shear, wetting, shear, THERMO_RICHARDS_MECHANICS: total stress", rows,
                total[1:], DIGITS, WRITTEN)
clients.compare("and its degree of saturation", saturation, [[s] for s in table["s_w"][1:]], DIGITS)

# The column. OpenGeoSys is of first order in time: two runs are extrapolated to steps of no length. What a third run
# moves the extrapolation is the error allowed, and with it what half the step moves mud_host.
coarse, middle, fine = (column(20, steps) for steps in (20, 40, 80))
own_middle, own_fine = host_column(20, 40), host_column(20, 80)
for i, name in enumerate(("suction at the top", "settlement of the top")):
    if not all((coarse, middle, fine, own_middle, own_fine)):
        clients.verdict(False, f"column wetted from below, {name}", "a program did not come to its end")
        continue
    before, there = ([2.0*b[i] - a[i] for a, b in zip(*pair)] for pair in ((coarse, middle), (middle, fine)))
    ours_before, ours_now = ([row[i] for row in rows] for rows in (own_middle, own_fine))
    scale = max(abs(x) for x in ours_now)
    theirs, ours, apart = (max(abs(a - b) for a, b in zip(*pair))/scale
                           for pair in ((before, there), (ours_before, ours_now), (there, ours_now)))
    clients.verdict(apart <= theirs + ours, f"column wetted from below against mud_host, {name}",
                    f"apart {apart:.1e} of {scale:.4g}, allowed {theirs:.1e} (OpenGeoSys) + {ours:.1e} (mud_host)")


def told(name, **changes):
    """Exit code and standard error of two steps with other parameters."""
    folder = clients.work_folder(f"opengeosys/{name}")
    project.write_cube(folder)
    table = clients.expected("shear")
    text = project.project(clients.library_file, named_props() | changes, {}, clients.strains(table)[:3], -100.0)
    (folder / "cube.prj").write_text(text)
    done = subprocess.run([python.parent / "ogs", "cube.prj"], cwd=folder, capture_output=True, text=True, timeout=600)
    return done.returncode, done.stderr


# What the library says is on standard error.
code, words = told("refused", K_0=-1.0)
clients.verdict(code != 0 and "MUD: MFront refused the increment" in words and "parameter K_0 (PROPS 1) is -1" in words,
                "a refusal tells its reason on standard error", f"exit code {code}")
code, words = told("units", p_atm=101325.0)
clients.verdict("do all PROPS have the unit of stress of p_atm?" in words, "p_atm in Pa among kPa draws a warning",
                f"exit code {code}")

# The start: ground with weight under K_0 stress.
CELLS, DEPTH, K_0, SURCHARGE, ADDED, STEPS = 4, 4.0, 0.5, 10.0, 40.0, 20
density = 2.65/(1.0 + named_props()["e_0"])
folder = clients.work_folder("opengeosys/ground")
project.write_column(folder, CELLS, DEPTH)
(folder / "column.prj").write_text(project.ground(clients.library_file, named_props(), DEPTH, density, K_0, SURCHARGE,
                                                  ADDED, STEPS))
code = clients.run([python.parent / "ogs", "column.prj"], folder / "log.txt", cwd=folder, timeout=600)
moved = max(abs(x) for x in field(folder / "r_1.vtu", "displacement")) if code == 0 else float("nan")
# The first iteration of the first step is followed by that of the second.
begun = re.findall(r"Iteration #(\d+) started", (folder / "log.txt").read_text())[:2]
clients.verdict(code == 0 and moved <= 1e-8 and begun == ["1", "1"], "ground under K_0 stress rests in one iteration",
                f"iterations {begun}, displacement {moved:.1e} m")
if code == 0:
    before, after = (field(folder / f"r_{i}.vtu", "sigma")[:4] for i in (1, STEPS + 1))
    table = clients.expected("ground", sigma_a=-before[1], sigma_r=-before[0], sigma_a_end=-after[1])
    clients.compare("and its horizontal stress follows the surcharge as in mud_triax", [[after[0]]],
                    [[-table["sigma_r"][-1]]], 2e-4)

cases.check("opengeosys", PACKAGES[0], lambda case, divided: references.run(python, case, divided), references.FINER)
clients.finish()
