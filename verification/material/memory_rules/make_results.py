# SPDX-License-Identifier: MIT
"""Runs the whole battery for the rules of the page and writes results.csv."""
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parents[1])]
from battery import ROWS, parse_rule  # noqa: E402
from point_walk import ROOT, Walker  # noqa: E402
from tools import results, tables  # noqa: E402

HEAVY = ("turning", "random_walks", "random_increments")   # rows of minutes: for two rules only
HEAVY_RULES = ["classic:2e-5", "return_point:2e-5"]
RULES = [f"{name}:{radius}" for radius in ("0", "2e-5") for name in ("classic", "threshold", "repositioning", "return_point")]


def main():
    walker = Walker(os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release")
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=HERE, capture_output=True, text=True).stdout.strip()
    lines = []
    for name, row in ROWS.items():
        for rule in HEAVY_RULES if name in HEAVY else [*RULES, "classic:1e-3"] if name == "energy" else RULES:
            lines += [(name, key, rule, f"{value:.6g}") for key, value in row(walker, parse_rule(rule)).items()]
        print(name, flush=True)
    tables.write(results.folder(__file__) / "results.csv", ("row", "quantity", "rule", "value"), lines,
                 [f"made by make_results.py at commit {commit or 'unknown'}", "rule: name and radius rho_e of the elastic domain"])


if __name__ == "__main__":
    main()
