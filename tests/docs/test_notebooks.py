# SPDX-License-Identifier: MIT
"""The notebooks: each page is what its notebook holds, and two of them, executed again, say the same numbers."""
import json
import os
import re
import sys

from checking import build, check, loads_library, root, work

folder = root / "docs/notebooks"
sys.path[:0] = [str(folder), str(root / "python")]
import execute  # noqa: E402

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")


def texts(notebook):
    """What its cells print, the estimates of errors aside, which depend on rounding."""
    found = "".join("".join(output.get("text", [])) for cell in notebook["cells"] for output in cell.get("outputs", []))
    return "\n".join(line for line in found.splitlines() if not line.startswith("accuracy: "))


def test_there_are_three_notebooks():
    names = sorted(path.stem for path in folder.glob("*.ipynb"))
    check("there are three notebooks", names == ["element_test", "own_sand", "umat"], names)
    for name in names:
        held = json.loads((folder / f"{name}.ipynb").read_text(encoding="utf-8"))
        check(f"{name} is a notebook that was executed", held["nbformat"] == 4 and all(
            cell["execution_count"] for cell in held["cells"] if cell["cell_type"] == "code"))
        check(f"the page of {name} is what the notebook holds", execute.same(folder / f"{name}.ipynb"))
        shown = re.findall(r" object at 0x[0-9a-f]+", json.dumps([cell.get("outputs") for cell in held["cells"]]))
        check(f"{name} shows no address, which another run would not repeat", not shown, shown)


def planted(*sources):
    """The outputs of cells that run as a notebook, those of a cell as one text."""
    cells = [{"cell_type": "code", "source": [text]} for text in sources]
    return [json.dumps(cell["outputs"]) for cell in execute.executed({"cells": cells})["cells"]]


def test_a_cell_shows_its_value_and_no_other_notebook():
    check("a value is an output, not so behind a semicolon", [bool(json.loads(text)) for text in planted(
        "7 * 6", "7 * 6;", "7 * 6;  \n")] == [True, False, False])
    look = "import matplotlib\nmatplotlib.rcParams['font.size']"
    first, = planted(look)
    planted("import matplotlib\nmatplotlib.rcParams['font.size'] = 3")
    check("pictures do not take the style of the notebook before", planted(look) == [first], first)


@loads_library
def test_says_the_same_when_it_is_executed():
    os.environ.update(MUD_LIBRARY_DIR=str(build), MUD_TREE=str(root), MPLBACKEND="Agg")
    os.chdir(work)
    for name in ("element_test", "umat"):  # own_sand, half a minute: scripts/before_release
        held = json.loads((folder / f"{name}.ipynb").read_text(encoding="utf-8"))
        before = texts(held)
        after = texts(execute.executed(held))
        told, found = ([float(n) for n in NUMBER.findall(text)] for text in (before, after))
        # Printed with three to five digits: other compilers and presets round the last one differently.
        same = NUMBER.sub("#", before) == NUMBER.sub("#", after) and all(
            abs(a - b) <= 2e-3 * max(abs(a), abs(b), 0.1) for a, b in zip(told, found))
        check(f"{name} says the same when it is executed", same, after)
