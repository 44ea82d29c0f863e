# SPDX-License-Identifier: MIT
"""What a hard case of the host is, its runs, and how it is judged.

Every case is run as it is and with its loads multiplied by 1 + 1e-9. It passes if all of its runs come to their end, if its own criterion holds,
and if the nudge stays below the third digit of its answer.
"""
import concurrent.futures
import functools
import math
import os
import pathlib
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from typing import Callable

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "material"), str(HERE.parents[1])]
from catalogue import CONTINUITY, SETTINGS, Setting  # noqa: E402
from point_walk import RULES  # noqa: E402
from tools import tables  # noqa: E402

ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1"}
SECONDS = 600   # of one run: one that takes longer hangs
PUBLISHED = ("classic", "paper's remedy", "as published")   # settings that take the scheme of the paper too
PAPER_RHO = 0.8                             # its spectral radius is not stated there; that of its authors' earlier papers
BOTH = tuple(setting for setting in SETTINGS if setting.name in ("default", "paper's remedy"))
NAMES = ("case", "setting", "finished", "value", "allowed", "continuity", "iterations", "cuts", "passed", "told")


def build_folder():
    return pathlib.Path(os.environ.get("MUD_BUILD_DIR") or HERE.parents[2] / "build/release").resolve()


def host():
    return build_folder() / "host/mud_host"


def sand(setting, **more):
    """The group of the material: what the setting says, the rest by default."""
    keys = {"memory_rule": None if setting.rule is None else RULES[setting.rule], "rho_e": setting.rho_e, "scheme": setting.scheme,
            "tolerance": setting.tolerance, "tangent": 3, **dict(setting.keys), **more}
    return "&mud name='sand' " + " ".join(f"{key}={value}" for key, value in keys.items() if value is not None) + " /\n"


def rho(setting):
    """The spectral radius of a stage: the paper's, or what the host chooses by default."""
    return f"rho_inf={PAPER_RHO}" if setting.name in PUBLISHED else ""


def load(setting, value):
    """A load or a prescribed motion, nudged where the setting is."""
    return repr(value * (1 + setting.nudge))


@dataclass(frozen=True)
class HostCase:
    """`scenes(setting)` gives {label: text or (text, {file: text})}; `judge({label: Run})` a number at or below `allowed`; `answer` what a
    nudge must not change; `settings` those that make a difference."""
    name: str
    group: str
    hard: str
    criterion: str
    allowed: float
    scenes: Callable
    judge: Callable
    answer: Callable = None
    settings: tuple = SETTINGS
    nudged: tuple = ()     # labels of the scenes that are nudged; none: all
    limit: str = ""        # why it is not passed with the defaults
    remedy: str = ""       # setting or key that passes it
    picture: Callable = None


class Run:
    """One run of mud_host: its exit code, what it said, its tables."""

    def __init__(self, folder, code, told):
        self.folder, self.code, self.told = folder, code, told

    @functools.cache
    def table(self, name):
        return tables.columns(self.folder / f"{name}.csv")

    @property
    def ledger(self):
        return self.table("ledger")

    @property
    def contact(self):
        return self.table("contact")

    @property
    def histories(self):
        return self.table("histories")

    @property
    def iterations(self):
        """Of all accepted steps; 0: none was."""
        return int(sum(self.ledger["iterations"])) if (self.folder / "ledger.csv").exists() else 0

    @property
    def cuts(self):
        """Up to the last accepted step."""
        return int(max(self.ledger["cuts"], default=0)) if (self.folder / "ledger.csv").exists() else 0

    def sentence(self):
        """The last line of a run that was refused or ended early."""
        lines = [line for line in self.told.splitlines() if line.strip()]
        return lines[-1] if lines else ""


def run(scene, folder, *more, seconds=SECONDS, limits=None):
    """mud_host on a text, or on a text with further files; in `folder`."""
    text, files = scene if isinstance(scene, tuple) else (scene, {})
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_text(content, encoding="utf-8")
    (folder / "scene.nml").write_text(text, encoding="utf-8")
    try:
        done = subprocess.run([host(), folder / "scene.nml", "--output", folder / "out", *more], capture_output=True, text=True, errors="replace",
                              timeout=seconds, env=ENVIRONMENT, preexec_fn=limits)
    except subprocess.TimeoutExpired:
        return Run(folder / "out", None, f"still runs after {seconds} s")
    return Run(folder / "out", done.returncode, done.stdout + done.stderr)


def run_all(scenes, folder):
    """{label: Run}; two at a time."""
    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("MUD_HARD_THREADS", 1))) as pool:
        jobs = {label: pool.submit(run, scene, folder / str(i)) for i, (label, scene) in enumerate(scenes.items())}
        return {label: job.result() for label, job in jobs.items()}


@dataclass(frozen=True)
class HostOutcome:
    case: str
    setting: str
    finished: bool
    value: float
    allowed: float
    continuity: float   # % of the answer; NaN: not asked
    iterations: int
    cuts: int
    passed: bool
    told: str           # by the run that did not come to its end
    runs: object   # {label: Run}, or the record of a case of files


def ended(told):
    """What stopped a run, in a few words."""
    for mark, words in (("created", "stops: energy out of nothing"), ("still runs", "hangs"), ("no convergence", "no convergence"),
                        ("refuse", "refused"), ("singular", "singular equations")):
        if mark in told.lower():
            return words
    return " ".join(told.split()[:8])


def evaluate(case, setting, folder, nudge=True):
    """The outcome of a case whose scenes run to their end, with every setting nudged too."""
    runs = run_all(case.scenes(setting), folder / "plain")
    stopped = [r for r in runs.values() if r.code != 0]
    done = not stopped
    value = case.judge(runs) if done else math.inf
    continuity = math.nan
    if nudge and done and case.answer:
        nudged = {label: scene for label, scene in case.scenes(setting.nudged()).items() if not case.nudged or label in case.nudged}
        other = run_all(nudged, folder / "nudged")
        continuity = math.inf
        if all(r.code == 0 for r in other.values()):
            a, b = case.answer({label: runs[label] for label in other}), case.answer(other)
            continuity = 100 * max(abs(x - y) / max(abs(x), 1e-300) for x, y in zip(a, b))
    good = done and value <= case.allowed and not continuity > CONTINUITY
    return HostOutcome(case.name, setting.name, done, value, case.allowed, continuity, sum(r.iterations for r in runs.values()),
                       sum(r.cuts for r in runs.values()), good, ended(stopped[0].sentence()) if stopped else "", runs)


def temporary():
    return tempfile.TemporaryDirectory(prefix="mud-hard-")


__all__ = ["BOTH", "HostCase", "HostOutcome", "NAMES", "Run", "SETTINGS", "Setting", "evaluate", "host", "load", "rho", "run", "sand", "temporary"]
