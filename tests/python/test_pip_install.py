# SPDX-License-Identifier: MIT
"""`pip install .` into a fresh virtual environment, and the package in use from there; in the release preset.

The libraries are compiled without optimisation here; scripts/before_release makes the wheel as a user gets it.
"""
import re
import subprocess
import sys

import pytest
from checking import check, needs_nightly, root, work


def run(*command):
    done = subprocess.run([str(word) for word in command], cwd=work, capture_output=True, text=True)
    return done.returncode == 0, (done.stdout + done.stderr)[-3000:]


needs_nightly("pip compiles the library once more: ./check --tier nightly, and scripts/before_release as a user does")


def test_there_is_a_fresh_environment():
    version = re.search(r'^version = "(.*)"', (root / "pyproject.toml").read_text(encoding="utf-8"), re.MULTILINE)[1]

    python = work / "venv/bin/python3"
    good, told = run(sys.executable, "-m", "venv", work / "venv")
    check("there is a fresh environment", good, told)
    reached, told = run(python, "-m", "pip", "download", "--no-deps", "--dest", work, "numpy>=1.26")
    check("the version is told", version)
    if not reached:
        pytest.skip(f"no index of Python packages is reached, so nothing is installed: {told.splitlines()[-1:]}")
    good, told = run(python, "-m", "pip", "install", "--disable-pip-version-check", "--find-links", work, root,
                     "--config-settings", f"build-dir={work / 'wheel'}",
                     "--config-settings", "cmake.define.CMAKE_Fortran_FLAGS_RELEASE=-O0")
    check("pip installs the package from the tree", good, told)
    good, told = run(python, root / "tests/python/try_package.py", version)
    check("it says its version, updates without LAPACK, and runs an element test", good, told)
