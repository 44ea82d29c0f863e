# SPDX-License-Identifier: MIT
"""Names of the Python package that programs of the repository use: each exists, also in programs that the check does
not run, because they need what it does not install."""

import ast
import importlib
import os
import sys
from types import ModuleType

from checking import build, check, needs_plain_library, root

needs_plain_library()
os.environ["MUD_LIBRARY_DIR"] = str(build)
sys.path[:0] = [str(root / "python")]
FOLDERS = ("benchmarks", "calibration", "clients", "docs", "host", "materials", "packaging", "scripts", "tests",
           "verification")


def is_of_package(module):
    return (module or "").split(".")[0] == "mud"


def part_of(module, name):
    """A name of a module, which may be a module itself; None: there is none."""
    try:
        return importlib.import_module(f"{module}.{name}")
    except ModuleNotFoundError:
        return getattr(importlib.import_module(module), name, None)


def modules_and_missing(tree):
    """Modules of the package by the names they have in a program, and imports that are not there."""
    modules, missing = {}, []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for one in filter(lambda one: is_of_package(one.name), node.names):
                whole = importlib.import_module(one.name)
                modules[one.asname or "mud"] = whole if one.asname else importlib.import_module("mud")
        elif isinstance(node, ast.ImportFrom) and not node.level and is_of_package(node.module):
            for one in node.names:
                part = part_of(node.module, one.name)
                missing += [f"{node.lineno}: {node.module}.{one.name}"] if part is None else []
                if isinstance(part, ModuleType):
                    modules[one.asname or one.name] = part
    return modules, missing


def unknown_names(text):
    tree = ast.parse(text)
    modules, missing = modules_and_missing(tree)
    arguments = {node.arg for node in ast.walk(tree) if isinstance(node, ast.arg)}   # they may hide a module
    used = [node for node in ast.walk(tree) if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)
            and node.value.id in set(modules) - arguments]
    return missing + [f"{node.lineno}: {node.value.id}.{node.attr}" for node in used
                      if not hasattr(modules[node.value.id], node.attr)]


def test_programs_use_names_that_exist():
    programs = [file for folder in FOLDERS for file in sorted((root / folder).rglob("*.py"))]
    for file in programs:
        found = unknown_names(file.read_text(encoding="utf-8"))
        check(f"{file.relative_to(root)}", not found, found)
    check("programs of clients are among them", any("clients" in file.parts for file in programs), FOLDERS)


def test_a_name_that_does_not_exist_is_found():
    found = unknown_names("import mud\nfrom mud import namelist, nothing\nfrom mud.errors import InputError\n"
                          "namelist.read_material(1)\nnamelist._gone(mud.absent)\n")
    wanted = ["2: mud.nothing", "5: namelist._gone", "5: mud.absent"]
    check("three of them", sorted(found) == sorted(wanted), found)
