# SPDX-License-Identifier: MIT
"""Ground with weight begins at its K_0 stress, then the surcharge grows: ground.py GIVEN.json RESULT.json"""
import json
import sys
import mud
import numpy as np
from skfem import Basis, BilinearForm, ElementHex1, ElementVector, FacetBasis, LinearForm, MeshHex, condense, solve

given = json.load(open(sys.argv[1]))  # height [m], weight [kN/m3], k_0, surcharge, added [kPa], steps


def voigt(v):
    g = v.grad
    return np.stack([g[0, 0], g[1, 1], g[2, 2], g[0, 1] + g[1, 0], g[0, 2] + g[2, 0], g[1, 2] + g[2, 1]])


stiffness = BilinearForm(lambda u, v, w: np.einsum("ij...,j...,i...", w["tangent"], voigt(u), voigt(v)))
internal = LinearForm(lambda v, w: np.einsum("i...,i...", w["stress"], voigt(v)))
down = LinearForm(lambda v, w: -v[2])
mesh = MeshHex.init_tensor(np.array([0.0, 1.0]), np.array([0.0, 1.0]), np.linspace(-given["height"], 0.0, 5))
basis = Basis(mesh, ElementVector(ElementHex1()), intorder=2)
shape, n = basis.dx.shape, basis.dx.size  # elements and points of each; all points
weight = given["weight"]*down.assemble(basis)
top = down.assemble(FacetBasis(mesh, basis.elem, facets=mesh.facets_satisfying(lambda x: x[2] == 0.0)))
sides = [basis.get_dofs(lambda x, i=i: (x[i] == 0.0) | (x[i] == 1.0)).all(f"u^{i + 1}") for i in range(2)]
fixed = np.unique(np.concatenate([*sides, basis.get_dofs(lambda x: x[2] == -given["height"]).all("u^3")]))
# Every point begins at the stress of its depth, in balance with the weight, and so with a memory of its own.
depth = -np.asarray(basis.global_coordinates())[2].ravel()
vertical = -(given["surcharge"] + given["weight"]*depth)
sand = mud.Material("toyoura", e_0=0.8)
old = sand.init_batch(np.stack([given["k_0"]*vertical, given["k_0"]*vertical, vertical, *[0.0*vertical]*3], 1))
u, low, told = basis.zeros(), int(np.argmax(depth)), []
for step in range(given["steps"] + 1):  # nothing is added in the first step
    load = weight + (given["surcharge"] + given["added"]*step/given["steps"])*top
    start, new = u.copy(), sand.tangent_batch(old.stress, old.statev)
    new.stress, new.statev = old.stress.copy(), old.statev.copy()
    for iteration in range(1, 16):
        tangent = np.moveaxis(new.dsig_deps, 0, -1).reshape(6, 6, *shape)
        residual = load - internal.assemble(basis, stress=new.stress.T.reshape(6, *shape))
        u += solve(*condense(stiffness.assemble(basis, tangent=tangent), residual, D=fixed))
        strain = np.ascontiguousarray(voigt(basis.interpolate(u - start)).reshape(6, -1).T)
        if sand.update_batch(old.stress, old.statev, strain, tangent="consistent", out=new).failed:
            sys.exit(str(new.fault()))
        left = load - internal.assemble(basis, stress=new.stress.T.reshape(6, *shape))
        if np.linalg.norm(np.delete(left, fixed)) <= 1e-8*np.linalg.norm(load):  # of the forces, not of the residual
            break
    old = new
    told.append({"iterations": iteration, "moved": np.abs(u).max(), "stress": old.stress[low, [0, 2]].tolist()})
json.dump({"first": told[0], "last": told[-1]}, open(sys.argv[2], "w"))
