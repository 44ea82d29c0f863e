# SPDX-License-Identifier: MIT
"""Failed increments: saved by every interface as a case of mud_triax, which repeats them bit by bit."""
import functools
import os
import re
import resource
import signal
import subprocess

import pytest
from checking import build, check, root, work

cache = dict(re.findall(r"^(\w+):\w+=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE))
triax = build / "drivers/mud_triax"
SAVED = "mud_failed_too_many_substeps.nml"  # the one name that umat_ has for this failure
quiet = {**{name: value for name, value in os.environ.items() if name != "MUD_SAVE_FAILED"}, "MUD_MESSAGES": "off"}


def run(*words, folder=work, **more):
    return subprocess.run([str(word) for word in words], cwd=folder, capture_output=True, text=True,
                          **{"env": quiet, **more})


def flags(language):
    kind = cache["CMAKE_BUILD_TYPE"].upper()
    return f"{cache.get(f'CMAKE_{language}_FLAGS', '')} {cache.get(f'CMAKE_{language}_FLAGS_{kind}', '')}".split()


@functools.cache
def compiled():
    """tests/consumers/failing_host.c against the library of this build."""
    done = run(cache["CMAKE_C_COMPILER"], *flags("C"), "-std=c11", "-Wall", "-Wextra", "-Werror", "-I",
               root / "umat/include", "-c", root / "tests/consumers/failing_host.c", "-o", "failing_host.o")
    if done.returncode == 0:
        done = run(cache["CMAKE_Fortran_COMPILER"], *flags("Fortran"), "failing_host.o", build / "umat/libmud.a",
                   "-lgomp", "-pthread", "-o", "failing_host")
    check("the host compiles", done.returncode == 0, done.stdout + done.stderr)
    return work / "failing_host"


def folder(name):
    path = work / name
    path.mkdir()
    return path


def lines(path):
    """Without the remark on where it comes from."""
    return [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("   title")]


def repeated(path, copy):
    """mud_triax runs a saved increment, and saves it again where it fails."""
    return run(triax, path, "--output", "repeated.csv", "--save-failed", copy)


saved = work / "saved.nml"
REFUSED = {"bad_props_h_0": "h_0", "bad_props_n_b": "n_b", "bad_input_stress_11": "stress",
           "increment_too_large_strain_13": "strain increment 13", "bad_state_memory_22": "state_variables",
           "bad_void_ratio": "void_ratio = 6"}


# Where nothing can be written: -10, a reason, and no remains.
def small_disk():
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2048, 2048))  # the file has about 5 kB


@pytest.fixture(scope="module")
def text():
    """An increment that the C interface has saved."""
    done = run(compiled(), "api", saved)
    assert done.stdout.split()[:1] == ["0"], done.stdout + done.stderr
    return saved.read_text(encoding="utf-8")


def test_umat_writes_nothing_unasked(text):
    heard = {name: value for name, value in quiet.items() if name != "MUD_MESSAGES"}

    host = compiled()
    files_before = sorted(work.iterdir())

    # By default nothing is written, however often umat_ fails. Status 2 is MUD_TOO_MANY_SUBSTEPS.
    done = run(host, "umat", 3)
    check("umat_ writes nothing unasked", done.stdout.strip() == "2" and done.stderr == "" and
          sorted(work.iterdir()) == files_before, done.stdout + done.stderr)

    check("the C interface saves", saved.exists())
    numbers = dict(re.findall(r"^   (\w+) = (\S+)", text, re.MULTILINE))
    stress_33 = re.search(r"(\S+) +! 33$", text, re.MULTILINE)[1]
    check("the numbers are those of the host, compression positive", (float(numbers["d_suction"]),
          float(numbers["change_4"]), float(stress_33)) == (-0.375, -1e-3/3, 120.0), numbers)
    done = repeated(saved, "copy.nml")
    check("the failure is that of the host", done.returncode == 0 and "the first refused update: too many substeps" in
          done.stdout, done.stdout + done.stderr)

    # Were a bit of any number lost, or did the increment end in another way, the copy would differ.
    check("the repetition has every bit", lines(work / "copy.nml") == lines(saved), "the copy differs")
    check("cutting helps", re.search(r"1 increments, [1-9]\d* cuts", done.stdout), done.stdout)

    # By umat_, for a folder named in the environment: the same file but for the remark, and one of each failure.
    asked = folder("asked")
    done = run(host, "umat", 25, env={**quiet, "MUD_SAVE_FAILED": str(asked)})
    names = [path.name for path in sorted(asked.iterdir())]
    check("umat_ saves one file of a failure that comes again", done.stdout.strip() == "2" and names == [SAVED],
          f"{done.stdout} {names}")
    check("umat_ saves what the C interface does", names and all(
        lines(path) == lines(saved) for path in asked.iterdir()))
    done = repeated(asked / SAVED, "umat_copy.nml")
    check("umat_'s file repeats and names the place of the first", lines(work / "umat_copy.nml") == lines(saved) and
          "element 1, point 4, step 1, increment 9" in (asked / SAVED).read_text(), done.stdout + done.stderr)
    done = run(host, "several", env={**quiet, "MUD_SAVE_FAILED": str(asked)})
    names = sorted(path.name for path in asked.iterdir())
    check("umat_ saves each distinct failure under its name", done.stdout.strip() == "-8" and names == sorted([
          SAVED, *(f"mud_failed_{name}.nml" for name in REFUSED)]), f"{done.stdout} {names}")

    # An argument that no increment may have is refused, by its name: by the reader, or by the law.
    for name, word in REFUSED.items():
        done = repeated(asked / f"mud_failed_{name}.nml", f"again_{name}.nml")
        check(f"mud_triax names what is wrong: {name}", word in done.stdout + done.stderr,
              f"{done.returncode} {done.stdout} {done.stderr}")
    (asked / SAVED).write_text("precious", encoding="utf-8")
    run(host, "umat", 2, env={**quiet, "MUD_SAVE_FAILED": str(asked)})
    check("umat_ overwrites nothing", (asked / SAVED).read_text(encoding="utf-8") == "precious")
    for name, value in (("an absent folder", str(work / "absent")), ("an endless name", "x"*5000)):
        before = sorted(work.iterdir())
        done = run(host, "umat", 3, env={**heard, "MUD_SAVE_FAILED": value})
        check(f"umat_ survives {name} and says so once", done.stdout.strip() == "2" and
              done.stderr.count("could not save a failed increment") == 1 and sorted(work.iterdir()) == before,
              done.stdout + done.stderr)
    done = run(host, "umat", 3, env={**quiet, "MUD_SAVE_FAILED": ""})
    check("no folder, nothing saved", done.stdout.strip() == "2" and done.stderr == "", done.stdout + done.stderr)

    # Threads: one name is given once, and every file is whole.
    done = run(host, "threads", work / "one.nml")
    check("of eight threads one writes a file", done.stdout.strip() == "1" and lines(work / "one.nml") == lines(saved),
          done.stdout + done.stderr)
    busy = folder("busy")
    done = run(host, "crowd", env={**quiet, "MUD_SAVE_FAILED": str(busy)})
    check("eight failing threads save one file", done.stdout.strip() == "8" and
          [path.name for path in busy.iterdir()] == [SAVED] and lines(busy / SAVED) == lines(saved),
          f"{done.stdout} {sorted(busy.iterdir())}")

    for name, path, words, more in (
            ("a file that exists", saved, ["a file of that name"], {}),
            ("a folder that does not", work / "absent/x.txt", ["cannot be made", "folder"], {}),
            ("a device", "/dev/full", ["a file of that name"], {}),
            ("a disk that is full", work / "full.txt", ["is the disk full"], {"preexec_fn": small_disk}),
            ("an empty name", "", ["empty"], {}), ("a name too long", "x"*3000, ["too long"], {})):
        before = sorted(work.iterdir())
        done = run(host, "api", path, **more)
        check(f"{name} is refused", done.stdout.startswith("-10 ") and all(word in done.stdout for word in words) and
              sorted(work.iterdir()) == before, done.stdout + done.stderr)
    check("the file that existed is untouched", saved.read_text(encoding="utf-8") == text)
    done = run(host, "api", "NULL")
    check("no name at all is refused", done.stdout.startswith("-7 "), done.stdout)


