# SPDX-License-Identifier: MIT
"""Sheets as laboratories write them: CSV, semicolons, tabs or blanks, decimal commas, workbooks.

What a sheet says is brought to heads and rows of cells with a point as decimal mark. What had to be understood for that is
kept as pairs (in the sheet, understood as).
"""

from __future__ import annotations

import dataclasses
import os
import pathlib
import re
from collections import Counter
from collections.abc import Sequence

from .._csv import cells_of
from .._texts import text_of_bytes
from ..errors import InputError
from .heads import NO_UNITS, Head, head_of, unit_of

LEAST_KNOWN = 2  # heads that make a line the line of names
LINES_ABOVE = 200  # in which the line of names is looked for
_DECIMAL = {mark: re.compile(rf"^[+-]?\d+[{mark}]\d+([eE][+-]?\d+)?$") for mark in ",."}
# 1.234,5 and 1.234: figures in threes, which a number below one has not.
_THOUSANDS = {mark: re.compile(rf"^[+-]?[1-9]\d{{0,2}}([{mark}]\d{{3}})+([{other}]\d+)?$") for mark, other in (",.", ".,")}


@dataclasses.dataclass
class Sheet:
    """A table of a file; ``understood``: pairs (in the sheet, understood as)."""

    title: str  #: of a sheet of a workbook, else empty
    line: int  #: of the names
    heads: list[Head]
    rows: list[tuple[int, list[str]]]
    understood: list[tuple[str, str]]


def read_sheets(path: str | os.PathLike, kind: str) -> list[Sheet]:
    """The sheets of a file that have rows: one of a text, those of a workbook in their order. kind : of the tests in them.

    Raises ``InputError`` for a file that cannot be read.
    """
    path = pathlib.Path(path)
    if path.suffix.lower() in (".xlsx", ".xlsm"):
        found = _workbook(path)
    else:
        told: list[tuple[str, str]] = []
        found = [("", _text(path, kind, told), told)]
    return [_sheet(title, rows, kind, told) for title, rows, told in found if rows]


def _sheet(title: str, rows: list[tuple[int, list[str]]], kind: str, understood: list[tuple[str, str]]) -> Sheet:
    first = _line_of_names([cells for _, cells in rows], kind) or 0
    if first:
        lines = f"lines {rows[0][0]} to {rows[first - 1][0]}" if first > 1 else f"line {rows[0][0]}"
        understood.append((lines, "above the line of names, not read"))
    rows = _second_line_of_units(rows[first:], understood)
    width = max((i + 1 for i, cell in enumerate(rows[0][1]) if cell.strip()), default=0)
    heads = [head_of(cell, kind) for cell in rows[0][1][:width]]
    body = [(number, cells[:width] if _blank(cells[width:]) else cells) for number, cells in rows[1:]]
    return Sheet(title, rows[0][0], heads, body, understood)


def _blank(cells: Sequence[str]) -> bool:
    return not any(cell.strip() for cell in cells)


def _text(path: pathlib.Path, kind: str, understood: list[tuple[str, str]]) -> list[tuple[int, list[str]]]:
    try:
        text, letters = text_of_bytes(path.read_bytes())
    except OSError as problem:
        raise InputError(f"{path} cannot be read: {problem.strerror}") from problem
    if letters:
        understood.append(("letters", letters))
    if "\0" in text:
        raise InputError(f"{path} is no text; save the table as CSV or .xlsx")
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip()]
    comments = [(n, line.lstrip("# ")) for n, line in lines if line.startswith("#")]
    lines = [(n, line) for n, line in lines if not line.startswith("#")]
    numbers = [line for _, line in lines if sum(map(str.isdigit, line)) > sum(map(str.isalpha, line))]
    numbers = numbers or [line for _, line in lines]  # a long preamble says nothing of the rows
    mark = _separator(numbers)
    if mark in SEPARATORS:
        understood.append((f"{SEPARATORS[mark]} between cells", "the separator"))
    rows = [(n, _split(line, mark)) for n, line in lines]
    width = Counter(len(_split(line, mark)) for line in numbers).most_common(1)[0][0] if numbers else 0
    if mark == " ":
        rows = [(n, _split_names(line, cells, width)) for (n, line), (_, cells) in zip(lines, rows)]
    if _line_of_names([cells for _, cells in rows], kind) is None:
        rows = sorted([*rows, *_names_in_comment(comments, kind, mark, width, understood)])
    rows = _decimal_points(rows, mark, understood)
    return [(n, cells) for n, cells in rows if not _blank(cells)]


SEPARATORS = {"\t": "tabs", ";": "semicolons", " ": "blanks"}  # that are told
_GAP = re.compile(r"\d\s+[+-]?[\d.]")  # two numbers with a blank between them


def _separator(lines: list[str]) -> str:
    """What stands between the cells of more than half of the lines. With blanks between numbers commas are decimal marks."""

    def most(meets) -> bool:
        return sum(map(bool, map(meets, lines))) > len(lines) / 2

    for mark in ("\t", ";"):
        if most(lambda line: mark in line):
            return mark
    if most(lambda line: "," in line) and not most(_GAP.search):
        return ","
    return " " if most(lambda line: len(line.split()) > 1) else ","


def _split(line: str, mark: str) -> list[str]:
    return cells_of(" ".join(line.split()), " ") if mark == " " else cells_of(line, mark)


