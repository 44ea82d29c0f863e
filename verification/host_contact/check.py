"""Contact in the host: patch tests, punch, sphere and cylinder, refinement, deformable plate, drainage, falling plate, bar
against a wall."""
import pathlib
import shutil
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(here), str(here.parent)]
import numpy as np  # noqa: E402
import make_meshes  # noqa: E402
from host_tools import Checks, arguments, figure, number, read, run, scratch  # noqa: E402

args = arguments(__doc__)
checks = Checks("contact")
meshes = scratch()

# Patch tests: 100 kPa in every point of all blocks; the penalty (1e6 kN/m3) alone lets them overlap by p/eps = 1e-4 m, of which
# the mesh has 1e-6 m from the start. Direct solution of a well-posed problem: rounding, times 1e4 for E/eps and the mesh.
PRESSURE, PENALTY = 100.0, 1.0e6
pointwise = ("penalty = 1.0e6", "penalty = 1.0e6\n   gap = 'pointwise'")
plane = ("'axisymmetric'", "'plane_strain'")
swap = [("slave = 'lower_top'", "slave = 'upper_bottom'"), ("master = 'upper_bottom'", "master = 'lower_top'")]
for name, scene, changes in (("master finer", "patch", []), ("master coarser", "patch", swap), ("pointwise gap", "patch", [pointwise]),
                             ("plane strain", "patch", [plane]), ("end inside an edge", "split", []),
                             ("end inside an edge, pointwise gap", "split", [pointwise]),
                             ("end inside an edge, plane strain", "split", [plane]),
                             ("end inside an edge, plane strain, pointwise gap", "split", [plane, pointwise])):
    folder = run(here / f"{scene}.nml", changes)
    points, touching = read(folder / "points_load.csv"), read(folder / "contact_load.csv")
    checks.near(f"patch, {name}: vertical stress / pressure", points["s_zz"] / PRESSURE, -1.0, 1e-8)
    checks.small(f"patch, {name}: other stresses / pressure", max(np.abs(points[s]).max() for s in ("s_rr", "s_tt", "s_rz")) / PRESSURE, 1e-8)
    checks.near(f"patch, {name}: penetration / (p/eps)", touching["gap"][touching["coverage"] > 0] * PENALTY / PRESSURE, -1.0, 1e-8)

# Punch: P = 2 E a w/(1 - nu**2). The domain's boundary adds a share of the order of a/R (measured 2.4 % at R = 40 a, 1.2 % at 80 a,
# 0.6 % at 160 a), so two domains give the value without it; the mesh (halved: 0.01 %) and the penalty are far below 1 %.
exact = 2 * 1.0e4 * 0.15 * 1.0e-3 / (1 - 0.3**2)
forces = []
for domain in (12, 24):
    folder = run(here / "punch.nml", [("0.3, 24", f"0.3, {domain}"), ("z = -24", f"z = -{domain}")])
    forces.append(read(folder / "contact.csv")["footing.thrust"][-1])
checks.near("punch, 160 radii: force / closed form", forces[1] / exact, 1.0, 0.01)
checks.near("punch, domain extrapolated: force / closed form", (2 * forces[1] - forces[0]) / exact, 1.0, 0.0025)

# Hertz, both bodies elastic. Sphere: a**3 = 3 P R/(4 E*), peak 3 P/(2 pi a**2), approach a**2/R. Cylinder, force P' a unit of length:
# a**2 = 4 P' R/(pi E*), peak 2 P'/(pi a).
RADIUS, APPROACH = 10.0, 2.5e-4
MODULUS = 1 / ((1 - 0.3**2) / 1.0e4 + (1 - 0.2**2) / 2.0e4)


