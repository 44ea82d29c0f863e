# SPDX-License-Identifier: MIT
"""A footing on saturated MUD sand: a quarter of a square one in three dimensions, or half a strip in plane strain.

The sand begins at an even effective stress, held by a surcharge; p_w, counted from the back pressure, is 0 at the top,
the other sides are closed and on rollers. The square footing is smooth, rigid and pushed; the strip is a pressure
beside the axis. Example:
   mpirun -n 2 python3 footing.py --cells 6 --settlement 0.02 --steps 10 --result footing.json
"""
import argparse
import json
import sys
import time

import numpy as np
import petsc4py
petsc4py.init(sys.argv)  # options of PETSc from the command line
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py import PETSc

import mud
import porous

HALF_WIDTH, SIZE = 0.5, 4.0  # of the footing, of the ground [m]
SURCHARGE = 50.0             # [kPa], also the effective stress at the start


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--strip", action="store_true", help="plane strain under a pressure")
    parser.add_argument("--cells", type=int, default=6,
                        help="along an edge; divisible by 3: a third lies under the footing")
    parser.add_argument("--scale", type=float, default=1.0, help="of footing and ground")
    parser.add_argument("--settlement", type=float, default=0.02, help="of the square footing [m]")
    parser.add_argument("--pressure", type=float, default=150.0, help="of the strip [kPa]")
    parser.add_argument("--back-pressure", type=float, default=0.0, help="of the water at the start [kPa]")
    parser.add_argument("--steps", type=int, default=10)
    parser.add_argument("--duration", type=float, default=100.0, help="[s]")
    parser.add_argument("--void-ratio", type=float, default=0.75)
    parser.add_argument("--scheme", type=int, default=1, help="integration scheme of MUD, 1 to 3")
    parser.add_argument("--linear", choices=("mumps", "amg"), default="mumps")
    parser.add_argument("--tolerance", type=float, default=1.0e-9)
    parser.add_argument("--save", help="checkpoint written after every step")
    parser.add_argument("--load", help="checkpoint to go on from")
    parser.add_argument("--stop-after", type=int, help="step after which to end")
    parser.add_argument("--record", help="writes the increment of every point in the last step, by number of the cell")
    parser.add_argument("--result", help="JSON file")
    return parser.parse_known_args()[0]


def abort_all(*problem):
    """An exception on one rank would leave the others waiting."""
    sys.__excepthook__(*problem)
    sys.stderr.flush()
    MPI.COMM_WORLD.Abort(1)


def graded(x):
    """From the unit interval to the ground: a third of the cells under the footing, then ever larger ones."""
    beyond = np.clip((x - 1/3)*1.5, 0.0, None)
    slope = 2.0*HALF_WIDTH  # of the even part, per unit of `beyond`
    return np.where(x <= 1/3, 3.0*HALF_WIDTH*x, HALF_WIDTH + slope*beyond + (SIZE - HALF_WIDTH - slope)*beyond**2)


def ground(dimension, n, scale):
    comm = MPI.COMM_WORLD
    if dimension == 2:
        domain = mesh.create_unit_square(comm, n, n)
    else:
        domain = mesh.create_unit_cube(comm, n, n, n)
    x = domain.geometry.x
    for i in range(dimension - 1):
        x[:, i] = graded(x[:, i])
    x[:, dimension - 1] = -graded(1.0 - x[:, dimension - 1])  # the top is 0
    x *= scale
    return domain


