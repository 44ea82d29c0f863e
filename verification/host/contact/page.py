# SPDX-License-Identifier: MIT
"""Contact: patch tests, punch, sphere and cylinder, refinement, deformable plate, drainage, bar, falling plate."""
import shutil

import make_meshes
import numpy as np
from tools import tables
from tools.bench import number
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="contacts transmit a uniform pressure through meshes that do not match, reproduce the closed "
          "forms of punch, sphere and cylinder, give the rigid plate as the stiff limit of a deformable "
          "one, seal the surface in contact if drainage follows the contact, and conserve momentum in "
          "impacts without gain of energy",
    kind=("exact", "conservation"),
    input="`patch.nml`, `split.nml`, `punch.nml`, `hertz.nml`, `steel.nml`, `drain.nml`, `bar.nml`, `fall.nml`; "
          "`make_meshes.py` wrote the meshes, finer ones are made as they are "
          "needed",
    reference="closed forms of the punch and of Hertz, 2 L/c and 2 m v of the bar; balances of volume, momentum and "
              "energy; limits of stiffness",
    seconds=60, quick=10, pictures=("contact.png", "hertz.png", "plate.png", "drain.png"))
MAKES = (Script("make_meshes.py", ("*.msh",), 1),)

POINTWISE = ("penalty = 1.0e6", "penalty = 1.0e6\n   gap = 'pointwise'")
PLANE = ("'axisymmetric'", "'plane_strain'")
STATIC = [("analysis = 'dynamic'", "analysis = 'static'"), ("duration = 0.04", "duration = 0.014"),
          ("dt = 1.0e-4", "dt = 0.014"),
          # of all forces: what the stiffest plate changes is rounding of what it carries
          ("tolerance = 1.0e-5", "tolerance = 1.0e-9\n   measure = 'forces'")]
RIGID = [("master = 'plate_bottom'", "master = 'rigid'"), ("value = 91.95618934", "value = 0"),
         ("&history", """&plate name = 'rigid' r = 0, 0.15 mass = 0.011098231 weight = 'yes'
   force = -6.5 history = 'triangle' /
&fix group = 'plate' field = 'u_r' /
&fix group = 'plate' field = 'u_z' /
&history""")]
RADIUS, APPROACH = 10.0, 2.5e-4
MODULUS = 1 / ((1 - 0.3**2) / 1.0e4 + (1 - 0.2**2) / 2.0e4)

UNIFORM = Tolerance("direct solution of a well-posed problem: rounding, times 1e4 for E/eps and the mesh",
                    absolute=1e-8)
FAR_BOUNDARY = Tolerance("the domain's boundary adds a share of the order of a/R, measured 2.4 % at 40 a, 1.2 % at 80 "
                         "a, 0.6 % at 160 a", absolute=0.01)
NO_BOUNDARY = Tolerance("two domains give the value without the boundary; the mesh (halved: 0.01 %) and the penalty "
                        "are far below", absolute=0.0025)
CLOSED_APPROACH = Tolerance("the boundary makes the approach too small by a share of the order of a/L, measured 3 % at "
                            "20 a, 1.4 % at 40 a", absolute=1 / 40)
OPEN_APPROACH = Tolerance("the remaining error of two domains is the second order, (1/40)**2, the penalty, 1e-3, and the "
                          "sphere's own curve, L/R = 0.2", absolute=0.005)
MEAN_ORDER = Tolerance("smooth inside, so that quadratic displacements and linear pressures should give 2; the edge of "
                       "the contact, where the pressure has a vertical tangent, "
                       "falls on another place of an element with every mesh, which moves single halvings",
                       absolute=0.25)
LOWEST_ORDER = Tolerance("every halving at least of first order")
PENALTY_ORDER = Tolerance("the penalty alone is an error of first order; the next order is of its own size",
                          absolute=0.1)
EQUILIBRIUM = Tolerance("equilibrium holds to 1e-9 of all forces, of which the soil's weight is some hundred times the "
                        "load", absolute=1e-6)
STIFF_LIMIT = Tolerance("1e10 kPa instead of infinity: a hundredth of the steel's bending", absolute=1e-4)
EXACTLY = Tolerance("the same computation")
COUNTED = Tolerance("a count")
PRESCRIBED = Tolerance("prescribed to zero", absolute=1e-15)
SEALED = Tolerance("under the plate nothing flows out: at least 0.01 kPa", absolute=1.0)
SHORT_WAVES = ("algorithmic damping takes the shortest waves: an energy share of a few per mille of the jump that 50 "
               "cells cannot carry")
