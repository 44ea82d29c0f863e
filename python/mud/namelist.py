# SPDX-License-Identifier: MIT
"""Material files: one group ``&material`` with ``key = value`` lines; ``!`` begins a comment.

Read as mud_triax reads them: names in letters of either size, any encoding, a text between quotes of either kind, inside
which the same quote is written twice.
"""

from __future__ import annotations

import os
import pathlib
import re

from ._texts import text_of_bytes
from .errors import InputError

TOKEN = re.compile(
    r"""[\s,]+ | (?P<comment>!.*) | (?P<mark>[=&/]) | (?P<text>'(?:[^']|'')*'|"(?:[^"]|"")*") | (?P<open>['"])
    | (?P<word>[^\s,=!&/'"]+)""",
    re.VERBOSE,
)
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([edED][+-]?\d+)?")
TEXTS = ("name", "reference")
LONGEST = 200  # bytes of a name or reference that is written; the readers take 256


def quoted(text: str, longest: int | None = None) -> str:
    """A text as a value that every reader takes back: in one line, between quotes that it does not have or has twice."""
    plain = " ".join(text.splitlines()).encode()[:longest].decode(errors="ignore")
    mark = '"' if "'" in plain and '"' not in plain else "'"
    return mark + plain.replace(mark, 2 * mark) + mark


def tokens_of(text: str, path: str | os.PathLike) -> list[tuple[int, re.Match[str]]]:
    """Line numbers and matches of TOKEN: marks, words and texts, without comments. ``path`` is told in errors."""
    tokens = []
    for number, line in enumerate(text.splitlines(), 1):
        for match in TOKEN.finditer(line):
            if match["open"]:
                raise InputError(f"{path}:{number}: a quoted text is not closed; add {match['open']}")
            tokens += [(number, match)] if match.lastgroup not in (None, "comment") else []
    return tokens


def word_of(value: re.Match[str]) -> str:
    """A word, or a text as it is meant between its quotes."""
    mark = value["text"][0] if value["text"] else ""
    return value["text"][1:-1].replace(2 * mark, mark) if mark else value["word"]


def value_of(value: re.Match[str]) -> float | str:
    """A number where the word or text is one, as the readers of texts take it, else the word."""
    word = word_of(value)
    return float(word.lower().replace("d", "e")) if NUMBER.fullmatch(word) else word


def read_material(path: str | os.PathLike) -> dict[str, float | str]:
    """Entries of a material file by name: numbers, words, and the texts ``name`` and ``reference``."""
    path = pathlib.Path(path)
    try:
        text, _ = text_of_bytes(path.read_bytes())
    except OSError as problem:
        raise InputError(f"{path} cannot be read: {problem.strerror}") from problem
    tokens = tokens_of(text, path)
    marks = [match["mark"] for _, match in tokens]
    if marks.count("&") != 1 or marks[0] != "&" or (tokens[1][1]["word"] or "").lower() != "material" or marks[-1] != "/":
        raise InputError(f"{path}: a material file holds exactly one group, &material ... /")
    inner = tokens[2:-1]
    if len(inner) % 3:
        raise InputError(f"{path}: the group &material is not made of key = value lines")
    entries: dict[str, float | str] = {}
    for (number, key), (_, equals), (_, value) in zip(inner[::3], inner[1::3], inner[2::3]):
        if key["word"] is None or equals["mark"] != "=" or value["mark"]:
            raise InputError(f"{path}:{number}: not a line key = value")
        name = key["word"]
        if name.lower() in map(str.lower, entries):
            raise InputError(f"{path}:{number}: {name} is given twice")
        if name.lower() in TEXTS:
            entries[name.lower()] = word_of(value)
        else:
            entries[name] = value_of(value)
    return entries
