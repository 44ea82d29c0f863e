# SPDX-License-Identifier: MIT
"""Displacement and pressure of the pore water in MUD sand, by FEniCSx, PETSc and MPI: quasi-static, small strains.

Quadratic displacement, linear pressure, backward Euler, Newton with the consistent tangent of the batch call, line
search, and a cut of the step by all ranks together. Stress is effective and tension positive, p_w compression positive.
"""
import dataclasses
import hashlib
import os

import basix
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem import petsc as fem_petsc
from mpi4py import MPI
from petsc4py import PETSc

import mud


SUCTION = 1.0e-3  # [kPa], what rounding and the tolerance of Newton's method leave where p_w is held at 0


@dataclasses.dataclass
class Water:
    storage: float = 0.8/1.8/2.2e6     #: porosity over the bulk modulus of the water [1/kPa]
    conductivity: float = 1.0e-5/9.81  #: permeability over the unit weight of the water [m2/(kPa s)]
    at_rest: object = 0.0   #: pressure that p_w is counted from [kPa]: a number, or a function of places (points, 3)


@dataclasses.dataclass
class Control:
    tolerance: float = 1.0e-8   #: of the residual: norm over that of the internal forces
    iterations: int = 25
    searches: int = 6           #: halvings in a line search
    cuts: int = 12              #: halvings of a step
    linear: str = "mumps"       #: or "amg": multigrid with rigid-body modes for u, for large problems
    linear_tolerance: float = 1.0e-8  #: of "amg"
    quadrature: int = 2         #: degree
    told: bool = True


class NotConverged(Exception):
    pass


class Refused(Exception):
    """Some point of any rank has no answer to its increment; nothing was written there."""


def voigt_strain(v):
    """11, 22, 33, 12, 13, 23 with engineering shear; in two dimensions plane strain."""
    g, zero = ufl.grad(v), 0*v[0]
    if len(v) == 2:
        return ufl.as_vector([g[0, 0], g[1, 1], zero, g[0, 1] + g[1, 0], zero, zero])
    return ufl.as_vector([g[0, 0], g[1, 1], g[2, 2], g[0, 1] + g[1, 0], g[0, 2] + g[2, 0], g[1, 2] + g[2, 1]])


class Unsaturated(Exception):
    """The water of an accepted step is in tension: the equations here fill every pore with water."""


