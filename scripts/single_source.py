# SPDX-License-Identifier: MIT
"""Writes the library as one Fortran source; usage: single_source.py OUTPUT.

The modules, in the order of umat/CMakeLists.txt, follow each other unchanged behind a comment that says what the file is
and how it is linked.
"""
import pathlib
import re
import sys

root = pathlib.Path(__file__).resolve().parents[1]
USE = re.compile(r"^\s*use\s+(mud_\w+)", re.MULTILINE | re.IGNORECASE)

HEADER = """\
MUD {version}: bounding-surface model for unsaturated soil dynamics, the whole library in one file.
Written by scripts/single_source.py from umat/core, umat/abi and umat/doors: change it there, not here.

It defines the UMAT (symbol umat_), a VUMAT (vumat_), a UDSM (user_mod_ and its companions) and the functions of
mud.h, but neither its tables of names nor what MFront's behaviours need: those are C and in the library. PROPS,
STATEV, conventions and status codes: umat/README.md. Free form, Fortran 2018; gfortran 12 or later. Compiling leaves
.mod files in the working folder, which nobody needs. With -fopenmp mud_update_points uses several threads, and what
umat_ says is said once even if two threads fail at the same instant; everything else is the same without.

   gfortran -O3 -fPIC -fno-semantic-interposition -c mud_umat_single.f90

Abaqus:    abaqus job=JOB user=mud_umat_single.o     (add -lgfortran to link_sl of the environment file if it links with
           another compiler; user=mud_umat_single.f90 works where compile_fortran is gfortran with free form)
CalculiX:  link mud_umat_single.o before ccx_VERSION.a, whose own umat is then left out; name the material ABAQUS...
           (small strains). CalculiX never sets PREDEF and DPRED: MUD does not read them where PNEWDT enters with -1,
           the suction is that of STATEV.
Others:    call umat_ with the arguments of Abaqus; the hidden length of CMNAME may be passed or left out.

{licence}"""


def cmake_order():
    """Source files in the order in which CMake lists them, lowest first."""
    text = (root / "umat/CMakeLists.txt").read_text(encoding="utf-8")
    files = []
    for folder in ("core", "abi"):
        names = re.search(rf"^set\({folder}\s+([^)]*)\)", text, re.MULTILINE)[1].split()
        paths = [pathlib.PurePosixPath(folder, name) for name in names]
        files += [root / "umat" / path.with_name(f"mud_{path.name}.f90") for path in paths]
    return files + [root / "umat" / name for name in re.search(r"^set\(doors\s+([^)]*)\)", text, re.MULTILINE)[1].split()]


def version():
    text = (root / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(mud VERSION ([\d.]+)", text)[1]


def single_source(files):
    licence = (root / "LICENSE").read_text(encoding="utf-8").rstrip()
    header = HEADER.format(version=version(), licence=licence)
    parts = ["\n".join(f"! {line}".rstrip() for line in header.splitlines())]
    above = set()
    for file in files:
        text = file.read_text(encoding="utf-8").rstrip()
        early = [name for name in USE.findall(text) if name.lower() not in above]
        if early:
            raise ValueError(f"{file.name} uses {early[0]}, which does not stand before it in umat/CMakeLists.txt")
        above.add(file.stem)
        parts.append(text)
    return "\n\n".join(parts) + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        sys.exit(0 if sys.argv[1:] in (["-h"], ["--help"]) else 2)
    try:
        source = single_source(cmake_order())
    except (OSError, ValueError) as problem:
        sys.exit(f"single_source.py: {problem}")
    pathlib.Path(sys.argv[1]).write_text(source, encoding="utf-8")
