# SPDX-License-Identifier: MIT
"""What the scripts share: where sources and build are, a folder that is gone at the end, checks that are counted."""
import atexit
import os
import pathlib
import shutil
import sys
import tempfile

root = pathlib.Path(os.environ.get("MUD_SOURCE_DIR") or pathlib.Path(__file__).parents[2]).resolve()
build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release").resolve()
light = os.environ.get("MUD_PRESET", "release") != "release"   # the checking builds are slow
nightly = os.environ.get("MUD_TIER") == "nightly"              # everything at full length: ./check --tier nightly
brief = light and not nightly                                  # one path through each part of the program
# Scripts read CSV tables by common/tables.py.
sys.path.append(str(root / "common"))
sys.dont_write_bytecode = True
work = pathlib.Path(tempfile.mkdtemp())
atexit.register(shutil.rmtree, work, ignore_errors=True)
counts = {True: 0, False: 0}


def check(name, good, told=""):
    """Counts a check; one that fails is named, with what was found."""
    counts[bool(good)] += 1
    if not good:
        print(f"FAILED {name}: {told}")


def add(passed, failed):
    """Checks that another program counted."""
    counts[True] += passed
    counts[False] += failed


def finish():
    """The closing line that the runner reads, and the exit code."""
    print(f"{counts[True]} passed, {counts[False]} failed")
    sys.exit(counts[False] > 0)
