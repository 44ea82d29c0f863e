# SPDX-License-Identifier: MIT
"""Writes the table of the library of materials into calibration/README.md, from the heads of the files and the misfits.

usage: calibration/library.py [--check]     --check: changes nothing, exit code 1 if the table is not up to date
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
BEGIN, END = "<!-- library -->", "<!-- end -->"


def comment(path, word):
    """What a comment of a material file says behind a word; comments may go on in the next line."""
    head = " ".join(line.lstrip("! ") for line in path.read_text(encoding="utf-8").split("&material")[0].splitlines())
    found = re.search(rf"{word} (.*?)(?= (?:Tests|Range of the fitted tests|Misfit): | *$)", head)
    return found[1].rstrip(".") if found else ""


def published():
    """The set that nobody fitted here: its misfit is that of the column beside the fitted one."""
    page = (ROOT / "calibration/toyoura_fitted/README.md").read_text(encoding="utf-8").split("Beside it:")[1]
    lines = [line.split("|") for line in page.splitlines() if line.startswith("| ") and "set" not in line][:2]
    return "; ".join(f"tests of toyoura_fitted, {cells[1].strip()}: {cells[2].strip()}" for cells in lines)


def table():
    rows = [
        "| name | source | date | misfit | range |",
        "|---|---|---|---|---|",
        "| `toyoura` (published) | the paper's Tables 2 and 3; laboratory: Verdugo & Ishihara (1996) | 1996 | "
        f"{published()} | p' 100 to 3000 kPa, e 0.73 to 1.00 |",
    ]
    for name in ("toyoura_fitted", "karlsruhe", "karlsruhe_cyclic", "hostun_hysteresis"):
        path = ROOT / f"drivers/materials/{name}.nml"
        date = re.search(r"on (\d{4}-\d\d-\d\d)", path.read_text(encoding="utf-8"))[1]
        rows.append(
            f"| [`{name}`]({name}/README.md) | {comment(path, 'Tests:')} | {date} | {comment(path, 'Misfit:')} | "
            f"{comment(path, 'Range of the fitted tests:')} |"
        )
    return "\n".join(rows)


def renew(begin, end, table, usage, script):
    """What stands between two marks of the page is written again, or compared with --check."""
    if sys.argv[1:] not in ([], ["--check"]):
        print(usage)
        sys.exit(0 if sys.argv[1:] in (["-h"], ["--help"]) else 2)
    page = ROOT / "calibration/README.md"
    text = page.read_text(encoding="utf-8")
    new = text.split(begin)[0] + begin + "\n" + table() + "\n" + end + text.split(end)[1]
    if "--check" in sys.argv:
        sys.exit(f"calibration/README.md is out of date: run calibration/{script}" if new != text else 0)
    page.write_text(new, encoding="utf-8")


if __name__ == "__main__":
    renew(BEGIN, END, table, __doc__, "library.py")
