# SPDX-License-Identifier: MIT
"""A run of a scene: stages, steps, Newton's method. docs/theory/host.md is the theory; air is at rest.

Whatever decides about the course of a run (a refused point, a norm, an error) is reduced over all ranks, so that all of
them decide alike.
"""
import dataclasses

import numpy as np
from mpi4py import MPI

from . import balances, boundaries, control, grid
from .balances import DYNAMIC, STATIC, Scheme, between
from .constraints import Constraints
from .laws import M, Points, Refused, retention
from .linear import NotSolved, Solver
from .scene import SceneError
from .space import GRADIENT, NUMBERS, PRESSURE, STRAIN, Space

TENSION = 1.0e-3   # [kPa], what rounding and Newton's tolerance leave where saturated water is held at 0
LEAST_STEP = 1.0e-12


class NotConverged(Exception):
    pass


class Stopped(Exception):
    """The run cannot go on."""


@dataclasses.dataclass
class Options:
    thickness: float = 0.0
    layers: int = 1
    sector: float = 5.0
    cells: str = ""
    linear: str = "mumps"
    linear_tolerance: float = 1.0e-8
    searches: int = 6
    lanes: bool = False
    told: bool = True


class Run:
    def __init__(self, comm, scene, options=None):
        self.comm, self.scene, self.options = comm, scene, options or Options()
        o = self.options
        plan, fault = None, None
        if comm.rank == 0:
            try:
                plan = grid.make(scene, o.thickness, o.layers, o.sector, o.cells)
            except (SceneError, OSError) as problem:
                fault = problem
        fault = comm.bcast(fault)
        if fault:
            raise fault
        degree = 0 if not scene.has_water else 1 if scene.scene.pressures == "linear" else 2
        if int(scene.scene.quadrature) not in (3, 6, 7, 12):
            raise SceneError("&scene quadrature: 3, 6, 7 or 12")
        self.space = Space(comm, plan, degree, int(scene.scene.quadrature))
        space = self.space
        self.swept = scene.scene.geometry == "axisymmetric"
        self.thick = scene.scene.geometry == "plane_strain" and space.dimension == 3
        #: what the mesh is of the body that a scene of mud_host means: forces and masses are divided by it
        self.share = o.sector/360.0 if self.swept else o.thickness if self.thick else 1.0
        self.up = space.dimension - 1
        self.regions = self._regions()
        self.points = Points(comm, scene, np.repeat(self.regions, space.per_cell), not scene.air_at_rest,
                             o.lanes)
        self.ground = balances.Ground(scene, np.repeat(self.regions, space.per_cell))
        self.weight = np.zeros(3)
        self.weight[self.up] = -scene.scene.gravity
        self.time, self.stage_number = 0.0, 0
        self.x, self.v, self.a = np.zeros(space.size), np.zeros(space.size), np.zeros(space.size)
        self.counts = {"steps": 0, "iterations": 0, "cuts": 0, "searches": 0, "linear_iterations": 0, "rejected": 0}
        self._begin_state()
        self.watchers = []  # called with (run, stage) after every accepted step

    # The start.
    def _regions(self):
        space, found = self.space, np.full(self.space.cells, -1)
        for number, region in enumerate(self.scene.regions):
            if region.group:
                if region.group not in space.cell_groups:
                    raise SceneError(f"&region group = '{region.group}': there is no such group of cells")
                found[space.cell_groups[region.group]] = number
        rest = [i for i, region in enumerate(self.scene.regions) if not region.group]
        if rest:
            found[found < 0] = rest[0]
        if self.comm.allreduce(int((found < 0).sum())):
            raise SceneError("there are cells that no &region names")
        return found

    def _begin_state(self):
        space, points, scene = self.space, self.points, self.scene
        place = space.places.reshape(-1, space.dimension)
        z, n = place[:, self.up], points.n
        stress, void = np.zeros((n, 6)), np.zeros(n)
        for number, region in enumerate(scene.regions):
            void[points.region == number] = self._void_of(number)
        for initial in scene.initials:
            if scene.has_water:
                nodes = space.nodes_of(initial.group, 1) if initial.group != "all" else slice(None)
                height = space.places_p[nodes][:, self.up]
                self.x[space.of_p[nodes]] = initial.p_w + initial.p_w_slope*(height - initial.datum)
        p = space.numbers(self.x)[0].reshape(n, NUMBERS)[:, PRESSURE]
        suction = self.ground.suction(p)[0]
        self._retention_at_start(void, suction)
        for initial in scene.initials:
            if initial.group not in space.cell_groups:
                if initial.stress != "none":
                    raise SceneError(f"&initial group = '{initial.group}': there is no such group of cells")
                continue
            i = np.repeat(space.cell_groups[initial.group], space.per_cell)
            if initial.stress == "uniform":
                rr, zz, tt = initial.sigma
                stress[i, :3] = (rr, zz, tt) if space.dimension == 2 else (rr, tt, zz)
            elif initial.stress == "geostatic":
                total = initial.surcharge + self._overburden(i, z, initial)
                pore = p[i] + (1.0 - points.s0[i])*suction[i] if scene.has_water else 0.0
                vertical = total - pore
                chi = points.s0[i]*suction[i] if initial.k_0_of == "net" else 0.0
                level = initial.k_0*(vertical - chi) + chi
                stress[i, :3] = -level[:, None]
                stress[i, self.up] = -vertical
        points.begin(stress, suction, void)
        flow = np.zeros((space.cells, space.per_cell, NUMBERS))
        self.flow0 = np.zeros(space.size)
        if scene.has_water and scene.scene.initial_flow == "subtract":
            numbers = space.numbers(self.x)[0].reshape(n, NUMBERS)
            k, _ = self.ground.conductivity(points.s0)
            flow.reshape(n, NUMBERS)[:, GRADIENT] = k[:, None]*(numbers[:, GRADIENT] - self.ground.rho_w*self.weight
                                                               * scene.factor(scene.scene.gravity_history, 0.0))
            self.flow0 = space.gathered(space.forces(flow)[0])

    def _retention_at_start(self, void, suction):
        """S_w of the initial void ratios and suctions into points.s0."""
        points = self.points
        points.s0[:] = 1.0
        if points.saturated or not self.scene.has_water:
            return
        if len(points.elastic):
            points.retain(suction, points.s0)
        for number, law in enumerate(points.laws):
            here = points.mud[points.region[points.mud] == number]
            if len(here):
                pairs, back = np.unique(np.stack([suction[here], void[here]], 1), axis=0, return_inverse=True)
                points.s0[here] = law.saturation(pairs[:, 0], pairs[:, 1])[back.ravel()]

    def _overburden(self, own, z, initial):
        """Weight above the points, of the ground of their own region with its water."""
        points, scene = self.points, self.scene
        total = np.zeros(int(own.sum()))
        gravity = scene.scene.gravity*scene.factor(scene.scene.gravity_history, 0.0)
        for number, region in enumerate(scene.regions):
            here = points.region[own] == number
            lowest = self.comm.allreduce(float(z[own][here].min(initial=np.inf)), op=MPI.MIN)
            if not np.isfinite(lowest):
                continue
            levels = np.linspace(initial.surface, min(lowest, initial.surface - 1e-9), 801)
            e = np.full_like(levels, self._void_of(number))
            p = initial.p_w + initial.p_w_slope*(levels - initial.datum) if scene.has_water else 0.0*levels
            suction = self.ground.suction(p)[0]
            s = np.ones_like(levels)
            if scene.air_at_rest:
                law, curve = points.laws[number], points.curves[number]
                s = retention(curve, suction)[0] if curve else law.saturation(suction, e)
            n = e/(1.0 + e)
            fluids = scene.fluids
            rho = (1.0 - n)*region.rho_s
            if scene.has_water:
                rho = rho + n*s*fluids.rho_w + n*(1.0 - s)*fluids.rho_a
            steps = 0.5*(rho[1:] + rho[:-1])*-np.diff(levels)*gravity
            sums = np.concatenate([[0.0], np.cumsum(steps)])
            total[here] = np.interp(-z[own][here], -levels, sums)
        return total

    def _void_of(self, number):
        region = self.scene.regions[number]
        own = region.void_ratio if region.void_ratio is not None else self.points.own_void_ratio[number]
        if own is None:
            raise SceneError(f"&region of '{region.material}': the key void_ratio is missing")
        return own

    # What acts.
    def gravity_at(self, time):
        return self.weight*self.scene.factor(self.scene.scene.gravity_history, time)

    def plates_now(self, scheme, a, time_0, time_1):
        """(global number, force against the residual, mass term) of every plate, at the levels of a step."""
        found = []
        for plate in self.scene.plates:
            mass = plate.mass*self.share
            force = between(*(plate.force*self.share*self.scene.factor(plate.history, t) for t in (time_0, time_1)),
                            scheme.l_f)
            if plate.weight == "yes":
                force += mass*float(between(self.gravity_at(time_0), self.gravity_at(time_1), scheme.l_f)[self.up])
            inertia = scheme.l_a*scheme.acceleration_slope*mass if scheme.kind == DYNAMIC else 0.0
            found.append((plate["master"], force, inertia, mass))
        return found

    # One stage.
    def begin_stage(self, stage):
        self.stage = stage
        self.begun = self.time
        self.constraints = Constraints(self.space, self.scene, stage, self.options.sector if self.swept else 0.0,
                                       self.thick)
        self.solver = Solver(self.space, self.constraints, self.options.linear, self.options.linear_tolerance)
        self.x_stage = self.x.copy()
        rho = stage.rho_inf if stage.rho_inf is not None else 0.8 if stage.analysis == DYNAMIC else 0.0
        self.rho_inf = rho
        self.controlled = stage.steps == "controlled" or (stage.steps != "given" and
                                                          (stage.dt is None or self.scene.scene.step_tolerance is not None))
        accuracy = self.scene.scene.step_tolerance or 1e-2
        self.tolerance = stage.tolerance or (min(1e-4, 0.1*accuracy) if self.controlled else 1e-3)
        self.largest = {"u": 0.0, "p": 0.0}
        self.dashpots = boundaries.absorbing(self, stage) if stage.analysis == DYNAMIC else []
        if self.dashpots:
            boundaries.hold_ground(self)
        if stage.analysis == DYNAMIC and stage.start == "solve":
            self._first_accelerations(stage)

    def _first_accelerations(self, stage):
        space, points = self.space, self.points
        scheme = Scheme(DYNAMIC, 1.0, 1.0)
        residual = self._static_residual()
        for master, force, _, _ in self.plates_now(scheme, self.a, self.time, self.time):
            self._at(master, residual, -force)
        J = balances.mass(points, self.ground)
        if space.pressure_degree:
            J[:, PRESSURE, PRESSURE] = 1.0  # of no consequence: the pressures have no equation here
        plates = [(master, mass) for master, _, _, mass in self.plates_now(scheme, self.a, self.time, self.time)]
        self.solver.set(J.reshape(space.cells, space.per_cell, NUMBERS, NUMBERS), [], plates, points.tangent)
        residual = self.constraints.reduced(residual)
        residual[~space.is_u] = 0.0
        self.a = self.solver.solve(-residual)
        self.a[~space.is_u] = 0.0

    def _static_residual(self):
        """Internal forces less loads of the present state, without what moves."""
        space = self.space
        numbers = space.numbers(self.x)[0].reshape(-1, NUMBERS)
        s = balances.start_numbers(self.points, self.ground, numbers, self.gravity_at(self.time))
        f = space.gathered(space.forces(s.reshape(space.cells, space.per_cell, NUMBERS))[0])
        f -= boundaries.loads(self, self.stage, self.time)
        if self.dashpots:
            f -= boundaries.held(self)
        return f

    def _at(self, number, local, value):
        """Adds to one unknown, by its global number, on its owner; ghosts follow."""
        space = self.space
        if space.first <= number < space.first + space.owned:
            local[number - space.first] += value
        local[:] = space.spread(local[:space.owned])

    def run(self, until=None, steps=None):
        """All stages from the present one on; steps: ends after so many of them."""
        made = 0
        while self.stage_number < len(self.scene.stages):
            stage = self.scene.stages[self.stage_number]
            if not getattr(self, "resumed", False):
                self.begin_stage(stage)
                self.controller = control.Controller(self, stage)
            self.resumed = False
            end = self.begun + stage.duration
            while end - self.time > LEAST_STEP*stage.duration:
                self.step(stage, end)
                made += 1
                for watch in self.watchers:
                    watch(self, stage)
                if steps is not None and made >= steps:
                    return
            self.time = end
            if stage.zero_displacements == "yes":
                self.x[self.space.is_u] = 0.0
                self.v[:], self.a[:], self.points.rate0[:] = 0.0, 0.0, 0.0
            self.stage_number += 1

    def step(self, stage, end):
        """One accepted step, cut where it must be."""
        cuts = 0
        while True:
            dt = self.controller.next(self.time, end)
            if dt < LEAST_STEP*stage.duration or cuts > stage.cuts:
                raise Stopped(f"stage {stage.name}, time {self.time:.6g} s: no step of {dt:.3g} s goes through: {why}")
            scheme = Scheme(stage.analysis, self.rho_inf, dt, begins=self.controller.fresh == 0)
            self.controller.move_rates(scheme)
            try:
                iterations, x1, v1, a1 = self._newton(scheme)
            except (NotConverged, NotSolved, Refused) as reason:
                why, cuts = str(reason), cuts + 1
                self.counts["cuts"] += 1
                self.controller.cut(dt)
                self.tell(f"   stage {stage.name}, time {self.time + dt:.6g} s: cut: {why}")
                continue
            if not self.controller.stands(scheme, x1, v1, a1):
                self.counts["rejected"] += 1
                continue
            break
        self._refuse_tension(x1, self.time + dt)
        self.controller.accept(scheme, x1, v1, a1)
        self.points.accept(scheme.first_order(self.points.s0, self.points.rate0, self.points.s1))
        self.x, self.v, self.a = x1, v1, a1
        self.time = end if abs(end - self.time - dt) < LEAST_STEP*stage.duration else self.time + dt
        self.dt, self.step_iterations = dt, iterations
        self.counts["steps"] += 1
        self.tell(f"{stage.name}: time {self.time:.6g} s, step {dt:.3g} s, {iterations} iterations, "
                  f"{self.solver.iterations - self.counts['linear_iterations']} of the linear solver")
        self.counts["linear_iterations"] = self.solver.iterations

    def _refuse_tension(self, x, time):
        """Ends the run, on every rank, where saturated water would be in tension."""
        if not self.scene.has_water or self.scene.air_at_rest:
            return
        space = self.space
        own = space.of_p[space.of_p < space.owned]
        places = space.places_p[space.of_p < space.owned]
        low = (float(x[own].min()), *places[x[own].argmin()]) if len(own) else (np.inf, 0.0, 0.0, 0.0)
        value, *place = min(self.comm.allgather(low))
        if value < -TENSION:
            raise Stopped(
                f"t {time:.6g} s: the pressure of the water falls to {value:.4g} kPa at "
                f"({', '.join(f'{c:.4g}' for c in place[:space.dimension])}); the fields 'u-p_w' know saturated soil "
                "only. Begin at a pressure of the water that leaves none, or take the fields 'u-p_w-p_c' with air at "
                "rest (&fix group = 'all' field = 'p_a')")

    def _newton(self, scheme):
        space, points, ground, held = self.space, self.points, self.ground, self.constraints
        n, shape = points.n, (space.cells, space.per_cell, NUMBERS)
        time = self.time + scheme.dt
        held.before = self.x
        target = self.x.copy()
        held.prescribe(target, time, self.x_stage, scheme, self.v, self.a)
        f0, f1 = (boundaries.loads(self, self.stage, t) for t in (self.time, time))
        load = between(f0, f1, scheme.l_f)
        weight = between(self.gravity_at(self.time), self.gravity_at(time), scheme.l_f)
        plates = self.plates_now(scheme, self.a, self.time, time)
        incoming = boundaries.incoming(self, scheme, self.time, time)
        begin = space.numbers(self.x)[0].reshape(n, NUMBERS)
        start = balances.start_numbers(points, ground, begin, weight)
        f_start = space.forces(start.reshape(shape))[0]
        full = space.norm(space.gathered(np.abs(f_start)), space.is_u)
        self.largest["u"] = max(self.largest["u"], full)
        free = ~held.held
        free_u, free_p = free & space.is_u, free & ~space.is_u
        floor_p = 0.0

        def assess(x, present=False):
            """Residual (reduced), its scales, J, at a guess."""
            nonlocal floor_p
            v1, a1 = scheme.rates(space, self.x, self.v, self.a, x)
            level = np.where(space.is_u, scheme.l_v, scheme.l_p)
            vl, al = self.v + level*(v1 - self.v), between(self.a, a1, scheme.l_a)
            end, velocity, acceleration = (array.reshape(n, NUMBERS) for array in space.numbers(x, vl, al))
            points.update(end[:, STRAIN] - begin[:, STRAIN], ground.suction(end[:, PRESSURE])[0], present)
            s, J = balances.evaluate(points, ground, scheme, begin, end, velocity, acceleration, velocity, weight)
            change, flux, volume = s.copy(), np.zeros_like(s), np.zeros_like(s)
            change[:, :9] -= start[:, :9]
            change[:, GRADIENT] = 0.0
            flux[:, GRADIENT] = s[:, GRADIENT]
            parts = [change.reshape(shape), flux.reshape(shape)]
            if ground.wet and scheme.kind != STATIC:
                volume[:, PRESSURE] = np.abs(velocity[:, STRAIN] @ M)
                k, _ = ground.conductivity(points.s1)
                volume[:, GRADIENT] = -k[:, None]*ground.rho_w*weight
                parts.append(volume.reshape(shape))
            forces = space.forces(*parts)
            d = space.dimension*space.nodes_u.shape[1]
            total = forces[0] + forces[1]
            total[:, :d] += f_start[:, :d]
            sizes = np.abs(forces[0]) + np.abs(forces[1])
            r = space.gathered(total) - load - self.flow0*(scheme.kind != STATIC)
            size = space.gathered(sizes) + np.abs(f1 - f0)
            for dofs, blocks in self.dashpots:
                r += space.gathered(np.einsum("cij,cj->ci", blocks, vl[dofs]), dofs)
            if self.dashpots:
                r -= boundaries.held(self) + incoming
            for master, force, _, mass in plates:
                own = space.first <= master < space.first + space.owned
                al_master = self.comm.allreduce(float(al[master - space.first]) if own else 0.0)
                self._at(master, r, mass*al_master*(scheme.kind == DYNAMIC) - force)
                self._at(master, size, abs(force) + abs(mass*al_master))
            if len(parts) > 2 and floor_p == 0.0:
                floor_p = 1e-4*space.norm(space.gathered(np.abs(forces[2])), free_p)
            return held.reduced(r), held.reduced(size), J, v1, a1

        def errors(r, size):
            scales = []
            for which, key, floor in ((free_u, "u", 0.0), (free_p, "p", floor_p)):
                scale = space.norm(size, which)
                least = max(1e-6, 1e-13/self.tolerance)*self.largest[key]
                self.largest[key] = max(self.largest[key], scale)
                scales.append(max(scale, least, floor, 1e-12))
            return max(space.norm(r, free_u)/scales[0], space.norm(r, free_p)/scales[1])

        x, present = self.x.copy(), True
        if scheme.kind == DYNAMIC:
            u = space.is_u
            x[u] += scheme.dt*self.v[u] + 0.5*scheme.dt**2*self.a[u]
            x[~u] += scheme.dt*self.v[~u]
            present = False
        try:
            r, size, J, v1, a1 = assess(x, present)
        except Refused:
            x = self.x.copy()
            r, size, J, v1, a1 = assess(x, True)
        error = np.inf
        for iteration in range(1, int(self.stage.max_iterations) + 1):
            more = [(dofs, scheme.l_v*scheme.velocity_slope*blocks) for dofs, blocks in self.dashpots]
            self.solver.set(J.reshape(space.cells, space.per_cell, NUMBERS, NUMBERS), more,
                            [(master, inertia) for master, _, inertia, _ in plates if inertia],
                            points.tangent)
            lift = np.where(held.fixed, target - x, 0.0)
            right = -r - held.reduced(self.solver.lifted(lift))
            step = self.solver.solve(right) + lift
            self.counts["iterations"] += 1
            share = 1.0
            for search in range(self.options.searches + 1):
                try:
                    r, size, J, v1, a1 = assess(x + share*step)
                    new = errors(r, size)
                    better = new <= max((1.0 - 1e-4*share)*error, self.tolerance)
                    if np.isfinite(new) and (iteration == 1 or better):
                        break
                except Refused:
                    if iteration == 1:
                        raise
                self.counts["searches"] += 1
                share *= 0.5
            else:
                raise NotConverged("line search")
            x, error = x + share*step, new
            if error <= self.tolerance and share == 1.0:
                self.residual = r
                return iteration, x, v1, a1
        raise NotConverged(f"{iteration} iterations, error {error:.2g}")

    def tell(self, text):
        if self.options.told and self.comm.rank == 0:
            print(text, flush=True)
