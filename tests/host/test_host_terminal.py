# SPDX-License-Identifier: MIT
"""What mud_host says to a person at a terminal: peaks, steps, warnings again; one run a folder; Ctrl-C; whole rows."""
import fcntl
import os
import pty
import re
import signal
import subprocess
import time

import numpy as np

from checking import build, check, work
import tables  # noqa: E402

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}
SWING = """&scene name = 'swing' geometry = 'plane_strain' fields = 'u' {more} /
&mesh r = 0, 1 r_cells = {cells} z = -4, 0 z_cells = {deep} /
&elastic name = 'm' young = 2e4 poisson = 0.25 /
&region material = 'm' rho_s = 2 void_ratio = 0 /
&history name = 'v' times = 0, 0.2, 2 values = 0, 1, 0 /
&stage name = 's' analysis = 'dynamic' duration = {duration} dt = 0.01 fields = 10000 /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'left' field = 'u_r' /
&load group = 'top' kind = 'pressure' value = 5 history = 'v' /
&point name = 'corner' r = 1 z = 0 /
"""
SMALL = SWING.format(more="", cells=1, deep=4, duration=1)
LONG = SWING.format(more="checkpoint_steps = 40", cells=2, deep=8, duration=400)


def written(name, text):
    (work / f"{name}.nml").write_text(text)
    return work / f"{name}.nml"


def run(scene, out, *words):
    return subprocess.run([host, scene, "--output", out, *words], capture_output=True, text=True, env=environment)


