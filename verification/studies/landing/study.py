#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Bodies that fall on soil: speed at each landing, peak thrust of it and settlement at three tolerances, against given
fine steps on the same mesh. Writes results.csv and picture.csv; resumable, a scene whose rows are there is left.

    study.py [--build build/release] [--results FOLDER] [SCENE...]

Fine runs go to build/landing and serve again, to the same programs. Some 15 minutes of one core.
"""
import argparse
import os
import pathlib
import re
import resource
import subprocess
import sys
from dataclasses import dataclass

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(ROOT / "verification"), str(ROOT / "common")]
import tables  # noqa: E402
from tools.gmsh import Mesh  # noqa: E402
from tools.results import current, folder as made_in  # noqa: E402

COLUMNS = ("scene", "tolerance", "steps", "repeated", "seconds", "answer", "value", "reference", "reference_off", "error")
TOLERANCES = ("1e-1", "1e-2", "1e-3")
GRAVITY = 9.81
FLIGHT = 0.15      # A contact that has been open for this share of the first flight lands anew.
LANDINGS = 3
PICTURE = "plate on elastic soil, 2 cm"

SOILS = {"elastic soil": ("&elastic name = 'soil' young = 2e4 poisson = 0.3 /\n", "void_ratio = 0.7 drainage = 'dry' damping = 20"),
         "MUD": ("&mud name = 'soil' file = '{materials}/toyoura.nml' tangent = 3 /\n", "void_ratio = 0.75 drainage = 'dry'")}
SURCHARGE = 5.0    # On the sand, which has no strength without it [kPa].
R, Z = (0.0, 0.1, 0.2, 0.44, 0.8), (-0.8, -0.4, -0.16, 0.0)   # The soil's cells, and those of the block upon it.
BLOCK_R, BLOCK_Z = (0.0, 0.075, 0.15), (0.0, 0.075, 0.15)


@dataclass(frozen=True)
class Scene:
    body: str         # plate or block
    soil: str         # of SOILS
    height: float     # [m]
    duration: float   # until after the third landing, or where the body stays down after it has come to rest [s]
    fine: float       # given step of the reference [s]

    @property
    def name(self):
        fall = f"{1000*self.height:.0f} mm" if self.height < 0.01 else f"{100*self.height:.0f} cm"
        return f"{self.body} on {self.soil}, {fall}"


def scenes():
    for soil, body, durations in (("elastic soil", "plate", (0.07, 0.17, 0.41)), ("elastic soil", "block", (0.07, 0.17, 0.5)),
                                  ("MUD", "plate", (0.035, 0.078, 0.216)), ("MUD", "block", (0.035, 0.078, 0.216))):
        for height, duration in zip((0.002, 0.02, 0.2), durations):
            yield Scene(body, soil, height, duration, 4e-6 if soil == "elastic soil" else 2e-5)


def text_of(scene, folder, step=""):
    """The scene, its mesh in a folder; `step`: keys of the stage in which the body falls."""
    mesh = Mesh()
    mesh.block("ground", R, Z)
    if scene.body == "block":
        mesh.block("block", BLOCK_R, [scene.height + z for z in BLOCK_Z])
    mesh.write(folder / "mesh.msh")
    material, region = SOILS[scene.soil]
    material = material.replace("{materials}", str(ROOT / "drivers/materials"))
    text = (f"&scene name = '{scene.name}' gravity = {GRAVITY} /\n&mesh file = 'mesh.msh' /\n{material}"
            f"&region group = 'ground' material = 'soil' {region} /\n"
            "&fix group = 'axis' field = 'u_r' /\n&fix group = 'ground_side' field = 'u_r' /\n"
            "&fix group = 'ground_bottom' field = 'u_r' /\n&fix group = 'ground_bottom' field = 'u_z' /\n"
            "&point name = 'centre' r = 0 z = 0 /\n")
    rest = scene.soil == "MUD"
    acts = "stages = 'fall'" if rest else ""
    surcharge = f"surcharge = {SURCHARGE}" if rest else ""
    text += f"&initial group = 'ground' stress = 'geostatic' k_0 = 0.5 {surcharge} /\n"
    if rest:
        text += (f"&load group = 'ground_top' kind = 'pressure' value = {SURCHARGE} /\n"
                 "&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-10 zero_displacements = 'yes' /\n")
    master = "plate"
    if scene.body == "plate":
        text += f"&plate name = 'plate' r = 0, 0.2 z = {scene.height} mass = 0.05 force = {-0.05*GRAVITY} /\n"
        if rest:
            text += "&fix group = 'plate' field = 'u_z' hold = 'yes' stages = 'rest' /\n"
    else:
        master = "block_bottom"
        text += ("&elastic name = 'block' young = 2e5 poisson = 0.2 /\n"
                 "&region group = 'block' material = 'block' void_ratio = 0 rho_s = 2.5 drainage = 'dry' /\n"
                 f"&point name = 'block' r = 0 z = {scene.height + BLOCK_Z[1]} /\n")
        if rest:
            text += "&fix group = 'block' field = 'u_z' hold = 'yes' stages = 'rest' /\n"
    return text + (f"&contact name = 'face' slave = 'ground_top' master = '{master}' penalty = 1e6 search_radius = 0.5 {acts} /\n"
                   f"&stage name = 'fall' analysis = 'dynamic' duration = {scene.duration} {step} /\n")


def run(host, scene, folder, step="", *words):
    """Seconds of processor time."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.nml").write_text(text_of(scene, folder, step), encoding="utf-8")
    began = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(host), str(folder / "scene.nml"), "--output", str(folder), *words], capture_output=True,
                          text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    (folder / "said.txt").write_text(done.stdout + done.stderr, encoding="utf-8")
    if done.returncode:
        raise RuntimeError(f"{scene.name}: exit code {done.returncode}. {done.stderr.strip()}")
    return ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime


