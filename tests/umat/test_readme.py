# SPDX-License-Identifier: MIT
"""The tables of umat/README.md are what the library says of itself. Run with --write to renew them."""
import os
import pathlib
import re
import subprocess
import sys

import pytest

root = pathlib.Path(os.environ.get("MUD_SOURCE_DIR") or pathlib.Path(__file__).parents[2])
build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release")
readme = root / "umat/README.md"
BLOCK = re.compile(r"(<!-- (mud_describe \w+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)
PROMISED = {"mud_describe props", "mud_describe statev"}


def content(block):
    return folded(subprocess.run([build / "drivers/mud_describe", block.split()[1]], check=True, capture_output=True,
                                 text=True).stdout)


def folded(table):
    """The table with one row for the components of a tensor: rows that differ in place and name alone."""
    rows = []
    for line in table.splitlines():
        place, name, rest = re.fullmatch(r"\| ?(.*?) ?\| ?(.*?) ?\|(.*)", line).groups()
        if rows and rows[-1][2] == rest and name.startswith("`"):
            rows[-1] = (rows[-1][0].split(" ")[0] + f" to {place}", rows[-1][1].split(" ")[0] + f" to {name}", rest)
        else:
            rows.append((place, name, rest))
    return "".join(f"| {place} | {name} |{rest}\n" if name.strip("-") else f"|{place}|{name}|{rest}\n"
                   for place, name, rest in rows)


text = readme.read_text(encoding="utf-8")


@pytest.mark.parametrize("what", sorted({what for _, what, _, _ in BLOCK.findall(text)} | PROMISED))
def test_the_table_is_what_the_library_says(what):
    held = [block for _, name, block, _ in BLOCK.findall(text) if name == what]
    assert held == [content(what)], "renew with tests/umat/test_readme.py --write"


if __name__ == "__main__" and "--write" in sys.argv:
    readme.write_text(BLOCK.sub(lambda m: m[1] + content(m[2]) + m[4], text), encoding="utf-8")