class Problem:
    """Fields, points and equations; boundary values and loads come from the caller, see `step`."""

    def __init__(self, mesh, material, stress, void_ratio, water=Water(), control=Control()):
        """stress: at the start of every point, one for all or a function of places (points, 3)."""
        self.mesh, self.material, self.water, self.control = mesh, material, water, control
        self.comm, self.time = mesh.comm, 0.0
        cell, self.dimension = mesh.ufl_cell(), mesh.geometry.dim
        self.V = fem.FunctionSpace(mesh, ufl.VectorElement("Lagrange", cell, 2))
        self.Q = fem.FunctionSpace(mesh, ufl.FiniteElement("Lagrange", cell, 1))
        self.u, self.p = fem.Function(self.V, name="u"), fem.Function(self.Q, name="p_w")
        self.u0, self.p0 = fem.Function(self.V), fem.Function(self.Q)
        self.dt = fem.Constant(mesh, 1.0)
        self._points(cell, stress, void_ratio)
        self._forms(cell, water)
        self.bcs, self.loads = [], None
        self.counts = {"steps": 0, "iterations": 0, "cuts": 0, "searches": 0, "linear_iterations": 0}

    def _points(self, cell, stress, void_ratio):
        degree = self.control.quadrature
        kind = {"triangle": basix.CellType.triangle, "tetrahedron": basix.CellType.tetrahedron}[cell.cellname()]
        points, _ = basix.make_quadrature(kind, degree)
        self.per_cell = len(points)
        self.cells = self.mesh.topology.index_map(self.mesh.topology.dim).size_local
        n = self.cells*self.per_cell

        def quadrature(components):
            space = fem.FunctionSpace(self.mesh, ufl.VectorElement("Quadrature", cell, degree, dim=components,
                                                                   quad_scheme="default"))
            return fem.Function(space), space.dofmap.list.array.reshape(-1, self.per_cell)[:self.cells].ravel()

        self.stress_field, self.rows = quadrature(6)
        self.tangent_field, self.tangent_rows = quadrature(36)
        self.strain = fem.Expression(voigt_strain(self.u - self.u0), points)
        self.owned = np.arange(self.cells, dtype=np.int32)
        x = ufl.SpatialCoordinate(self.mesh)
        self.places = fem.Expression(x, points).eval(self.owned).reshape(n, -1)
        begin = stress(self.places) if callable(stress) else np.tile(np.array(stress, float), (n, 1))
        begun = self.material.init_batch(begin, void_ratio=np.full(n, void_ratio))
        self.stress0, self.state0 = begun.stress, begun.statev
        self.stress1, self.state1 = self.stress0.copy(), self.state0.copy()
        self.tangent = np.zeros((n, 6, 6))

    def _forms(self, cell, water):
        v, q = ufl.TestFunction(self.V), ufl.TestFunction(self.Q)
        du, dp = ufl.TrialFunction(self.V), ufl.TrialFunction(self.Q)
        dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": self.control.quadrature,
                                                    "quadrature_scheme": "default"})
        sigma, k = self.stress_field, self.dt*water.conductivity
        # The library's tangent comes column by column: entry 6 j + i is d sigma_i/d eps_j.
        slope = ufl.as_matrix([[self.tangent_field[6*j + i] for j in range(6)] for i in range(6)])
        push = ufl.inner(sigma, voigt_strain(v))*dx - self.p*ufl.div(v)*dx
        # Balance of mass with its sign turned: the matrix is symmetric where the tangent is.
        flow = -q*(ufl.div(self.u - self.u0) + water.storage*(self.p - self.p0))*dx \
            - k*ufl.inner(ufl.grad(self.p), ufl.grad(q))*dx
        self.internal = fem.form(push)
        self.push, self.flow, self.v = push, flow, v
        self.jacobian = fem.form([[ufl.inner(ufl.dot(slope, voigt_strain(du)), voigt_strain(v))*dx,
                                   -dp*ufl.div(v)*dx],
                                  [-q*ufl.div(du)*dx,
                                   -water.storage*q*dp*dx - k*ufl.inner(ufl.grad(dp), ufl.grad(q))*dx]])
        self.residual = fem.form([push, flow])

    def external(self, work):
        """Work of the loads on the test function: work(v) gives a form."""
        self.residual = fem.form([self.push - work(self.v), self.flow])

    def update(self):
        """Stress, state, tangent for the present displacement; every rank learns when a point of any refuses."""
        strain = self.strain.eval(self.owned).reshape(-1, 6)
        answer = self.material.update_batch(
            self.stress0, self.state0, np.ascontiguousarray(strain), tangent="consistent", threads=1,
            out=mud.BatchResponse(self.stress1, self.state1, self.tangent))
        if self.comm.allreduce(answer.failed):
            raise Refused(next(fault for fault in self.comm.allgather(str(answer.fault() or "")) if fault))
        self._to_fields(self.stress1)

    def _to_fields(self, stress):
        self.stress_field.x.array.reshape(-1, 6)[self.rows] = stress
        self.tangent_field.x.array.reshape(-1, 36)[self.tangent_rows] = self.tangent.reshape(-1, 36)

    def _vector(self):
        """Residual with the distance of the boundary values, as Newton's method wants it."""
        with self.b.localForm() as local:
            local.set(0.0)
        fem_petsc.assemble_vector_block(self.b, self.residual, self.jacobian, self.bcs, x0=self.x, scale=-1.0)
        return self.b.norm()

    def _pack(self):
        n = self.n_u
        self.x.array[:n] = self.u.x.array[:n]
        self.x.array[n:] = self.p.x.array[:len(self.x.array) - n]
        self.x.ghostUpdate(addv=PETSc.InsertMode.INSERT, mode=PETSc.ScatterMode.FORWARD)

    def _unpack(self, base, step):
        """Fields at base + step, ghosts too."""
        n = self.n_u
        new = base + step
        self.u.x.array[:n] = new[:n]
        self.p.x.array[:len(new) - n] = new[n:]
        self.u.x.scatter_forward()
        self.p.x.scatter_forward()

    def _start(self):
        """Storage, created at the first step, when the boundary conditions are known."""
        self.n_u = self.V.dofmap.index_map.size_local*self.dimension
        self.A = fem_petsc.create_matrix_block(self.jacobian)
        self.b = fem_petsc.create_vector_block(self.residual)
        self.x, self.d = self.b.copy(), self.b.copy()
        self.ksp = PETSc.KSP().create(self.comm)
        self.ksp.setOperators(self.A)
        pc = self.ksp.getPC()
        if self.control.linear == "mumps":
            self.ksp.setType("preonly")
            pc.setType("lu")
            pc.setFactorSolverType("mumps")
            options = PETSc.Options()
            options["mat_mumps_icntl_14"] = 60  # room for pivoting
            self.ksp.setFromOptions()
        else:
            self._multigrid(pc)

    def _multigrid(self, pc):
        """Fields apart: multigrid with the rigid-body modes for u, and for p on its Schur complement."""
        first = self.A.getOwnershipRange()[0]
        n_p = self.A.getLocalSize()[0] - self.n_u
        u = PETSc.IS().createStride(self.n_u, first, 1, self.comm)
        p = PETSc.IS().createStride(n_p, first + self.n_u, 1, self.comm)
        u.setBlockSize(self.dimension)
        u.compose("nearnullspace", self._rigid_body_modes())
        pc.setType("fieldsplit")
        pc.setFieldSplitIS(("u", u), ("p", p))
        self.ksp.setType("fgmres")
        self.ksp.setTolerances(rtol=self.control.linear_tolerance, max_it=500)
        self.ksp.setGMRESRestart(200)
        options = PETSc.Options()
        # One cycle for u and one for p precondition; p sees what the diagonal of u leaves of its Schur complement.
        for name, value in (("pc_fieldsplit_type", "schur"), ("pc_fieldsplit_schur_fact_type", "lower"),
                            ("pc_fieldsplit_schur_precondition", "selfp"),
                            ("fieldsplit_u_ksp_type", "preonly"), ("fieldsplit_u_pc_type", "gamg"),
                            ("fieldsplit_u_pc_gamg_threshold", 0.02),
                            ("fieldsplit_p_ksp_type", "preonly"), ("fieldsplit_p_pc_type", "hypre")):
            if not options.hasName(name):  # the command line goes first
                options[name] = value
        self.ksp.setFromOptions()

    def _rigid_body_modes(self):
        """Near null space of the block of u: translations, rotations."""
        d, points = self.dimension, self.V.tabulate_dof_coordinates()[:self.n_u//self.dimension]
        rotations = [(0, 1)] if d == 2 else [(0, 1), (1, 2), (0, 2)]
        vectors = []
        for i in range(d + len(rotations)):
            mode = np.zeros((len(points), d))
            if i < d:
                mode[:, i] = 1.0
            else:
                a, b = rotations[i - d]
                mode[:, a], mode[:, b] = -points[:, b], points[:, a]
            vector = PETSc.Vec().createMPI((self.n_u, PETSc.DETERMINE), bsize=d, comm=self.comm)
            vector.setArray(mode.ravel())
            for other in vectors:
                vector.axpy(-vector.dot(other), other)
            vector.normalize()
            vectors.append(vector)
        return PETSc.NullSpace().create(vectors=vectors, comm=self.comm)

    def present(self):
        """Stress of the start of the step, and the slopes with which the states go on as they strained last: those of a
        zero increment would be elastic."""
        self.material.tangent_batch(self.stress0, self.state0, threads=1, out=mud.BatchResponse(columns=self.tangent))
        self._to_fields(self.stress0)

    def _newton(self):
        control = self.control
        self._pack()
        self.present()
        self._vector()
        force = 0.0
        for iteration in range(1, control.iterations + 1):
            before = self.b.norm()
            self.A.zeroEntries()
            fem_petsc.assemble_matrix_block(self.A, self.jacobian, self.bcs)
            self.A.assemble()
            self.ksp.solve(self.b, self.d)
            self.counts["iterations"] += 1
            self.counts["linear_iterations"] += self.ksp.getIterationNumber()
            if self.ksp.getConvergedReason() < 0:
                raise NotConverged(f"linear solver: reason {self.ksp.getConvergedReason()}")
            base, direction, share = self.x.array.copy(), -self.d.array, 1.0
            # The first iteration moves the boundary: its residual cannot be compared with what was before.
            for search in range(control.searches + 1):
                self._unpack(base, share*direction)
                try:
                    self.update()
                    self._pack()
                    norm = self._vector()
                    if np.isfinite(norm) and (iteration == 1 or norm <= (1.0 - 1.0e-4*share)*before
                                              or norm <= control.tolerance*force):
                        break
                except Refused:
                    if iteration == 1:
                        raise
                self.counts["searches"] += 1
                share *= 0.5
            else:
                raise NotConverged("line search")
            force = max(force, self._force())
            if norm <= control.tolerance*force:
                return iteration
        raise NotConverged(f"{control.iterations} iterations")

    def _force(self):
        """Norm of the internal forces: what a residual is measured by."""
        f = fem_petsc.assemble_vector(self.internal)
        f.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
        norm = f.norm()
        f.destroy()
        return norm

    def step(self, end, set_boundary):
        """Goes to the time `end`, in pieces where it must. set_boundary(time) sets values of boundary and loads."""
        if not hasattr(self, "A"):
            self._start()
        size, cuts = end - self.time, 0
        while self.time < end*(1.0 - 1.0e-12):
            size = min(size, end - self.time)
            self.dt.value = size
            set_boundary(self.time + size)
            try:
                iterations = self._newton()
            except (NotConverged, Refused, PETSc.Error) as reason:
                # Every rank comes here: refusals are reduced, norms and PETSc's reasons are those of all.
                cuts += 1
                self.counts["cuts"] += 1
                self._tell(f"   cut at t {self.time + size:.6g}: {reason}")
                if cuts > self.control.cuts:
                    raise
                self._restore()
                size *= 0.5
                continue
            self._refuse_suction(self.time + size)
            self.accept()
            self.time += size
            self.counts["steps"] += 1
            self._tell(f"t {self.time:.6g}: {iterations} iterations")
            size *= 2.0
        self.time = end

    def _refuse_suction(self, time):
        """Ends the run, on every rank, where the water would be in tension."""
        n = self.Q.dofmap.index_map.size_local
        places = self.Q.tabulate_dof_coordinates()[:n]
        rest = self.water.at_rest
        total = self.p.x.array[:n] + (rest(places) if callable(rest) else rest)
        low = (float(total.min()), *places[total.argmin()]) if n else (np.inf, 0.0, 0.0, 0.0)
        value, *place = min(self.comm.allgather(low))
        if value < -SUCTION:
            raise Unsaturated(
                f"t {time:.6g} s: the pressure of the water falls to {value:.4g} kPa at "
                f"({', '.join(f'{x:.4g}' for x in place[:self.dimension])}); this program knows saturated soil only, "
                "from 0 kPa up. Begin at a pressure of the water that leaves none (Water.at_rest; footing.py "
                "--back-pressure), or use mud_host with the fields u-p_w-p_c")

    def accept(self):
        self.last_strain = self.strain.eval(self.owned).reshape(-1, 6)
        self.stress0, self.stress1 = self.stress1, self.stress0
        self.state0, self.state1 = self.state1, self.state0
        self.u0.x.array[:] = self.u.x.array
        self.p0.x.array[:] = self.p.x.array

    def _restore(self):
        self.u.x.array[:] = self.u0.x.array
        self.p.x.array[:] = self.p0.x.array

    def reaction(self, dofs, component):
        """Force that holds these nodes (blocked dofs), less what loads bring, summed over all ranks."""
        f = fem_petsc.assemble_vector(self.residual[0])
        f.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
        owned = dofs[dofs < self.V.dofmap.index_map.size_local]
        total = self.comm.allreduce(float(f.array[owned*self.dimension + component].sum()))
        f.destroy()
        return total

    # Checkpoints: what a cell holds, by the number it had in the mesh before the mesh was distributed, so that a run
    # may go on with another number of ranks, and two runs may be compared cell by cell.
    def _cell_data(self):
        """(cells, columns): displacement, pressure, stress and state of owned cells."""
        u = self.V.dofmap.list.array.reshape(-1, self.V.dofmap.dof_layout.num_dofs)[:self.cells]
        p = self.Q.dofmap.list.array.reshape(-1, self.Q.dofmap.dof_layout.num_dofs)[:self.cells]
        return u, p, [self.u0.x.array.reshape(-1, self.dimension)[u].reshape(self.cells, -1), self.p0.x.array[p],
                      self.stress0.reshape(self.cells, -1), self.state0.reshape(self.cells, -1)]

    def _cell_vector(self, width):
        total = self.mesh.topology.index_map(self.mesh.topology.dim).size_global
        numbers = np.asarray(self.mesh.topology.original_cell_index[:self.cells], np.int32)
        vector = PETSc.Vec().createMPI(total*width, bsize=width, comm=self.comm)
        return vector, PETSc.IS().createBlock(width, numbers, self.comm)

    def digest(self):
        """Hash of all that the cells hold, in the order of the mesh before it was distributed."""
        data = np.hstack(self._cell_data()[2])
        numbers = self.mesh.topology.original_cell_index[:self.cells]
        rows = self.comm.gather((numbers, data))
        if self.comm.rank:
            return None
        numbers, data = (np.concatenate(part) for part in zip(*rows))
        return hashlib.sha256(data[np.argsort(numbers)].tobytes()).hexdigest()[:16]

    def save(self, path):
        """Writes a checkpoint with PETSc's viewer; complete under its name or not there."""
        data = np.hstack(self._cell_data()[2])
        vector, places = self._cell_vector(data.shape[1])
        local = PETSc.Vec().createWithArray(np.ascontiguousarray(data).ravel(), comm=PETSc.COMM_SELF)
        scatter = PETSc.Scatter().create(local, None, vector, places)
        scatter.scatter(local, vector)
        vector.assemble()
        viewer = PETSc.Viewer().createBinary(path + ".part", "w", self.comm)
        vector.view(viewer)
        viewer.destroy()
        self.comm.barrier()
        if self.comm.rank == 0:
            with open(path + ".time", "w") as file:
                file.write(self.time.hex())
            os.replace(path + ".part", path)
        self.comm.barrier()

    def load(self, path):
        """Goes on from a checkpoint, bit by bit, with any number of ranks."""
        u, p, parts = self._cell_data()
        widths = [part.shape[1] for part in parts]
        vector, places = self._cell_vector(sum(widths))
        vector.load(PETSc.Viewer().createBinary(path, "r", self.comm))
        local = PETSc.Vec().createSeq(self.cells*sum(widths))
        PETSc.Scatter().create(vector, places, local, None).scatter(vector, local)
        data = local.array.reshape(self.cells, -1)
        du, dp, ds, dq = np.split(data, np.cumsum(widths)[:-1], axis=1)
        self.u0.x.array.reshape(-1, self.dimension)[u.ravel()] = du.reshape(-1, self.dimension)
        self.p0.x.array[p.ravel()] = dp.ravel()
        for field in (self.u0, self.p0):
            field.x.scatter_forward()
        self.stress0[:] = ds.reshape(self.stress0.shape)
        self.state0[:] = dq.reshape(self.state0.shape)
        self._restore()
        with open(path + ".time") as file:
            self.time = float.fromhex(file.read())

    def _tell(self, text):
        if self.control.told and self.comm.rank == 0:
            print(text, flush=True)
