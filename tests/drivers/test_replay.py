# SPDX-License-Identifier: MIT
"""Failed increments: saved by every door, replayed bit by bit, and every mistake on the way has its sentence."""
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
from checking import build, check, finish, root, work  # noqa: E402

cache = dict(re.findall(r"^(\w+):\w+=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE))
replay, triax = build / "drivers/mud_replay", build / "drivers/mud_triax"
SAVED = "mud_failed_too_many_substeps.txt"  # the one name that umat_ has for this failure
quiet = {**{name: value for name, value in os.environ.items() if name != "MUD_SAVE_FAILED"}, "MUD_MESSAGES": "off"}
heard = {name: value for name, value in quiet.items() if name != "MUD_MESSAGES"}


def run(*words, folder=work, **more):
    return subprocess.run([str(word) for word in words], cwd=folder, capture_output=True, text=True,
                          **{"env": quiet, **more})


def flags(language):
    kind = cache["CMAKE_BUILD_TYPE"].upper()
    return f"{cache.get(f'CMAKE_{language}_FLAGS', '')} {cache.get(f'CMAKE_{language}_FLAGS_{kind}', '')}".split()


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
    return [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("origin")]


host = compiled()
files_before = sorted(work.iterdir())

# By default nothing is written, however often umat_ fails. Status 2 is MUD_TOO_MANY_SUBSTEPS.
done = run(host, "umat", 3)
check("umat_ writes nothing unasked", done.stdout.strip() == "2" and done.stderr == "" and
      sorted(work.iterdir()) == files_before, done.stdout + done.stderr)

# By the C interface. The copy is made from what was read: were a bit of any number lost, or did the replay end in
# another way, it would differ.
saved = work / "saved.txt"
done = run(host, "api", saved)
check("the C interface saves", done.stdout.split()[:1] == ["0"] and saved.exists(), done.stdout + done.stderr)
text = saved.read_text(encoding="utf-8")
numbers = dict(re.findall(r"^(\w+) (\S+)$", text, re.MULTILINE))
check("the numbers are those of the host", (float(numbers["dsuction"]), float(numbers["dstrain_12"]),
      float(numbers["stress_33"])) == (-1/3, 1e-3/3, -120.0), numbers)
done = run(replay, saved, "--save", "copy.txt")
check("the replay is that of the failure", done.returncode == 0 and "status      2: too many substeps" in done.stdout
      and "the same status, work and share reached" in done.stdout, done.stdout + done.stderr)
check("the replay has every bit", (work / "copy.txt").read_bytes() == saved.read_bytes(), "the copy differs")
rows = re.findall(r"^ +\d+ (?:\S+ +){2}(accepted|rejected|FAILED) ", done.stdout, re.MULTILINE)
counted = [int(re.search(rf"^{name} (\d+)$", text, re.MULTILINE)[1]) for name in ("n_substep", "n_reject")]
check("the table shows the substeps that were counted", len(rows) == 12 and
      [rows.count("accepted"), rows.count("rejected")] == counted, f"{rows} {counted}")
check("cutting helps", re.search(r"it passes in \d+ equal parts", done.stdout), done.stdout)
done = run(replay, saved, "--steps", 3)
check("--steps shows the ends", re.findall(r"^ +(\d+) \d\.", done.stdout, re.MULTILINE) == ["1", "2", "12"]
      and "9 substeps not shown" in done.stdout, done.stdout)

# By umat_, for a folder named in the environment: the same file but for the remark, and one of each failure.
asked = folder("asked")
done = run(host, "umat", 25, env={**quiet, "MUD_SAVE_FAILED": str(asked)})
names = [path.name for path in sorted(asked.iterdir())]
check("umat_ saves one file of a failure that comes again", done.stdout.strip() == "2" and names == [SAVED],
      f"{done.stdout} {names}")
check("umat_ saves what the C interface does", names and all(lines(path) == lines(saved) for path in asked.iterdir()))
done = run(replay, asked / SAVED)
check("umat_'s file replays and names the place of the first", "the same status" in done.stdout and
      "element 1, point 4, step 1, increment 9" in done.stdout, done.stdout + done.stderr)
done = run(host, "several", env={**quiet, "MUD_SAVE_FAILED": str(asked)})
names = sorted(path.name for path in asked.iterdir())
check("umat_ saves each distinct failure under its name", done.stdout.strip() == "-6" and names == sorted([
      SAVED, "mud_failed_bad_props_h_0.txt", "mud_failed_bad_props_n_b.txt", "mud_failed_bad_input_stress_11.txt",
      "mud_failed_increment_too_large_strain_13.txt", "mud_failed_bad_state_memory_22.txt"]), f"{done.stdout} {names}")
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
done = run(host, "threads", work / "one.txt")
check("of eight threads one writes a file", done.stdout.strip() == "1" and lines(work / "one.txt") == lines(saved),
      done.stdout + done.stderr)
busy = folder("busy")
done = run(host, "crowd", env={**quiet, "MUD_SAVE_FAILED": str(busy)})
check("eight failing threads save one file", done.stdout.strip() == "8" and
      [path.name for path in busy.iterdir()] == [SAVED] and lines(busy / SAVED) == lines(saved),
      f"{done.stdout} {sorted(busy.iterdir())}")


# Where nothing can be written: -10, a reason, and no remains.
def small_disk():
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2048, 2048))  # the file has about 5 kB


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

