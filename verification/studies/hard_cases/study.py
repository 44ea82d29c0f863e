# SPDX-License-Identifier: MIT
"""Every case with every setting. Resumable: what the table in the output folder holds already is not run again.

Usage: study.py [NAME...]: cases or settings by name (all). Progress and time left go to standard output.
"""
import os
import pathlib
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "material"), str(HERE.parents[1]), str(HERE.parents[2] / "common")]
import report  # noqa: E402
import tables  # noqa: E402
from catalogue import SETTINGS, evaluate  # noqa: E402
from point_walk import ROOT, Walker  # noqa: E402
from tools import results  # noqa: E402


def main(names):
    walker = Walker(os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release")
    path = results.folder(__file__) / "results.csv"
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=HERE, capture_output=True, text=True).stdout.strip() or "unknown"
    comment = [f"made by study.py at commit {commit}; per cent but for rates and cuts"]
    done = {}
    if path.exists() and tables.comments(path) == comment:
        done = {(row["case"], row["setting"]): tuple(row.values()) for row in tables.rows(path)}
    todo = [(case, setting) for case in report.CASES for setting in SETTINGS
            if (case.name, setting.name) not in done and (not names or case.name in names or setting.name in names)]
    start = time.monotonic()
    for count, (case, setting) in enumerate(todo, 1):
        outcome = evaluate(walker, case, setting)
        done[case.name, setting.name] = tuple(getattr(outcome, name) for name in report.NAMES)
        tables.write(path, report.NAMES, done.values(), comment)
        left = (time.monotonic() - start) / count * (len(todo) - count)
        print(f"{count} of {len(todo)}: {case.name}, {setting.name}: {'passed' if outcome.passed else 'FAILED'}; about {left / 60:.0f} min left", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
