# SPDX-License-Identifier: MIT
"""What the tests of the pages read: files, headings, links, code blocks, and sessions of the screen."""
import re
import unicodedata
from dataclasses import dataclass

FENCE = re.compile(r"^(?P<inset> *)```(?P<info>[^\n`]*)\n(?P<text>.*?)^(?P=inset)```", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


@dataclass(frozen=True)
class Block:
    line: int
    words: list     # of the line that opens it: language, and what the page says of it
    text: str


def blocks(text):
    return [Block(text.count("\n", 0, found.start()) + 1, found["info"].split(), found["text"])
            for found in FENCE.finditer(text)]


def plain(text):
    """The text with its code blanked: what looks like a link or a heading there is none."""
    blank = lambda found: re.sub(r"[^\n]", " ", found[0])  # noqa: E731
    return re.sub(r"`[^`\n]+`", blank, FENCE.sub(blank, text))


def anchor(heading):
    """The target that a forge makes of a heading."""
    heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").strip().lower()
    kept = "".join(c for c in heading if c in "-_ " or unicodedata.category(c)[0] in "LNM")
    return kept.replace(" ", "-")


def anchors(text):
    """Targets of a page; a second heading of the same words gets -1 behind it."""
    seen = {}
    for heading in re.findall(r"^#+ (.+?)\s*$", FENCE.sub("", text), re.MULTILINE):
        name = anchor(heading)
        seen[name] = seen.get(name, -1) + 1
        if seen[name]:
            seen[f"{name}-{seen[name]}"] = 0
    return set(seen)


def broken(name, text, root, anchors_of):
    """Links of a page whose file or heading is not there."""
    wrong = []
    for found in LINK.finditer(plain(text)):
        target, _, heading = found[1].partition("#")
        if "://" in found[1] or target.startswith("mailto:"):
            continue
        path = (root / name).parent / target if target else root / name
        if not path.is_file():
            wrong.append(f"{found[1]}: there is no such file")
        elif heading and heading not in anchors_of(path):
            wrong.append(f"{found[1]}: there is no such heading")
    return wrong


def steps(session):
    """(command, lines expected) of a block `console`; a command goes on behind a backslash."""
    made = []
    for line in session.splitlines():
        if line.startswith("$ "):
            made.append([line[2:], []])
        elif made and made[-1][0].endswith("\\") and not made[-1][1]:
            made[-1][0] += "\n" + line
        elif made:
            made[-1][1].append(line)
        else:
            raise ValueError(f"a session begins with a command, not with {line!r}")
    return made


def agrees(expected, said):
    """Whether the lines are those expected: a line `...` is any lines, `...` within a line any text."""
    if not expected:
        return True
    pattern = "".join(
        r"(?:.*\n)*?" if line.strip() == "..." else re.escape(line.rstrip()).replace(r"\.\.\.", ".*") + r"[ ]*\n"
        for line in expected)
    return re.fullmatch(pattern, said if said.endswith("\n") or not said else said + "\n") is not None