CONTACT_TIME, IMPULSE, BAR_ENERGY = (Tolerance(SHORT_WAVES, absolute=a) for a in (0.02, 0.002, 0.005))
MOMENTUM = Tolerance("Newton's tolerance of 1e-6 over 600 steps bounds what is missing by 6e-4, the end of the "
                     "generalised-alpha step by dt times an acceleration", absolute=1e-3)
DAMPED = Tolerance("with damping no energy is gained, up to the tolerance of Newton", absolute=1e-6)
OPENING = Tolerance("with little damping a step that opens or closes a contact makes an error of first order in the "
                    "step", absolute=1e-3)
FIRST_ORDER = Tolerance("first order in the step: half, with a margin for the step that contains an opening", absolute=0.6)


def read(folder, *names):
    found = [tables.columns(folder / f"{name}.csv") for name in names]
    return found[0] if len(found) == 1 else found


def check(bench):
    patches(bench)
    punch(bench)
    bodies, series = hertz(bench)
    surfaces, impact = plates(bench)
    drain, water = drainage(bench)
    return {"bodies": bodies, "series": series, "surfaces": surfaces, "impact": impact, "drain": drain, "water": water,
            "bar": bar(bench),
            "fall": falling_plate(bench)}


def patches(bench):
    """100 kPa in every point of all blocks; the penalty (1e6 kN/m3) alone lets them overlap by p/eps = 1e-4 m, of which
    the mesh has 1e-6 m from the start."""
    pressure, penalty = 100.0, 1.0e6
    swap = [("slave = 'lower_top'", "slave = 'upper_bottom'"), ("master = 'upper_bottom'", "master = 'lower_top'")]
    for name, scene, changes in (("master finer", "patch", []), ("master coarser", "patch", swap),
                                 ("pointwise gap", "patch", [POINTWISE]),
                                 ("plane strain", "patch", [PLANE]), ("end inside an edge", "split", []),
                                 ("end inside an edge, pointwise gap", "split", [POINTWISE]),
                                 ("end inside an edge, plane strain", "split", [PLANE]),
                                 ("end inside an edge, plane strain, pointwise gap", "split", [PLANE, POINTWISE])):
        points, touching = read(bench.host(f"{scene}.nml", changes), "points_load", "contact_load")
        bench.near(f"patch, {name}: vertical stress / pressure", points["s_zz"] / pressure, -1.0, UNIFORM)
        bench.below(f"patch, {name}: other stresses / pressure",
                    max(np.abs(points[s]).max() for s in ("s_rr", "s_tt", "s_rz")) / pressure, UNIFORM)
        gap = touching["gap"][touching["coverage"] > 0]
        bench.near(f"patch, {name}: penetration / (p/eps)", gap * penalty / pressure, -1.0, UNIFORM)


def punch(bench):
    """P = 2 E a w/(1 - nu**2)."""
    exact = 2 * 1.0e4 * 0.15 * 1.0e-3 / (1 - 0.3**2)
    forces = []
    for domain in (12, 24):
        folder = bench.host("punch.nml", [("0.3, 24", f"0.3, {domain}"), ("z = -24", f"z = -{domain}")])
        forces.append(read(folder, "contact")["footing.thrust"][-1])
    bench.near("punch, 160 radii: force / closed form", forces[1] / exact, 1.0, FAR_BOUNDARY)
    bench.near("punch, domain extrapolated: force / closed form", (2 * forces[1] - forces[0]) / exact, 1.0, NO_BOUNDARY)


class Hertz:
    """A run of two elastic bodies, and the closed form at its force. Sphere: a**3 = 3 P R/(4 E*), peak 3 P/(2 pi a**2),
    approach a**2/R. Cylinder, force P' a unit of length: a**2 = 4 P' R/(pi E*), peak 2 P'/(pi a)."""

    def __init__(self, bench, cells, domain, *changes):
        mesh = bench.folder() / "hertz.msh"
        make_meshes.hertz(RADIUS, 0.05, cells, domain).write(mesh)
        c, touching = read(bench.host("hertz.nml", [("'hertz.msh'", f"'{mesh}'"), *changes]), "contact",
                           "contact_press")
        self.force, area = c["touch.thrust"][-1], c["touch.area"][-1]
        order = np.argsort(touching["r"])
        self.r, self.p, self.weight = (touching[name][order] for name in ("r", "pressure", "weight"))
        if PLANE in changes:
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


