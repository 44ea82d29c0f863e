# SPDX-License-Identifier: MIT
"""Histories, fields and checkpoints of a run."""
import csv
import json
import os
import pathlib

import numpy as np
from petsc4py import PETSc

from .scene import SceneError


class Histories:
    """histories.csv with the columns of mud_host, reactions.csv with the forces of supports, as of the whole body."""

    def __init__(self, run, folder):
        self.run, space = run, run.space
        run.comm.barrier()
        self.places = []
        for point in run.scene.points:
            target = np.zeros(space.dimension)
            target[0], target[run.up] = point.r, point.z
            if space.dimension == 3:
                target[1] = point.y
            self.places.append((point.name, *self._nearest(target)))
        self.file = None
        if run.comm.rank == 0:
            folder.mkdir(parents=True, exist_ok=True)
            self.file = open(folder/"histories.csv", "w", newline="")
            self.writer = csv.writer(self.file)
            names = [f"{name}.{column}" for name, *_ in self.places for column in self._columns()]
            self.writer.writerow(["time", "dt", *names])
            self.reactions = open(folder/"reactions.csv", "w", newline="")
        self.last_stage = None

    def _columns(self):
        axes = ("r", "z") if self.run.space.dimension == 2 else ("r", "y", "z")
        columns = [f"{kind}_{a}" for kind in "uva" for a in axes]
        if self.run.scene.has_water:
            columns += ["p_w"] + ["p_c"]*self.run.scene.air_at_rest
        return columns + ["s_rr", "s_zz", "s_tt", "s_rz", "e", "S_w"]

    def _nearest(self, target):
        """Local node of u, of p, point: each with the rank that has it."""
        space, comm = self.run.space, self.run.comm
        d = space.dimension
        found = []
        own_u, own_p = space.own_u//d, space.own_p
        for places in (space.places_u[:own_u, :d], space.places_p[:own_p, :d], space.places.reshape(-1, d)):
            away = np.linalg.norm(places - target, axis=1)
            near = int(away.argmin()) if len(away) else -1
            least = comm.allgather(round(float(away[near]), 12) if len(away) else np.inf)
            found.append((near, int(np.argmin(least))))
        return found

    def __call__(self, run, stage):
        if run.counts["steps"] % int(stage.every):
            return
        space, row = run.space, [repr(run.time), repr(run.dt)]
        p_of = run.points
        for _, (u, who_u), (p, who_p), (point, who) in self.places:
            if run.comm.rank == who_u:
                at = space.of_u[u]
                mine = [*run.x[at], *run.v[at], *run.a[at]]
            row += run.comm.bcast(mine if run.comm.rank == who_u else None, who_u)
            if run.scene.has_water:
                value = run.comm.bcast(float(run.x[space.of_p[p]]) if run.comm.rank == who_p else None, who_p)
                row += [value] + [-value]*run.scene.air_at_rest
            if run.comm.rank == who:
                s = p_of.stress0[point]
                two = space.dimension == 2
                mine = [s[0], s[1 if two else 2], s[2 if two else 1], s[3 if two else 4]]
                mine += [p_of.e0[point], p_of.s0[point]]
            row += run.comm.bcast(mine if run.comm.rank == who else None, who)
        forces = self._reactions(run)
        if self.file:
            self.writer.writerow([x if isinstance(x, str) else repr(float(x)) for x in row])
            self.file.flush()
            if self.last_stage != stage.name:
                self.reactions.write(",".join(["time", *forces]) + "\n")
            self.reactions.write(",".join([repr(run.time), *map(repr, forces.values())]) + "\n")
            self.reactions.flush()
        self.last_stage = stage.name

    def _reactions(self, run):
        """Force of the supports on the body, outflow through prescribed pressures, of the whole body."""
        found, space = {}, run.space
        for fix, unknowns in run.constraints.groups:
            own = unknowns[unknowns < space.owned]
            total = run.comm.allreduce(float(run.residual[own].sum()))/run.share
            name = f"{fix.group}.outflow_w" if fix.field == "p_w" else f"{fix.group}.force_{fix.field[-1]}"
            found[name] = -total if fix.field == "p_w" else total
        return found


