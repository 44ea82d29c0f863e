# SPDX-License-Identifier: MIT
"""Every case with every setting, at the point and in the host. Resumable: what the tables in the output folder hold already is not run again.

Usage: study.py [point|host] [NAME...]: one part, cases or settings by name (all). Progress and time left go to standard output.
"""
import os
import pathlib
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "material"), str(HERE.parents[1]), str(HERE.parents[2] / "common")]
import host_report  # noqa: E402
import host_runs  # noqa: E402
import report  # noqa: E402
import tables  # noqa: E402
from catalogue import SETTINGS, evaluate  # noqa: E402
from point_walk import ROOT, Walker  # noqa: E402
from tools import results  # noqa: E402

# The defaults and the paper's rules first, what takes longest last.
HOST_ORDER = sorted(SETTINGS, key=lambda setting: {"default": 0, "paper's remedy": 1, "scheme 3": 3, "tight": 4}.get(setting.name, 2))


SECONDS = 30   # of the processor, for one path; with the defaults the longest takes about three


def commit():
    return subprocess.run(["git", "describe", "--always", "--dirty"], cwd=HERE, capture_output=True, text=True).stdout.strip() or "unknown"


def work_off(path, comment, names, todo, run):
    """Runs what is not in the table yet; `run(case, setting)` gives a row under `names`."""
    done = {}
    if path.exists():   # begun earlier: the comment tells by which commit
        comment = tables.comments(path)
        done = {(row["case"], row["setting"]): tuple(row.values()) for row in tables.rows(path)}
    todo = [(case, setting) for case, setting in todo if (case.name, setting.name) not in done]
    start = time.monotonic()
    for count, (case, setting) in enumerate(todo, 1):
        outcome = run(case, setting)
        done[case.name, setting.name] = tuple(getattr(outcome, name) for name in names)
        tables.write(path, names, done.values(), comment)
        left = (time.monotonic() - start) / count * (len(todo) - count)
        print(f"{count} of {len(todo)}: {case.name}, {setting.name}: {'passed' if outcome.passed else 'FAILED'}; about {left / 60:.0f} min left", flush=True)


def main(names):
    parts = [name for name in names if name in ("point", "host")] or ["point", "host"]
    names = [name for name in names if name not in ("point", "host")]

    def asked(case, setting):
        return not names or case.name in names or setting.name in names

    folder = results.folder(__file__)
    if "point" in parts:
        # The settings of one rule share the runs with the tight tolerance: a walker runs a path once.
        walker = Walker(os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release", jobs=1, seconds=SECONDS)
        work_off(folder / "results.csv", [f"made by study.py at commit {commit()}; per cent but for rates and cuts"], report.NAMES,
                 [(case, setting) for case in report.CASES for setting in SETTINGS if asked(case, setting)],
                 lambda case, setting: evaluate(walker, case, setting))
    if "host" in parts:
        work_off(folder / "host.csv", [f"made by study.py at commit {commit()}; per cent but for iterations and cuts"], host_runs.NAMES,
                 [(case, setting) for setting in HOST_ORDER for case in host_report.CASES
                  if setting in host_report.settings_of(case) and asked(case, setting)],
                 host_report.outcome)


if __name__ == "__main__":
    main(sys.argv[1:])
