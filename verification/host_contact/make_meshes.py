"""Writes blocks.msh: two unit squares one upon the other, 3 and 4 unequal cells wide, in Gmsh 4.1. The upper one begins 1e-6 m
deep in the lower one, so that the contact is closed from the first iteration."""
import pathlib

import numpy as np

OVERLAP = 1e-6
points, t6, cells, edges = [], [], {}, {}


def block(name, r, z):
    """A block of cells, each of two triangles; middles lie half-way."""
    number = {}

    def node(i, j):
        if (i, j) not in number:
            points.append((np.interp(i, range(0, 2 * len(r), 2), r), np.interp(j, range(0, 2 * len(z), 2), z)))
            number[i, j] = len(points)
        return number[i, j]

    cells[name] = []
    for j in range(0, 2 * len(z) - 2, 2):
        for i in range(0, 2 * len(r) - 2, 2):
            cells[name].append([node(i, j), node(i + 2, j), node(i + 2, j + 2), node(i + 1, j), node(i + 2, j + 1), node(i + 1, j + 1)])
            cells[name].append([node(i, j), node(i + 2, j + 2), node(i, j + 2), node(i + 1, j + 1), node(i + 1, j + 2), node(i, j + 1)])
    wide, high = 2 * len(r) - 2, 2 * len(z) - 2
    for side, j in (("bottom", 0), ("top", high)):
        edges[f"{name}_{side}"] = [[node(i, j), node(i + 2, j), node(i + 1, j)] for i in range(0, wide, 2)]
    edges.setdefault("axis", []).extend([node(0, j), node(0, j + 2), node(0, j + 1)] for j in range(0, high, 2))


block("lower", [0, 0.29, 0.61, 1], [0, 0.55, 1])
block("upper", [0, 0.21, 0.52, 0.74, 1], [1 - OVERLAP, 1.4, 2])
n, names = len(points), list(edges)
lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names) + 2)]
lines += [f'1 {i} "{name}"' for i, name in enumerate(names, 1)] + [f'2 {8 + i} "{name}"' for i, name in enumerate(cells)]
lines += ["$EndPhysicalNames", "$Entities", f"0 {len(names)} 2 0"]
lines += [f"{i} 0 0 0 1 2 0 1 {i} 0" for i in range(1, len(names) + 1)]
lines += [f"{i} 0 0 0 1 2 0 1 {8 + i} 0" for i in range(2)]
lines += ["$EndEntities", "$Nodes", f"1 {n} 1 {n}", f"2 1 0 {n}"] + [str(i + 1) for i in range(n)]
lines += [f"{r:.16g} {z:.16g} 0" for r, z in points] + ["$EndNodes", "$Elements"]
total = sum(map(len, cells.values())) + sum(map(len, edges.values()))
lines.append(f"{len(names) + 2} {total} 1 {total}")
tag = 0
for kind, lists, first in ((8, edges, 1), (9, cells, 0)):
    for i, members in enumerate(lists.values(), first):
        lines.append(f"{2 if kind == 9 else 1} {i} {kind} {len(members)}")
        for member in members:
            tag += 1
            lines.append(" ".join(map(str, (tag, *member))))
lines.append("$EndElements")
pathlib.Path(__file__).with_name("blocks.msh").write_text("\n".join(lines) + "\n", encoding="utf-8")
