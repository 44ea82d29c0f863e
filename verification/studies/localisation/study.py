#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Shares of the shear work that is done without ellipticity: in the indentation, mesh by mesh and with viscosity
(indentation.csv), and in every scene of the repository with soil that yields (scenes.csv). A run that is finished is not
repeated, so that the script may be stopped and started again. Usage: study.py [indentation | scenes]"""
import json
import os
import pathlib
import re
import resource
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "common"), str(ROOT / "verification")]
import tables  # noqa: E402
from tools import results  # noqa: E402

BUILD = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release")
HERE = "studies/localisation"
INDENTATION = ROOT / "verification/studies/indentation/indent_s030.nml"
DURATION = 0.024    # [s] Of the impact: beyond the largest settlement, at 20.6 ms.
# Suction [kPa], viscosity [kPa s], meshes; the finest at 3 kPa, where meshes decide.
CASES = ((3, 0, (0.5, 1, 2, 3, 4)), (3, 0.2, (0.5, 1, 2, 3)), (3, 1.0, (0.5, 1, 2, 3)), (10, 0, (0.5, 1, 2, 3)),
         (30, 0, (0.5, 1, 2)), (30, 0.2, (0.5, 1)), (100, 0, (0.5, 1)))
SECONDS = 25        # Of the processor, for a scene: what a scene has not come to by then is told.
INDENTED = ("suction", "viscosity", "fineness", "share", "since_ms", "settlement_mm", "thrust_kN", "impulse_kNs", "p_w_kPa",
            "seconds")
SCENES = ("scene", "share", "since", "done", "words")


def run(folder, scene, *more, seconds=None):
    """A run, or what it left: its folder, exit code, what it said, processor time."""
    record = folder / "run.json"
    if record.exists():
        return json.loads(record.read_text())
    folder.mkdir(parents=True, exist_ok=True)
    limit = (lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))) if seconds else None
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([BUILD / "host/mud_host", scene, "--output", folder, "--quiet", *more], capture_output=True,
                          text=True, env={**os.environ, "OMP_NUM_THREADS": "1"}, preexec_fn=limit, cwd=scene.parent)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    told = dict(code=done.returncode, said=done.stderr.strip(), seconds=after.ru_utime - before.ru_utime)
    record.write_text(json.dumps(told))
    return told


def share_of(folder):
    """Largest share, and the time at which it first was above 5 %."""
    ledger = tables.columns(folder / "ledger.csv")
    share = ledger["localised"]
    above = share > 0.05
    return (float(share.max()), float(ledger["time"][above.argmax()]) if above.any() else None,
            float(ledger["time"][-1]))


def indentation(made):
    rows = []
    for suction, viscosity, meshes in CASES:
        for fineness in meshes:
            folder = made / "indentation" / f"s{suction}_v{viscosity}_f{fineness}"
            told = run(folder, INDENTATION, "--fineness", str(fineness), *(
                word for key, value in (
                    ("initial.p_w", -suction), ("initial.p_c", suction), ("fix[5].value", -suction),
                    ("fix[6].value", suction), ("stage[impact].duration", DURATION), ("region.viscosity", viscosity))
                for word in ("--set", f"{key}={value}")))
            if told["code"]:
                raise RuntimeError(f"{folder}: {told['said']}")
            share, since, _ = share_of(folder)
            h, contact = (tables.columns(folder / f"{name}.csv") for name in ("histories", "contact"))
            seated = contact["time"] > 2
            thrust = next(contact[name] for name in contact if name.endswith(".thrust"))[seated]
            rising = contact["time"][seated] <= 2.014
            impulse = np.trapezoid(thrust[rising], contact["time"][seated][rising])
            at_peak = np.interp(2.014, h["time"], h["centre.p_w"]) - np.interp(2.0, h["time"], h["centre.p_w"])
            rows.append((suction, viscosity, fineness, f"{share:.4f}", "" if since is None else
                         f"{1e3 * (since - 2):.2f}", f"{-1e3 * h['centre.u_z'].min():.4f}", f"{thrust.max():.4f}",
                         f"{impulse:.6f}", f"{at_peak:.4f}", f"{told['seconds']:.0f}"))
            tables.write(made / "indentation.csv", INDENTED, rows)
            print(*rows[-1], flush=True)


def listed():
    """Scenes with a soil that yields, by their paths from the root."""
    files = subprocess.run(["git", "ls-files", "*.nml"], cwd=ROOT, capture_output=True, text=True, check=True)
    found = []
    for name in files.stdout.split():
        text = (ROOT / name).read_text()
        if HERE not in name and re.search(r"^ *&scene\b", text, re.M) and re.search(r"^ *&(mud|umat)\b", text, re.M):
            found.append(name)
    return found


def scenes(made):
    rows = []
    for name in listed():
        folder = made / "scenes" / re.sub(r"\W", "_", name.removesuffix(".nml"))
        told = run(folder, prepared(name, folder), seconds=SECONDS)
        try:
            share, since, time = share_of(folder)
        except (OSError, ValueError, KeyError):
            print(f"{name}: no ledger: {told['said'][-300:]}")
            continue
        how = "to its end" if told["code"] == 0 else f"to {time:.4g} s: " + (
            f"{SECONDS} s of the processor" if told["code"] < 0 else f"exit code {told['code']}")
        words = re.search(r"most of it at (\(.*?\) m) in a band with its normal at (\d+) degrees", told["said"])
        rows.append((name.removesuffix(".nml"), f"{share:.4f}", "" if since is None else f"{since:.4g}", how,
                     f"{words[1]}, {words[2]} degrees" if words else ""))
        tables.write(made / "scenes.csv", SCENES, rows)
        print(*rows[-1], flush=True)


def prepared(name, folder):
    """The scene itself, or a copy that finds the laws of the tests."""
    path = ROOT / name
    text = path.read_text()
    changed = re.sub(r"'(\w+)\.so'", lambda found: f"'{BUILD / 'tests/umats' / found[1]}.so'", text)
    if changed == text:
        return path
    folder.mkdir(parents=True, exist_ok=True)
    copy = folder / path.name
    copy.write_text(changed)
    return copy


if __name__ == "__main__":
    for part in sys.argv[1:] or ("indentation", "scenes"):
        {"indentation": indentation, "scenes": scenes}[part](results.folder(__file__))
