# SPDX-License-Identifier: MIT
"""Every test and page that verification/DEFECTS.md names exists, so that a defect cannot lose its guard unseen."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
from checking import check, finish, root  # noqa: E402

HEAD = "| defect | was | is | test or page |"
SUITES = {path.stem: path.read_text(encoding="utf-8") for path in (root / "tests").rglob("test_*.pf")}
SCRIPTS = {path.name: path.read_text(encoding="utf-8") for path in (root / "tests").rglob("test_*.py")}


def exists(name, words):
    """A test of a suite, the words of a check in a script, or a page."""
    if name.endswith(".py"):
        return words and words in SCRIPTS.get(name, "")
    if "/" in name:
        return (root / "verification" / name / "page.py").exists()
    suite, _, test = name.partition(".")
    return bool(re.search(rf"^ *@test\n(?: *@.*\n)* *subroutine {test}\(", SUITES.get(suite, ""), re.MULTILINE))


page = (root / "verification/DEFECTS.md").read_text(encoding="utf-8")
rows = [line.strip("| ").split(" | ") for line in page.splitlines() if line.startswith("| ") and line != HEAD]
check("the page has its tables", len(rows) > 20, len(rows))
for row in rows:
    check(f"{row[0]}: four cells", len(row) == 4, row)
    # A script's name is followed by the words of its check, up to the next name.
    guards = re.findall(r"`([^`]+)`(?:: ([^`]*?))?(?=, `|$)", row[-1])
    check(f"{row[0]}: is held by something", guards, row[-1])
    for name, words in guards:
        check(f"{row[0]}: {name} {words}", exists(name, words.strip()), "does not exist")
check("a test that is gone is missed", not exists("test_rules.every_turn", "")
      and not exists("test_refusals.py", "a check of nobody") and not exists("material/nothing", ""))
index = (root / "verification/README.md").read_text(encoding="utf-8")
check("the index leads there", "(DEFECTS.md)" in index)
finish()
