"""Time of the host by phase, what each measure buys, and growth with the number of unknowns.

Writes results/host.csv (every run) and results/host.md (tables). Runs of one comparison take turns; medians count.
"""
import argparse
import atexit
import csv
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
PHASES = ("material", "assembly", "contact", "factorisation", "solution", "rest of Newton", "output", "all else", "in all")
# Cells of the mesh: along r to 0.15 m and beyond, along z; ratios so that the smallest cells shrink with the mesh.
MESHES = [(2, 5, 8), (4, 9, 16), (6, 13, 24), (8, 18, 32), (11, 26, 46), (16, 36, 64)]

options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
options.add_argument("--host", type=pathlib.Path, default=root / "build/release/host/mud_host")
options.add_argument("--results", type=pathlib.Path, default=root / "build/benchmark/results")
options.add_argument("--rounds", type=int, default=3, help="runs of every variant; their medians are printed (3)")
options.add_argument("--part", choices=("phases", "measures", "growth"), action="append", help="only this part")
options.add_argument("--steps", type=int, default=1333, help="steps of the pulse (1333)")
args = options.parse_args()
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
    process = subprocess.Popen([args.host, path, "--output", work / "out"], stdout=subprocess.PIPE,
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
        with open(work / "out/histories.csv", encoding="utf-8") as lines:
            *_, last = csv.DictReader(lines)
        row["settlement"] = -1e3 * float(last["centre.u_z"])
    rows.append(row)
    print(f"  {part}: {name}, {threads} thread(s): " +
          (f"{row['iterations']} iterations, {row['in all']:.1f} s" if row["completed"] else "failed"), flush=True)
    return row


def middle(found, key):
    return statistics.median(row[key] for row in found)


def table(head, lines):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head),
                      *("| " + " | ".join(line) + " |" for line in lines)]) + "\n"


text = []
if "phases" in parts:
    found = {}
    for _ in range(args.rounds):
        for threads in (1, 2):
            for factors in ("fresh", "reuse"):
                change = [("   gravity = 9.81", f"   gravity = 9.81\n   factors = '{factors}'")]
                found.setdefault((threads, factors), []).append(run("phases", f"factors {factors}", change, threads))
    lines = []
    for (threads, factors), group in found.items():
        lines.append([str(threads), factors, str(int(middle(group, "iterations"))),
                      *(f"{1e3 * middle(group, p) / middle(group, 'iterations'):.2f}" for p in PHASES),
                      f"{middle(group, 'in all'):.1f}"])
    first = next(iter(found.values()))[0]
    numeric = {t: 1e3 * middle(found[t, "fresh"], "factorisation") / middle(found[t, "fresh"], "factorisations")
               for t in (1, 2)}
    besides = {t: 1e3 * (middle(found[t, "reuse"], "in all") - middle(found[t, "reuse"], "factorisation")
                         - middle(found[t, "reuse"], "solution")) / middle(found[t, "reuse"], "iterations")
               for t in (1, 2)}
    text += [f"## Phases\n{first['nodes']} nodes, {first['unknowns']} unknowns, {args.steps} steps of 3e-5 s; milliseconds "
             "per iteration (a linear solve), the whole run in seconds.\n",
             table(["threads", "factors", "iterations", *PHASES, "whole run [s]"], lines),
             "One numeric factorisation: " + ", ".join(f"{v:.1f} ms with {t} thread(s)" for t, v in numeric.items())
             + "; everything outside the linear solver, per iteration: "
             + ", ".join(f"{v:.1f} ms with {t}" for t, v in besides.items()) + ".\n"]
