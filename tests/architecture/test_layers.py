# SPDX-License-Identifier: MIT
"""Layers of the whole tree, read from the `use` lines: which folder may use which, that a module hands on nothing of
another, and where foreign libraries live. Every rule is first shown a planted offence."""
import re

from checking import check
from test_architecture import code_lines, root, shown, sources, uses

# Folders, lowest first; a folder uses those above it in the list of its group and the groups named.
HOST = ("host/base", "host/time", "host/mesh", "host/element", "host/solver", "host/contact", "host/scene",
        "host/model", "host/terms", "host/setup", "host/run", "host/output", "host")
GROUPS = {
    "umat/core": (("umat/core/base", "umat/core/laws", "umat/core/options", "umat/core/rates", "umat/core/integration",
                   "umat/core/tangent", "umat/core"), ()),
    "umat/abi": (("umat/abi",), ("umat/core",)),
    "umat/lanes": (("umat/lanes",), ("umat/core", "umat/abi")),
    "umat/doors": (("umat/doors",), ("umat/include",)),
    "umat/tables": (("umat/tables",), ("umat/core",)),
    "umat/include": (("umat/include",), ()),
    "common": (("common",), ()),
    "materials": (("materials",), ("common", "umat/include")),
    "drivers": (("drivers",), ("common", "materials", "umat/include")),
    "host": (HOST, ("common", "materials", "umat/include")),
}
# The one file of each foreign library, and what betrays it.
FOREIGN = {
    "HDF5": ("hdf5_file", re.compile(r"\buse\s+(hdf5|h5\w+)\b|\bh5\w+_f\b", re.IGNORECASE)),
    "LAPACK": ("dense", re.compile(r"\bd(ge|sy|po|gt|gb|pt|tr|st|or)"
                                   r"(sv|svx|ev|evd|evr|evx|trf|trs|tri|qrf|sdd|svd|con|qr)\b", re.IGNORECASE)),
    "UMFPACK": ("sparse_factors", re.compile(r"\bumfpack_\w+", re.IGNORECASE)),
}


def place(folder):
    """(group, height in it) of a folder; drivers/src counts as drivers."""
    for group, (folders, _) in GROUPS.items():
        for height, name in enumerate(folders):
            if folder == name:
                return group, height
    parent = folder.rpartition("/")[0]
    if parent in GROUPS and len(GROUPS[parent][0]) == 1:
        return parent, 0
    return None, 0


def used(files, stem):
    """Modules of the project that a module uses."""
    return list(dict.fromkeys(module for _, module, _ in uses(files[stem][1]) if module in files and module != stem))


def wrong_layers(files):
    """Uses that go up, or into a group that is not to be seen. files: {module: (folder, text)}."""
    wrong = []
    for stem, (folder, text) in files.items():
        group, height = place(folder)
        if group is None:
            wrong.append(f"{folder}/{stem}: the folder {folder} has no layer")
            continue
        for number, module, _ in uses(text):
            if module not in files or module == stem:
                continue
            other, level = place(files[module][0])
            if other == group and level > height:
                wrong.append(f"{folder}/{stem}:{number}: uses {module} of {files[module][0]}, which is above it")
            elif other != group and other not in GROUPS[group][1]:
                wrong.append(f"{folder}/{stem}:{number}: uses {module} of {files[module][0]}, which {group} is not to "
                             f"see")
    return wrong


def cycles(files):
    """Folders that use each other, directly or through others."""
    below = {}
    for stem, (folder, _) in files.items():
        below.setdefault(folder, set())
        below[folder] |= {files[module][0] for module in used(files, stem)} - {folder}

    def reaches(start, goal, seen):
        return any(step == goal or step not in seen and not seen.add(step) and reaches(step, goal, seen)
                   for step in below.get(start, ()))
    return sorted(f"{folder} uses folders that use it" for folder in below if reaches(folder, folder, set()))


