# SPDX-License-Identifier: MIT
"""Sheets as laboratories write them: CSV, semicolons and decimal commas, tabs, workbooks; heads in words with units.

What a sheet says is brought to the form of ``tables``: names of quantities, units, a point as decimal mark. What had to be
understood for that is kept as pairs (in the sheet, understood as).
"""

from __future__ import annotations

import codecs
import dataclasses
import os
import pathlib
import re

from .._csv import cells_of
from ..errors import InputError

# Units, and what they are worth in kPa or as a fraction; "" is a pure number.
UNITS = {
    "percent": 0.01,
    "pct": 0.01,
    "pc": 0.01,
    "%": 0.01,
    "kPa": 1.0,
    "MPa": 1000.0,
    "Pa": 0.001,
    "bar": 100.0,
    "kN/m2": 1.0,
    "kN/m²": 1.0,
    "MN/m2": 1000.0,
    "MN/m²": 1000.0,
    "N/mm2": 1000.0,
    "N/mm²": 1000.0,
    "kg/cm2": 98.0665,
    "kgf/cm2": 98.0665,
    "psi": 6.894757293168361,
    "degrees": 1.0,
}
_LOWER_UNITS = {unit.lower(): unit for unit in UNITS} | {"mpa": "MPa", "pa": "Pa"}
NO_UNITS = ("", "-", "1")
# Heads in words: letters and figures alone, in lower case -> quantity.
WORDS = {
    "test": ("sample", "specimen", "testno", "testname", "sampleno", "probe", "versuch", "ensayo", "muestra", "essai"),
    "eps_a": ("axialstrain", "verticalstrain", "eps1", "epsa", "epsilon1", "epsilona", "ε1", "εa"),
    "eps_v": ("volumetricstrain", "volumestrain", "volstrain", "epsv", "epsvol", "epsilonv", "εv", "εvol"),
    "gamma": ("shearstrain", "γ", "engineeringshearstrain"),
    "q": ("deviatorstress", "deviatoricstress", "stressdifference", "principalstressdifference"),
    "p": ("meanstress", "meaneffectivestress", "effectivemeanstress", "p'", "peff", "p′"),
    "sigma_a": ("axialstress", "verticalstress", "effectiveverticalstress", "effectiveaxialstress")
    + ("sigma1", "sigma1'", "sigmav", "sigmav'", "σ1", "σ1'", "σ'1", "σv", "σ'v", "σv'", "σa", "σ'a"),
    "sigma_r": ("radialstress", "effectiveradialstress", "effectiveconfiningpressure", "confiningstress")
    + ("effectivecellpressure", "lateralstress", "effectivelateralstress")
    + ("sigma3", "sigma3'", "sigmah", "sigmah'", "σ3", "σ3'", "σ'3", "σh", "σ'h", "σr", "σ'r"),
    "u": ("porepressure", "excessporepressure", "porewaterpressure", "excessporewaterpressure", "δu", "du"),
    "e": ("voidratio",),
    "e_0": ("initialvoidratio", "voidratioatstart", "e0", "einit", "eini"),
    "suction": ("matricsuction", "suctionpressure"),
    "S_w": ("degreeofsaturation", "saturation", "saturationdegree", "sw"),
    "stress_ratio": ("stressratio", "principalstressratio"),
    "cycle": ("cycleno", "cyclenumber"),
    "r_u": ("porepressureratio", "ru"),
    "G_max": ("gmax", "smallstrainshearmodulus", "maximumshearmodulus", "g0"),
    "G_ratio": ("g/gmax", "g/g0", "modulusratio"),
    "damping": ("dampingratio",),
    "csr": ("cyclicstressratio", "crr"),
    "N": ("cyclestoliquefaction", "numberofcycles", "nliq"),
}
_WORDS = {word: quantity for quantity, words in WORDS.items() for word in words}
LEAST_KNOWN = 2  # heads that make a line the line of names
_DECIMAL = {mark: re.compile(rf"^[+-]?\d+[{mark}]\d+([eE][+-]?\d+)?$") for mark in ",."}
# 1.234,5 and 1.234: figures in threes, which a number below one has not.
_THOUSANDS = {mark: re.compile(rf"^[+-]?[1-9]\d{{0,2}}([{mark}]\d{{3}})+([{other}]\d+)?$") for mark, other in (",.", ".,")}


@dataclasses.dataclass
class Sheet:
    """Rows of cells, their first the names; ``understood``: pairs (in the sheet, understood as)."""

    rows: list[tuple[int, list[str]]]
    understood: list[tuple[str, str]]


def read_sheet(path: str | os.PathLike, known: frozenset[str]) -> Sheet:
    """A file as a sheet. known : names that are taken as they are.

    Raises ``InputError`` for a file that cannot be read.
    """
    path, understood = pathlib.Path(path), []
    if path.suffix.lower() in (".xlsx", ".xlsm"):
        rows = _workbook(path, understood)
    else:
        rows = _text(path, understood)
    first = _line_of_names(rows, known)
    if first:
        lines = f"lines {rows[0][0]} to {rows[first - 1][0]}" if first > 1 else f"line {rows[0][0]}"
        understood.append((lines, "above the line of names, not read"))
        rows = rows[first:]
    if not rows:
        return Sheet([], understood)
    rows = _second_line_of_units(rows, understood)
    width = max((i + 1 for i, cell in enumerate(rows[0][1]) if cell.strip()), default=0)
    names = [_understood_name(cell, known, understood) for cell in rows[0][1][:width]]
    body = [(number, cells[:width] if _blank(cells[width:]) else cells) for number, cells in rows[1:]]
    return Sheet([(rows[0][0], names), *body], understood)


