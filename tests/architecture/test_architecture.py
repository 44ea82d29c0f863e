# SPDX-License-Identifier: MIT
"""Layers and style that a compiler does not hold: reads the sources. Every rule is first shown a planted offence."""
import re

from checking import check, root

COLUMNS = 120
SHOWN = 30  # findings that are printed of one rule
LAYERS = ["base", "laws", "options", "rates", "integration", "tangent", "core"]  # folders of the core, lowest first

USE = re.compile(r"^\s*use\b\s*(,\s*(non_)?intrinsic\s*)?(::)?\s*(\w+)\s*(,\s*only\s*:)?", re.IGNORECASE)
HEAD = re.compile(r"^\s*((?:(?:\w+\s*\([^()]*\)|[\w*]+)\s+)*?)(function|subroutine)\s+(\w+)\s*\(", re.IGNORECASE)
FRAGMENT = re.compile(r"(what|of|the same|that|how|which|whose|its|their|those|likewise)\b", re.IGNORECASE)
# Folders whose comments are sentences and noun phrases that stand alone.
SPOKEN = ("umat/*", "umat/core/*", "common", "materials", "drivers/src", *(f"host/{name}" for name in (
    "base", "time", "mesh", "element", "contact", "solver", "run", "output")), "host")
IMPURE = re.compile(r"^\s*(?:if\s*\(.*\)\s*)?(print\b|write\s*\(|read\s*\(|open\s*\(|close\s*\(|flush\b|stop\b|"
                    r"error\s+stop\b|call\s+(?:execute_command_line|exit|abort)\b|allocate\s*\(|save\b)", re.IGNORECASE)
DECLARATION = re.compile(r"^\s*(integer|real|logical|character|complex|type\s*\(|class\s*\()[^!]*::", re.IGNORECASE)


def code_lines(text):
    """(line number, statement) without comments and with continuations joined; strings are emptied."""
    statement, start = "", 0
    for number, line in enumerate(text.splitlines(), 1):
        line = re.sub(r"'[^']*'|\"[^\"]*\"", "''", line)
        line = line.split("!", 1)[0].rstrip()
        if not line.strip():
            continue
        start = start or number
        statement += " " + line.strip().lstrip("&").strip() if statement else line.strip()
        if statement.endswith("&"):
            statement = statement[:-1].rstrip()
            continue
        yield start, statement
        statement, start = "", 0


def uses(text):
    return [(n, m[4].lower(), bool(m[5])) for n, line in code_lines(text) if (m := USE.match(line))]


def use_without_only(text):
    return [f"{n}: use {module} without only" for n, module, only in uses(text) if not only]


def idle_imports(text):
    """Names that a use statement brings and no other statement has. Two stand behind every @assert of pFUnit."""
    brought, had = [], {"anyexceptions", "sourcelocation"}
    for n, line in code_lines(text):
        if USE.match(line):
            brought += [(n, name.split("=>")[0].strip()) for name in re.split(", *", line.rpartition(":")[2])]
        else:
            had |= set(re.findall(r"\b[a-z]\w*|(?<=\d_)\w+", line.lower()))
    return [f"{n}: {name} is imported and not used" for n, name in brought
            if re.fullmatch(r"\w+", name) and name.lower() not in had]


def upward_use(text, name, order, allowed_beside=frozenset()):
    """Modules of the library that `name` may not see: those at or above its own place."""
    return [f"{n}: {name} uses {module}, which is not below it" for n, module, _ in uses(text)
            if module.startswith("mud_") and module not in order[:order.index(name)] and module not in allowed_beside]


def inner_use(text, inner):
    return [f"{n}: uses {module}, which is the library's own" for n, module, _ in uses(text) if module in inner]


def not_pure(text):
    """Procedures that are not pure, and statements that would make them so."""
    wrong = []
    for n, line in code_lines(text):
        head = HEAD.match(line)
        if head and not line.lower().startswith("end") and not {"pure", "elemental"} & set(head[1].lower().split()):
            wrong.append(f"{n}: {head[3]} is not pure")
        if IMPURE.match(line):
            wrong.append(f"{n}: {line[:40]}")
        if re.search(r"\b(allocatable|save)\b", line.split("::")[0], re.IGNORECASE) and DECLARATION.match(line):
            wrong.append(f"{n}: {line[:40]}")
    return wrong


def module_variables(text):
    """Declarations before `contains`, outside a type and an interface, that are no parameters."""
    wrong, inside = [], False
    for n, line in code_lines(text):
        lower = line.lower()
        if lower == "contains" and not inside:
            break
        if re.match(r"(type\b(?!\s*\()|interface\b)", lower):
            inside = True
        elif re.match(r"end\s*(type|interface)", lower):
            inside = False
        elif not inside and DECLARATION.match(line) and "parameter" not in lower.split("::")[0]:
            wrong.append(f"{n}: {line[:60]}")
    return wrong


