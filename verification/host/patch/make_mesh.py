# SPDX-License-Identifier: MIT
"""Writes patch.msh: an irregular mesh of 6-node triangles on the unit square, one element turned clockwise, in Gmsh
4.1."""
import matplotlib.tri
import numpy as np
from tools import gmsh
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
(folder(__file__) / "patch.msh").write_text(gmsh.text(points, {"soil": t6}, edges), encoding="utf-8")
