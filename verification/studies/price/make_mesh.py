# SPDX-License-Identifier: MIT
"""Writes ring.msh: a quarter of a plate between an elliptic hole, half axes 1 m and 0.6 m, and a circle of 3 m."""
import numpy as np
from tools.gmsh import Mesh
from tools.results import folder


def place(share, angle):
    return (1 + 2*share)*np.cos(angle), (0.6 + 2.4*share)*np.sin(angle)


mesh = Mesh()
mesh.block("ring", np.linspace(0, 1, 5)**1.3, np.linspace(0, np.pi/2, 5), place)
mesh.edges = {"floor": mesh.edges["ring_bottom"], "hole": mesh.edges["axis"], "wall": mesh.edges["ring_top"],
              "rim": mesh.edges["ring_side"]}
mesh.write(folder(__file__) / "ring.msh")
