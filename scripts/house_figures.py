#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How large the house is: lines of the Fortran sources by folder, what one must know to change how a step is taken,
what the main program imports.

    python3 scripts/house_figures.py             of this tree
    python3 scripts/house_figures.py TREE ...    of other trees, a column each

The closure of a module is every module that a chain of `use` lines leads to, itself included.
"""
import argparse
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[1]
PARTS = ("host", "umat", "drivers", "common", "materials")
UNIT = re.compile(r"^\s*(?:module|program) (?!procedure\b)(\w+)\s*$", re.MULTILINE | re.IGNORECASE)
USE = re.compile(r"^\s*use\s*(?:,\s*(?:non_)?intrinsic\s*)?(?:::)?\s*(\w+)", re.MULTILINE | re.IGNORECASE)
KINDS = re.compile(r"(?:==|/=)\s*(?:STATIC|QUASI_STATIC|DYNAMIC)\b")


def closure(sources, uses, start):
    """Files that a module needs: itself and what a chain of uses leads to."""
    seen, left = set(), [start]
    while left:
        unit = left.pop()
        if unit in seen or unit not in sources:
            continue
        seen.add(unit)
        left += uses[unit]
    return {sources[unit] for unit in seen}


def figures(tree):
    """{what: number} of a tree."""
    files = sorted(path for part in PARTS for path in (tree / part).glob("**/*.f90"))
    text = {path: path.read_text(encoding="utf-8") for path in files}
    lines = {path: text[path].count("\n") for path in files}
    sources = {unit.lower(): path for path in files for unit in UNIT.findall(text[path])}
    uses = {unit: [name.lower() for name in USE.findall(text[path])] for unit, path in sources.items()}
    found = {f"lines, {part}": sum(n for path, n in lines.items() if path.relative_to(tree).parts[0] == part)
             for part in PARTS}
    found["lines, all"] = sum(found.values())
    for folder in sorted({path.parent for path in files if path.relative_to(tree).parts[0] == "host"}):
        found[f"lines, {folder.relative_to(tree)}/"] = sum(n for path, n in lines.items() if path.parent == folder)
    step = closure(sources, uses, "time_stepping")
    found["files to change a step"] = len(step)
    found["lines to change a step"] = sum(lines[path] for path in step)
    found["modules that mud_host imports"] = len(set(uses["mud_host"]) & set(sources))
    found["comparisons of the kind of analysis"] = sum(len(KINDS.findall(text[path])) for path in files)
    found["files with such comparisons"] = sum(bool(KINDS.search(text[path])) for path in files)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trees", nargs="*", type=pathlib.Path, default=[ROOT], metavar="TREE")
    trees = parser.parse_args().trees
    columns = [figures(tree.resolve()) for tree in trees]
    for name in dict.fromkeys(name for column in columns for name in column):
        print(f"{name:40}" + "".join(f"{column.get(name, 0):>10}" for column in columns))


if __name__ == "__main__":
    main()
