# SPDX-License-Identifier: MIT
"""mud_host as the suites of Python run it: a text as a scene, its results in a folder of the same name, one thread."""
import os
import subprocess

import checking
from checking import build, check

HOST = build / "host/mud_host"
ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1"}


def start(name, text, *more):
    """The process at its end: exit code and what it said."""
    scene = checking.work / f"{name}.nml"
    scene.write_text(text)
    return subprocess.run([HOST, scene, "--output", checking.work / name, "--quiet", *more], capture_output=True,
                          text=True, env=ENVIRONMENT)


def ran(name, text, *more):
    """Whether it ran to its end, which is a check."""
    done = start(name, text, *more)
    check(f"{name} runs", done.returncode == 0, done.stderr)
    return done.returncode == 0
