#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the twelve tests with every variant of the sand and writes results.csv.

    make_results.py [--build build/release] [--only VARIANT ...]

Three minutes of one core. Rows of variants that are not run are those of the committed file.
"""
import argparse
import csv
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.insert(0, str(ROOT / "verification"))
from tools import results, tables  # noqa: E402

MEASURED = HERE / "rong_mccartney_2019_unsaturated_css.csv"
VERTICAL, CYCLES = 50.0, 200
# Three pairs of suction and S_w of the tests, fitted by eq. (24) at constant void ratio.
CURVE = {"P_a": 1.83, "n_x": 1.6, "m_x": 2.0, "S_max": 1.0, "S_min": 0.0}
MEDIUM = 0.806      # Toyoura sand of relative density 45 %
TOLERANCE = 1e-3    # of the stress integration; eps_v after 20 cycles is that of 1e-5 to the third digit
VARIANTS = {   # void ratio, Omega, further keys
    "published": (MEDIUM, 0.0, ""),
    "without bonding": (MEDIUM, 0.0, "bonding = 0"),
    "with hysteresis": (MEDIUM, 2.0, "hysteresis = 1"),
    "with preloading": (MEDIUM, 0.0, "c_chi = 0.26"),
}
COLUMNS = ("variant", "gamma_amplitude_percent", "suction_kPa", "eps_v_1_percent", "eps_v_20_percent", "eps_v_200_percent",
           "S_w_initial", "S_w_end", "void_ratio_end")


def case(variant, amplitude, suction, s_w):
    """The test: consolidated at K0 0.5 of the net stress, then drained simple shear at constant suction."""
    e, omega, more = VARIANTS[variant]
    curve = CURVE | {"P_a": CURVE["P_a"] * e**omega, "Omega": omega}
    keys = "".join(f"   {name} = {value}\n" for name, value in curve.items())
    return (f"&case\n   name = '{variant}'\n/\n&material\n   file = '{ROOT}/drivers/materials/toyoura.nml'\n{keys}   tolerance = {TOLERANCE}\n   {more}\n/\n"
            f"&initial\n   sigma_a = {VERTICAL + s_w * suction}\n   sigma_r = {0.5 * VERTICAL + s_w * suction}\n"
            f"   suction = {suction}\n   void_ratio = {e}\n/\n"
            f"&stage\n   control = 'simple_shear_drained'\n   cycle_by = 'gamma'\n   amplitude = {amplitude}\n"
            f"   cycles = {CYCLES}\n   increment = {amplitude / 40}\n   output_interval = {amplitude}\n/\n")


def run(build, variant, test):
    """A row of the table; the volume shrinks where eps_v > 0."""
    amplitude = test["gamma_amplitude_percent"] / 100
    with tempfile.TemporaryDirectory() as scratch:
        path = pathlib.Path(scratch) / "case.nml"
        path.write_text(case(variant, amplitude, test["suction_kPa"], test["S_w_initial"]), encoding="utf-8")
        out = path.with_suffix(".csv")
        done = subprocess.run([str(pathlib.Path(build) / "drivers/mud_triax"), str(path), "--quiet", "--output", str(out)],
                              capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"{variant}: {done.stderr.strip()}")
        h = tables.columns(out)
    eps = 100 * h["eps_v"]
    at = [round((len(eps) - 1) * n / CYCLES) for n in (1, 20, CYCLES)]
    return (variant, f"{test['gamma_amplitude_percent']:g}", f"{test['suction_kPa']:g}", *(f"{eps[i]:.3f}" for i in at),
            f"{h['s_w'][0]:.4f}", f"{h['s_w'][-1]:.4f}", f"{h['e'][-1]:.4f}")


def tests():
    """The tests as dictionaries of numbers."""
    columns = tables.columns(MEASURED)
    return [dict(zip(columns, values)) for values in zip(*columns.values())]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", default=os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release")
    parser.add_argument("--only", nargs="+", choices=list(VARIANTS), default=list(VARIANTS))
    args = parser.parse_args()
    kept = (tuple(row[name] for name in COLUMNS) for row in tables.rows(HERE / "results.csv"))
    rows = [row for row in kept if row[0] not in args.only]
    rows += [run(args.build, variant, test) for variant in args.only for test in tests()]
    rows.sort(key=lambda row: list(VARIANTS).index(row[0]))
    with open(results.folder(__file__) / "results.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows)


if __name__ == "__main__":
    main()
