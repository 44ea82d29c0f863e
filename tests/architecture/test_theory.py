# SPDX-License-Identifier: MIT
"""Texts find what they cite: sections of docs/theory, pages that Markdown links to, headings behind a #, files.

Every rule is first shown a planted offence and its nearest innocent neighbour.
"""
import functools
import os
import pathlib
import re

from checking import check, root

SKIPPED = {".git", "build", "__pycache__", "node_modules"}
READ = {".f90", ".pf", ".py", ".md", ".h", ".c", ".nml", ".csv", ".cmake", ".txt", ".sh", ".inp", ".cff", ""}
SHOWN = 30   # findings that are printed of one rule
NUMBER = r"\d+(?:\.\d+)*"
LIST = rf"sections? ({NUMBER}(?:(?:, | and | to | or ){NUMBER})*)"
CITED = re.compile(rf"docs/theory/([\w-]+\.md),? {LIST}")
LINKED = re.compile(rf"\]\(([\w./-]*?)([\w-]+\.md)\),? {LIST}")
OWN = re.compile(rf"(?<!\)) ?\b{LIST}")
HEADING = re.compile(r"^(#{1,6}) +(.*?) *#*$", re.MULTILINE)
LINK = re.compile(r"(?<!\!)\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)\)|!\[[^\]]*\]\(([^()\s]+)\)")
# What the texts once cited and a reader of the repository cannot find; written so that this file does not contain it.
LOST = re.compile("theory" r"\s+page|material-model" r"\.md|shared/" "theory", re.IGNORECASE)


def flat(text):
    """A text without comment marks and line breaks, so that a citation may run on in the next line."""
    return re.sub(r"\s+", " ", re.sub(r"^\s*(?:!>|!<|!|#+|//|\*|/\*)? *", " ", text, flags=re.MULTILINE))


def without_code(text):
    """Markdown without fenced blocks and code spans: what stands there links to nothing."""
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL))


def sections(text):
    """Numbers of the headings of a chapter."""
    return [m[1] for _, title in HEADING.findall(without_code(text)) if (m := re.match(rf"({NUMBER})\.? ", title))]


def slugs(text):
    """Anchors that GitHub gives the headings of a page."""
    found = set()
    for _, title in HEADING.findall(re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title).replace("`", "").lower()
        slug = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")
        number = 1
        while slug in found:
            slug = f"{slug.rsplit('-', 1)[0] if number > 1 else slug}-{number}"
            number += 1
        found.add(slug)
    return found


def missing_sections(text, headings):
    """Citations as docs/theory/NAME.md section N whose chapter or heading does not exist; headings: per chapter."""
    wrong = []
    for name, numbers in CITED.findall(flat(text)):
        if name not in headings:
            wrong.append(f"there is no docs/theory/{name}")
        else:
            wrong += [f"docs/theory/{name} has no section {n}" for n in re.findall(NUMBER, numbers)
                      if n not in headings[name]]
    return wrong


def missing_in_chapter(text, name, headings):
    """Within docs/theory: sections behind a link to a chapter, and sections of the chapter itself."""
    text = flat(without_code(text))
    wrong = [f"{chapter} has no section {n}" for folder, chapter, numbers in LINKED.findall(text)
             if folder in ("", "./") for n in re.findall(NUMBER, numbers) if n not in headings.get(chapter, ())]
    own = re.sub(r"(?:paper's |of the paper: )?\(?its sections? [\d. and]+|[Ss]ections? [\d.]+ of the paper", "",
                 LINKED.sub("", text))
    return wrong + [f"it has no section {n} itself" for numbers in OWN.findall(own) for n in re.findall(NUMBER, numbers)
                    if n not in headings[name]]


def out_of_order(numbers):
    """Chapters are numbered 1, 1.1, 1.2, 2 ... without gaps, so that a number names one place."""
    wrong, count = [], []
    for number in numbers:
        parts = [int(part) for part in number.split(".")]
        expected = count[:len(parts)] + [0]*(len(parts) - len(count))
        expected[-1] += 1
        if parts != expected:
            wrong.append(f"{number} where {'.'.join(map(str, expected))} is expected")
        count = parts
    return wrong


def lost_names(text):
    return [f"`{found}`: cite docs/theory/NAME.md by section" for found in LOST.findall(flat(text))]


def broken_links(text, exists, anchors):
    """Relative links of a page: exists(path) and anchors(path) answer for paths relative to it."""
    wrong = []
    for link, image in LINK.findall(without_code(text)):
        target = link or image
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        if path and not exists(path):
            wrong.append(f"link to {target}: there is no such file")
        elif anchor and anchor not in anchors(path):
            wrong.append(f"link to {target}: there is no such heading")
    return wrong


def missing_files(text, exists):
    """Paths in code spans, `folder/name`; a part in capitals stands for any name."""
    return [f"`{path}`: there is no such file or folder" for path in re.findall(r"`([a-z_]+/[\w./-]*)`", text)
            if not re.search(r"\b(?:\w+_)?[A-Z]{3,}\b", path) and not exists(path)]


