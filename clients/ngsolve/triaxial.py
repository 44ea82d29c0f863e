# SPDX-License-Identifier: MIT
"""Drained triaxial compression of a cube of MUD tetrahedra by NGSolve: triaxial.py STRAINS.json STRESSES.json"""
import json
import sys
import mud
import numpy as np
from ngsolve import CF, BilinearForm, Grad, GridFunction, InnerProduct, LinearForm, Mesh, VectorH1, ds, dx, unit_cube
from ngsolve.comp import IntegrationRuleSpace

mesh = Mesh(unit_cube.GenerateMesh(maxh=1.0))
Q = IntegrationRuleSpace(mesh, order=2)
V = VectorH1(mesh, order=2, dirichletx="back|front", dirichlety="left", dirichletz="bottom")
points, fields = dx(intrules=Q.GetIntegrationRules()), [GridFunction(Q) for _ in range(42)]
stress, tangent = CF(tuple(fields[:6])), CF(tuple(fields[6:]), dims=(6, 6))  # by rows


def voigt(g):
    return CF((g[0, 0], g[1, 1], g[2, 2], g[0, 1] + g[1, 0], g[0, 2] + g[2, 0], g[1, 2] + g[2, 1]))


(u, v), moved, change, one, before, rows = V.TnT(), GridFunction(V), GridFunction(V), GridFunction(Q), 0.0, []
stiffness = BilinearForm(InnerProduct(tangent*voigt(Grad(u)), voigt(Grad(v)))*points)
residual = LinearForm(-InnerProduct(stress, voigt(Grad(v)))*points - 100.0*v[1]*ds("right") - 100.0*v[2]*ds("top"))
old = (sand := mud.Material("toyoura", e_0=0.8)).init_batch(np.tile([-100.0]*3 + [0.0]*3, (Q.ndof, 1)))
for axial in json.load(open(sys.argv[1])):
    new, moved.vec[:] = sand.tangent_batch(old.stress, old.statev), 0.0
    new.stress, new.statev = old.stress.copy(), old.statev.copy()
    for iteration in range(15):
        for field, values in zip(fields, [*new.stress.T, *new.dsig_deps.reshape(-1, 36).T]):
            field.vec.FV().NumPy()[:] = values
        if np.abs(residual.Assemble().vec.FV().NumPy()[list(V.FreeDofs())]).max() < 1e-9 and iteration:
            break
        change.Set(CF((0.0 if iteration else before - axial, 0.0, 0.0)), definedon=mesh.Boundaries("front"))
        change.vec.data += stiffness.Assemble().mat.Inverse(V.FreeDofs())*(residual.vec - stiffness.mat*change.vec)
        moved.vec.data += change.vec
        strain = np.stack([one.Interpolate(e) or one.vec.FV().NumPy() + 0.0 for e in voigt(Grad(moved))], 1)
        if fault := sand.update_batch(old.stress, old.statev, strain, tangent="consistent", out=new).fault():
            raise fault
    before, old, rows = axial, new, [*rows, new.stress[0].tolist()]
json.dump(rows, open(sys.argv[2], "w"))
