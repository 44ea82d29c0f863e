# SPDX-License-Identifier: MIT
"""CalculiX with external behaviours: MUD loaded by name (@) and linked statically."""
import os
import pathlib
import shutil
import subprocess
import sys

import clients

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


def stresses(job, ccx, name, more=""):
    """Stress of the first point of element 1 at every increment: 11, 22, 33, 12, 13, 23."""
    folder = clients.work_folder(f"calculix/{job}_{ccx.name}{'_more' if more else ''}")
    deck = (here / f"{job}.inp").read_text().replace("@ABAQUS_MUD", name)
    (folder / f"{job}.inp").write_text(deck.replace("*INITIAL CONDITIONS", more + "*INITIAL CONDITIONS", 1))
    (folder / "material.inp").write_text(clients.describe("calculix").replace("@ABAQUS_MUD", name))
    shutil.copy(clients.library_file, folder / "libMUD.so")
    environment = dict(os.environ, LD_LIBRARY_PATH=str(folder), OMP_NUM_THREADS="1")
    if clients.run([ccx, job], folder / "log.txt", cwd=folder, env=environment, timeout=900) != 0:
        return []
    rows = []
    for line in (folder / f"{job}.dat").read_text().splitlines():
        words = line.split()
        if words[:2] == ["1", "1"]:
            rows.append([float(x) for x in words[2:8]])
    return rows


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
clients.finish()
