# SPDX-License-Identifier: MIT
"""Material files: one group ``&material`` with ``key = value`` lines; ``!`` begins a comment."""

from __future__ import annotations

import os
import pathlib
import re

from .errors import InputError

TOKEN = re.compile(r"""\s*(?:(?P<word>[^\s=,!&/'"]+)|(?P<text>'[^']*'|"[^"]*")|(?P<mark>[=&/])|,)""")


def read_material(path: str | os.PathLike) -> dict[str, float | str]:
    """Entries of a material file by name: numbers, words, and the texts ``name`` and ``reference``."""
    path = pathlib.Path(path)
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as problem:
        raise InputError(f"{path} cannot be read: {problem.strerror}") from problem
    tokens = [
        (number, match) for number, line in enumerate(lines, 1) for match in TOKEN.finditer(_without_comment(line))
    ]
    marks = [match["mark"] for _, match in tokens]
    if marks.count("&") != 1 or marks[:1] != ["&"] or tokens[1][1]["word"] != "material" or marks[-1] != "/":
        raise InputError(f"{path}: a material file holds exactly one group, &material ... /")
    entries: dict[str, float | str] = {}
    inner = [token for token in tokens[2:-1] if token[1].group().strip() != ","]
    if len(inner) % 3:
        raise InputError(f"{path}: the group &material is not made of key = value lines")
    for (number, key), (_, equals), (_, value) in zip(inner[::3], inner[1::3], inner[2::3]):
        if key["word"] is None or equals["mark"] != "=" or value["mark"]:
            raise InputError(f"{path}:{number}: not a line key = value")
        if key["word"] in entries:
            raise InputError(f"{path}:{number}: {key['word']} is given twice")
        entries[key["word"]] = value["text"][1:-1] if value["text"] else _number(value["word"])
    return entries


def _without_comment(line: str) -> str:
    quoted = ""
    for i, letter in enumerate(line):
        if quoted:
            quoted = "" if letter == quoted else quoted
        elif letter in "'\"":
            quoted = letter
        elif letter == "!":
            return line[:i]
    return line


def _number(word: str) -> float | str:
    try:
        return float(word.lower().replace("d", "e"))
    except ValueError:
        return word
