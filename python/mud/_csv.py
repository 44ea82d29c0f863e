# SPDX-License-Identifier: MIT
"""The package's one reader of CSV tables: a wheel has nothing of the tree's common/."""

from __future__ import annotations

import csv
import os
import pathlib

from ._texts import text_of_bytes
from .errors import InputError


def cells_of(line: str, mark: str = ",") -> list[str]:
    """Cells of a line, quoted ones without their quotes."""
    return next(csv.reader([line], delimiter=mark))


def rows_of(path: str | os.PathLike) -> list[tuple[int, list[str]]]:
    """(line, cells) of every row that is neither empty nor a comment (#), the names of the columns first."""
    try:
        text, _ = text_of_bytes(pathlib.Path(path).read_bytes())
    except OSError as problem:
        raise InputError(f"{path} cannot be read: {problem.strerror}") from problem
    if "\0" in text:
        raise InputError(f"{path} is no text; save it as CSV")
    return [
        (number, cells_of(line))
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.startswith("#")
    ]