def handed_on(files):
    """Public names that a module has from another module of the project: users import from where a name is defined."""
    wrong = []
    for stem, (folder, text) in files.items():
        imported, public = {}, set()
        for _, line in code_lines(text):
            if (m := re.match(r"use\s+(\w+)\s*,\s*only\s*:(.*)", line, re.IGNORECASE)) and m[1].lower() in files:
                imported |= {name.strip().lower(): m[1] for name in re.split(", *", m[2]) if "=>" not in name}
            elif m := re.match(r"public\s*::(.*)", line, re.IGNORECASE):
                public |= {name.strip().lower() for name in re.split(", *", m[1])}
        wrong += [f"{folder}/{stem}: hands on {name} of {imported[name]}" for name in sorted(public & set(imported))]
    return wrong


def foreign(files):
    wrong = []
    for stem, (folder, text) in files.items():
        for library, (home, sign) in FOREIGN.items():
            if stem == home:
                continue
            wrong += [f"{folder}/{stem}:{number}: {library} lives in {home}.f90: {found[0]}"
                      for number, line in code_lines(text) if (found := sign.search(line))]
    return wrong


def strange_use(files):
    """A use of something that is neither of the project nor intrinsic nor one of the foreign libraries."""
    known = {"iso_fortran_env", "iso_c_binding", "ieee_arithmetic", "ieee_exceptions", "omp_lib", "hdf5", "h5lt"}
    return [f"{folder}/{stem}:{number}: uses {module}, which is not there" for stem, (folder, text) in files.items()
            for number, module, _ in uses(text) if module not in files and module not in known]


def misplaced(suites, folders):
    """Suites whose folder is not that of what they test: tests/X/... for X/..."""
    beside = {"architecture", "umat/contract"}   # of the whole tree, of the whole library
    return [f"{suite}: there is no folder {place}" for suite in suites
            if (place := suite.removeprefix("tests/").rpartition("/")[0]) not in folders | beside]


INSIDE = re.compile(r"\buse\s+mud_(params|state)\b|%\s*laws\b|\buse\s+path_tools\b.*\bparameters\b", re.IGNORECASE)
LAW_SUITES = 13   # Suites that may know them: those of one law or one procedure, in tests/umat/core and umat/lanes.


def inside(suites):
    """Suites that know what the core keeps parameters and state in. suites: {place below tests: text}."""
    return sorted(suite for suite, text in suites.items() if any(INSIDE.search(line) for _, line in code_lines(text)))


def of_the_contract(suites):
    return [f"{suite} knows the parameters or the state of the core: path_tools has both by name"
            for suite in inside(suites) if not suite.startswith(("umat/core/", "umat/lanes/"))]


AS_WRITTEN = {"scene_types", "namelists", "key_table", "key_schema"}   # What a run does not know.


# The loops of an update use the tangent; beside them whoever passes blocks on.
TANGENT, USERS = "umat/core/tangent", {"mud_point", "mud_lanes"}
BLOCKS = {"mud_blocks": {"mud_kernel", "mud_lane_kernel"}}


def tangents_met(files):
    """Uses of the tangent folder by others than the loops of an update, and blocks by others than the kernel: the value
    path is read without a tangent."""
    return [f"{folder}/{stem}: uses {module} of {TANGENT}" for stem, (folder, _) in files.items()
            for module in used(files, stem) if files[module][0] == TANGENT and folder != TANGENT
            and stem not in USERS | BLOCKS.get(module, set())]


def all_parameters(files):
    """Laws that take every parameter of a material: each has a type of its own, of which params_t is composed."""
    return [f"{folder}/{stem}:{number}: {line}" for stem, (folder, text) in files.items()
            if folder == "umat/core/laws" and stem != "mud_params"
            for number, line in code_lines(text) if re.search(r"\bparams_t\b", line, re.IGNORECASE)]


