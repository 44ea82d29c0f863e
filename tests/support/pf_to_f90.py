# SPDX-License-Identifier: MIT
"""Turn one pFUnit .pf file into Fortran for the runner in funit.f90.

Understood, each alone on one physical line, are @test, @assertEqual(...), @assertTrue(...) and
@assertFalse(...): the part of pFUnit that both processors read alike. Anything else that starts
with @ is an error, so that no test can slip through unread.
"""
import pathlib
import re
import sys

ASSERTION = re.compile(r"\s*@assert(Equal|True|False)\s*\((.*\S.*)\)\s*$", re.IGNORECASE)
TEST = re.compile(r"\s*@test\s*$", re.IGNORECASE)
SUBROUTINE = re.compile(r"\s*subroutine\s+(\w+)\s*\(\s*\)\s*(!.*)?$", re.IGNORECASE)
MODULE = re.compile(r"\s*module\s+(\w+)\s*(!.*)?$", re.IGNORECASE)
COMMENT = re.compile(r"\s*(!.*)?$")


def process(source):
    """The Fortran text; raises ValueError((line number, what is wrong))."""
    name = source.stem
    tests, out, module, waiting = [], [f'#line 1 "{source}"'], None, 0
    for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
        if COMMENT.match(line):
            out.append(line)
            continue
        if waiting:
            found = SUBROUTINE.match(line)
            if not found:
                raise ValueError(waiting, "@test must be followed by `subroutine NAME()`")
            if found[1].lower() in (test.lower() for test in tests):
                raise ValueError(number, f"the test {found[1]} exists twice")
            tests.append(found[1])
            waiting = 0
        if module is None and (found := MODULE.match(line)):
            module = found[1]
        if TEST.match(line):
            waiting = number
            out.append("!" + line)
        elif found := ASSERTION.match(line):
            out += [f"      call assert{found[1]}({found[2]}, &",
                    f"         location=SourceLocation('{source.name}', {number}))",
                    "      if (anyExceptions()) return",
                    f'#line {number + 1} "{source}"']
        elif line.lstrip().startswith("@"):
            raise ValueError(number, f"not understood (one line each of @test, @assertEqual(...), "
                                     f"@assertTrue(...), @assertFalse(...)): {line.strip()}")
        else:
            out.append(line)
    if waiting:
        raise ValueError(waiting, "@test without a subroutine")
    if module is None or module.lower() != name.lower():
        raise ValueError(1, f"the module must be called {name}, as the file is (found: {module})")
    if not tests:
        raise ValueError(1, "no @test in this file")
    out += [f"program run_{name}", "   use funit, only: begin_test, end_test, end_suite"]
    out += [f"   use {module}, only: {test}" for test in tests]
    out.append("   implicit none (type, external)")
    for test in tests:
        out += [f"   if (begin_test('{test}')) then", f"      call {test}()", "      call end_test()", "   end if"]
    out += ["   call end_suite()", f"end program run_{name}", ""]
    return "\n".join(out)


if __name__ == "__main__":
    path = pathlib.Path(sys.argv[1])
    try:
        text = process(path)
    except ValueError as problem:
        sys.exit("{}:{}: {}".format(path, *problem.args))
    pathlib.Path(sys.argv[2]).write_text(text, encoding="utf-8")
