# SPDX-License-Identifier: MIT
"""Runs the pages of a section of the verification as the check run takes them: short versions, few in slow builds."""
import sys

from checking import add, build, check, light, root, work

verification = root / "verification"
sys.path.insert(0, str(verification))
sys.dont_write_bytecode = True
from tools import readme, runner  # noqa: E402

pages = runner.declared()


def tree():
    """Sizes and times of the files under verification."""
    return {path: (path.stat().st_size, path.stat().st_mtime_ns) for path in verification.rglob("*")
            if path.is_file() and "__pycache__" not in path.parts}


def run_section(*sections):
    """Counts every check of a page; what fails is printed with what was found."""
    before = tree()
    chosen = [name for name, page in pages.items() if name.split("/")[0] in sections and page.quick
              and (page.every_build or not light)]
    for outcome in runner.run_pages(chosen, build, work / "verification", quick=True):
        add(outcome.passed, outcome.failed)
        if outcome.failed:
            runner.report(outcome)
        table = readme.block((verification / outcome.name / "README.md").read_text(encoding="utf-8"), "checks") or ""
        missing = [c.name for c in outcome.checks if f"| {readme.cell(c.name)}" not in table]
        check(f"{outcome.name}: its README has its checks", not missing, f"{missing}: verification/run PAGE --update")
    after = tree()
    check("a run of the pages changes nothing in the source tree", after == before,
          sorted(str(path) for path in before.keys() | after.keys() if before.get(path) != after.get(path)))
