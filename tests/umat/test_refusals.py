# SPDX-License-Identifier: MIT
"""Refusals of umat_ are heard, once a process, by hosts like Kratos, CalculiX, incrementalDriver and Abaqus."""
import os
import re
import subprocess

from checking import build, check, root, work

cache = dict(re.findall(r"^(\w+):\w+=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE))
plain = {name: value for name, value in os.environ.items() if not name.startswith("MUD_")}
# p' and q [kPa] at 1 % axial strain, undrained e 0.735 p' 100 (verification/material/reference), their tolerance.
KNOWN, WITHIN = (147.354, 219.588), 1e-4
SENTENCE = re.compile(r"MUD: umat_ refused the increment at (.+?), status (-?\d+): (.+) \(said once a process; "
                      r"MUD_MESSAGES=off silences\)")


# What a process says when it ends, after increments that were answered with NaN.
LAST_WORD = re.compile(r"MUD: at the end of this process: refused increments whose stress was set to NaN: (\d+)\. "
                       r"Unless the host has repeated them .+ are no results")


def run(*words, **environment):
    return subprocess.run([str(word) for word in words], cwd=work, capture_output=True, text=True,
                          env={**plain, **environment})


def flags(language):
    kind = cache["CMAKE_BUILD_TYPE"].upper()
    return f"{cache.get(f'CMAKE_{language}_FLAGS', '')} {cache.get(f'CMAKE_{language}_FLAGS_{kind}', '')}".split()


def sentences(done):
    """(place, status, text) of every line on standard error but the last word; None where a line is something else."""
    return [found.groups() if (found := SENTENCE.fullmatch(line)) else None for line in done.stderr.splitlines()
            if not LAST_WORD.fullmatch(line)]


def known(done):
    found = re.fullmatch(r"p' ([-\d.]+) kPa, q ([-\d.]+) kPa\n", done.stdout)
    return bool(found) and all(abs(float(value) - is_) <= WITHIN*is_ for value, is_ in zip(found.groups(), KNOWN))


def linked(*options):
    """Whether the program has the umat_ of the library."""
    made = run(cache["CMAKE_Fortran_COMPILER"], *flags("Fortran"), *options, "main.o", build / "umat/libmud.a",
               "solver.a", "-lgomp", "-o", "solver")
    return made.returncode == 0 and "__mud_" in run("nm", "solver").stdout


def test_the_host_compiles():
    done = run(cache["CMAKE_C_COMPILER"], *flags("C"), "-std=c11", "-Wall", "-Wextra", "-Werror", "-I",
               root / "umat/include", "-c", root / "tests/consumers/refused_host.c", "-o", "refused_host.o")
    if done.returncode == 0:
        done = run(cache["CMAKE_Fortran_COMPILER"], *flags("Fortran"), "refused_host.o",
                   build / "umat/libmud.a", "-lgomp", "-pthread", "-o", "refused_host")
    check("the host compiles", done.returncode == 0, done.stdout + done.stderr)
    host = work / "refused_host"

    # Nothing to refuse, nothing said, and the known answer, whatever the host leaves unset.
    for name in ("kratos", "incremental_driver"):
        done = run(host, name)
        check(f"{name} meets the known answer in silence", known(done) and done.stderr == "", done.stdout + done.stderr)
    done = run(host, "abaqus", 6)
    check("abaqus meets the known answer in silence", known(done) and done.stderr == "", done.stdout + done.stderr)

    # CalculiX: fields of 37.2, 74.4 and so on that it never set are not taken for a suction, and that is said once.
    done = run(host, "calculix")
    check("calculix meets the known answer", known(done), done.stdout + done.stderr)
    check("calculix is told that PREDEF is not read", done.stderr.count("\n") == 1 and
          "they are not read" in done.stderr and "element 12, point 3, step 2, increment 1:" in done.stderr and
          "37.200000" in done.stderr, done.stderr)

    # A host without PNEWDT must not go on: NaN in STRESS never converges. Left as it was, the old stress does.
    done = run(host, "kratos_hard")
    told = sentences(done)
    check("kratos stops where an increment is refused", "step 50 did not converge" in done.stdout, done.stdout)
    check("and says once what, where and what to do", len(told) == 1 and told[0] and told[0][1] == "6" and
          "element 0, point 0, step 2, increment" in told[0][0] and
          all(words in told[0][2] for words in ("strain increment 11 is -3, allowed -1 to 1", "cut it",
                                                "PNEWDT is NULL, so STRESS is NaN")), done.stderr)
    last = done.stderr.splitlines()[-1:]
    check("and its last word is how many increments were answered with NaN", last and (
        found := LAST_WORD.fullmatch(last[0])) and found[1] == "15", done.stderr)

    # Every strain prescribed: no equation sees the NaN and no iteration diverges.
    done = run(host, "kratos_prescribed")
    last = LAST_WORD.fullmatch(done.stderr.splitlines()[-1])
    check("a host without unknowns ends like a good one, and hears of the NaN at its end", done.returncode == 0 and
          "nan" in done.stdout and done.stderr.count("\n") == 2 and last and last[1] == "100",
          done.stdout + done.stderr)
    done = run(host, "kratos_hard", MUD_NO_PNEWDT="keep")
    check("MUD_NO_PNEWDT=keep leaves the old stress, on which the host converges", re.match(r"p' ", done.stdout) and
          not known(done) and "what it computes from here is wrong" in done.stderr, done.stdout + done.stderr)
    done = run(host, "kratos_hard", MUD_NO_PNEWDT="stop")
    check("any other value of it does not", "did not converge" in done.stdout, done.stdout)

    table = subprocess.run([build / "drivers/mud_describe", "statev"], capture_output=True, text=True).stdout
    NEEDED = f"given 60, needed {int(re.search(r'^[|] ([0-9]+) [|] `turns`', table, re.MULTILINE).group(1)) - 1}"

    # The first thing that goes wrong: too few STATEV, an NTENS of another element.
    for name, number, status, words in (("kratos", 60, "-2", (NEEDED,)),
                                        ("calculix", 60, "-2", (NEEDED,)),
                                        ("abaqus", 3, "-3", ("NTENS is 3", "6 (solid) or 4"))):
        done = run(host, name, number)
        told = sentences(done)
        check(f"{name} receives the message of {number}", len(told) == 1 and told[0] and told[0][1] == status and
              all(word in told[0][2] for word in words), done.stderr)
        check(f"{name} stops with {number}", done.returncode == 1 and re.search("step 1 (did not converge|cut by 0.1)",
                                                                                done.stdout), done.stdout)

    done = run(host, "null")
    told = sentences(done)
    check("a NULL that must be given is named, each once, where the host names no place", done.returncode == 0 and
          [found and (found[0], found[1], found[2].rpartition(": ")[2]) for found in told] ==
          [("a place that the host does not name", "-7", name) for name in ("DSTRAN", "NPROPS")], done.stderr)

    # PREDEF of the end of the increment, growing by 1, 2 and so on: the suction runs to PREDEF + DPRED = 20 + 55 + 10
    # all the same, and it is said where STATEV first holds something else, 22 = 21 + 1.
    done = run(host, "contradiction")
    check("a PREDEF that contradicts STATEV is obeyed from the stored suction", done.stdout == "suction 85.000000\n",
          done.stdout)
    check("and that is said once", done.stderr.count("\n") == 1 and "PREDEF(1) is 23 " in done.stderr and
          "STATEV holds 22 " in done.stderr and "PREDEF(1) + DPRED(1) = 25" in done.stderr and
          "increment 2:" in done.stderr, done.stderr)

    # PROPS in mixed units: the warning of mud_validate_props, which no host of a UMAT calls.
    done = run(host, "units")
    check("PROPS in mixed units draw a warning", done.returncode == 0 and done.stderr.count("\n") == 1 and
          "do all PROPS have the unit of stress of p_atm?" in done.stderr, f"{done.returncode} {done.stderr}")

    # A mean effective stress below zero, where the guard that prevents it is off: said once, of the first point.
    done = run(host, "tension", 0)
    check("without the tension cut-off p' falls below zero, and that is said once", done.stdout.startswith("p' -") and
          done.stderr.count("\n") == 1 and "remark of umat_ at element 12, point 1, step 2" in done.stderr and
          "p' is -" in done.stderr and "set cutoff = 1" in done.stderr, done.stdout + done.stderr)
    done = run(host, "tension", 1)
    check("with the tension cut-off it stays above, in silence", done.stdout.startswith("p' 0.1") and done.stderr == "",
          done.stdout + done.stderr)

    # Once a process: eight threads with a thousand failures of two kinds each; a forked child knows what was said.
    done = run(host, "threads")
    told = sentences(done)
    check("of eight threads one says it", done.stdout == "8 threads\n" and None not in told and
          sorted(found[1] for found in told) == ["-2", "6"], done.stderr)
    done = run(host, "fork")
    told = sentences(done)
    check("a forked process says what is new", done.returncode == 0 and
          [found and found[1] for found in told] == ["6", "-2"], done.stderr)
    for name in ("kratos_hard", "threads", "contradiction", "calculix"):
        done = run(host, name, MUD_MESSAGES="off")
        check(f"MUD_MESSAGES=off silences {name}", done.stderr == "" and done.stdout != "", done.stderr)
    done = run(host, "kratos_hard", MUD_MESSAGES="on")
    check("any other value of it does not", done.stderr.count("\n") == 2, done.stderr)


def test_a_solver_with_a_umat_of_its_own_compiles():
    # A solver in an archive that has a umat_ of its own, as CalculiX does:
    # nothing of libmud.a is taken unless asked for.
    (work / "solver.c").write_text("void umat_(void *);\nvoid solve(void) { double s[6] = {0}; umat_(s); }\n",
                                   encoding="utf-8")
    (
    work /
    "own.c").write_text(
        "#include <stdio.h>\nvoid umat_(void *s) { (void)s; puts(\"the solver's own umat_\"); }\n",
         encoding="utf-8")
    (work / "main.c").write_text("void solve(void);\nint main(void) { solve(); return 0; }\n", encoding="utf-8")
    done = run(cache["CMAKE_C_COMPILER"], *flags("C"), "-c", "solver.c", "own.c", "main.c")
    if done.returncode == 0:
        done = run("ar", "rcs", "solver.a", "solver.o", "own.o")
    check("a solver with a umat_ of its own compiles", done.returncode == 0, done.stdout + done.stderr)


def test_the_order_of_the_readme_libmud_a_before_the_solvers_archive():
    check("the order of the README, libmud.a before the solver's archive, keeps the solver's umat_", not linked())
    check("-Wl,-u,umat_ takes that of the library", linked("-Wl,-u,umat_"))
