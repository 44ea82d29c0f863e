#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What 10, 3 and 1 % of error cost, by `mud_study price` scene by scene. Usage: study.py [SCENE ...] [--budget S]"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "common"), str(ROOT / "verification")]
import tables  # noqa: E402
from tools import results  # noqa: E402

HERE, COST = ROOT / "verification/studies/price", ROOT / "verification/studies/cost/scenes"
SCENES = {"strip": HERE, "ring": HERE, "rain_layers": HERE, "mandel": COST, "push": COST, "harmonic": COST}
SHOWN = "rain_layers"     # whose picture is on the page
HEAD = ("scene", "accuracy", "state", "fineness", "step_tolerance", "total", "seconds")


def rows_of(name, build, folder, budget):
    """The table of a scene."""
    folder = pathlib.Path(folder) / name
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "python"), "MUD_LIBRARY_DIR": str(build), "OMP_NUM_THREADS": "1",
                   "MUD_HOST": str(pathlib.Path(build) / "host/mud_host"), "MPLBACKEND": "Agg"}
    done = subprocess.run([sys.executable, "-m", "mud.study", "price", SCENES[name] / f"{name}.nml", "--budget", str(budget),
                           "--output", folder], capture_output=True, text=True, env=environment)
    if done.returncode == 21:
        return [(name, level, "localised", *[""] * 4) for level in ("0.1", "0.03", "0.01")]
    if not (folder / "price.csv").exists():
        raise RuntimeError(f"{name}: exit code {done.returncode}. {done.stderr.strip()}")
    return [(name, *row.values()) for row in tables.rows(folder / "price.csv")]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", default=list(SCENES))
    parser.add_argument("--budget", type=float, default=10.0, help="processor time of a scene [s]")
    args = parser.parse_args()
    made, build, rows = results.folder(__file__), os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release", []
    for i, name in enumerate(args.scenes):
        rows += rows_of(name, build, made, args.budget)
        tables.write(made / "results.csv", HEAD, rows)
        print(f"{name}: {i + 1} of {len(args.scenes)}", flush=True)
        if name == SHOWN:
            shutil.copy(made / name / "price.png", made / "price.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
