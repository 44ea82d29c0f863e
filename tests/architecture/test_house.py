# SPDX-License-Identifier: MIT
"""One house: tables have one reader, public procedures a comment, and documents name only what is there. Every rule is
first shown a planted offence."""
import pathlib
import re
import subprocess

from checking import check, root

COLUMNS = 120
LANGUAGES = (".f90", ".pf", ".py", ".c", ".h", ".sh", ".cmake")

READER = re.compile(r"\bcsv\.(reader|DictReader)\b|\b(loadtxt|genfromtxt|read_csv)\b|\.split\([\"'],[\"']\)")
# Words of earlier versions: elastic domain, reset of the memory, did not converge, docs/theory/FILE.md, porous balance.
OLD_WORDS = re.compile(r"nucleus|re-?seat|\b(goes|went) astray|theory[ ]page|\bfe_point\b", re.IGNORECASE)
PROCEDURE = re.compile(r"(?!\s*end\b)\s*(?:(?:pure|elemental|recursive|impure|logical|integer|\w+\([^)]*\))\s+)*"
                       r"(?:subroutine|function)\s+(?P<name>\w+)", re.IGNORECASE)
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
TOPS = "common|umat|materials|host|drivers|tests|verification|scripts|docs|benchmarks|cmake"
PLACE = re.compile(rf"`((?:{TOPS})/[\w./-]+)`")


def own_readers(lines):
    return [f"{number}: {line.strip()}" for number, line in enumerate(lines, 1) if READER.search(line)]


def old_words(lines):
    return [f"{number}: {found[0]}" for number, line in enumerate(lines, 1) if (found := OLD_WORDS.search(line))]


def statement(lines, number):
    """The Fortran statement that begins in a line, with its continuation lines."""
    last = next(i for i in range(number - 1, len(lines)) if not lines[i].rstrip().endswith("&"))
    return "\n".join(lines[number - 1:last + 1])


def uncommented(lines):
    """Public procedures of a Fortran module without a comment `!>` directly above; those of C (bind) have theirs in
    mud.h, mud_triax.h or the system."""
    text = re.sub(r"&\s*\n\s*", "", "\n".join(lines))
    public = {name.strip().lower() for found in re.finditer(r"^\s*public\s*::\s*([^!\n]*)", text, re.MULTILINE)
              for name in found[1].split(chr(44))}
    return [f"{number}: {found['name']} has no comment !> above it" for number, line in enumerate(lines, 1)
            if (found := PROCEDURE.match(line)) and found["name"].lower() in public
            and "bind(c" not in statement(lines, number)
            and not lines[number - 2].lstrip().startswith("!>")]


def unfinished(lines):
    """Comments beside a declaration (`!<`) that go on beside the next one."""
    return [f"{number}: {line.split('!<')[1].strip()}" for number, line in enumerate(lines, 1)
            if re.search(r"!<.*[,;:]\s*$", line)
            and not (number < len(lines) and lines[number].lstrip().startswith("!<"))]


def gone(text, folder, exists):
    """Links of a document that lead nowhere, and places in backticks that are not there."""
    links = [target for target in LINK.findall(text) if "://" not in target and not target.startswith("mailto:")
             and not exists(folder / target)]
    places = [place for place in PLACE.findall(text) if not re.search(r"[A-Z]{4,}|\bbuild/", place)
              and not any(exists(root / name) for name in (place, place + ".nml", "verification/" + place))]
    return links + places


def wide(lines):
    """Lines of a page beyond 120 columns, outside of code, formulas, tables and pictures."""
    found, inside = [], False
    for number, line in enumerate(lines, 1):
        text = line.strip()
        inside ^= text.startswith(("```", "~~~")) or text == "$$"
        if len(line) > COLUMNS and not (inside or line.startswith("    ")
                                        or text.startswith(("|", "#", "![", "$", "<")) or " " not in text):
            found.append(f"{number}: {len(line)} columns")
    return found