def hertz(bench):
    """Bodies by name, and the series of meshes."""
    cells = 6 if bench.quick else 12
    bodies = {"sphere": Hertz(bench, cells, 20), "cylinder": Hertz(bench, cells, 20, PLANE, ("-2.5e-4", "-5.0e-4"))}
    if not bench.quick:
        bodies["sphere, pointwise gap"] = Hertz(bench, cells, 20, ("'nodal'", "'pointwise'"))
    for name, one in bodies.items():
        half_edge = Tolerance("the edge of the contact is known to half an edge of the mesh: a node is in contact or "
                              "not", absolute=0.5 * one.edge)
        smooth = Tolerance("inside the pressure is smooth, and its error of the second order, (edge/a)**2; the penalty "
                           "of 1e8 kN/m3 lets the surfaces overlap by less than 1e-3 "
                           "of the approach", absolute=one.edge**2)
        if "pointwise" not in name:
            # Pointwise, a node is active as soon as its hat is touched: the area says less.
            bench.near(f"{name}: radius of the active area / closed form", one.reached / one.a, 1.0, half_edge)
        bench.near(f"{name}: radius from the pressures inside / closed form", one.fitted[0], 1.0, smooth)
        bench.near(f"{name}: peak from the pressures inside / closed form", one.fitted[1], 1.0, smooth)
        bench.near(f"{name}: pressure on the axis / closed form", one.p[0] / one.peak, 1.0, smooth)
    near, far = (APPROACH / (one.a**2 / RADIUS) for one in (bodies["sphere"], Hertz(bench, cells, 40)))
    bench.near("sphere, 40 radii: approach / closed form", far, 1.0, CLOSED_APPROACH)
    bench.near("sphere, domain extrapolated: approach / closed form", 2 * far - near, 1.0, OPEN_APPROACH)
    if bench.quick:
        return bodies, []
    series = [Hertz(bench, n, 20, ("1.0e8", f"{2.0e7 * (n / 3)**2:.3e}")) for n in (3, 6, 12, 24)]
    orders = np.log2([one.error / finer.error for one, finer in zip(series, series[1:])])
    bench.note(f"mesh halved and penalty times four: error of the pressure within 0.8 a "
               f"{', '.join(f'{one.error:.2e}' for one in series)}; orders {orders.round(2)}")
    bench.below("refinement: 2 less the mean order of three halvings", 2 - orders.mean(), MEAN_ORDER)
    bench.below("refinement: 1 less the lowest order", 1 - orders.min(), LOWEST_ORDER)
    forces = [Hertz(bench, 6, 20, ("1.0e8", eps)).force for eps in ("4.0e6", "1.6e7", "6.4e7")]
    order = np.log((forces[1] - forces[0]) / (forces[2] - forces[1])) / np.log(4)
    bench.near("penalty times four: order of the force", order, 1.0, PENALTY_ORDER)
    return bodies, series


def surface(folder):
    """Contact pressure and settlement of the soil's surface by radius."""
    nodes, touching = read(folder, "nodes_impact", "contact_impact")
    on = np.flatnonzero((nodes["z"] == 0) & (nodes["r"] <= 0.3))
    on, order = on[np.argsort(nodes["r"][on])], np.argsort(touching["r"])
    return touching["r"][order], touching["pressure"][order], nodes["r"][on], nodes["u_z"][on]


