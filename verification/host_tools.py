"""Shared by the verification of the host: runs a scene, reads its files, compares, draws."""
import argparse
import atexit
import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

root = pathlib.Path(__file__).resolve().parents[1]
build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release")
host = build / "host/mud_host"


def read(path):
    """Columns of a csv file with a head line, as a dictionary of arrays."""
    with open(path, newline="", encoding="utf-8") as lines:
        rows = list(csv.reader(lines))
    values = np.array([[float(v) for v in row] for row in rows[1:]])
    return dict(zip(rows[0], values.T))


def scratch():
    """A folder that is gone when the script ends."""
    folder = pathlib.Path(tempfile.mkdtemp())
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def run(scene, changes=(), expect=0, more=(), folder=None):
    """Runs a scene with pieces of its text replaced, and more arguments; the folder of its output."""
    scene = pathlib.Path(scene)
    text = scene.read_text(encoding="utf-8")
    for old, new in changes:
        if old not in text:
            raise ValueError(f"{scene.name} has no text {old!r} to replace")
        text = text.replace(old, new)
    folder = folder or scratch()
    # Beside the original, so that relative paths hold.
    copy = scene.with_name(f".{scene.stem}_{folder.name}.nml")
    copy.write_text(text, encoding="utf-8")
    try:
        done = subprocess.run([host, copy, "--output", folder, *more], capture_output=True, text=True,
                              env={**os.environ, "OMP_NUM_THREADS": "1"})
    finally:
        copy.unlink()
    if done.returncode != expect:
        raise RuntimeError(f"{scene.name} ended with {done.returncode}: {done.stderr}")
    (folder / "log.txt").write_text(done.stdout + done.stderr, encoding="utf-8")
    return folder


class Checks:
    """Counts and prints what was compared."""

    def __init__(self, title):
        self.title, self.passed, self.failed = title, 0, 0

    def near(self, what, value, reference, allowed, unit=""):
        """|value - reference| <= allowed, for the largest difference of arrays."""
        error = float(np.max(np.abs(np.asarray(value) - np.asarray(reference))))
        self.small(what, error, allowed, unit)

    def small(self, what, error, allowed, unit=""):
        good = bool(error <= allowed)
        self.passed, self.failed = self.passed + good, self.failed + (not good)
        print(f"{'  ' if good else 'FAILED '}{self.title}: {what}: {error:.3g} (allowed {allowed:.3g}) {unit}")

    def end(self):
        print(f"{self.passed} passed, {self.failed} failed")
        sys.exit(self.failed > 0)


def arguments(description):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--quick", action="store_true", help="the short version that belongs to the check run")
    parser.add_argument("--plot", action="store_true", help="write the picture beside the scene")
    return parser.parse_args()


def figure(columns, height=3.2):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "lines.linewidth": 1.2})
    return plt.subplots(1, columns, figsize=(3.8 * columns, height), layout="constrained")


def number(text, key):
    """A number of the scene's text."""
    return float(re.search(rf"^\s*{key}\s*=\s*([-+.\deE]+)", text, re.MULTILINE)[1])
