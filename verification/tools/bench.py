# SPDX-License-Identifier: MIT
"""What `check(bench)` of a page works with: runs cases and scenes of the built programs and records what was compared.

All results go outside the source tree; cases and scenes are copied there with their relative paths made absolute.
"""
import os
import pathlib
import re
import subprocess
import tempfile
from dataclasses import dataclass

import numpy as np

from . import tables

ROOT = pathlib.Path(__file__).resolve().parents[2]
CASES = ROOT / "drivers" / "cases"
MATERIAL = ROOT / "drivers" / "materials" / "toyoura.nml"
# The model as it was published, without any guard of this library (docs/theory/material.md section 5).
GUARDS = ("x_0", "x_rev", "cap_d", "cap_h", "cutoff")
AS_PUBLISHED = dict(memory_rule=0, rho_e=0.0, isotropic=1, scheme=1, **dict.fromkeys(GUARDS, 0))


@dataclass(frozen=True)
class Check:
    """One comparison: the value that is worst off, its reference, by how much it is off, what is allowed, and why."""
    name: str
    value: float
    reference: float
    off: float
    allowed: float
    unit: str
    because: str
    count: int
    passed: bool
    bound: bool = False   # the value itself has a bound, and there is no reference

    @property
    def single(self):
        """Whether value and reference tell more than by how much they differ."""
        return self.count == 1 and not self.bound and self.reference != 0

    def line(self):
        text = f"{'ok    ' if self.passed else 'FAILED'} {self.name}: "
        unit = f" {self.unit}" if self.unit else ""
        if self.bound:
            return f"{text}{self.value:.3g}, at most {self.allowed:.3g}{unit}"
        shown = f" (worst of {self.count})" if self.count > 1 else ""
        if self.single:
            shown = f" (value {self.value:.8g}, reference {self.reference:.8g})"
        return f"{text}off by {self.off:.3g}, allowed {self.allowed:.3g}{unit}{shown}"


