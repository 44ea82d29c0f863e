# SPDX-License-Identifier: MIT
"""scripts/same_increments.py finds what a change of the library moved."""
import os
import subprocess
import sys

import numpy as np
import pytest

from checking import build, needs_plain_library, root

needs_plain_library()


def run(*words):
    return subprocess.run([sys.executable, root / "scripts/same_increments.py", *words], capture_output=True, text=True,
                          env={**os.environ, "MUD_LIBRARY_DIR": str(build)})


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    file = tmp_path_factory.mktemp("increments") / "answers.npz"
    told = run("record", file, "--paths", "30")
    assert told.returncode == 0, told.stderr
    return file


def test_the_same_library_gives_the_same_bits(recorded):
    told = run("compare", recorded)
    assert told.returncode == 0 and "600 increments, 600 bitwise the same" in told.stdout, told.stdout + told.stderr


@pytest.mark.parametrize("part, column", [("state", 2), ("state", 20), ("tangent", 7), ("code", None)])
def test_what_moved_is_found(recorded, tmp_path, part, column):
    answers = dict(np.load(recorded))
    if part == "tangent":
        answers[part][column] *= 1 + 1e-8
    elif part == "code":
        answers[part][599] = -3
    else:
        answers[part][599, column] += 1e-8 * max(abs(answers[part][599, column]), 1.0)
    np.savez(tmp_path / "moved.npz", **answers)
    told = run("compare", tmp_path / "moved.npz")
    assert told.returncode == 1, told.stdout + told.stderr
