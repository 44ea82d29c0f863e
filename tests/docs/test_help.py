# SPDX-License-Identifier: MIT
"""Every program and every script that a person starts says how it is called: --help prints a usage, ends with exit
code 0, runs nothing and leaves no file behind."""
import os
import subprocess
import sys

from checking import build, check, light, root, work

SECONDS = 60   # a help text takes less than one; more only on a machine that is very busy
PROGRAMS = [build / name for name in ("drivers/mud_triax", "drivers/mud_describe",
                                      "host/mud_host")]
# Started by these words; what the build or a test alone starts is not here.
PYTHON = ["drivers/plot_case.py", "host/plot_run.py", "calibration/library.py", "scripts/single_source.py",
          "scripts/same_answers.py", "scripts/same_increments.py", "scripts/run_suites.py", "scripts/module_map.py",
          "benchmarks/host_benchmark.py", "benchmarks/host_lanes.py", "tests/mutations/run_mutations.py"]
SHELL = ["demo", "check", "scripts/site", "scripts/benchmark", "scripts/random_increments", "scripts/try_packages.sh",
         "scripts/before_release", "scripts/try_fpm", "scripts/try_recipes", "scripts/wheel",
         "clients/check", "verification/run", "tests/fuzz/run"]


def executables():
    """Scripts of the tree that have the right to be executed, those of machines (.ci) aside."""
    told = subprocess.run(["git", "ls-files", "--stage"], cwd=root, capture_output=True, text=True)
    return {line.split("\t")[1] for line in told.stdout.splitlines() if line.startswith("100755")
            and not line.split("\t")[1].startswith(".ci/")}


def helps(name, *command):
    folder = work / name.replace("/", "_")
    folder.mkdir()
    environment = dict(os.environ, MUD_PYTHON=sys.executable, PYTHONPATH=str(root / "python"))
    try:
        done = subprocess.run([*command, "--help"], cwd=folder, env=environment, capture_output=True, text=True,
                              timeout=SECONDS)
    except subprocess.TimeoutExpired:
        check(f"{name} --help ends", False, f"still running after {SECONDS} s")
        return
    said = done.stdout.lower()
    check(f"{name} --help prints a usage", done.returncode == 0 and "usage" in said and not done.stderr.strip(),
          f"exit code {done.returncode}: {done.stdout[:200]} {done.stderr[-300:]}")
    check(f"{name} --help leaves no file behind", not list(folder.iterdir()), [one.name for one in folder.iterdir()])


def test_every_executable_script_of_the_tree_is_tried_here():
    for program in PROGRAMS:
        helps(program.name, program)
    if not light:   # scripts are the same in every build
        for name in PYTHON:
            helps(name, sys.executable, root / name)
        helps("mud_study", sys.executable, "-m", "mud.study")
        helps("mud_lwd", sys.executable, "-m", "mud.lwd")
        helps("mud_calibrate", sys.executable, "-m", "mud.calibration.command")
        for name in SHELL:
            helps(name, root / name)
    missing = executables() - set(SHELL) - set(PYTHON)
    check("every executable script of the tree is tried here", not missing, sorted(missing))
