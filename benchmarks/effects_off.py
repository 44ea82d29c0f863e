#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What an effect of the material costs where it is off: instructions of an update, beside a build without its code.

    benchmarks/effects_off.py [--only EFFECT ...] [--folder build/effects_off] [--keep]

For every effect a copy of the sources in which the question whether it is on is answered beforehand is built, so that the
compiler removes its code; both builds then walk the paths of mud_benchmark with the effect off. Needs valgrind; a minute
of one core an effect. --keep writes results/effects_off.csv.
"""
import argparse
import csv
import filecmp
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "common"))
import tables  # noqa: E402

PATHS = ("unsaturated", "saturated_turning")
TANGENTS = {0: "none", 3: "consistent"}
UPDATES = 500   # of a walk
COLUMNS = ("effect", "parameter", "path", "tangent", "off", "without_its_code", "difference_percent")


def never(parameter):
    return ((rf"\b(material%)?par%{parameter}\b", ".false."),)


# Effect: parameter that is 0 where it is off, what is replaced in the sources of the library.
EFFECTS = {
    "hysteresis": ("hysteresis", never("hysteresis") + ((r"\bpar%scanning%between\b", ".false."),)),
    "bonding": ("bonding", never("bonding")),
    "fabric": ("fabric", never("fabric")),
    "isotropic": ("isotropic", never("isotropic")),
    "lode": ("lode", never("lode")),
    "memory_rule": ("memory_rule", ((r"\b(material%)?par%memory_rule\b", "0"),)),
    "elastic_domain": ("rho_e", ((r"\binc%rho <= 0\.0_wp", ".true."), (r"\binc%rho > 0\.0_wp", ".false."))),
    "void_ratio_in_retention": ("Omega", (
        (r"\bpar%omega > 0\.0_wp", ".false."), (r"= slope\*par%omega/e\b", "= 0.0_wp"),
        (r"bend\*par%omega/\(p_c\*e\), \(bend\*par%omega - slope\)\*par%omega/e\*\*2", "0.0_wp, 0.0_wp"))),
}


def command(*words, **keys):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, **keys)
    if done.returncode:
        sys.exit(f"{' '.join(str(w) for w in words)}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout + done.stderr


def build(source, target, *options):
    """A program of a tree of sources, by its place in the build folder."""
    folder = source / "build"
    if not (folder / "build.ninja").exists():
        command("cmake", "-S", source, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                "-DCMAKE_Fortran_FLAGS_RELEASE=-O3",
                "-DMUD_BUILD_TESTS=OFF", "-DMUD_BUILD_DRIVERS=OFF", "-DMUD_BUILD_SHARED=OFF", "-DMUD_WERROR=OFF", *options)
    command("ninja", "-j1", "-C", folder, pathlib.Path(target).name)
    return folder / target


def copy_to(folder, *places):
    """The sources that every build needs, and those at the places, as they are now."""
    names = command("git", "-C", ROOT, "ls-files", "CMakeLists.txt", "CMakePresets.json", "cmake", "common", "umat", "materials",
                    "drivers", "LICENSE", "README.md", *places).split()
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        if not (folder / name).exists() or not filecmp.cmp(ROOT / name, folder / name, shallow=False):
            shutil.copy(ROOT / name, folder / name)


def patched(source, changes, under="umat", left_alone=()):
    """Answers the question in every source below a folder; the originals, to be put back."""
    originals = {}
    for path in sorted((source / under).rglob("*.f90")):
        if path.relative_to(source).as_posix().startswith(tuple(left_alone)):
            continue
        text = path.read_text(encoding="utf-8")
        new = text
        for old, by in changes:
            new = re.sub(old, by, new, flags=re.MULTILINE)
        if new != text:
            originals[path] = text
            path.write_text(new, encoding="utf-8")
    if not originals:
        raise ValueError("nothing was replaced")
    return originals


def instructions(program, path, tangent, parameter):
    """Of an update: three walks less one."""
    def count(walks):
        said = command("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, path, "1e-5", "1", "1e-5",
                       tangent, walks, "-", "-", parameter)
        return int(re.search(r"Collected : (\d+)", said)[1])
    return (count(3) - count(1)) / 2 / UPDATES


def measure(description, effects, columns, folder, places, make, count):
    """The program of both scripts: a build with everything, and for every effect one without its code, of the sources of
    today. places: what a build needs beside the library; make(source) builds a program; count(effect, whole, without)
    gives the rows of an effect; effects: changes and what else patched takes."""
    parser = argparse.ArgumentParser(description=description.split("\n")[0])
    parser.add_argument("--only", nargs="+", choices=list(effects), default=list(effects))
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build" / folder)
    parser.add_argument("--keep", action="store_true")
    args = parser.parse_args()
    place = args.folder.resolve()
    place.mkdir(parents=True, exist_ok=True)
    source, whole = place / "source", place / "with"
    copy_to(source, *places)
    shutil.copy2(make(source), whole)
    results = (ROOT / "benchmarks/results" if args.keep else place) / f"{folder}.csv"
    rows = [tuple(row.values()) for row in (tables.rows(results) if results.exists() else [])
            if row["effect"] not in args.only]
    for effect in args.only:
        originals = patched(source, *effects[effect])
        try:
            for row in count(effect, whole, make(source)):
                rows.append(row)
                print(*row, flush=True)
        finally:
            for file, text in originals.items():
                file.write_text(text, encoding="utf-8")
        with open(results, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(columns)
            writer.writerows(sorted(rows, key=lambda row: list(effects).index(row[0])))


def percent(off, bare):
    return f"{off:.0f}", f"{bare:.0f}", f"{100 * (off / bare - 1):.2f}"


def make(source):
    return build(source, "benchmarks/mud_benchmark", "-DMUD_BUILD_BENCHMARKS=ON", "-DMUD_BUILD_HOST=OFF")


def count(effect, whole, without):
    parameter = EFFECTS[effect][0]
    for path in PATHS:
        for tangent, name in TANGENTS.items():
            yield (effect, parameter, path, name,
                   *percent(*(instructions(program, path, tangent, parameter) for program in (whole, without))))


if __name__ == "__main__":
    measure(__doc__, {effect: (changes,) for effect, (_, changes) in EFFECTS.items()}, COLUMNS, "effects_off",
            ("benchmarks", "verification/studies/work_precision"), make, count)