def planted():
    there = {root / "host/README.md", root / "docs/a.md", root / "common"}
    exists = there.__contains__
    cases = [("a reader of its own", own_readers, ["rows = csv.DictReader(file)"], ["rows = tables.rows(file)"]),
             ("a table taken apart", own_readers, ["a = line.split(',')"], ["a = line.split(';')"]),
             ("a public procedure without a comment", uncommented, ["public :: a", "", "pure real(wp) function a(x)"],
              ["public :: a", "!> What it is.", "pure real(wp) function a(x)", "end function a", "function b(x)"]),
             ("a comment that goes on beside the next declaration", unfinished,
              ["integer :: a   !< One number,", "integer :: b   !< and another."],
              ["integer :: a   !< One number,", "               !< or more.", "integer :: b   !< Another: 2."]),
             ("an old word", old_words, ["! the way out of the nucleus"], ["! the way out of the elastic domain"]),
             ("a wide line of a page", wide, ["word " * 25],
              ["word " * 24, "| " + "word " * 25, "```", "word " * 25, "```"]),
             ("numpy's reader", own_readers, ["a = np.loadtxt(path)"], ["a = tables.columns(path)"])]
    documents = [("a link", "[a](b.md)", "[a](a.md#b) [c](https://x.org/y)"),
                 ("a folder", "`host/src` and", "`host/README.md`, `host/FOLDER/x`")]
    return ([f"{name}: the offence is not seen" for name, rule, bad, _ in cases if not rule(bad)]
            + [f"{name}: innocent code is blamed" for name, rule, _, good in cases if rule(good)]
            + [f"{name}: the offence is not seen" for name, bad, _ in documents if not gone(bad, root / "docs", exists)]
            + [f"{name}: an innocent text is blamed" for name, _, good in documents
               if gone(good, root / "docs", exists)])


def files(*suffixes):
    """Committed and new files, or, without git, what lies in the tree."""
    told = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=root,
                          capture_output=True, text=True)
    names = told.stdout.split("\n") if told.returncode == 0 else [
        str(path.relative_to(root)) for path in root.rglob("*") if "build" not in path.relative_to(root).parts]
    return sorted(name for name in names if name and (root / name).is_file()
                  and (pathlib.Path(name).suffix in suffixes or pathlib.Path(name).name in suffixes))


def over(names, rule):
    found = []
    for name in names:
        found += [f"{name}: {what}" for what in rule((root / name).read_text(encoding="utf-8").splitlines())]
    return found


def rule(name, findings):
    check(name, not findings, "\n  " + "\n  ".join(findings[:30]))


def test_there_are_sources_of_every_language_to_look_at():
    sources = files(*LANGUAGES, "CMakeLists.txt", "check", "demo", "run", "benchmark")
    rule("every rule sees its planted offence and nothing else", planted())
    check("there are sources of every language to look at",
          {".f90", ".pf", ".py", ".c", ".h"} <= {pathlib.Path(name).suffix for name in sources}, len(sources))


def test_sources_and_pages_keep_the_rules():
    # Scripts of clients/ run in the Python of a foreign program, and the
    # Python package is installed, without this tree.
    rule("tables are read by common/tables.py", over(
        [name for name in files(".py") if not name.startswith("clients/")
         and name not in ("common/tables.py", "python/mud/_csv.py", "tests/architecture/test_house.py")], own_readers))
    rule("texts say the words of today", over(
        [name for name in files(*LANGUAGES, ".md", ".nml")
         if name not in ("CHANGELOG.md", "tests/architecture/test_house.py", "tests/docs/test_changelog.py")],
        old_words))
    rule("public procedures have a comment", over(
        [name for name in files(".f90") if name.split("/")[0] in ("common", "umat", "materials", "host", "drivers")],
        uncommented))
    rule("a comment ends before the next declaration", over(
        [name for name in files(".f90") if not name.startswith("tests/")], unfinished))
    rule("documents name only what is there", [
        f"{name}: {what}" for name in files(".md") if name != "CHANGELOG.md" and not name.startswith("docs/site/")
        for what in gone((root / name).read_text(encoding="utf-8"), (root / name).parent, pathlib.Path.exists)])
    rule(f"pages are wrapped at {COLUMNS} columns", over(
        [name for name in files(".md") if not name.startswith(("tests/mutations/", "benchmarks/results/"))
         and not re.fullmatch(r"calibration/\w+/README.md", name)], wide))
