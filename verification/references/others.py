# SPDX-License-Identifier: MIT
"""Writes the table of what other programs made of the cases into README.md, from references.json of each client.

`others.py` prints it, `others.py --update` writes it.
"""
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
PROGRAMS = {"opengeosys": "OpenGeoSys", "kratos": "Kratos"}
PART = re.compile(r"(<!-- others -->\n).*?(<!-- /others -->)", re.DOTALL)


def cell(found):
    """Of the quantities of a case the largest difference over its tolerance, and the same on the finer run."""
    if isinstance(found, str):
        return found
    return "; finer ".join(f"{max(shares):.2g}" for shares in zip(*found.values()))


def kept(name):
    """What the check of a client has left."""
    return json.loads((HERE.parents[1] / "clients" / name / "references.json").read_text(encoding="utf-8"))


def table():
    of = {name: kept(name) for name in PROGRAMS}
    lines = ["| case | " + " | ".join(f"{title} ({of[name]['version'].split('==')[1]})"
                                      for name, title in PROGRAMS.items()) + " |", "|---" * 3 + "|"]
    cases = sorted(path.parent.name for path in HERE.glob("*/case.toml"))
    lines += [f"| {case} | " + " | ".join(cell(of[name]["cases"][case]) for name in PROGRAMS) + " |"
              for case in cases]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["--update"]):
        sys.exit(__doc__)
    page = HERE / "README.md"
    if sys.argv[1:]:
        page.write_text(PART.sub(lambda m: m[1] + table() + m[2], page.read_text(encoding="utf-8")), encoding="utf-8")
    else:
        print(table(), end="")
