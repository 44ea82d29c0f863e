# SPDX-License-Identifier: MIT
"""Hard cases of the host that run to their end: contact, pore water, failure, meshes."""
import math

import numpy as np
from host_runs import BOTH, SETTINGS, HostCase
from host_scenes import (AIR, HENRY, WATER as BULK, bank, column, drawdown, fading, falling, footing, impact, meshes, raft, rectangle, shaken_air, showers,
                         spin, square, tolerant)

DEFAULT = SETTINGS[:1]
CONTACT, WATER, FAILURE, MESH = "contact", "pore water", "failure", "mesh"
PRESSURE = "pore pressure deeper than two elements against the closed form, of the load [%]"
CREATED = "energy created, share of the largest work [%]"
STEPS = (0.1, 1, 10)
PENALTIES = tuple(10.0 ** n for n in range(5, 11))
PERMEABILITIES = tuple(10.0 ** -n for n in range(8, 15))


def created(runs):
    """Energy out of nothing in the dynamic stage, of the largest work so far: what the run itself is stopped by [%]."""
    worst = 0.0
    for run in runs.values():
        table = run.ledger
        stage = table["stage"] == table["stage"].max()
        work = np.maximum.accumulate(np.max([np.abs(table[name]) for name in ("loads", "supports", "gravity", "kinetic", "skeleton", "pores")], axis=0))
        if run.code == 0:
            worst = max(worst, 100 * float(np.max(-(table["imbalance"][stage] - table["imbalance"][stage][0]) / np.maximum(work[stage], 1e-300))))
    return worst


def settlement(run):
    return float(-run.histories["centre.u_z"].min())


def settlements(runs):
    return [settlement(run) for run in runs.values()]


def last_settlement(runs):
    return [float(run.histories["centre.u_z"][-1]) for run in runs.values()]


def spread(labels, reference):
    """By how much the settlement of some runs is off that of another one [%]."""
    return lambda runs: max(100 * abs(settlement(runs[label]) / settlement(runs[reference]) - 1) for label in labels)


def off_terzaghi(runs):
    """Pore pressure deeper than two elements below the drained side against the closed form of one implicit step: p - l2 p'' = p_0 with
    p = 0 on top, l2 = c dt/1.5 (generalised alpha, rho_inf 0) [% of the load]."""
    stiffness, water = 1.2e4, 2.2e6 / (0.8 / 1.8)   # oedometric, of the pores' water [kPa]
    jump = 100 / (1 + stiffness / water)
    worst = 0.0
    for label, run in runs.items():
        nodes = run.table("nodes_load")
        depth = 1 - nodes["z"]
        length = math.sqrt(float(label) / 1e-6 / (1 / stiffness + 1 / water) * 1e-3 / 1.5)
        exact = jump * (1 - (np.exp(-depth / length) + np.exp(-(2 - depth) / length)) / (1 + np.exp(-2 / length)))
        worst = max(worst, float(np.max(np.abs(nodes["p_w"] - exact)[depth > 2 / 8 + 1e-9])))
    return worst


def off_the_limit(runs):
    """Largest difference of settlement and of largest pore pressure between two permeabilities that are as good as none [%]."""
    pairs = zip(*((settlement(run), float(np.max(np.abs(run.histories["centre.p_w"])))) for run in runs.values()))
    return max(100 * abs(a / b - 1) for a, b in pairs)


def above_limit(runs):
    """Pressure of the surface above that of its pond, and rain that neither entered nor ran off, of what fell [%]."""
    worst = 0.0
    for run in runs.values():
        row, pressure = run.table("reactions_rain"), run.histories["centre.p_w"]
        fallen = np.sum(row["top.inflow_w"])
        worst = max(worst, 100 * float(np.max(pressure)) / (9.81 * 0.02) - 100, 100 * float(np.sum(np.maximum(0, -row["top.outflow_w"])) / fallen),
                    100 * float(np.sum(np.maximum(0, row["top.outflow_w"] - row["top.inflow_w"])) / fallen))
    return worst


def off_the_weight(runs):
    """Force of the base against the weight of the ground that is there at the end of every stage of the bank [%]. Mass and volume at the start of
    each layer; small strains: the weight of an element follows its void ratio by less than what is asked."""
    worst = 0.0
    for run in runs.values():
        for name, height in (("rest", 2), ("one", 2.5), ("two", 3), ("three", 3.5), ("cut", 2.5)):
            weight = 2 * height * 2.7 / 1.85 * 9.81
            worst = max(worst, 100 * abs(float(run.table("reactions_" + name)["bottom.force_z"][-1]) / weight - 1))
    return worst


def off_the_spin(runs):
    """Force of the base against the weight at 50 g [%]."""
    weight = 0.2 * 0.3 * 2.7 / 1.9 * 490.5
    return max(100 * abs(float(run.table("reactions_spin")["bottom.force_z"][-1]) / weight - 1) for run in runs.values())


def off_the_faded(runs):
    """Force of the base against weight and loads at the end [%]."""
    weight = 3 * 2 * 2.7 / 1.8 * 9.81 + 5 * 3 + 30 * 0.5
    return max(100 * abs(float(run.table("reactions_fade")["bottom.force_z"][-1]) / weight - 1) for run in runs.values())


