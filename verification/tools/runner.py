# SPDX-License-Identifier: MIT
"""Runs pages of the verification.

    verification/run                          all pages
    verification/run material host/cylinder   a section, a page; the name alone does where there is one of it
    verification/run --list                   what there is, and which data are older than the model (umat/core)
    verification/run --all --make --update    overnight: makes the data of every page again, the cheap ones first, then
                                              runs and writes the pages, as far as both fit into three hours; after an
                                              interruption the same command goes on where it stood
    verification/run --quick                  short versions of what the check run takes, without pictures

Every page prints its checks, each with what it is off by, what is allowed, value and reference; the last line is
`N passed, M failed`, the exit code 1 if a check failed. Pictures go to build/verification/PAGE and nothing is written
into the source tree but with
    --update   puts declarations, tables of checks, pictures and the index of verification/README.md into the tree
               (with --list: without running anything, what does not depend on results)
    --make     runs the programs that made the committed data of the pages instead, some of them for hours, and says
               what has changed; with --update the files are taken into the tree
"""
import argparse
import concurrent.futures
import contextlib
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import threading
import time
import traceback
from dataclasses import dataclass, field

HERE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(HERE))
sys.dont_write_bytecode = True
from tools import pictures, readme  # noqa: E402
from tools.bench import ROOT, Bench  # noqa: E402
from tools.page import Tolerance  # noqa: E402

sys.path.append(str(ROOT / "common"))
import tables  # noqa: E402

SECTIONS = {"material": "element tests with mud_triax", "host": "scenes with mud_host",
            "studies": "the program compared with itself and with published results"}
SAME = Tolerance("generated from the committed files")


AGES = HERE / "made.csv"   # script,core: with which core a script last made its data
NIGHT = 3*3600.0           # s of one core, of the scripts and the pages that --all --make runs
ONE = threading.Lock()     # Held where pages that are made side by side would meet: loading, and what is written down.


@dataclass
class Outcome:
    """What running a page gave."""
    name: str
    checks: list = field(default_factory=list)
    notes: list = field(default_factory=list)
    pictures: list = field(default_factory=list)
    error: str = ""
    seconds: float = 0.0

    @property
    def passed(self):
        return sum(c.passed for c in self.checks)

    @property
    def failed(self):
        return len(self.checks) - self.passed + bool(self.error)


def names():
    """All pages in the order of the sections."""
    return [f"{section}/{path.parent.name}" for section in SECTIONS
            for path in sorted((HERE / section).glob("*/page.py"))]


