"""The one reader of CSV tables: results of the programs, committed results, data from elsewhere; # begins a comment."""
import csv
import pathlib

import numpy as np


def rows(path, header_in_comment=False):
    """Rows as dictionaries of text. With `header_in_comment` the last comment before the rows names the columns."""
    return list(csv.DictReader(_lines(pathlib.Path(path).read_text(encoding="utf-8"), header_in_comment, path)))


def parsed(text):
    """Rows of a text as dictionaries."""
    return list(csv.DictReader(_lines(text, False, "the text")))


def _lines(text, header_in_comment, path):
    """The head and the rows, without comments."""
    lines = text.splitlines()
    body = [line for line in lines if not line.startswith("#")]
    if header_in_comment:
        first = next((i for i, line in enumerate(lines) if not line.startswith("#")), 0)
        if first == 0:
            raise ValueError(f"{path} has no comment with the names of its columns before the first row")
        body.insert(0, lines[first - 1].lstrip("# "))
    return body


def columns(path, header_in_comment=False):
    """Columns of numbers as a dictionary of arrays."""
    text = pathlib.Path(path).read_text(encoding="utf-8")
    names, *found = csv.reader(_lines(text, header_in_comment, path))
    if not found:
        raise ValueError(f"{path} has no rows")
    return dict(zip(names, np.array(found, float).T))


def comments(path):
    """The comment lines without their mark."""
    return [line.lstrip("# ") for line in pathlib.Path(path).read_text(encoding="utf-8").splitlines()
            if line.startswith("#")]


def write(path, header, lines, comment=()):
    """Writes rows under the names of their columns, after lines of comment."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        file.writelines(f"# {line}\n" for line in comment)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(lines)


def markdown(head, lines):
    """A table of a README."""
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head),
                      *("| " + " | ".join(map(str, line)) + " |" for line in lines)]) + "\n"