def lost_fluids(runs):
    """Largest change of the air that is kept, by Boyle's and Henry's laws, and of the water, of what there was [%]."""
    worst = 0.0
    for run in runs.values():
        row = run.histories
        water, void = row["centre.S_w"] * row["centre.e"], row["centre.e"]
        air = (AIR + row["centre.p_w"] + row["centre.p_c"]) * (void - (1 - HENRY) * water)
        water = water * np.exp(row["centre.p_w"] / BULK)
        worst = max(worst, *(100 * float(np.max(np.abs(kept / kept[0] - 1))) for kept in (air, water)))
    return worst


def drawn_in(runs):
    """Water that enters through a face that lets water out alone, of what leaves, and pressure of the face above that of the water outside [%]."""
    worst = 0.0
    for run in runs.values():
        out, pressure = run.table("reactions_rain")["right.outflow_w"], run.histories
        outside = 19.62 * np.maximum(0, 1 - pressure["time"] / 60) - 9.81 * 2 / 3 * np.maximum(0, 1 - pressure["time"] / 60)
        worst = max(worst, 100 * float(np.sum(np.maximum(0, -out)) / np.sum(np.maximum(0, out))),
                    100 * float(np.max(pressure["centre.p_w"] - outside)) / 19.62)
    return worst


def surface_pressures(runs):
    return [float(run.histories["centre.p_w"][-1]) for run in runs.values()]


def base_pressures(runs):
    return [float(run.histories["base.p_w"][-1]) for run in runs.values()]


def pressure(run):
    """Force on the footing at the end [kN]."""
    return float(run.table("reactions_push")["top_1.force_z"][-1])


def half_steps(runs):
    fine, coarse = pressure(runs["fine"]), pressure(runs["coarse"])
    return 100 * abs(coarse / fine - 1)


def forces(runs):
    return [pressure(run) for run in runs.values()]


def uneven(runs):
    """Stress anywhere in any mesh against that of the regular one [%]."""
    regular = runs["regular"].table("points_press")
    reference = {name: float(np.mean(regular[name])) for name in ("s_rr", "s_zz", "s_tt")}
    size = max(map(abs, reference.values()))
    return max(100 * float(np.max(np.abs(run.table("points_press")[name] - reference[name]))) / size for run in runs.values() for name in reference)


def stresses(runs):
    return [float(np.mean(run.table("points_press")["s_zz"])) for run in runs.values()]


def footing_case(name, hard, **soil):
    return HostCase(name, FAILURE, hard, "force at a settlement of 25 cm by 10 steps against 20 [%]", 5,
                    lambda setting: {"coarse": footing(setting, steps=10, **soil), "fine": footing(setting, steps=20, **soil)}, half_steps, forces,
                    nudged=("coarse",))


def undrained(pressures, hard, **more):
    """Saturated soil under the plate with a permeability that is as good as none."""
    return HostCase(f"impact on undrained soil, {pressures} pressures", WATER, hard,
                    "settlement and pore pressure under the plate by k 1e-14 against 1e-13 m2 [%]", 2,
                    lambda setting: {f"{k:.0e}": impact(setting, suction=0, k=k, pressures=pressures, duration=0.021) for k in (1e-13, 1e-14)}, off_the_limit, settlements,
                    **more)


