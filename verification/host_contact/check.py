"""Contact in the host: patch test, punch, falling plate, bar against a wall."""
import pathlib
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(here.parent))
import numpy as np  # noqa: E402
from host_tools import Checks, arguments, figure, number, read, run  # noqa: E402

args = arguments(__doc__)
checks = Checks("contact")

# Patch test: 100 kPa in every point of both blocks; the penalty (1e6 kN/m3) alone lets them overlap by p/eps = 1e-4 m, of which
# the mesh has 1e-6 m from the start. Direct solution of a well-posed problem: rounding, times 1e4 for E/eps and the mesh.
PRESSURE, YOUNG, PENALTY, OVERLAP = 100.0, 1.0e4, 1.0e6, 1.0e-6
swap = [("slave = 'lower_top'", "slave = 'upper_bottom'"), ("master = 'upper_bottom'", "master = 'lower_top'")]
for name, changes in (("master finer", []), ("master coarser", swap), ("pointwise gap", [("penalty = 1.0e6", "penalty = 1.0e6\n   gap = 'pointwise'")])):
    folder = run(here / "patch.nml", changes)
    points, nodes = read(folder / "points_load.csv"), read(folder / "nodes_load.csv")
    checks.near(f"patch, {name}: vertical stress / pressure", points["s_zz"] / PRESSURE, -1.0, 1e-8)
    checks.small(f"patch, {name}: other stresses / pressure", max(np.abs(points[s]).max() for s in ("s_rr", "s_tt", "s_rz")) / PRESSURE, 1e-8)
    joint = nodes["u_z"][nodes["z"] == 1 - OVERLAP].mean() - nodes["u_z"][nodes["z"] == 1].mean()
    checks.near(f"patch, {name}: penetration / (p/eps)", (OVERLAP - joint) * PENALTY / PRESSURE, 1.0, 1e-8)

# Punch: P = 2 E a w/(1 - nu**2). The domain's boundary adds a share of the order of a/R (measured 2.4 % at R = 40 a, 1.2 % at 80 a,
# 0.6 % at 160 a), so two domains give the value without it; the mesh (halved: 0.01 %) and the penalty are far below 1 %.
exact = 2 * 1.0e4 * 0.15 * 1.0e-3 / (1 - 0.3**2)
forces = []
for domain in (12, 24):
    folder = run(here / "punch.nml", [("0.3, 24", f"0.3, {domain}"), ("z = -24", f"z = -{domain}")])
    forces.append(read(folder / "contact.csv")["footing.thrust"][-1])
checks.near("punch, 160 radii: force / closed form", forces[1] / exact, 1.0, 0.01)
checks.near("punch, domain extrapolated: force / closed form", (2 * forces[1] - forces[0]) / exact, 1.0, 0.0025)

# Bar: it leaves when the wave comes back, after 2 L/c = 1 ms, with its momentum turned round. Algorithmic damping takes the
# shortest waves: an energy share of a few per mille of the jump that 50 cells cannot carry.
c, ledger = read((folder := run(here / "bar.nml")) / "contact.csv"), read(folder / "ledger.csv")
speed, mass = np.sqrt(1.0e7 / 2.5), 2.5 * 0.05
touching = c["time"][c["end.thrust"] < 0]
checks.near("bar: contact time / (2 L/c)", (touching[-1] - touching[0]) / (2 / speed), 1.0, 0.02)
checks.near("bar: impulse / 2 m v", -np.sum(c["end.thrust"] * c["dt"]) / (2 * mass), 1.0, 0.002)
checks.near("bar: energy at the end / at the start", (ledger["kinetic"][-1] + ledger["skeleton"][-1]) / (0.5 * mass), 1.0, 0.005)
bar = c

# Falling plate: energy of plate and body without that of the penalty, which is never negative.
gains = {}
steps = ("1.0e-5",) if args.quick else ("1.0e-5", "5.0e-6")
for step in steps:
    for rho in ("0.8", "0.5"):
        folder = run(here / "fall.nml", [("dt = 1.0e-5", f"dt = {step}"), ("rho_inf = 0.8", f"rho_inf = {rho}")])
        l, c = read(folder / "ledger.csv"), read(folder / "contact.csv")
        energy = l["kinetic"] + l["skeleton"] - l["gravity"] - l["loads"]
        gains[rho, step] = max(0.0, np.max(energy / energy[0] - 1))
        if step == steps[0]:
            # Force and momentum: the plate's change of momentum is the impulse of contact and weight. Newton's tolerance of 1e-6
            # over 600 steps bounds what is missing by 6e-4; the end of the generalised-alpha step by dt times an acceleration.
            impulse = np.sum(c["soil_plate.thrust"] * c["dt"]) + np.sum(c["plate.load"] * c["dt"])
            momentum = number((here / "fall.nml").read_text(), "mass") * (c["plate.v_z"][-1] + 0.05)
            checks.near(f"fall, rho_inf {rho}: impulse / momentum", impulse / momentum, 1.0, 1e-3)
# With damping none, up to the tolerance of Newton. With little of it a step that opens or closes a contact makes an error of first order in the step.
checks.small("fall, rho_inf 0.5: energy gained / at the start", max(g for (rho, _), g in gains.items() if rho == "0.5"), 1e-6)
checks.small("fall, rho_inf 0.8: energy gained / at the start", gains["0.8", "1.0e-5"], 1e-3)
if not args.quick:
    checks.small("fall, rho_inf 0.8: that of half the step / of the step", gains["0.8", "5.0e-6"] / gains["0.8", "1.0e-5"], 0.6)

if args.plot:
    fig, axes = figure(2)
    axes[0].plot(bar["time"] * speed / 2, -bar["end.thrust"] / (2.5 * speed * 0.05), label="host")
    axes[0].plot([0, 0, 1, 1, 1.5], [0, 1, 1, 0, 0], "k--", lw=1, label="closed form")
    axes[0].set(xlabel="time c / (2 L)", ylabel="force / (rho c v A)", title="bar against a wall")
    axes[1].plot(c["time"] * 1e3, c["soil_plate.thrust"], label="thrust [kN]")
    axes[1].set(xlabel="time [ms]", ylabel="kN", title="falling plate")
    for axis in axes:
        axis.legend()
    fig.savefig(here / "contact.png", dpi=130)
checks.end()