def plates(bench):
    """Deformable plate. Steel of 20 mm on this soil is nearly rigid: what it bends is 1/E of the plate to first order,
    so ten times the modulus must give a tenth (but for a share of the order of the bending itself), and 1e10 kPa the
    rigid plate to 1e-4."""
    folder = bench.host("steel.nml", RIGID + STATIC)
    settled = np.diff(read(folder, "contact")["rigid.u_z"])[0]
    pressed, bent, surfaces = {}, {}, {"rigid": surface(folder)}
    for young in ("2.1e8", "2.1e9", "2.1e10", *(() if bench.quick else ("3.0e6",))):
        folder = bench.host("steel.nml", [*STATIC, ("young = 2.1e8", f"young = {young}")])
        h, c = read(folder, "histories", "contact")
        moved = {name: h[f"{name}.u_z"][-1] - h[f"{name}.u_z"][-2] for name in ("centre", "rim")}
        bent[young] = (moved["centre"] - moved["rim"]) / settled
        pressed[young] = moved["centre"] / settled - 1
        surfaces[young] = surface(folder)
        bench.near(f"plate of {young} kPa: thrust / load and weight",
                   c["interface.thrust"][-1] / (6.5 + 9.81 * 0.011098231), 1.0, EQUILIBRIUM)
    bench.note(f"steel plate: centre {pressed['2.1e8']:.2%} deeper than the rigid one, {bent['2.1e8']:.2%} deeper than "
               f"its rim")
    second = Tolerance("the bending of a nearly rigid plate is 1/E to first order; the next order is a share of the size "
                       "of the bending itself: four times it", absolute=4 * bent["2.1e8"])
    bench.near("plate: bending of 2.1e9 kPa / a tenth of that of 2.1e8", 10 * bent["2.1e9"] / bent["2.1e8"], 1.0,
               second)
    bench.near("plate: bending of 2.1e10 kPa / a tenth of that of 2.1e9", 10 * bent["2.1e10"] / bent["2.1e9"], 1.0,
               second)
    bench.below("plate: settlement of 2.1e10 kPa over that of a rigid plate", abs(pressed["2.1e10"]), STIFF_LIMIT)
    if bench.quick:
        return surfaces, None
    # The impact: momentum, and both plates alike to what the steel bends at rest.
    c_steel, h = read(bench.host("steel.nml"), "contact", "histories")
    c_rigid = read(bench.host("steel.nml", RIGID), "contact")
    impact = c_rigid["time"] > 1
    centre = h["centre.u_z"][2:] - h["centre.u_z"][1]
    plate = c_rigid["rigid.u_z"][impact] - c_rigid["rigid.u_z"][~impact]
    peaks = [c["interface.thrust"].max() for c in (c_steel, c_rigid)]
    bending = Tolerance("both plates agree to the bending of the steel at rest", absolute=bent["2.1e8"])
    bench.near("impact: largest thrust, steel / rigid", peaks[0] / peaks[1], 1.0, bending)
    bench.near("impact: largest settlement of the centre, steel / rigid", centre.min() / plate.min(), 1.0, bending)
    return surfaces, (c_rigid["time"][impact] - 1, plate, centre)


def integral(nodes, field):
    """Integral of a field over the surface, whose edges are quadratic."""
    on = np.flatnonzero(nodes["z"] == 0)
    on = on[np.argsort(nodes["r"][on])]
    r, value, total = nodes["r"][on], nodes[field][on], 0.0
    for at, weight in zip(*np.polynomial.legendre.leggauss(3)):
        shape = np.array([-at * (1 - at) / 2, 1 - at**2, at * (1 + at) / 2])
        for k in range(0, len(r) - 2, 2):
            total += weight * (r[k + 2] - r[k]) / 2 * 2 * np.pi * (shape @ r[k:k + 3]) * (shape @ value[k:k + 3])
    return total


def drainage(bench):
    """Drainage that follows the contact. Incompressible water: what has flown out is the volume that the surface lost."""
    checkpoint = [("threads = 1", "threads = 1\n   checkpoint_steps = 65")]
    following = bench.host("drain.nml", checkpoint)
    fixed = bench.host("drain.nml", [("drainage = 'state'", "drainage = 'fixed'"),
                                     ("group = 'top'\n   field = 'p_w'", "group = 'top_2'\n   field = 'p_w'")])
    bench.below("drainage: files of the push that differ between drainage by state and the rest of the surface drained",
                sum((following / name).read_bytes() != (fixed / name).read_bytes()
                    for name in ("nodes_push.csv", "points_push.csv")),
                EXACTLY)
    drain, ledger, water = read(following, "contact", "ledger", "histories")
    for stage, row in (("push", 59), ("lift", -1)):
        nodes, touching = read(following, f"nodes_{stage}", f"contact_{stage}")
        lost = -integral(nodes, "u_z")
        digits = Tolerance("ledger.csv has seven digits", absolute=2e-6 * ledger["outflow"].max() / lost)
        bench.near(f"drainage, {stage}: outflow / volume lost", ledger["outflow"][row] / lost, 1.0, digits)
        covered = {r for r, share, p in zip(touching["r"], touching["coverage"], touching["pressure"]) if share >= 0.5
                   and p > 0}
        on_surface = {r: p for r, z, p in zip(nodes["r"], nodes["z"], nodes["p_w"]) if z == 0}
        bench.below(f"drainage, {stage}: pressure of the nodes not in contact",
                    max(abs(p) for r, p in on_surface.items() if r not in covered), PRESCRIBED,
                    "kPa")
        bench.near(f"drainage, {stage}: impervious nodes", drain["interface.sealed"][row], len(covered), COUNTED)
        if covered:
            bench.below(f"drainage, {stage}: 0.01 kPa / least pressure under the plate",
                        0.01 / min(on_surface[r] for r in covered),
                        SEALED)
    switched = np.flatnonzero(np.diff(drain["interface.sealed"])) + 1
    bench.near("drainage: impervious nodes in push, and after it", [drain["interface.sealed"][:60].min(),
                                                                    drain["interface.sealed"][-1]], [8, 0], COUNTED)
    # A restart in the middle of the switching decides the same.
    bench.below("drainage: switches before and after the checkpoint that are missing",
                2 - (switched.min() < 65) - (switched.max() >= 65), COUNTED)
    again = bench.folder() / "again"
    shutil.copytree(following, again)
    bench.host("drain.nml", checkpoint, more=("--restart", again / "checkpoint.h5"), folder=again)
    bench.below("drainage: files that differ after a restart while nodes switch",
                sum((again / path.name).read_bytes() != path.read_bytes() for path in following.iterdir()
                    if path.suffix in (".csv", ".h5")), EXACTLY)
    return drain, water