def _blank(cells: list[str]) -> bool:
    return not any(cell.strip() for cell in cells)


def _text(path: pathlib.Path, understood: list[tuple[str, str]]) -> list[tuple[int, list[str]]]:
    try:
        raw = path.read_bytes()
    except OSError as problem:
        raise InputError(f"{path} cannot be read: {problem.strerror}") from problem
    if raw[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE):  # what Excel calls Unicode text
        text = raw.decode("utf-16", errors="replace")
        understood.append(("letters", "UTF-16"))
    else:
        try:
            text = raw.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = raw.decode("cp1252", errors="replace")
            understood.append(("letters", "Windows-1252, not UTF-8"))
    if "\0" in text:
        raise InputError(f"{path} is no text; save the table as CSV or .xlsx")
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    mark = next((m for m in ("\t", ";") if sum(m in line for _, line in lines) > len(lines) / 2), ",")
    if mark != ",":
        understood.append(({"\t": "tabs", ";": "semicolons"}[mark] + " between cells", "the separator"))
    rows = [(n, cells_of(line, mark)) for n, line in lines]
    rows = _decimal_points(rows, mark, understood)
    return [(n, cells) for n, cells in rows if not _blank(cells)]


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


def _workbook(path: pathlib.Path, understood: list[tuple[str, str]]) -> list[tuple[int, list[str]]]:
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
    sheets, commas = [], set()
    for sheet in book.worksheets:
        rows = [
            (n, [_cell(v, commas) for v in values])
            for n, values in enumerate(sheet.iter_rows(values_only=True), 1)
        ]
        rows = [(n, cells) for n, cells in rows if not _blank(cells) and not cells[0].startswith("#")]
        if rows:
            sheets.append((sheet.title, rows))
    book.close()
    if commas:
        understood.append((f"cells of text as {min(commas)}", "numbers with decimal commas"))
    if len(sheets) > 1:
        others = ", ".join(title for title, _ in sheets[1:])
        understood.append((f"the sheet {sheets[0][0]}", f"the table; not read: {others}"))
    return sheets[0][1] if sheets else []


def _cell(value: object, commas: set[str]) -> str:
    """A cell of a workbook as text; text that is a number with a decimal comma is taken as one, and kept in ``commas``."""
    if isinstance(value, str) and _DECIMAL[","].match(value.strip()):
        commas.add(value.strip())
        return value.strip().replace(",", ".")
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)


def _line_of_names(rows: list[tuple[int, list[str]]], known: frozenset[str]) -> int:
    """Number of the first row in which names are found; 0 where none is."""
    for i, (_, cells) in enumerate(rows[:40]):
        if sum(_name(cell, known)[0] in known for cell in cells if cell.strip()) >= LEAST_KNOWN:
            return i
    return 0


def _second_line_of_units(
    rows: list[tuple[int, list[str]]], understood: list[tuple[str, str]]
) -> list[tuple[int, list[str]]]:
    """A line of units below the names goes into the names."""
    if len(rows) < 2:
        return rows
    units = [cell.strip().strip("[]()").strip() for cell in rows[1][1]]
    if not any(units) or any(u.lower() not in _LOWER_UNITS and u not in NO_UNITS for u in units):
        return rows
    units += [""] * (len(rows[0][1]) - len(units))
    names = [f"{name.strip()} [{unit}]" if unit not in NO_UNITS else name for name, unit in zip(rows[0][1], units)]
    understood.append((f"line {rows[1][0]}", "units of the names above it"))
    return [(rows[0][0], names), *rows[2:]]


def _name(cell: str, known: frozenset[str]) -> tuple[str, str]:
    """(quantity, unit) of a head; the head itself where it is not understood."""
    text, unit = cell.strip(), ""
    found = re.match(r"^(.*?)[\s_,]*[\[\(]\s*([^\[\]\(\)]*?)\s*[\]\)]$", text)
    if found and (found[2].lower() in _LOWER_UNITS or found[2] in NO_UNITS):
        text, unit = found[1].strip(), _unit(found[2])
    else:
        stem, gap, last = re.match(r"^(.*?)([\s_]?)([^\s_]*)$", text).groups()
        if stem and gap and last in UNITS:
            text, unit = stem, last
    if text in known:
        return text, unit
    plain = re.sub(r"[\s_.\-]", "", text).lower()
    return _WORDS.get(plain, {k.lower(): k for k in known if len(k) > 1}.get(text.lower(), text)), unit


def _unit(text: str) -> str:
    """A unit as UNITS has it: MPa is not mPa, other letters may be of either size."""
    return text if text in UNITS else _LOWER_UNITS.get(text.lower(), "")


def _understood_name(cell: str, known: frozenset[str], understood: list[tuple[str, str]]) -> str:
    """A head as ``tables`` reads it: the quantity, and its unit behind it."""
    name, unit = _name(cell, known)
    if name not in known:
        return cell.strip()
    told = {"percent": "percent", "pct": "percent", "pc": "percent", "%": "percent"}.get(unit, unit)
    answer = f"{name}_{told}" if told else name
    if answer != cell.strip() and f"{name}_{unit}" != cell.strip():
        understood.append((cell.strip(), f"{name}" + (f" in {unit}" if unit else ", no unit")))
    return answer