if "measures" in parts:
    key = "   gravity = 9.81"
    variants = {
        "as it is": [],
        "factors fresh": [(key, key + "\n   factors = 'fresh'")],
        "ordering METIS": [(key, key + "\n   ordering = 'metis'")],
        "ordering best": [(key, key + "\n   ordering = 'best'")],
        "factors fresh, METIS": [(key, key + "\n   factors = 'fresh'\n   ordering = 'metis'")],
        "factors fresh, best": [(key, key + "\n   factors = 'fresh'\n   ordering = 'best'")],
        "linear pressures (Taylor-Hood)": [(key, key + "\n   pressures = 'linear'")],
        "linear pressures, factors fresh": [(key, key + "\n   pressures = 'linear'\n   factors = 'fresh'")],
        "quadrature 3": [(key, key + "\n   quadrature = 3")],
        "quadrature 7": [(key, key + "\n   quadrature = 7")],
        "tangent consistent": [("   name = 'sand'", "   name = 'sand'\n   tangent = 3")],
        "tangent elastic": [("   name = 'sand'", "   name = 'sand'\n   tangent = 1")],
    }
    found = {}
    for _ in range(args.rounds):
        for name, changes in variants.items():
            found.setdefault(name, []).append(run("measures", name, changes, 2, min(args.steps, 300)))
    usual = found["as it is"]
    lines = []
    for name, group in found.items():
        ratio = statistics.median(a["in all"] / b["in all"] for a, b in zip(group, usual))
        lines.append([name, str(int(middle(group, "iterations"))), str(int(middle(group, "factorisations"))),
                      str(int(middle(group, "solutions"))), str(int(middle(group, "entries"))),
                      *(f"{middle(group, p):.2f}" for p in ("material", "assembly", "factorisation", "solution", "in all")),
                      f"{ratio:.2f}", f"{100 * (group[0]['settlement'] / usual[0]['settlement'] - 1):+.3f}"])
    text += [f"## Measures\nThe same scene, {min(args.steps, 300)} steps, two threads; seconds; the last columns are the "
             "time over that of the first line, and how far the settlement under the centre is from its.\n",
             table(["variant", "iterations", "factorisations", "solutions", "entries in factors", "material", "assembly",
                    "factorisation", "solution", "in all", "ratio", "settlement [%]"], lines)]
if "growth" in parts:
    lines, sizes, fresh_times, memories = [], [], [], []
    for near, far, down in MESHES:
        mesh = [("r_cells = 4, 9", f"r_cells = {near}, {far}"), ("z_cells = 16", f"z_cells = {down}"),
                ("r_ratio = 1, 1.3", f"r_ratio = 1, {1.3 ** (9 / far):.6f}"),
                ("z_ratio = 0.85", f"z_ratio = {0.85 ** (16 / down):.6f}")]
        for ordering in ("amd", "metis"):
            key = "   gravity = 9.81"
            fresh, again = (run("growth", f"{ordering}, factors {factors}",
                                [*mesh, (key, f"{key}\n   factors = '{factors}'\n   ordering = '{ordering}'")], 2, 40)
                            for factors in ("fresh", "reuse"))
            numeric = 1e3 * fresh["factorisation"] / fresh["factorisations"]
            if ordering == "amd":
                sizes.append(fresh["unknowns"])
            lines.append([str(fresh["unknowns"]), ordering, f"{fresh['entries'] / 1e6:.2f}", f"{numeric:.0f}",
                          f"{1e3 * fresh['solution'] / fresh['solutions']:.1f}",
                          f"{1e3 * (fresh['material'] + fresh['assembly']) / fresh['iterations']:.0f}",
                          f"{fresh['memory']:.0f}", f"{1e3 * fresh['in all'] / fresh['iterations']:.0f}",
                          f"{1e3 * again['in all'] / again['iterations']:.0f}",
                          f"{again['factorisations']}"])
    text += ["## Growth\n40 steps, two threads; milliseconds; memory is the process's peak [MiB], factors reused in the "
             "last two columns only.\n",
             table(["unknowns", "ordering", "entries in factors [1e6]", "numeric factorisation", "solution by factors",
                    "material and assembly per iteration", "memory", "iteration, factors fresh",
                    "iteration, factors reused", "factorisations"], lines)]
    import math

    def exponents(column, ordering):
        own = [line for line in lines if line[1] == ordering]
        pairs = [(math.log(float(line[0])), math.log(float(line[column]))) for line in own if float(line[column]) > 0]
        return (pairs[-1][1] - pairs[-3][1]) / (pairs[-1][0] - pairs[-3][0])

    named = {"entries in factors": 2, "numeric factorisation": 3, "solution": 4, "material and assembly": 5, "memory": 6}
    text += ["Exponents over the last three sizes: " + "; ".join(
        f"{name} " + ", ".join(f"{exponents(column, o):.2f} ({o})" for o in ("amd", "metis"))
        for name, column in named.items()) + ".\n"]

model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")),
             platform.processor())
commit = subprocess.run(["git", "-C", root, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
origin = f"commit {commit or 'unknown'}; {model}, {os.cpu_count()} cores; {args.rounds} rounds"
args.results.mkdir(parents=True, exist_ok=True)
with open(args.results / "host.csv", "w", newline="", encoding="utf-8") as file:
    file.write(f"# {origin}\n")
    keys = list(dict.fromkeys(key for row in rows for key in row))
    writer = csv.DictWriter(file, keys, restval="")
    writer.writeheader()
    writer.writerows(rows)
(args.results / "host.md").write_text(f"# The host\n{origin}\n\n" + "\n".join(text), encoding="utf-8")
print("\n".join(text))
