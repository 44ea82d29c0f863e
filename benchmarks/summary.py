# SPDX-License-Identifier: MIT
"""The tables of benchmarks/README.md from speed.csv and instructions.csv of a folder."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "verification"))
from tools import tables  # noqa: E402

folder = pathlib.Path(sys.argv[1])


def rows(name):
    file = folder / name
    return tables.rows(file) if file.exists() else []


speed = rows("speed.csv")
counted = {(r["path"], float(r["strain"]), int(r["tangent"])): r["instructions_per_update"] for r in rows("instructions.csv")}
TANGENTS = ["none", "elastic", "continuum", "consistent"]
for line in (folder / "speed.csv").read_text(encoding="utf-8").splitlines():
    if line[:1] == "#":
        print(re.sub(r"^# commit [^;]*;", "#", line)[1:].strip() + "  ")

print("\n| one rate evaluation | ns |\n|---|---|")
for r in speed:
    if r["call"] == "rate":
        print(f"| {r['path']} | {r['ns']} |")

print("\n| update with the defaults | strain | tangent | rates | ns | ratio | instructions |\n|---|---|---|---|---|---|---|")
for r in speed:
    if (r["call"], r["scheme"], r["tolerance"]) == ("update", "auto", "1.0E-05") and r["tangent"] != "elastic":
        print(f"| {r['path']} | {float(r['strain']):.0e} | {r['tangent']} | {r['rates_per_update']} | {r['ns']} | "
              f"{r['ratio']} | {counted.get((r['path'], float(r['strain']), TANGENTS.index(r['tangent'])), '')} |")

print("\n| strain, path | scheme | tolerance 1e-3: rates, ns | 1e-5 | 1e-7 | largest ratio continuum | consistent |\n"
      "|---|---|---|---|---|---|---|")
groups = {}
for r in speed:
    if r["call"] == "update":
        groups.setdefault((r["strain"], r["path"], r["scheme"]), []).append(r)
for (strain, path, scheme), mine in groups.items():
    none = [r for r in mine if r["tangent"] == "none"]
    largest = [max(float(r["ratio"]) for r in mine if r["tangent"] == kind) for kind in TANGENTS[2:]]
    print(f"| {float(strain):.0e} {path} | {scheme} | "
          + " | ".join(f"{float(r['rates_per_update']):.1f}, {r['ns']}" for r in none)
          + f" | {largest[0]:.2f} | {largest[1]:.2f} |")

print("\n| batch of 400 points, 1e-5 strain | tangent | 1 thread: ns per point | 2 threads | ratio |\n|---|---|---|---|---|")
batch = [r for r in speed if r["call"] == "batch"]
for one, two in zip(batch[::2], batch[1::2]):
    print(f"| {one['path']} | {one['tangent']} | {one['ns']} | {two['ns']} | {two['ratio']} |")
