# SPDX-License-Identifier: MIT
"""One matrix, one solution, every point once: the first iteration of a step of 2 mm of footing.py's footing, and the
processor seconds of its parts, the largest of all ranks.

scaling.py CELLS even|graded SECONDS RESULT: appends a line of JSON. SECONDS: of the step; in a short one no water
leaves.
Processor time can be told on a machine that others use too; a rank that waits in MPI burns it as well.
"""
import json
import pathlib
import resource
import sys
import tempfile
import time

import petsc4py

petsc4py.init(sys.argv)
from mpi4py import MPI

import footing
from mud3d import engine, linear
from mud3d.scene import Scene

spent = dict.fromkeys(("points", "assembly", "solver"), 0.0)


def timed(part, owner, name):
    action = getattr(owner, name)

    def call(*arguments, **more):
        began = time.process_time()
        try:
            return action(*arguments, **more)
        finally:
            spent[part] += time.process_time() - began
    setattr(owner, name, call)


def main(cells, mesh, seconds, result, kind="amg"):
    comm = MPI.COMM_WORLD
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)/"scene.nml"
        path.write_text(footing.scene(int(cells), mesh == "graded", float(seconds), 0.002, 1, tolerance=1e-12,
                                      stage="cuts = 0").replace("max_iterations = 30", "max_iterations = 1"))
        run = engine.Run(comm, Scene(path), engine.Options(linear=kind, told=False))
    timed("points", engine.Points, "update")
    timed("assembly", linear.Solver, "set")
    timed("solver", linear.Solver, "solve")
    try:
        run.run()
    except engine.Stopped:
        pass
    largest = {part: round(max(comm.allgather(value)), 2) for part, value in spent.items()}
    row = {"ranks": comm.size, "mesh": mesh, "seconds": float(seconds), "linear": kind,
           "unknowns": comm.allreduce(run.space.owned), "points_number": comm.allreduce(run.points.n),
           "iterations": run.solver.iterations, **largest,
           "megabytes": max(comm.allgather(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss//1024))}
    if comm.rank == 0:
        print(json.dumps(row))
        with open(result, "a") as file:
            file.write(json.dumps(row) + "\n")


if __name__ == "__main__":
    main(*[a for a in sys.argv[1:6] if not a.startswith("-")])
