# SPDX-License-Identifier: MIT
"""The one reader and writer of CSV tables for scripts: results of the programs, committed results, data from elsewhere.

# begins a comment line. What cannot be read is a TableError that names the file, the line and the column.
"""
import codecs
import csv
import pathlib
import re
import textwrap


class TableError(ValueError):
    """A table that cannot be read: which file, where in it, what was found and what belongs there."""


def decoded(raw):
    """Bytes as text, without a byte-order mark. A title in Latin-1 goes into the results as the case has it."""
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def rows(path, header_in_comment=False):
    """Rows as dictionaries of text. With `header_in_comment` the last comment before the rows names the columns."""
    return _rows(_text(path), header_in_comment, path)[1]


def parsed(text):
    """Rows of a text as dictionaries of text."""
    return _rows(text, False, "the text")[1]


def numbers(path, header_in_comment=False):
    """Rows as dictionaries of numbers."""
    names, found, at = _rows(_text(path), header_in_comment, path)
    return [{name: _number(row[name], path, line, name) for name in names} for row, line in zip(found, at)]


def columns(path, header_in_comment=False):
    """Columns of numbers as a dictionary of arrays; a table without rows is an error."""
    import numpy as np   # not at the top: rows do without it
    found = numbers(path, header_in_comment)
    if not found:
        raise TableError(f"{path} has no rows below the names of its columns")
    return {name: np.array([row[name] for row in found]) for name in found[0]}


def header(path):
    """Names of the columns."""
    return _rows(_text(path), False, path)[0]


def comments(path):
    """The comment lines without their mark."""
    return [line.lstrip("# ") for line in _text(path).splitlines() if line.startswith("#")]


def write(path, names, lines, comment=()):
    """Writes rows under the names of their columns, after lines of comment."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        file.writelines(f"# {line}\n" for line in comment)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        writer.writerows(lines)


def markdown(head, lines):
    """A table of a README."""
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head),
                      *("| " + " | ".join(map(str, line)) + " |" for line in lines)]) + "\n"


def wrapped(text, width=120):
    """Markdown with its sentences and lists in lines of a width; tables, headings, code and formulae stay as they are."""
    lines, code = [], False
    for line in text.splitlines():
        code = code != line.lstrip().startswith(("```", "~~~"))
        if code or len(line) <= width or line.lstrip().startswith(("|", "#", "<", "![")):
            lines.append(line)
        else:
            indent = " " * len(re.match(r"\s*([-*] |\d+\. )?", line)[0])
            lines += textwrap.wrap(line, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
    return "\n".join(lines) + "\n"


def _text(path):
    raw = pathlib.Path(path).read_bytes()
    if b"\0" in raw or raw[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE):
        raise TableError(f"{path} is not a text in UTF-8 or Latin-1")
    return decoded(raw)


def _rows(text, header_in_comment, path):
    """Names of the columns, rows as dictionaries of text, and the line of the file that each row stands in."""
    lines = list(enumerate(text.splitlines(), 1))
    body = [(number, line) for number, line in lines if line.strip() and not line.startswith("#")]
    if header_in_comment:
        above = [(number, line) for number, line in lines
                 if line.startswith("#") and (not body or number < body[0][0])]
        if not above:
            raise TableError(f"{path} has no comment with the names of its columns before the first row")
        body.insert(0, (above[-1][0], above[-1][1].lstrip("# ")))
    if not body:
        raise TableError(f"{path} is empty: the names of its columns are missing")
    at = [number for number, _ in body]
    names, *found = csv.reader(line for _, line in body)
    for number, row in zip(at[1:], found):
        if len(row) != len(names):
            raise TableError(f"{path}, line {number}: {len(row)} cells under {len(names)} names of columns")
    return names, [dict(zip(names, row)) for row in found], at[1:]


def _number(cell, path, line, name):
    try:
        return float(cell)
    except ValueError:
        raise TableError(f"{path}, line {line}, column {name}: '{cell}' is not a number") from None