def seen_by(files, start):
    """Of AS_WRITTEN what a chain of uses from a module leads to."""
    seen, left = set(), [start]
    while left:
        module = left.pop()
        if module not in seen:
            seen.add(module)
            left += used(files, module)
    return sorted(f"{start} knows {module}" for module in seen & AS_WRITTEN)


def planted():
    """Every rule against an offence it must see, and against the nearest innocent tree."""
    def tree(*modules):
        return {name: (folder, text) for name, folder, text in modules}
    node, solve, core = ("node", "host/mesh", ""), ("solve", "host/solver", ""), ("mud_a", "umat/core/base", "")
    cases = [
        ("upward use", wrong_layers, [("node", "host/mesh", "use solve, only: x"), solve],
         [node, ("solve", "host/solver", "use node, only: x")]),
        ("the core from the host", wrong_layers, [("node", "host/mesh", "use mud_a, only: x"), core],
         [("mud_interface", "umat/include", ""), ("node", "host/mesh", "use mud_interface, only: x")]),
        ("the library's inside from a door", wrong_layers,
         [("mud_door", "umat/doors", "use mud_kernel, only: x"), ("mud_kernel", "umat/abi", "")],
         [("mud_door", "umat/doors", "use mud_interface, only: x"), ("mud_interface", "umat/include", "")]),
        ("the core from a door", wrong_layers, [("mud_door", "umat/doors", "use mud_a, only: x"), core],
         [("mud_door", "umat/doors", "use mud_vumat, only: x"), ("mud_vumat", "umat/doors", "")]),
        ("drivers from the host", wrong_layers, [("node", "host/mesh", "use case, only: x"),
                                                 ("case", "drivers/src", "")],
         [("node", "host/mesh", "use point, only: x"), ("point", "materials", "")]),
        ("host from the materials", wrong_layers, [("point", "materials", "use node, only: x"), node],
         [("point", "materials", "use texts, only: x"), ("texts", "common", "")]),
        ("materials from common", wrong_layers, [("texts", "common", "use point, only: x"), ("point", "materials", "")],
         [("texts", "common", "use kinds, only: x"), ("kinds", "common", "")]),
        ("upward use in the core", wrong_layers, [("mud_a", "umat/core/base", "use mud_b, only: x"),
                                                  ("mud_b", "umat/core/laws", "")],
         [core, ("mud_b", "umat/core/laws", "use mud_a, only: x")]),
        ("a folder without a layer", wrong_layers, [("new", "host/new", "")], [node]),
        ("a cycle of folders", cycles,
         [("a", "host/mesh", "use b, only: x"), ("b", "host/run", "use c, only: x"),
          ("c", "host/time", "use d, only: x"), ("d", "host/mesh", "")],
         [("a", "host/mesh", ""), ("b", "host/run", "use c, only: x"), ("c", "host/time", "use a, only: x")]),
        ("a name handed on", handed_on, [("a", "host/run", "use node, only: x\npublic :: y, x"), node],
         [("a", "host/run", "use node, only: x\npublic :: y"), node]),
        ("HDF5 elsewhere", foreign, [("node", "host/mesh", "use hdf5, only: h5fopen_f")],
         [("hdf5_file", "host/base", "use hdf5, only: x")]),
        ("LAPACK elsewhere", foreign, [("node", "host/mesh", "call dgesv(n)")], [("dense", "common", "call dgesv(n)")]),
        ("UMFPACK elsewhere", foreign, [("node", "host/mesh", "call umfpack_di_solve(n)")],
         [("node", "host/mesh", "call solve(n) ! umfpack_di_solve")]),
        ("a tangent on the value path", tangents_met,
         [("mud_trial", "umat/core/integration", "use mud_turn, only: x"), ("mud_turn", TANGENT, "")],
         [("mud_point", "umat/core", "use mud_turn, only: x"), ("mud_turn", TANGENT, "use mud_held, only: x"),
          ("mud_held", TANGENT, "use mud_trial, only: x"), ("mud_trial", "umat/core/integration", "")]),
        ("a law that takes all parameters", all_parameters,
         [("mud_flow", "umat/core/laws", "type(params_t), intent(in) :: par")],
         [("mud_flow", "umat/core/laws", "type(flow_t) :: par ! params_t"),
          ("mud_params", "umat/core/laws", "params_t"),
          ("mud_rates", "umat/core/rates", "type(params_t), intent(in) :: par")]),
        ("a module from nowhere", strange_use, [("node", "host/mesh", "use somewhere, only: x")],
         [("node", "host/mesh", "use, intrinsic :: iso_fortran_env, only: x")])]
    mirror = [] if (misplaced(["tests/unit/test_a.pf"], {"host/mesh"})
                    and not misplaced(["tests/host/mesh/test_a.pf"], {"host/mesh"})) else ["misplaced suites"]
    words = ("use mud_state, only: state_t", "use mud_params, only: params_t", "k = f(soil%laws)",
             "use path_tools, only: &\n   parameters")
    mirror += [f"the core seen by a suite of the contract: {text}" for text in words
               if not of_the_contract({"umat/abi/a": text}) or of_the_contract({"umat/core/laws/a": text})]
    if of_the_contract({"umat/contract/a": "use path_tools, only: soil_t, point_t ! use mud_state, only: x"}):
        mirror.append("a suite that asks for a soil and a point is blamed")
    return (mirror + [f"{name}: the offence is not seen" for name, rule, bad, _ in cases if not rule(tree(*bad))]
            + [f"{name}: innocent code is blamed" for name, rule, _, good in cases if rule(tree(*good))])


