# SPDX-License-Identifier: MIT
"""The distributed mesh as arrays: numbers of the unknowns, shape functions at the points, assembly over all ranks.

At every point of quadrature the equations have thirteen numbers, made from the nodes of a cell by one matrix G: strain
(6), displacement (3), pressure, gradient of the pressure (3). A vector of a rank holds what it owns, displacements
before pressures, and then its ghosts in the same order.
"""
import numpy as np
from petsc4py import PETSc

from . import calls
from .scene import SceneError

STRAIN, MOTION, PRESSURE, GRADIENT = slice(0, 6), slice(6, 9), 9, slice(10, 13)
NUMBERS = 13
CHUNK = 512  # cells whose matrices stand in memory at once
DEGREE = {3: 2, 6: 4, 7: 5, 12: 6}  # of quadrature, for mud_host's number of points in a triangle
LEAST = {"quadrilateral": 4, "hexahedron": 4}  # with two points along an edge some motions would meet no stiffness


class Space:
    def __init__(self, comm, plan, pressure_degree, quadrature):
        cell = comm.bcast(plan.cell if plan else None)
        self.dimension = comm.bcast(plan.dimension if plan else None)
        self.mesh = calls.Distributed(comm, cell, plan.points if plan else None, plan.cells if plan else None,
                                      self.dimension)
        self.comm, self.cell, self.cells, self.pressure_degree = comm, cell, self.mesh.cells, pressure_degree
        self._number()
        self._tables(quadrature)
        self.facet_groups = comm.bcast(plan.facet_groups if plan else None)
        groups = comm.bcast(plan.cell_groups if plan else None)
        self.cell_groups = {name: of_all[self.mesh.original] for name, of_all in groups.items()}
        self.cell_groups["all"] = np.ones(self.cells, bool)
        self._facets = self._sorted_facets()

    def _number(self):
        d, comm = self.dimension, self.comm
        each_u, own_u, ghosts_u, first_u, self.places_u = self.mesh.nodes(2)
        if self.pressure_degree:
            each_p, own_p, ghosts_p, first_p, self.places_p = self.mesh.nodes(self.pressure_degree)
        else:
            each_p, own_p, ghosts_p, first_p = np.zeros((self.cells, 0), int), 0, np.zeros(0, int), 0
            self.places_p = np.zeros((0, 3))
        self.own_u, self.own_p, self.owned = d*own_u, own_p, d*own_u + own_p
        starts = np.array(comm.allgather((first_u, first_p)))
        self.first = comm.scan(self.owned) - self.owned
        offsets = np.array(comm.allgather(self.first))
        sizes_u = np.array(comm.allgather(own_u))
        who_u = np.searchsorted(starts[:, 0], ghosts_u, "right") - 1
        who_p = np.searchsorted(starts[:, 1], ghosts_p, "right") - 1
        ghost_u = (offsets[who_u] + d*(ghosts_u - starts[who_u, 0]))[:, None] + np.arange(d)
        ghost_p = offsets[who_p] + d*sizes_u[who_p] + ghosts_p - starts[who_p, 1]
        self.ghosts = np.concatenate([ghost_u.ravel(), ghost_p]).astype(PETSc.IntType)
        #: global number of every local unknown
        self.everywhere = np.concatenate([self.first + np.arange(self.owned), self.ghosts]).astype(PETSc.IntType)
        node = np.arange(len(self.places_u))
        first = np.where(node < own_u, d*node, self.owned + d*(node - own_u))
        self.of_u = first[:, None] + np.arange(d)  #: (nodes, dimension) local numbers
        node = np.arange(len(self.places_p))
        self.of_p = np.where(node < own_p, d*own_u + node, self.owned + d*len(ghosts_u) + node - own_p)
        self.nodes_u, self.nodes_p = each_u, each_p
        #: (cells, unknowns): displacements, then pressures
        self.dofs = np.concatenate([self.of_u[each_u].reshape(self.cells, -1), self.of_p[each_p]], 1)
        self.size = len(self.everywhere)
        self.is_u = np.zeros(self.size, bool)
        self.is_u[self.of_u.ravel()] = True
        self._vector = PETSc.Vec().createGhost(self.ghosts, (self.owned, PETSc.DETERMINE), comm=comm)

    def _tables(self, quadrature):
        points, weights = calls.quadrature(self.cell, max(DEGREE[quadrature], LEAST.get(self.cell, 0)))
        self.reference = (points, weights)
        _, slopes = calls.shapes(self.cell, 1, points)
        corners = self.mesh.corners
        jacobian = np.einsum("cvi,qvj->cqij", corners, slopes)
        self.weights = np.abs(np.linalg.det(jacobian))*weights
        inverse = np.linalg.inv(jacobian)
        self.shape_u, slopes = calls.shapes(self.cell, 2, points)
        self.slopes_u = np.einsum("qnj,cqji->cqni", slopes, inverse)
        self.per_cell, self.points = len(points), self.cells*len(points)
        if self.pressure_degree:
            self.shape_p, slopes = calls.shapes(self.cell, self.pressure_degree, points)
            self.slopes_p = np.einsum("qnj,cqji->cqni", slopes, inverse)
        value, _ = calls.shapes(self.cell, 1, points)
        self.places = np.einsum("qv,cvi->cqi", value, corners)

    def matrices(self, cells):
        """G of these cells: (cells, points, 13, unknowns)."""
        d, g = self.dimension, self.slopes_u[cells]
        n = g.shape[2]
        G = np.zeros((len(g), self.per_cell, NUMBERS, self.dofs.shape[1]))
        axes = (0, 1) if d == 2 else (0, 1, 2)
        for a in axes:
            G[:, :, a, a:d*n:d] = g[..., a]
            G[:, :, 6 + a, a:d*n:d] = self.shape_u
        for row, (a, b) in zip((3, 4, 5), ((0, 1), (0, 2), (1, 2))):
            if b < d:
                G[:, :, row, a:d*n:d] = g[..., b]
                G[:, :, row, b:d*n:d] = g[..., a]
        if self.pressure_degree:
            G[:, :, PRESSURE, d*n:] = self.shape_p
            for a in axes:
                G[:, :, 10 + a, d*n:] = self.slopes_p[cells][..., a]
        return G

    def chunks(self):
        return [slice(i, min(i + CHUNK, self.cells)) for i in range(0, self.cells, CHUNK)]

    def numbers(self, *vectors):
        """The thirteen numbers of every point (cells, points, 13) of each local vector."""
        out = [np.empty((self.cells, self.per_cell, NUMBERS)) for _ in vectors]
        for chunk in self.chunks():
            G = self.matrices(chunk)
            for vector, array in zip(vectors, out):
                array[chunk] = np.einsum("cqkn,cn->cqk", G, vector[self.dofs[chunk]], optimize=True)
        return out

    def forces(self, *answers):
        """Sum of G^T s times weight: (cells, unknowns) of each array (cells, points, 13)."""
        out = [np.empty((self.cells, self.dofs.shape[1])) for _ in answers]
        for chunk in self.chunks():
            G = self.matrices(chunk)
            for s, array in zip(answers, out):
                array[chunk] = np.einsum("cqkn,cqk->cn", G, s[chunk]*self.weights[chunk][..., None], optimize=True)
        return out

    def stiffness(self, chunk, J):
        """G^T J G of cells: (cells, unknowns, unknowns)."""
        G = self.matrices(chunk)
        shape = (len(G), -1, G.shape[-1])
        JG = (J*self.weights[chunk][..., None, None]) @ G
        return G.reshape(shape).transpose(0, 2, 1) @ JG.reshape(shape)

    # What ranks share.
    def summed(self, local):
        """Local vector whose entries are summed over all ranks, right on ghosts too."""
        with self._vector.localForm() as form:
            form.setArray(local)
        self._vector.ghostUpdate(PETSc.InsertMode.ADD, PETSc.ScatterMode.REVERSE)
        return self.spread(self._vector.array)

    def spread(self, owned):
        """Local vector of what every rank owns."""
        self._vector.setArray(owned)
        self._vector.ghostUpdate(PETSc.InsertMode.INSERT, PETSc.ScatterMode.FORWARD)
        with self._vector.localForm() as form:
            return form.array.copy()

    def gathered(self, of_cells, dofs=None):
        """Sum of contributions (cells, unknowns) to every unknown, over all ranks."""
        dofs = self.dofs if dofs is None else dofs
        return self.summed(np.bincount(dofs.ravel(), of_cells.ravel(), self.size))

    def norm(self, local, which=None):
        own = local[:self.owned] if which is None else local[:self.owned][which[:self.owned]]
        return np.sqrt(self.comm.allreduce(float((own**2).sum())))

    def new_matrix(self):
        """A matrix of all unknowns with room for every pair of a cell."""
        counts = np.zeros(self.size)
        keys = [np.unique(self.dofs[c].astype(np.int64)[:, :, None]*self.size + self.dofs[c][:, None, :])
                for c in self.chunks()]
        pairs = np.unique(np.concatenate(keys)) if keys else np.zeros(0, np.int64)
        counts = np.bincount(pairs//self.size, minlength=self.size).astype(float)
        total = self.comm.allreduce(self.owned)
        room = np.minimum(self.summed(counts)[:self.owned], total).astype(PETSc.IntType)
        A = PETSc.Mat().createAIJ(((self.owned, total), (self.owned, total)), bsize=1,
                                  nnz=(np.minimum(room, self.owned), np.minimum(room, total - self.owned)),
                                  comm=self.comm)
        A.setOption(PETSc.Mat.Option.KEEP_NONZERO_PATTERN, True)
        return A

    def fill(self, A, J, more=()):
        """A from J of every point (cells, points, 13, 13); more: (unknowns of cells, matrices) besides."""
        A.zeroEntries()
        add, rows = PETSc.InsertMode.ADD, self.everywhere[self.dofs]
        for chunk in self.chunks():
            for row, block in zip(rows[chunk], self.stiffness(chunk, J[chunk])):
                A.setValues(row, row, block, add)
        for dofs, blocks in more:
            for row, block in zip(self.everywhere[dofs], blocks):
                A.setValues(row, row, block, add)
        A.assemble()

    # Boundaries.
    def _sorted_facets(self):
        vertices = self.mesh.vertices
        if not self.cells:
            return [np.zeros((0, len(f)), np.int64) for f in calls.facets(self.cell)[0]]
        return [np.sort(vertices[:, facet], 1) for facet in calls.facets(self.cell)[0]]

    def facets(self, name):
        """(cell, number of the facet in it) of the facets of a group on this rank."""
        wanted = self.facet_groups[name]
        if not len(wanted):
            return np.zeros((0, 2), int)
        _, codes = np.unique(np.concatenate([wanted, *self._facets]), axis=0, return_inverse=True)
        codes = codes.ravel()
        hit = np.isin(codes[len(wanted):], codes[:len(wanted)]).reshape(len(self._facets), -1)
        number, cell = np.nonzero(hit)
        return np.stack([cell, number], 1)

    def facet_shapes(self, number, degree):
        """Places on the cell, weights, tangents of the reference facet; values of the shape functions."""
        topology, vertices = calls.facets(self.cell)
        corner = vertices[topology[number]]
        kind = {2: "interval", 3: "triangle", 4: "quadrilateral"}[len(corner)]
        points, weights = calls.quadrature(kind, degree)
        tangents = corner[1:3] - corner[0] if len(corner) > 2 else corner[1:2] - corner[0]
        return corner[0] + points @ tangents, weights, tangents

    def on_facets(self, name, degree=4):
        """Of the facets of a group: cell, shape functions of u (f, q, n) and p, outward normal times weight (f, q, d),
        places (f, q, d)."""
        chosen = self.facets(name)
        cells, shape_u, shape_p, normal, places = [], [], [], [], []
        for number in np.unique(chosen[:, 1]):
            own = chosen[chosen[:, 1] == number, 0]
            points, weights, tangents = self.facet_shapes(number, degree)
            values, slopes = calls.shapes(self.cell, 1, points)
            corners = self.mesh.corners[own]
            jacobian = np.einsum("cvi,qvj->cqij", corners, slopes)
            real = np.einsum("cqij,tj->cqti", jacobian, tangents)
            if self.dimension == 3:
                n = np.cross(real[..., 0, :], real[..., 1, :])
            else:
                n = np.stack([real[..., 0, 1], -real[..., 0, 0]], -1)
            place = np.einsum("qv,cvi->cqi", values, corners)
            outward = np.einsum("cqi,cqi->cq", n, place - corners.mean(1)[:, None])
            n = n*np.sign(outward)[..., None]*weights[:, None]
            cells.append(own)
            u = calls.shapes(self.cell, 2, points)[0]
            shape_u.append(np.broadcast_to(u, (len(own), *u.shape)))
            if self.pressure_degree:
                p = calls.shapes(self.cell, self.pressure_degree, points)[0]
                shape_p.append(np.broadcast_to(p, (len(own), *p.shape)))
            normal.append(n)
            places.append(place)
        if not cells:
            q = len(self.facet_shapes(0, degree)[1])
            m = self.nodes_p.shape[1]
            return (np.zeros(0, int), np.zeros((0, q, self.shape_u.shape[1])), np.zeros((0, q, m)),
                    np.zeros((0, q, self.dimension)), np.zeros((0, q, self.dimension)))
        join = np.concatenate
        return join(cells), join(shape_u), join(shape_p) if shape_p else None, join(normal), join(places)

    def nodes_of(self, name, degree):
        """Local nodes (of u where degree = 2, else of p) of a group of facets or cells, as marks over all."""
        if not self.has(name):
            raise SceneError(f"there is no group '{name}'")
        each, places = (self.nodes_u, self.places_u) if degree == 2 else (self.nodes_p, self.places_p)
        numbers = self.of_u[:, 0] if degree == 2 else self.of_p
        marks = np.zeros(self.size)
        if name in self.facet_groups:
            topology, vertices = calls.facets(self.cell)
            order = 2 if degree == 2 else self.pressure_degree
            reference = calls.node_places(self.cell, order)
            for cell, number in self.facets(name):
                corner = vertices[topology[number]]
                edges = corner[1:3] - corner[0]
                normal = np.cross(edges[0], edges[1]) if self.dimension == 3 else np.array([edges[0][1], -edges[0][0]])
                on = np.abs((reference - corner[0]) @ normal) < 1e-12
                marks[numbers[each[cell, on]]] = 1.0
        else:
            marks[numbers[each[self.cell_groups[name]].ravel()]] = 1.0
        return self.summed(marks)[numbers] > 0.0

    def has(self, name):
        return name in self.facet_groups or name in self.cell_groups
