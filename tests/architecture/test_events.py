# SPDX-License-Identifier: MIT
"""An event inside a substep is one file, umat/core/integration/mud_event_NAME.f90, with its row; the table is a list of
the rows, and theory and code have the same events."""
import re

from checking import check, root

FOLDER = root / "umat/core/integration"


def rows(text):
    """Names of the rows that a file defines."""
    return re.findall(r"type\(event_t\), parameter :: (\w+) =", text)


def listed(text):
    """Names in the list of the table, without the first, which is no event."""
    return re.findall(r"\w+", re.search(r"EVENTS\(EVENT_NONE:EVENT_TURN\) = \[[&\s]*NO_EVENT, ([^\]]*)\]", text)[1])


def test_every_event_is_a_file_with_a_row_in_the_table():
    found = {file.stem: rows(file.read_text(encoding="utf-8")) for file in FOLDER.glob("mud_event_*.f90")
             if file.stem != "mud_event_table"}
    table = listed((FOLDER / "mud_event_table.f90").read_text(encoding="utf-8"))
    check("a file has one row", all(len(names) == 1 for names in found.values()), found)
    check("the table is the list of the rows", sorted(table) == sorted(sum(found.values(), [])), (table, found))
    numbers = re.findall(r"EVENT_(\w+) = (\d+)", (FOLDER / "mud_event.f90").read_text(encoding="utf-8"))
    order = [name for name, number in sorted(numbers, key=lambda pair: int(pair[1])) if number != "0"]
    check("in the order of their numbers", [name.removesuffix("S").removesuffix("S_AT") for name in table]
          == [name.removesuffix("S") for name in order], (table, order))
    text = (root / "docs/theory/integration.md").read_text(encoding="utf-8")
    theory = re.findall(r"^\| ([\w ]+) \|", text.partition("### 4.2")[2].partition("### 4.3")[0], re.MULTILINE)
    check("the theory has them, but the turn, which ends no substep", len(theory) - 1 == len(order) - 1, theory)
