# SPDX-License-Identifier: MIT
"""Data that scripts of pages make: rows of other programs are not mixed with those of the present ones, every
committed table has a row, all scripts and pages fit into a night, and they leave the tree alone."""
import subprocess
import sys
import threading

import pytest
from checking import at_length, build, check, light, nightly, root, work

sys.path.insert(0, str(root / "verification"))
from tools import results, runner  # noqa: E402
from tools.page import Script  # noqa: E402

PEERS = "peers.py"   # Needs OpenSees, which a night does without.


def test_results_of_other_programs_are_removed():
    build, place = work / "a_build", work / "made"
    (build / "host").mkdir(parents=True, exist_ok=True)
    (build / "host/mud_host").write_bytes(b"one")
    row = results.current(place, build) / "rows.csv"
    row.write_text("a\n")
    (place / "run").mkdir(exist_ok=True)
    results.current(place, build)
    check("the same program: a study goes on where it was", row.exists() and (place / "run").is_dir())
    (build / "host/mud_host").write_bytes(b"two")
    results.current(place, build)
    check("another program: it begins anew", place.is_dir() and not row.exists() and not (place / "run").exists())
    row.write_text("a\n")
    (place / results.MARK).unlink()
    results.current(place, build)
    check("nothing tells of the program: it begins anew", not row.exists())


def test_no_data_of_a_page_is_empty():
    # A page that the check run leaves out would fail unseen.
    empty = [str(path.relative_to(root)) for path in (root / "verification").rglob("*.csv")
             if "/build/" not in str(path) and len(path.read_bytes().splitlines()) < 2]
    check("every committed table has a row", not empty, empty)


@at_length
def test_a_night_has_room_for_every_script_and_page(capsys, monkeypatch):
    # What --all --make leaves out needs a program that is not here or says that it runs alone.
    names = runner.names()
    taken = runner.in_a_night(names)
    said = capsys.readouterr().out
    scripts = {(name, script.name): script for name in names for script in getattr(runner.load(name), "MAKES", ())}
    left = [key for key in scripts if key[1] not in taken.get(key[0], ())]
    check("only what cannot run here, or runs alone, is left out", all(
        runner.missing(scripts[key]) or scripts[key].alone for key in left), said)
    check("and it is told", all(f"{page} --make --only {script}" in said for page, script in left), said)
    order = {name: [script.name for script in getattr(runner.load(name), "MAKES", ())] for name in names}
    check("scripts of a page keep their order: one reads what another made", all(
        some == [script for script in order[name] if script in some] for name, some in taken.items()), taken)
    total = sum(script.seconds for (page, name), script in scripts.items() if name != PEERS and not script.alone) + sum(
        runner.load(name).PAGE.seconds for name in names)
    check("with every package there is room for all but the other program, and for the pages", total <= runner.NIGHT,
          total)
    check("no script that runs alone is in a night, however short it were", not any(
        script.alone for (page, name), script in scripts.items() if name in taken.get(page, ())), taken)
    monkeypatch.setattr(runner, "NIGHT", total/2)
    taken = runner.in_a_night(names)
    spent = sum(scripts[name, script].seconds for name, some in taken.items() for script in some) + sum(
        runner.load(name).PAGE.seconds for name in names)
    check("a shorter night takes fewer scripts and all pages", spent <= runner.NIGHT and taken, spent)


def test_a_script_that_runs_alone_runs_where_it_is_named(capsys, monkeypatch):
    page = work / "pages/studies/dear"
    page.mkdir(parents=True)
    (page / "dear.py").write_text("open('ran', 'w').close()\n")
    monkeypatch.setattr(runner, "HERE", work / "pages")
    monkeypatch.setattr(runner, "scripts_of", lambda name: (Script("dear.py", (), 9000, alone=True),))
    ran = work / "alone/studies/dear/made/ran"
    runner.make("studies/dear", build, work / "alone", False, [], [])
    said = capsys.readouterr().out
    check("a page that is made leaves it out and says so", not ran.exists() and "dear.py runs alone" in said, said)
    runner.make("studies/dear", build, work / "alone", False, ["dear.py"], [])
    check("it runs where it is named", ran.exists(), capsys.readouterr().out)


def test_a_night_makes_pages_side_by_side(monkeypatch):
    together, begun, output = threading.Barrier(2, timeout=60), [], work / "side_by_side"

    def make(name, build, output, update, only, arguments, log):
        begun.append(name)
        if name != "host/cheap":
            together.wait()
        return log

    output.mkdir()
    with monkeypatch.context() as patch:
        patch.setattr(runner, "make", make)
        good = runner.make_night({"host/cheap": ["a.py"], "host/dear": ["b.py"], "host/dearest": ["c.py"]}, build,
                                 output, False, 2)
    check("two at the same time, what they print apart, the dear ones first",
          good == [True]*3 and begun[-1] == "host/cheap", (good, begun))
    made = runner.make("host/patch", build, output, False, ["make_mesh.py"], [], True)
    check("a log lies beside what a script made", made and (output / "host/patch/make_mesh.py.log").exists()
          and (output / "host/patch/made/patch.msh").exists(), sorted(output.rglob("*")))


