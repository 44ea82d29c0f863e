#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What each effect changes in the scenes of scenes.py, by `mud_study effects --share inf`. Usage: study.py [NAME ...]"""
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "common"), str(ROOT / "verification")]
import scenes  # noqa: E402
import tables  # noqa: E402
from tools import results  # noqa: E402

ALL = scenes.TRAPS + scenes.EASY
NAMES = ("scene", "effect", "on", "by", "influence", "answer", "remark", "wanted")


def rows_of(scene, build, folder):
    """The table of a scene, with what is wanted of each effect."""
    path = pathlib.Path(folder) / "scene.nml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(scene.text.replace("{materials}", str(ROOT / "drivers/materials")), encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "python"), "MUD_LIBRARY_DIR": str(build),
                   "MUD_HOST": str(pathlib.Path(build) / "host/mud_host"), "OMP_NUM_THREADS": "1", "MPLBACKEND": "Agg"}
    done = subprocess.run([sys.executable, "-m", "mud.study", "effects", path, "--share", "inf", "--output", folder],
                          capture_output=True, text=True, env=environment)
    if done.returncode:
        raise RuntimeError(f"{scene.name}: exit code {done.returncode}. {done.stderr.strip()}")
    wanted = {**dict.fromkeys(scene.keeps, "on"), **dict.fromkeys(scene.drops, "off")}
    # Remarks quote sentences of runs; where they were run is no result.
    rows = [(scene.name, *(r[n].replace(f"{folder}/", "") for n in NAMES[1:-1]), wanted.pop(r["effect"], ""))
            for r in tables.rows(pathlib.Path(folder) / "effects.csv")]
    # What is not even in the table is decided wrongly.
    return rows + [(scene.name, effect, *[""] * (len(NAMES) - 3), on) for effect, on in wanted.items()]


def main(words):
    made = results.folder(__file__)
    build = os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release"
    rows = []
    for i, scene in enumerate(ALL):
        if words and scene.name not in words:
            continue
        rows += rows_of(scene, build, made / scene.name.replace(" ", "_").replace(",", ""))
        tables.write(made / "results.csv", NAMES, rows)
        print(f"{scene.name}: {i + 1} of {len(ALL)}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
