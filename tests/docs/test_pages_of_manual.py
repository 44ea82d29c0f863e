# SPDX-License-Identifier: MIT
"""The pages of the manual: links and headings exist, commands have options that their programs know, tutorials
and recipes run and say what is printed, troubleshooting quotes messages as they are, and the snippet of README.md
compiles.

The nightly tier also runs the blocks `console heavy` (a fit, an installation).
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from checking import build, check, light, nightly, root, work
import pages  # noqa: E402

HEAVY = nightly and not light
RUN = ("docs/tutorials/", "docs/how-to/")
# Of fenced blocks: Pygments knows them; namelists are read as Fortran.
LANGUAGES = ("console", "c", "cmake", "fortran", "math", "python", "sh", "text", "toml")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")
# What stands at the beginning of a command, and who prints its options.
PROGRAMS = {
    "mud_triax": [build / "drivers/mud_triax", "--help"], "mud_host": [build / "host/mud_host", "--help"],
    "mud_describe": [build / "drivers/mud_describe", "--help"],
    "mud_calibrate": [sys.executable, "-m", "mud.calibration.command", "--help"], "check": [root / "check", "--help"],
    "verification/run": [root / "verification/run", "--help"],
    "plot_case.py": [sys.executable, root / "drivers/plot_case.py", "--help"],
    "plot_run.py": [sys.executable, root / "host/plot_run.py", "--help"]}
COMMAND = re.compile(r"^(?:\$ |    )?(?:[A-Z_]+=\S+ )*(?:build/venv/bin/python3 |build/release/\w+/|\./)?"
                     r"(?:(?!clients)[\w.]+/)*(mud_triax|mud_host|mud_describe|mud_calibrate|check|"
                     r"verification/run|plot_case\.py|plot_run\.py)(?= )(?P<words>[^|>#!\n]*)", re.MULTILINE)


def files(*patterns):
    """Committed and new files, or, without git, what lies in the tree."""
    told = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns], cwd=root,
                          capture_output=True, text=True)
    found = (told.stdout.split("\n") if told.returncode == 0 else
             [str(path.relative_to(root)) for pattern in patterns for path in root.rglob(pattern)
              if "build" not in path.relative_to(root).parts])
    return sorted(name for name in found if name and (root / name).is_file() and not name.startswith("docs/site/"))


def rule(name, findings):
    check(name, not findings, "\n  " + "\n  ".join(findings[:30]))


def anchors_of(path, known={}):  # noqa: B006 (a cache)
    if path not in known:
        known[path] = pages.anchors(path.read_text(encoding="utf-8")) if path.suffix == ".md" else set()
    return known[path]


def planted():
    """What each rule has to see, and what it has to leave alone."""
    text = "# A b\n\n[x](a.md#a-b) [y](a.md#c) [z](b.md) `[n](none.md)`\n```\n[n](none.md)\n```\n"
    (work / "a.md").write_text(text)
    found = pages.broken("a.md", text, work, lambda path: pages.anchors(path.read_text()))
    return ([] if [one.split(":")[0] for one in found] == ["a.md#c", "b.md"] else [f"links: {found}"]) + [
        f"{expected} and {said!r}" for expected, said, good in (
            (["a", "..."], "a\nb\nc\n", True), (["a...c"], "abc", True), (["a", "c"], "a\nb\nc\n", False),
            (["1.5 kPa"], "1x5 kPa", False), (["...", "c"], "a\nc\nd\n", False))
        if pages.agrees(expected, said) != good] + [
        "options: the offence is not seen" for _ in [0] if not unknown_options("    mud_triax a.nml --no-such x\n")]


# A Python without sanitizers cannot load a library with them; the library of release serves it where it is built.
UNTRIED = set()
if os.environ.get("MUD_PRESET") == "sanitize" and not any((root / "build/release/umat").glob("libmud.so*")):
    print("note: the options of mud_calibrate are looked at in the other builds")
    UNTRIED.add("mud_calibrate")


def help_of(program, known={}):  # noqa: B006 (a cache)
    if program not in known:
        done = subprocess.run(PROGRAMS[program], capture_output=True, text=True,
                              env=dict(os.environ, PYTHONPATH=str(root / "python"), MUD_PYTHON=sys.executable))
        known[program] = done.stdout + done.stderr
    return known[program]


def unknown_options(text):
    return [f"{found[1]} has no {option}" for found in COMMAND.finditer(text.replace("\\\n", " "))
            for option in OPTION.findall(found["words"].split("--pass ")[0])
            if found[1] not in UNTRIED and not re.search(re.escape(option) + r"(?![\w-])", help_of(found[1]))]


def unsaid(text):
    """Messages that a page quotes in the first column of a table, and that no source holds."""
    told = "".join((root / name).read_text(encoding="utf-8") for name in files("*.f90", "*.py", "*.sh"))
    told = told.replace("''", "'")
    quoted = re.findall(r'"([^"]+)"', "".join(re.findall(r"^\| [^|]*", text, re.MULTILINE)))
    return [message for message in quoted if message not in told] if quoted else ["no message is quoted"]


def tree():
    """A folder that looks like the top of the tree, whose programs are those of this build."""
    top = work / "tree"
    (top / "build").mkdir(parents=True)
    for entry in root.iterdir():
        if entry.name not in ("build", ".git"):
            (top / entry.name).symlink_to(entry)
    (top / "build/release").symlink_to(build)
    (top / "build/venv/bin").mkdir(parents=True)
    python = top / "build/venv/bin/python3"
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    python.chmod(0o755)
    return top


def run_page(name, top):
    """Writes the files of the page and runs its sessions in their order; what is not as printed."""
    environment = dict(os.environ, MPLBACKEND="Agg", OMP_NUM_THREADS="1")
    variables, wrong, number = "", [], 0
    for block in pages.blocks((root / name).read_text(encoding="utf-8")):
        language, *rest = block.words or [""]
        if language != "console" and rest:
            (top / rest[0]).write_text(block.text)
        if language != "console" or (rest == ["heavy"] and not HEAVY):
            continue
        for command, expected in pages.steps(block.text):
            number += 1
            if command.startswith("export "):
                variables += command + "\n"
                continue
            done = subprocess.run(["bash", "-c", "set -e\n" + variables + command], cwd=top,
                                  env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            if done.returncode or not pages.agrees(expected, done.stdout):
                wrong.append(f"line {block.line}: {command}: exit code {done.returncode}, said\n{done.stdout}")
    return wrong, number


def snippet_compiles():
    """The C of README.md, in a main program that prints its status."""
    text = (root / "README.md").read_text(encoding="utf-8")
    code = next(block.text for block in pages.blocks(text) if block.words == ["c"])
    source, program = work / "snippet.c", work / "snippet"
    source.write_text('#include <stdio.h>\n#include "mud.h"\nint main(void)\n{\n' + code
                      + 'printf("%d %.6f\\n", status, report.reached);\nreturn 0;\n}\n')
    library = build / "umat/libmud.so"
    made = subprocess.run([os.environ.get("CC", "cc"), "-Wall", "-Werror", "-I", root / "umat/include", source, library,
                           f"-Wl,-rpath,{library.parent}", "-o", program], capture_output=True, text=True)
    said = subprocess.run([program], capture_output=True, text=True).stdout if made.returncode == 0 else made.stderr
    check("the C of README.md compiles and updates a point", said == "0 1.000000\n", said)


def test_there_are_pages_to_look_at():
    texts = {name: (root / name).read_text(encoding="utf-8") for name in files("*.md")}
    rule("every rule sees its planted offence and nothing else", planted())
    check("there are pages to look at", len(texts) > 50 and "README.md" in texts, len(texts))
    rule("links lead to files and headings that there are", [
        f"{name}: {what}" for name, text in texts.items() if name != "CHANGELOG.md"
        for what in pages.broken(name, text, root, anchors_of)])
    rule("headings are short: one that was wrapped with its paragraph is none", [
        f"{name}: {line}" for name, text in texts.items() for line in pages.FENCE.sub("", text).split("\n")
        if re.match("#+ ", line) and len(line) > 100])
    rule("commands have options that their programs know", [
        f"{name}: {what}" for name, text in texts.items() for what in unknown_options(text)])
    rule("code is of a language that the site can colour, or of none", [
        f"{name}, line {block.line}: {block.words[0]}" for name, text in texts.items() for block in pages.blocks(text)
        if block.words and block.words[0] not in LANGUAGES])
    rule("troubleshooting quotes messages as they are", unsaid(texts["docs/troubleshooting.md"]))

    # The checking builds print the same; their sanitizers have nothing to find in a page.
    if not light:
        snippet_compiles()
        for page in [name for name in texts if name.startswith(RUN)]:
            top = tree()
            wrong, commands = run_page(page, top)
            check(f"{page} runs as it is printed", not wrong, "\n" + "\n".join(wrong))
            check(f"{page} has commands that run", commands > 0)
            shutil.rmtree(top)
