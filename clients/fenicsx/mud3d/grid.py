# SPDX-License-Identifier: MIT
"""Meshes of a scene, made on the first rank: a box, the plane of mud_host made thick or swept about its axis, or a file
of Gmsh. Groups are sets of cells and of facets, the latter by their vertices."""
import pathlib

import numpy as np

from .calls import facets
from .scene import SceneError


class Plan:
    """What the first rank has before the mesh is distributed."""

    def __init__(self, cell, points, cells, cell_groups, facet_groups):
        self.cell, self.points, self.cells = cell, points, cells
        self.cell_groups = cell_groups    #: name: (cells,) of bool
        self.facet_groups = facet_groups  #: name: (facets, vertices)

    @property
    def dimension(self):
        return self.points.shape[1]


def _line(breaks, cells, ratios, name):
    """Ends of the cells between the breaks, and the number of the piece of every cell, from 1."""
    if len(breaks) < 2 or len(cells) != len(breaks) - 1 or (ratios and len(ratios) != len(cells)):
        raise SceneError(f"&mesh {name}: two breaks or more, and a number of cells for every piece between them")
    x, piece = [breaks[0]], []
    for i, n in enumerate(map(int, cells)):
        sizes = (ratios[i] if ratios else 1.0)**np.arange(n)
        x += list(breaks[i] + (breaks[i + 1] - breaks[i])*np.cumsum(sizes)/sizes.sum())
        x[-1] = breaks[i + 1]
        piece += [i + 1]*n
    return np.array(x), np.array(piece)


def _plane(given):
    """Quadrilaterals in r, z of the built-in mesh: points; cells (bottom left, bottom right, top left, top right),
    their pieces along r and z, and which have an even sum of column and row."""
    r, r_piece = _line(given.r, given.r_cells, given.r_ratio, "r")
    z, z_piece = _line(given.z, given.z_cells, given.z_ratio, "z")
    points = np.stack(np.meshgrid(r, z, indexing="ij"), -1).reshape(-1, 2)
    i, j = np.meshgrid(np.arange(len(r) - 1), np.arange(len(z) - 1), indexing="ij")
    first = (i*len(z) + j).ravel()
    cells = np.stack([first, first + len(z), first + 1, first + len(z) + 1], 1)
    return points, cells, np.stack([r_piece[i.ravel()], z_piece[j.ravel()]], 1), (i + j).ravel() % 2 == 0


def _halved(cells, even):
    """Two triangles of every quadrilateral; the diagonals alternate as in mud_host, `even` rise to the right."""
    rising, falling = cells[:, [0, 1, 3, 0, 3, 2]], cells[:, [0, 1, 2, 1, 3, 2]]
    return np.where(even[:, None], rising, falling).reshape(-1, 3)


def _raised(points, cells, layers, place):
    """Prisms (or hexahedra) over every triangle (quadrilateral) as (bottom vertices, top vertices) of every layer;
    place(k) gives the points of level k. Points that lie at the same place are one (on an axis)."""
    levels = np.stack([place(k) for k in range(layers + 1)])  # (levels, n, 3)
    n = len(points)
    number = np.arange((layers + 1)*n).reshape(layers + 1, n)
    still = np.all(np.isclose(levels, levels[0], rtol=0, atol=1e-12*np.abs(points).max()), axis=(0, 2))
    number[:, still] = number[0, still]
    used, compact = np.unique(number, return_inverse=True)
    number = compact.reshape(number.shape)
    stacks = np.concatenate([np.stack([number[k][cells], number[k + 1][cells]], 1) for k in range(layers)])
    return levels.reshape(-1, 3)[used], stacks