def test_mud_triax_saves_and_goes_on():
    # By mud_triax: an increment that the library refuses, and that the driver then cuts.
    case = (root / "drivers/cases/undrained_e735_p100.nml").read_text(encoding="utf-8")
    case = case.replace("../materials/toyoura.nml'", f"{root}/drivers/materials/toyoura.nml'\n   max_substeps = 30")
    case = re.sub(r"increment = \S+", "increment = 0.01", re.sub(r"eps_a_end = \S+", "eps_a_end = 0.02", case))
    (work / "case.nml").write_text(case, encoding="utf-8")
    done = run(triax, "case.nml", "--save-failed", "triax.nml")
    check("mud_triax saves and goes on", done.returncode == 0 and "triax.nml" in done.stdout, done.stdout + done.stderr)
    done = repeated("triax.nml", "triax_copy.nml")
    check("mud_triax's file repeats", "undrained stage, increment 1 of 2" in (work / "triax.nml").read_text() and
          lines(work / "triax_copy.nml") == lines(work / "triax.nml"), done.stdout + done.stderr)
    done = run(triax, "case.nml", "--save-failed", "triax.nml", "--output", "other.csv")
    check("mud_triax overwrites nothing", done.returncode == 4 and "triax.nml" in done.stderr and
          not (work / "other.csv").exists(), done.stderr)
    done = run(triax, "case.nml", "--save-failed", "absent/x.txt", "--quiet")
    check("mud_triax says that it cannot save", done.returncode == 4 and "absent/x.txt" in done.stderr, done.stderr)
    (work / "calm.nml").write_text(case.replace("max_substeps = 30", ""), encoding="utf-8")
    done = run(triax, "calm.nml", "--save-failed", "calm.txt")
    check("mud_triax saves nothing where nothing fails", done.returncode == 0 and not (work / "calm.txt").exists(),
          done.stdout + done.stderr)


def test_an_edited_number_is_obeyed(text):
    # The file is a case: any number may be edited.
    (work / "edited.nml").write_text(re.sub(r"max_substeps = .*", "max_substeps = 1e5", text), encoding="utf-8")
    done = repeated("edited.nml", "none.nml")
    check("an edited number is obeyed", done.returncode == 0 and "cut" not in done.stdout.partition("work")[2] and
          not (work / "none.nml").exists(), done.stdout + done.stderr)
    for name, wrong, words in (
            ("a state with a variable too few", re.sub(r"\n.*! layout", "", text), ["state_variables has"]),
            ("a state without its stress", re.sub(r"   stress =\n(.*\n){6}", "", text),
             ["state_variables needs stress"]),
            ("two changes of suction", text.replace("   d_suction", "   suction_end = 1\n   d_suction"), ["d_suction"]),
            ("two stresses", text.replace("   stress =", "   p_eff = 100\n   stress ="), ["the stress once"])):
        (work / "edited.nml").write_text(wrong, encoding="utf-8")
        done = repeated("edited.nml", "none.nml")
        check(f"{name} is refused", done.returncode == 2 and all(word in done.stderr for word in words), done.stderr)
