# SPDX-License-Identifier: MIT
"""The library as one source file compiles alone and is, bit by bit, the library; called as Abaqus calls a UMAT."""
import pathlib
import re
import subprocess
import sys
import tempfile

from checking import build, check, root

cache = dict(re.findall(r"^(\w+):\w+=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE))
built = build / "umat/mud_umat_single.f90"
WARNINGS = ["-std=f2018", "-Wall", "-Wextra", "-Wuse-without-only", "-Werror"]
LONGEST = 132  # columns of free form that every compiler takes
# p' and q [kPa] at 1 % axial strain, undrained e 0.735 p' 100 (verification/material/reference), their tolerance.
KNOWN, WITHIN = (147.354, 219.587), 1e-4


def run(*command, folder, **more):
    return subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, **more)


def flags(language):
    kind = cache["CMAKE_BUILD_TYPE"].upper()
    return f"{cache.get(f'CMAKE_{language}_FLAGS', '')} {cache.get(f'CMAKE_{language}_FLAGS_{kind}', '')}".split()


def compiler(language):
    return cache[f"CMAKE_{language}_COMPILER"]


def program(folder, name, *objects):
    """umat_host with these objects: what it prints, or what went wrong."""
    host = folder / f"{name}.o"
    done = run(compiler("C"), *flags("C"), "-std=c11", "-Wall", "-Wextra", "-Werror", "-I", root / "umat/include", "-c",
               root / "tests/consumers/umat_host.c", "-o", host, folder=folder)
    if done.returncode == 0:
        done = run(compiler("Fortran"), *flags("Fortran"), host, *objects, "-o", folder / name, folder=folder)
    if done.returncode == 0:
        done = run(folder / name, folder=folder)
    return done.stdout if done.returncode == 0 else f"umat_host failed: {done.stdout}{done.stderr}"


def near(text):
    found = re.search(r"p' ([-\d.]+) kPa, q ([-\d.]+) kPa", text)
    return bool(found) and all(abs(float(value) - known) <= WITHIN*known for value, known in zip(found.groups(), KNOWN))


def library_files():
    return [file for folder in ("core/**", "abi", "doors", "include") for file in root.glob(f"umat/{folder}/*.f90")]


def refusal(folder):
    """What the program says where a module stands before one that it uses."""
    copy = folder / "disordered"
    for name in ("CMakeLists.txt", "LICENSE", "umat/CMakeLists.txt", "scripts/single_source.py",
                 *(file.relative_to(root) for file in library_files())):
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        text = (root / name).read_text(encoding="utf-8")
        if name == "umat/CMakeLists.txt":
            text = text.replace("set(core base/kinds base/status", "set(core base/status base/kinds")
        (copy / name).write_text(text, encoding="utf-8")
    done = run(sys.executable, copy / "scripts/single_source.py", copy / "out.f90", folder=folder)
    return done.stderr if done.returncode and not (copy / "out.f90").exists() else ""


def test_one_file_is_the_library():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        alone = folder / "alone"
        alone.mkdir()
        source, object_file = alone / "mud_umat_single.f90", alone / "mud_umat_single.o"
        written = run(sys.executable, root / "scripts/single_source.py", source, folder=alone)
        text = source.read_text(encoding="utf-8") if written.returncode == 0 else ""
        header = text.split("\nmodule ", 1)[0]
        modules = re.findall(r"^module (\w+)$", text, re.MULTILINE)
        compiled = run(compiler("Fortran"), *flags("Fortran"), *WARNINGS, "-fPIC", "-c", source, folder=alone)
        symbols = run("nm", object_file, folder=alone).stdout
        shows = set(re.findall(r" T (\w+)$", symbols, re.MULTILINE))
        needs = set(re.findall(r" U (\w+)$", symbols, re.MULTILINE))
        one, many = (program(folder, "single", object_file),
                     program(folder, "library", build / "umat/libmud.a"))
        version = re.search(r"VERSION = '([\d.]+)'", text)
        declared = set(re.findall(r"\b(mud_\w+)\s*\(", re.sub(r"/\*.*?\*/", "", (root / "umat/include/mud.h").read_text(
            encoding="utf-8"), flags=re.DOTALL)))
        checks = [
            ("the program writes the file", written.returncode == 0, written.stderr),
            ("the file of the build tree is what the program writes now",
             built.exists() and built.read_text(encoding="utf-8") == text,
             f"rebuild the target mud_single_source: {built}"),
            ("every module of the library is in it, once",
             sorted(modules) == sorted(file.stem for file in library_files()), str(modules)),
            ("the header says the version that the library says", bool(version) and f"MUD {version[1]}:" in header,
             header[:80]),
            ("the header says the licence and how to link",
             all(words in header for words in ("Permission is hereby granted", "user=mud_umat_single", "CalculiX")),
             ""),
            (f"no line has more than {LONGEST} columns", max(map(len, text.splitlines()), default=0) <= LONGEST, ""),
            ("it compiles alone, without a warning", compiled.returncode == 0, compiled.stderr[-2000:]),
            ("the object defines umat_ and the functions of mud.h", {"umat_"} | declared <= shows,
             str({"umat_"} | declared - shows)),
            ("the object needs nothing of ours", not [s for s in needs if "mud" in s], str(needs)),
            ("a C host of umat_ meets the known answer", near(one), one[:2000]),
            ("all its bits are those of the library", one == many and near(many), f"{one[:500]}\n{many[:500]}"),
            ("a list out of order is refused with the module's name", "uses mud_kinds" in refusal(folder),
             refusal(folder))]
        for sentence, good, why in checks:
            check(sentence, good, why)
