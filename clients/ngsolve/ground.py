# SPDX-License-Identifier: MIT
"""Ground with weight begins at its K_0 stress, then the surcharge grows: ground.py GIVEN.json RESULT.json"""
import json
import sys
import mud
import numpy as np
from ngsolve import CF, BilinearForm, Grad, GridFunction, InnerProduct, LinearForm, VectorH1, ds, dx, z
from ngsolve.comp import IntegrationRuleSpace
from ngsolve.meshes import MakeStructured3DMesh

given = json.load(open(sys.argv[1]))  # height [m], weight [kN/m3], k_0, surcharge, added [kPa], steps
mesh = MakeStructured3DMesh(hexes=False, nx=1, ny=1, nz=4, mapping=lambda x, y, z: (x, y, given["height"]*(z - 1)))
Q = IntegrationRuleSpace(mesh, order=2)
V = VectorH1(mesh, order=2, dirichletx="back|front", dirichlety="left|right", dirichletz="bottom")
points, fields = dx(intrules=Q.GetIntegrationRules()), [GridFunction(Q) for _ in range(42)]
stress, tangent = CF(tuple(fields[:6])), CF(tuple(fields[6:]), dims=(6, 6))  # by rows


def voigt(g):
    return CF((g[0, 0], g[1, 1], g[2, 2], g[0, 1] + g[1, 0], g[0, 2] + g[2, 0], g[1, 2] + g[2, 1]))


(u, v), moved, one, free = V.TnT(), GridFunction(V), GridFunction(Q), list(V.FreeDofs())
stiffness = BilinearForm(InnerProduct(tangent*voigt(Grad(u)), voigt(Grad(v)))*points)
internal = LinearForm(InnerProduct(stress, voigt(Grad(v)))*points)
weight = LinearForm(-given["weight"]*v[2]*dx).Assemble().vec.FV().NumPy()
top = LinearForm(-v[2]*ds("top")).Assemble().vec.FV().NumPy()
# Every point begins at the stress of its depth, in balance with the weight, and so with a memory of its own.
one.Interpolate(z)
depth = -one.vec.FV().NumPy()
vertical = -(given["surcharge"] + given["weight"]*depth)
sand = mud.Material("toyoura", e_0=0.8)
old = sand.init_batch(np.stack([given["k_0"]*vertical, given["k_0"]*vertical, vertical, *[0.0*vertical]*3], 1))
low, told, largest = int(np.argmax(depth)), [], 0.0


def left(new):
    """What the forces of the points leave of the load; stress and tangent stay in the fields."""
    for field, values in zip(fields, [*new.stress.T, *new.dsig_deps.reshape(-1, 36).T]):
        field.vec.FV().NumPy()[:] = values
    return load - internal.Assemble().vec.FV().NumPy()


for step in range(given["steps"] + 1):  # nothing is added in the first step
    load = weight + (given["surcharge"] + given["added"]*step/given["steps"])*top
    new, moved.vec[:] = sand.tangent_batch(old.stress, old.statev), 0.0
    new.stress, new.statev = old.stress.copy(), old.statev.copy()
    residual = left(new)
    for iteration in range(1, 16):
        force = moved.vec.CreateVector()
        force.FV().NumPy()[:] = residual
        moved.vec.data += stiffness.Assemble().mat.Inverse(V.FreeDofs())*force
        strain = np.stack([one.Interpolate(e) or one.vec.FV().NumPy() + 0.0 for e in voigt(Grad(moved))], 1)
        if fault := sand.update_batch(old.stress, old.statev, strain, tangent="consistent", out=new).fault():
            raise fault
        residual = left(new)
        if np.linalg.norm(residual[free]) <= 1e-8*np.linalg.norm(load):  # of the forces, not of the first residual
            break
    old, largest = new, max(largest, np.abs(moved.vec.FV().NumPy()).max())
    told.append({"iterations": iteration, "moved": largest, "stress": old.stress[low, [0, 2]].tolist()})
json.dump({"first": told[0], "last": told[-1]}, open(sys.argv[2], "w"))
