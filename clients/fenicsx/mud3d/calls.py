# SPDX-License-Identifier: MIT
"""Every call of dolfinx, basix and ufl stands here: another release of FEniCSx needs changes in this file alone.

Written for 0.5.2 (Debian 12). What newer releases call otherwise is marked "newer". Nothing here knows the equations.
"""
import basix
import dolfinx
import numpy as np
import ufl
from dolfinx import fem, io, mesh

NEWER = tuple(int(part) for part in dolfinx.__version__.split(".")[:2]) >= (0, 7)
VERTICES = {"triangle": 3, "quadrilateral": 4, "tetrahedron": 4, "hexahedron": 8}


def quadrature(cell, degree):
    """Points (q, dimension) and weights (q) on the reference cell."""
    return basix.make_quadrature(getattr(basix.CellType, cell), degree)


def _element(cell, degree):
    family = basix.ElementFamily.P
    return basix.create_element(family, getattr(basix.CellType, cell), degree, basix.LagrangeVariant.gll_warped)


def shapes(cell, degree, points):
    """Values (q, nodes) and slopes (q, nodes, dimension) of Lagrange's shape functions on the reference cell."""
    table = _element(cell, degree).tabulate(1, points)[..., 0]
    return table[0], np.moveaxis(table[1:], 0, -1)


def node_places(cell, degree):
    """(nodes, dimension) on the reference cell."""
    return np.asarray(_element(cell, degree).points)


def facets(cell):
    """Vertices of every facet of the reference cell, and places of the vertices."""
    kind = getattr(basix.CellType, cell)
    return basix.topology(kind)[-2], np.asarray(basix.geometry(kind))


class Distributed:
    """A mesh over all ranks, made of what the first rank has, and the numbers of its nodes.

    points (n, dimension), cells (m, vertices in the order of basix).
    """

    def __init__(self, comm, cell, points, cells, dimension):
        if comm.rank:
            points, cells = np.zeros((0, dimension)), np.zeros((0, VERTICES[cell]), np.int64)
        if NEWER:
            import basix.ufl
            domain = ufl.Mesh(basix.ufl.element("Lagrange", cell, 1, shape=(dimension,)))
            partitioner = mesh.create_cell_partitioner(mesh.GhostMode.none)
            self.mesh = mesh.create_mesh(comm, cells.astype(np.int64), points, domain, partitioner)
        else:
            domain = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell(cell, geometric_dimension=dimension), 1))
            self.mesh = mesh.create_mesh(comm, cells.astype(np.int64), points, domain, mesh.GhostMode.none)
        self.comm, self.cell = comm, cell
        topology = self.mesh.topology
        self.cells = topology.index_map(topology.dim).size_local
        self.cells_of_all = topology.index_map(topology.dim).size_global
        #: number of every cell in the mesh before it was distributed
        self.original = np.asarray(topology.original_cell_index[:self.cells], np.int64)
        geometry = self.mesh.geometry
        corners = geometry.dofmap if NEWER else geometry.dofmap.array
        corners = np.asarray(corners).reshape(-1, VERTICES[cell])[:self.cells]
        self.corners = geometry.x[corners][..., :dimension]  #: (cells, vertices, dimension)
        #: numbers of the vertices before the mesh was distributed (cells, vertices)
        self.vertices = np.asarray(geometry.input_global_indices, np.int64)[corners]

    def nodes(self, degree):
        """Nodes of a scalar Lagrange space: of every cell (cells, nodes), owned, ghosts' global numbers, first of
        the owned, places (owned and ghosts, dimension)."""
        space = (fem.functionspace if NEWER else fem.FunctionSpace)(self.mesh, ("Lagrange", degree))
        lists = space.dofmap.list if NEWER else space.dofmap.list.array
        index_map = space.dofmap.index_map
        each = np.asarray(lists).reshape(-1, space.dofmap.dof_layout.num_dofs)[:self.cells]
        places = space.tabulate_dof_coordinates()
        ghosts = np.asarray(index_map.ghosts, np.int64)
        return each, index_map.size_local, ghosts, index_map.local_range[0], places

    def writer(self, path):
        return _Writer(self.mesh, path)


class _Writer:
    """Fields over time for ParaView: values at the vertices and of the cells."""

    def __init__(self, domain, path):
        self.mesh, self.functions = domain, {}
        self.file = io.XDMFFile(domain.comm, path, "w")
        self.file.write_mesh(domain)

    def _function(self, name, family, degree, components):
        if name not in self.functions:
            if NEWER:
                shape = (family, degree) if components == 1 else (family, degree, (components,))
                space = fem.functionspace(self.mesh, shape)
            elif components == 1:
                space = fem.FunctionSpace(self.mesh, (family, degree))
            else:
                space = fem.VectorFunctionSpace(self.mesh, (family, degree), dim=components)
            self.functions[name] = fem.Function(space, name=name)
        return self.functions[name]

    def write(self, time, at_vertices, of_cells):
        """at_vertices: (cells, vertices, components) by name, of_cells: (cells, components)."""
        for values, family, degree in ((at_vertices, "Lagrange", 1), (of_cells, "DG", 0)):
            for name, array in values.items():
                function = self._function(name, family, degree, array.shape[-1])
                dofmap = function.function_space.dofmap
                each = np.asarray(dofmap.list if NEWER else dofmap.list.array)
                count = len(array) if family == "DG" else array.shape[0]*array.shape[1]
                function.x.array.reshape(-1, array.shape[-1])[each.reshape(-1)[:count]] = \
                    array.reshape(count, array.shape[-1])
                function.x.scatter_forward()
                self.file.write_function(function, time)

    def close(self):
        self.file.close()
