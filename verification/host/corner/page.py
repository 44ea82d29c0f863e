# SPDX-License-Identifier: MIT
"""A tilted block that falls on its corner: when contact acts, how deep the corner gets, and what a run says of it."""
import math

import numpy as np
from tools import tables
from tools.gmsh import Mesh
from tools.page import Page, Tolerance


PAGE = Page(
    claim="a corner meets the contact in the step in which it arrives; mean gaps alone let it penetrate, with a warning",
    kind="exact",
    input="`scene.nml`: an elastic block of 0.1 by 0.05 m with edges of 50 mm, tilted by 6 degrees, 1 mm above a rigid "
          "floor, falling with 0.3 m/s under gravity; the mesh is made by `page.py`",
    reference="free fall: 0.3 t + g t**2/2 = 1 mm",
    seconds=10, quick=10, every_build=False, pictures=("corner.png",))

TILT, HEIGHT, SPEED, GRAVITY, DT = math.radians(6), 1e-3, 0.3, 9.81, 1e-5
ARRIVAL = (math.sqrt(SPEED**2 + 2 * GRAVITY * HEIGHT) - SPEED) / GRAVITY
IN_ITS_STEP = Tolerance("the row of a step is that of its end, contact acts from the first step that ends below the "
                        "floor: one step", absolute=1.001 * DT)
SAID = Tolerance("a count")


def first_touch(folder):
    table = tables.columns(folder / "contact.csv")
    return table["time"][np.flatnonzero(np.abs(table["c.thrust"]) > 0)[0]]


def check(bench):
    mesh = Mesh()
    mesh.block("block", [0, 0.05, 0.1], [0, 0.05],
               lambda r, z: (1 + r * math.cos(TILT) - z * math.sin(TILT),
                             HEIGHT + r * math.sin(TILT) + z * math.cos(TILT)))
    path = bench.folder() / "block.msh"
    mesh.write(path)
    curves = {}
    for gap in ("nodal", "pointwise", "combined"):
        folder = bench.host("scene.nml", [("block.msh", str(path)), ("'combined'", f"'{gap}'")])
        history = tables.columns(folder / "histories.csv")
        curves[gap] = history["time"], HEIGHT + history["corner.u_z"], first_touch(folder)
    bench.near("combined: contact acts from", curves["combined"][2], ARRIVAL, IN_ITS_STEP, "s")
    bench.below("combined: depth of the corner / that of mean gaps", -curves["combined"][1].min() / -curves["nodal"][1].min(),
                Tolerance("mean gaps let it penetrate until half an edge is inside", absolute=0.25))
    for gap, (_, z, touch) in curves.items():
        bench.note(gap, f"acts from {1e3 * touch:.2f} ms (arrival {1e3 * ARRIVAL:.2f} ms), depth {-1e3 * z.min():.2f} mm")
    return curves


def draw(bench, curves, plt):
    figure, axis = plt.subplots(figsize=(5, 3))
    for gap, (t, z, _) in curves.items():
        axis.plot(1e3 * t, 1e3 * z, label=f"gap = '{gap}'")
    axis.axhline(0, color="k", lw=0.6)
    axis.set(xlabel="time [ms]", ylabel="height of the corner [mm]")
    axis.legend()
    bench.save(figure, "corner.png")
