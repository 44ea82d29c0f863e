# SPDX-License-Identifier: MIT
"""Writes slope.msh: a bank of 4 m with a slope of 1:1.5, from 12 m wide at its base, six-node triangles in Gmsh 4.1; and
curve.txt, the exponential retention curve of rain.nml."""
import numpy as np
from tools.results import folder

COLUMNS, ROWS, HEIGHT, BASE, RUN = 12, 8, 4.0, 12.0, 1.5
here = folder(__file__)


def node(i, j):
    """Number of the node i/2 columns and j/2 rows from the corner."""
    return i * (2 * ROWS + 1) + j


points = []
for i in range(2 * COLUMNS + 1):
    for j in range(2 * ROWS + 1):
        z = HEIGHT * j / (2 * ROWS)
        points.append(((BASE - RUN * z) * i / (2 * COLUMNS), z))
t6 = []
for i in range(0, 2 * COLUMNS, 2):
    for j in range(0, 2 * ROWS, 2):
        a, b, c, d = (i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)
        for corners in ((a, b, c), (a, c, d)):
            middles = [((p[0] + q[0]) // 2, (p[1] + q[1]) // 2) for p, q in zip(corners, corners[1:] + corners[:1])]
            t6.append([node(*p) for p in (*corners, *middles)])
m, n = 2 * COLUMNS, 2 * ROWS
edges = {"bottom": [(node(i, 0), node(i + 2, 0), node(i + 1, 0)) for i in range(0, m, 2)],
         "slope": [(node(m, j), node(m, j + 2), node(m, j + 1)) for j in range(0, n, 2)],
         "top": [(node(i + 2, n), node(i, n), node(i + 1, n)) for i in range(0, m, 2)],
         "left": [(node(0, j + 2), node(0, j), node(0, j + 1)) for j in range(0, n, 2)]}
lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", "5"]
lines += [f'1 {i} "{name}"' for i, name in enumerate(edges, 1)] + ['2 9 "soil"', "$EndPhysicalNames"]
lines += ["$Entities", "0 4 1 0"] + [f"{i} 0 0 0 1 1 0 1 {i} 0" for i in range(1, 5)] + ["1 0 0 0 1 1 0 1 9 0"]
count = len(points)
lines += ["$EndEntities", "$Nodes", f"1 {count} 1 {count}", f"2 1 0 {count}"] + [str(i + 1) for i in range(count)]
lines += [f"{x:.16g} {z:.16g} 0" for x, z in points] + ["$EndNodes", "$Elements"]
total = len(t6) + sum(map(len, edges.values()))
lines.append(f"5 {total} 1 {total}")
tag = 0
for dimension, kind, number, members in [(1, 8, i, e) for i, e in enumerate(edges.values(), 1)] + [(2, 9, 1, t6)]:
    lines.append(f"{dimension} {number} {kind} {len(members)}")
    for member in members:
        tag += 1
        lines.append(" ".join(str(v) for v in (tag, *(k + 1 for k in member))))
lines.append("$EndElements")
(here / "slope.msh").write_text("\n".join(lines) + "\n", encoding="utf-8")
(here / "curve.txt").write_text("".join(f"{p:.17g} {0.2 + 0.8 * np.exp(-0.2 * p):.17g}\n"
                                        for p in np.linspace(0, 30, 1501)), encoding="utf-8")
