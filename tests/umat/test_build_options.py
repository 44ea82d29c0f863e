# SPDX-License-Identifier: MIT
"""Every option of CMakeLists.txt can be switched off: the rest builds, and its programs run.

One folder, without optimisation: one option after another is off, so that only what it changes is compiled again.
"""
import re
import shutil
import subprocess
import sys

from checking import build, check, needs_nightly, root, work

needs_nightly("a build of the whole tree: ./check --tier nightly and scripts/before_release make it")

cache = dict(re.findall(r"^(\w+):\w+=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE))
folder = work / "options"
# What is installed, and which option it belongs to.
PARTS = {"bin/mud_triax": "MUD_BUILD_DRIVERS", "bin/mud_describe": "MUD_BUILD_DRIVERS",
         "bin/mud_host": "MUD_BUILD_HOST", "libmud.a": "MUD_BUILD_STATIC",
         "libmud.so": "MUD_BUILD_SHARED", "include/mud.h": "MUD_INSTALL"}


def run(*command):
    """Exit code and everything that was written."""
    done = subprocess.run([str(word) for word in command], cwd=work, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def options():
    """The names of the options of the project."""
    text = (root / "CMakeLists.txt").read_text(encoding="utf-8")
    return set(re.findall(r"^option\((MUD_\w+) ", text, re.MULTILINE))


def built_without(*off):
    """Configures, builds and installs with these options off and every other on: whether that went well, its text."""
    shutil.rmtree(work / "prefix", ignore_errors=True)
    values = {name: "ON" for name in options() if name not in ("MUD_BUILD_PYTHON", "MUD_BUILD_BENCHMARKS", *off)}
    values |= {name: "OFF" for name in ("MUD_BUILD_TESTS", *off)}
    for command in (
            ["cmake", "-S", root, "-B", folder, "-G", cache["CMAKE_GENERATOR"], "--no-warn-unused-cli",
             f"-DCMAKE_Fortran_COMPILER={cache['CMAKE_Fortran_COMPILER']}",
             f"-DCMAKE_C_COMPILER={cache['CMAKE_C_COMPILER']}", f"-DMUD_PYTHON={sys.executable}",
             "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_Fortran_FLAGS_DEBUG=-O0", "-DCMAKE_C_FLAGS_DEBUG=-O0",
             f"-DCMAKE_DISABLE_FIND_PACKAGE_HDF5={'ON' if 'MUD_BUILD_HOST' in off else 'OFF'}",
             *[f"-D{name}={value}" for name, value in values.items()]],
            ["cmake", "--build", folder, "-j", "2"], ["cmake", "--install", folder, "--prefix", work / "prefix"]):
        code, told = run(*command)
        if code != 0:
            return False, told[-2000:]
    return True, ""


def contradictions(*off):
    """Parts installed although their option is off, those missing although it is on, programs that do not run."""
    prefix = work / "prefix"
    there = {part: list(prefix.rglob(part)) for part in PARTS}
    wrong = [part for part, option in PARTS.items() if bool(there[part]) == (option in off or "MUD_INSTALL" in off)]
    return wrong + [f"{part}: {told}" for part, found in there.items() if found and part.startswith("bin/")
                    for code, told in [run(found[0], "--help")] if code != 0]


def test_it_builds_without_tests_and_without_each_part():
    good, told = built_without()
    check("it builds without tests", good, told)
    check("everything is installed, and the programs run", not contradictions(), contradictions())

    single = {"MUD_BUILD_STATIC", "MUD_BUILD_SHARED", "MUD_BUILD_DRIVERS", "MUD_BUILD_HOST", "MUD_INSTALL"}
    check("every option is tried here or stands off", options() == single | {
        "MUD_BUILD_TESTS", "MUD_BUILD_BENCHMARKS", "MUD_BUILD_PYTHON", "MUD_WERROR"}, options())
    for option in sorted(single):
        good, told = built_without(option)
        check(f"it builds with {option}=OFF", good, told)
        wrong = contradictions(option)
        check(f"with {option}=OFF what is on is installed, and nothing else", not wrong, wrong)