def _tetrahedra(triangles, prisms):
    """Three of every prism, by the order of the vertices of its triangle, so that neighbours fit; fewer at an axis.
    Also the prism of every one."""
    order = np.argsort(np.tile(triangles, (len(prisms)//len(triangles), 1)), axis=1)
    low, high = (np.take_along_axis(prisms[:, k], order, 1) for k in (0, 1))
    parts = np.stack([np.stack([low[:, 0], low[:, 1], low[:, 2], high[:, 2]], 1),
                      np.stack([low[:, 0], low[:, 1], high[:, 1], high[:, 2]], 1),
                      np.stack([low[:, 0], high[:, 0], high[:, 1], high[:, 2]], 1)], 1).reshape(-1, 4)
    parents = np.repeat(np.arange(len(prisms)), 3)
    ordered = np.sort(parts, 1)
    whole = np.all(ordered[:, 1:] != ordered[:, :-1], axis=1)
    return parts[whole], parents[whole]


def boundary(cell, cells):
    """Vertices of the facets that one cell alone has."""
    every = np.sort(np.concatenate([cells[:, facet] for facet in facets(cell)[0]]), 1)
    rows, counts = np.unique(every, axis=0, return_counts=True)
    return rows[counts == 1]


def _built_in(scene, thickness, layers, sector, cells):
    given, geometry = scene.mesh, scene.scene.geometry
    plane, squares, pieces, even = _plane(given)
    cells = cells or given.cells
    y = None
    if geometry == "box":
        y = _line(given.y, given.y_cells, given.y_ratio, "y")[0]
    elif geometry == "axisymmetric":
        if plane[:, 0].min() < 0:
            raise SceneError("&mesh r: below the axis")
        cells = cells or "tetrahedra"
    elif thickness:
        y = np.linspace(0.0, thickness, layers + 1)
    solid = y is not None or geometry == "axisymmetric"
    allowed = ("tetrahedra", "hexahedra") if solid else ("triangles", "quadrilaterals")
    cells = cells or allowed[1]
    if cells not in allowed or (geometry == "axisymmetric" and cells == "hexahedra"):
        raise SceneError(f"cells = '{cells}': not in this geometry; the others are {', '.join(allowed)}"
                         " (about an axis tetrahedra alone)")
    simplices = cells in ("triangles", "tetrahedra")
    flat = _halved(squares, even) if simplices else squares
    parents = np.repeat(np.arange(len(squares)), 2) if simplices else np.arange(len(squares))
    if not solid:
        points, found = plane, flat
    else:
        def place(k):
            if y is not None:
                return np.stack([plane[:, 0], np.full(len(plane), y[k]), plane[:, 1]], 1)
            angle = np.radians(sector)*k/layers
            return np.stack([plane[:, 0]*np.cos(angle), plane[:, 0]*np.sin(angle), plane[:, 1]], 1)

        count = len(y) - 1 if y is not None else layers
        points, stacks = _raised(plane, flat, count, place)
        parents = np.tile(parents, count)
        if simplices:
            found, own = _tetrahedra(flat, stacks)
            parents = parents[own]
        else:  # basix: x fastest, then y, then z
            found = stacks[:, [0, 0, 1, 1, 0, 0, 1, 1], [0, 1, 0, 1, 2, 3, 2, 3]]
    cell = cells.replace("tetrahedra", "tetrahedron").replace("hexahedra", "hexahedron").rstrip("s")
    pieces = pieces[parents]
    cell_groups = {f"block_{i}_{j}": (pieces[:, 0] == i) & (pieces[:, 1] == j)
                   for i in range(1, len(given.r)) for j in range(1, len(given.z))}
    skin = boundary(cell, found)
    up = points.shape[1] - 1
    radius = np.hypot(points[:, 0], points[:, 1]) if geometry == "axisymmetric" else points[:, 0]
    tolerance = 1e-9*np.abs(points).max()

    def on(values, target):
        return np.all(np.abs(values[skin] - target) <= tolerance, axis=1)

    sides = {"left": on(radius, given.r[0]), "right": on(radius, given.r[-1]),
             "bottom": on(points[:, up], given.z[0]), "top": on(points[:, up], given.z[-1])}
    if geometry == "axisymmetric":
        tangent = np.tan(np.radians(sector))
        sides["front"], sides["back"] = on(points[:, 1], 0.0), on(points[:, 1] - tangent*points[:, 0], 0.0)
    elif solid:
        sides["front"], sides["back"] = on(points[:, 1], y[0]), on(points[:, 1], y[-1])
    groups = {name: skin[where] for name, where in sides.items()}
    for name, values, breaks in (("bottom", radius, given.r), ("top", radius, given.r),
                                 ("left", points[:, up], given.z), ("right", points[:, up], given.z)):
        for i, (low, high) in enumerate(zip(breaks, breaks[1:]), 1):
            inside = (values[groups[name]] >= low - tolerance) & (values[groups[name]] <= high + tolerance)
            groups[f"{name}_{i}"] = groups[name][inside.all(axis=1)]
    if geometry == "box":  # parts of the top by r and y, as top_1_2
        strips = [name for name in groups if name.startswith("top_")]
        for name, depth in ((name, i) for name in strips for i in range(1, len(given.y))):
            across = points[:, 1][groups[name]]
            inside = (across >= given.y[depth - 1] - tolerance) & (across <= given.y[depth] + tolerance)
            groups[f"{name}_{depth}"] = groups[name][inside.all(axis=1)]
    if geometry == "axisymmetric" and given.r[0] == 0.0:
        groups["left"] = np.zeros((0, skin.shape[1]), int)  # an axis is no facet: its nodes are held by front and back
    return Plan(cell, points, found, cell_groups, groups)


GMSH = {2: ("triangle", 3), 3: ("quadrilateral", 4), 4: ("tetrahedron", 4), 5: ("hexahedron", 8), 9: ("triangle", 3),
        11: ("tetrahedron", 4), 1: ("line", 2), 8: ("line", 2)}
ORDER = {"quadrilateral": [0, 1, 3, 2], "hexahedron": [0, 1, 3, 2, 4, 5, 7, 6]}  # of Gmsh, as basix counts


def _sections(text):
    found, lines, i = {}, text.splitlines(), 0
    while i < len(lines):
        if lines[i].startswith("$") and not lines[i].startswith("$End"):
            end = lines.index("$End" + lines[i].strip()[1:], i)
            found[lines[i].strip()[1:]] = lines[i + 1:end]
            i = end
        i += 1
    return found


def read_gmsh(path, scale):
    """Text files of Gmsh 4.1; of cells of second order the corners are taken, their sides must be straight."""
    parts = _sections(pathlib.Path(path).read_text())
    if not parts.get("MeshFormat", [""])[0].startswith("4.1 0"):
        raise SceneError(f"{path}: a text mesh of Gmsh 4.1 is needed (-format msh41)")
    names = {}
    for line in parts.get("PhysicalNames", ["0"])[1:]:
        dimension, tag, name = line.split(maxsplit=2)
        names[int(dimension), int(tag)] = name.strip().strip('"')
    entities, lines = {}, parts["Entities"]
    counts, at = [int(x) for x in lines[0].split()], 1
    for dimension, count in enumerate(counts):
        for line in lines[at:at + count]:
            words = line.split()
            first = 4 if dimension == 0 else 7
            tags = [int(x) for x in words[first + 1:first + 1 + int(words[first])]]
            kind = ("point", "curve", "surface", "volume")[dimension]
            entities[dimension, int(words[0])] = [names.get((dimension, abs(t)), f"{kind}_{abs(t)}") for t in tags]
        at += count
    places, at, lines = {}, 1, parts["Nodes"]
    for _ in range(int(lines[0].split()[0])):
        count = int(lines[at].split()[3])
        for tag, place in zip(lines[at + 1:at + 1 + count], lines[at + 1 + count:at + 1 + 2*count]):
            places[int(tag)] = [float(x) for x in place.split()[:3]]
        at += 1 + 2*count
    blocks, at, lines = [], 1, parts["Elements"]
    for _ in range(int(lines[0].split()[0])):
        dimension, entity, kind, count = map(int, lines[at].split())
        rows = np.array([[int(x) for x in line.split()[1:]] for line in lines[at + 1:at + 1 + count]])
        if dimension > 0:
            if kind not in GMSH:
                raise SceneError(f"{path}: cells of Gmsh's type {kind} are not carried")
            blocks.append((dimension, entities[dimension, entity], GMSH[kind][0], rows[:, :GMSH[kind][1]], rows))
        at += 1 + count
    top = max(block[0] for block in blocks)
    kinds = {block[2] for block in blocks if block[0] == top}
    if len(kinds) != 1:
        raise SceneError(f"{path}: cells of one kind are needed, there are {', '.join(sorted(kinds))}")
    cell = kinds.pop()
    middle = {9: ((0, 1), (1, 2), (2, 0)), 11: ((0, 1), (1, 2), (2, 0), (0, 3), (2, 3), (1, 3))}
    for _, _, kind, corners, rows in blocks:
        if rows.shape[1] > corners.shape[1] and kind in ("triangle", "tetrahedron"):
            where = np.array([[places[t] for t in row] for row in rows])
            ends = middle[9 if kind == "triangle" else 11]
            straight = np.stack([0.5*(where[:, a] + where[:, b]) for a, b in ends], 1)
            if np.abs(where[:, corners.shape[1]:] - straight).max() > 1e-6*np.abs(where).max():
                raise SceneError(f"{path}: cells with curved sides are not carried")
    tags = np.unique(np.concatenate([block[3].ravel() for block in blocks if block[0] == top]))
    number = {int(tag): i for i, tag in enumerate(tags)}
    points = scale*np.array([places[int(tag)] for tag in tags])[:, :top]
    cells, cell_groups, facet_groups, of_cell = [], {}, {}, []
    for dimension, groups, _, corners, _ in blocks:
        rows = np.array([[number.get(int(t), -1) for t in row] for row in corners])
        if dimension == top:
            cells.append(rows[:, ORDER.get(cell, slice(None))])
            of_cell += [groups]*len(rows)
        elif dimension == top - 1:
            for name in groups:
                facet_groups.setdefault(name, []).append(np.sort(rows, 1))
    for name in sorted({name for groups in of_cell for name in groups}):
        cell_groups[name] = np.array([name in groups for groups in of_cell])
    return Plan(cell, points, np.concatenate(cells), cell_groups,
                {name: np.concatenate(rows) for name, rows in facet_groups.items()})


def make(scene, thickness=0.0, layers=1, sector=5.0, cells=""):
    """The plan of a scene. thickness [m], layers: of a plane scene, 0: it stays plane; sector [degrees]: of an
    axisymmetric one; cells: goes before the key."""
    given = scene.mesh
    if given.file:
        plan = read_gmsh(scene.path.parent/given.file, given.scale)
        if scene.scene.geometry == "axisymmetric" or (scene.scene.geometry == "box") != (plan.dimension == 3):
            raise SceneError("&mesh file: a mesh in three dimensions needs geometry = 'box', in two 'plane_strain'")
        return plan
    return _built_in(scene, thickness, layers, sector, cells)
