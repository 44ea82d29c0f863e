# SPDX-License-Identifier: MIT
"""The indentation benchmark as a function: scenes from indent_s030.nml, a queue that runs them, what a run tells."""
import argparse
import ctypes
import functools
import hashlib
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
from tools import results, tables
from tools.bench import AS_PUBLISHED, MATERIAL
from tools.bench import ROOT as root

here = pathlib.Path(__file__).resolve().parent
build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release")
host = build / "host/mud_host"
read = tables.columns
TEMPLATE = here / "indent_s030.nml"
RESULTS = here / "results"   # committed: to read from
SUCTIONS = (0, 3, 30, 50, 100, 200, 500, 1000)
STEPS, DT = 1333, 3e-5
# By steps and not by time: factors of the matrix are dropped at a checkpoint, and so the same steps are taken every
# time.
CHECKPOINT_STEPS = 500
# Name: memory rule, Newton's tolerance (None: that of the template).
SERIES = {"remedy": (1, None), "as_published": (0, None), "classic": (0, None),
          "remedy_tight": (1, 1e-5), "as_published_tight": (0, 1e-5)}
SURCHARGE = 0.2        # kPa, where the suction is 0
SATURATED_FLOOR = 0.01   # least relative permeability of the three-field scene there
CHECKPOINT_REFUSED = 17   # exit code of mud_host
IMPULSE_ALLOWED, ENERGY_ALLOWED = 1e-3, 1e-2   # shares of the impulse of the load and of its work


# ---- scenes

def parse(text):
    """A scene as a list of groups: (name, {key: text of the value})."""
    groups = []
    for line in text.splitlines():
        line = line.split("!")[0].strip()
        if line.startswith("&"):
            groups.append((line[1:], {}))
        elif "=" in line:
            key, value = line.split("=", 1)
            groups[-1][1][key.strip()] = value.strip()
    return groups


def render(groups):
    return "".join(f"&{name}\n" + "".join(f"   {k} = {v}\n" for k, v in keys.items()) + "/\n" for name, keys in groups)


def change(groups, where, **keys):
    """Sets keys of the one group that `where` names (`stage:impact`); None takes a key away."""
    kind, _, name = where.partition(":")
    found = [k for g, k in groups if g == kind and (not name or k.get("name") == f"'{name}'")]
    if len(found) != 1:
        raise ValueError(f"{len(found)} groups {where} in the scene")
    for key, value in keys.items():
        found[0].pop(key, None)
        if value is not None:
            found[0][key] = str(value)


def scene(suction, fields, series, adapt=None, steps=STEPS):
    """Groups of one analysis; `adapt(groups)` makes a variation of it."""
    groups = parse(TEMPLATE.read_text(encoding="utf-8"))
    rule, tolerance = SERIES[series]
    change(groups, "mud", file=f"'{MATERIAL}'", memory_rule=rule, rho_e=0.0)
    if series.startswith("as_published"):
        change(groups, "mud", **AS_PUBLISHED)
    change(groups, "scene", fields=f"'{fields}'", checkpoint_steps=CHECKPOINT_STEPS)
    change(groups, "stage:impact", duration=f"{steps * DT:.8g}")
    if tolerance:
        change(groups, "stage:impact", tolerance=tolerance)
    water = dict(p_w=-suction, p_c=suction)
    if suction == 0:
        # Hydrostatic; nothing presses the grains of the surface together but a stated surcharge.
        water.update(p_w_slope=f"{-0.997 * 9.81:.8g}", surcharge=SURCHARGE)
        groups.append(("load", dict(group="'top'", kind="'pressure'", value=str(SURCHARGE))))
        # Sand that is about to flow: with the continuum tangent the published rules need five times the rates to sit.
        change(groups, "mud", tangent=None)
        if fields == "u-p_w":
            del water["p_c"]
            groups = [g for g in groups if g[1].get("field") != "'p_c'"]
            change(groups, "initial", p_c=None)
        else:
            change(groups, "permeability", floor=SATURATED_FLOOR)
    change(groups, "initial", **water)
    for name, keys in groups:
        if name == "fix" and keys["field"] in ("'p_w'", "'p_c'"):
            keys["value"] = str(suction if keys["field"] == "'p_c'" else -suction)
    if adapt:
        adapt(groups)
    return groups


