# SPDX-License-Identifier: MIT
"""Processor time of the parts of a footing's first steps, the largest of all ranks. Options are those of footing.py.

Processor time, not time on the clock: it can be told on a machine that others use too. A rank that waits for another in
MPI burns processor time as well, so that the parts hold what is lost by waiting. `--result` appends a line of JSON;
`--first` ends after the first iteration: one matrix, one solution, every point once.
"""
import json
import sys
import time

from dolfinx.fem import petsc as fem_petsc

import footing
import porous

spent = dict.fromkeys(("material", "assembly", "solver"), 0.0)


def timed(part, action):
    def call(*arguments, **more):
        began = time.process_time()
        try:
            return action(*arguments, **more)
        finally:
            spent[part] += time.process_time() - began
    return call


def main():
    sys.excepthook = footing.abort_all
    given = footing.arguments()
    problem, set_boundary, *_ = footing.model(given)
    problem.material.update_batch = timed("material", problem.material.update_batch)
    problem.material.tangent_batch = timed("material", problem.material.tangent_batch)
    fem_petsc.assemble_matrix_block = timed("assembly", fem_petsc.assemble_matrix_block)
    fem_petsc.assemble_vector_block = timed("assembly", fem_petsc.assemble_vector_block)
    problem._start()
    porous_solve = problem.ksp.solve

    class Timed:
        """The linear solver, with its time taken."""

        def __getattr__(self, name):
            return getattr(ksp, name)

        solve = staticmethod(timed("solver", porous_solve))

    ksp, problem.ksp = problem.ksp, Timed()
    steps = given.stop_after or given.steps
    first = "--first" in sys.argv
    if first:
        problem.control.iterations, problem.control.cuts, steps = 1, 0, 1
    for step in range(1, steps + 1):
        try:
            problem.step(given.duration*step/given.steps, set_boundary)
        except porous.NotConverged:
            if not first or problem.counts["iterations"] != 1:
                raise
    largest = {part: max(problem.comm.allgather(seconds)) for part, seconds in spent.items()}
    row = {"ranks": problem.comm.size, "linear": given.linear, "cells": given.cells,
           "unknowns": problem.A.getSize()[0], "points": problem.comm.allreduce(len(problem.stress0)),
           **{k: problem.counts[k] for k in ("iterations", "linear_iterations")},
           **{part: round(seconds, 3) for part, seconds in largest.items()}}
    if problem.comm.rank == 0:
        print(json.dumps(row))
        with open(given.result or "scaling.json", "a") as file:
            file.write(json.dumps(row) + "\n")


if __name__ == "__main__":
    main()
