#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Ten scenes of 20 to 2000 elements that leave open what they can, with `effects = 'auto'` and its defaults: what was
decided, whether that is right, and what it costs against the run that a user would have written. Writes results.csv.

    study.py [--build build/release] [--results FOLDER] [SCENE...]
"""
import argparse
import csv
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
from dataclasses import dataclass

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(ROOT / "verification")]
from tools import tables  # noqa: E402
from tools.results import MISSED, folder as made_in  # noqa: E402

COLUMNS = ("scene", "elements", "decided", "right", "differs by", "steps", "pilots", "auto [s]", "of these pilots [s]",
           "by hand [s]", "bound [s]")
SECONDS, TIMES = 10.0, 1.1   # What auto may cost: TIMES the run by hand, and SECONDS.
AUTO = "effects = 'auto'"


@dataclass(frozen=True)
class Scene:
    name: str
    why: str          # what decides, in a few words
    text: str         # {keys} of &scene, {analysis} of the open stage
    right: dict       # effect: on or off, as far as it is left open
    keys: str         # the same by hand: of &scene
    analysis: str     # and of the stage


def rectangle(r, r_cells, z, z_cells, ratio=""):
    return f"&mesh r = {r} r_cells = {r_cells} z = {z} z_cells = {z_cells} {ratio} /\n"


HELD = "&fix group = 'left' field = 'u_r' /\n&fix group = 'right' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /\n"
ELASTIC = "&elastic name = 's' young = {} poisson = 0.3 /\n"
DARCY = "&permeability name = 'k' intrinsic = {} law = 'constant' /\n"
SAND = "&mud name = 's' file = '{materials}/toyoura.nml' tangent = 3 /\n"


def head(name, more=""):
    return f"&scene name = '{name}' geometry = 'plane_strain' {{keys}} {more} /\n"


def ramp(times, values="0, 1"):
    return f"&history name = 'h' times = {times} values = {values} /\n"


def pressure(group, value):
    return f"&load group = '{group}' kind = 'pressure' value = {value} history = 'h' /\n"


def stage(duration, more=""):
    return f"&stage name = 'run' {{analysis}} duration = {duration} {more} /\n"


def points(*places):
    return "".join(f"&point name = '{name}' r = {r} z = {z} /\n" for name, r, z in places)


def scenes():
    yield Scene("air pressure on a column", "1000 s of consolidation by air and load", head("air")
                + rectangle("0, 0.2", 1, "-2, 0", 16) + ELASTIC.format("4e3")
                + "&retention name = 'vg' law = 'van_genuchten' alpha = 0.05 n = 2 s_min = 0.1 /\n"
                "&permeability name = 'k' intrinsic = 2e-14 law = 'mualem' m = 0.5 s_min = 0.1 /\n"
                "&region material = 's' retention = 'vg' permeability = 'k' void_ratio = 0.7 /\n"
                "&initial p_w = -20 p_c = 20 /\n" + ramp("0, 500, 505, 520, 525", "0, 0, 1, 1, 0")
                + stage(1000) + "&fix group = 'top' field = 'p_a' value = 15 history = 'h' /\n" + pressure("top", 15) + HELD
                + points(("top", 0, 0), ("middle", 0, -1)),
                {"inertia in run": "off", "p_w": "on", "p_c": "on", "gravity": "on"},
                "fields = 'u-p_w-p_c' pressures = 'quadratic' gravity = 9.81", "analysis = 'quasi_static'")
    yield Scene("slow footing, dry", "100 kPa within 1000 s; 20 kPa of weight below it", head("dry")
                + rectangle("0, 1, 6", "4, 8", "-6, 0", 10) + ELASTIC.format("2e4")
                + "&region material = 's' void_ratio = 0.7 /\n" + ramp("0, 1000") + stage(1000) + pressure("top_1", 100)
                + HELD + points(("centre", 0, 0), ("below", 0, -3)),
                {"inertia in run": "off", "gravity": "on"}, "gravity = 9.81", "analysis = 'quasi_static'")
    yield Scene("pulse on a column", "5 ms of pressure, waves of 25 ms", head("pulse", "gravity = 0")
                + rectangle("0, 0.1", 1, "0, 1", 10) + ELASTIC.format("1e4") + "&region material = 's' void_ratio = 0.8 /\n"
                + ramp("0, 0.0025, 0.005", "0, 1, 0") + stage(0.1) + pressure("top", 10) + HELD
                + points(("top", 0, 1), ("middle", 0, 0.5)),
                {"inertia in run": "on"}, "", "analysis = 'dynamic'")
    yield Scene("footing, saturated", "100 kPa within a day on soil that drains in days", head("wet", "gravity = 0")
                + rectangle("0, 1, 6", "6, 12", "-6, 0", 14) + ELASTIC.format("1e4") + DARCY.format("1e-14")
                + "&region material = 's' permeability = 'k' void_ratio = 0.7 /\n" + ramp("0, 86400") + stage(1e6)
                + pressure("top_1", 100) + "&fix group = 'top' field = 'p_w' /\n" + HELD
                + points(("centre", 0, 0), ("below", 0, -1)),
                {"inertia in run": "off", "p_w": "on"}, "fields = 'u-p_w' pressures = 'quadratic'", "analysis = 'quasi_static'")
    yield Scene("slow ramp, permeable", "10 kPa within 1000 s on soil that drains in a second", head("ramp", "gravity = 0")
                + rectangle("0, 2", 20, "0, 2", 50) + ELASTIC.format("1e4") + DARCY.format("1e-10")
                + "&region material = 's' permeability = 'k' void_ratio = 0.8 /\n" + ramp("0, 1000") + stage(1000)
                + pressure("top", 10) + "&fix group = 'top' field = 'p_w' /\n" + HELD
                + points(("top", 0, 2), ("middle", 0, 1)),
                {"inertia in run": "off", "p_w": "off"}, "fields = 'u-p_w' pressures = 'quadratic' without = 'p_w'", "analysis = 'quasi_static'")
    yield Scene("column shaken at its base", "a motion of the base acts with inertia alone", head("shaken", "gravity = 0")
                + rectangle("0, 1", 1, "-10, 0", 10) + ELASTIC.format("1e5") + "&region material = 's' void_ratio = 0.7 /\n"
                + ramp("0, 0.1, 0.3, 0.5, 0.6, 1", "0, 1, -1, 1, 0, 0") + stage(1)
                + "&tie first = 'left' second = 'right' /\n"
                "&fix group = 'bottom' field = 'u_r' motion = 'acceleration' value = 1 history = 'h' /\n"
                "&fix group = 'bottom' field = 'u_z' /\n" + points(("top", 0, 0), ("middle", 0, -5)),
                {"inertia in run": "on"}, "", "analysis = 'dynamic'")
    yield Scene("rain on a slope of suction", "two days of rain of 2e-7 m/s into 30 kPa of suction",
                head("rain", "gravity = 9.81")
                + rectangle("0, 0.5", 1, "-3, 0", 30) + ELASTIC.format("1e4")
                + "&retention name = 'vg' law = 'van_genuchten' alpha = 0.1 n = 2 s_min = 0.1 /\n"
                "&permeability name = 'k' intrinsic = 1e-12 law = 'mualem' m = 0.5 s_min = 0.1 /\n"
                "&region material = 's' retention = 'vg' permeability = 'k' void_ratio = 0.7 /\n"
                "&initial p_w = -30 p_c = 30 p_w_slope = -9.81 p_c_slope = 9.81 stress = 'geostatic' k_0 = 0.5 /\n"
                "&fix group = 'all' field = 'p_a' /\n" + ramp("0, 3600") + stage(172800)
                + "&load group = 'top' kind = 'water' value = 2e-7 history = 'h' /\n" + HELD
                + points(("top", 0, 0), ("middle", 0, -1)),
                {"inertia in run": "off", "p_w": "on", "p_c": "on"}, "fields = 'u-p_w-p_c' pressures = 'quadratic'", "analysis = 'quasi_static'")
    yield Scene("footing on sand", "a plate pushed 5 mm within 100 s into dry Toyoura sand", head("sand", "gravity = 9.81")
                + rectangle("0, 0.5, 3", "4, 6", "-3, 0", 8) + SAND + "&region material = 's' void_ratio = 0.75 /\n"
                "&initial stress = 'geostatic' k_0 = 0.5 surcharge = 10 /\n&load group = 'top_2' kind = 'pressure' value = 10 /\n"
                + ramp("0, 100") + stage(100, "steps = 'given' dt = 2")
                + "&fix group = 'top_1' field = 'u_z' value = -0.005 history = 'h' /\n" + HELD
                + points(("side", 1, 0), ("below", 0, -1)),
                {"inertia in run": "off"}, "", "analysis = 'quasi_static'")
    yield Scene("falling plate", "nothing but inertia holds a plate in flight", head("fall", "gravity = 0")
                + rectangle("0, 0.2, 0.8", "2, 3", "-0.8, 0", 4) + ELASTIC.format("2e4")
                + "&region material = 's' void_ratio = 0.7 /\n" + stage(0.06, "steps = 'given' dt = 1e-4")
                + "&plate name = 'p' r = 0, 0.2 z = 0.005 mass = 0.05 force = -0.4905 /\n"
                "&contact name = 'c' slave = 'top' master = 'p' penalty = 1e6 search_radius = 0.1 /\n" + HELD
                + points(("centre", 0, 0), ("below", 0, -0.4)),
                {"inertia in run": "on"}, "", "analysis = 'dynamic'")
    yield Scene("embankment, wet", "fill within ten days on 6 m of clay that drains in years", head("fill", "gravity = 0")
                + rectangle("0, 5, 20", "12, 16", "-6, 0", 36) + ELASTIC.format("3e3") + DARCY.format("1e-16")
                + "&region material = 's' permeability = 'k' void_ratio = 1 /\n" + ramp("0, 864000") + stage("3e7", "")
                + pressure("top_1", 60) + "&fix group = 'top' field = 'p_w' /\n" + HELD
                + points(("centre", 0, 0), ("toe", 5, 0), ("below", 0, -3)),
                {"inertia in run": "off", "p_w": "on"}, "fields = 'u-p_w' pressures = 'quadratic'", "analysis = 'quasi_static'")


def run(host, text, folder):
    """Seconds of processor time, what it prints, histories and the table of effects."""
    path = folder / "scene.nml"
    path.write_text(text.replace("{materials}", str(ROOT / "drivers/materials")), encoding="utf-8")
    began = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(host), str(path), "--output", str(folder)], capture_output=True, text=True,
                          env={**os.environ, "OMP_NUM_THREADS": "1"})
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in (0, MISSED):
        raise RuntimeError(done.stderr.strip())
    seconds = ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime
    table = folder / "effects.csv"
    rows = {row["effect"]: row for row in tables.rows(table)} if table.exists() else {}
    return seconds, done.stdout, tables.columns(folder / "histories.csv"), rows


def texts_of(scene):
    fill = lambda keys, analysis: scene.text.replace("{keys}", keys).replace("{analysis}", analysis)  # noqa: E731
    return fill(AUTO, ""), fill(scene.keys, scene.analysis)


def apart(one, other):
    """Largest distance of displacement histories at the named points, as a share of the largest range."""
    columns = [name for name in one if name.endswith((".u_r", ".u_z"))]
    scale = max(np.ptp(one[name]) for name in columns)
    return max(float(np.max(np.abs(np.interp(one["time"], other["time"], other[name]) - one[name])))
               for name in columns) / scale


def compare(host, scene):
    auto, hand = texts_of(scene)
    with tempfile.TemporaryDirectory() as folder:
        seconds, said, chosen, table = run(host, auto, pathlib.Path(folder))
    with tempfile.TemporaryDirectory() as folder:
        by_hand, _, wanted, _ = run(host, hand, pathlib.Path(folder))
    clock, pilots = (re.search(words, said) for words in (r"in all +(\S+) s", r"of these (\S+) s for pilots"))
    share = float(pilots[1]) / float(clock[1]) if pilots else 0.0
    decided = {name: table[name]["on"] for name in scene.right}
    return (scene.name, re.search(r": (\d+) elements, \d+ nodes", said)[1],
            ", ".join(f"{name.replace(' in run', '')} {on}" for name, on in decided.items()),
            "yes" if decided == scene.right else "no", f"{apart(wanted, chosen):.2g}",
            re.search(r"^(\d+) steps", said, re.M)[1], (re.search(r"^(\d+) pilots in", said, re.M) or "00")[1],
            f"{seconds:.2f}", f"{share * seconds:.2f}", f"{by_hand:.2f}", f"{TIMES * by_hand + SECONDS:.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--results", default=made_in(__file__), type=pathlib.Path)
    parser.add_argument("names", nargs="*", help="scenes; default: all, and results.csv is written")
    args = parser.parse_args()
    rows = []
    for scene in scenes():
        if args.names and scene.name not in args.names:
            continue
        rows.append(compare(args.build / "host/mud_host", scene))
        print(*rows[-1], sep=" | ", flush=True)
    if args.names:
        return
    with open(args.results / "results.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows)


if __name__ == "__main__":
    main()
