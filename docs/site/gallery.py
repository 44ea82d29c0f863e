# SPDX-License-Identifier: MIT
"""The gallery: of every page of the verification a picture, the claim, what was measured and allowed, and the seconds.

All of it is read from the page's README.md, which `verification/run --update` keeps; nothing is repeated by hand.
"""
import posixpath
import re

SECTIONS = {"material": "Material: element tests", "host": "Finite elements", "studies": "Studies"}
BLOCK = r"<!-- made: {} -->\n(.*?)<!-- end -->"
LINK = re.compile(r"(?<=\]\()(?![a-z]+:|#)[^)\s]+")
PICTURE = re.compile(r"!\[[^\]]*\]\(([^)]+\.(?:png|svg))\)")
MOST_CHECKS = 6


def rows(table):
    """The cells of a table of Markdown, a list a row, without head and rule."""
    lines = [line for line in table.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines[2:]]


def block(text, mark):
    found = re.search(BLOCK.format(mark), text, re.DOTALL)
    return found[1] if found else ""


def seen_from_top(text, folder):
    """The text of a page of a folder, with what it links to as a page at the top of the tree names it."""
    return LINK.sub(lambda found: posixpath.normpath(posixpath.join(folder, found[0])), text)


def entry(root, folder):
    """The part of one page; None if it declares nothing."""
    place = folder.relative_to(root).as_posix()
    text = seen_from_top((folder / "README.md").read_text(encoding="utf-8"), place)
    facts = dict(row[:2] for row in rows(block(text, "page")))
    if "claim" not in facts:
        return None
    link = f"{place}/README.md"
    lines = [f"### [{text.splitlines()[0].lstrip('# ')}]({link})", ""]
    if picture := PICTURE.search(text):
        lines += [f"![{folder.name}]({picture[1]})", ""]
    kind = ", ".join(re.findall(r"\*\*([^*]+)\*\*", facts["kind"]))
    seconds = facts["run"].split(": ", 1)[-1]
    lines += [f"**{facts['claim'][0].upper()}{facts['claim'][1:]}.**", "",
              f"Kind: {kind}. Reference: {facts['reference']}. Time: {seconds}.", ""]
    checks = rows(block(text, "checks"))
    if checks:
        lines += ["| check | measured or off by | allowed |", "|---|---|---|"]
        lines += [f"| {name} | {off or measured} | {allowed} |"
                  for name, measured, _, off, allowed, *_ in checks[:MOST_CHECKS]]
        more = len(checks) - MOST_CHECKS
        lines += ["", f"{more} more on [its page]({link})." if more > 0 else "", ""]
    return "\n".join(lines)


def page(root):
    lines = ["# Gallery", "",
             "Every page of the verification: its claim, the measured deviation, what is allowed, and the time that "
             "it takes. The numbers are those of the last whole run; [verification](verification/README.md) says how to "
             "repeat it.", ""]
    for section, title in SECTIONS.items():
        lines += [f"## {title}", ""]
        for folder in sorted((root / "verification" / section).iterdir()):
            if (folder / "README.md").is_file() and (made := entry(root, folder)):
                lines += [made]
    return "\n".join(lines)
