# SPDX-License-Identifier: MIT
"""Runs of a scene, each made once: with other meshes, steps and keys; a folder keeps what is finished."""

from __future__ import annotations

import contextlib
import csv
import ctypes
import fcntl
import hashlib
import json
import math
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import time
from dataclasses import dataclass, field

from ..errors import InputError
from ..host import HostRun
from .histories import Histories

try:
    import f90nml
except ImportError as problem:
    raise ImportError("studies read scenes with f90nml: pip install 'mud-soil[study]'") from problem

FILES = ("file", "library", "step_ends")  # keys that name files
LOOSEST = 0.1  # step tolerance above which nothing differs: steps of flows grow as fast as they may
# What the host takes where the scene says nothing, of a step tolerance A: a tenth, at most this (host/SCENE.md).
NEWTON_LARGEST, STRESS_LARGEST, SHARE = 1e-4, 1e-3, 0.1
DEFAULT_TOLERANCE = 1e-3  # of the steps that a stage chooses
GIVEN_NEWTON = 1e-3  # the same of stages with given steps
CUT = -signal.SIGPROF  # exit code of a run that has taken the processor time that it may
WORDS_EVERY = 10.0  # a run that lasts longer says every so many seconds where it is [s]
END_WITH_PARENT = 1  # PR_SET_PDEATHSIG of Linux
_held: dict[pathlib.Path, object] = {}  # locks of folders, until this process and its runs end
LOCALISED = 0.05  # share of the work that is done where the soil has lost ellipticity [-]


class Failed(Exception):
    """A run that ended before its time: a sentence, exit code and last words of mud_host, and whether it took all the
    processor time that it may."""

    def __init__(self, words: str, code: int = 0, said: str = "", cut: bool = False):
        super().__init__(words)
        self.code, self.said, self.cut = code, said or words, cut


class BudgetUsedUp(Exception):
    """The time is over."""


@dataclass(frozen=True)
class Key:
    """What a run is: times the cells along each axis, tolerance of the steps, tenths of the other tolerances, keys."""

    fineness: float
    tolerance: float
    newton: int = 0
    stress: int = 0
    settings: tuple[str, ...] = ()

    @classmethod
    def of(cls, fineness, tolerance, newton=0, stress=0, settings=()) -> Key:
        """With the digits that the host is given."""
        return cls(float(f"{fineness:.6g}"), float(f"{tolerance:.4g}"), newton, stress, tuple(settings))

    @property
    def folder(self) -> str:
        name = f"F{self.fineness:g}_a{self.tolerance:.3g}"
        name += f"_newton{self.newton}" * (self.newton > 0) + f"_stress{self.stress}" * (self.stress > 0)
        if self.settings:
            name += "_" + hashlib.sha256("\n".join(self.settings).encode()).hexdigest()[:8]
        return name

    def __str__(self):
        words = [f"fineness {self.fineness:g}", f"step tolerance {self.tolerance:.2g}"]
        tighter = [w for w, n in (("Newton's method", self.newton), ("the stress integration", self.stress)) if n]
        if tighter:
            words.append("a tenth of the tolerance of " + " and ".join(tighter))
        return ", ".join([*words, *self.settings])


@dataclass
class Run:
    """A run that is finished."""

    key: Key
    seconds: float  # processor time, of all threads
    histories: Histories = field(repr=False)
    warnings: list[str] = field(default_factory=list)
    localised: str = ""  # what the run says of shear bands without a width of their own


