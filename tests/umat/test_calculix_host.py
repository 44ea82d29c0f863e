# SPDX-License-Identifier: MIT
"""What CalculiX does to a UMAT, by a host that does the same: cuts, a restart that loses STATEV, finite strains."""
import os
import re
import subprocess

from checking import build, check, root, work

cache = dict(re.findall(r"^(\w+):\w+=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE))
plain = {name: value for name, value in os.environ.items() if not name.startswith("MUD_")}


def run(*words):
    return subprocess.run([str(word) for word in words], cwd=work, capture_output=True, text=True, env=plain)


def flags(language):
    kind = cache["CMAKE_BUILD_TYPE"].upper()
    return f"{cache.get(f'CMAKE_{language}_FLAGS', '')} {cache.get(f'CMAKE_{language}_FLAGS_{kind}', '')}".split()


def axial(done):
    """Axial stress that a run ends with; NaN where it ends otherwise."""
    found = re.match(r"axial (-[\d.]+)", done.stdout)
    return float(found.group(1)) if found and done.returncode == 0 else float("nan")


def told(done, *words):
    return done.stderr.count("\n") == 1 and all(word in done.stderr for word in words)


def test_the_host_compiles():
    done = run(cache["CMAKE_C_COMPILER"], *flags("C"), "-std=c11", "-Wall", "-Wextra", "-Werror", "-I",
               root / "umat/include", "-c", root / "tests/consumers/calculix_host.c", "-o", "calculix_host.o")
    if done.returncode == 0:
        done = run(
    cache["CMAKE_Fortran_COMPILER"],
    *flags("Fortran"),
    "calculix_host.o",
    build / "umat/libmud.a",
    "-lgomp",
    "-o",
     "calculix_host")
    check("the host compiles", done.returncode == 0, done.stdout + done.stderr)
    host = work / "calculix_host"

    # Increments that are cut come near the stress of small ones: what is left is the strain path between their ends,
    # which is 2e-3 where none is cut. A DDSDDE that a refusal leaves unwritten is singular.
    fine = run(host, "fine")
    done = run(host, "cut", 0)
    check("increments of 1 % pass uncut where substeps are not limited", "cuts 0" in done.stdout and done.stderr ==
          "" and abs(axial(done) - axial(fine)) <= 3e-3*abs(axial(fine)), done.stdout + done.stderr + fine.stdout)
    for substeps in (8, 20):
        done = run(host, "cut", substeps)
        cuts = int((re.search(r"cuts (\d+)", done.stdout) or [0, 0])[1])
        check(f"max_substeps = {substeps}: a host that factorises before it cuts comes to the end",
              cuts > 0 and abs(axial(done) - axial(fine)) <= 1e-3*abs(axial(fine)) and told(done, "too many substeps"),
              f"{done.stdout} {fine.stdout} {done.stderr}")

    # A STATEV of zeros in the midst of an analysis.
    done = run(host, "restart")
    check("a STATEV that a restart has lost is told once", abs(axial(done) - axial(fine)) > 1e-3*abs(axial(fine)) and
          told(done, "begins at TIME(2) = 0.010000,", "layout 0", "*RESTART", "increment 101:"),
          done.stdout + done.stderr)
    done = run(host, "added")
    check("so is an element that begins later, which may be right", told(done, "begins at TIME(2) = 1,",
                                                                         "right for an element that is activated now"),
          done.stderr)

    # Finite strains. Axes that do not turn: the stress is that of the sample that stands still, to the last digit.
    still = run(host, "nlgeom", "logarithmic", 0)
    check("finite strains without rotation: nothing is told", axial(still) < -100 and still.stderr == "",
          still.stdout + still.stderr)
    turned = run(host, "nlgeom", "logarithmic", 90)
    check("a sample that turns by 90 degrees has the stress of one that does not", turned.stdout == still.stdout,
          turned.stdout + still.stdout)
    check(
    "and that DROT is not read is told once",
    told(
        turned,
        "DROT is a rotation, but it is not read",
        "PNEWDT = -1"),
         turned.stderr)
    small = run(host, "nlgeom", "green", 0)
    check("Green's strain is told once, with the name that the material must have", axial(small) < -100 and
          abs(axial(small) - axial(still)) > 1e-3*abs(axial(still)) and told(small, "Green's strain", "@ABAQUSNL_"),
          small.stdout + small.stderr)
    done = run(host, "nlgeom", "green", 30)
    check("also of a sample that turns", told(done, "Green's strain"), done.stderr)
    done = run(host, "nlgeom", "linear", 0)
    check("small strains are told nothing", done.stdout == still.stdout and done.stderr == "",
          done.stdout + done.stderr)
