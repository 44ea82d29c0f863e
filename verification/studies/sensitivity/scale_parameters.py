# SPDX-License-Identifier: MIT
"""Runs the six drained tests with h_0 or A_0 scaled and writes sensitivity.csv. Nothing is tuned."""
import os
import pathlib
import re
import sys
import tempfile

from tools import tables
from tools.bench import ROOT, Bench, parameters
from tools.results import folder

sys.path.insert(0, str(ROOT / "verification/material/verdugo_ishihara"))
import laboratory  # noqa: E402

P = parameters()
FACTORS = (0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0)


def misfits(bench, parameter, value):
    """{test: (q [%], eps_v [points])} with one parameter of the material changed."""
    changes = ((re.compile(r"(?m)^   file = .*$"), rf"\g<0>\n   {parameter} = {value}\n   rho_e = 0.0"),)
    tests = laboratory.read()
    return {name: laboratory.misfit(bench.driver(f"vi_drained_{name}", changes), tests[name])
            for name in laboratory.TESTS}


def main():
    rows = []
    with tempfile.TemporaryDirectory() as output:
        bench = Bench(pathlib.Path(__file__).parent, os.environ["MUD_BUILD_DIR"], output)
        for parameter in ("h_0", "A_0"):
            for factor in FACTORS:
                value = round(factor * P[parameter], 6)
                found = misfits(bench, parameter, value)
                mean = [sum(f[i] for f in found.values()) / len(found) for i in (0, 1)]
                rows.append([parameter, value, factor, *(f"{found[n][0]:.2f}" for n in laboratory.TESTS),
                             f"{mean[0]:.2f}",
                             *(f"{found[n][1]:.3f}" for n in laboratory.TESTS), f"{mean[1]:.3f}"])
                print(*rows[-1], flush=True)
    header = ["parameter", "value", "factor", *(f"q_{n}_pct" for n in laboratory.TESTS), "q_mean_pct",
              *(f"eps_v_{n}_points" for n in laboratory.TESTS), "eps_v_mean_points"]
    tables.write(folder(__file__) / "sensitivity.csv", header, rows)


if __name__ == "__main__":
    main()
