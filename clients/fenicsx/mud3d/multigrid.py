# SPDX-License-Identifier: MIT
"""Preconditioner of the linear equations whose number of iterations does not follow the size of the mesh.

One application is block lower-triangular: a cycle for the displacements, then, for what the pressures still lack, one
for their Schur complement.

* Displacements: two levels by order. Quadratic ones are smoothed (SOR, forwards and backwards), linear ones on the same
  cells are the coarse level, where a cycle of BoomerAMG takes over, which keeps the components apart.
* Pressures: storage + flow + b_u b_p/kappa, the response of the skeleton to a pressure. 1/kappa is that to a plane wave
  of pressure, n.Q^-1.n with the acoustic tensor Q(n) of the present tangent, the mean over directions: 1/(K + 4 G/3)
  where the skeleton is isotropic. It is what makes fast loading as easy as slow. Its inverse is a cycle of BoomerAMG.
"""
import numpy as np
from petsc4py import PETSc

from . import calls
from .space import GRADIENT, NUMBERS, PRESSURE

DIRECTIONS = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [1, 1, -1], [1, -1, 1], [-1, 1, 1]], float)
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1)[:, None]
LOCAL = ((0, 3, 4), (3, 1, 5), (4, 5, 2))


def compliance(tangent, dimension):
    """1/kappa of every point; tangent (n, 6, 6)."""
    C = tangent[:, LOCAL][:, :, :, LOCAL]  # C[i, j, k, l]
    C = 0.5*(C + C.transpose(0, 3, 4, 1, 2))
    total = 0.0
    directions = DIRECTIONS if dimension == 3 else np.array([[1, 0, 0], [0, 1, 0], [1, 1, 0], [1, -1, 0]], float)
    for n in directions:
        n = n/np.linalg.norm(n)
        Q = np.einsum("j,pijkl,l->pik", n, C, n)[:, :dimension, :dimension]
        least = 1e-4*np.trace(Q, axis1=1, axis2=2)[:, None, None]*np.eye(dimension)
        m = n[:dimension]
        moved = np.linalg.solve(Q + least, np.tile(m, (len(Q), 1))[..., None])[..., 0]
        total = total + np.maximum(moved @ m, 0.0)
    return total/len(directions)


