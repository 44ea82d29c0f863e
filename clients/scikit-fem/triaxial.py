# SPDX-License-Identifier: MIT
"""Drained triaxial compression of eight MUD hexahedra by scikit-fem: triaxial.py STRAINS.json STRESSES.json"""
import json
import sys
import mud
import numpy as np
from skfem import Basis, BilinearForm, ElementHex1, ElementVector, FacetBasis, LinearForm, MeshHex, condense, solve


def voigt(v):
    g = v.grad
    return np.stack([g[0, 0], g[1, 1], g[2, 2], g[0, 1] + g[1, 0], g[0, 2] + g[2, 0], g[1, 2] + g[2, 1]])


stiffness = BilinearForm(lambda u, v, w: np.einsum("ij...,j...,i...", w["tangent"], voigt(u), voigt(v)))
internal = LinearForm(lambda v, w: np.einsum("i...,i...", w["stress"], voigt(v)))
push = LinearForm(lambda v, w: 100.0*(w.n[0]*v[0] - sum(w.n[i]*v[i] for i in range(3))))  # 100 kPa on the sides
sand, basis = mud.Material("toyoura", e_0=0.8), Basis(MeshHex().refined(1), ElementVector(ElementHex1()), intorder=2)
shape, n = basis.dx.shape, basis.dx.size  # elements and points of each; all points
old = sand.init_batch(np.tile([-100.0]*3 + [0.0]*3, (n, 1)))
load = push.assemble(FacetBasis(basis.mesh, basis.elem))
held = [basis.get_dofs(lambda x, i=i: x[i] == 0.0).all(f"u^{i + 1}") for i in range(3)]
top, u, rows = basis.get_dofs(lambda x: x[0] == 1.0).all("u^1"), basis.zeros(), []
fixed = np.unique(np.concatenate([*held, top]))
for axial in json.load(open(sys.argv[1])):
    start, new, step = u.copy(), sand.tangent_batch(old.stress, old.statev), basis.zeros()
    new.stress, new.statev, step[top] = old.stress.copy(), old.statev.copy(), -axial - u[top]
    for iteration in range(15):
        tangent = np.moveaxis(new.dsig_deps, 0, -1).reshape(6, 6, *shape)
        residual = load - internal.assemble(basis, stress=new.stress.T.reshape(6, *shape))
        if iteration and np.abs(np.delete(residual, fixed)).max() < 1e-9:
            break
        u += solve(*condense(stiffness.assemble(basis, tangent=tangent), residual, x=step, D=fixed))
        strain = np.ascontiguousarray(voigt(basis.interpolate(u - start)).reshape(6, -1).T)
        if sand.update_batch(old.stress, old.statev, strain, tangent="consistent", out=new).failed:
            sys.exit(str(new.fault()))
        step[:] = 0.0
    old = new
    rows.append(old.stress[0].tolist())
json.dump(rows, open(sys.argv[2], "w"))