def load(name):
    """The module of a page, which finds what it imports in its folder and its section's. Modules of other pages are
    forgotten, so that two may have a name in common."""
    folder = HERE / name
    for module, found in list(sys.modules.items()):
        place = pathlib.Path(getattr(found, "__file__", None) or "/")
        if HERE in place.parents and "tools" not in place.parts:
            del sys.modules[module]
    for path in (str(folder.parent), str(folder)):
        if path in sys.path:
            sys.path.remove(path)
        sys.path.insert(0, path)
    spec = importlib.util.spec_from_file_location("page_" + name.replace("/", "_"), folder / "page.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def scripts_of(name):
    """What made committed files of a page."""
    with ONE:
        return getattr(load(name), "MAKES", ())


def declared():
    return {name: load(name).PAGE for name in names()}


def run_page(name, build, output, quick=False):
    """Runs the checks of a page and, unless quick, draws its pictures."""
    outcome, start = Outcome(name), time.monotonic()
    bench = Bench(HERE / name, build, pathlib.Path(output) / name, quick)
    try:
        module = load(name)
        results = module.check(bench)
        for file, blocks in (module.texts(bench) if hasattr(module, "texts") else {}).items():
            text = (bench.here / file).read_text(encoding="utf-8")
            for mark, content in blocks.items():
                bench.near(f"{file}, {mark}: texts that are not what the committed files say",
                           readme.block(text, mark) != readme.made(content), 0, SAME)
        if not quick and hasattr(module, "draw"):
            plt = pictures.pyplot()
            module.draw(bench, results, plt)
            plt.close("all")
        if not bench.checks:
            raise RuntimeError("the page compared nothing")
        if not quick and set(bench.pictures) != set(module.PAGE.pictures):
            raise RuntimeError(f"the page declares pictures {module.PAGE.pictures} and drew {tuple(bench.pictures)}")
    except (RuntimeError, ValueError, OSError) as problem:
        outcome.error = f"{type(problem).__name__}: {problem}"
    except Exception:   # a mistake in the page itself: where
        outcome.error = traceback.format_exc()
    outcome.checks, outcome.notes, outcome.pictures = bench.checks, bench.notes, bench.pictures
    outcome.seconds = time.monotonic() - start
    return outcome


def run_pages(chosen, build, output, quick=False, jobs=1):
    """Outcomes as they come."""
    if jobs == 1:
        for name in chosen:
            yield run_page(name, build, output, quick)
        return
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        waiting = [pool.submit(run_page, name, build, output, quick) for name in chosen]
        for done in concurrent.futures.as_completed(waiting):
            yield done.result()


def report(outcome, place=""):
    print(f"{outcome.name}{place}: {outcome.passed} passed, {outcome.failed} failed, {outcome.seconds:.1f} s")
    for line in outcome.notes:
        print("   " + line)
    if outcome.error:
        print(f"   FAILED {outcome.error}")
    for name in outcome.pictures:
        print(f"   picture {name}")
    sys.stdout.flush()


# ---- --update

def write(path, text):
    if path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
        print(f"   written {path.relative_to(ROOT)}")


def update_index():
    path = HERE / "README.md"
    text = readme.replaced(path.read_text(encoding="utf-8"), "kinds", readme.kinds())
    write(path, readme.replaced(text, "index", readme.index(declared(), SECTIONS)))


def update_texts(name, output):
    """What does not depend on a run: the declaration, and what the committed files say."""
    folder, module = HERE / name, load(name)
    texts = module.texts(Bench(folder, ".", output / name)) if hasattr(module, "texts") else {}
    texts.setdefault("README.md", {})["page"] = readme.declaration(name, module.PAGE)
    for file, blocks in texts.items():
        text = (folder / file).read_text(encoding="utf-8")
        for mark, content in blocks.items():
            text = readme.replaced(text, mark, content)
        write(folder / file, text)


def renew_texts(chosen, output):
    """Writes the texts of pages; names of those that could not be made of their data, which is told and stops no
    other."""
    failed = []
    for name in chosen:
        try:
            update_texts(name, output)
        except Exception:   # A night has made data that the page did not expect.
            failed.append(name)
            print(f"FAILED {name}: its texts\n{traceback.format_exc()}", flush=True)
    return failed


def update_page(outcome, output):
    """Table of checks and pictures."""
    folder = HERE / outcome.name
    path = folder / "README.md"
    write(path, readme.replaced(path.read_text(encoding="utf-8"), "checks", readme.measured(outcome.checks)))
    for picture in outcome.pictures:
        shutil.copyfile(output / outcome.name / picture, folder / picture)


# ---- --make

def make(name, build, output, update, only, arguments, log=False):
    """Runs the scripts of a page in its folder of the output; True if all ended well. log: what a script prints goes
    to SCRIPT.log of that folder, as beside others. Without `only` those that run alone are left out."""
    good = True
    for script in scripts_of(name):
        if only and script.name not in only:
            continue
        if script.alone and not only:
            print(f"{name}: {script.name} runs alone, about {script.seconds:g} s: --make --only {script.name}")
            continue
        print(f"{name}: {script.name}, about {script.seconds:g} s" + (f", needs {script.needs}" if script.needs
                                                                      else ""), flush=True)
        if absent := missing(script):
            print(f"   FAILED {script.name}: needs {', '.join(absent)}, which {sys.executable} has not")
            good = False
            continue
        results = output / name / "made"
        results.mkdir(parents=True, exist_ok=True)
        start = time.monotonic()
        with open(output / name / f"{script.name}.log", "w", encoding="utf-8") if log else contextlib.nullcontext() as file:
            code = subprocess.run([sys.executable, HERE / name / script.name, *arguments], cwd=results, stdout=file,
                                  stderr=file, env={**os.environ, "MUD_BUILD_DIR": str(build),
                                                    "MUD_VERIFICATION_OUTPUT": str(results), "PYTHONPATH":
                                                    os.pathsep.join(filter(None, (str(HERE),
                                                                                  os.environ.get("PYTHONPATH"))))
                                                    }).returncode
        said = [f"{name}: {script.name} took {time.monotonic() - start:.0f} s"]
        good = good and code == 0
        if code:
            said.append(f"   FAILED {script.name}: exit code {code}" + (f", see {file.name}" if log else ""))
        else:
            said += take(name, script, results, update)
        print("\n".join(said), flush=True)
    return good


def take(name, script, results, update):
    """Says which files of a script have changed; with update they go into the tree."""
    said = []
    if update:
        note_age(name, script)
    for pattern in script.files:
        for made in sorted(results.glob(pattern)):
            file = made.relative_to(results)
            kept = HERE / name / file
            same = kept.exists() and kept.read_bytes() == made.read_bytes()
            said.append(f"   {'same   ' if same else 'changed'} {file}")
            if update and not same:
                kept.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(made, kept)
    return said


def missing(script):
    """Packages and programs that a script needs and that are not there."""
    return [need for need in script.needs.split(", ") if need and not importlib.util.find_spec(need)
            and not shutil.which(need)]


def core():
    """The core of the tree as git counts its contents; empty without git or with changes that are not committed."""
    said = [subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True) for words in (
        ("rev-parse", "HEAD:umat/core"), ("status", "--porcelain", "umat/core"))]
    return said[0].stdout.strip() if not any(done.returncode for done in said) and not said[1].stdout.strip() else ""


