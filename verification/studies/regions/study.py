#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the indentation with different outer halves and writes results.csv.

    study.py [--build build/release]
"""
import argparse
import csv
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.insert(0, str(ROOT / "verification"))
from tools import tables  # noqa: E402
from tools.results import folder as made_in  # noqa: E402

GROUPS = ("block_1_1", "block_2_1", "block_3_1", "block_3_2")
# G of 24 MPa, which the sand has at a mean effective stress of 53 kPa, and the sand's curve at its initial void ratio.
ELASTIC = ("&elastic name = 'stiff' young = 6.0e4 poisson = 0.25 /\n"
           "&retention name = 'curve' P_a = 7.8125 omega = 0 n = 2 m = 1 /\n")
SAND, STIFF = "material = 'sand' retention = 'mud'", "material = 'stiff' retention = 'curve'"
CASES = {   # outer half: what stands before the regions, material, drainage
    "sand, coupled": ("", SAND, "coupled"),
    "sand, undrained": ("", SAND, "undrained"),
    "sand, drained": ("", SAND, "drained"),
    "elastic, coupled": (ELASTIC, STIFF, "coupled"),
    "elastic, drained": (ELASTIC, STIFF, "drained"),
}
COLUMNS = ("outer half", "unknowns", "state of the points [MB]", "matrices of the elements [MB]", "factors [MB]",
           "rate evaluations", "seconds", "largest indentation [mm]", "last indentation [mm]", "largest rise of p_w [kPa]")


def scene(case):
    before, keys, drainage = CASES[case]
    flow = " permeability = 'k'" if drainage == "coupled" else ""
    regions = "\n".join(f"&region group = '{group}' {keys} rho_s = 2.7 void_ratio = 0.8 drainage = '{drainage}'{flow} /"
                        for group in GROUPS)
    text = (HERE / "scene.nml").read_text(encoding="utf-8").replace("! OUTER\n", before + regions + "\n")
    return text.replace("'../../../", f"'{ROOT}/")


def run(build, case):
    """A row of the table."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "scene.nml"
        path.write_text(scene(case), encoding="utf-8")
        began = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run([str(pathlib.Path(build) / "host/mud_host"), str(path), "--verbose", "--output", folder],
                              capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"{case}: {done.stderr.strip()}")
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - began
        h = tables.columns(pathlib.Path(folder) / "histories.csv")
    size = re.search(r"^(\d+) unknowns \(.*\); state of the points (\S+) MB, matrices of the elements (\S+) MB, "
                     r"matrix \S+ MB, its factors (\S+) MB", done.stdout, re.M)
    rates = re.search(r"(\d+) rate evaluations", done.stdout)[1]
    impact = h["time"] >= 2.0
    sunk = 1e3*(h["centre.u_z"][impact][0] - h["centre.u_z"][impact])
    rise = (h["rim.p_w"][impact] - h["rim.p_w"][impact][0]).max(), (h["centre.p_w"][impact] - h["centre.p_w"][impact][0]).max()
    return (case, size[1], size[2], size[3], size[4], rates, f"{seconds:.1f}", f"{sunk.max():.5f}", f"{sunk[-1]:.5f}",
            f"{max(rise):.5f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", default=ROOT / "build/release")
    build = parser.parse_args().build
    with open(made_in(__file__) / "results.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for case in CASES:
            writer.writerow(run(build, case))
            print(case, flush=True)


if __name__ == "__main__":
    main()