def remembered(files):
    """The exception from the rule above: mud_once's variable decides on sentences and threads alone."""
    text = next((file.read_text(encoding="utf-8") for file in files if file.stem == "mud_once"), "")
    wrong = [] if len(module_variables(text)) == 1 else [f"mud_once: module variables {module_variables(text)}"]
    # Whether a sentence is new, how many increments the last sentence of a process counts, and which process used
    # threads: nothing else.
    bodies = re.findall(r"(?:function|subroutine) (first_time|report_at_exit|write_last_sentence|may_use_threads)\b"
                        r"(.*?)end (?:function|subroutine) \1$", text, re.DOTALL | re.MULTILINE)
    uses_of = [len(re.findall(r"\btold\(", part)) for part in (text, "".join(body for _, body in bodies))]
    return wrong + ([] if uses_of[0] == uses_of[1] + 1 else ["mud_once: told is used outside sentences and threads"])


def not_strict(text):
    """Modules and programs that leave out implicit none; modules that leave out private."""
    wrong = []
    for unit in re.finditer(r"^(module|program) (\w+)$.*?^end \1 \2", text, re.MULTILINE | re.DOTALL | re.IGNORECASE):
        if not re.search(r"^ +implicit none \(type, external\)$", unit[0], re.MULTILINE):
            wrong.append(f"{unit[2]}: no `implicit none (type, external)`")
        if unit[1].lower() == "module" and not re.search(r"^ +private$", unit[0], re.MULTILINE):
            wrong.append(f"{unit[2]}: no `private`")
    return wrong


def wrong_name(text, stem):
    names = re.findall(r"^(?:module|program) (\w+)$", text, re.MULTILINE)
    return [] if names == [stem] else [f"units {names} in a file called {stem}"]


def long_lines(text):
    """An assertion must stand on one line, so it may be longer."""
    return [f"{n}: {len(line)} columns" for n, line in enumerate(text.splitlines(), 1)
            if len(line) > COLUMNS and not line.lstrip().startswith("@assert")]


def fragments(text):
    """Comments !> and !< that begin in the middle of a sentence, which only what stands around them would complete."""
    begun, wrong = "", []
    for n, line in enumerate(text.splitlines(), 1):
        found = re.match(r"\s*(!>)\s*(.*)", line) or re.search(r"(!<)\s*(.*)", line)
        alone = line.lstrip().startswith("!")
        if found and not (alone and found[1] == begun) and FRAGMENT.match(found[2]):
            wrong.append(f"{n}: {found[2][:60]}")
        begun = found[1] if found else ""
    return wrong


def idle_tests(text):
    """Tests of a .pf file without an assertion, in themselves or in a procedure of the file that they call."""
    bodies = dict(re.findall(r"^ *(?:recursive )?subroutine (\w+)\(.*?$(.*?)^ *end subroutine \1", text,
                             re.MULTILINE | re.DOTALL))

    def asserts(name, seen=()):
        body = bodies.get(name, "")
        return "@assert" in body or any(asserts(called, (*seen, name)) for called in re.findall(r"\bcall (\w+)", body)
                                        if called not in (*seen, name))

    return [f"{name} asserts nothing" for name in re.findall(r"^ *@test\s*\n *subroutine (\w+)", text, re.MULTILINE)
            if not asserts(name)]


def sources(*patterns):
    return [file for pattern in patterns for file in sorted(root.glob(pattern))]


def cmake_order():
    """Modules of the library in the order of umat/CMakeLists.txt: (core, abi)."""
    text = (root / "umat/CMakeLists.txt").read_text(encoding="utf-8")
    return [["mud_" + name.rpartition("/")[2] for name in re.search(rf"set\({list_name}\s+([^)]*)\)", text)[1].split()]
            for list_name in ("core", "abi")]


def layer_order(core_files, core):
    """The modules of a lower folder stand before those of a higher one in the CMake list."""
    folder = {file.stem: file.parent.name for file in core_files}
    order = [LAYERS.index(folder[name]) for name in core if name in folder]
    return [f"{core[i + 1]} ({LAYERS[b]}) stands after {core[i]} ({LAYERS[a]})"
            for i, (a, b) in enumerate(zip(order, order[1:])) if b < a]