def ages():
    """{page/script: core that it was made with}."""
    return {row["script"]: row["core"] for row in tables.rows(AGES)} if AGES.exists() else {}


def note_age(name, script):
    with ONE:
        made = {**ages(), f"{name}/{script.name}": core()}
        AGES.write_text("script,core\n" + "".join(f"{key},{made[key]}\n" for key in sorted(made)), encoding="utf-8")


def older(name):
    """Scripts of a page whose committed data were made with another core, or it is not known with which."""
    known, now = ages(), core()
    return [script.name for script in scripts_of(name) if not now
            or known.get(f"{name}/{script.name}") != now]


def in_a_night(chosen):
    """{page: scripts} that fit into a night beside the pages: the cheap pages first, the scripts of a page in their
    order, for one may read what another made. What does not fit, runs alone or cannot run here is said."""
    makes = {name: scripts_of(name) for name in chosen}
    taken, spent = {}, sum(load(name).PAGE.seconds for name in chosen)   # the pages run afterwards
    for name in sorted(makes, key=lambda name: sum(script.seconds for script in makes[name])):
        for script in makes[name]:
            if absent := missing(script):
                print(f"left out, {', '.join(absent)} is not here: verification/run {name} --make --only {script.name}")
            elif not script.alone and spent + script.seconds <= NIGHT:
                taken.setdefault(name, []).append(script.name)
                spent += script.seconds
            else:
                print(f"left out, {script.seconds:g} s: verification/run {name} --make --only {script.name}")
    print(f"scripts of {len(taken)} pages and {len(chosen)} pages, about {spent:.0f} s of one core", flush=True)
    return taken


def make_night(taken, build, output, update, jobs=1):
    """Makes {page: scripts}, of each page in their order, jobs pages at the same time (then the dear ones first); True
    for every script that ended well. OUTPUT/night.csv keeps which did, and with which core: a night that goes on after
    an interruption leaves them out. Who ends the night removes it."""
    kept, now = output / "night.csv", core()
    before = {row["script"] for row in tables.rows(kept) if now and row["core"] == now} if kept.exists() else set()

    stopped = threading.Event()

    def page(name):
        good = []
        for script in taken[name]:
            key = f"{name}/{script}"
            if stopped.is_set():
                break
            if key in before:
                print(f"{key}: made before the interruption", flush=True)
            good.append(key in before or make(name, build, output, update, [script], [], jobs > 1))
            if good[-1] and key not in before and not stopped.is_set():
                with ONE, open(kept, "a", encoding="utf-8") as file:
                    file.write(f"{key},{now}\n" if file.tell() else f"script,core\n{key},{now}\n")
        return good

    if jobs == 1:
        return [good for name in taken for good in page(name)]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        try:
            return [good for some in pool.map(page, list(taken)[::-1]) for good in some]
        except BaseException:
            stopped.set()   # The scripts that run end, or the keyboard ends them too; no other begins.
            raise


