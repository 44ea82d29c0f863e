# SPDX-License-Identifier: MIT
"""Meshes of 6-node triangles in Gmsh 4.1."""
import pathlib

import numpy as np


def text(points, cells, edges, digits=12):
    """The file. cells: {region: [nodes of a triangle]}, edges: {boundary: [start, end, middle]}; nodes count from 0."""
    n, names = len(points), list(edges)
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names) + len(cells))]
    lines += [f'1 {i} "{name}"' for i, name in enumerate(names, 1)]
    lines += [f'2 {len(names) + i} "{name}"' for i, name in enumerate(cells, 1)]
    lines += ["$EndPhysicalNames", "$Entities", f"0 {len(names)} {len(cells)} 0"]
    lines += [f"{i} 0 0 0 1 2 0 1 {i} 0" for i in range(1, len(names) + 1)]
    lines += [f"{i} 0 0 0 1 2 0 1 {len(names) + i} 0" for i in range(1, len(cells) + 1)]
    lines += ["$EndEntities", "$Nodes", f"1 {n} 1 {n}", f"2 1 0 {n}"] + [str(i + 1) for i in range(n)]
    lines += [f"{r:.{digits}g} {z:.{digits}g} 0" for r, z in points] + ["$EndNodes", "$Elements"]
    total = sum(map(len, cells.values())) + sum(map(len, edges.values()))
    lines.append(f"{len(names) + len(cells)} {total} 1 {total}")
    tag = 0
    for dimension, kind, lists in ((1, 8, edges), (2, 9, cells)):
        for i, members in enumerate(lists.values(), 1):
            lines.append(f"{dimension} {i} {kind} {len(members)}")
            for member in members:
                tag += 1
                lines.append(" ".join(str(int(i)) for i in (tag, *(node + 1 for node in member))))
    return "\n".join([*lines, "$EndElements"]) + "\n"


class Mesh:
    """Bodies of cells, each of two triangles, and their boundaries NAME_bottom, NAME_top, NAME_side; all left sides are `axis`."""

    def __init__(self):
        self.points, self.cells, self.edges = [], {}, {}

    def block(self, name, r, z, shape=lambda r, z: (r, z)):
        """Adds a body; shape moves its nodes, those in the middle of sides too."""
        first = len(self.points)
        wide, high = 2 * len(r) - 2, 2 * len(z) - 2
        grid_r = np.interp(range(wide + 1), range(0, wide + 1, 2), r)
        grid_z = np.interp(range(high + 1), range(0, high + 1, 2), z)
        self.points += [shape(r, z) for z in grid_z for r in grid_r]

        def nodes(*places):
            return [first + (wide + 1) * j + i for i, j in places]

        self.cells[name] = []
        for j in range(0, high, 2):
            for i in range(0, wide, 2):
                self.cells[name].append(nodes((i, j), (i + 2, j), (i + 2, j + 2), (i + 1, j), (i + 2, j + 1), (i + 1, j + 1)))
                self.cells[name].append(nodes((i, j), (i + 2, j + 2), (i, j + 2), (i + 1, j + 1), (i + 1, j + 2), (i, j + 1)))
        for side, j in (("bottom", 0), ("top", high)):
            self.edges[f"{name}_{side}"] = [nodes((i, j), (i + 2, j), (i + 1, j)) for i in range(0, wide, 2)]
        for side, i in (("axis", 0), (f"{name}_side", wide)):
            self.edges.setdefault(side, []).extend(nodes((i, j), (i, j + 2), (i, j + 1)) for j in range(0, high, 2))

    def write(self, path):
        assert len(self.points) == len(set(sum(sum(self.cells.values(), []), [])))
        pathlib.Path(path).write_text(text(self.points, self.cells, self.edges), encoding="utf-8")