def bar(bench):
    """It leaves when the wave comes back, after 2 L/c = 1 ms, with its momentum turned round."""
    c, ledger = read(bench.host("bar.nml"), "contact", "ledger")
    speed, mass = np.sqrt(1.0e7 / 2.5), 2.5 * 0.05
    touching = c["time"][c["end.thrust"] < 0]
    bench.near("bar: contact time / (2 L/c)", (touching[-1] - touching[0]) / (2 / speed), 1.0, CONTACT_TIME)
    bench.near("bar: impulse / 2 m v", -np.sum(c["end.thrust"] * c["dt"]) / (2 * mass), 1.0, IMPULSE)
    bench.near("bar: energy at the end / at the start", (ledger["kinetic"][-1] + ledger["skeleton"][-1]) / (0.5 * mass),
               1.0, BAR_ENERGY)
    return c


def gain(ledger):
    """Energy of plate and body without that of the penalty (never negative), gained over that at the start."""
    energy = ledger["kinetic"] + ledger["skeleton"] - ledger["gravity"] - ledger["loads"]
    return max(0.0, np.max(energy / energy[0] - 1))


def falling_plate(bench):
    gains = {}
    for step in ("1.0e-5",) if bench.quick else ("1.0e-5", "5.0e-6"):
        for rho in ("0.8", "0.5"):
            ledger, c = read(bench.host("fall.nml", [("dt = 1.0e-5", f"dt = {step}"),
                                                     ("rho_inf = 0.8", f"rho_inf = {rho}")]), "ledger",
                             "contact")
            gains[rho, step] = gain(ledger)
            if step == "1.0e-5":
                # The plate's change of momentum is the impulse of contact and weight.
                impulse = np.sum(c["soil_plate.thrust"] * c["dt"]) + np.sum(c["plate.load"] * c["dt"])
                momentum = number((bench.here / "fall.nml").read_text(encoding="utf-8"),
                                  "mass") * (c["plate.v_z"][-1] + 0.05)
                bench.near(f"fall, rho_inf {rho}: impulse / momentum", impulse / momentum, 1.0, MOMENTUM)
    bench.below("fall, rho_inf 0.5: energy gained / at the start", max(g for (rho, _), g in gains.items()
                                                                       if rho == "0.5"), DAMPED)
    bench.below("fall, rho_inf 0.8: energy gained / at the start", gains["0.8", "1.0e-5"], OPENING)
    if bench.quick:
        return c
    bench.below("fall, rho_inf 0.8: that of half the step / of the step",
                gains["0.8", "5.0e-6"] / gains["0.8", "1.0e-5"],
                FIRST_ORDER)
    # Steps a period of the plate on its penalty, and energy gained: what host/CONTACT.md says of the step.
    bench.note("fall: penalty, rho_inf, steps a period, energy gained / at the start")
    slow = []
    for penalty in (1.0e7, 1.0e8):
        period = 2 * np.pi * np.sqrt(0.0111 / (penalty * np.pi * 0.15**2))
        for rho in ("0.8", "0.5"):
            for step in (2.0e-5, 1.0e-5, 5.0e-6, 2.5e-6):
                ledger = read(bench.host("fall.nml", [("dt = 1.0e-5", f"dt = {step}"),
                                                      ("rho_inf = 0.8", f"rho_inf = {rho}\n   created_energy = 1e9"),
                                                      ("penalty = 1.0e7", f"penalty = {penalty}")]), "ledger")
                bench.note(f"{penalty:.0e} {rho} {period / step:6.1f} {gain(ledger):.1e}")
                if period / step > 39:
                    slow.append(gain(ledger))
    bench.below("fall, forty steps a period or more: energy gained / at the start", max(slow), OPENING)
    return c


