# SPDX-License-Identifier: MIT
"""A thousand points sheared at once, in place, and the tangent of one of them: many_points.py

Points follow the library's convention: tension positive, components 11, 22, 33, 12, 13, 23, engineering shear strain.
"""

import numpy as np

import mud

sand = mud.Material("toyoura", e_0=0.75)
n = 1000
mesh = sand.init_batch(np.tile([-100.0, -100.0, -100.0, 0.0, 0.0, 0.0], (n, 1)))
# Each point is sheared in its own direction, at constant volume.
strains = np.random.default_rng(1).normal(scale=1e-4, size=(n, 6))
strains[:, :3] -= strains[:, :3].mean(axis=1, keepdims=True)

for _ in range(20):
    sand.update_batch(mesh.stress, mesh.statev, strains, out=mesh)  # nothing is copied
pressure = -mesh.stress[:, :3].mean(axis=1)
print(f"{mesh.failed} points failed; p' {pressure.min():.1f} to {pressure.max():.1f} kPa")
print(f"largest fabric component {np.abs(mud.state(mesh.statev, 'fabric')).max():.3f}")

response = sand.update(mesh.stress[0], mesh.statev[0], strains[0], tangent="consistent")
print(f"d sigma_11/d eps_11 of the first point: {response.dsig_deps[0, 0]/1e3:.1f} MPa")
