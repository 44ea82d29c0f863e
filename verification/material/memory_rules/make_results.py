# SPDX-License-Identifier: MIT
"""Runs the battery for the rules of the page and writes results.csv.

   make_results.py                          all of it
   make_results.py --rules return_point:0   these rules, and --rows NAME these rows for every rule; the rest is what results.csv holds
"""
import argparse
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parents[1])]
from battery import ALL_MEMORIES, ROWS, parse_rule  # noqa: E402
from point_walk import ROOT, Walker  # noqa: E402
from tools import results, tables  # noqa: E402

HEAVY = ("tolerance_on_random_turns", "turning", "random_walks", "random_increments")   # rows of minutes: for three rules only
HEAVY_RULES = ["classic:2e-5", "return_point:2e-5", ALL_MEMORIES]
RULES = [f"{name}:{radius}" for radius in ("0", "2e-5") for name in ("classic", "threshold", "repositioning", "return_point")] + [ALL_MEMORIES]


def rules_of(row):
    return HEAVY_RULES if row in HEAVY else [*RULES, "classic:1e-3"] if row == "energy" else RULES


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rules", nargs="+", default=[], metavar="RULE:RHO_E")
    parser.add_argument("--rows", nargs="+", default=[], choices=ROWS)
    options = parser.parse_args()
    whole = not (options.rules or options.rows)
    walker = Walker(os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release")
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=HERE, capture_output=True, text=True).stdout.strip() or "unknown"
    path = results.folder(__file__) / "results.csv"
    before, made = {}, [f"made by make_results.py at commit {commit}"]
    if not whole:
        before = {(row["row"], row["quantity"], row["rule"]): row["value"] for row in tables.rows(HERE / "results.csv")}
        made = [*tables.comments(HERE / "results.csv")[:1], f"renewed at commit {commit}: " + ", ".join([*options.rules, *(f"row {name}" for name in options.rows)])]
    lines = []
    for name, row in ROWS.items():
        for rule in rules_of(name):
            if whole or name in options.rows or rule in options.rules:
                lines += [(name, key, rule, f"{value:.6g}") for key, value in row(walker, parse_rule(rule)).items()]
            else:
                lines += [(*key, value) for key, value in before.items() if (key[0], key[2]) == (name, rule)]
        print(name, flush=True)
    tables.write(path, ("row", "quantity", "rule", "value"), lines, [*made, "rule: name and radius rho_e of the elastic domain"])


if __name__ == "__main__":
    main()
