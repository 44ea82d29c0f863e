# SPDX-License-Identifier: MIT
"""The linear equations of a step, P^T A P y = r: factors of MUMPS, or GMRES with one multigrid for every field."""
import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from . import multigrid


NEAR = 1.0e-5  # change of slopes, over the stiffness, that needs no new matrix: Newton's method loses nothing by it


class NotSolved(Exception):
    pass


class Solver:
    def __init__(self, space, constraints, kind, tolerance=1.0e-8):
        self.space, self.constraints, self.kind = space, constraints, kind
        self.A = space.new_matrix()
        self.C = None
        self.tolerance = tolerance
        self.ksp, self.iterations, self.J = None, 0, None

    def set(self, J, more, plates, tangent):
        """The matrix of these slopes; plates: (global number, mass term); tangent: of the skeleton at every point."""
        space, held = self.space, self.constraints
        self.new = not self._is_old(J, more)
        if not self.new:  # an elastic ground in steps of one length: the factors serve
            return
        self.J = None
        space.fill(self.A, J, more)
        if plates:
            for row, value in plates:
                if space.comm.rank == 0:
                    self.A.setValue(row, row, value, PETSc.InsertMode.ADD)
            self.A.assemble()
        if held.P is None:
            self.C = self.A.copy() if self.C is None else self.A.copy(self.C, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
        else:
            self.C = self.A.ptap(held.P, result=self.C)
            self.C.setOption(PETSc.Mat.Option.KEEP_NONZERO_PATTERN, True)
        diagonal = np.abs(self.C.getDiagonal().array)
        big = space.comm.allreduce(float(diagonal[:space.own_u].max(initial=0.0)), op=MPI.MAX)
        self.C.zeroRowsColumns(held.rows, big or 1.0)
        self.J, self.more, self.tangent = J, [blocks for _, blocks in more], tangent

    def _is_old(self, J, more):
        """Whether the matrix that is there serves, on all ranks: its slopes are these but for NEAR."""
        old = self.J is not None and len(more) == len(self.more) \
            and all(np.array_equal(blocks, one) for (_, blocks), one in zip(more, self.more))
        if old and len(J):
            J, before = (slopes.reshape(-1, *slopes.shape[-2:]) for slopes in (J, self.J))
            size = np.sqrt(np.abs(np.einsum("kii->ki", J)).max(0))
            old = bool(np.all(np.abs(J - before).max(0) <= NEAR*np.outer(size, size)))
        return self.space.comm.allreduce(int(old)) == self.space.comm.size

    def lifted(self, local):
        """A times a local vector."""
        x, y = self.A.createVecRight(), self.A.createVecLeft()
        x.setArray(local[:self.space.owned])
        self.A.mult(x, y)
        return self.space.spread(y.array)

    def solve(self, right):
        """dx (local vector, without what is prescribed) of a right side that is already reduced (local)."""
        if self.ksp is None:
            self._begin()
        b, y = self.C.createVecLeft(), self.C.createVecRight()
        b.setArray(np.where(self.constraints.held, 0.0, right)[:self.space.owned])
        self.ksp.setOperators(self.C)
        try:
            self._prepare()
            self.ksp.solve(b, y)
        except PETSc.Error as problem:
            raise NotSolved(f"PETSc: {problem}") from problem
        self.iterations += self.ksp.getIterationNumber()
        if self.ksp.getConvergedReason() < 0 or not np.isfinite(y.norm()):
            raise NotSolved(f"the linear solver ended with reason {self.ksp.getConvergedReason()}")
        return self.constraints.full(y.array)

    def _begin(self):
        self.ksp = PETSc.KSP().create(self.space.comm)
        self.ksp.setOperators(self.C)
        pc, options = self.ksp.getPC(), PETSc.Options()
        if self.kind == "mumps":
            self.ksp.setType("preonly")
            pc.setType("lu")
            pc.setFactorSolverType("mumps")
            options["mat_mumps_icntl_14"] = 80  # room for pivoting
            self.ksp.setFromOptions()
        else:
            self.blocks = multigrid.setup(self, pc)

    def _prepare(self):
        if self.kind != "mumps" and self.new:
            self.blocks.refresh(self.C, self.J)
