# SPDX-License-Identifier: MIT
"""OpenGeoSys through the generic interface of MFront: mechanics, and the unsaturated process with a wetting."""
import csv
import ctypes
import pathlib
import xml.etree.ElementTree

import clients
import project

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
clients.finish()