def planted_offences():
    """Every rule against an offence it must see, and against the nearest innocent text."""
    module = "module mud_x\n   implicit none (type, external)\n   private\ncontains\nend module mud_x\n"
    order = ["mud_a", "mud_b", "mud_c"]
    cases = [
        ("use without only", use_without_only, "use mud_a", "use mud_a, only: b"),
        ("continued use", use_without_only, "use, intrinsic :: iso_x", "use, intrinsic :: iso_x, only: &\n  c"),
        ("idle import", idle_imports, "use a, only: b, &\n   c\nd = b ! c",
         "use, intrinsic :: a, only: b, c => d\ne = c(1.0_B)"),
        ("upward use", lambda t: upward_use(t, "mud_b", order), "use mud_c, only: x", "use mud_a, only: x"),
        ("inner use", lambda t: inner_use(t, {"mud_a"}), "use mud_a, only: x", "use mud_interface, only: x"),
        ("impure function", not_pure, "real(wp) function f(x)", "pure real(wp) function f(x)"),
        ("impure subroutine", not_pure, "subroutine f(x)", "pure subroutine f(x) ! end"),
        ("print", not_pure, "print '(a)', 'x'", "x = 1 ! print"),
        ("write after if", not_pure, "if (a(1) > 0) write (*, *) x", "if (a(1) > 0) x = 1"),
        ("stop", not_pure, "error stop 'x'", "stopped = .true."),
        ("saved local", not_pure, "integer, save :: n", "integer :: n"),
        ("allocatable", not_pure, "real(wp), allocatable :: a(:)", "real(wp) :: allocatable_size"),
        ("module variable", module_variables, "integer :: n = 0", "integer, parameter :: n = 0"),
        ("module variable after a type", module_variables, "type :: t\nreal :: a\nend type t\ntype(t) :: b",
         "type :: t\nreal :: a\nend type t\ncontains\nreal :: b"),
        ("no private", not_strict, module.replace("   private\n", ""), module),
        ("implicit typing", not_strict, module.replace(" (type, external)", ""), module),
        ("file name", lambda t: wrong_name(t, "mud_x"), module.replace("mud_x", "mud_y"), module),
        ("long line", long_lines, "x" * (COLUMNS + 1), "x" * COLUMNS),
        ("fragment of a comment", fragments, "x = 1   !< Of a plate [m].", "x = 1   !< Mass, that\n   !< of a plate."),
        ("fragment above", fragments, "!> What a step did.\ntype :: t", "!> Log of a step,\n!> of what it did."),
        ("idle test", idle_tests, "@test\nsubroutine a()\nx = 1\nend subroutine a\n",
         "@test\nsubroutine a()\ncall b(1)\nend subroutine a\nsubroutine b(x)\n@assertTrue(x)\nend subroutine b\n")]
    return ([f"{name}: the offence is not seen" for name, rule, bad, _ in cases if not rule(bad)]
            + [f"{name}: innocent text is blamed" for name, rule, _, good in cases if rule(good)])


def shown(findings):
    """Findings a line each, the first ones."""
    more = [f"and {len(findings) - SHOWN} more"] if len(findings) > SHOWN else []
    return "".join("\n  " + line for line in [*findings[:SHOWN], *more])


def test_the_sources_keep_the_rules():
    core, abi = cmake_order()
    inside = core + abi
    core_files, abi_files, doors = (sources(f"umat/{folder}/*.f90") for folder in ("core/**", "abi", "doors"))
    library = core_files + abi_files + doors
    clients = sources("common/**/*.f90", "materials/**/*.f90", "host/**/*.f90", "drivers/**/*.f90")
    # UMATs of other laws are external subroutines, as other people write them.
    helpers = [file for file in sources("tests/**/*.f90") if file.parent.name != "umats"]
    suites = sources("tests/**/*.pf")
    # mud_interface.f90 defines one module per file too; the helper that includes it has none of its own.
    others = [f for f in sources("umat/include/*", "tests/**/*.[ch]", "tests/**/*.py")
              if f.name != "mutations.py"]  # quotes lines of the sources
    modules = [f for f in library + clients + helpers + sources("umat/include/*.f90") if f.stem != "abi_mud_interface"]

    def over(files, rule, needs_name=False):
        found = []
        for file in files:
            text = file.read_text(encoding="utf-8")
            wrong = rule(text, file.stem) if needs_name else rule(text)
            found += [f"{file.relative_to(root)}:{line}" for line in wrong]
        return found

    checks = [
        ("every rule sees its planted offence and nothing else", planted_offences()),
        ("the sources of the library are those of umat/CMakeLists.txt",
         sorted(set(inside) ^ {file.stem for file in core_files + abi_files})),
        ("there are drivers, helpers and suites to look at", [] if clients and helpers and suites else ["none found"]),
        ("the layers of the core stand one after the other", layer_order(core_files, core)),
        ("core uses only what is below", over(core_files, lambda t, n: upward_use(t, n, core), True)),
        ("abi uses the core and what is below in abi", over(abi_files, lambda t, n: upward_use(t, n, inside), True)),
        ("doors, common, materials, drivers and host see mud_interface only",
         over(doors + clients, lambda t: inner_use(t, set(inside)))),
        ("the host's view of the library uses nothing of it",
         over(sources("umat/include/*.f90"), lambda t: inner_use(t, set(inside)))),
        ("every use says only", over(library + clients + helpers + suites, use_without_only)),
        ("every import is used", over(library + clients + helpers + suites, idle_imports)),
        ("core procedures are pure", over(core_files, not_pure)),
        ("core and abi have no module variables, but for what was said already",
         over([file for file in library if file.stem != "mud_once"], module_variables)),
        ("what was said already is one variable, which sentences alone read", remembered(abi_files)),
        ("every unit is strict", over(modules + suites, not_strict)),
        ("a file and its module share one name", over(modules + suites, wrong_name, True)),
        (f"no line has more than {COLUMNS} columns",
         over(library + clients + helpers + suites + others, long_lines)),
        ("comments are no fragments", over(sources(*(f"{folder}/*.f90" for folder in SPOKEN)), fragments)),
        ("every test asserts something", over(suites, idle_tests))]
    for name, findings in checks:
        check(name, not findings, shown(findings))