class Hertz:
    """A run, and the closed form at its force."""

    def __init__(self, cells, domain, *changes):
        mesh = meshes / f"{cells}_{domain}.msh"
        make_meshes.hertz(RADIUS, 0.05, cells, domain).write(mesh)
        folder = run(here / "hertz.nml", [("'hertz.msh'", f"'{mesh}'"), *changes])
        c = read(folder / "contact.csv")
        self.force, area = c["touch.thrust"][-1], c["touch.area"][-1]
        touching = read(folder / "contact_press.csv")
        order = np.argsort(touching["r"])
        self.r, self.p, self.weight = (touching[name][order] for name in ("r", "pressure", "weight"))
        if plane in changes:
            self.a = np.sqrt(4 * 2 * self.force * RADIUS / np.pi / MODULUS)
            self.peak, self.reached = 2 * 2 * self.force / np.pi / self.a, area
        else:
            self.a = (0.75 * self.force * RADIUS / MODULUS)**(1 / 3)
            self.peak, self.reached = 1.5 * self.force / np.pi / self.a**2, np.sqrt(area / np.pi)
        self.edge = self.r[2] / self.a
        # Within 0.8 a: the straight line of p**2 over r**2 has both, and the error of the pressure itself.
        inside = self.r < 0.8 * self.a
        slope, top = np.polyfit(self.r[inside]**2, self.p[inside]**2, 1)
        self.fitted = np.sqrt(-top / slope) / self.a, np.sqrt(top) / self.peak
        wrong = self.p[inside] - self.peak * np.sqrt(1 - (self.r[inside] / self.a)**2)
        self.error = np.sqrt(self.weight[inside] @ wrong**2 / self.weight[inside].sum()) / self.peak


# The edge of the contact is known to half an edge of the mesh: a node is in contact or not. Inside the pressure is smooth, and the
# error of the second order: (edge/a)**2. The penalty of 1e8 kN/m3 lets the surfaces overlap by less than 1e-3 of the approach.
cells = 6 if args.quick else 12
bodies = {"sphere": Hertz(cells, 20), "cylinder": Hertz(cells, 20, plane, ("-2.5e-4", "-5.0e-4"))}
if not args.quick:
    bodies["sphere, pointwise gap"] = Hertz(cells, 20, ("'nodal'", "'pointwise'"))
for name, one in bodies.items():
    if "pointwise" not in name:
        # Pointwise, a node is active as soon as its hat is touched: the area says less.
        checks.near(f"{name}: radius of the active area / closed form", one.reached / one.a, 1.0, 0.5 * one.edge)
    checks.near(f"{name}: radius from the pressures inside / closed form", one.fitted[0], 1.0, one.edge**2)
    checks.near(f"{name}: peak from the pressures inside / closed form", one.fitted[1], 1.0, one.edge**2)
    checks.near(f"{name}: pressure on the axis / closed form", one.p[0] / one.peak, 1.0, one.edge**2)
# The boundary makes the approach too small by a share of the order of a/L (measured 3 % at 20 a, 1.4 % at 40 a); what is left of two
# domains is the second order, (1/40)**2, the penalty, 1e-3, and the sphere's own curve, L/R = 0.2.
near, far = (APPROACH / (one.a**2 / RADIUS) for one in (bodies["sphere"], Hertz(cells, 40)))
checks.near("sphere, 40 radii: approach / closed form", far, 1.0, 1 / 40)
checks.near("sphere, domain extrapolated: approach / closed form", 2 * far - near, 1.0, 0.005)
if not args.quick:
    # Smooth inside, so that quadratic displacements and linear pressures should give 2; but the edge of the contact, where the
    # pressure has a vertical tangent, falls on another place of an element with every mesh, which moves single halvings: the mean,
    # and at least first order each. The penalty alone: first order.
    series = [Hertz(n, 20, ("1.0e8", f"{2.0e7 * (n / 3)**2:.3e}")) for n in (3, 6, 12, 24)]
    orders = np.log2([one.error / finer.error for one, finer in zip(series, series[1:])])
    print(f"  mesh halved and penalty times four: error of the pressure within 0.8 a {', '.join(f'{one.error:.2e}' for one in series)}; orders {orders.round(2)}")
    checks.small("refinement: 2 less the mean order of three halvings", 2 - orders.mean(), 0.25)
    checks.small("refinement: 1 less the lowest order", 1 - orders.min(), 0.0)
    forces = [Hertz(6, 20, ("1.0e8", eps)).force for eps in ("4.0e6", "1.6e7", "6.4e7")]
    checks.near("penalty times four: order of the force", np.log((forces[1] - forces[0]) / (forces[2] - forces[1])) / np.log(4), 1.0, 0.1)