def label(suction, fields):
    return f"s{suction:04d}" + ("w" if fields == "u-p_w" else "")


# ---- program

def digest(*pieces):
    return hashlib.sha256(b"\0".join(pieces)).hexdigest()[:12]


@functools.cache
def program_bytes():
    """The executable; nothing where it is not built, as for a report."""
    return host.read_bytes() if host.exists() else b""


def program():
    """(digest of the executable, commit of its sources; + where they differ from it)."""
    def git(*words):
        return subprocess.run(["git", "-C", root, *words], capture_output=True, text=True).stdout.strip()
    sources = (":(glob)*/**/*.f90", ":(glob)umat/**/*.h", ":(exclude)tests", ":(exclude)verification",
               ":(exclude)benchmarks", "cmake", "CMakePresets.json",
               ":(glob)**/CMakeLists.txt")
    commit = git("log", "-1", "--format=%h", "--", *sources) or "unknown"
    return digest(program_bytes()), commit + ("+" if git("status", "--porcelain", "--", *sources) else "")


def results_folder(script, quick):
    """Where a script writes results: beside those of earlier runs, which begin as the committed ones."""
    folder = results.folder(script) / ("quick" if quick else "results")
    for kept in [] if quick else RESULTS.rglob("*.csv"):
        copy = folder / kept.relative_to(RESULTS)
        if not copy.exists() or copy.stat().st_mtime < kept.stat().st_mtime:
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(kept, copy)
    return folder


def rows_so_far(path, args, parser):
    """Rows of earlier runs. Where everything is run, those that another program made go; where the arguments choose a
    part the others stay, and the script ends with exit code 1 if they are of another program."""
    rows, (digest, _) = read_rows(path), program()
    whole = all(getattr(args, name, None) == parser.get_default(name) for name in ("suction", "series", "only"))
    return {name: row for name, row in rows.items() if row["program"] == digest or not whole}


# ---- queue

def parser_of(text, suctions, limit):
    """Options that every set of analyses has."""
    parser = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--suction", type=int, nargs="+", choices=suctions, default=suctions, metavar="KPA")
    parser.add_argument("--jobs", type=int, default=2, help="analyses at a time, one thread each (default: 2)")
    parser.add_argument("--limit", type=float, default=limit, help=f"minutes after which an analysis is stopped "
                                                                   f"(default: {limit})")
    parser.add_argument("--quick", action="store_true", help="50 steps; results and pictures into "
                                                             "build/indentation_quick")
    parser.add_argument("--list", action="store_true", help="say what would run")
    return parser


def show(jobs):
    for job in jobs:
        print(f"{job.name}: {'finished' if job.finished else 'to run'}")


