# SPDX-License-Identifier: MIT
"""The archive keeps nothing between calls but which sentences were said, and offers what mud.h promises."""
import os
import re
import subprocess

from checking import build, check, preset, root


WRITABLE = "BbCcDdGgSs"  # nm's letters of .bss, common and .data, global or local
# Descriptors that gfortran makes of every derived type. It never writes them, but does not mark them read-only either.
DESCRIPTOR = re.compile(r"__\w+_MOD___(vtab|def_init)_\w+$")
# The one exception: one bit for each sentence that umat_ has said in this process (umat/abi/mud_once.f90).
SAID = "__mud_once_MOD_told"


def symbols(archive):
    """(object, letter, name) of every symbol of an archive."""
    text = subprocess.run(["nm", archive], check=True, capture_output=True, text=True).stdout
    member, found = "", []
    for line in text.splitlines():
        words = line.split()
        if line.endswith(":"):
            member = line[:-1]
        elif len(words) >= 2 and len(words[-2]) == 1:
            found.append((member, words[-2], words[-1]))
    return found


def constants(archive):
    """Names in sections that are read-only once they are loaded: tables of pointers, which the loader fills in."""
    text = subprocess.run(["objdump", "-t", archive], check=True, capture_output=True, text=True).stdout
    return {line.split()[-1] for line in text.splitlines() if " .data.rel.ro" in line}


def promised():
    """Functions that mud.h declares, and the entries that hosts look for, such as umat_."""
    entries = re.search(r"set\(entries ([^)]*)\)", (root / "umat/CMakeLists.txt").read_text(encoding="utf-8"))[1]
    header = re.sub(r"/\*.*?\*/", "", (root / "umat/include/mud.h").read_text(encoding="utf-8"), flags=re.DOTALL)
    return set(re.findall(r"\b(mud_\w+)\s*\([^;{]*\)\s*;", header)) | set(entries.split())


# By these the copies of the core for newer processors (umat/lanes) and their door find each other, and the functions
# of mud_tables.c the door of MFront.
INSIDE = {"mud_lane_points", "mud_lane_points_v3", "mud_lane_points_v4", "mud_find_rates_v3", "mud_find_rates_v4",
          "mud_find_ends_v3", "mud_find_ends_v4", "mud_fetch", "mud_behaviour"}
# What MGIS looks up; test_mfront_symbols knows each of them.
OF_MFRONT = re.compile(r"MUD_(StressSaturation_)?[A-Za-z_]+$")


def test_the_archive_keeps_nothing_and_offers_what_is_promised():
    archive = build / "umat/libmud.a"
    found = symbols(archive)
    defined = {name for _, letter, name in found if letter == "T"}
    names = promised()

    # Fewer functions than the first version of the header had would mean that the expression above no longer reads it.
    checks = [("mud.h: fewer than 12 functions found", len(names) < 13)]
    checks += [(f"{name} is not a defined global symbol", name not in defined) for name in sorted(names)]

    # A C name that no header promises would collide with other people's: gfortran's own begin with __.
    checks += [(f"{name} is global but no promised name", name not in names | INSIDE)
               for name in sorted(defined) if not name.startswith(("__mud_", "_GLOBAL_")) and not OF_MFRONT.match(name)]
    if preset == "sanitize":
        print("note: writable data is not looked for here, because the sanitizers add their own (1 check fewer)")
    else:
        fixed = constants(archive)
        writable = [(member, letter, name) for member, letter, name in found
                    if letter in WRITABLE and not DESCRIPTOR.match(name) and name != SAID and name not in fixed]
        for member, letter, name in writable:
            print(f"  {member}: {name} ({letter})")
        checks.append((f"{SAID} is not there: the exception is for nothing",
                      SAID not in {name for _, _, name in found}))
        once = subprocess.run(["nm", "--undefined-only", archive], check=True, capture_output=True, text=True).stdout
        once = once[once.index("mud_once.f90.o:"):].split("\n\n")[0]
        checks.append(("mud_once needs a run-time library for its atomic operations",
                       bool(re.search(r"GOMP|omp_|atomic", once))))
        code = subprocess.run(["objdump", "-d", archive], check=True, capture_output=True, text=True).stdout
        code = code[code.index("<__mud_once_MOD_first_time>:"):].split("\n\n")[0]
        checks.append(("the exchange in mud_once is not atomic",
     os.uname().machine == "x86_64" and "lock " not in code))
        checks.append(
    (f"{len(writable)} writable symbols: state between calls, and threads that share it", bool(writable)))

    for text, wrong in checks:
        check(text, not wrong)