# By mud_triax: an increment that the library refuses, and that the driver then cuts.
case = (root / "drivers/cases/undrained_e735_p100.nml").read_text(encoding="utf-8")
case = case.replace("../materials/toyoura.nml'", f"{root}/drivers/materials/toyoura.nml'\n   max_substeps = 30")
case = re.sub(r"increment = \S+", "increment = 0.01", re.sub(r"eps_a_end = \S+", "eps_a_end = 0.02", case))
(work / "case.nml").write_text(case, encoding="utf-8")
done = run(triax, "case.nml", "--save-failed", "triax.txt")
check("mud_triax saves and goes on", done.returncode == 0 and "triax.txt" in done.stdout, done.stdout + done.stderr)
done = run(replay, "triax.txt", "--save", "triax_copy.txt")
check("mud_triax's file replays", "the same status" in done.stdout and "undrained stage, increment 1 of 2" in
      done.stdout and (work / "triax_copy.txt").read_bytes() == (work / "triax.txt").read_bytes(),
      done.stdout + done.stderr)
done = run(triax, "case.nml", "--save-failed", "triax.txt", "--output", "other.csv")
check("mud_triax overwrites nothing", done.returncode == 4 and "triax.txt" in done.stderr and
      not (work / "other.csv").exists(), done.stderr)
done = run(triax, "case.nml", "--save-failed", "absent/x.txt", "--quiet")
check("mud_triax says that it cannot save", done.returncode == 4 and "absent/x.txt" in done.stderr, done.stderr)
(work / "calm.nml").write_text(case.replace("max_substeps = 30", ""), encoding="utf-8")
done = run(triax, "calm.nml", "--save-failed", "calm.txt")
check("mud_triax saves nothing where nothing fails", done.returncode == 0 and not (work / "calm.txt").exists(),
      done.stdout + done.stderr)

# Edits. Allowed: any number, and the file then says that the end is another one.
edited = work / "edited.txt"
edited.write_text(re.sub(r"^max_substeps .*$", "max_substeps 1e5", text, flags=re.MULTILINE), encoding="utf-8")
done = run(replay, edited)
check("an edited number is obeyed", done.returncode == 0 and "status      0: no error" in done.stdout and
      "DIFFERENT: status 2" in done.stdout, done.stdout + done.stderr)