def _split_names(line: str, cells: list[str], width: int) -> list[str]:
    """Cells of a line with blanks inside its names: two blanks or a bracket tell where a name ends."""
    joined = re.sub(r"\s*/\s*", "/", re.sub(r"\s+(?=[\[({])", "", line.strip()))
    ways = [cells, re.split(r"\s{2,}|\t", line.strip()), joined.split(), re.split(r"\s{2,}|(?<=[\])}])\s+", line.strip())]
    return next((way for way in ways if len(way) == width), cells)


def _names_in_comment(
    comments: list[tuple[int, str]], kind: str, mark: str, width: int, understood: list[tuple[str, str]]
) -> list[tuple[int, list[str]]]:
    """The comment line that names the columns, as numpy.savetxt writes it; none if no comment does."""
    for number, line in comments:
        for other in dict.fromkeys((mark, ",", ";", "\t", " ")):
            cells = _split_names(line, _split(line, other), width) if other == " " else _split(line, other)
            if len(cells) == width and _line_of_names([cells], kind) == 0:
                understood.append((f"the comment in line {number}", "the line of names"))
                return [(number, cells)]
    return []


def _decimal_points(
    rows: list[tuple[int, list[str]]], separator: str, understood: list[tuple[str, str]]
) -> list[tuple[int, list[str]]]:
    """Numbers with a point as decimal mark and without marks between thousands."""
    cells = {cell.strip() for _, row in rows for cell in row}
    grouped = {mark: {c for c in cells if _THOUSANDS[mark].match(c)} for mark in ",."}
    decimal = {mark: {c for c in cells if _DECIMAL[mark].match(c)} for mark in ",."}
    # 1,234 can be either; 0,5 and 1.234,5 have a decimal comma.
    sure = {mark: bool(decimal[mark] - grouped[mark] or grouped[other] - decimal[other]) for mark, other in (",.", ".,")}
    commas = sure[","] or (not sure["."] and separator != "," and bool(grouped[","]))
    other = "." if commas else ","
    thousands = set() if sure[other] else grouped[other]
    if commas:
        understood.append(("commas inside numbers", "decimal marks"))
    if thousands:
        understood.append((f"{'points' if commas else 'commas'} inside numbers, as in {min(thousands)}", "between thousands"))

    def point(cell: str) -> str:
        word = cell.strip().replace(other, "") if cell.strip() in thousands else cell.strip()
        return word.replace(",", ".") if _DECIMAL[","].match(word) else word if cell.strip() in thousands else cell

    return [(n, [point(cell) for cell in row]) for n, row in rows]


def _workbook(path: pathlib.Path) -> list[tuple[str, list[tuple[int, list[str]]], list[tuple[str, str]]]]:
    """(title, rows, what was understood) of every sheet."""
    try:
        import openpyxl
    except ImportError as problem:
        raise ImportError("workbooks need openpyxl: pip install 'mud-soil[calibrate]'") from problem
    try:
        book = openpyxl.load_workbook(path, read_only=True, data_only=True)
    except OSError as problem:
        raise InputError(f"{path} cannot be read: {problem.strerror}") from problem
    except Exception as problem:  # openpyxl raises what its parts raise
        raise InputError(f"{path} is no workbook that openpyxl reads: {problem}") from problem
    sheets = []
    for sheet in book.worksheets:
        commas: set[str] = set()
        rows = [
            (n, [_cell(v, commas) for v in values])
            for n, values in enumerate(sheet.iter_rows(values_only=True), 1)
        ]
        rows = [(n, cells) for n, cells in rows if not _blank(cells) and not cells[0].startswith("#")]
        told = [(f"cells of text as {min(commas)}", "numbers with decimal commas")] if commas else []
        sheets.append((sheet.title, rows, told))
    book.close()
    return sheets


def _cell(value: object, commas: set[str]) -> str:
    """A cell of a workbook as text; text that is a number with a decimal comma is taken as one, and kept in ``commas``."""
    if isinstance(value, str) and _DECIMAL[","].match(value.strip()):
        commas.add(value.strip())
        return value.strip().replace(",", ".")
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)


def _line_of_names(rows: Sequence[Sequence[str]], kind: str) -> int | None:
    """Number of the first row in which names are found; None where none is."""
    for i, cells in enumerate(rows[:LINES_ABOVE]):
        if sum(bool(head_of(cell, kind).quantity) for cell in cells if cell.strip()) >= LEAST_KNOWN:
            return i
    return None


def _second_line_of_units(
    rows: list[tuple[int, list[str]]], understood: list[tuple[str, str]]
) -> list[tuple[int, list[str]]]:
    """A line of units below the names goes into the names: one with a unit and without numbers."""
    if len(rows) < 2:
        return rows
    units = [cell.strip().strip("[](){}").strip() for cell in rows[1][1]]
    if not any(map(unit_of, units)) or any(re.match(r"[+-]?[.,]?\d", unit) and unit != "1" for unit in units):
        return rows
    units += [""] * (len(rows[0][1]) - len(units))
    names = [f"{name.strip()} [{unit}]" if unit not in NO_UNITS else name for name, unit in zip(rows[0][1], units)]
    understood.append((f"line {rows[1][0]}", "units of the names above it"))
    return [(rows[0][0], names), *rows[2:]]