CASES = (
    HostCase("chatter", CONTACT, "a light plate on a stiff penalty opens and closes every few steps; a scheme that is not dissipative there creates energy", CREATED, 1,
             lambda s: {str(dt): falling(s, penalty=1e8, dt=dt, duration=0.003) for dt in (3e-6, 1e-5, 3e-5)}, created, settlements, BOTH),
    HostCase("lift-off and re-impact", CONTACT, "unsaturated soil rebounds; the plate lifts off and falls on it again several times", CREATED, 1,
             lambda s: {"": impact(s, duration=0.06, pulse=0.01, force=3)}, created, last_settlement),
    HostCase("re-impact with friction", CONTACT, "as before, with friction of 0.5: nodes stick, slide, open and touch again within steps; tractions that outlive a contact create energy",
             CREATED, 1, lambda s: {"": impact(s, duration=0.06, pulse=0.01, force=3, friction=0.5)}, created, last_settlement, DEFAULT),
    undrained("quadratic", "saturated, sealed, no volume may change: every element is a constraint",
              limit="as for the column: pore pressures oscillate from node to node, and the run warns of it; `pressures = 'linear'` is the remedy"),
    undrained("linear", "as before, with pressures an order below displacements"),
    HostCase("impact at suction 100 kPa", CONTACT, "the paper's analysis breaks down here without its remedy: reloading is far too stiff", CREATED, 1,
             lambda s: {"": impact(s, suction=100, duration=0.03)}, created, settlements),
    HostCase("steps of 3e-6 to 3e-4 s", CONTACT, "a tenth to ten times the paper's step",
             "settlement after 1.5 ms by up to ten times the paper's step against a tenth of it [%]", 5,
             lambda s: {str(x): impact(s, dt=3e-5 * x, duration=0.0015) for x in STEPS}, spread(("1", "10"), "0.1"), settlements),
    HostCase("steps of 3e-3 s", CONTACT, "a hundred times the paper's step: five steps to the peak of the load", CREATED, 1,
             lambda s: {"": impact(s, dt=3e-3)}, created, settlements),
    HostCase("steps of 3e-3 s, energy alarm at 10 %", CONTACT, "as before, with `created_energy = 0.1`", "settlement against that by steps of 3e-4 s [%]", 10,
             lambda s: {"3e-4": impact(s, duration=0.021), "3e-3": tolerant(impact(s, dt=3e-3, duration=0.021))}, spread(("3e-3",), "3e-4"), settlements),
    HostCase("penalty 1e5 to 1e10 kN/m3", CONTACT, "a soft penalty is compliant, a stiff one makes the matrix ill-conditioned and oscillates",
             "settlement after 6 ms by 1e8 (the default) and 1e10 against 1e9 [%]", 5,
             lambda s: {f"{x:.0e}": impact(s, penalty=x, duration=0.006) for x in PENALTIES}, spread(("1e+08", "1e+10"), "1e+09"), settlements),
    HostCase("permeability 1e-8 to 1e-14 m2, quadratic pressures", WATER,
             "a layer that drains in the first step is thinner than an element; pressures of the order of displacements violate the inf-sup condition",
             PRESSURE, 10, lambda s: {f"{k:.0e}": column(s, k, "quadratic") for k in PERMEABILITIES}, off_terzaghi, base_pressures, DEFAULT,
             limit="displacements and pressures of one order have no stable pressures without drainage: `pressures = 'linear'` is the remedy"),
    HostCase("permeability 1e-8 to 1e-14 m2, linear pressures", WATER, "as before, with pressures an order below displacements",
             PRESSURE, 10, lambda s: {f"{k:.0e}": column(s, k, "linear") for k in PERMEABILITIES}, off_terzaghi, base_pressures, DEFAULT),
    HostCase("showers", WATER, "rain of three times the conductivity, five times on and off: the surface of unsaturated sand ponds and dries",
             "pressure above the pond's, water drawn in at the limit, and run-off beyond the rain, of pond and rain [%]", 0.1,
             lambda s: {"": showers(s)}, above_limit, surface_pressures, DEFAULT),
    HostCase("a bank in layers, cut again", FAILURE, "new ground without stress, where sand has no stiffness; two layers leave at once",
             "force of the base against the weight of the ground at the end of each stage [%]", 1.0,
             lambda s: {"": bank(s)}, off_the_weight, last_settlement, DEFAULT),
    HostCase("a raft that rocks on sand", CONTACT, "a rigid body lifts off on one side, comes back and slides, on soil that yields under its edges", CREATED, 1,
             lambda s: {f"steps of {dt} s": raft(s, dt) for dt in (1e-3, 4e-3)}, created, last_settlement, DEFAULT),
    HostCase("drawdown at a seepage face", WATER, "the water outside falls in a minute: node by node a face of saturated loose sand goes from held to free",
             "water drawn in of what leaves, and pressure of the face above that outside, of the first [%]", 0.1,
             lambda s: {"": drawdown(s)}, drawn_in, surface_pressures, DEFAULT),
    HostCase("spin-up of loose sand", FAILURE, "gravity grows fiftyfold; at its surface sand has no stress", "force of the base against the weight at 50 g [%]", 1.0,
             lambda s: {"": spin(s)}, off_the_spin, last_settlement, DEFAULT),
    HostCase("strength that falls, comes back and falls", FAILURE, "under loads that stay every point loses its share of the stress at once, to 0.7, then to 0.6",
             "force of the base against weight and loads [%]", 1.0, lambda s: {"": fading(s)}, off_the_faded, last_settlement, DEFAULT),
    HostCase("air that cannot escape, shaken", WATER, "nearly saturated loose sand in twenty cycles: the stiffness of the pores grows with the pressure",
             "change of the air and of the water that are kept [%]", 0.1, lambda s: {"": shaken_air(s)}, lost_fluids, surface_pressures, DEFAULT),
    footing_case("footing on loose sand", "the tangent of a softening or perfectly plastic soil is nearly singular", void_ratio=0.907),
    footing_case("footing on dense sand", "softening and dilation under the edge", void_ratio=0.75),
    footing_case("footing on undrained sand", "no volume change, and loose sand loses its strength", void_ratio=0.907, undrained=True,
                 pressures="linear"),
    footing_case("footing at suction 100 kPa", "a stiff, strong crust over a soft edge", void_ratio=0.907, suction=100),
    HostCase("slivers, distorted and graded meshes", MESH, "angles of 0.1 degrees, corners moved by 0.4 of an element, sizes over five decades",
             "stress anywhere against that of a regular mesh [%]", 0.01,
             lambda s: {name: square(s, mesh) for name, mesh in meshes().items()}, uneven, stresses),
)
REFUSED_MESH = rectangle([0, 0.5, 1], [0, 0.5, 1], bulge=0.9)   # its first element folds over
