"""Patch tests on an irregular Gmsh mesh: uniform stress, uniform pressure gradients, soil at rest."""
import pathlib
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(here.parent))
import numpy as np  # noqa: E402
from host_tools import Checks, arguments, figure, read, run  # noqa: E402

args = arguments(__doc__)
checks = Checks("patch")
E, NU = 1e4, 0.3
# Rounding of a system of 60 unknowns: 1e-12 of the largest value.
for geometry in ("axisymmetric", "plane_strain"):
    out = run(here / "stress.nml", [("geometry = 'axisymmetric'", f"geometry = '{geometry}'")])
    nodes, points = read(out / "nodes_load.csv"), read(out / "points_load.csv")
    s_r, s_z = -100.0, -50.0
    s_t = s_r if geometry == "axisymmetric" else NU * (s_r + s_z)
    for name, value in (("s_rr", s_r), ("s_zz", s_z), ("s_tt", s_t), ("s_rz", 0.0)):
        checks.near(f"{geometry} {name}", points[name], value, 1e-10, "kPa")
    checks.near(f"{geometry} u_r", nodes["u_r"], (s_r - NU * (s_z + s_t)) / E * nodes["r"], 1e-14, "m")
    checks.near(f"{geometry} u_z", nodes["u_z"], (s_z - NU * (s_r + s_t)) / E * nodes["z"], 1e-14, "m")
for pressures in ("quadratic", "linear"):
    out = run(here / "flow.nml", [("fields = 'u-p_w-p_c'", f"fields = 'u-p_w-p_c'\n   pressures = '{pressures}'")])
    nodes, ledger = read(out / "nodes_flow.csv"), read(out / "ledger.csv")
    checks.near(f"{pressures} p_w", nodes["p_w"], 10 + 20 * nodes["z"], 1e-9, "kPa")
    checks.near(f"{pressures} p_c", nodes["p_c"], 50 - 40 * nodes["z"], 1e-9, "kPa")
out = run(here / "geostatic.nml")
nodes = read(out / "nodes_still.csv")
# Residual of the theory page: below 1e-10 of the forces; the surcharge on a stiffness of 1e3 kPa moves less than this.
checks.near("soil at rest: displacement", np.hypot(nodes["u_r"], nodes["u_z"]), 0.0, 1e-12, "m")
checks.near("soil at rest: p_w", nodes["p_w"], 9.81 * (1 - nodes["z"]), 1e-9, "kPa")
if args.plot:
    fig, axis = figure(1)
    text = (here / "patch.msh").read_text().split("$Elements")[1].splitlines()
    t6 = [[int(v) - 1 for v in line.split()[1:]] for line in text if len(line.split()) == 7]
    image = axis.tricontourf(nodes["r"], nodes["z"], [t[:3] for t in t6], nodes["p_w"], levels=20)
    for t in t6:
        axis.plot(nodes["r"][[*t[:3], t[0]]], nodes["z"][[*t[:3], t[0]]], "k-", lw=0.6)
    axis.plot(nodes["r"], nodes["z"], "k.", ms=3)
    axis.set(xlabel="r [m]", ylabel="z [m]", aspect="equal")
    axis.grid(False)
    fig.colorbar(image, label="p_w at rest [kPa]")
    fig.savefig(here / "patch.png", dpi=130)
checks.end()
