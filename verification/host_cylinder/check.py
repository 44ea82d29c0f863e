"""A thick elastic cylinder under internal pressure (Lame), with the observed order of convergence."""
import pathlib
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(here.parent))
import numpy as np  # noqa: E402
from host_tools import Checks, arguments, figure, read, run  # noqa: E402

A, B, P, E, NU = 1.0, 2.0, 100.0, 1.0e4, 0.3


def displacement(r):
    return (1 + NU) / E * P * A * A / (B * B - A * A) * ((1 - 2 * NU) * r + B * B / r)


def stresses(r):
    c = P * A * A / (B * B - A * A)
    return c * (1 - (B / r) ** 2), c * (1 + (B / r) ** 2)


args = arguments(__doc__)
checks = Checks("cylinder")
errors = []
cells = (4, 8, 16)
for n in cells:
    out = run(here / "scene.nml", [("r_cells = 8", f"r_cells = {n}"), ("z_cells = 2", f"z_cells = {max(1, n // 4)}")])
    nodes, points = read(out / "nodes_load.csv"), read(out / "points_load.csv")
    s_r, s_t = stresses(points["r"])
    weight = points["weight"] / np.sum(points["weight"])
    errors.append([np.max(np.abs(nodes["u_r"] / displacement(nodes["r"]) - 1)),
                   np.sqrt(np.sum(weight * (points["s_rr"] - s_r) ** 2)) / P,
                   np.sqrt(np.sum(weight * (points["s_tt"] - s_t) ** 2)) / P])
errors = np.array(errors)
orders = np.log2(errors[:-1] / errors[1:])
print("   errors of u_r, s_rr, s_tt:", *(f"{e:.2e}" for e in errors[-1]), " orders:", *(f"{o:.2f}" for o in orders[-1]))
# Quadratic elements: 3 for displacements (4 at nodes of such a smooth problem), 2 for stresses.
checks.small("u_r at the nodes, 16 cells", errors[-1][0], 2e-5)
checks.small("lack of order of u_r below 3", 3 - orders[-1][0], 0.2)
checks.near("order of the stresses", orders[-1][1:], 2, 0.2)
if args.plot:
    fig, axes = figure(2)
    r = np.linspace(A, B, 200)
    axes[0].plot(r, displacement(r) * 1e3, label="Lame")
    axes[0].plot(nodes["r"], nodes["u_r"] * 1e3, "o", ms=3, label="host")
    axes[0].set(xlabel="r [m]", ylabel="u_r [mm]")
    for value, key, colour in zip(stresses(r), ("s_rr", "s_tt"), ("C0", "C1")):
        axes[1].plot(r, value, color=colour, label=key)
        axes[1].plot(points["r"], points[key], ".", ms=3, color=colour)
    axes[1].set(xlabel="r [m]", ylabel="stress [kPa], tension positive")
    for axis in axes:
        axis.legend()
    fig.savefig(here / "cylinder.png", dpi=130)
checks.end()