class Bench:
    def __init__(self, folder, build, scratch, quick=False):
        self.here = pathlib.Path(folder)    # of the page, in the source tree: to read from
        self.build = pathlib.Path(build)
        self.output = pathlib.Path(scratch)   # of the page, for pictures and what else is to stay
        self.output.mkdir(parents=True, exist_ok=True)
        self.quick = quick
        self.checks, self.notes, self.pictures = [], [], []
        self._temporary = tempfile.TemporaryDirectory(prefix="mud-page-")
        self._runs = {}

    # ---- comparisons

    def near(self, name, value, reference, tolerance, unit=""):
        """|value - reference| <= tolerance, of numbers or of arrays, of which the worst counts."""
        value, reference = np.broadcast_arrays(np.asarray(value, float), np.asarray(reference, float))
        if value.size == 0:
            raise ValueError(f"{name}: there is nothing to compare")
        off = np.abs(value - reference).ravel()
        allowed = tolerance.absolute + tolerance.relative * np.abs(reference).ravel()
        worst = int(np.argmax(off - allowed))   # a NaN comes first
        self._record(name, value.ravel()[worst], reference.ravel()[worst], off[worst], allowed[worst], unit, tolerance,
                     value.size, False)

    def below(self, name, value, tolerance, unit=""):
        """value <= the absolute tolerance; a value may be negative."""
        self._record(name, float(value), 0.0, float(value), tolerance.absolute, unit, tolerance, 1, True)

    def _record(self, name, value, reference, off, allowed, unit, tolerance, count, bound):
        good = bool(off <= allowed)   # false for NaN
        self.checks.append(Check(name, float(value), float(reference), float(off), float(allowed), unit,
                                 tolerance.because, count, good,
                                 bound))
        self.note(self.checks[-1].line())

    def note(self, *words):
        """A line of the report that is no check."""
        self.notes.append(" ".join(map(str, words)))

    # ---- programs

    def folder(self):
        """A new folder that is gone when the page has been run."""
        return pathlib.Path(tempfile.mkdtemp(dir=self._temporary.name))

    def program(self, name):
        path = self.build / name
        if not path.exists():
            raise RuntimeError(f"{path} is not built")
        return path

    def driver(self, case, changes=()):
        """Columns of a run of mud_triax: a name of drivers/cases or a path. A case that ran before is not run again."""
        path = case if isinstance(case, pathlib.Path) else CASES / f"{case}.nml"
        key = (path, tuple(changes))
        if key not in self._runs:
            text = absolute(changed(path.read_text(encoding="utf-8"), changes, path.name), path.parent)
            self._runs[key] = self.driver_text(text, path.stem)
        return self._runs[key]

    def driver_text(self, text, name="case"):
        """Columns of a run of mud_triax with this text, whose paths are absolute."""
        folder = self.folder()
        case, out = folder / f"{name}.nml", folder / f"{name}.csv"
        case.write_text(text, encoding="utf-8")
        done = subprocess.run([self.program("drivers/mud_triax"), case, "--quiet", "--output", out],
                              capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"{name}: exit code {done.returncode}. {done.stderr.strip()}")
        return tables.columns(out)

    def host(self, scene, changes=(), expect=0, more=(), folder=None):
        """The folder with the output of mud_host: a scene of the page with pieces of its text replaced."""
        scene = self.here / scene
        text = absolute(changed(scene.read_text(encoding="utf-8"), changes, scene.name), scene.parent)
        folder = folder or self.folder()
        copy = self.folder() / scene.name
        copy.write_text(text, encoding="utf-8")
        done = subprocess.run([self.program("host/mud_host"), copy, "--output", folder, *more], capture_output=True,
                              text=True,
                              env={**os.environ, "OMP_NUM_THREADS": "1"})
        if done.returncode != expect:
            raise RuntimeError(f"{scene.name}: exit code {done.returncode}. {done.stderr.strip()}")
        (folder / "log.txt").write_text(done.stdout + done.stderr, encoding="utf-8")
        return folder

    def suite(self, name, tolerance):
        """Runs a suite of tests that judges the page."""
        done = subprocess.run([self.program(f"tests/{name}")], capture_output=True, text=True, errors="replace",
                              env={**os.environ, "MUD_SOURCE_DIR": str(ROOT), "MUD_BUILD_DIR": str(self.build)})
        found = (re.search(r"(\d+) passed, (\d+) failed\s*$", done.stdout)
                 or re.search(r"OK\s*\((\d+) tests?()", done.stdout))   # our own runner, pFUnit
        if not found:
            raise RuntimeError(f"{name} ended with exit code {done.returncode} without its closing line")
        self.near(f"tests of {name} that fail, of {int(found[1]) + int(found[2] or 0)}", int(found[2] or 0), 0,
                  tolerance)

    # ---- pictures

    def picture(self, name):
        """Where a picture of the page is to be written."""
        self.pictures.append(name)
        return self.output / name

    def save(self, figure, name, dpi=110):
        figure.savefig(self.picture(name), dpi=dpi)


def changed(text, changes, name="text"):
    """Pairs (old, new): old is text or a compiled pattern; every occurrence is replaced, and there must be one."""
    for old, new in changes:
        if isinstance(old, re.Pattern):
            text, count = old.subn(new, text)
        else:
            count, text = text.count(old), text.replace(old, new)
        if not count:
            raise ValueError(f"{name} has no text {getattr(old, 'pattern', old)!r} to replace")
    return text


def absolute(text, folder):
    """The text of a case or scene with relative names of files made absolute, so that a copy of it can lie anywhere."""
    return re.sub(r"(\b(?:file|library)\s*=\s*')([^'/][^']*)'", lambda m: f"{m[1]}{(folder / m[2]).resolve()}'", text)


def number(text, key):
    """A number of a case or scene."""
    return float(re.search(rf"^\s*{key}\s*=\s*([-+.\deE]+)", text, re.MULTILINE)[1])


def parameters(path=MATERIAL):
    """Numbers of a file of parameters by their names, without the range of the tests behind them."""
    text = re.sub(r"!.*", "", path.read_text(encoding="utf-8"))
    return {key: float(value) for key, value in re.findall(r"(\w+)\s*=\s*([-+.\deE]+)", text)
            if not key.startswith("tested_")}
