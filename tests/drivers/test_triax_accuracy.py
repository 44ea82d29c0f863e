# SPDX-License-Identifier: MIT
"""Accuracy asked of mud_triax: increments and the tolerance of the stresses follow, the estimated errors are those of a
far finer run within a band, what is given by hand stays."""
import re
import subprocess


from checking import build, check, root, work
import tables  # noqa: E402 (checking knows its folder)

triax = build / "drivers/mud_triax"
BAND = 0.2, 5.0   # True error over the estimated one.
MATERIAL = f"&material file = '{root}/drivers/materials/toyoura.nml' MORE /\n"
CASES = {
    "drained": "&initial p_eff = 100 void_ratio = 0.833 /\n"
               "&stage control = 'drained' eps_a_end = 0.05 output_interval = 1e-2 GIVEN /\n",
    "undrained": "&initial p_eff = 100 void_ratio = 0.833 /\n"
                 "&stage control = 'undrained' eps_a_end = 0.05 output_interval = 1e-2 GIVEN /\n",
    "cycles": "&initial p_eff = 100 void_ratio = 0.735 /\n"
              "&stage control = 'undrained' cycle_by = 'q' amplitude = 15 cycles = 2 output_interval = 1e-2 GIVEN /\n",
    "constant water": "&initial p_eff = 100 void_ratio = 0.8 suction = 50 /\n"
                      "&stage control = 'drained' water = 'constant' eps_a_end = 0.02 output_interval = 1e-2 GIVEN /\n",
}


def run(name, text, *words):
    case, out = work / f"{name}.nml", work / f"{name}.csv"
    case.write_text(text)
    out.unlink(missing_ok=True)
    done = subprocess.run([triax, case, "--output", out, *words], capture_output=True, text=True, cwd=work)
    return done, tables.numbers(out) if out.exists() else []


def text_of(name, more="", given=""):
    return MATERIAL.replace("MORE", more) + CASES[name].replace("GIVEN", given)


def counted(done):
    return int(re.search(r"(\d+) increments", done.stdout)[1])


def estimated(said):
    """Estimated error and change of every answer."""
    lines = re.findall(r"^ +(\w+) (\S+) % of (\S+)(?: kPa)?$", said, re.MULTILINE)
    return {name: (float(error)/100, float(change)) for name, error, change in lines}


def test_what_was_asked_for():
    for name in CASES:
        done, fine = run("fine", text_of(name, "tolerance = 1e-10 scheme = 3", "increment = 2e-6"), "--quiet")
        for accuracy in ("3e-2", "1e-3"):
            done, rows = run("asked", text_of(name), "--accuracy", accuracy)
            check(f"{name}, {accuracy}: runs", done.returncode == 0 and not done.stderr, done.stderr)
            told, true = estimated(done.stdout), {}
            for answer in ("q", "p_eff", "eps_v", "suction"):
                if answer in told and told[answer][1] > 0 and len(rows) > 1:
                    true[answer] = abs(rows[-1][answer] - fine[-1][answer])/told[answer][1]
            worst = max(true.values(), default=9)
            check(f"{name}, {accuracy}: what was asked for", worst < float(accuracy), (true, told))
            # At the end of the test the error may be less than the largest, but no more than the band allows.
            good = all(error < BAND[1]*told[answer][0] + 1e-9 for answer, error in true.items())
            check(f"{name}, {accuracy}: no error beyond its estimate", good, (true, told))


def test_3_takes_fewer_increments_than_the_default():
    # The price: an accuracy takes fewer updates than the default increments where it asks for little.
    done, rows = run("asked", text_of("drained"), "--accuracy", "3e-2")
    coarse = counted(done)
    done, rows = run("default", text_of("drained"))
    check("3 % takes fewer increments than the default", coarse < counted(done), coarse)
    check("without an accuracy nothing is told of it", "accuracy" not in done.stdout, done.stdout)


def test_given_increments_stay_and_are_told():
    # Given by hand: increments and tolerance stay, are measured, and a warning says that they do not reach it.
    done, rows = run("hand", text_of("drained", given="increment = 5e-3"), "--accuracy", "1e-6", "--quiet")
    check("given increments stay and are told", done.returncode == 0 and "not reached" in done.stderr
          and "the increments" in done.stderr, done.stderr)
    done, plain = run("plain", text_of("drained", "tolerance = 1e-3 scheme = 1", "increment = 5e-3"), "--quiet")
    done, rows = run("hand", text_of("drained", "tolerance = 1e-3 scheme = 1", "increment = 5e-3"), "--accuracy", "0.3",
                     "--quiet")
    check("what is given by hand stays", rows == plain and len(rows) > 3, (len(rows), len(plain)))


def test_accuracy_of_case_verify():
    # In the case, in the results, and verified.
    done, rows = run("inside", "&case accuracy = 1e-2 /\n" + text_of("drained"), "--verify")
    check("accuracy of &case, --verify", done.returncode == 0 and "verified" in done.stdout, done.stdout + done.stderr)
    check("the results tell it", "# accuracy: asked 1 %, verified" in (work / "inside.csv").read_text())
    verified = estimated(done.stdout)
    done, rows = run("inside", "&case accuracy = 1e-2 /\n" + text_of("drained"))
    ratio = verified["q"][0]/estimated(done.stdout)["q"][0]
    check("--verify finds the estimated error within the band", BAND[0] < ratio < BAND[1], ratio)
    for words, said in ((("--accuracy", "0"), "accuracy"), (("--accuracy", "fine"), "accuracy"),
                        (("--verify",), "ask for")):
        done, rows = run("bad", text_of("drained"), *words)
        check(f"{words}: refused", done.returncode == 2 and said in done.stderr and not rows, done.stderr)
