# SPDX-License-Identifier: MIT
"""Writes slope.msh: a bank of 4 m with a slope of 1:1.5, from 12 m wide at its base; and curve.txt, the exponential
retention curve of rain.nml."""
import numpy as np
from tools.gmsh import Mesh
from tools.results import folder

HEIGHT, BASE, RUN = 4.0, 12.0, 1.5
here = folder(__file__)
mesh = Mesh()
mesh.block("soil", np.linspace(0, BASE, 13), np.linspace(0, HEIGHT, 9), lambda x, z: (x * (1 - RUN * z / BASE), z))
mesh.edges = {"bottom": mesh.edges["soil_bottom"], "slope": mesh.edges["soil_side"], "top": mesh.edges["soil_top"],
              "left": mesh.edges["axis"]}
mesh.write(here / "slope.msh")
(here / "curve.txt").write_text("".join(f"{p:.17g} {0.2 + 0.8 * np.exp(-0.2 * p):.17g}\n"
                                        for p in np.linspace(0, 30, 1501)), encoding="utf-8")
