# SPDX-License-Identifier: MIT
"""Runs a scene: python3 -m mud3d SCENE.nml --output FOLDER, alone or under mpirun."""
import argparse
import json
import pathlib
import sys
import time

import petsc4py

petsc4py.init(sys.argv)  # options of PETSc from the command line
from mpi4py import MPI

import mud

from . import output
from .engine import Options, Run, Stopped
from .laws import Refused
from .scene import Scene, SceneError


def arguments():
    parser = argparse.ArgumentParser(prog="mud3d", description=__doc__)
    parser.add_argument("scene")
    parser.add_argument("--output", default="output", help="folder of the results")
    parser.add_argument("--check", action="store_true", help="reads the scene and makes the mesh, no more")
    parser.add_argument("--thickness", type=float, default=0.0, help="of a plane scene, which is then solid [m]")
    parser.add_argument("--layers", type=int, default=1, help="of cells across the thickness or the sector")
    parser.add_argument("--sector", type=float, default=5.0, help="of a scene about an axis [degrees]")
    parser.add_argument("--cells", default="", help="triangles, quadrilaterals, tetrahedra or hexahedra")
    parser.add_argument("--linear", choices=("mumps", "amg"), default="mumps")
    parser.add_argument("--linear-tolerance", type=float, default=1e-8)
    parser.add_argument("--lanes", action="store_true", help="points of MUD side by side, eight at a time")
    parser.add_argument("--checkpoint", help="file, written every checkpoint_steps of the scene and at the end")
    parser.add_argument("--restart", help="checkpoint to go on from")
    parser.add_argument("--stop-after", type=int, help="number of steps after which to end")
    parser.add_argument("--no-fields", action="store_true", help="no results.xdmf")
    parser.add_argument("--quiet", action="store_true")
    return parser.parse_known_args()[0]


def abort_all(*problem):
    """An exception on one rank would leave the others waiting."""
    sys.__excepthook__(*problem)
    sys.stderr.flush()
    MPI.COMM_WORLD.Abort(1)


def main():
    comm, given = MPI.COMM_WORLD, arguments()
    began = time.monotonic()
    try:
        run = Run(comm, Scene(given.scene), Options(given.thickness, given.layers, given.sector, given.cells,
                                                    given.linear, given.linear_tolerance, told=not given.quiet,
                                                    lanes=given.lanes))
        folder = pathlib.Path(given.output)
        if given.check:
            run.tell(f"{run.space.mesh.cells_of_all} cells, {comm.allreduce(run.space.owned)} unknowns: in order")
            return 0
        if given.restart:
            output.load(run, given.restart)
        run.watchers.append(output.Histories(run, folder))
        if not given.no_fields:
            run.watchers.append(output.Fields(run, folder))
        every = int(run.scene.scene.checkpoint_steps)
        if given.checkpoint and every:
            run.watchers.append(lambda run, stage: run.counts["steps"] % every or output.save(run, given.checkpoint))
        run.run(steps=given.stop_after)
        if given.checkpoint:
            output.save(run, given.checkpoint)
    except (SceneError, mud.InputError) as problem:
        if comm.rank == 0:
            print(f"mud3d: {problem}", file=sys.stderr)
        return 2
    except (Stopped, Refused) as problem:
        if comm.rank == 0:
            print(f"mud3d: {problem}", file=sys.stderr)
        return 14
    unknowns, points = comm.allreduce(run.space.owned), comm.allreduce(run.points.n)
    if comm.rank == 0:
        told = {"ranks": comm.size, "unknowns": unknowns, "points": points, "seconds": time.monotonic() - began,
                **run.counts}
        (folder/"run.json").write_text(json.dumps(told, indent=1) + "\n")
    run.tell(f"{unknowns} unknowns, {points} points, {run.counts['steps']} steps, "
             f"{run.counts['iterations']} iterations, {run.counts['cuts']} cuts, {time.monotonic() - began:.1f} s")
    return 0


if __name__ == "__main__":
    sys.excepthook = abort_all
    sys.exit(main())
