# SPDX-License-Identifier: MIT
"""4,000 scenes of nonsense in blocks of 1000, by the suite that runs 1000 of them in every check. Resumable; a row a
block goes to nonsense.csv.

Usage: nonsense_scenes.py [SCENES] (4000). Five minutes.
"""
import os
import pathlib
import re
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1])]
from tools import results, tables  # noqa: E402

BLOCK = 1000
EVERY = 100   # one scene in so many is run, the others are read and built
RUNNING = 1   # second of the processor for a scene that is run: longer is a run too
KINDS = ("refused", "read", "ran", "ended early", "still running")
NAMES = ("first", "scenes", "failed", *KINDS)
SUITE = HERE.parents[2] / "tests/host/test_host_nonsense.py"


def block(first):
    done = subprocess.run([sys.executable, "-m", "pytest", "-s", SUITE], capture_output=True, text=True,
                          env={**os.environ, "MUD_PRESET": "release", "MUD_NONSENSE": str(BLOCK), "MUD_NONSENSE_FIRST": str(first),
                               "MUD_NONSENSE_SECONDS": str(RUNNING),
                               "MUD_NONSENSE_RUN": str(EVERY), "MUD_NONSENSE_TOGETHER": "1"})
    counts = {kind: int(number) for number, kind in re.findall(r"(\d+) (" + "|".join(KINDS) + ")", done.stdout.split("answers: ")[-1])}
    failed = int(re.search(r"(\d+) failed\s*$", done.stdout)[1])
    if failed:
        print(done.stdout, flush=True)
    return failed, counts


def main(scenes):
    path = results.folder(__file__) / "nonsense.csv"
    comment = ("made by nonsense_scenes.py; scenes of each block by what became of them",)
    rows = [tuple(row.values()) for row in tables.rows(path)] if path.exists() else []
    start, begun = time.monotonic(), len(rows)
    for first in range(BLOCK * begun, scenes, BLOCK):
        failed, counts = block(first)
        rows.append((first, BLOCK, failed, *(counts.get(kind, 0) for kind in KINDS)))
        tables.write(path, NAMES, rows, comment)
        left = (time.monotonic() - start) / (len(rows) - begun) * (scenes / BLOCK - len(rows))
        print(f"{first + BLOCK} of {scenes} scenes, {sum(int(row[2]) for row in rows)} failed; about {left / 60:.0f} min left", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 4000)
