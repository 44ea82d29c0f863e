# SPDX-License-Identifier: MIT
"""What the suites of Python share: where sources and build are, a folder that is gone at the end, checks that are
counted one by one. tests/conftest.py makes them tests of pytest."""
import atexit
import os
import pathlib
import shutil
import sys
import tempfile

import pytest

root = pathlib.Path(os.environ.get("MUD_SOURCE_DIR") or pathlib.Path(__file__).parents[2]).resolve()
build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release").resolve()
preset = os.environ.get("MUD_PRESET", "release")
light = preset != "release"                            # the checking builds are slow
nightly = os.environ.get("MUD_TIER") == "nightly"      # everything at full length: ./check --tier nightly
brief = light and not nightly                          # one path through each part of the program
# Scripts read CSV tables by common/tables.py.
sys.path.append(str(root / "common"))
sys.dont_write_bytecode = True
counts = {True: 0, False: 0}
failures = []   # of the test that runs

NO_LIBRARY = "a Python without sanitizers cannot load a library with them; the other builds do"
loads_library = pytest.mark.skipif(preset == "sanitize", reason=NO_LIBRARY)
at_length = pytest.mark.skipif(brief, reason="the checking builds take one path through each part of the program")


def new_folder():
    """An empty folder that is gone at the end."""
    folder = pathlib.Path(tempfile.mkdtemp())
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


work = new_folder()   # tests/conftest.py gives every module its own


def check(name, good, told=""):
    """Counts a check; one that fails is named, with what was found, and fails its test at the end."""
    counts[bool(good)] += 1
    if not good:
        failures.append(f"FAILED {name}: {told}")


def add(passed, failed):
    """Checks that another program counted."""
    counts[True] += passed
    counts[False] += failed
    if failed:
        failures.append(f"FAILED {failed} checks of another program")


def needs_plain_library():
    """Skips a module where this Python cannot load the library."""
    if preset == "sanitize":
        pytest.skip(NO_LIBRARY, allow_module_level=True)


def needs_nightly(reason):
    """Skips a module that ./check --tier nightly runs, in the release."""
    if light or not nightly:
        pytest.skip(reason, allow_module_level=True)


def needs_release(reason):
    """Skips a module whose checks do not depend on how the library is compiled."""
    if light:
        pytest.skip(reason, allow_module_level=True)
