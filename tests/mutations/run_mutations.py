# SPDX-License-Identifier: MIT
"""Change the library in one place at a time and see which tests notice.

Usage: run_mutations.py [--contact | --regions | --field] [-k WORD] [--most N] [--readme] [--keep] [-j N]. Works on a
copy of the source tree in a temporary folder; builds release with our own runner. A mutation that no test notices
survives: exit code 1. One that does not apply or does not compile is an error of mutations.py: exit code 2.
  --contact  mutations of the host's contact instead: its suites and the page verification/host/contact
  --regions  mutations of what regions of the host do: its suites of models and elements
  --field    mutations of what the field does to a boundary: limits of pressure, gravity, ground and strength in time
  -k WORD    only mutations whose title contains it
  --most N   only mutations that at most N tests noticed when the table was written: 0, those it does not have
  --readme   write the table to README.md (CONTACT.md, REGIONS.md, FIELD.md) beside this file; what was left out keeps
             its row
  --keep     keep the temporary folder
  --apply    only see whether every mutation applies: nothing is built or run
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

from mutations import CONTACT, FIELD, MUTATIONS, REGIONS

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "common"))
import tables  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LEFT_OUT = {"test_random", "test_random_long"}  # minutes each
TIMEOUT = 180   # s; the slowest suite takes 5 s, so a suite that takes longer hangs
PATIENCE = 4    # a page may take so many times what it takes unchanged
UNCHANGED = 1800  # s, for a page unchanged, on a machine that has other work
FAILED = re.compile(r"^FAILED (\w+) at", re.MULTILINE)


def run(command, folder, **more):
    return subprocess.run(command, cwd=folder, text=True, errors="replace", stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, **more)


class Library:
    """The library and its suites."""
    mutations, sources, table, title = MUTATIONS, "umat", "README.md", "Mutations"
    command = "python3 tests/mutations/run_mutations.py --readme"
    judges = "the suites of `tests/umat/core` and `tests/umat/contract`"
    patterns, programs, pages = ("tests/umat/core/*/*.pf", "tests/umat/contract/*.pf"), [], []


class Contact:
    """The host's contact, its suites and its page of known answers."""
    mutations, sources, table, title = CONTACT, "host", "CONTACT.md", "Mutations of the contact"
    command = "python3 tests/mutations/run_mutations.py --contact --readme"
    judges = ("the suites of contact and drainage in `tests/host`, and, where none of them notices, "
              "`verification/run host/contact --quick`")
    patterns = ("tests/host/contact/*.pf", "tests/host/model/test_contact_drainage.pf")
    programs, pages = ["mud_host"], ["host/contact"]


class Regions:
    """What the regions of the host do, and its suites of models and elements."""
    mutations, sources, table, title = REGIONS, "host", "REGIONS.md", "Mutations of regions"
    command = "python3 tests/mutations/run_mutations.py --regions --readme"
    judges = "the suites of `tests/host/model` and `tests/host/element`"
    patterns, programs, pages = ("tests/host/model/*.pf", "tests/host/element/*.pf"), [], []


class Field:
    """What the field does to a boundary, with suites of the host that run scenes."""
    mutations, sources, table, title = FIELD, "host", "FIELD.md", "Mutations of the field"
    command = "python3 tests/mutations/run_mutations.py --field --readme"
    judges = ("the suites of limited pressures, elements and friction in `tests/host`, and, where none of them "
              "notices, `verification/run host/stages --quick` and the suites of scenes on gravity, ground, strength, "
              "water, dissolved air and free surfaces")
    patterns = ("tests/host/terms/test_run_off.pf", "tests/host/element/test_element_equations.pf",
                "tests/host/contact/test_contact_penalty.pf", "tests/host/contact/test_contact_interfaces.pf")
    programs, pages = ["mud_host", "umat_tresca"], ["host/stages"]
    scenes = ["gravity", "stages", "strength", "water", "dissolved_air", "free_surface"]


subject = Library


def suites_of(tree):
    files = sum((sorted(tree.glob(pattern)) for pattern in subject.patterns), [])
    return [file.stem for file in files if file.stem not in LEFT_OUT]


def build(tree, jobs, targets):
    """Output if the build fails, else None."""
    done = run(["cmake", "--build", "build", "-j", str(jobs), "--target", *targets], tree)
    return done.stdout if done.returncode else None