for value in ("NaN", "Infinity", "-Infinity"):
    edited.write_text(re.sub(r"^dstrain_13 .*$", f"dstrain_13 {value}", text, flags=re.MULTILINE), encoding="utf-8")
    (work / "odd.txt").unlink(missing_ok=True)
    done = run(replay, edited, "--save", "odd.txt")
    check(f"{value} is replayed", "strain increment 13 is not finite" in done.stdout and
          f"dstrain_13 {value}\n" in (work / "odd.txt").read_text(encoding="utf-8"), done.stdout + done.stderr)
edited.write_text(text.replace("\n", "\r\n") + "# a remark\n", encoding="utf-8")
done = run(replay, edited)
check("line ends of other systems and remarks are read", "the same status" in done.stdout, done.stdout + done.stderr)


def place(name):
    """Line of an entry."""
    return next(n for n, line in enumerate(text.splitlines(), 1) if line.split()[0] == name)


# Refused with file, line and what is wrong; exit code 2.
for name, wrong, line, words in (
        ("a truncated file", "".join(text.splitlines(True)[:place("M_c") - 1]), place("M_c"), ["truncated", "`M_c`"]),
        ("a file cut in a line", text[:text.index("\ntheta") + 4], place("theta"), ["`theta` is expected", "`the`"]),
        ("a missing end", text.replace("\nend\n", "\n"), place("end"), ["`end`", "truncated"]),
        ("text after the end", text + "more\n", place("end") + 1, ["after `end`"]),
        ("another format", text.replace("format 1", "format 2"), place("format"), ["format 2", "format 1"]),
        ("another ABI", text.replace("abi 2\n", "abi 7\n"), place("abi"), ["ABI 7", "ABI 2"]),
        ("a name of another library", text.replace("\nh_0 ", "\nh_O "), place("h_0"), ["`h_0`", "`h_O`"]),
        ("another number of entries", re.sub(r"\nprops \d+", "\nprops 3", text), place("props"), ["3 entries"]),
        ("a word for a number", re.sub(r"\nG_0 .*", "\nG_0 1.2.3", text), place("G_0"), ["`G_0`", "1.2.3"]),
        ("a missing value", re.sub(r"\nG_0 .*", "\nG_0", text), place("G_0"), ["`G_0` has no value"]),
        ("a broken count", re.sub(r"\nn_rate .*", "\nn_rate 1.5", text), place("n_rate"), ["n_rate", "1.5"]),
        ("a tangent that is none", re.sub(r"\ntangent 2\n", "\ntangent 9\n", text), place("tangent"), ["0 to 3"]),
        ("a line without end", text.replace("format 1", "format " + "1"*700), 2, ["cannot be read"]),
        ("an empty file", "", 1, ["`format`", "truncated"]),
        ("another kind of file", "eps_a,q\n0,0\n", 1, ["no saved increment"])):
    edited.write_text(wrong, encoding="utf-8")
    done = run(replay, edited)
    check(f"{name} is refused", done.returncode == 2 and f"edited.txt:{line}: " in done.stderr and
          all(word in done.stderr for word in words) and done.stdout == "", f"{done.stderr} (line {line})")
edited.write_bytes(bytes(range(256))*8)
done = run(replay, edited)
check("bytes are refused", done.returncode == 2 and "edited.txt:" in done.stderr, done.stderr)
for name, words, code, told in (
        ("an absent file", ["absent.txt"], 2, "absent.txt"), ("no file", [], 2, "No increment file"),
        ("two files", ["a", "b"], 2, "One increment"), ("an unknown option", ["--frob"], 2, "--frob"),
        ("no number of steps", [saved, "--steps", "many"], 2, "many"),
        ("a copy onto a file", [saved, "--save", saved], 4, "a file of that name")):
    done = run(replay, *words)
    check(f"{name} is explained", done.returncode == code and told in done.stderr, f"{done.returncode} {done.stderr}")
done = run(replay, "--help")
check("--help explains", done.returncode == 0 and "--steps" in done.stdout, done.stdout)
done = run(replay, "--version")
check("--version tells the library's", re.fullmatch(r"mud_replay, MUD library \d+\.\d+\.\d+\n", done.stdout),
      done.stdout)

finish()
