# SPDX-License-Identifier: MIT
"""Paths of one point for mud_walk, and the program itself. Compression positive, engineering shear, kPa."""
import concurrent.futures
import dataclasses
import pathlib
import resource
import signal
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "common"))
import tables  # noqa: E402 (its folder is known only now)

RULES = {"classic": 0, "threshold": 1, "repositioning": 2, "return_point": 3}


@dataclasses.dataclass(frozen=True)
class Soil:
    """The default material with a memory rule (its number) and an elastic domain of radius rho_e; None: the library's default."""
    rule: int = None
    rho_e: float = None
    properties: tuple = ()   # further (name, value)

    def having(self, **properties):
        return dataclasses.replace(self, properties=self.properties + tuple(properties.items()))


class Path:
    """A path, written down step by step."""

    def __init__(self, soil, e, p=100.0, stress=None, suction=0.0):
        """Starts from an isotropic effective stress p, or from six components."""
        stress = stress or (p, p, p, 0.0, 0.0, 0.0)
        self.lines = [f"set {name} {value!r}" for name, value in (("memory_rule", soil.rule), ("rho_e", soil.rho_e)) if value is not None]
        self.lines += [f"set {name} {value!r}" for name, value in soil.properties]
        self.lines.append("start " + " ".join(map(repr, (*stress, suction, e))))

    def lead(self, letters):
        """'s' or 'e' for each component: led by its stress or by its strain."""
        self.lines.append("lead " + " ".join("T" if letter == "s" else "F" for letter in letters))
        return self

    def go(self, n, change, suction=0.0):
        """n equal increments of the led quantities, `change` in all."""
        self.lines.append(f"go {n} " + " ".join(repr(float(x)) for x in (*change, suction)))
        return self

    def turn(self, rotation):
        """A rigid rotation by a matrix (rows)."""
        self.lines.append("turn " + " ".join(repr(float(rotation[i][j])) for j in range(3) for i in range(3)))
        return self

    def row(self, label="end"):
        self.lines.append(f"row {label}")
        return self


COLUMNS = ("label", "s11", "s22", "s33", "s12", "s13", "s23", "e11", "e22", "e33", "g12", "g13", "g23", "e", "suction", "rates", "substeps", "resets", "cuts",
           "iterations")


class Row(dict):
    """A state: stress, strain (lists), e, suction, counters, label, failed."""

    def __init__(self, cells):
        super().__init__()
        self["label"] = cells["label"]
        self["failed"] = cells["status"] != "0"
        self["stress"] = [float(cells[k]) for k in ("s11", "s22", "s33", "s12", "s13", "s23")]
        self["strain"] = [float(cells[k]) for k in ("e11", "e22", "e33", "g12", "g13", "g23")]
        for key in ("e", "suction"):
            self[key] = float(cells[key])
        for key in ("rates", "substeps", "resets", "cuts", "iterations"):
            self[key] = int(cells[key])

    @property
    def p(self):
        return sum(self["stress"][:3]) / 3

    @property
    def q(self):
        """Axial minus mean lateral stress (axis 1)."""
        s = self["stress"]
        return s[0] - (s[1] + s[2]) / 2


class Walker:
    """Runs paths with the program of a build, each once and at most `jobs` at a time. A path that takes more than `seconds` of the processor has failed."""

    def __init__(self, build=ROOT / "build/release", jobs=2, seconds=None):
        self.seconds = seconds
        self.program = pathlib.Path(build) / "verification/material/memory_rules/mud_walk"
        if not self.program.exists():
            raise SystemExit(f"there is no {self.program}: build the target mud_walk first")
        self.begun = {}
        self.pool = concurrent.futures.ThreadPoolExecutor(jobs)

    def start(self, path):
        """A future of the path's rows."""
        text = "\n".join(["case walk", *path.lines]) + "\n"
        if text not in self.begun:
            self.begun[text] = self.pool.submit(self._run, text)
        return self.begun[text]

    def run(self, path):
        return self.start(path).result()

    def run_all(self, paths):
        """Rows of every path of a list or a dictionary."""
        if isinstance(paths, dict):
            return dict(zip(paths, self.run_all(list(paths.values()))))
        return [future.result() for future in [self.start(path) for path in paths]]

    def _run(self, text):
        limited = self.seconds and (lambda: resource.setrlimit(resource.RLIMIT_CPU, (self.seconds, self.seconds + 5)))
        done = subprocess.run([self.program], input=text, capture_output=True, text=True, check=False, preexec_fn=limited)
        if self.seconds and done.returncode in (-signal.SIGXCPU, 128 + signal.SIGXCPU, -signal.SIGKILL):
            rows = [Row(cells) for cells in tables.parsed(done.stdout.rpartition("\n")[0])] if "\n" in done.stdout else []
            return [*rows, Row({**dict.fromkeys(COLUMNS, "0"), "status": "1"})]
        if done.returncode != 0:
            raise SystemExit(f"mud_walk: {done.stdout.splitlines()[-1:]} {done.stderr}")
        return [Row(cells) for cells in tables.parsed(done.stdout)]