def chosen_of(words, parser):
    """Names of pages from the words of the command line."""
    every, chosen = names(), []
    for word in words:
        word = word.strip("/")
        found = [n for n in every if word in (n, n.split("/")[0])] or [n for n in every if n.split("/")[1] == word]
        if not found:
            parser.error(f"there is no page {word}; there are {', '.join(every)}")
        chosen += [n for n in found if n not in chosen]
    return chosen or every


def main():
    parser = argparse.ArgumentParser(prog="verification/run", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", nargs="*", metavar="PAGE")
    parser.add_argument("--all", action="store_true", help="with --make: what fits into a night, then all pages")
    parser.add_argument("--list", action="store_true", help="name the pages and run nothing")
    parser.add_argument("--quick", action="store_true", help="as the check run does")
    parser.add_argument("--update", action="store_true", help="write into the source tree what was found")
    parser.add_argument("--make", action="store_true", help="make the committed data of the pages again")
    parser.add_argument("--only", nargs="+", metavar="SCRIPT", help="with --make: only these scripts")
    parser.add_argument("--pass", nargs=argparse.REMAINDER, default=[], dest="arguments", metavar="ARGUMENT",
                        help="with --make: everything behind this goes to the scripts (series.py --help)")
    parser.add_argument("-j", type=int, default=1, metavar="N", help="pages at the same time, with --all --make their scripts too (1)")
    parser.add_argument("--build", type=pathlib.Path, default=os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release",
                        help="build folder with the programs (build/release)")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "build/verification",
                        help="where results go (build/verification)")
    options = parser.parse_args()
    if options.update and options.quick:
        parser.error("--update takes whole pages: leave out --quick")
    if options.all and (options.pages or options.only):
        parser.error("--all takes every page: leave out names and --only")
    build, output = options.build.resolve(), options.output.resolve()
    chosen = chosen_of(options.pages, parser)
    if options.list:
        for name in chosen:
            page = load(name).PAGE
            print(f"{name:32s} {page.seconds:6g} s  {', '.join(page.kind)}: {page.claim}")
            if old := older(name):
                print(f"{'':32s}   older than the core: {', '.join(old)}")
            if options.update:
                update_texts(name, output)
        if options.update:
            update_index()
        return 0
    if options.all and options.make:
        taken = in_a_night(chosen)
        good = make_night(taken, build, output, options.update, options.j)
        print(f"{good.count(True)} scripts ended well, {good.count(False)} failed", flush=True)
    elif options.make:
        good = [make(name, build, output, options.update, options.only, options.arguments) for name in chosen]
        return 0 if all(good) else 1
    if options.quick:
        chosen = [name for name in chosen if load(name).PAGE.quick]
    print(f"{len(chosen)} pages, about "
          f"{sum(page.quick if options.quick else page.seconds for page in (load(n).PAGE for n in chosen)):.0f} s "
          f"of one core", flush=True)
    unwritten = renew_texts(chosen, output) if options.update else []
    outcomes = []
    for outcome in run_pages(chosen, build, output, options.quick, options.j):
        outcomes.append(outcome)
        report(outcome, f" ({len(outcomes)} of {len(chosen)})")
        if options.update and not outcome.error:
            update_page(outcome, output)
    if options.update:
        update_index()
    if options.all and options.make:
        (output / "night.csv").unlink(missing_ok=True)
    failed = sum(o.failed for o in outcomes) + len(unwritten)
    for outcome in outcomes:
        if outcome.failed:
            print(f"FAILED {outcome.name}: {outcome.failed} of {len(outcome.checks) + bool(outcome.error)}")
    print(f"{sum(o.passed for o in outcomes)} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
