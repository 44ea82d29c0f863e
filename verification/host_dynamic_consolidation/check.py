"""Dynamic consolidation of a half space in closed form: displacements at the surface and 1 m below."""
import pathlib
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(here.parent))
import numpy as np  # noqa: E402
from host_tools import Checks, arguments, figure, read, run  # noqa: E402

M, K_OVER_ETA, POROSITY, RHO_S, RHO_W, LOAD = 1.2e4, 1e-8 / 1e-6, 0.8 / 1.8, 2.7, 1.0, 10.0
RHO = (1 - POROSITY) * RHO_S + POROSITY * RHO_W


def pulse(t):
    return LOAD * np.interp(t, [0, 0.01, 0.02], [0, 1, 0], left=0, right=0)


def displacement(depth, times, seepage_inertia, panels=4000):
    """The convolution integral of the theory page; midpoint rule over the smooth part, its error below 1e-6."""
    a = (RHO - RHO_W if seepage_inertia else RHO) / M
    b = 1 / (K_OVER_ETA * M)
    arrival = np.sqrt(a) * depth
    out = np.zeros(len(times))
    for i, t in enumerate(times):
        if t <= arrival:
            continue
        s = arrival + (np.arange(panels) + 0.5) * (t - arrival) / panels
        kernel = np.exp(-b * s / (2 * a)) * np.i0(b / (2 * a) * np.sqrt(np.maximum(s**2 - a * depth**2, 0)))
        out[i] = np.sum(pulse(t - s) * kernel) * (t - arrival) / panels / (np.sqrt(a) * M)
    return out


args = arguments(__doc__)
checks = Checks("dynamic consolidation")
curves = {}
for inertia in ("yes",) if args.quick else ("yes", "no"):
    h = read(run(here / "scene.nml", [("seepage_inertia = 'yes'", f"seepage_inertia = '{inertia}'")]) / "histories.csv")
    for place, depth in (("surface", 0.0), ("deep", 1.0)):
        exact = displacement(depth, h["time"], inertia == "yes")
        curves[inertia, place] = h["time"], -h[place + ".u_z"], exact
        # Cells of 0.05 m against a pulse 2 m long, 100 steps up its front; the front itself is a kink.
        checks.near(f"seepage inertia {inertia}, {place}: displacement / largest", -h[place + ".u_z"] / np.max(exact),
                    exact / np.max(exact), 2e-3)
if args.plot:
    fig, axes = figure(2)
    for axis, inertia in zip(axes, ("yes", "no")):
        for (kind, place), (t, u, exact) in curves.items():
            if kind == inertia:
                colour = "C0" if place == "surface" else "C1"
                axis.plot(t, exact * 1e3, color=colour, label=f"closed form, {place}")
                axis.plot(t[::15], u[::15] * 1e3, "o", ms=3, color=colour)
        axis.set(xlabel="time [s]", ylabel="displacement [mm]", title=f"seepage inertia: {inertia}")
        axis.legend()
    fig.savefig(here / "dynamic_consolidation.png", dpi=130)
checks.end()