def failures_of(tree, suite):
    """Names of the tests of a suite that fail, as suite.test."""
    program = tree / "build" / "tests" / suite
    environment = dict(os.environ, MUD_SOURCE_DIR=str(tree), MUD_BUILD_DIR=str(tree / "build"), MUD_PRESET="release")
    try:
        done = run([str(program)], tree, env=environment, timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        return [f"{suite} (hangs)"]
    names = [f"{suite}.{name}" for name in FAILED.findall(done.stdout)]
    if done.returncode and not names:
        return [f"{suite} (stops)"]
    return names


def failures_of_page(tree, page, seconds):
    """Whether a page of known answers fails within so many seconds, as page (k claims)."""
    venv = ROOT / "build/venv/bin/python3"
    environment = dict(os.environ, MUD_BUILD_DIR=str(tree / "build"))
    try:
        done = run([venv if venv.exists() else sys.executable, tree / "verification/tools/runner.py", page, "--quick"],
                   tree, env=environment, timeout=seconds)
    except subprocess.TimeoutExpired:
        return [f"{page} (hangs)"]
    missed = len(re.findall("^ +FAILED ", done.stdout, re.MULTILINE))
    if not done.returncode and not missed:
        return []
    return [f"{page} ({missed} claims)" if re.search(r"^\d+ passed", done.stdout, re.MULTILINE) else f"{page} (stops)"]


def failures_of_scenes(tree, scenes, seconds):
    """Names of the tests of suites of Python that fail, each suite in a process of its own."""
    venv = ROOT / "build/venv/bin/python3"
    environment = dict(os.environ, MUD_BUILD_DIR=str(tree / "build"))
    found = []
    for scene in scenes:
        file = f"tests/host/test_host_{scene}.py"
        try:
            done = run([venv if venv.exists() else sys.executable, "-m", "pytest", "-q", file], tree, env=environment,
                       timeout=seconds)
        except subprocess.TimeoutExpired:
            return [f"{scene} (hangs)"]
        found += [f"{scene}.{name}" for name in re.findall(r"^FAILED \S+::(\w+)", done.stdout, re.MULTILINE)]
        if found:
            return found
        if done.returncode:
            return [f"{scene} (stops)"]
    return found


def failures_of_suites(tree, jobs):
    """What the suites notice; ValueError where they do not compile."""
    problem = build(tree, jobs, suites_of(tree))
    if problem:
        raise ValueError("does not compile:\n" + problem[-2000:])
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        found = list(pool.map(lambda suite: failures_of(tree, suite), suites_of(tree)))
    return sorted(set(sum(found, [])))


def failures_of_pages(tree, jobs, seconds):
    """What the pages notice, with the programs they need."""
    if not subject.pages:
        return []
    problem = build(tree, jobs, subject.programs)
    if problem:
        raise ValueError("does not compile:\n" + problem[-2000:])
    found = sum((failures_of_page(tree, page, seconds) for page in subject.pages), [])
    return found or failures_of_scenes(tree, getattr(subject, "scenes", []), seconds)


def mutate(tree, changes):
    """Apply (file, old, new) ...; the originals by file."""
    originals = {}
    for file, old, new in changes:
        path = tree / subject.sources / file
        text = path.read_text(encoding="utf-8")
        originals.setdefault(path, text)
        if text.count(old) != 1:
            raise ValueError(f"{file}: {old!r} stands there {text.count(old)} times, not once")
        path.write_text(text.replace(old, new), encoding="utf-8")
    return originals


def restore(originals):
    for path, text in originals.items():
        path.write_text(text, encoding="utf-8")


def apply_all(tree):
    """Whether every mutation finds its lines: exit code 2 where one does not."""
    broken = 0
    for title, *changes in subject.mutations:
        try:
            restore(mutate(tree, changes))
        except (ValueError, OSError) as error:
            broken += 1
            print(f"ERROR {title}: {error}")
    print(f"{len(subject.mutations)} mutations, {broken} not applicable")
    return 2 if broken else 0


def rows_of_page():
    """Lines of the present table by title."""
    page = HERE / subject.table
    lines = page.read_text(encoding="utf-8").splitlines() if page.exists() else []
    return {line.split("|")[1].strip(): line for line in lines if line.startswith("| ")}


def tests_in(row):
    """How many tests noticed the mutation of a line of the table, 0 without one."""
    return int(row.split("|")[2]) if row else 0


def write_readme(table, rows):
    for title, caught in table:
        shown = ", ".join(f"`{name}`" for name in caught[:4])
        if len(caught) > 4:
            shown += f" and {len(caught) - 4} more"
        rows[title] = f"| {title} | {len(caught)} | {shown or '**none**'} |"
    rows = [rows[title] for title, *_ in subject.mutations if title in rows]
    survived = sum(not tests_in(row) for row in rows)
    lines = [f"# {subject.title}", "",
             f"`{subject.command}` changes `{subject.sources}` in one place at a time "
             f"(`mutations.py`), builds it and runs {subject.judges}. It is not part of "
             "`./check`. \"(hangs)\" and \"(stops)\" mean that the program of the suite hung or stopped.", "",
             f"Measured: {len(rows)} mutations, {len(rows) - survived} noticed, {survived} survived."
             + (f" Left out: {', '.join(sorted(LEFT_OUT))}." if subject is Library else ""), "",
             "| mutation | tests | noticed by |", "|---|---|---|", *rows]
    (HERE / subject.table).write_text(tables.wrapped("\n".join(lines)), encoding="utf-8")


def main():
    global subject
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--contact", action="store_true")
    arguments.add_argument("--regions", action="store_true")
    arguments.add_argument("--field", action="store_true")
    arguments.add_argument("-k", default="", metavar="WORD")
    arguments.add_argument("--most", type=int, metavar="N")
    arguments.add_argument("--readme", action="store_true")
    arguments.add_argument("--keep", action="store_true")
    arguments.add_argument("--apply", action="store_true")
    arguments.add_argument("-j", type=int, default=os.cpu_count())
    arguments = arguments.parse_args()
    subject = (Contact if arguments.contact else Regions if arguments.regions else Field if arguments.field
               else Library)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="mud-mutations-"))
    tree = folder / "mud"
    try:
        shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns("build", ".git", "__pycache__"))
        if arguments.apply:
            return apply_all(tree)
        configured = run(["cmake", "-S", ".", "-B", "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                          "-DMUD_PRESET=release", "-DMUD_USE_PFUNIT=OFF", "-DMUD_WERROR=OFF",
                          "-DMUD_BUILD_DRIVERS=OFF", f"-DMUD_BUILD_HOST={'OFF' if subject is Library else 'ON'}"], tree)
        if configured.returncode:
            print(configured.stdout)
            return 2
        before = failures_of_suites(tree, arguments.j)
        began = time.monotonic()
        failing = failures_of_pages(tree, arguments.j, UNCHANGED)
        allowed = max(TIMEOUT, PATIENCE*(time.monotonic() - began))
        print(f"unchanged: {len(suites_of(tree))} suites, failing {before + failing or 'none'}", flush=True)
        if failing:
            print("the page fails unchanged: does build/venv exist (./check makes it)?")
            return 2
        table, broken, rows = [], 0, rows_of_page()
        for title, *changes in subject.mutations:
            if arguments.k not in title:
                continue
            if arguments.most is not None and tests_in(rows.get(title, "")) > arguments.most:
                continue
            originals = {}
            try:
                originals = mutate(tree, changes)
                caught = [name for name in failures_of_suites(tree, arguments.j) if name not in before]
                if not caught:
                    caught = failures_of_pages(tree, arguments.j, allowed)
            except ValueError as error:
                broken += 1
                print(f"ERROR {title}: {error}", flush=True)
                restore(originals)
                continue
            restore(originals)
            table.append((title, caught))
            print(f"{'caught' if caught else 'SURVIVED'}: {title}: {len(caught)}: {', '.join(caught)}", flush=True)
        survived = [title for title, caught in table if not caught]
        print(f"{len(table)} mutations, {len(survived)} survived, {broken} not applicable")
        if arguments.readme:
            write_readme(table, rows)
        return 2 if broken else bool(survived)
    except ValueError as problem:
        print(f"unchanged: {problem}")
        return 2
    finally:
        if arguments.keep:
            print(f"kept: {folder}")
        else:
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