def model(given):
    half_width, size = HALF_WIDTH*given.scale, SIZE*given.scale
    dimension = 2 if given.strip else 3
    domain = ground(dimension, given.cells, given.scale)
    material = mud.Material(scheme=given.scheme)
    control = porous.Control(linear=given.linear, tolerance=given.tolerance)
    problem = porous.Problem(domain, material, [-SURCHARGE]*3 + [0.0]*3, given.void_ratio,
                             water=porous.Water(at_rest=given.back_pressure), control=control)
    up, facet = dimension - 1, dimension - 1
    domain.topology.create_connectivity(facet, dimension)

    def near(axis, value):
        return lambda x: np.isclose(x[axis], value)

    def under(x):
        inside = np.isclose(x[up], 0.0)
        for i in range(up):
            inside &= x[i] <= half_width*(1.0 + 1e-9)
        return inside

    sides = [(i, near(i, v)) for i in range(up) for v in (0.0, size)] + [(up, near(up, -size))]
    bcs = []
    for axis, where in sides:
        facets = mesh.locate_entities_boundary(domain, facet, where)
        dofs = fem.locate_dofs_topological(problem.V.sub(axis), facet, facets)
        bcs.append(fem.dirichletbc(PETSc.ScalarType(0), dofs, problem.V.sub(axis)))
    top = mesh.locate_entities_boundary(domain, facet, near(up, 0.0))
    bcs.append(fem.dirichletbc(PETSc.ScalarType(0), fem.locate_dofs_topological(problem.Q, facet, top), problem.Q))
    footing = mesh.locate_entities_boundary(domain, facet, under)
    plate = fem.locate_dofs_topological(problem.V, facet, footing)
    pushed = fem.Constant(domain, PETSc.ScalarType(0))
    tags = np.full(len(top), 1, np.int32)
    tags[np.isin(top, footing)] = 2
    order = np.argsort(top)
    ds = ufl.Measure("ds", domain, subdomain_data=mesh.meshtags(domain, facet, top[order], tags[order]))
    load = fem.Constant(domain, PETSc.ScalarType(0))
    problem.external(lambda v: -SURCHARGE*v[up]*ds((1, 2)) - load*v[up]*ds(2))
    if not given.strip:
        dofs = fem.locate_dofs_topological(problem.V.sub(up), facet, footing)
        bcs.append(fem.dirichletbc(pushed, dofs, problem.V.sub(up)))
    problem.bcs = bcs

    def set_boundary(now):
        pushed.value = -given.settlement*now/given.duration
        load.value = given.pressure*now/given.duration if given.strip else 0.0

    return problem, set_boundary, plate, up


def at_axis(problem, field, component, depth):
    """Value of a field at the vertex on the axis that is nearest to a depth."""
    x = field.function_space.tabulate_dof_coordinates()
    owned = field.function_space.dofmap.index_map.size_local
    target = np.zeros(3)
    target[problem.dimension - 1] = -depth
    distance = np.linalg.norm(x[:owned] - target, axis=1) if owned else np.array([np.inf])
    near = int(np.argmin(distance))
    size = field.function_space.dofmap.bs
    value = float(field.x.array[near*size + component]) if owned else 0.0
    return min(problem.comm.allgather((float(distance[near]), value)))[1]


def record(path, problem, before):
    """Last increment of every point: stress, state, strain before, and the state after, ordered by cell."""
    stress, state, strain = before
    numbers = problem.mesh.topology.original_cell_index[:problem.cells]
    parts = problem.comm.gather((numbers, *(a.reshape(problem.cells, -1) for a in
                                            (stress, state, strain, problem.stress0, problem.state0))))
    if problem.comm.rank == 0:
        numbers, *arrays = (np.concatenate(part) for part in zip(*parts))
        order = np.argsort(numbers)
        np.savez(path, **{name: array[order] for name, array in zip(
            ("stress", "state", "strain", "new_stress", "new_state"), arrays)}, props=problem.material.props)


def main():
    sys.excepthook = abort_all
    given = arguments()
    began = time.monotonic()
    problem, set_boundary, plate, up = model(given)
    if given.load:
        problem.load(given.load)
    area = (HALF_WIDTH*given.scale)**(problem.dimension - 1)
    first = round(problem.time/given.duration*given.steps) + 1
    loads = []
    solving = time.monotonic()
    for step in range(first, (given.stop_after or given.steps) + 1):
        before = (problem.stress0.copy(), problem.state0.copy())
        problem.step(given.duration*step/given.steps, set_boundary)
        loads.append(-problem.reaction(plate, up)/area)
        if given.save:
            problem.save(given.save)
    solved = time.monotonic()
    if given.record:  # the last step alone, if it was not cut
        record(given.record, problem, (*before, problem.last_strain))
    unknowns = sum(space.dofmap.index_map.size_global*space.dofmap.index_map_bs for space in (problem.V, problem.Q))
    row = {"ranks": problem.comm.size, "unknowns": unknowns,
           "points": problem.comm.allreduce(len(problem.stress0)), "pressure": loads,
           "settlement": -at_axis(problem, problem.u, up, 0.0),
           "p_w": at_axis(problem, problem.p, 0, HALF_WIDTH*given.scale),
           "digest": problem.digest(), "seconds": solved - solving, "seconds_before": solving - began, **problem.counts}
    if problem.comm.rank == 0:
        print(json.dumps(row))
        if given.result:
            with open(given.result, "w") as file:
                json.dump(row, file, indent=3)


if __name__ == "__main__":
    main()
