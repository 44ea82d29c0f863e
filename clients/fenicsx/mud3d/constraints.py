# SPDX-License-Identifier: MIT
"""What holds unknowns in a stage: prescribed values, ties, plates, planes of symmetry.

All unknowns follow from those that are free, x = P y + g. A tied unknown is a share of its master; what fixes one
member of a tie fixes all.
"""
import numpy as np
from petsc4py import PETSc

from .balances import DYNAMIC, STATIC
from .scene import SceneError


class Constraints:
    def __init__(self, space, scene, stage, sector, thick):
        self.space, self.scene, self.stage, self.sector = space, scene, stage, np.radians(sector)
        d = space.dimension
        self.axis = {"u_r": 0, "u_z": d - 1, "u_y": 1}
        self.values = []  # (local unknowns, what gives their value at a time)
        self.accelerated = []
        self.groups = []  # (fix, local unknowns): whose reactions are told
        pairs = [self._tie(tie) for tie in scene.ties] + [self._plate(plate) for plate in scene.plates]
        pairs = [pair for pair in pairs if pair is not None]
        self.slaves, self.masters = (np.concatenate(part) if pairs else np.zeros(0, int) for part in
                                     (zip(*pairs) if pairs else ((), ())))
        marked = np.zeros(space.size, bool)
        if sector:
            self._symmetry(marked)
        elif thick:
            for side in ("front", "back"):
                self._hold(space.of_u[space.nodes_of(side, 2), 1], marked)
        for fix in scene.fixs:
            if scene.acts(fix, stage) and fix.field != "p_a":
                self._fix(fix, marked)
        if stage.analysis == STATIC and scene.has_water:
            self._hold(space.of_p, marked, keep=True)
        self.fixed = self.spread_over_ties(marked)
        self._matrix()

    def _hold(self, unknowns, marked, keep=False):
        marked[unknowns] = True
        self.values.append((unknowns, None if keep else (lambda time: 0.0)))

    def _symmetry(self, marked):
        """Sector about an axis: no motion across its sides, none along r at the axis."""
        space, slope = self.space, np.tan(self.sector)
        front, back = space.nodes_of("front", 2), space.nodes_of("back", 2)
        self._hold(space.of_u[front, 1], marked)
        axis = np.hypot(*space.places_u[:, :2].T) < 1e-9*np.abs(space.places_u).max()
        self._hold(space.of_u[axis][:, :2].ravel(), marked)
        back &= ~axis
        self.oblique = space.of_u[back]
        self.slope = slope

    def _fix(self, fix, marked):
        space, scene = self.space, self.scene
        group = next((p.group for p in scene.plates if p.name == fix.group), fix.group)
        pressure = fix.field == "p_w"
        nodes = space.nodes_of(group, 1 if pressure else 2)
        height = (space.places_p if pressure else space.places_u)[nodes][:, space.dimension - 1]
        unknowns = space.of_p[nodes] if pressure else space.of_u[nodes, self.axis[fix.field]]
        self.groups.append((fix, unknowns))
        if self.sector and fix.field == "u_r":
            if fix.value or fix.value_slope:
                raise SceneError("&fix field = 'u_r' of a sector: only the value 0 is carried")
            unknowns, height = space.of_u[nodes][:, :2].ravel(), np.repeat(height, 2)
        marked[unknowns] = True
        amount = fix.value + fix.value_slope*(height - fix.datum)
        if fix.motion == "acceleration":
            self.accelerated.append((unknowns, lambda time: amount*scene.factor(fix.history, time)))
            self.values.append((unknowns, None))
        elif fix.hold == "yes":
            self.values.append((unknowns, None))
        else:
            self.values.append((unknowns, lambda time: amount*scene.factor(fix.history, time)))

    def _everyone(self, nodes, axis):
        """Places and global numbers of the owned ones of these nodes, of all ranks."""
        space = self.space
        own = np.nonzero(nodes)[0]
        own = own[own < space.own_u//space.dimension]
        found = space.comm.allgather((space.places_u[own], space.everywhere[space.of_u[own, axis]]))
        return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])

    def _plate(self, plate):
        """Nodes of a plate follow the one with the smallest number."""
        _, numbers = self._everyone(self.space.nodes_of(plate.group, 2), self.space.dimension - 1)
        if not len(numbers):
            raise SceneError(f"&plate group = '{plate.group}': there is no such boundary")
        master = numbers.min()
        plate["master"] = int(master)
        others = numbers[numbers != master]
        return others, np.full(len(others), master)

    def _tie(self, tie):
        """Nodes of two sides at equal places along them share their displacement."""
        if tie.pressures == "yes":
            raise SceneError("&tie pressures = 'yes' is not carried by this program")
        space, along, pairs = self.space, range(1, self.space.dimension), []
        for axis in range(space.dimension):
            sides = [self._everyone(space.nodes_of(name, 2), axis) for name in (tie.first, tie.second)]
            order = [np.lexsort(np.round(places[:, along]/np.abs(places).max(), 9).T) for places, _ in sides]
            (one, of_one), (two, of_two) = ((p[o][:, along], n[o]) for (p, n), o in zip(sides, order))
            if len(one) != len(two) or not np.allclose(one, two):
                raise SceneError(f"&tie '{tie.first}', '{tie.second}': their nodes do not stand at equal places")
            pairs.append((of_two, of_one))
        return tuple(np.concatenate(part) for part in zip(*pairs))

    def _of_ties(self, one, local):
        """Entries of a local vector at unknowns of ties, on every rank."""
        here = (one >= self.space.first) & (one < self.space.first + self.space.owned)
        values = np.zeros(len(one))
        values[here] = local[one[here] - self.space.first]
        return self.space.comm.allreduce(values)

    def _put(self, one, values, local):
        here = (one >= self.space.first) & (one < self.space.first + self.space.owned)
        local[one[here] - self.space.first] = values[here]

    def spread_over_ties(self, marked):
        """Marks on unknowns, on ghosts and on all members of a tie that has one."""
        marked = self.space.summed(marked.astype(float)) > 0
        for one, other in ((self.slaves, self.masters), (self.masters, self.slaves)):
            hit = self._of_ties(one, marked) > 0  # the slaves first: then their masters reach all others
            self._put(other[hit], np.ones(int(hit.sum()), bool), marked)
            marked = self.space.spread(marked[:self.space.owned].astype(float)) > 0
        return marked

    def _matrix(self):
        """P, or None where nothing is tied; `held` marks unknowns that are not free."""
        space = self.space
        slaves = np.zeros(space.size, bool)
        rows = []
        here = (self.slaves >= space.first) & (self.slaves < space.first + space.owned)
        for slave, master in zip(self.slaves[here], self.masters[here]):
            if not self.fixed[slave - space.first]:
                rows.append((slave, master, 1.0))
        for unknowns in getattr(self, "oblique", ()):
            if unknowns[1] < space.owned and not self.fixed[unknowns[1]]:
                rows.append((space.everywhere[unknowns[1]], space.everywhere[unknowns[0]], self.slope))
        for slave, _, _ in rows:
            slaves[slave - space.first] = True
        self.held = self.fixed | (space.summed(slaves.astype(float)) > 0)
        #: global numbers of the rows that are no equations
        self.rows = space.everywhere[:space.owned][self.held[:space.owned]]
        self.P = None
        if space.comm.allreduce(len(rows)):
            total = space.comm.allreduce(space.owned)
            self.P = PETSc.Mat().createAIJ(((space.owned, total), (space.owned, total)), nnz=(2, 2), comm=space.comm)
            own = space.everywhere[:space.owned]
            diagonal = np.where(slaves[:space.owned], 0.0, 1.0)
            for i, value in zip(own, diagonal):  # zeros of the slaves keep a place in the product
                self.P.setValue(i, i, value)
            for slave, master, share in rows:
                self.P.setValue(slave, master, share)
            self.P.assemble()

    def prescribe(self, x, time, start, scheme=None, v=None, a=None):
        """Prescribed values at a time into the local vector x; start: values when the stage began."""
        for unknowns, value in self.values:
            x[unknowns] = start[unknowns] if value is None else value(time)
        if scheme is not None and scheme.kind == DYNAMIC:
            dt, b = scheme.dt, scheme.beta
            for unknowns, value in self.accelerated:
                new = value(time - (scheme.gamma - 0.5)*dt)
                x0 = self.before[unknowns]
                x[unknowns] = x0 + dt*v[unknowns] + dt**2*((0.5 - b)*a[unknowns] + b*new)
        if len(self.slaves):  # partners of what is prescribed
            known = self._of_ties(self.masters, self.fixed) > 0
            self._put(self.slaves[known], self._of_ties(self.masters, x)[known], x)
            x[:] = self.space.spread(x[:self.space.owned])

    def reduced(self, local):
        """P^T r of a local vector, ghosts right."""
        if self.P is None:
            return local
        space = self.space
        r, y = self.P.createVecLeft(), self.P.createVecRight()
        r.setArray(local[:space.owned])
        self.P.multTranspose(r, y)
        return space.spread(y.array)

    def full(self, owned):
        """P y of owned values, as a local vector."""
        space = self.space
        if self.P is None:
            return space.spread(owned)
        y, x = self.P.createVecRight(), self.P.createVecLeft()
        y.setArray(owned)
        self.P.mult(y, x)
        return space.spread(x.array)
