# SPDX-License-Identifier: MIT
"""Suites that run in one process, as `pytest tests/FOLDER` of CONTRIBUTING.md runs them: each has its own folder."""
import subprocess
import sys

from checking import check, needs_release, root

needs_release("the suites themselves run with every build")
SUITES = ("test_host_gravity.py", "test_host_keys.py")


def test_suites_run_in_one_process():
    done = subprocess.run([sys.executable, "-m", "pytest", "-q", *(root / "tests/host" / name for name in SUITES)],
                          cwd=root, capture_output=True, text=True)
    check("two suites in one process pass", done.returncode == 0, done.stdout)
    check("both ran", done.stdout.splitlines()[-1].endswith(" passed, 0 failed"), done.stdout)
