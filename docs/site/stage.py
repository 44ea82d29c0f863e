# SPDX-License-Identifier: MIT
"""Gathers the pages of the site: the Markdown files of the tree as they are, what they show and link to, and pages that
are made of sources (gallery, C header). Links stay relative, so a page reads the same in the tree and on the site."""
import pathlib
import re
import shutil
import subprocess

import c_header
import gallery

LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s]+)(\))")
FORTRAN = ("umat/core", "umat/abi", "umat/doors", "umat/include", "common", "materials", "drivers/src", "host")
COPIED = (".png", ".svg", ".ipynb")   # beside the page, as they are
# Headings of the margin for pages that the front page does not list; the last takes what is left.
REST = {"Evidence: element tests": "verification/material/", "Evidence: finite elements": "verification/host/",
        "Evidence: studies": "verification/studies/", "Other programs": "clients/", "Further pages": ""}
ORPHAN = "---\norphan: true\n---\n"   # the head of a page that shows a source and stands in no margin
LANGUAGES = {".py": "python", ".f90": "fortran", ".pf": "none", ".h": "c", ".c": "c", ".toml": "toml"}


def committed(root):
    """Markdown files of the tree, committed or new, as paths from its top; `docs/site` is the machinery of the site."""
    told = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"], cwd=root,
                          capture_output=True, text=True)
    names = (told.stdout.split("\n") if told.returncode == 0 else
             [str(path.relative_to(root)) for path in root.rglob("*.md")
              if "build" not in path.relative_to(root).parts])
    return sorted(name for name in set(names) if name and (root / name).is_file() and not name.startswith("docs/site/"))


def without_code(text):
    """The text with code blocks and inline code blanked, so that nothing in them looks like a link."""
    blank = lambda found: re.sub(r"[^\n]", " ", found[0])  # noqa: E731
    text = re.sub(r"^( *)```.*?^\1```", blank, text, flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"`[^`\n]+`", blank, text)


def source_page(name, path):
    """A source that a page links to, as a page of its own."""
    language = LANGUAGES.get(path.suffix, "none")
    return f"{ORPHAN}# `{name}`\n\n```````{language}\n{path.read_text(encoding='utf-8')}\n```````\n"


def staged(root, pages, name):
    """The text of a page for the site; puts the pictures and sources that it links to beside it."""
    text = (root / name).read_text(encoding="utf-8")
    if not re.search(r"^# ", text, re.MULTILINE):   # tables that a script made
        text = f"# {name}\n\n{text}"
    edits = []
    for found in LINK.finditer(without_code(text)):
        target, _, anchor = found[2].partition("#")
        if "://" in target or target.startswith("mailto:") or not target or target.endswith(".md"):
            continue
        path = (root / name).parent / target
        if not path.is_file():
            raise SystemExit(f"{name}: the link to {target} leads nowhere (a link names a file, not a folder)")
        place = pages / path.resolve().relative_to(root)
        place.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix in COPIED:
            shutil.copyfile(path, place)
        else:
            place.with_name(place.name + ".md").write_text(
                source_page(path.resolve().relative_to(root).as_posix(), path), encoding="utf-8")
            edits.append((found.start(2), found.end(2), target + ".md" + ("#" + anchor if anchor else "")))
    for begin, end, new in reversed(edits):
        text = text[:begin] + new + text[end:]
    return text


def fortran_page(root, pages):
    """The Fortran sources: a table a folder, a line a module with the comment at its head, linked to its source."""
    lines = ["# The Fortran sources", "", "A comment `!>` above a procedure gives units, shapes, errors and the source of "
             "its formula.", ""]
    folders = {}
    for path in sorted(path for name in FORTRAN for path in (root / name).rglob("*.f90")):
        folders.setdefault(path.parent.relative_to(root).as_posix(), []).append(path)
    for folder, paths in folders.items():
        lines += [f"## {folder}", "", "| module | |", "|---|---|"]
        for path in paths:
            text = path.read_text(encoding="utf-8")
            head = " ".join(re.findall(r"^!> ?(.*)", re.split(r"^(?:module|program)\b", text, flags=re.MULTILINE)[0],
                                       re.MULTILINE))
            name = path.relative_to(root).as_posix()
            place = pages / (name + ".md")
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(source_page(name, path), encoding="utf-8")
            lines.append(f"| [{path.stem}]({name}.md) | {c_header.escaped(head).replace('|', chr(92) + '|')} |")
        lines.append("")
    return "\n".join(lines)


def with_the_rest(index, names):
    """The front page, and below its lists, for the margin alone, the pages that these do not name, under headings."""
    named = {line.split("<")[-1].rstrip(">") for line in index.splitlines()}
    rest = [name[:-3] for name in names if name[:-3] not in named]
    for caption, folder in REST.items():
        mine = [name for name in rest if name.startswith(folder)]
        rest = [name for name in rest if name not in mine]
        if mine:
            index += f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n" + "\n".join(mine) + "\n```\n"
    return index


def stage(root, pages):
    """Makes the folder `pages` anew."""
    shutil.rmtree(pages, ignore_errors=True)
    names = committed(root)
    for name in names:
        place = pages / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(staged(root, pages, name), encoding="utf-8")
    site = root / "docs/site"
    for page in sorted((site / "pages").glob("*.md")):
        shutil.copyfile(page, pages / page.name)
    index = pages / "index.md"
    index.write_text(with_the_rest(index.read_text(encoding="utf-8"), names), encoding="utf-8")
    (pages / "gallery.md").write_text(gallery.page(root), encoding="utf-8")
    (pages / "fortran.md").write_text(fortran_page(root, pages), encoding="utf-8")
    (pages / "c_header.md").write_text(c_header.page(root / "umat/include/mud.h"), encoding="utf-8")
    return names
