# SPDX-License-Identifier: MIT
"""Patch tests: uniform stress, uniform pressure gradients, soil at rest."""
import numpy as np
from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="on an irregular mesh (12 corners, one element turned clockwise in the file) read from Gmsh 4.1, "
          "fields that the elements can represent are reproduced to rounding",
    kind="exact",
    input="`stress.nml` (axisymmetric and plane strain), `flow.nml` (skeleton held, steady; quadratic and linear "
          "pressures), `geostatic.nml` (MUD under its weight, "
          "water table at the surface, static and ten dynamic steps)",
    reference="uniform stress -100, -50 kPa and linear displacements; linear p_w 10 to 30 and p_c 50 to 10 kPa; "
              "nothing moves",
    seconds=2, quick=2, every_build=True, pictures=("patch.png",))
MAKES = (Script("make_mesh.py", ("patch.msh",), 1),)

E, NU = 1e4, 0.3
ROUNDING = "rounding of a system of 60 unknowns: 1e-12 of the largest value"
STRESS, DISPLACEMENT, PRESSURE = (Tolerance(ROUNDING, absolute=a) for a in (1e-10, 1e-14, 1e-9))
AT_REST = Tolerance("residual below 1e-10 of the forces: the surcharge on a stiffness of 1e3 kPa moves less than this",
                    absolute=1e-12)


def check(bench):
    for geometry in ("axisymmetric", "plane_strain"):
        out = bench.host("stress.nml", [("geometry = 'axisymmetric'", f"geometry = '{geometry}'")])
        nodes, points = tables.columns(out / "nodes_load.csv"), tables.columns(out / "points_load.csv")
        s_r, s_z = -100.0, -50.0
        s_t = s_r if geometry == "axisymmetric" else NU * (s_r + s_z)
        for name, value in (("s_rr", s_r), ("s_zz", s_z), ("s_tt", s_t), ("s_rz", 0.0)):
            bench.near(f"{geometry} {name}", points[name], value, STRESS, "kPa")
        bench.near(f"{geometry} u_r", nodes["u_r"], (s_r - NU * (s_z + s_t)) / E * nodes["r"], DISPLACEMENT, "m")
        bench.near(f"{geometry} u_z", nodes["u_z"], (s_z - NU * (s_r + s_t)) / E * nodes["z"], DISPLACEMENT, "m")
    for pressures in ("quadratic", "linear"):
        out = bench.host("flow.nml", [("pressures = 'quadratic'", f"pressures = '{pressures}'")])
        nodes = tables.columns(out / "nodes_flow.csv")
        bench.near(f"{pressures} p_w", nodes["p_w"], 10 + 20 * nodes["z"], PRESSURE, "kPa")
        bench.near(f"{pressures} p_c", nodes["p_c"], 50 - 40 * nodes["z"], PRESSURE, "kPa")
    nodes = tables.columns(bench.host("geostatic.nml") / "nodes_still.csv")
    bench.near("soil at rest: displacement", np.hypot(nodes["u_r"], nodes["u_z"]), 0.0, AT_REST, "m")
    bench.near("soil at rest: p_w", nodes["p_w"], 9.81 * (1 - nodes["z"]), PRESSURE, "kPa")
    return nodes


def draw(bench, nodes, plt):
    figure, axis = plt.subplots(figsize=(3.8, 3.2))
    text = (bench.here / "patch.msh").read_text(encoding="utf-8").split("$Elements")[1].splitlines()
    t6 = [[int(v) - 1 for v in line.split()[1:]] for line in text if len(line.split()) == 7]
    image = axis.tricontourf(nodes["r"], nodes["z"], [t[:3] for t in t6], nodes["p_w"], levels=20)
    for t in t6:
        axis.plot(nodes["r"][[*t[:3], t[0]]], nodes["z"][[*t[:3], t[0]]], "k-", lw=0.6)
    axis.plot(nodes["r"], nodes["z"], "k.", ms=3)
    axis.set(xlabel="r [m]", ylabel="z [m]", aspect="equal")
    axis.grid(False)
    figure.colorbar(image, label="p_w at rest [kPa]")
    bench.save(figure, "patch.png")
