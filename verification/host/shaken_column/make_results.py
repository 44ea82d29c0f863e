# SPDX-License-Identifier: MIT
"""Measures what the page states and writes results.csv."""
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]
import page  # noqa: E402
from tools import results, tables  # noqa: E402
from tools.bench import ROOT, Bench  # noqa: E402

if __name__ == "__main__":
    made = results.folder(__file__)
    bench = Bench(HERE, os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release", made / "scratch")
    told, lines = [], []
    for motion, sand in page.RUNS:
        h = page.run(bench, sand, motion)[0]
        told += [(motion, sand, quantity, f"{value:.5g}") for quantity, value in page.values(h).items()]
        series = page.series(h)
        lines += [(motion, sand, *(f"{value:.4g}" for value in row)) for row in zip(*series.values())]
    tables.write(made / "results.csv", ("motion", "sand", "quantity", "value"), told, ["made by make_results.py"])
    tables.write(made / "series.csv", ("motion", "sand", *series), lines, ["made by make_results.py; s, kPa, cm, m/s2; r_u and stresses at 5 m"])
