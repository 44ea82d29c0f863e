# SPDX-License-Identifier: MIT
"""Bearing curves of the footing to 10 cm for every soil, with and without surcharge, rough and under a smooth plate.

verification/run host/footing --make [-- NAMES]: NAMES are parts of the names of the cases to run; the others stay.
"""
import argparse
import csv
import os
import pathlib
import re
import subprocess
import tempfile

import numpy as np

from tools import tables
from tools.bench import changed
from tools.results import folder

HERE = pathlib.Path(__file__).resolve().parent
AREA = 3.141592653589793 * 0.5**2
SETTLEMENTS = (0.5, 1, 2, 3, 5, 7.5, 10)   # [cm]
COLUMNS = ("case", *(f"q_{s:g}cm" for s in SETTLEMENTS), "reached_cm", "iterations", "cuts", "end")
NO_SURCHARGE = [("surcharge=2 ", "surcharge=0 "), ("&load group='top_2' kind='pressure' value=2.0 /\n", "")]
DENSE = [("e_0=0.907", "e_0=0.75")]
POROUS = ("&region material='sand' /",
          "&permeability name='k' intrinsic=1e-12 /\n&region material='sand' permeability='k' {} /")
WATER = [("fields='u'", "fields='u-p_w' pressures='linear'"), (POROUS[0], POROUS[1].format("")),
         ("&initial ", "&initial p_w_slope=-9.81 ")]
UNDRAINED = [("analysis='static' duration=1.0 dt=0.025", "analysis='quasi_static' duration=0.01 dt=2.5e-4 rho_inf=0"),
             ("times=0,1.0", "times=0,0.01")]
PLATE = [("&fix group='top_1' field='u_r' /\n", ""),
         ("&fix group='top_1' field='u_z'",
          "&plate name='p' r=0,0.5 mass=1 /\n&contact name='c' slave='top' master='p' /\n&fix group='p' field='u_z'")]
# A plate with a face of its own holds nothing before it touches: there the surcharge is to be below it as well.
BELOW_TOO = [("group='top_2'", "group='top'")]


def suction(kpa):
    return [("fields='u'", "fields='u-p_w-p_c' pressures='linear'"),
            (POROUS[0], POROUS[1].format("retention='material'")), ("&initial ", f"&initial p_w={-kpa} p_c={kpa} ")]


SOILS = {"dry": [], "drained": WATER, "undrained": WATER + UNDRAINED, "suction 30": suction(30),
         "suction 100": suction(100)}
CASES = {f"{density}, {soil}, surcharge {load}, {face}": shape + dense + changes + above
         for face, shape in (("rough", []), ("plate", PLATE))
         for density, dense in (("loose", []), ("dense", DENSE))
         for soil, changes in SOILS.items()
         for load, above in ((2, BELOW_TOO if face == "plate" else []), (0, NO_SURCHARGE))}


def curve(out):
    """Settlement [cm] and pressure [kPa] of the rows of a run: the force holds at `time_of_forces`."""
    rows = tables.columns(out / "reactions_push.csv")
    end = 0.01 if rows["time"][-1] <= 0.0101 else 1.0
    force = next(rows[name] for name in ("p.force_z", "top_1.force_z") if name in rows)
    return 10 * rows["time_of_forces"] / end, -force / AREA


def run(program, name):
    """A row of the table, also where the run ends early."""
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        text = changed((HERE / "scene.nml").read_text(encoding="utf-8"), CASES[name])
        (scratch / "scene.nml").write_text(text, encoding="utf-8")
        done = subprocess.run([program, scratch / "scene.nml", "--verbose", "--output", scratch / "out"],
                              capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
        settlement, pressure = curve(scratch / "out")
        if "surcharge 2, plate" in name:
            pressure = pressure + 2
        ledger = tables.columns(scratch / "out/ledger.csv")
    cuts = re.findall(r"(\d+) cuts", done.stdout)
    # Steps that were cut do not end at the settlements of the table.
    values = [f"{np.interp(s, settlement, pressure):.1f}" if s <= settlement[-1] + 1e-9 else "" for s in SETTLEMENTS]
    said = "done" if done.returncode == 0 else f"exit {done.returncode}: {done.stderr.strip().splitlines()[-1]}"
    return dict(zip(COLUMNS, (name, *values, f"{settlement[-1]:.2f}", int(ledger["iterations"].sum()),
                              cuts[-1] if cuts else "", said)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", help="parts of the names of the cases to run; the others stay")
    chosen = parser.parse_args().parts
    program = pathlib.Path(os.environ["MUD_BUILD_DIR"]) / "host/mud_host"
    path = folder(__file__) / "matrix.csv"
    rows = {row["case"]: row for kept in (HERE / "matrix.csv", path) if kept.exists() for row in tables.rows(kept)}
    for name in CASES:
        if chosen and not any(part in name for part in chosen):
            continue
        rows[name] = run(program, name)
        print(*rows[name].values(), sep="; ", flush=True)
        with path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows[n] for n in CASES if n in rows)


if __name__ == "__main__":
    main()
