#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the ledger of effects (mud_host --ablate) of six scenes, and each scene with another mesh, or other steps.

    ledgers.py [--build build/release] [--only NAME ...] [--results FOLDER]

Writes effects_NAME.csv and answers_NAME.csv as the program does, methods_NAME.csv and a line of runs.csv. Ten minutes of
one core.
"""
import argparse
import csv
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(ROOT / "verification"), str(HERE.parent / "indentation")]
import analysis  # noqa: E402
from tools import tables  # noqa: E402
from tools.results import MISSED, folder as made_in  # noqa: E402

RUNS = ("scene", "elements", "unknowns", "steps", "seconds", "commit")
METHODS = ("change", "answer", "range", "difference", "influence", "elements", "unknowns", "seconds")
STEP = 4.8e-4   # of the indentations, sixteen times that of the benchmark [s]
BETWEEN_NODES = r"z\d\d5\."   # Points of the site column that are no nodes of the coarse mesh.
NUMBER = r"[\d.]+"
LIST = r"\b{} *= *([\d., ]*\d)"
CHANGE_NOTHING = 1e-4   # A smaller range, as a share of the largest of its unit, is no answer; as the program has it.


def coarser(cells, ratio):
    """Half the cells between two breaks, of the same grading from end to end: as the pilots coarsen."""
    fewer = [(n + 1) // 2 for n in cells]
    return fewer, [r ** (n / f) for r, n, f in zip(ratio, cells, fewer)]


def with_mesh(groups, change):
    mesh = next(keys for name, keys in groups if name == "mesh")
    for axis in "rz":
        cells = [int(n) for n in re.findall(NUMBER, mesh[f"{axis}_cells"])]
        ratio = [float(x) for x in re.findall(NUMBER, mesh.get(f"{axis}_ratio", "1 " * len(cells)))]
        cells, ratio = change(cells, ratio)
        mesh[f"{axis}_cells"] = ", ".join(str(n) for n in cells)
        mesh[f"{axis}_ratio"] = ", ".join(f"{x:.8g}" for x in ratio)
    return groups


def indentation(suction):
    """The paper's benchmark with the remedy: half the cells along each side, and longer steps with rho_inf 0, as the program
    chooses it where contacts act; and what the mesh and the steps of the benchmark change."""
    def groups(steps):
        made = analysis.scene(suction, "u-p_w-p_c", "remedy")
        analysis.change(made, "scene", checkpoint_steps=None)
        if steps:
            analysis.change(made, "stage:impact", dt=steps, rho_inf=None)
        return made
    return (analysis.render(with_mesh(groups(STEP), coarser)),
            {"mesh of the benchmark": analysis.render(groups(STEP)),
             "steps of the benchmark": analysis.render(with_mesh(groups(None), coarser))})


def listed(text, key):
    """Values of a list of a scene; none where the key is not given."""
    found = re.search(LIST.format(key), text)
    return re.findall(NUMBER, found[1]) if found else []


def of_page(path, *edits, steps=()):
    """The scene of another page on half the cells and with longer steps where `steps` says so; and on its own mesh."""
    def text():
        scene = (ROOT / path).read_text(encoding="utf-8")
        for old, new in (*edits, *steps):
            if old not in scene:
                raise ValueError(f"{path} has no '{old}'")
            scene = scene.replace(old, new)
        return re.sub(r"file ?= ?'(?!/)", f"file = '{(ROOT / path).parent}/", scene)

    def coarse(scene):
        for axis in "rz":
            cells = [int(n) for n in listed(scene, f"{axis}_cells")]
            ratio = [float(x) for x in listed(scene, f"{axis}_ratio")]
            ratio = ratio or len(cells) * [1.0]
            cells, ratio = coarser(cells, ratio)
            scene = re.sub(LIST.format(f"{axis}_cells"), f"{axis}_cells = {','.join(str(n) for n in cells)}", scene)
            scene = re.sub(LIST.format(f"{axis}_ratio"), f"{axis}_ratio = {','.join(f'{x:.8g}' for x in ratio)}", scene)
        return scene
    return coarse(text()), {"mesh of the page": text()}


def scenes():
    return {
        "indentation_0": indentation(0),
        "indentation_30": indentation(30),
        "indentation_1000": indentation(1000),
        "terzaghi": of_page("verification/host/terzaghi/scene.nml"),
        # Loaded instead of pushed, so that its settlement is an answer, and in time, so that inertia has a meaning.
        "footing": of_page("verification/host/footing/scene.nml",
                           ("analysis='static' duration=1.0", "analysis='quasi_static' duration=1.0"),
                           ("&fix group='top_1' field='u_z' value=-0.1 history='ramp' /",
                            "&load group='top_1' kind='pressure' value=25 history='ramp' /"),
                           ("&point name='edge' r=0.5 z=0 /", "&point name='centre' r=0 z=0 /\n&point name='edge' r=0.5 z=0 /\n"
                            "&point name='below' r=0 z=-0.6 /")),
        "site": of_page("verification/host/site/scene.nml", steps=(("dt = 0.01", "dt = 0.02"),)),
    }


def farthest(one, other, columns):
    """Of every answer its range and the largest distance of the other run's history, with its sign."""
    rows = []
    largest = {}
    for name in columns:
        unit = name.rsplit(".", 1)[1][0]
        largest[unit] = max(largest.get(unit, 0.0), np.ptp(one[name]))
    for name in columns:
        spread = np.ptp(one[name])
        if spread <= CHANGE_NOTHING * largest[name.rsplit(".", 1)[1][0]]:
            continue
        apart = np.interp(one["time"], other["time"], other[name]) - one[name]
        change = apart[np.argmax(np.abs(apart))]
        rows.append((name, f"{spread:.6g}", f"{change:.6g}", f"{abs(change) / spread:.6g}"))
    return rows


