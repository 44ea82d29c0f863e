# SPDX-License-Identifier: MIT
"""common/tables.py, the CSV reader of all scripts: what it reads, and what it says of a table that it cannot read."""

from checking import check, work
import tables  # noqa: E402 (checking knows its folder)

path = work / "table.csv"


def told(text, read, **how):
    """What the reader says of a text."""
    path.write_text(text, encoding="utf-8")
    try:
        return f"no complaint: {read(path, **how)}"
    except tables.TableError as problem:
        return str(problem)


def test_what_was_written_is_read_again():
    tables.write(path, ["time", "name", "u"], [[0, "a,b", 1.5], [0.1, "", -2e-3]], comment=["title: a test", "two"])
    check("what was written is read again", tables.rows(path) == [
        {"time": "0", "name": "a,b", "u": "1.5"}, {"time": "0.1", "name": "", "u": "-0.002"}], tables.rows(path))
    check("comments come without their mark", tables.comments(path) == ["title: a test", "two"], tables.comments(path))
    check("names of columns are in their order", tables.header(path) == ["time", "name", "u"], tables.header(path))
    path.write_text("# kPa\n# p, q\n\n1,2\n3,NaN\n", encoding="utf-8")
    found = tables.rows(path, header_in_comment=True)
    check("a comment may name the columns", list(found[0]) == ["p", " q"] and found[0]["p"] == "1", found)
    path.write_text("p,q\n1,2\n\n3,4e1\n", encoding="utf-8")
    check("rows of numbers", tables.numbers(path) == [{"p": 1, "q": 2}, {"p": 3, "q": 40}], tables.numbers(path))
    check("columns of numbers", tables.columns(path)["q"].tolist() == [2, 40], tables.columns(path))
    check("a text is read as a file is", tables.parsed("p,q\n# no\n1,2\n") == [{"p": "1", "q": "2"}])


def test_is_explained():
    for what, text, read, words in (
            ("not a number", "# x\np,q\n1,2\n3,four\n", tables.numbers, ("table.csv", "line 4", "column q", "'four'")),
            ("a missing number", "p,q\n1,\n", tables.columns, ("line 2", "column q", "''")),
            ("a row that is short", "p,q\n1,2\n3\n", tables.rows, ("table.csv", "line 3", "1 cells under 2")),
            ("a row that is long", "p,q\n1,2,3\n", tables.rows, ("line 2", "3 cells under 2")),
            ("an empty file", "# only this\n", tables.rows, ("table.csv", "empty")),
            ("no rows", "p,q\n", tables.columns, ("table.csv", "no rows"))):
        answer = told(text, read)
        check(f"{what} is explained", all(word in answer for word in words), answer)
    answer = told("1,2\n", tables.rows, header_in_comment=True)
    check("columns that no comment names are explained", "no comment with the names" in answer, answer)
    path.write_bytes("p,q\n1,2\n".encode("utf-16"))
    try:
        tables.rows(path)
        answer = ""
    except tables.TableError as problem:
        answer = str(problem)
    check("what is no text is explained", "table.csv is not a text" in answer, answer)
    for encoding in ("utf-8-sig", "latin-1"):
        path.write_bytes("p\n1.5\n# title: Größe\n".encode(encoding))
        check(f"letters in {encoding} are read", tables.numbers(path) == [{"p": 1.5}]
              and tables.comments(path) == ["title: Größe"], tables.comments(path))
