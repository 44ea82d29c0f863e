# SPDX-License-Identifier: MIT
"""Time of the host by phase, what each measure buys, and growth with the number of unknowns.

Writes results/host.csv (every run) and results/host.md (tables). Runs of one comparison take turns; medians count.
"""
import argparse
import atexit
import math
import os
import pathlib
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).resolve().parent
root = here.parent
sys.path.insert(0, str(root / "verification"))
from tools import tables  # noqa: E402

PHASES = ("material", "assembly", "contact", "factorisation", "solution", "rest of Newton", "output", "all else",
          "in all")
# Cells of the mesh: along r to 0.15 m and beyond, along z; ratios so that the smallest cells shrink with the mesh.
MESHES = [(2, 5, 8), (4, 9, 16), (6, 13, 24), (8, 18, 32), (11, 26, 46), (16, 36, 64)]

options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
options.add_argument("--host", type=pathlib.Path, default=root / "build/release/host/mud_host")
options.add_argument("--results", type=pathlib.Path, default=root / "build/benchmark/results")
options.add_argument("--rounds", type=int, default=3, help="runs of every variant; their medians are printed (3)")
options.add_argument("--part", choices=("phases", "measures", "growth"), action="append", help="only this part")
options.add_argument("--steps", type=int, default=1333, help="steps of the pulse (1333)")
args = options.parse_args()
if args.part and args.results.resolve() == here / "results":
    options.error("the committed results hold all parts: leave --part out, or name another --results")
parts = args.part or ["phases", "measures", "growth"]
work = pathlib.Path(tempfile.mkdtemp())
atexit.register(shutil.rmtree, work, ignore_errors=True)
scene = (here / "host.nml").read_text(encoding="utf-8").replace("'../", f"'{root}/")
rows = []


def replaced(text, changes):
    for old, new in changes:
        if old not in text:
            sys.exit(f"host.nml has no text {old!r}")
        text = text.replace(old, new)
    return text


def run(part, name, changes=(), threads=1, steps=None):
    """One run; its figures as a dictionary, which is also a row of the results."""
    steps = steps or args.steps
    path = work / "scene.nml"
    text = replaced(scene, [("duration = 0.03999", f"duration = {steps * 3.0e-5:.6e}"), *changes])
    path.write_text(text, encoding="utf-8")
    process = subprocess.Popen([args.host, path, "--output", work / "out", "--verbose"], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, env={**os.environ, "OMP_NUM_THREADS": str(threads)})
    said = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    row = {"part": part, "variant": name, "threads": threads, "steps": steps, "completed": status == 0}
    if status != 0:
        print(said, file=sys.stderr)
    else:
        counts = re.search(r"(\d+) nodes, (\d+) unknowns", said)
        row.update(nodes=int(counts[1]), unknowns=int(counts[2]))
        counts = re.search(r"(\d+) steps, (\d+) iterations, (\d+) cuts, .*? (\d+) factorisations \((\d+) entries\), "
                           r"(\d+) solutions", said)
        row.update(zip(("iterations", "cuts", "factorisations", "entries", "solutions"), map(int, counts.groups()[1:])))
        for phase in PHASES:
            row[phase] = float(re.search(rf"^ *{phase} +([\d.]+) s", said, re.M)[1])
        row["memory"] = usage.ru_maxrss / 1024
        row["settlement"] = -1e3 * tables.columns(work / "out/histories.csv")["centre.u_z"][-1]
    rows.append(row)
    print(f"  {part}: {name}, {threads} thread(s): " +
          (f"{row['iterations']} iterations, {row['in all']:.1f} s" if row["completed"] else "failed"), flush=True)
    return row


def middle(found, key):
    """Median over the runs that came to their end; nan if none did."""
    values = [row[key] for row in found if row["completed"]]
    return statistics.median(values) if values else math.nan


def each(found, key, per):
    """Median of one figure over that of another [ms]."""
    count = middle(found, per)
    return 1e3 * middle(found, key) / count if count else math.nan


def paired(found, others):
    """Median ratio of the times of runs that took turns."""
    ratios = [a["in all"] / b["in all"] for a, b in zip(found, others) if a["completed"] and b["completed"]]
    return statistics.median(ratios) if ratios else math.nan


def table(head, lines):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head),
                      *("| " + " | ".join(line) + " |" for line in lines)]) + "\n"


VARIANTS = {
    "as it is": [],
    "factors fresh": ["factors = 'fresh'"],
    "linear pressures (Taylor-Hood)": ["pressures = 'linear'"],
    "linear pressures, factors fresh": ["pressures = 'linear'", "factors = 'fresh'"],
    "quadrature 3": ["quadrature = 3"],
    "quadrature 7": ["quadrature = 7"],
}
TANGENTS = {"tangent consistent": 3, "tangent elastic": 1}


def of_scene(*keys):
    """Change of the scene: keys of its first group."""
    return ("   gravity = 9.81", "\n   ".join(["   gravity = 9.81", *keys]))


# All runs come first and are on the disk before the tables are made of them.
phases, measures, growth = {}, {}, {}
if "phases" in parts:
    for _ in range(args.rounds):
        for threads in (1, 2):
            for factors in ("fresh", "reuse"):
                row = run("phases", f"factors {factors}", [of_scene(f"factors = '{factors}'")], threads)
                phases.setdefault((threads, factors), []).append(row)
if "measures" in parts:
    variants = {name: [of_scene(*keys)] for name, keys in VARIANTS.items()}
    variants |= {name: [("   tangent = 2", f"   tangent = {k}")] for name, k in TANGENTS.items()}
    for _ in range(args.rounds):
        for name, changes in variants.items():
            measures.setdefault(name, []).append(run("measures", name, changes, 2, min(args.steps, 300)))
