# SPDX-License-Identifier: MIT
"""Ground with weight begins at its K_0 stress, then the surcharge grows: ground.py GIVEN.json --result RESULT.json

Plane strain under water: p_w is the excess over the hydrostatic pressure and the weight that of soil under water, so
that both begin in balance. The surcharge grows so slowly that no excess pressure is left.
"""
import json
import sys

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py import PETSc

import mud
import porous

with open(sys.argv[1]) as file:
    given = json.load(file)  # height [m], weight [kN/m3], k_0, surcharge, added [kPa], steps
LONG = 1.0e9  # [s]
height = given["height"]


def at_rest(x):
    """Effective stress of the depth of every point, tension positive."""
    vertical = -(given["surcharge"] - given["weight"]*x[:, 1])
    zero = 0.0*vertical
    return np.stack([given["k_0"]*vertical, vertical, given["k_0"]*vertical, zero, zero, zero], 1)


domain = mesh.create_rectangle(MPI.COMM_WORLD, [(0.0, -height), (1.0, 0.0)], [1, 4])
water = porous.Water(at_rest=lambda x: -9.81*x[:, 1])
problem = porous.Problem(domain, mud.Material("toyoura"), at_rest, 0.8, water, porous.Control(told=False))
sides = [(problem.V.sub(0), lambda x: np.isclose(x[0], 0.0) | np.isclose(x[0], 1.0)),
         (problem.V.sub(1), lambda x: np.isclose(x[1], -height)), (problem.Q, lambda x: np.isclose(x[1], 0.0))]
for space, where in sides:
    facets = mesh.locate_entities_boundary(domain, 1, where)
    problem.bcs.append(fem.dirichletbc(PETSc.ScalarType(0), fem.locate_dofs_topological(space, 1, facets), space))
top = mesh.locate_entities_boundary(domain, 1, sides[-1][1])
ds = ufl.Measure("ds", domain, subdomain_data=mesh.meshtags(domain, 1, top, np.full(len(top), 1, np.int32)))
load = fem.Constant(domain, PETSc.ScalarType(given["surcharge"]))
problem.external(lambda v: -given["weight"]*v[1]*ufl.dx - load*v[1]*ds(1))
low, told = int(np.argmin(problem.places[:, 1])), []
for step in range(given["steps"] + 1):  # nothing is added in the first step
    def grow(now, share=step/given["steps"]):
        load.value = given["surcharge"] + given["added"]*share

    before = problem.counts["iterations"]
    problem.step(1.0 + LONG*step, grow)
    told.append({"iterations": problem.counts["iterations"] - before, "moved": float(np.abs(problem.u.x.array).max()),
                 "stress": problem.stress0[low, [0, 1]].tolist()})
with open(sys.argv[3], "w") as file:
    json.dump({"first": told[0], "last": told[-1]}, file)
