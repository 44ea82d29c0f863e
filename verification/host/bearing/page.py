# SPDX-License-Identifier: MIT
"""A circular footing on Tresca soil against the exact limit loads."""
import math

import numpy as np
from tools import tables
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="the limit loads of a smooth and of a rough circular footing on Tresca soil converge to the exact ones as the mesh is "
          "refined",
    kind="exact",
    input="`scene.nml`: radius 0.5 m, s_u 10 kPa, E 1e5 kPa, Poisson's ratio 0.49, 8 and 12 cells under the footing, graded "
          "towards its edge; the law is a UMAT of the tests (`tests/umats/tresca.f90`)",
    reference="slip lines: 5.69 s_u smooth (Shield 1955), 6.05 s_u rough (Eason & Shield 1960); both factors as quoted by "
              "Gourvenec, Randolph & Kingsnorth (2006)",
    seconds=40, quick=6, pictures=("bearing.png",))

RADIUS, STRENGTH = 0.5, 10.0
EXACT = {"smooth": 5.69, "rough": 6.05}
SMOOTH = ("&fix group='top_1' field='u_r' /\n", "")
FINER = [("r_cells=8,10 r_ratio=0.72,1.4", "r_cells=12,14 r_ratio=0.75,1.35"),
         ("z_cells=5,8 z_ratio=0.65,0.75", "z_cells=5,12 z_ratio=0.65,0.78")]


def edge_cell(cells, ratio):
    """Width of the cell inside the edge [m]."""
    return RADIUS * (1 - ratio) * ratio**(cells - 1) / (1 - ratio**cells)


EDGE = {8: edge_cell(8, 0.72), 12: edge_cell(12, 0.75)}
BELOW = 0.01   # What the cells below the footing and the third digit of the reference leave.
WITHOUT_CELL = Tolerance("the error is in proportion to the cell at the edge; the remaining error is that of the cells "
                         "below, of second order, and the third digit of the reference", relative=BELOW)
ON_A_MESH = {cells: Tolerance("the stress jumps at the edge, within a cell: the footing is wider by up to the cell beside it, h, "
                              "its area larger by 2 h/R; the cells below 1 %", relative=2 * h / RADIUS + BELOW)
             for cells, h in EDGE.items()}
PLATEAU = Tolerance("a limit load no longer grows: 1 % in the last fifth of the settlement", absolute=0.01)


def factor(bench, *changes):
    """Settlement over the radius, pressure over the strength."""
    changes = [("'tresca.so'", f"'{bench.program('tests/umats/tresca.so').resolve()}'"), *changes]
    rows = tables.columns(bench.host("scene.nml", changes) / "reactions_push.csv")
    return rows["time"] * 0.003 / RADIUS, -rows["top_1.force_z"] / (math.pi * RADIUS**2 * STRENGTH)


def check(bench):
    curves = {}
    for face, change in (("smooth", [SMOOTH]), ("rough", [])):
        for cells, mesh in ((8, []), (12, FINER)):
            if bench.quick and (face, cells) != ("smooth", 8):
                continue
            settlement, n = factor(bench, *change, *mesh)
            curves[face, cells] = settlement, n
            bench.near(f"{face}, {cells} cells: limit load / s_u", n[-1], EXACT[face], ON_A_MESH[cells])
            bench.below(f"{face}, {cells} cells: growth at the end", 1 - np.interp(0.8 * settlement[-1], settlement, n) / n[-1],
                        PLATEAU)
        if not bench.quick:
            coarse, fine = curves[face, 8][1][-1], curves[face, 12][1][-1]
            bench.near(f"{face}: extrapolated to an edge cell of nothing",
                       fine - (coarse - fine) * EDGE[12] / (EDGE[8] - EDGE[12]), EXACT[face], WITHOUT_CELL)
    return curves


def draw(bench, curves, plt):
    figure, axis = plt.subplots(figsize=(5, 3.2))
    for (face, cells), (settlement, n) in curves.items():
        axis.plot(np.insert(100 * settlement, 0, 0), np.insert(n, 0, 0), label=f"{face}, {cells} cells",
                  color=COLOURS[face == "rough"], ls="--" if cells == 8 else "-")
    for face, value in EXACT.items():
        axis.axhline(value, color=COLOURS[face == "rough"], lw=0.7, ls=":")
    axis.set(xlabel="settlement / radius [%]", ylabel="pressure / s_u", ylim=(0, None))
    axis.legend(loc="lower right")
    bench.save(figure, "bearing.png")