# Deformable plate. Steel of 20 mm on this soil is nearly rigid: what it bends is 1/E of the plate to first order, so ten times the
# modulus must give a tenth (but for a share of the order of the bending itself), and 1e10 kPa the rigid plate to 1e-4.
# Equilibrium holds to 1e-9 of all forces, of which the soil's weight is some hundred times the load.
rigid_body = [("master = 'plate_bottom'", "master = 'rigid'"), ("value = 91.95618934", "value = 0"),
              ("&history", """&plate name = 'rigid' r = 0, 0.15 mass = 0.011098231 weight = 'yes' force = -6.5 history = 'triangle' /
&fix group = 'plate' field = 'u_r' /
&fix group = 'plate' field = 'u_z' /
&history""")]
static = [("analysis = 'dynamic'", "analysis = 'static'"), ("duration = 0.04", "duration = 0.014"), ("dt = 1.0e-4", "dt = 0.014"),
          ("tolerance = 1.0e-5", "tolerance = 1.0e-9")]
folder = run(here / "steel.nml", rigid_body + static)
settled = np.diff(read(folder / "contact.csv")["rigid.u_z"])[0]
pressed, bent, surfaces = {}, {}, {}


def surface(folder):
    """Contact pressure and settlement of the soil's surface by radius."""
    nodes, touching = read(folder / "nodes_impact.csv"), read(folder / "contact_impact.csv")
    on = np.flatnonzero((nodes["z"] == 0) & (nodes["r"] <= 0.3))
    on, order = on[np.argsort(nodes["r"][on])], np.argsort(touching["r"])
    return touching["r"][order], touching["pressure"][order], nodes["r"][on], nodes["u_z"][on]


surfaces["rigid"] = surface(folder)
for young in ("2.1e8", "2.1e9", "2.1e10", *(() if args.quick else ("3.0e6",))):
    folder = run(here / "steel.nml", [*static, ("young = 2.1e8", f"young = {young}")])
    h, c = read(folder / "histories.csv"), read(folder / "contact.csv")
    moved = {name: h[f"{name}.u_z"][-1] - h[f"{name}.u_z"][-2] for name in ("centre", "rim")}
    bent[young] = (moved["centre"] - moved["rim"]) / settled
    pressed[young] = moved["centre"] / settled - 1
    surfaces[young] = surface(folder)
    checks.near(f"plate of {young} kPa: thrust / load and weight", c["interface.thrust"][-1] / (6.5 + 9.81 * 0.011098231), 1.0, 1e-6)
print(f"  steel plate: centre {pressed['2.1e8']:.2%} deeper than the rigid one, {bent['2.1e8']:.2%} deeper than its rim")
checks.near("plate: bending of 2.1e9 kPa / a tenth of that of 2.1e8", 10 * bent["2.1e9"] / bent["2.1e8"], 1.0, 4 * bent["2.1e8"])
checks.near("plate: bending of 2.1e10 kPa / a tenth of that of 2.1e9", 10 * bent["2.1e10"] / bent["2.1e9"], 1.0, 4 * bent["2.1e8"])
checks.small("plate: settlement of 2.1e10 kPa over that of a rigid plate", abs(pressed["2.1e10"]), 1e-4)
if not args.quick:
    # The impact: momentum, and both plates alike to what the steel bends at rest.
    steel, rigid = run(here / "steel.nml"), run(here / "steel.nml", rigid_body)
    steel, rigid, h = read(steel / "contact.csv"), read(rigid / "contact.csv"), read(steel / "histories.csv")
    impact = rigid["time"] > 1
    centre, plate = h["centre.u_z"][2:] - h["centre.u_z"][1], rigid["rigid.u_z"][impact] - rigid["rigid.u_z"][~impact]
    peaks = [c["interface.thrust"].max() for c in (steel, rigid)]
    checks.near("impact: largest thrust, steel / rigid", peaks[0] / peaks[1], 1.0, bent["2.1e8"])
    checks.near("impact: largest settlement of the centre, steel / rigid", centre.min() / plate.min(), 1.0, bent["2.1e8"])