def read():
    """{module: (folder, text)} of every source."""
    found = {}
    for file in sources("common/*.f90", "materials/**/*.f90", "drivers/**/*.f90", "host/**/*.f90", "umat/core/**/*.f90",
                        "umat/abi/**/*.f90", "umat/lanes/*.f90", "umat/doors/*.f90", "umat/include/*.f90",
                        "umat/tables/*.f90"):
        found[file.stem] = (str(file.parent.relative_to(root)), file.read_text(encoding="utf-8"))
    return found


def test_folders_use_what_their_layer_may():
    files = read()
    have = {place(folder)[0] for folder, _ in files.values()}
    suites = {str(file.relative_to(root / "tests"))[:-len(".pf")]: file.read_text(encoding="utf-8")
              for file in sources("tests/umat/**/*.pf")}
    checks = [
        ("every rule sees its planted offence and nothing else", planted()),
        ("there are sources of every group to look at", sorted(set(GROUPS) - have)),
        ("every module uses only what its layer may see", wrong_layers(files)),
        ("no folders use each other in a circle", cycles(files)),
        ("the value path meets no tangent", tangents_met(files)),
        ("laws take their own parameters, not all of a material", all_parameters(files)),
        ("no module hands on a name of another", handed_on(files)),
        ("HDF5, LAPACK and UMFPACK live in one file each", foreign(files)),
        ("every module that is used is there", strange_use(files)),
        ("a run knows the model, and neither the scene as it is written nor its keys",
         seen_by(files, "time_stepping") or ([] if seen_by(files, "model_builder") else ["nothing is ever seen"])),
        ("suites of the contract ask for a soil and a point by name, never for what the core keeps them in",
         of_the_contract(suites)),
        (f"no more than {LAW_SUITES} suites, of single laws, know parameters or state of the core",
         inside(suites) if not 0 < len(inside(suites)) <= LAW_SUITES else []),
        ("tests mirror the tree", misplaced([str(file.relative_to(root)) for file in sources("tests/**/test_*")
                                          if file.parent.name != "__pycache__"],
                                         {str(folder.relative_to(root)) for folder in sources("*", "*/*", "*/*/*")
                                          if folder.is_dir() and folder.parts[len(root.parts)] != "tests"}))]
    for name, findings in checks:
        check(name, not findings, shown(findings))