class Job:
    """One analysis in its own folder of the build; finished, interrupted or new, as the folder says."""

    def __init__(self, name, groups, folder, steps=STEPS, **facts):
        self.name, self.groups, self.folder, self.facts = name, groups, folder / name, facts
        self.duration = steps * DT
        self.text = render(groups)
        self.mark = digest(self.text.encode(), MATERIAL.read_bytes(), program_bytes())
        self.process = None
        try:
            self.state = json.loads((self.folder / "state.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            self.state = {}
        if self.state.get("mark") != self.mark:
            self.state = {"mark": self.mark, "outcome": None, "cpu": 0.0, "wall": 0.0, "attempts": 0}

    @property
    def finished(self):
        return self.state["outcome"] not in (None, "limit")

    def save(self):
        (self.folder / "state.json").write_text(json.dumps(self.state), encoding="utf-8")

    def start(self):
        checkpoint = self.folder / "checkpoint.h5"
        again = self.state["attempts"] > 0 and checkpoint.exists()
        if not again:
            shutil.rmtree(self.folder, ignore_errors=True)
            self.folder.mkdir(parents=True)
            self.state.update(cpu=0.0, wall=0.0, attempts=0)
        self.state["attempts"] += 1
        self.save()
        path = self.folder / "scene.nml"
        path.write_text(self.text, encoding="utf-8")
        command = [host, path, "--output", self.folder] + (["--restart", checkpoint] if again else [])
        with open(self.folder / "log.txt", "a", encoding="utf-8") as log:
            self.process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, preexec_fn=die_with_parent,
                                            env={**os.environ, "OMP_NUM_THREADS": "1"})
        self.began = time.monotonic()

    def book(self, usage, outcome):
        self.state["cpu"] += usage.ru_utime + usage.ru_stime
        self.state["wall"] += time.monotonic() - self.began
        self.state["outcome"] = outcome
        self.save()
        self.process = None

    def poll(self, limit):
        """True when it has ended by itself or at its limit of seconds."""
        pid, status, usage = os.wait4(self.process.pid, os.WNOHANG)
        if pid:
            code = os.waitstatus_to_exitcode(status)
            self.process.returncode = code   # it was waited for here
            # Killed from outside: it goes on next time, from the start if its checkpoint was refused.
            self.book(usage, None if code in (-signal.SIGTERM, -signal.SIGKILL, -signal.SIGINT, CHECKPOINT_REFUSED)
                      else code)
            if code == CHECKPOINT_REFUSED:
                (self.folder / "checkpoint.h5").unlink(missing_ok=True)
        elif time.monotonic() - self.began > limit:
            self.stop("limit")
        else:
            return False
        return True

    def stop(self, outcome=None):
        self.process.terminate()
        pid, status, usage = os.wait4(self.process.pid, 0)
        self.process.returncode = os.waitstatus_to_exitcode(status)
        self.book(usage, outcome)

    def share(self):
        """How much of the steps is done."""
        try:
            with open(self.folder / "ledger.csv", "rb") as file:
                file.seek(0, 2)
                file.seek(max(0, file.tell() - 600))
                return min(1.0, max(0.0, (float(file.read().splitlines()[-2].split(b",")[0]) - 2) / self.duration))
        except (OSError, ValueError, IndexError):
            return 0.0


def die_with_parent():
    ctypes.CDLL(None).prctl(1, signal.SIGTERM)


def run_all(jobs, parallel, limit, done):
    """Runs what is not finished; `done(job)` after each. Interrupted ones go on from their checkpoint next time."""
    waiting = [j for j in jobs if not j.finished]
    for job in jobs:
        if job.finished:
            done(job)
    print(f"{len(jobs)} analyses, {len(jobs) - len(waiting)} of them finished before; {parallel} at a time", flush=True)
    total, running, spent, shown = len(waiting), [], [], 0.0
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    try:
        while waiting or running:
            while waiting and len(running) < parallel:
                running.append(waiting.pop(0))
                running[-1].start()
            time.sleep(0.2)
            for job in [j for j in running if j.poll(limit)]:
                running.remove(job)
                if job.state["outcome"] is None:
                    print(f"\r{job.name}: interrupted; the next start of this command goes on with it", flush=True)
                    continue
                spent.append(job.state["wall"])
                done(job)
                print(f"\r{job.name}: {outcome_of(job)}, {job.state['wall']:.0f} s; "
                      f"{total - len(waiting) - len(running)} of "
                      f"{total}, about {span(left(waiting, running, spent, parallel))} left" + 10 * " ", flush=True)
            if sys.stdout.isatty() and time.monotonic() - shown > 1:
                shown = time.monotonic()
                print("\r" + ", ".join(f"{j.name} {100 * j.share():.0f} %" for j in running)
                      + f"; about {span(left(waiting, running, spent, parallel))} left" + 10 * " ", end="", flush=True)
    finally:
        for job in running:
            job.stop()


def left(waiting, running, spent, parallel):
    """Seconds, or None while nothing tells the pace."""
    shares = [(time.monotonic() - j.began, j.share()) for j in running]
    paces = spent + [t / s for t, s in shares if s > 0.05]
    if not paces:
        return None
    mean = sum(paces) / len(paces)
    return (mean * len(waiting) + sum((1 - s) * mean for _, s in shares)) / parallel


def span(seconds):
    if seconds is None:
        return "?"
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


def outcome_of(job):
    outcome = job.state["outcome"]
    return {0: "done", "limit": "stopped at the limit of time; the next start goes on with it"}.get(outcome, f"exit code {outcome}")


# ---- what a run tells

def impact_of(folder):
    """Contact, ledger, histories of the impact, each with the row at its start first."""
    c, ledger, h = (read(folder / f"{name}.csv") for name in ("contact", "ledger", "histories"))
    seated = np.flatnonzero(ledger["stage"] == 2)[-1]
    cut = {"contact": c, "ledger": ledger}
    cut = {name: {k: v[seated:] for k, v in table.items()} for name, table in cut.items()}
    cut["histories"] = {k: v[-len(cut["ledger"]["time"]):] for k, v in h.items()}
    cut["start"] = {k: v[0] for k, v in h.items()}
    return cut


def retention(suction, e=0.8):
    """Paper, eq. (24) with Table 3."""
    return 1 / math.log(math.e + (suction * e**2 / 5)**2)


def measure(job):
    """A row of the table of results."""
    row = dict(name=job.name, **job.facts, outcome=job.state["outcome"], message="",
               cpu_s=job.state["cpu"], wall_s=job.state["wall"], attempts=job.state["attempts"])
    log = (job.folder / "log.txt").read_text(encoding="utf-8", errors="replace")
    lines = [line for line in log.splitlines() if line.strip() and line.strip() != "Terminated"]
    if job.state["outcome"] != 0:
        # The sentence of the fault, which begins with stage and time; not the account of the time after it.
        said = [line for line in lines if re.match(r"Stage \S+, time", line)]
        row["message"] = (said or lines or [""])[-1].strip() if job.state["outcome"] != "limit" else ""
    try:
        t = impact_of(job.folder)
    except (OSError, IndexError, ValueError):
        return row   # it did not come to the impact
    c, ledger, h = t["contact"], t["ledger"], t["histories"]
    keys = {g: k for g, k in job.groups}
    stage = next(k for g, k in job.groups if g == "stage" and k["name"] == "'impact'")
    mass, rho = float(keys["plate"]["mass"]), float(stage["rho_inf"])
    time_ms = 1e3 * (c["time"] - c["time"][0])
    n = len(time_ms) - 1
    iterations = ledger["iterations"][1:]
    row.update(last_ms=time_ms[-1], steps=n, iterations=int(iterations.sum()), second=int((iterations > 1).sum()),
               most=int(iterations.max(initial=0)))
    found = re.findall(r"(\d+) steps, (\d+) iterations, (\d+) cuts, (\d+) rate evaluations", log)
    if found:
        everything = read(job.folder / "ledger.csv")["iterations"].sum()
        row.update(rejected=int(found[-1][1]) - int(everything), cuts=int(found[-1][2]), rates=int(found[-1][3]))
    if n == 0:
        return row
    u, plate = (-1e3 * (x - x[0]) for x in (h["centre.u_z"], c["plate.u_z"]))
    thrust = c["interface.thrust"]
    off = time_ms[(thrust <= 0) & (time_ms > 14)]
    row.update(largest_mm=u.max(), largest_ms=time_ms[u.argmax()], plate_mm=plate[-1], lost_ms=off[0] if len(off)
               else math.nan)
    row["final_mm"] = u[-1] if job.state["outcome"] == 0 else math.nan
    row.update(S_w_start=t["start"].get("centre.S_w", 1.0))
    suction = job.facts["suction"]
    row["S_w_error"] = abs(row["S_w_start"] - retention(suction, float(keys["region"]["void_ratio"])))
    peak = int(np.argmin(c["plate.load"]))
    for name in ("p_w", "p_c", "S_w"):
        value = h.get("centre." + name, np.zeros(n + 1))
        row.update({f"d_{name}": value[peak] - value[0], f"{name}_least": value.min(), f"{name}_most": value.max()})
    # Oscillation: rms of p_w about its mean over 0.6 ms.
    row["ripple_kPa"] = ripple(h["centre.p_w"], time_ms)
    # Forces count at 1 - alpha_f = 1/(1 + rho_inf) within a step, and so does the load here.
    dt = c["dt"][1:]
    given = np.sum((c["plate.load"][:-1] + np.diff(c["plate.load"]) / (1 + rho)) * dt)
    gained = mass * (c["plate.v_z"][-1] - c["plate.v_z"][0])
    row["impulse_open"] = abs(given + np.sum(thrust[1:] * dt) - gained) / abs(given)
    row["energy_open"] = np.abs(ledger["imbalance"] - ledger["imbalance"][0]).max() / np.abs(ledger["loads"]).max()
    first = np.max([ledger["first_" + f][1:] for f in ("u_r", "u_z", "p_w", "p_c")], axis=0)
    for name, part in (("before", time_ms[1:] <= 14), ("unloading", (time_ms[1:] > 14) & (time_ms[1:] <= 28)),
                       ("after", time_ms[1:] > 28)):
        if part.any():
            row["first_" + name] = np.median(first[part])
    row.update(by_residual=int((ledger["reduction"][1:] > 1e-3).sum()),
               by_change=int((ledger["correction"][1:] > 1e-3).sum()))
    return row


def ripple(values, time_ms):
    window = time_ms.searchsorted(0.6)
    if len(values) < 3 * window or window < 3:
        return math.nan
    mean = np.convolve(values, np.ones(window) / window, mode="valid")
    half = window // 2
    return float(np.sqrt(np.mean((values[half:half + len(mean)] - mean)**2)))


def histories(folder, every):
    """Decimated histories of the impact as columns."""
    t = impact_of(folder)
    c, ledger, h = t["contact"], t["ledger"], t["histories"]
    keep = np.unique(np.r_[np.arange(0, len(c["time"]), every), len(c["time"]) - 1])
    columns = {"t_ms": 1e3 * (c["time"] - c["time"][0]), "u_mm": -1e3 * (h["centre.u_z"] - h["centre.u_z"][0]),
               "plate_mm": -1e3 * (c["plate.u_z"] - c["plate.u_z"][0]), "thrust_kN": c["interface.thrust"],
               "load_kN": -c["plate.load"], "p_w_kPa": h["centre.p_w"]}
    if "centre.p_c" in h:
        columns.update(p_c_kPa=h["centre.p_c"], S_w=h["centre.S_w"])
    return {k: v[keep] for k, v in columns.items()}


def errors(folder):
    """Per step: number of iterations, largest error of the fields after the first and after the last of them."""
    ledger = impact_of(folder)["ledger"]
    fields = ("u_r", "u_z", "p_w", "p_c")
    return {"t_ms": 1e3 * (ledger["time"][1:] - ledger["time"][0]), "iterations": ledger["iterations"][1:],
            "first": np.max([ledger["first_" + f][1:] for f in fields], axis=0),
            "last": np.max([ledger["error_" + f][1:] for f in fields], axis=0)}


# ---- small files

def write_table(path, columns, digits=6):
    tables.write(path, columns, ([f"{v:.{digits}g}" for v in row] for row in zip(*columns.values())))


def read_rows(path):
    """Rows of results by their name; numbers as such, nan where nothing stands."""
    def value(text):
        try:
            return float(text)
        except ValueError:
            return text
    if not path.exists():
        return {}
    rows = tables.rows(path)
    texts = ("name", "fields", "series", "variation", "message", "program", "commit", "outcome")
    return {r["name"]: {k: v if k in texts else value(v) if v else math.nan for k, v in r.items()} for r in rows}


def write_rows(path, rows):
    keys = list(dict.fromkeys(k for row in rows.values() for k in row))
    tables.write(path, keys, (["" if isinstance(v, float) and math.isnan(v) else f"{v:.7g}" if isinstance(v, float)
                               else v
                               for v in (row.get(k, "") for k in keys)] for row in rows.values()))


def balances(row):
    """Sentences about what is not as it must be."""
    wrong = []
    for key, allowed in (("impulse_open", IMPULSE_ALLOWED), ("energy_open", ENERGY_ALLOWED), ("S_w_error", 1e-6)):
        if not row.get(key, math.nan) <= allowed:
            wrong.append(f"{row['name']}: {key} = {row.get(key, math.nan):.2g}, allowed {allowed:g}")
    return wrong