# Drainage that follows the contact. Incompressible water: what has flown out is the volume that the surface lost. The scheme's rates
# lie half a step ahead (rho_inf = 0), so half a step's volume is added; ledger.csv has seven digits.
DRAIN, STEP = here / "drain.nml", 0.05
following = run(DRAIN, [("threads = 1", "threads = 1\n   checkpoint_steps = 65")])
fixed = run(DRAIN, [("drainage = 'state'", "drainage = 'fixed'"), ("group = 'top'\n   field = 'p_w'", "group = 'top_2'\n   field = 'p_w'")])
checks.small("drainage: files of the push that differ between drainage by state and the rest of the surface drained",
             sum((following / name).read_bytes() != (fixed / name).read_bytes() for name in ("nodes_push.csv", "points_push.csv")), 0)
drain, ledger, water = (read(following / name) for name in ("contact.csv", "ledger.csv", "histories.csv"))


def volume(nodes, field):
    """Integral of a field over the surface, whose edges are quadratic."""
    on = np.flatnonzero(nodes["z"] == 0)
    on = on[np.argsort(nodes["r"][on])]
    r, value, total = nodes["r"][on], nodes[field][on], 0.0
    for at, weight in zip(*np.polynomial.legendre.leggauss(3)):
        shape = np.array([-at * (1 - at) / 2, 1 - at**2, at * (1 + at) / 2])
        for k in range(0, len(r) - 2, 2):
            total += weight * (r[k + 2] - r[k]) / 2 * 2 * np.pi * (shape @ r[k:k + 3]) * (shape @ value[k:k + 3])
    return total


for stage, row in (("push", 59), ("lift", -1)):
    nodes, touching = read(following / f"nodes_{stage}.csv"), read(following / f"contact_{stage}.csv")
    lost = -volume(nodes, "u_z") - 0.5 * STEP * volume(nodes, "v_z")
    checks.near(f"drainage, {stage}: outflow / volume lost", ledger["outflow"][row] / lost, 1.0, 2e-6 * ledger["outflow"].max() / lost)
    covered = {r for r, share, p in zip(touching["r"], touching["coverage"], touching["pressure"]) if share >= 0.5 and p > 0}
    surface_pressure = {r: p for r, z, p in zip(nodes["r"], nodes["z"], nodes["p_w"]) if z == 0}
    checks.small(f"drainage, {stage}: pressure of the nodes not in contact [kPa]", max(abs(p) for r, p in surface_pressure.items() if r not in covered), 1e-15)
    checks.near(f"drainage, {stage}: impervious nodes", drain["interface.sealed"][row], len(covered), 0)
    if covered:
        checks.small(f"drainage, {stage}: 0.01 kPa / least pressure under the plate", 0.01 / min(surface_pressure[r] for r in covered), 1.0)