def draw(bench, results, plt):
    speed, beam, c = np.sqrt(1.0e7 / 2.5), results["bar"], results["fall"]
    figure, axes = plt.subplots(1, 2, figsize=(7.6, 3.2))
    axes[0].plot(beam["time"] * speed / 2, -beam["end.thrust"] / (2.5 * speed * 0.05), label="host")
    axes[0].plot([0, 0, 1, 1, 1.5], [0, 1, 1, 0, 0], "k--", lw=1, label="closed form")
    axes[0].set(xlabel="time c / (2 L)", ylabel="force / (rho c v A)", title="bar against a wall")
    axes[1].plot(c["time"] * 1e3, c["soil_plate.thrust"], label="thrust [kN]")
    axes[1].set(xlabel="time [ms]", ylabel="kN", title="falling plate")
    for axis in axes:
        axis.legend()
    bench.save(figure, "contact.png")

    figure, axes = plt.subplots(1, 2, figsize=(7.6, 3.2))
    x = np.linspace(0, 1, 200)
    axes[0].plot(x, np.sqrt(1 - x**2), "k-", lw=1, label="closed form")
    for (name, one), style in zip(results["bodies"].items(), "ox+"):
        axes[0].plot(one.r / one.a, one.p / one.peak, style, ms=5, mfc="none", label=name)
    axes[0].set(xlabel="r / a", ylabel="pressure / peak", title="sphere and cylinder on a half space", xlim=(0, 1.3))
    axes[0].legend(fontsize=8)
    series = results["series"]
    edges = [one.edge for one in series]
    axes[1].loglog(edges, [one.error for one in series], "o-", label="pressure within 0.8 a")
    axes[1].loglog(edges, series[-1].error * (np.array(edges) / edges[-1])**2, "k--", lw=1, label="second order")
    axes[1].set(xlabel="edge / a", ylabel="error / peak", title="mesh halved, penalty times four")
    axes[1].legend(fontsize=8)
    bench.save(figure, "hertz.png")

    figure, axes = plt.subplots(1, 3, figsize=(11.4, 3.2))
    for young, name, style in (("rigid", "rigid", "k-"), ("2.1e8", "steel", "C0--"), ("3.0e6", "E = 3 GPa", "C1-")):
        r, p, r_surface, u = results["surfaces"][young]
        axes[0].plot(r[r <= 0.15] * 1e3, p[r <= 0.15], style, label=name)
        axes[1].plot(r_surface * 1e3, u * 1e3, style, label=name)
    axes[0].set(xlabel="r [mm]", ylabel="contact pressure [kPa]", title="6.5 kN at rest", ylim=(0, 300))
    axes[1].set(xlabel="r [mm]", ylabel="soil surface [mm]", title="6.5 kN at rest")
    time, plate, centre = results["impact"]
    axes[2].plot(time * 1e3, plate * 1e3, "k-", label="rigid")
    axes[2].plot(time * 1e3, (centre - plate) * 1e5, "C0--", label="100 x (centre of steel - rigid)")
    axes[2].set(xlabel="time [ms]", ylabel="plate [mm]", title="impact")
    for axis in axes:
        axis.legend(fontsize=8)
    bench.save(figure, "plate.png")

    drain, water = results["drain"], results["water"]
    figure, axes = plt.subplots(1, 2, figsize=(7.6, 3.2))
    axes[0].plot(water["time"], water["centre.p_w"], label="under the plate's centre")
    axes[0].plot(water["time"], water["aside.p_w"], label="beside the plate")
    axes[0].set(xlabel="time [s]", ylabel="$p_w$ [kPa]", title="pressed, held, lifted")
    axes[0].legend(fontsize=8)
    axes[1].step(drain["time"], drain["interface.sealed"], where="pre")
    axes[1].set(xlabel="time [s]", ylabel="impervious nodes", title="drainage by state")
    bench.save(figure, "drain.png")