if "growth" in parts:
    for near, far, down in MESHES:
        mesh = [("r_cells = 4, 9", f"r_cells = {near}, {far}"), ("z_cells = 16", f"z_cells = {down}"),
                ("r_ratio = 1, 1.3", f"r_ratio = 1, {1.3 ** (9 / far):.6f}"),
                ("z_ratio = 0.85", f"z_ratio = {0.85 ** (16 / down):.6f}")]
        for factors in ("fresh", "reuse"):
            row = run("growth", f"factors {factors}", [*mesh, of_scene(f"factors = '{factors}'")], 2, 40)
            growth.setdefault(near, []).append(row)

model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8")
              if line.startswith("model name")), platform.processor())
commit = subprocess.run(["git", "-C", root, "rev-parse", "--short", "HEAD"], capture_output=True,
                        text=True).stdout.strip()
origin = f"commit {commit or 'unknown'}; {model}, {os.cpu_count()} cores; {args.rounds} rounds"
args.results.mkdir(parents=True, exist_ok=True)
keys = list(dict.fromkeys(key for row in rows for key in row))
tables.write(args.results / "host.csv", keys, ([row.get(key, "") for key in keys] for row in rows), [origin])

text = []
if phases:
    lines = [[str(threads), factors, f"{middle(group, 'iterations'):.0f}",
              *(f"{each(group, p, 'iterations'):.2f}" for p in PHASES), f"{middle(group, 'in all'):.1f}"]
             for (threads, factors), group in phases.items()]
    numeric = {t: each(phases[t, "fresh"], "factorisation", "factorisations") for t in (1, 2)}
    besides = {}
    for t in (1, 2):
        total, *solver = (each(phases[t, "reuse"], p, "iterations") for p in ("in all", "factorisation", "solution"))
        besides[t] = total - sum(solver)
    every = [row for group in phases.values() for row in group]
    text += [f"## Phases\n{middle(every, 'nodes'):.0f} nodes, {middle(every, 'unknowns'):.0f} unknowns, {args.steps} "
             "steps of 3e-5 s; milliseconds per iteration (a linear solve), the whole run in seconds.\n",
             table(["threads", "factors", "iterations", *PHASES, "whole run [s]"], lines),
             "One numeric factorisation: " + ", ".join(f"{v:.1f} ms with {t} thread(s)" for t, v in numeric.items())
             + "; everything outside the linear solver, per iteration: "
             + ", ".join(f"{v:.1f} ms with {t}" for t, v in besides.items()) + ".\n"]
if measures:
    usual = measures["as it is"]
    lines = [[name, *(f"{middle(group, p):.0f}" for p in ("iterations", "factorisations", "solutions", "entries")),
              *(f"{middle(group, p):.2f}" for p in ("material", "assembly", "factorisation", "solution", "in all")),
              f"{paired(group, usual):.2f}",
              f"{100 * (middle(group, 'settlement') / middle(usual, 'settlement') - 1):+.3f}"]
             for name, group in measures.items()]
    text += [f"## Measures\nThe same scene, {min(args.steps, 300)} steps, two threads; seconds; the last columns are "
             "the time over that of the first line, and how far the settlement under the centre is from its.\n",
             table(["variant", "iterations", "factorisations", "solutions", "entries in factors", "material",
                    "assembly", "factorisation", "solution", "in all", "ratio", "settlement [%]"], lines)]
if growth:
    # Figures of every size by name of the column.
    columns = {size: {
        "unknowns": middle([fresh], "unknowns"), "entries in factors [1e6]": middle([fresh], "entries") / 1e6,
        "numeric factorisation": each([fresh], "factorisation", "factorisations"),
        "solution by factors": each([fresh], "solution", "solutions"),
        "material and assembly per iteration": each([fresh], "material", "iterations")
        + each([fresh], "assembly", "iterations"),
        "memory": middle([fresh], "memory"), "iteration, factors fresh": each([fresh], "in all", "iterations"),
        "iteration, factors reused": each([again], "in all", "iterations"),
        "factorisations": middle([again], "factorisations")} for size, (fresh, again) in growth.items()}
    digits = {"entries in factors [1e6]": 2, "solution by factors": 1}
    lines = [[f"{row['unknowns']:.0f}", *(f"{v:.{digits.get(k, 0)}f}" for k, v in list(row.items())[1:])]
             for row in columns.values()]
    names = list(next(iter(columns.values())))
    text += ["## Growth\n40 steps, two threads; milliseconds; memory is the process's peak [MiB], factors reused in "
             "the last two columns only.\n", table(names, lines)]

    def exponent(column):
        """Over the last three sizes that came to their end."""
        pairs = [(math.log(row["unknowns"]), math.log(row[column])) for row in columns.values() if row[column] > 0]
        return (pairs[-1][1] - pairs[-3][1]) / (pairs[-1][0] - pairs[-3][0]) if len(pairs) > 2 else math.nan

    named = {"entries in factors": names[1], "numeric factorisation": names[2], "solution": names[3],
             "material and assembly": names[4], "memory": names[5]}
    text += ["Exponents over the last three sizes: " + "; ".join(
        f"{name} {exponent(column):.2f}" for name, column in named.items()) + ".\n"]
(args.results / "host.md").write_text(tables.wrapped("# The host\n" + origin.partition("; ")[2] + "\n\n" + "\n".join(text)),
                                     encoding="utf-8")
print("\n".join(text))
if not all(row["completed"] for row in rows):
    sys.exit("Some runs failed: their rows of host.csv have completed = False.")
