# SPDX-License-Identifier: MIT
"""mud_check_law: a law without mistakes passes, every planted mistake is found by the check that is made for it."""
import json
import os
import subprocess
import sys

import numpy as np
import pytest
from checking import build, check, needs_release, root, work

needs_release("the program is Python and the law is planted: one build runs them")
environment = {**os.environ, "MUD_LIBRARY_DIR": str(build), "PYTHONPATH": str(root / "python"), "MPLBACKEND": "Agg",
               "MUD_MESSAGES": "off"}
# Mistake of planted_law.c, its check, and words of the sentence. Two are notes: they are right in some hosts.
PLANTED = (
    (1, "increments", "off those of"),
    (2, "tangent", "neither the derivative"),
    (3, "tangent", "with the columns of shear halved is"),
    (4, "conventions", "tensor shear"),
    (5, "DROT", "not turned with DROT"),
    (6, "two materials", "properties of the first"),
    (7, "two points", "disturb each other"),
    (7, "restart", "more than STATEV"),
    (8, "threads", "end elsewhere"),
    (9, "arrays", "STATEV beyond its end"),
    (10, "large increments", "refused, but stress or STATEV are changed"),
    (11, "large increments", "not finite, and PNEWDT stays 1"),
    (12, "large increments", "it stopped the process (exit code 3)"),
    (13, "energy", "gives energy"),
    (14, "oscillation", "forgets its process of loading"),
    (15, "arrays", "DSTRAN"),
    (16, "first call", "zero, singular or not finite"),
    (17, "large increments", "the strain is lost without a word"),
    (18, "tangent", "one stiffness for loading and unloading"),
    (19, "tangent", "is not finite"),
    (20, "tangent", "neither the derivative"),
    (21, "first call", "of the other sign"),
    (22, "first call", "is refused"),
)
NOTES = (10, 18)


def run(library, *words):
    return subprocess.run([sys.executable, "-m", "mud.check_law", library, *words], capture_output=True, text=True,
                          env=environment, cwd=work)


def planted(mistake, *words):
    return run(build / "tests/umats/planted_law.so", f"--props={mistake},4000,8000,20,2000", "--nstatv=13", *words)


sys.path[:0] = [str(root / "python")]
os.environ["MUD_LIBRARY_DIR"] = str(build)
os.environ["MPLBACKEND"] = "Agg"
import mud  # noqa: E402
import tables  # noqa: E402
from mud import check_law, law_checks, law_under_test  # noqa: E402

FEWEST = mud.parameters["hysteresis"].index   # PROPS that PLAXIS has room for


def test_a_law_without_mistakes_has_no_fault():
    # All but the threads, as dear as the rest together: docs/tutorials/foreign_law.md asks every question at once, and
    # a law that two threads do not disturb has no fault there.
    asked = [name for name in law_checks.CHECKS if name != "threads"]
    done = planted(0, "--output=clean", *(f"--only={name}" for name in asked))
    check("a law without mistakes has no fault", done.returncode == 0 and "0 faults" in done.stdout,
          done.stdout + done.stderr)
    found = json.loads((work / "clean/findings.json").read_text()) if done.returncode == 0 else []
    check("its tangent is told consistent", any("(consistent)" in f["sentence"] for f in found), found)
    check("every check was made", {f["check"] for f in found} == set(asked), sorted({f["check"] for f in found}))
    check("tension that it carries is noted", [f["verdict"]
          for f in found if f["check"] == "tension"] == ["note"]*2, found)
    report = work / "clean/report.md"
    links = [word.split(")")[0] for word in report.read_text().split("](")[1:]] if report.exists() else []
    check("the report has pictures and cases, and they exist", len(links) >= 4
          and all((work / "clean" / link).stat().st_size for link in links), links)
    cases = sorted(case.name for case in (work / "clean").glob("*.nml"))
    check("every finding that a path of strain shows has its case", len(cases) >= 8, cases)
    for case in (work / "clean").glob("*.nml"):
        done = subprocess.run([build / "drivers/mud_triax", case, "--output", work / "case.csv", "--quiet"],
                              capture_output=True, text=True)
        check(f"mud_triax runs {case.name}", done.returncode == 0, done.stderr)


@pytest.mark.parametrize("mistake, name, words", PLANTED)
def test_a_planted_mistake_is_found(mistake, name, words, capsys):
    # In this process: what the law keeps between calls is what two of the mistakes are about, and begins with each.
    code = check_law.main([str(build / "tests/umats/planted_law.so"), f"--props={mistake},4000,8000,20,2000",
                           "--nstatv=13", f"--only={name}", f"--output={work / f'planted_{mistake}_{name}'}"])
    told = capsys.readouterr().out
    verdict = "note" if mistake in NOTES else "fault"
    lines = [line for line in told.splitlines() if line.startswith(verdict)]
    check(f"planted mistake {mistake} is found by '{name}'", code == (verdict == "fault")
          and any(f" {name}: " in line and words in line for line in lines), told)


