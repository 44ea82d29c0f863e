"""OpenGeoSys through the generic interface of MFront: mechanics, and the unsaturated process with a wetting."""
import ctypes
import xml.etree.ElementTree

import clients
import project

PACKAGES = ["ogs==6.5.9"]
# VTK writes a number with 11 digits at least.
DIGITS = 1e-9
WRITTEN = (0, 1, 2, 3, 5, 4)  # files of OpenGeoSys: xx, yy, zz, xy, yz, xz
python = clients.venv("ogs", PACKAGES)


def named_props():
    library = clients.mud()
    names = (ctypes.c_char_p*library.mud_count(clients.MUD_PROPS)).in_dll(library, "mud_props_names")
    return {name.decode(): value for name, value in zip(names, clients.props())}


def fields(path, *names):
    """Values of a field at the first node."""
    rows = []
    for array in xml.etree.ElementTree.parse(path).iter("DataArray"):
        if array.get("Name") in names:
            width = int(array.get("NumberOfComponents", 1))
            rows.append((array.get("Name"), [float(x) for x in array.text.split()[:width]]))
    return [dict(rows)[name] for name in names]


def run(name, strains, presets, stress, names, suction=None):
    folder = clients.work_folder(f"opengeosys/{name}")
    project.write_cube(folder)
    text = project.project(clients.library_file, named_props(), presets, strains, stress, suction)
    (folder / "cube.prj").write_text(text)
    for old in folder.glob("r_*.vtu"):
        old.unlink()
    if clients.run([python.parent / "ogs", "cube.prj"], folder / "log.txt", cwd=folder, timeout=600) != 0:
        return [[]]*len(names)
    found = [fields(folder / f"r_{i}.vtu", *names) for i in range(1, len(strains))]
    return [list(rows) for rows in zip(*found)]


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
                       ["sigma_total", "saturation"], table["suction"])
clients.compare("shear, wetting, shear, THERMO_RICHARDS_MECHANICS: total stress", rows,
                total[1:], DIGITS, WRITTEN)
clients.compare("and its degree of saturation", saturation, [[s] for s in table["s_w"][1:]], DIGITS)
clients.finish()
