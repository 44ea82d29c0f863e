# SPDX-License-Identifier: MIT
"""CalculiX with external behaviours: MUD loaded by name (@) and linked statically."""
import os
import pathlib
import shutil
import subprocess
import sys

import clients
import decks

here = pathlib.Path(__file__).parent
BUILD_NEEDS = ["gfortran", "gcc", "make", "dpkg-dev", "libspooles-dev", "libarpack2-dev", "liblapack-dev"]
SOURCE = "calculix-ccx"
VERSION = "2.20"
# The .dat file has seven digits: half a unit of the last one, with as much again for what Newton's method leaves.
PRINTED = 1e-6
# Held stress: CalculiX stops where the residual is 1e-8 of the mean force; the digits of the file are coarser.
HELD = 2e-6


def source_package():
    """Debian's source, unpacked with Debian's changes; the folder with the Makefile."""
    folder = clients.home / "calculix"
    source = folder / f"ccx/ccx_{VERSION}/src"
    if source.exists():
        return source
    if clients.may_not_install():
        clients.skip("the source of CalculiX is not there")
    folder.mkdir(parents=True, exist_ok=True)
    lists = folder / "lists"
    for part in (lists / "partial", folder / "sources"):
        part.mkdir(parents=True, exist_ok=True)
    # Source packages from the same places as binary ones, in lists of our own: the system's stay as they are.
    for found in [*pathlib.Path("/etc/apt/sources.list.d").glob("*.sources")]:
        text = found.read_text().replace("Types: deb\n", "Types: deb-src\n")
        (folder / "sources" / found.name).write_text(text)
    lines = pathlib.Path("/etc/apt/sources.list")
    if lines.exists():
        (folder / "sources/sources.list").write_text(lines.read_text().replace("deb ", "deb-src "))
    options = ["-o", "Dir::Etc::sourcelist=/dev/null", "-o", f"Dir::Etc::sourceparts={folder}/sources",
               "-o", f"Dir::State::lists={lists}"]
    subprocess.run(["apt-get", *options, "update"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["apt-get", *options, "source", "--download-only", SOURCE], check=True, cwd=folder,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    description = next(folder.glob(f"{SOURCE}_{VERSION}*.dsc"))
    subprocess.run(["dpkg-source", "--no-check", "-x", description.name, "ccx"], check=True, cwd=folder,
                   stdout=subprocess.DEVNULL)
    return source


def programs():
    """ccx that loads libraries, and ccx with MUD linked in."""
    clients.debian(BUILD_NEEDS)
    source = source_package()
    loading, static = source / f"ccx_{VERSION}", clients.home / "calculix/ccx_mud"
    if not loading.exists():
        print("building CalculiX: about 1100 files, ten minutes on two free cores", flush=True)
        flags = "-w -O1 -I/usr/include/spooles -DARCH=Linux -DSPOOLES -DARPACK -DMATRIXSTORAGE -DUSE_MT=1 " \
                "-DCALCULIX_EXTERNAL_BEHAVIOURS_SUPPORT"
        if clients.run(["make", f"-j{os.cpu_count()}", f"CFLAGS={flags}", "FFLAGS=-w -O1 -fallow-argument-mismatch",
                        "LDFLAGS=-ldl -rdynamic"], source / "make.log", cwd=source) != 0:
            sys.exit(1)
    # -u umat_: otherwise the linker takes CalculiX' own umat_ without a message.
    libraries = "-lspooles -lpthread -larpack -llapack -lblas -lm -fopenmp -ldl".split()
    if clients.run(["gfortran", "-o", static, source / f"ccx_{VERSION}.o", "-Wl,-u,umat_",
                    clients.build / "umat/libmud.a", source / f"ccx_{VERSION}.a", *libraries],
                   clients.home / "calculix/link.log") != 0:
        sys.exit(1)
    return loading, static


def solution(elements, state):
    """STATEV at the start. The reader of ccx 2.20 returns after one point where STATEV have more than six entries: a
    card for every point, two lines each, sets the first six; the rest stays zero."""
    points = [(element, point) for element in range(1, elements + 1) for point in range(1, 9)]
    return "".join(f"*INITIAL CONDITIONS, TYPE=SOLUTION\n{element}, {point}, {', '.join(map(str, state[:6]))}\n0.\n"
                   for element, point in points)


def analysis(job, ccx, name, deck, props=None, shares=""):
    """Runs a deck in a folder of its own, or in that of an earlier one: exit code, rows of stress of the first point of
    element 1 at every increment (11, 22, 33, 12, 13, 23), and what was printed."""
    folder = clients.work_folder(f"calculix/{shares or job}_{ccx.name}")
    (folder / f"{job}.inp").write_text(deck.replace("@ABAQUS_MUD", name))
    (folder / "material.inp").write_text(card(props or {}).replace("@ABAQUS_MUD", name))
    shutil.copy(clients.library_file, folder / "libMUD.so")
    environment = dict(os.environ, LD_LIBRARY_PATH=str(folder), OMP_NUM_THREADS="1")
    code = clients.run([ccx, job], folder / "log.txt", cwd=folder, env=environment, timeout=900)
    rows = []
    if (folder / f"{job}.dat").exists():
        words = [line.split() for line in (folder / f"{job}.dat").read_text().splitlines()]
        rows = [[float(x) for x in row[2:8]] for row in words if row[:2] == ["1", "1"] and len(row) == 8]
    return code, rows, (folder / "log.txt").read_text(errors="replace")


def card(changes):
    """The card of mud_describe with other parameters; eight numbers a line."""
    lines = clients.describe("calculix").splitlines()
    first = 1 + next(i for i, line in enumerate(lines) if line.upper().startswith("*USER MATERIAL"))
    for name, value in changes.items():
        index = clients.mud().mud_index(clients.MUD_PROPS, name.encode())
        words = lines[first + index//8].split(",")
        words[index % 8] = f" {value!r}"
        lines[first + index//8] = ",".join(words)
    return "\n".join(lines) + "\n"


def stresses(job, ccx, name, more=""):
    """Stress of a deck of this folder at every increment."""
    deck = (here / f"{job}.inp").read_text().replace("*INITIAL CONDITIONS", more + "*INITIAL CONDITIONS", 1)
    return analysis(f"{job}{'_more' if more else ''}", ccx, name, deck)[1]


def rest(name):
    """Largest residual of the first iteration of the first increment [% of the mean force], and largest displacement
    [m] at its end."""
    folder = clients.work_folder(f"calculix/{name}_{loading.name}")
    rows = [line.split() for line in (folder / f"{name}.cvg").read_text().splitlines()]
    residual = next(float(row[5]) for row in rows if row[:4] == ["1", "1", "1", "1"])
    text = (folder / f"{name}.dat").read_text().split("displacements")[1].split("stresses")[0]
    moved = [abs(float(x)) for line in text.splitlines()[1:] for x in line.split()[1:]]
    return residual, max(moved)


def times(name):
    """Ends of the increments that CalculiX accepted; a U stands behind the number of an attempt that it repeated."""
    folder = clients.work_folder(f"calculix/{name}_{loading.name}")
    rows = [line.split() for line in (folder / f"{name}.sta").read_text().splitlines()]
    return [float(row[4]) for row in rows if len(row) == 7 and row[2].isdigit()]


loading, static = programs()
table = clients.expected("triaxial")
wanted = list(zip(table["sigma_a"][1:], table["sigma_r"][1:]))
rows = stresses("triaxial", loading, "@ABAQUS_MUD")
clients.compare("triaxial with unloading, loaded by @", [[-r[2], -r[0]] for r in rows], wanted, HELD)
table = clients.expected("shear")
wanted = clients.stresses(table)[1:]
clients.compare("three shear components, reversed, loaded by @", stresses("shear", loading, "@ABAQUS_MUD"), wanted,
                PRINTED)
clients.compare("the same, linked statically", stresses("shear", static, "ABAQUS_MUD"), wanted, PRINTED)
table = clients.expected("shear_suction")
more = solution(8, clients.statev(suction=table["suction"][0]))
clients.compare("the same at a suction preset in STATEV", stresses("shear", loading, "@ABAQUS_MUD", more),
                clients.stresses(table)[1:], PRINTED)

# Cuts: a refused increment has an elastic stiffness, so that CalculiX, which factorises it, goes on. Other increments
# have other strain paths between their ends: mud_triax takes those that CalculiX has chosen.
for limit in (8, 20):
    code, rows, told = analysis(f"cut_{limit}", loading, "@ABAQUS_MUD", decks.cut(), {"max_substeps": limit})
    ends = times(f"cut_{limit}")
    clients.verdict(code == 0 and "too many substeps" in told, f"max_substeps = {limit}: the run cuts and ends",
                    f"exit code {code}, {len(ends)} increments")
    table = clients.expected("cut", stages=[(0.02*t/100, 0.02*(t - before)/100) for before, t in zip([0, *ends], ends)])
    clients.compare("and its stress is that of mud_triax", rows[-1:], [[-table[name][-1] for name in (
        "sigma_r", "sigma_r", "sigma_a")] + [0.0]*3], PRINTED)

# A restart loses STATEV: that cannot be repaired here, but it is told.
first, second = decks.restart()
analysis("first", loading, "@ABAQUS_MUD", first)
folder = clients.work_folder(f"calculix/first_{loading.name}")
shutil.copy(folder / "first.rout", folder / "second.rin")
code, rows, told = analysis("second", loading, "@ABAQUS_MUD", second, shares="first")
clients.verdict("STATEV is not initialised (layout 0)" in told and "*RESTART" in told,
                "*RESTART: MUD tells that STATEV is lost", f"exit code {code}, last axial stress {rows[-1][2]}")

# Finite strains: logarithmic strain, true stress, in @ABAQUSNL alone.
table = clients.expected("finite")
code, rows, told = analysis("finite", loading, "@ABAQUSNL_MUD", decks.finite())
clients.compare("NLGEOM with @ABAQUSNL at 2 % of the length", [[rows[-1][2]]], [[-table["sigma_a"][-1]]], 1e-4)
code, rows, told = analysis("green", loading, "@ABAQUS_MUD", decks.finite())
clients.verdict("Green's strain" in told and "@ABAQUSNL_" in told, "NLGEOM with @ABAQUS: MUD tells that it is wrong",
                f"axial stress {rows[-1][2]}")
strains = (-0.02, 0.008, 40)
code, still, told = analysis("still", loading, "@ABAQUSNL_MUD", decks.turning(0.0, *strains))
code, turned, told = analysis("turned", loading, "@ABAQUSNL_MUD", decks.turning(90.0, *strains))
clients.compare("a cube that turns by 90 degrees has the stress of one that stands", turned[-1:],
                [[still[-1][i] for i in (2, 1, 0)] + [0.0]*3], PRINTED)

# The start: ground with weight under K_0 stress. Nothing happens in a step without load; then the surcharge grows, and
# the lowest point goes the way of a point that begins at its own stress.
CELLS, HEIGHT, K_0, SURCHARGE, ADDED = 4, 4.0, 0.5, 10.0, 40.0
DENSITY = 2.65/(1.0 + clients.props()[clients.mud().mud_index(clients.MUD_PROPS, b"e_0")])
code, rows, told = analysis("ground", loading, "@ABAQUS_MUD",
                            decks.ground(CELLS, HEIGHT, DENSITY, K_0, SURCHARGE, ADDED, 20))
residual, moved = rest("ground")
clients.verdict(residual <= 1e-6 and moved <= 1e-8, "ground under K_0 stress rests in its first iteration",
                f"residual {residual:.1e} % of the mean force, displacement {moved:.1e} m")
table = clients.expected("ground", sigma_a=-rows[0][2], sigma_r=-rows[0][0], sigma_a_end=-rows[-1][2])
clients.compare("and its horizontal stress follows the surcharge as in mud_triax", [[rows[-1][0]]],
                [[-table["sigma_r"][-1]]], 1e-4)
clients.finish()