def test_what_is_no_mistake_of_drot_or_of_the_law_is_told_as_what_it_is():
    # It writes its one state variable where it yields, behind the first fifth of the path.
    done = run(build / "tests/umats/drucker_prager.so", "--props=2e4,0.3,0.5,0.2,10,1000,0.05,-15,0", "--reach=0.02",
               "--only=arrays")
    check("a state variable although there is none", done.returncode == 1 and "STATEV beyond its end" in done.stdout,
          done.stdout + done.stderr)
    done = planted(4, "--only=DROT")
    check("answers that depend on the directions anyhow are no mistake of DROT",
          done.stdout.startswith("not judged") and "1 not judged" in done.stdout,
          done.stdout + done.stderr)
    law, words = build / "tests/umats/tresca.so", ("--props=1e4,0.25,20", "--reach=0.05", "--only=large increments")
    done = run(law, *words, "--components=4")
    check("a law of four components loses no shear that it cannot get", done.stdout.startswith("pass"), done.stdout)
    (work / "file").write_text("")
    for words, told in (("--nstatv=-1", "it is 0 or more"), ("--stress=nan,1,1", "(--stress) has a value"),
                        ("--props=nan", "(--props) has a value"), ("--suction=inf", "(--suction) has a value"),
                        ("--kind=udsm --components=4", "User_Mod has 6"),
                        (f"--output={work / 'file'}", "File exists")):
        done = planted(0, *words.split())
        check(f"refused: {words}", done.returncode == 2 and told in done.stderr and not done.stdout,
              done.stdout + done.stderr)


def test_mud_as_plaxis_calls_it_has_no_fault():
    sand = ",".join(repr(float(x)) for x in mud.Material("toyoura").props[:FEWEST])
    done = run(build / "umat/libmud.so", "--kind=udsm", f"--props={sand}", f"--nstatv={len(mud.states)}",
               *(f"--only={name}" for name in ("first call", "arrays", "conventions", "increments", "restart")))
    check("MUD as PLAXIS calls it has no fault", done.returncode == 0, done.stdout + done.stderr)
    done = run(build / "umat/libmud.so", "--kind=udsm", f"--props={sand}", "--only=speed")
    took = float(done.stdout.split("speed: ")[1].split()[0]) if "speed: " in done.stdout else 0.0
    # An update of PLAXIS is two calls, stresses and stiffness; the quicker one alone took no time.
    check("without --nstatv as many state variables as the law says; its time is that of all its calls", took > 0.5,
          done.stdout + done.stderr)
    law = law_under_test.Law(str(build / "umat/libmud.so"), kind="udsm", props=mud.Material("toyoura").props[:FEWEST])
    found = check_law.check_law(law, only=["first call"])
    check("from Python it asks the model too", law.n_state >= mud.states["turns"].index
          and found[0].verdict == law_checks.PASS, (law.n_state, found))
    with pytest.raises(ValueError, match="at most 50"):
        law.like(props=[1.0]*51)
    done = run(build / "umat/libmud.so", "--kind=udsm", f"--props={sand}", "--nstatv=5")
    check("too few state variables are refused", done.returncode == 2 and "the law says that it has" in done.stderr,
          done.stdout + done.stderr)
    for words, told in ((("--stress=1,2",), "--stress has 2"), (("--only=nothing",), "there is no check"),
                        (("--nstatv=2", "--statev=1"), "(--statev) has 1")):
        done = planted(0, *words)
        check(f"refused: {words[-1]}", done.returncode == 2 and told in done.stderr, done.stdout + done.stderr)
    done = run(work / "missing.so")
    check("a library that is missing", done.returncode == 2 and "cannot be called as a umat" in done.stderr,
          done.stderr)


def test_a_case_of_a_finding_gives_its_numbers():
    # The strains of the finding, run by mud_triax, end at the stress that the law itself gives for them.
    law = check_law.Law(str(build / "tests/umats/planted_law.so"), props=[0, 4000.0, 8000.0, 20.0, 2000.0], n_state=13)
    at = law_checks.Setting(-100.0*np.array([1.0, 1, 1, 0, 0, 0]))
    start = law_checks.go(law, law_checks.begin(law, at), law_checks.straight(at, 30))
    path = law_checks.straight(at, 5) + law_checks.straight(at, 3, -0.01) + law_checks.straight(at, 2)
    wanted = law_checks.go(law, start, path).stress
    case = work / "finding.nml"
    case.write_text(law_checks.case_of(law, start, path))
    subprocess.run([build / "drivers/mud_triax", case, "--output", work / "finding.csv", "--quiet"], check=True)
    table = tables.columns(work / "finding.csv")
    got = [-table[f"sig_{a}"][-1] for a in ("11", "22", "33", "12", "13", "23")]
    check("stress at the end of the case", np.allclose(got, wanted, rtol=1e-12, atol=1e-9), f"{got}, {wanted}")
    check("a row for every increment and the start", len(table["eps_a"]) == 11, len(table["eps_a"]))
