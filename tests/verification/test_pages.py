# SPDX-License-Identifier: MIT
"""The pages of verification/material and studies as the check run takes them; READMEs that say what the pages declare;
and that the runner sees what is wrong."""
import subprocess
import sys

from checking import build, check, work
from page_checks import pages, run_section, verification  # noqa: E402
from tools import readme, runner  # noqa: E402
from tools.bench import Bench, absolute, changed  # noqa: E402
from tools.page import Page, Tolerance  # noqa: E402

# The READMEs say what the pages declare.
RENEW = "renew it with verification/run --list --update"


def refuses(what, action, *words):
    try:
        action()
    except (ValueError, RuntimeError, TypeError) as problem:
        check(what, all(word in str(problem) for word in words), problem)
    else:
        check(what, False, "nothing was said")


def test_the_of_verification_readme_md_are_those_of_the_pages():
    run_section("material", "studies")
    front = (verification / "README.md").read_text(encoding="utf-8")
    for mark, content in (("kinds", readme.kinds()), ("index", readme.index(pages, runner.SECTIONS))):
        check(f"the {mark} of verification/README.md are those of the pages",
              (readme.block(front, mark) or "").strip() == content.strip(), RENEW)
    for name, page in pages.items():
        text = (verification / name / "README.md").read_text(encoding="utf-8")
        check(f"{name}: its README says what it declares", (readme.block(text, "page")
                                                            or "").strip() == readme.declaration(name, page).strip(),
              RENEW)
        check(f"{name}: its README has a table of checks", (readme.block(text, "checks") or "").count("\n") > 2,
              "verification/run PAGE --update")
        shown = "".join(path.read_text(encoding="utf-8") for path in (verification / name).glob("*.md"))
        for picture in page.pictures:
            check(f"{name}: the picture {picture} is there and shown",
                  (verification / name / picture).exists() and f"({picture})" in shown)


def test_against():
    # A tolerance that nothing can miss proves nothing: what is wrong is seen.
    bench = Bench(verification / "material/lode", build, work / "planted")
    tight = Tolerance("planted", absolute=0.01)
    for value, reference, good in ((1.0, 1.1, False), (1.0, 1.005, True), (float("nan"), 1.0, False),
                                   ([1.0, 2.0], [1.0, 2.1], False)):
        bench.near("planted", value, reference, tight)
        check(f"{value} against {reference}", bench.checks[-1].passed is good, bench.checks[-1])
    bench.near("planted", [100.0, 50.0], [101.0, 50.0], Tolerance("planted", relative=0.01))
    check("a relative tolerance is of the reference", bench.checks[-1].passed
          and abs(bench.checks[-1].allowed - 1.01) < 1e-12, bench.checks[-1])
    bench.below("planted", float("nan"), tight)
    check("a NaN is below nothing", not bench.checks[-1].passed)

    refuses("a comparison of nothing", lambda: bench.near("planted", [], [], tight), "planted", "nothing to compare")
    refuses("a tolerance without a reason", lambda: Tolerance(" ", absolute=1.0), "reason")
    refuses("a kind that there is not", lambda: Page("c", "proved", "i", "r", 1.0), "proved", "exact")
    refuses("a change of a text that is not there", lambda: changed("a = 1", [("b = 1", "b = 2")], "scene.nml"),
            "scene.nml", "b = 1")
    refuses("a case that fails", lambda: bench.driver_text("&stage\n/\n"), "case", "exit code")
    check("relative names of files become absolute", absolute("file = 'a.msh'",
                                                              work) == f"file = '{(work / 'a.msh').resolve()}'"
          and absolute("file = '/b.msh'", work) == "file = '/b.msh'")
    missing = runner.run_page("material/lode", work / "nowhere", work / "out")
    check("a program that is not built fails the page", missing.failed ==
          1 and "not built" in missing.error, missing.error)

    command = [sys.executable, verification / "tools/runner.py", "--build", build, "--output", work / "command"]
    done = subprocess.run([*command, "nonsense"], capture_output=True, text=True)
    check("a page that there is not: said with the names", done.returncode == 2 and "no page nonsense" in done.stderr
          and "material/lode" in done.stderr,
          done.stderr)
    done = subprocess.run([*command, "--quick", "--update"], capture_output=True, text=True)
    check("--update takes whole pages", done.returncode == 2 and "leave out --quick" in done.stderr, done.stderr)
    done = subprocess.run([*command, "lode"], capture_output=True, text=True)
    check("a page by its short name: closing line, exit code, picture", done.returncode == 0
          and done.stdout.splitlines()[-1] == "5 passed, 0 failed"
          and (work / "command/material/lode/lode.png").exists(), done.stdout + done.stderr)
    done = subprocess.run([*command, "lode", "--build", work / "nowhere"], capture_output=True, text=True)
    check("a page that fails: exit code and closing line", done.returncode == 1
          and done.stdout.splitlines()[-1] == "0 passed, 1 failed", done.stdout)
    done = subprocess.run([*command, "--list"], capture_output=True, text=True)
    check("--list names every page", done.returncode == 0 and all(name in done.stdout for name in pages), done.stdout)