def begun(scene, out, *words):
    """A run that has taken steps."""
    table, end = out / "histories.csv", time.monotonic() + 30
    if "--restart" not in words:
        table.unlink(missing_ok=True)
    wanted = 20000 + (table.stat().st_size if table.exists() else 0)
    child = subprocess.Popen([host, scene, "--output", out, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             text=True, env=environment)
    while time.monotonic() < end and child.poll() is None and not (table.exists() and table.stat().st_size > wanted):
        time.sleep(0.01)
    return child


def test_peaks_and_their_times_are_told_in_the_unit_of_a_reader():
    done = run(written("small", SMALL), work / "small")
    rows = tables.columns(work / "small/histories.csv")
    peak = np.argmax(np.abs(rows["corner.u_z"]))
    value, when = 1e3*rows["corner.u_z"][peak], rows["time"][peak]
    said = re.search(r"^corner\.u_z (\S+) mm at (\S+) s$", done.stdout, re.MULTILINE)
    check("peak in mm and s, three digits", said and abs(float(said[1])/value - 1) < 5e-3
          and abs(float(said[2])/when - 1) < 5e-3, (value, when, done.stdout))
    check("nothing is told of pressures that are no unknowns", "corner.p_w" not in done.stdout, done.stdout)
    check("errors are not known", done.stdout.rstrip().endswith(
        f'The errors of these answers are not known; "mud_study accuracy {work}/small.nml" measures them.'),
        done.stdout)
    (work / "two words").mkdir(exist_ok=True)
    told = run(written("two words/small", SMALL), work / "small_words").stdout
    check("a path with a blank is one word of the command", f"accuracy '{work}/two words/small.nml'\" m" in told, told)
    told = run(work / "two words/small.nml", work / "small_words", "--accuracy", "0.01").stderr
    check("also where an option is refused", f"accuracy '{work}/two words/small.nml' --accuracy 0.01" in told, told)
    written("two words/small", SMALL.replace("&scene", "&scene mesh = 'auto'"))
    told = run(work / "two words/small.nml", work / "small_words").stderr
    check("and a key", f"accuracy '{work}/two words/small.nml' --accuracy A" in told, told)
    check("memory and times are for --verbose", "MB" not in done.stdout and "factorisation" not in done.stdout)
    check("and are there", all(word in run(work / "small.nml", work / "small", "--verbose").stdout
                               for word in ("MB", "factorisation")))
    # No segment of the history ends within the step.
    one = run(written("one", SMALL.replace("dt = 0.01", "dt = 1 steps = 'given'").replace("0, 0.2, 2", "0, 1.2, 2")),
              work / "one").stdout
    check("1 step", "Stage s: 1 step, time 1 s" in one and "\n1 step." in one, one)


def test_a_late_peak_has_a_time_that_tells_it_from_the_step_before():
    # A static stage of an hour and a half comes first: three digits of the time would be those of its end.
    late = SMALL.replace("&stage", "&stage name = 'w' analysis = 'static' duration = 5400 dt = 5400 /\n&stage").replace(
        "times = 0, 0.2, 2", "times = 5400, 5400.2, 5402")
    for name, more in (("late", ""), ("resumed", "checkpoint_steps = 60")):
        scene, out = written(name, late.replace("fields = 'u'", "fields = 'u' " + more)), work / name
        said = run(scene, out).stdout
        if name == "resumed" and (out / "checkpoint.h5").exists():   # the peak came before the checkpoint
            said = run(scene, out, "--restart", out / "checkpoint.h5").stdout
        rows = tables.columns(out / "histories.csv")
        when = rows["time"][np.argmax(np.abs(rows["corner.u_z"]))]
        told = re.search(r"^corner\.u_z \S+ mm at (\S+) s$", said, re.MULTILINE)
        check(f"{name}: to a part of a step of 0.01 s", told and abs(float(told[1]) - when) < 5e-3, (when, said))


def test_peaks_of_undrained_ground_are_told_and_rounding_is_not():
    # Water that cannot leave bears a load of 30 kPa but for its share of the stiffness; nothing moves sideways.
    closed = """&scene name = 'closed' geometry = 'plane_strain' fields = 'u-p_w' /
&mesh r = 0, 1 r_cells = 2 z = 0, 1, 3 z_cells = 2, 3 /
&elastic name = 'm' young = 9e3 poisson = 0.3 /
&permeability name = 'k' intrinsic = 1e-12 /
&region material = 'm' void_ratio = 0.6 drainage = 'undrained' /
&region group = 'block_1_2' material = 'm' void_ratio = 0.6 permeability = 'k' /
&stage name = 's' analysis = 'quasi_static' duration = 1e-3 dt = 1e-3 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 30 /
&point name = 'low' r = 0.5 z = 0.4 /
&point name = 'high' r = 0.5 z = 1.9 /
"""
    said = run(written("closed", closed), work / "closed").stdout
    stiff, water = 9e3*0.7/1.3/0.4, 2.2e6/(0.6/1.6)
    told = {name: float(value) for name, value in re.findall(r"^(\S+)\.p_w (\S+) kPa at 1 ms$", said, re.MULTILINE)}
    check("the pressure of both", sorted(told) == ["high", "low"], said)
    check("what the water bears", all(abs(p / (30*water/(water + stiff)) - 1) < 2e-3 for p in told.values()), told)
    check("no rounding", "u_z" in said and "u_r" not in said, said)


def test_warnings_are_said_again_at_the_end():
    done = run(written("warned", SMALL.replace("&stage", "&permeability name = 'k' intrinsic = 1e-12 /\n&stage")),
               work / "warned")
    warning = "&permeability 'k' has no effect"
    check("at the start on standard error, at the end on standard output",
          done.stderr.count(warning) == 1 and done.stdout.count(warning) == 1
          and done.stdout.index("Warnings of this run:") > done.stdout.index("corner.u_z"), done.stdout)
    check("quiet: once", run(work / "warned.nml", work / "warned", "--quiet").stdout == "")


def test_a_second_run_in_a_folder_is_refused_while_the_first_lives():
    scene, out = written("long", LONG), work / "shared"
    first = begun(scene, out, "--quiet")
    check("the first runs", first.poll() is None)
    second = run(scene, out)
    check("the second is refused", second.returncode == 4 and "choose another --output" in second.stderr
          and f"Another run writes its results to {out}" in second.stderr, second.stderr)
    elsewhere = run(written("small", SMALL), work / "elsewhere")
    check("another folder is free", elsewhere.returncode == 0, elsewhere.stderr)
    first.kill()
    first.wait()
    check("a killed run holds up nobody", run(written("small", SMALL), out, "--quiet").returncode == 0)
    (out / "lock").write_text("what a program left here\n")
    free = run(work / "small.nml", out, "--quiet")
    check("a file that nobody holds is taken over", free.returncode == 0, free.stderr)
    check("and stays what it is", (out / "lock").read_text() == "what a program left here\n")
    with open(out / "lock", "w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        check("one that another process holds is not", run(work / "small.nml", out).returncode == 4)


def test_runs_one_after_the_other_lock_one_file():
    # A run that has opened the file before the one before it ends must not lock a file that has lost its name.
    scene, out = written("small", SMALL), work / "in_turn"
    files = set()
    for _ in range(2):
        done = run(scene, out, "--quiet")
        check("the folder is free", done.returncode == 0, done.stderr)
        files.add((out / "lock").stat().st_ino)
    check("the file stays", len(files) == 1, files)


def test_a_folder_that_cannot_be_locked_is_refused():
    # A folder of that name, or a file of another user, cannot be written: then two runs would mix their files.
    out = work / "no_lock"
    (out / "lock").mkdir(parents=True)
    done = run(written("small", SMALL), out, "--quiet")
    check("refused", done.returncode == 4 and f"{out}/lock cannot be written" in done.stderr
          and len(done.stderr.splitlines()) == 1, done.stderr)
    check("nothing is written", [path.name for path in out.iterdir()] == ["lock"])


def test_a_killed_run_leaves_whole_rows():
    scene, out = written("long", LONG), work / "killed"
    for _ in range(3):
        child = begun(scene, out, "--quiet")
        child.kill()
        child.wait()
        for name in ("histories.csv", "ledger.csv"):
            text = (out / name).read_text()
            check(f"{name} ends with a row", text.endswith("\n") and len({row.count(",") for row in text.splitlines()})
                  == 1, text[-200:])
            check(f"{name}: up to the last steps", len(text.splitlines()) > 20)


def test_ctrl_c_ends_after_the_step_and_says_how_to_go_on():
    scene, out = written("long", LONG), work / "interrupted"
    for number in (signal.SIGINT, signal.SIGTERM):
        child = begun(scene, out)
        child.send_signal(number)
        said, error = child.communicate(timeout=60)
        check(f"{number.name}: its exit code", child.returncode == 130, (child.returncode, error))
        rows = tables.columns(out / "histories.csv")
        told = re.search(r"Interrupted at (\S+) s: the results up to there are complete", error)
        check(f"{number.name}: the last row is the time told", told and abs(float(told[1])/rows["time"][-1] - 1) < 1e-5,
              error)
        check(f"{number.name}: fields of that time", (out / "nodes_s.csv").exists())
        with open(out / "lock") as free:
            fcntl.flock(free, fcntl.LOCK_EX | fcntl.LOCK_NB)   # raises where the folder is not free
    check("the newest checkpoint is named", f"--restart {out}/checkpoint.h5 goes on" in error, error)
    more = begun(scene, out, "--restart", out / "checkpoint.h5")
    before = rows["time"][-1]
    more.send_signal(signal.SIGINT)
    more.communicate(timeout=60)
    times = tables.columns(out / "histories.csv")["time"]
    check("it goes on from there", before in times and times[-1] > before and np.all(np.diff(times) > 0), times[-3:])


def test_progress_is_as_wide_as_the_terminal_and_never_in_files():
    scene = written("long", LONG.replace("duration = 400", "duration = 30"))
    check("nothing in files", "left for" not in run(scene, work / "file").stdout)
    fcntl, termios, struct = (__import__(name) for name in ("fcntl", "termios", "struct"))
    for width in (40, 200):
        master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, width, 0, 0))
        child = subprocess.Popen([host, scene, "--output", work / "shown"], stdout=slave, stderr=slave, env=environment)
        os.close(slave)
        shown = b""
        while True:
            try:
                part = os.read(master, 65536)
            except OSError:
                break
            if not part:
                break
            shown += part
        child.wait()
        os.close(master)
        lines = [line for line in re.split(rb"[\r\n]+", shown) if line.startswith(b"Stage s: step ")]
        check(f"{width} columns: there is progress", len(lines) > 0, shown[-500:])
        check(f"{width} columns: no line wraps", all(len(line.rstrip()) < width for line in lines), lines)
        check(f"{width} columns: it is whole where there is room", width < 100 or any(b"left for" in x for x in lines),
              lines)