def run(host, path, *more):
    """What it prints, and the processor time [s]."""
    began = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([str(host), str(path), *more], capture_output=True, text=True)
    if done.returncode not in (0, MISSED):
        raise RuntimeError(f"{path.name}: {done.stderr.strip()}")
    return done.stdout, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - began


def write(path, columns, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(rows)


def ledger(host, name, base, methods, results, commit):
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "base.nml").write_text(base, encoding="utf-8")
        said, _ = run(host, folder / "base.nml", "--ablate", "--output", str(folder / "ablate"))
        print(said, flush=True)
        for kind, file in (("effects", "effects.csv"), ("answers", "effects_answers.csv")):
            (results / f"{kind}_{name}.csv").write_bytes((folder / "ablate" / file).read_bytes())
        _, own_seconds = run(host, folder / "base.nml", "--quiet", "--output", str(folder / "one"))
        one = tables.columns(folder / "one/histories.csv")
        answers = [c for c in one if c.endswith((".u_r", ".u_z", ".p_w", ".p_c")) and not re.match(BETWEEN_NODES, c)]
        rows = []
        for change, text in methods.items():
            (folder / "other.nml").write_text(text, encoding="utf-8")
            told, seconds = run(host, folder / "other.nml", "--output", str(folder / "other"))
            size = re.search(r": (\d+) elements, \d+ nodes, (\d+) unknowns", told)
            rows += [(change, *row, *size.groups(), f"{seconds:.4g}")
                     for row in farthest(one, tables.columns(folder / "other/histories.csv"), answers)]
    write(results / f"methods_{name}.csv", METHODS, rows)
    own = re.search(r"Pilots: (\d+) elements, (\d+) unknowns, (\d+) steps", said)
    path = results / "runs.csv"
    kept = {row["scene"]: tuple(row[c] for c in RUNS) for row in tables.rows(path)} if path.exists() else {}
    kept[name] = (name, *own.groups(), f"{own_seconds:.4g}", commit)
    write(path, RUNS, [kept[key] for key in scenes() if key in kept])


def main():
    made = scenes()
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--only", nargs="+", choices=list(made), default=list(made))
    parser.add_argument("--results", default=made_in(__file__) / "results", type=pathlib.Path)
    parser.add_argument("--commit", default=analysis.program()[1], help="of the program, if it is not that of the tree")
    args = parser.parse_args()
    args.results.mkdir(exist_ok=True, parents=True)
    for name in args.only:
        ledger(args.build / "host/mud_host", name, *made[name], args.results, args.commit)


if __name__ == "__main__":
    main()