def test_a_page_that_cannot_tell_its_data_stops_no_other(monkeypatch, capsys):
    told = []

    def update_texts(name, output):
        if name == "host/bad":
            raise ValueError("not enough rows")
        told.append(name)

    monkeypatch.setattr(runner, "update_texts", update_texts)
    failed = runner.renew_texts(["host/bad", "host/good"], work)
    check("the others are written, it is named, and why", failed == ["host/bad"] and told == ["host/good"]
          and "not enough rows" in capsys.readouterr().out, (failed, told))


@pytest.mark.skipif(light or not nightly, reason="./check --tier nightly runs the scripts that take seconds")
def test_scripts_write_where_made_files_belong():
    quick = [(name, script) for name in runner.names() for script in getattr(runner.load(name), "MAKES", ())
             if script.seconds <= 5 and not runner.missing(script)]

    def committed():
        return {str(path): path.stat().st_mtime_ns for name, _ in quick
                for path in (root / "verification" / name).iterdir() if path.is_file()}

    before = committed()
    for name, script in quick:
        done = subprocess.run([sys.executable, root / "verification/tools/runner.py", name, "--make", "--only",
                               script.name, "--build", build, "--output", work / "quick"], capture_output=True,
                              text=True)
        check(f"{name}/{script.name} makes its files", done.returncode == 0
              and all(list((work / "quick" / name / "made").glob(pattern)) for pattern in script.files),
              done.stdout + done.stderr)
    changed = set(before.items()) ^ set(committed().items())
    check("without --update no file of their folders is touched", not changed, changed)


def test_a_night_goes_on_after_an_interruption(monkeypatch, capsys):
    made, output = [], work / "interrupted"

    def make(name, build, output, update, only, arguments, log):
        if only == ["third.py"] and made.count("third.py") == 0:
            made.append("third.py")
            raise KeyboardInterrupt
        made.extend(only)
        return only != ["second.py"]

    output.mkdir()
    monkeypatch.setattr(runner, "make", make)
    monkeypatch.setattr(runner, "core", lambda: "a")
    taken = {"host/one": ["first.py", "second.py"], "host/two": ["third.py"]}
    with pytest.raises(KeyboardInterrupt):
        runner.make_night(taken, build, output, False)
    good = runner.make_night(taken, build, output, False)
    check("what was made is not made again, what failed or was cut off is", made == [
        "first.py", "second.py", "third.py", "second.py", "third.py"], made)
    check("it is told", "host/one/first.py: made before the interruption" in capsys.readouterr().out)
    check("and it counts", good == [True, False, True], good)
    monkeypatch.setattr(runner, "core", lambda: "b")
    made.clear()
    made.append("third.py")
    runner.make_night(taken, build, output, False)
    check("another core makes everything again", "first.py" in made, made)


def test_a_row_of_a_hard_case_of_the_host_counts_iterations_and_cuts():
    # The run says in its stage lines how many systems it solved; no step of a linear column is tried twice, so that the
    # ledger has all of them; a strain of 1.2 in one step is cut once. Modules of a study have the names of others: they
    # run in a process of their own.
    study = root / "verification/studies/hard_cases"
    script = ("import pathlib, sys; sys.path.insert(0, sys.argv[1]); import host_cases, host_runs, host_scenes\n"
              "case = host_cases.HostCase('c', 'g', 'h', 'none', 1, lambda s: "
              "{'': host_scenes.column(s, 1e-10, 'linear', steps=3)}, lambda r: 0)\n"
              "row = host_runs.evaluate(case, host_runs.SETTINGS[0], pathlib.Path(sys.argv[2]))\n"
              "cell = (\"&scene name='s' fields='u' / &mesh r=0,1 r_cells=1 z=0,1 z_cells=1 /\""
              "\"&elastic name='m' young=1e4 poisson=0 / &region material='m' rho_s=2 void_ratio=0 /\""
              "\"&stage name='q' analysis='static' duration=1 dt=1 / &fix group='bottom' field='u_z' /\""
              "\"&fix group='top' field='u_z' value=1.2 history='h' / &history name='h' times=0,1 values=0,1 /\")\n"
              "told = host_runs.run(cell, pathlib.Path(sys.argv[2]) / 'cut')\n"
              "print(row.finished, row.cuts, told.cuts, row.iterations, row.runs[''].told)")
    done = subprocess.run([sys.executable, "-c", script, str(study), str(work / "counted")], capture_output=True,
                          text=True, timeout=60)
    ended, cuts, cut, iterations, told = (done.stdout.split(" ", 4) + 5*[""])[:5]
    check("the run comes to its end without a cut, the other with one", (ended, cuts, cut) == ("True", "0", "1"),
          done.stdout + done.stderr)
    check("a row of the host has the iterations of its run",
          iterations.isdigit() and int(iterations) >= 3 and f"{iterations} linear solves and" in told, done.stdout)