class Fields:
    """results.xdmf for ParaView, at the end of a stage and every `fields` steps."""

    def __init__(self, run, folder):
        if run.comm.rank == 0:
            folder.mkdir(parents=True, exist_ok=True)
        run.comm.barrier()
        self.writer, self.stage = run.space.mesh.writer(str(folder/"results.xdmf")), None
        self.write(run)

    def __call__(self, run, stage):
        over = abs(run.begun + stage.duration - run.time) < 1e-12*stage.duration
        if over or (stage.fields and run.counts["steps"] % int(stage.fields) == 0):
            self.write(run)

    def write(self, run):
        space, points = run.space, run.points
        corners = space.mesh.corners.shape[1]
        d = space.dimension
        u = run.x[space.of_u[space.nodes_u[:, :corners]]]
        u = np.concatenate([u, np.zeros((*u.shape[:2], 3 - d))], 2)
        at = {"u": u}
        if run.scene.has_water:
            at["p_w"] = run.x[space.of_p[space.nodes_p[:, :corners]]][..., None]
        weights = space.weights/space.weights.sum(1, keepdims=True)
        shape = (space.cells, space.per_cell)
        cells = {f"s_{name}": (points.stress0[:, i].reshape(shape)*weights).sum(1, keepdims=True)
                 for i, name in enumerate(("11", "22", "33", "12", "13", "23"))}
        cells["e"] = (points.e0.reshape(shape)*weights).sum(1, keepdims=True)
        cells["S_w"] = (points.s0.reshape(shape)*weights).sum(1, keepdims=True)
        self.writer.write(run.time, at, cells)


# Checkpoints hold what every cell has, by the number it had before the mesh was distributed: they do not know ranks.
def _data(run):
    space = run.space
    nodes = [field[space.dofs] for field in (run.x, run.v, run.a, run.x_stage)]
    return np.concatenate([*nodes, run.points.kept().reshape(space.cells, -1)], 1)


def _places(run, width):
    space = run.space
    vector = PETSc.Vec().createMPI(space.mesh.cells_of_all*width, bsize=width, comm=run.comm)
    return vector, PETSc.IS().createBlock(width, space.mesh.original.astype(PETSc.IntType), run.comm)


def save(run, path):
    """Writes a checkpoint; complete under its name, or not there."""
    data = _data(run)
    vector, places = _places(run, data.shape[1])
    local = PETSc.Vec().createWithArray(np.ascontiguousarray(data).ravel(), comm=PETSc.COMM_SELF)
    PETSc.Scatter().create(local, None, vector, places).scatter(local, vector)
    vector.assemble()
    path = str(path)
    viewer = PETSc.Viewer().createBinary(path + ".part", "w", run.comm)
    vector.view(viewer)
    viewer.destroy()
    run.comm.barrier()
    if run.comm.rank == 0:
        told = {"time": run.time, "begun": run.begun, "stage": run.stage_number, "counts": run.counts,
                "controller": run.controller.kept(), "cells": run.space.mesh.cells_of_all, "width": data.shape[1]}
        pathlib.Path(path + ".json").write_text(json.dumps(told))
        os.replace(path + ".part", path)
    run.comm.barrier()


def load(run, path):
    """Goes on from a checkpoint, with any number of ranks."""
    path = str(path)
    told = json.loads(pathlib.Path(path + ".json").read_text())
    space = run.space
    width = space.dofs.shape[1]*4 + run.points.kept().shape[1]*space.per_cell
    if told["cells"] != space.mesh.cells_of_all or told["width"] != width:
        raise SceneError(f"{path}: the checkpoint is of another mesh or other fields")
    vector, places = _places(run, width)
    vector.load(PETSc.Viewer().createBinary(path, "r", run.comm))
    local = PETSc.Vec().createSeq(space.cells*width)
    PETSc.Scatter().create(vector, places, local, None).scatter(vector, local)
    data = local.array.reshape(space.cells, width)
    n = space.dofs.shape[1]
    fields = []
    for i in range(4):
        field = np.zeros(space.size)
        field[space.dofs.ravel()] = data[:, i*n:(i + 1)*n].ravel()
        fields.append(_agreed(space, field))
    x, v, a, x_stage = fields
    run.points.take(data[:, 4*n:].reshape(run.points.n, -1))
    from .control import Controller
    run.stage_number, run.time = told["stage"], told["begun"]
    run.x, run.v, run.a = x_stage.copy(), v, a
    stage = run.scene.stages[run.stage_number]
    absorbs = any(run.scene.acts(entry, stage) for entry in run.scene.absorbings)
    if stage.analysis == "dynamic" and absorbs and run.time < told["time"]:
        raise SceneError(f"{path}: it lies within a stage with &absorbing, whose ground is that of the start of the "
                         "stage: such a stage is not taken up again")
    run.begin_stage(stage)
    run.controller = Controller(run, stage)
    run.x, run.v, run.a, run.time, run.counts = x, v, a, told["time"], told["counts"]
    for name, value in told["controller"].items():
        setattr(run.controller, name, value)
    run.controller.known = False  # the rates before it are not in a checkpoint
    run.resumed = True


def _agreed(space, field):
    """The value of the owner; that of a rank with a cell where the owner has none."""
    seen = np.zeros(space.size)
    seen[space.dofs.ravel()] = 1.0
    own = seen[:space.owned] > 0
    mean = space.summed(field*seen)/np.maximum(space.summed(seen), 1.0)
    return space.spread(np.where(own, field[:space.owned], mean[:space.owned]))
