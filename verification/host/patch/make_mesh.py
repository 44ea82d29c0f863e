# SPDX-License-Identifier: MIT
"""Writes patch.msh: an irregular mesh of 6-node triangles on the unit square, one element turned clockwise, in Gmsh
4.1."""
import matplotlib.tri
import numpy as np
from tools.results import folder

corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
sides = [(0.42, 0), (1, 0.57), (0.33, 1), (0, 0.64)]
inside = [(0.3, 0.34), (0.72, 0.41), (0.52, 0.71), (0.81, 0.78)]
x = np.array(corners + sides + inside, float)
triangles = matplotlib.tri.Triangulation(*x.T).triangles
points, middles, t6 = list(map(tuple, x)), {}, []


def middle(a, b):
    key = frozenset((a, b))
    if key not in middles:
        points.append(tuple((np.array(points[a]) + points[b]) / 2))
        middles[key] = len(points) - 1
    return middles[key]


for number, (a, b, c) in enumerate(triangles):
    if number == 3:
        b, c = c, b
    t6.append([a, b, c, middle(a, b), middle(b, c), middle(c, a)])
walls = {"bottom": (1, 0), "right": (0, 1), "top": (1, 1), "left": (0, 0)}   # coordinate, its value
edges = {name: [] for name in walls}
for pair, m in middles.items():
    a, b = pair
    for name, (axis, value) in zip(walls, ((1, 0), (0, 1), (1, 1), (0, 0))):
        if points[a][axis] == points[b][axis] == value:
            edges[name].append((a, b, m))
lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", "5"]
lines += [f'1 {i} "{name}"' for i, name in enumerate(edges, 1)] + ['2 9 "soil"', "$EndPhysicalNames"]
lines += ["$Entities", "0 4 1 0"] + [f"{i} 0 0 0 1 1 0 1 {i} 0" for i in range(1, 5)] + ["1 0 0 0 1 1 0 1 9 0"]
n = len(points)
lines += ["$EndEntities", "$Nodes", f"1 {n} 1 {n}", f"2 1 0 {n}"] + [str(i + 1) for i in range(n)]
lines += [f"{px:.16g} {py:.16g} 0" for px, py in points] + ["$EndNodes", "$Elements"]
total = len(t6) + sum(map(len, edges.values()))
lines.append(f"5 {total} 1 {total}")
tag = 0
for i, members in enumerate(edges.values(), 1):
    lines.append(f"1 {i} 8 {len(members)}")
    for member in members:
        tag += 1
        lines.append(" ".join(str(v) for v in (tag, *(m + 1 for m in member))))
lines.append(f"2 1 9 {len(t6)}")
for member in t6:
    tag += 1
    lines.append(" ".join(str(v) for v in (tag, *(int(m) + 1 for m in member))))
lines.append("$EndElements")
(folder(__file__) / "patch.msh").write_text("\n".join(lines) + "\n", encoding="utf-8")