def planted_offences():
    chapter = {"a.md": ["1", "1.1", "2"]}
    a = "docs/" "theory/a.md"   # in two parts, lest this file cites it
    page = "# Top\n## 1. First part\n"

    def links(text):
        return broken_links(text, lambda path: path == "b.md", lambda path: slugs(page))

    cases = [
        ("a section that is not there", lambda t: missing_sections(t, chapter),
         f"! {a} section 1.2", f"! {a} section 1.1"),
        ("one on the next line of a comment", lambda t: missing_sections(t, chapter),
         f"!> {a}\n   !> section 3", f"!> {a}\n   !> section 2"),
        ("the second of two", lambda t: missing_sections(t, chapter),
         f"{a} sections 1 and 4", f"{a} sections 1 and 2"),
        ("a chapter that is not there", lambda t: missing_sections(t, chapter),
         f"{a.replace('a.md', 'b.md')} section 1", f"{a} section 1"),
        ("a section behind a link", lambda t: missing_in_chapter(t, "a.md", chapter),
         "see [a.md](a.md) section 1.3", "see [a.md](a.md) section 1.1"),
        ("a section of its own", lambda t: missing_in_chapter(t, "a.md", chapter),
         "see section 7", "see section 2; its sections 3 and 4"),
        ("a gap in the numbers", out_of_order, ["1", "1.2"], ["1", "1.1", "1.2", "2", "2.1"]),
        ("a name that nobody can look up", lost_names, "numbers of the theory" + "\n! page", "a page of theory"),
        ("a link to no file", links, "[x](c.md)", "[x](b.md)"),
        ("a picture that is not there", links, "![x](c.png)", "![x](b.md)"),
        ("a link to no heading", links, "[x](#second)", "[x](#1-first-part)"),
        ("a file that is gone", lambda t: missing_files(t, lambda path: path == "host/mesh"), "in `host/messh`",
         "in `host/mesh`, `host/law_NAME.f90`, read/write"),
        ("a heading of another page", links, "[x](b.md#second)", "`[x](c.md)` [x](https://c.md)")]
    return ([f"{name}: the offence is not seen" for name, rule, bad, _ in cases if not rule(bad)]
            + [f"{name}: innocent text is blamed" for name, rule, _, good in cases if rule(good)])


def texts():
    """(path, contents) of every text of the project; what is not UTF-8 is no text."""
    for folder, folders, files in os.walk(root):
        folders[:] = sorted(f for f in folders if f not in SKIPPED and not f.startswith("build"))
        for name in sorted(files):
            path = pathlib.Path(folder)/name
            if path.suffix not in READ or path.is_symlink():
                continue
            try:
                yield path, path.read_text(encoding="utf-8")
            except UnicodeDecodeError:
                continue


def report(name, findings):
    check(name, not findings, "\n  " + "\n  ".join(findings[:SHOWN]) if findings else "")


def test_the_theory_and_what_cites_it_agree():
    folder = root/"docs/theory"
    chapters = {path.name: path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.md"))}
    headings = {name: sections(text) for name, text in chapters.items()}
    everything = list(texts())

    @functools.lru_cache(maxsize=None)
    def anchors(path):
        return slugs(path.read_text(encoding="utf-8")) if path.suffix == ".md" else set()

    cited, lost, links, count = [], [], [], 0
    for path, text in everything:
        here = path.relative_to(root)
        count += len(CITED.findall(flat(text)))
        cited += [f"{here}: {wrong}" for wrong in missing_sections(text, headings)]
        lost += [f"{here}: {wrong}" for wrong in lost_names(text)]
        if path.suffix == ".md":
            # Pages of the site alone stand beside the README there.
            at = root if here.parts[:3] == ("docs", "site", "pages") else path.parent
            links += [f"{here}: {wrong}" for wrong in broken_links(
                text, lambda p, at=at: (at/p).exists(),
                lambda p, at=at, own=path: anchors((at/p).resolve() if p else own))]

    report("every rule sees its planted offence and nothing else", planted_offences())
    report("there are chapters with numbered sections",
           [name for name in chapters if not headings[name]] if chapters else ["docs/theory is empty"])
    report("sections are numbered without gaps",
           [f"{name}: {wrong}" for name in chapters for wrong in out_of_order(headings[name])])
    report("the index names every chapter",
           [name for name in chapters if name != "README.md" and f"]({name})" not in chapters.get("README.md", "")])
    report("sections cited within the chapters exist",
           [f"{name}: {wrong}" for name in chapters for wrong in missing_in_chapter(chapters[name], name, headings)])
    report("the code cites the chapters", [] if count else ["nothing cites docs/theory by section"])
    report("every section of docs/theory that is cited exists", cited)
    report("no text cites what a reader cannot find", lost)
    report("folders and files that CONTRIBUTING.md names exist",
           missing_files((root/"CONTRIBUTING.md").read_text(encoding="utf-8"),
                         lambda path: path.startswith("build/") or (root/path).exists()))
    report("links of the Markdown pages resolve", links)