class Blocks:
    """The preconditioner as PETSc calls it."""

    def __init__(self, solver):
        self.solver, self.space = solver, solver.space
        space = self.space
        comm = space.comm
        self.is_u = PETSc.IS().createStride(space.own_u, space.first, 1, comm)
        self.is_p = PETSc.IS().createStride(space.own_p, space.first + space.own_u, 1, comm)
        self.A_uu = self.A_pu = self.S = None
        self.Schur = space.new_matrix() if space.own_p or comm.allreduce(space.own_p) else None
        self._coarse()

    def _coarse(self):
        """Interpolation from the vertices to the nodes of the displacements; what is held gives and takes nothing."""
        space, d, comm = self.space, self.space.dimension, self.space.comm
        each, own, ghosts, first, places = space.mesh.nodes(1)
        number = np.concatenate([first + np.arange(own), ghosts])[each]
        weights = calls.shapes(space.cell, 1, calls.node_places(space.cell, 2))[0]
        held = self.solver.constraints.held
        node_held = held[space.of_u]  # (nodes, d)
        own_fine = space.own_u//d
        offset = comm.scan(space.own_u) - space.own_u
        # vertices are nodes of the displacements, too: the first ones of every cell
        corner_held = node_held[space.nodes_u[:, :each.shape[1]]]
        self.I = PETSc.Mat().createAIJ(((space.own_u, None), (d*own, None)), bsize=d,
                                       nnz=(each.shape[1], each.shape[1]), comm=comm)
        self.I.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, False)
        done = np.zeros(own_fine, bool)
        for cell in range(space.cells):
            for k, node in enumerate(space.nodes_u[cell]):
                if node >= own_fine or done[node]:
                    continue
                done[node] = True
                some = np.nonzero(weights[k] > 1e-12)[0]
                for c in range(d):
                    keep = some if node_held[node, c] else some[~corner_held[cell, some, c]]
                    if node_held[node, c] and len(some) > 1:
                        continue
                    if len(keep):  # zeros of held corners keep a place on the diagonal of the coarse matrix
                        self.I.setValues([offset + d*node + c], (d*number[cell, keep] + c).astype(PETSc.IntType),
                                         weights[k, keep]*(not node_held[node, c]))
        self.I.assemble()
        self.A_c = None
        self.ksp_u = self.ksp_p = None

    def refresh(self, C, J):
        space, held = self.space, self.solver.constraints
        self.A_uu = C.createSubMatrix(self.is_u, self.is_u, self.A_uu)
        self.A_c = self.A_uu.ptap(self.I, result=self.A_c)
        diagonal = self.A_c.getDiagonal().array
        first = self.A_c.getOwnershipRange()[0]
        empty = np.nonzero(np.abs(diagonal) == 0.0)[0] + first
        self.A_c.setOption(PETSc.Mat.Option.KEEP_NONZERO_PATTERN, True)
        big = float(np.abs(diagonal).max(initial=1.0))
        self.A_c.zeroRowsColumns(empty.astype(PETSc.IntType), big)
        if self.ksp_u is None:
            self._displacements()
        else:
            self.ksp_u.setOperators(self.A_uu)
            pc = self.ksp_u.getPC()
            pc.getMGCoarseSolve().setOperators(self.A_c)
            pc.getMGSmoother(1).setOperators(self.A_uu)
        if self.Schur is None:
            return
        self.A_pu = C.createSubMatrix(self.is_p, self.is_u, self.A_pu)
        J = J.reshape(-1, NUMBERS, NUMBERS)
        D = self.solver.tangent
        part = np.zeros_like(J)
        third = 1.0/3.0
        push = -third*J[:, 0:3, PRESSURE].sum(1)
        swell = third*J[:, PRESSURE, 0:3].sum(1)
        part[:, PRESSURE, PRESSURE] = J[:, PRESSURE, PRESSURE] + push*swell*compliance(D, space.dimension)
        part[:, GRADIENT, GRADIENT] = J[:, GRADIENT, GRADIENT]
        space.fill(self.Schur, part.reshape(space.cells, space.per_cell, NUMBERS, NUMBERS))
        size = np.abs(self.Schur.getDiagonal().array[space.own_u:]).max(initial=0.0)
        self.Schur.zeroRowsColumns(held.rows, float(size) or 1.0)
        self.S = self.Schur.createSubMatrix(self.is_p, self.is_p, self.S)
        if self.ksp_p is None:
            self._pressures()
        else:
            self.ksp_p.setOperators(self.S)

    def _displacements(self):
        self.ksp_u = PETSc.KSP().create(self.space.comm)
        self.ksp_u.setOptionsPrefix("u_")
        self.ksp_u.setType("preonly")
        self.ksp_u.setOperators(self.A_uu)
        pc = self.ksp_u.getPC()
        pc.setType("mg")
        pc.setMGLevels(2)
        pc.setMGInterpolation(1, self.I)
        smoother = pc.getMGSmoother(1)
        smoother.setOperators(self.A_uu)
        smoother.setType("richardson")
        smoother.getPC().setType("sor")
        smoother.setTolerances(max_it=2)
        smoother.setNormType(PETSc.KSP.NormType.NONE)
        coarse = pc.getMGCoarseSolve()
        coarse.setOperators(self.A_c)
        coarse.setType("preonly")
        coarse.getPC().setType("hypre")
        self.ksp_u.setFromOptions()

    def _pressures(self):
        self.ksp_p = PETSc.KSP().create(self.space.comm)
        self.ksp_p.setOptionsPrefix("p_")
        self.ksp_p.setType("preonly")
        self.ksp_p.setOperators(self.S)
        self.ksp_p.getPC().setType("hypre")
        self.ksp_p.setFromOptions()

    # What PETSc calls.
    def setUp(self, pc):
        pass

    def apply(self, pc, r, z):
        space = self.space
        if not hasattr(self, "r_u"):
            self.r_u, self.z_u = self.A_uu.createVecRight(), self.A_uu.createVecRight()
            if self.Schur is not None:
                self.r_p, self.z_p, self.t_p = (self.S.createVecRight() for _ in range(3))
        self.r_u.setArray(r.array_r[:space.own_u])
        self.ksp_u.solve(self.r_u, self.z_u)
        if self.Schur is None:
            z.setArray(self.z_u.array_r)
            return
        self.A_pu.mult(self.z_u, self.t_p)
        self.r_p.setArray(r.array_r[space.own_u:] - self.t_p.array_r)
        self.ksp_p.solve(self.r_p, self.z_p)
        z.setArray(np.concatenate([self.z_u.array_r, self.z_p.array_r]))


def setup(solver, pc):
    """GMRES with the blocks, as the solver's method."""
    blocks = Blocks(solver)
    pc.setType("python")
    pc.setPythonContext(blocks)
    solver.ksp.setType("fgmres")
    solver.ksp.setTolerances(rtol=solver.tolerance, max_it=300)
    solver.ksp.setGMRESRestart(100)
    solver.ksp.setFromOptions()
    return blocks