class Scene:
    """A scene and its finished runs."""

    def __init__(self, path, folder, host="", budget=math.inf, quiet=False, scale=True):
        self.path, self.folder, self.quiet = pathlib.Path(path), pathlib.Path(folder), quiet
        self.scale = scale  # given steps become longer and shorter with the tolerance
        self.host = find_host(host)
        if not self.path.is_file():
            raise InputError(f"{self.path}: there is no such scene")
        try:
            self.groups = f90nml.read(self.path)
        except Exception as problem:
            raise InputError(f"{self.path} cannot be read as groups of a scene: {problem}") from problem
        for name in ("scene", "mesh", "stage"):
            if name not in self.groups:
                raise InputError(f"{self.path}: the group &{name} is missing")
        self.budget, self.used = budget, 0.0  # processor time that runs of this call may take, and have taken [s]
        self.runs: dict[Key, Run] = {}
        self.failed: dict[Key, Failed] = {}
        self.made, self.lost = 0, 0.0  # runs of this call; processor time of runs that failed [s]
        self._origin = self._fingerprint()

    def list_of(self, group: str) -> list:
        return list_of(self.groups, group)

    @property
    def left(self) -> float:
        """Processor time that is left [s]: other programs on the machine do not shorten a study."""
        return self.budget - self.used

    @property
    def spent(self) -> float:
        """Processor time of all finished runs, also of those made earlier [s]."""
        return self.lost + sum(run.seconds for run in self.runs.values())

    def say(self, words: str, end: str = "\n"):
        if not self.quiet:
            print(words, end=end, flush=True)

    def run(self, fineness, tolerance, newton=0, stress=0, settings=(), keep=False, most=math.inf) -> Run:
        """A finished run: known, found in the folder, or made. `keep`: with the fields that the scene asks for; `most`:
        processor time that it may take [s]."""
        hold(self.folder)
        key = Key.of(fineness, tolerance, newton, stress, settings)
        if key in self.failed:
            raise self.failed[key]
        if key not in self.runs:
            told = self._found(key, most) or self._make(key, keep, most)
            if told["code"] != 0:
                words = f"the run with {key} ends with exit code {told['code']}: {told['said']}"
                if cut := told["code"] == CUT:
                    words = told["said"] = "it takes more processor time than it may"
                self.failed[key] = Failed(words, told["code"], told["said"], cut)
                self.lost += told["seconds"]
                raise self.failed[key]
            folder = self.folder / key.folder
            warnings = warnings_of(folder)
            self.runs[key] = Run(key, told["seconds"], Histories(folder), warnings, localised(folder, warnings))
        return self.runs[key]

    def words_of(self, key: Key) -> list[str]:
        """Options of mud_host that make a run what its key says."""
        words = ["--fineness", f"{key.fineness:.6g}", "--step-tolerance", f"{key.tolerance:.4g}"]
        settings = list(key.settings)
        for i, stage in enumerate(self.list_of("stage"), 1):
            given = stage.get("steps", "").lower() == "given"
            if given and self.scale:
                settings += self._given_steps(i, stage, key.tolerance)
            if key.newton:
                default = GIVEN_NEWTON if given else min(NEWTON_LARGEST, SHARE * key.tolerance)
                settings.append(
                    f"stage[{i}].tolerance={max(stage.get('tolerance', default) / 10**key.newton, 1e-14):.3e}"
                )
        if key.stress:
            for i, law in enumerate(self.list_of("mud"), 1):
                default = min(STRESS_LARGEST, SHARE * key.tolerance)
                settings.append(f"mud[{i}].tolerance={max(law.get('tolerance', default) / 10**key.stress, 1e-12):.3e}")
        return words + [word for setting in settings for word in ("--set", setting)]

    def _given_steps(self, i, stage, tolerance):
        """Steps that the scene gives are those of the tolerance 1e-2; with another they change as its square root."""
        times = (tolerance / 1e-2) ** 0.5
        if "step_ends" in stage:
            raise InputError(
                f"{self.path}: &stage {stage.get('name', i)} takes its steps from {stage['step_ends']}, so that no run "
                "of a study has others; leave step_ends out"
            )
        if abs(times - 1) < 1e-3 or "dt" not in stage:
            return []
        settings = [f"stage[{i}].dt={min(times * stage['dt'], stage['duration']):.6e}"]
        if "dt_max" in stage:
            settings.append(f"stage[{i}].dt_max={times * stage['dt_max']:.6e}")
        if "dt_growth" in stage:
            settings.append(f"stage[{i}].dt_growth={min(stage['dt_growth'] ** times, 10):.8f}")
        return settings

    def _fingerprint(self):
        """Of the scene, the files that it names and the program."""
        hashed = hashlib.sha256(self.path.read_bytes())
        hashed.update(pathlib.Path(self.host).read_bytes())
        for _, _, named in files_of(self.groups, self.path.parent):
            hashed.update(named.read_bytes())
        return hashed.hexdigest()

    def _found(self, key, most):
        """What the folder tells of a run that was finished by an earlier call."""
        try:
            told = json.loads((self.folder / key.folder / "run.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        if told["origin"] != self._origin or told["words"] != self.words_of(key):
            return None
        if told["code"] == CUT and most > told["most"]:
            return None
        self.say(f"   found: {key}, {told['seconds']:.3g} s")
        return told

    def _make(self, key, keep, most):
        folder = self.folder / key.folder
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        words = self.words_of(key)
        # Between steps that are not written a history is not known.
        command = [self.host, self.path, *words, "--output", folder, "--set", "stage.every=1"]
        if not keep:
            command += ["--set", "stage.fields=0"]
        if self.left <= 0:
            raise BudgetUsedUp
        self.made, limit = self.made + 1, min(most, self.left)
        self.say(f"   run {self.made}: {key} ...", end="")
        start, before = time.monotonic(), processor()
        with open(folder / "said.txt", "w", encoding="utf-8") as said, open(folder / "errors.txt", "w") as errors:
            # An interrupt waits until the run is known: one that nobody knows would go on, and write.
            mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
            process = subprocess.Popen(
                command, stdout=said, stderr=errors, preexec_fn=_limit(limit, mask), pass_fds=[hold(self.folder)]
            )
            try:
                signal.pthread_sigmask(signal.SIG_SETMASK, mask)
                while process.poll() is None:
                    try:
                        process.wait(WORDS_EVERY)
                    except subprocess.TimeoutExpired:
                        lines = (folder / "said.txt").read_text(encoding="utf-8", errors="replace").splitlines()
                        self.say(f"\n      {time.monotonic() - start:.0f} s: {lines[-1] if lines else ''}", end="")
            except BaseException:
                process.kill()
                process.wait()
                self.say(" stopped")
                raise
        used = processor() - before
        self.used += used
        if process.returncode == CUT and limit < most:
            self.say(" stopped")
            raise BudgetUsedUp
        self.say(f" {used:.3g} s")
        lines = (folder / "errors.txt").read_text(encoding="utf-8", errors="replace").strip().splitlines()
        told = {
            "origin": self._origin,
            "words": words,
            "seconds": used,
            "code": process.returncode,
            "said": lines[-1] if lines else "",
            "most": min(most, 1e9),
        }
        if process.returncode >= 0 or process.returncode == CUT:  # one that was killed is repeated
            part = folder / "run.json.part"
            part.write_text(json.dumps(told, indent=1), encoding="utf-8")
            part.replace(folder / "run.json")
        return told


def hold(folder: pathlib.Path) -> int:
    """Makes a folder and keeps it for this process and its runs: two studies there would delete and find each other's
    runs. The number of the open lock."""
    folder.mkdir(parents=True, exist_ok=True)
    place = folder.resolve()
    if place in _held:
        return _held[place].fileno()
    lock = open(place / "lock", "w")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        lock.close()
        raise InputError(f"another study is at work in {folder}: wait for it, or name another --output") from None
    _held[place] = lock
    return lock.fileno()


def list_of(groups, name: str) -> list:
    """Groups of a name, in their order."""
    found = groups.get(name, [])
    return list(found) if isinstance(found, list) else [found]


def files_of(groups, folder) -> list[tuple]:
    """Files that a scene names, seen from a folder: (group, key, path)."""
    all_groups = [group for name in dict.fromkeys(groups) for group in list_of(groups, name)]
    named = [(g, k, pathlib.Path(folder) / str(g[k])) for g in all_groups for k in FILES if k in g]
    return [one for one in named if one[2].is_file()]


def write_csv(path, head, rows):
    """A table; numbers with four digits, None as nothing."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(head)
        table.writerows([["" if x is None else x if isinstance(x, str) else f"{x:.4g}" for x in row] for row in rows])


def _limit(most, mask):
    """Sets in a new process what ends a run, more processor time [s] or that its study is gone, and its signals."""
    system = ctypes.CDLL(None)

    def begin():
        with contextlib.suppress(AttributeError):  # elsewhere the lock keeps others out until the run ends
            system.prctl(END_WITH_PARENT, signal.SIGKILL)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        if most != math.inf:
            signal.setitimer(signal.ITIMER_PROF, most)

    return begin


def processor() -> float:
    """Processor time of all runs that have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def warnings_of(folder) -> list[str]:
    """What a run warns of: of warnings that differ by stage, time and number the first, and how many more there are."""
    kinds: dict[str, list[str]] = {}
    for line in (folder / "errors.txt").read_text(encoding="utf-8", errors="replace").splitlines():
        if text := line.partition("warning: ")[2]:
            kind = re.sub(r"[-+.\d]+(e[-+]?\d+)?", "0", re.sub(r"^stage \w+", "", text))
            kinds.setdefault(kind, []).append(text.strip())
    return [same[0] + f" (and {len(same) - 1} more)" * (len(same) > 1) for same in kinds.values()]


def localised(folder, warnings) -> str:
    """What a run says of localisation: a warning, or the share of the shear work in its ledger. Empty: nothing."""
    for text in warnings:
        if "localis" in text.lower():
            return text.removesuffix(".")
    try:
        share = HostRun(folder).ledger.get("localised")
    except InputError:
        return ""
    if share is None or not len(share) or share.dtype.kind != "f" or share.max() <= LOCALISED:
        return ""
    return (
        f"{100 * share.max():.2g} % of the shear work is done where the tangent of the soil has lost ellipticity: "
        "displacements there depend on the cell and have no limit: state the cell with them, or give the region a "
        "viscosity"
    )


def find_host(host: str = "") -> str:
    """Path of mud_host: as named, MUD_HOST, that of the search path, that of a tree that is built."""
    tree = pathlib.Path(__file__).resolve().parents[3] / "build/release/host/mud_host"
    for name in (host, os.environ.get("MUD_HOST", "")):
        if name:
            found = shutil.which(name)
            if not found:
                raise InputError(f"there is no program {name}; name mud_host by --host or MUD_HOST")
            return found
    found = shutil.which("mud_host") or (str(tree) if tree.exists() else "")
    if not found:
        raise InputError(
            "mud_host is not found: ./demo of the source tree builds it in build/release/host; name it by --host or "
            "MUD_HOST, or put it into the search path"
        )
    return found