def histories(scene, folder):
    """Time, way of the body, thrust and settlement downwards at the ends of all steps of the fall."""
    contact, points = tables.columns(folder / "contact.csv"), tables.columns(folder / "histories.csv")
    time = contact["time"]
    centre = np.interp(time, points["time"], points["centre.u_z"])
    body = contact["plate.u_z"] if scene.body == "plate" else np.interp(time, points["time"], points["block.u_z"])
    falls = contact["dt"] < 1.0   # not the stage before
    return time[falls], -body[falls], contact["face.thrust"][falls], -centre[falls]


def speed_at_end(time, way):
    """Of a body in free flight: the parabola of its centre of mass through its ways. Its vibration is no speed."""
    t = time - time[-1]
    return float(np.polyfit(t, way - 0.5*GRAVITY*t**2, 1, w=np.sqrt(np.gradient(time)))[0]) if len(t) > 2 else float("nan")


def answers(scene, folder):
    """Name and value: of the first landings speed and peak thrust, and the largest settlement."""
    time, way, thrust, settlement = histories(scene, folder)
    closed = np.flatnonzero(thrust > 0)
    first = time[closed[0]] - (1.0 if scene.soil == "MUD" else 0.0)
    # A landing is a contact after a flight; gaps of rattling are shorter.
    breaks = np.flatnonzero(np.diff(time[closed]) > FLIGHT*first)
    begins, ends = closed[np.r_[0, breaks + 1]], closed[np.r_[breaks, len(closed) - 1]]
    found = {}
    for i, (begin, end) in enumerate(zip(begins[:LANDINGS], ends[:LANDINGS])):
        flight = slice(ends[i - 1] if i else 0, begin + 1)
        found[f"speed {i + 1}"] = speed_at_end(time[flight], way[flight])
        found[f"thrust {i + 1}"] = float(np.max(thrust[begin:end + 1]))
    found["settlement"] = float(np.max(settlement))
    return found


def reference(host, scene, scratch):
    """Answers of the run with fine steps, and how far those with twice the step are from them."""
    found = []
    for times in (1, 2):
        folder = scratch / scene.name.replace(" ", "_") / f"fine_{times}"
        if not (folder / "done").exists():
            run(host, scene, folder, f"steps = 'given' dt = {times*scene.fine:.6g} rho_inf = 0.8 tolerance = 1e-6", "--quiet")
            (folder / "done").touch()
        found.append(answers(scene, folder))
    return found


def rows_of(host, scene, scratch, tolerances=TOLERANCES):
    fine, coarser = reference(host, scene, scratch)
    rows = []
    for tolerance in tolerances:
        folder = scratch / scene.name.replace(" ", "_") / tolerance
        seconds = run(host, scene, folder, "", "--step-tolerance", tolerance)
        said = (folder / "said.txt").read_text(encoding="utf-8")
        steps = len(histories(scene, folder)[0])
        repeated = re.search(r"(\d+) repetition", said)[1]
        found = answers(scene, folder)
        for answer, value in fine.items():
            # Of the largest of its kind, that of the first landing. A landing that only one of the runs has counts as missed.
            got, largest = found.get(answer, 0.0), fine[answer[:-1] + "1"] if answer[-1].isdigit() else value
            rows.append((scene.name, tolerance, steps, repeated, f"{seconds:.2f}", answer, f"{got:.6g}", f"{value:.6g}",
                         f"{abs(coarser.get(answer, 0.0) - value)/largest:.2g}", f"{abs(got - value)/largest:.2g}"))
    return rows


def picture_rows(scratch):
    """Way of the body and thrust of one scene over time, at the loosest tolerance and with fine steps."""
    scene = next(s for s in scenes() if s.name == PICTURE)
    rows = []
    for kind in ("fine_1", TOLERANCES[0]):
        time, way, thrust, settlement = histories(scene, scratch / scene.name.replace(" ", "_") / kind)
        for i in np.unique(np.linspace(0, len(time) - 1, 1200).astype(int)):
            rows.append((kind.split("_")[0], f"{time[i]:.6g}", f"{way[i]:.6g}", f"{thrust[i]:.5g}", f"{settlement[i]:.5g}"))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--results", default=made_in(__file__), type=pathlib.Path)
    parser.add_argument("names", nargs="*", help="scenes; default: all")
    args = parser.parse_args()
    build = args.build.resolve()
    table, scratch = args.results / "results.csv", current(build.parent / "landing", build)
    have = [tuple(row[n] for n in COLUMNS) for row in tables.rows(table)] if table.exists() else []
    order = [scene.name for scene in scenes()]
    for scene in scenes():
        if args.names and scene.name not in args.names or any(row[0] == scene.name for row in have):
            continue
        have += [tuple(map(str, row)) for row in rows_of(args.build / "host/mud_host", scene, scratch)]
        have.sort(key=lambda row: order.index(row[0]))
        tables.write(table, COLUMNS, have)
        print(scene.name, "done", flush=True)
    if len({row[0] for row in have}) == len(order):
        tables.write(args.results / "picture.csv", ("run", "time", "way", "thrust", "settlement"), picture_rows(scratch))


if __name__ == "__main__":
    main()