switched = np.flatnonzero(np.diff(drain["interface.sealed"])) + 1
checks.near("drainage: impervious nodes in push, and after it", [drain["interface.sealed"][:60].min(), drain["interface.sealed"][-1]], [8, 0], 0)
# A restart in the middle of the switching decides the same.
checks.small("drainage: switches before and after the checkpoint that are missing", 2 - (switched.min() < 65) - (switched.max() >= 65), 0)
again = scratch() / "again"
shutil.copytree(following, again)
run(DRAIN, [("threads = 1", "threads = 1\n   checkpoint_steps = 65")], more=("--restart", again / "checkpoint.h5"), folder=again)
checks.small("drainage: files that differ after a restart while nodes switch",
             sum((again / path.name).read_bytes() != path.read_bytes() for path in following.iterdir() if path.suffix in (".csv", ".h5")), 0)

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
    # Steps a period of the plate on its penalty, and energy gained: what CONTACT.md says of the step.
    print("  fall: penalty, rho_inf, steps a period, energy gained / at the start")
    slow = []
    for penalty in (1.0e7, 1.0e8):
        period = 2 * np.pi * np.sqrt(0.0111 / (penalty * np.pi * 0.15**2))
        for rho in ("0.8", "0.5"):
            for step in (2.0e-5, 1.0e-5, 5.0e-6, 2.5e-6):
                l = read(run(here / "fall.nml", [("dt = 1.0e-5", f"dt = {step}"), ("rho_inf = 0.8", f"rho_inf = {rho}"),
                                                 ("penalty = 1.0e7", f"penalty = {penalty}")]) / "ledger.csv")
                energy = l["kinetic"] + l["skeleton"] - l["gravity"] - l["loads"]
                gain = max(0.0, np.max(energy / energy[0] - 1))
                print(f"  {penalty:.0e} {rho} {period / step:6.1f} {gain:.1e}")
                if period / step > 39:
                    slow.append(gain)
    checks.small("fall, forty steps a period or more: energy gained / at the start", max(slow), 1e-3)

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

    fig, axes = figure(2)
    x = np.linspace(0, 1, 200)
    axes[0].plot(x, np.sqrt(1 - x**2), "k-", lw=1, label="closed form")
    for (name, one), style in zip(bodies.items(), "ox+"):
        axes[0].plot(one.r / one.a, one.p / one.peak, style, ms=5, mfc="none", label=name)
    axes[0].set(xlabel="r / a", ylabel="pressure / peak", title="sphere and cylinder on a half space", xlim=(0, 1.3))
    axes[0].legend(fontsize=8)
    if not args.quick:
        edges = [one.edge for one in series]
        axes[1].loglog(edges, [one.error for one in series], "o-", label="pressure within 0.8 a")
        axes[1].loglog(edges, series[-1].error * (np.array(edges) / edges[-1])**2, "k--", lw=1, label="second order")
        axes[1].set(xlabel="edge / a", ylabel="error / peak", title="mesh halved, penalty times four")
        axes[1].legend(fontsize=8)
    fig.savefig(here / "hertz.png", dpi=130)

    fig, axes = figure(3)
    for young, name, style in (("rigid", "rigid", "k-"), ("2.1e8", "steel", "C0--"), ("3.0e6", "E = 3 GPa", "C1-")):
        if young not in surfaces:
            continue
        r, p, r_surface, u = surfaces[young]
        axes[0].plot(r[r <= 0.15] * 1e3, p[r <= 0.15], style, label=name)
        axes[1].plot(r_surface * 1e3, u * 1e3, style, label=name)
    axes[0].set(xlabel="r [mm]", ylabel="contact pressure [kPa]", title="6.5 kN at rest", ylim=(0, 300))
    axes[1].set(xlabel="r [mm]", ylabel="soil surface [mm]", title="6.5 kN at rest")
    if not args.quick:
        axes[2].plot((rigid["time"][impact] - 1) * 1e3, plate * 1e3, "k-", label="rigid")
        axes[2].plot((rigid["time"][impact] - 1) * 1e3, (centre - plate) * 1e5, "C0--", label="100 x (centre of steel - rigid)")
        axes[2].set(xlabel="time [ms]", ylabel="plate [mm]", title="impact")
    for axis in axes:
        axis.legend(fontsize=8)
    fig.savefig(here / "plate.png", dpi=130)

    fig, axes = figure(2)
    axes[0].plot(water["time"], water["centre.p_w"], label="under the plate's centre")
    axes[0].plot(water["time"], water["aside.p_w"], label="beside the plate")
    axes[0].set(xlabel="time [s]", ylabel="$p_w$ [kPa]", title="pressed, held, lifted")
    axes[0].legend(fontsize=8)
    axes[1].step(drain["time"], drain["interface.sealed"], where="pre")
    axes[1].set(xlabel="time [s]", ylabel="impervious nodes", title="drainage by state")
    fig.savefig(here / "drain.png", dpi=130)
checks.end()
