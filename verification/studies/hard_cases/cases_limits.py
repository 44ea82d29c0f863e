# SPDX-License-Identifier: MIT
"""Hard cases: the ends of the model: no stress, no suction, much suction, the compression line, large increments, other sands."""
import random

from bounds import BOUND, TRAIL, beyond, bounded
from catalogue import Case, last, off_the_clean
from closed_forms import line_pressure, steady_pressure
from point_steps import ACROSS, AXIAL, DENSE, LOOSE, MIDDLE, straight, times

ISOTROPIC = (1 / 3, 1 / 3, 1 / 3, 0.0, 0.0, 0.0)
ANY = "comes to its end"


def nothing(_):
    return 0.0


def rows_along(path, n, change, every=10, suction=0.0):
    for _ in range(every):
        path.go(n // every, times(1 / every, change), suction / every).row()
    return path


# ---- little stress

def tension(setting):
    """Expanded to nothing, sheared there, compressed again."""
    found = {}
    for e in (DENSE, LOOSE):
        path = setting.start(e, 20.0)
        rows_along(path, 100, times(-1e-2, ISOTROPIC)).go(100, times(2e-2, ACROSS)).row()
        found[str(e)] = rows_along(path, 200, times(2e-2, ISOTROPIC))
    return found


def tension_cycles(setting):
    """30 cycles that reach the cut-off and leave it."""
    path = setting.start(MIDDLE, 20.0)
    for _ in range(30):
        path.go(50, times(-8e-3, ISOTROPIC)).row().go(20, times(1e-3, ACROSS)).go(50, times(8e-3, ISOTROPIC)).row()
    return {"cycles": path}


def reversals_at_the_cutoff(setting):
    path = setting.start(LOOSE, 1.0).go(50, times(-3e-3, ISOTROPIC)).row()
    for i in range(200):
        path.go(1, times((-1) ** i * 1e-5, ACROSS))
    return {"held": path.row()}


def low_shear(setting):
    """Drained compression at p' 0.2 and 1 kPa."""
    return {f"{p}": rows_along(setting.start(MIDDLE, p).lead("esseee"), 500, (0.05, 0, 0, 0, 0, 0)) for p in (0.2, 1.0)}


def apex(setting):
    """Lateral stress taken away at constant vertical stress down to active failure, and on by strain."""
    path = setting.start(MIDDLE, 100.0).lead("seeeee")
    return {"active": rows_along(path, 400, (0, -0.02, -0.02, 0, 0, 0))}


def tension_with_suction(setting):
    path = setting.start(MIDDLE, 50.0, suction=100.0).go(100, times(-1.2e-2, ISOTROPIC)).row()
    return {"bonded": rows_along(path.go(40, (0,) * 6, -100.0).row(), 200, times(2e-2, ISOTROPIC))}


# ---- liquefaction

def static_liquefaction(setting):
    """Undrained compression and simple shear of very loose sand to 20 %."""
    return {f"{e} {name}": rows_along(setting.start(e, p), 800, times(0.2, direction))
            for e, p in ((0.93, 100.0), (0.97, 20.0)) for name, direction in (("compression", AXIAL), ("shear", ACROSS))}


def steady(setting):
    """Undrained compression of loose sand to 60 %: the critical state of its void ratio."""
    return {str(e): straight(setting.start(e, 500.0), 0.6, step=1e-3).row() for e in (0.80, 0.85)}


def off_steady(runs):
    return max(100 * abs(last(rows).p / steady_pressure(float(e)) - 1) for e, rows in runs.items())


def mobility(setting):
    """Constant volume, gamma +-1 %, 40 cycles: through p' near nothing twice a cycle."""
    path = straight(setting.start(MIDDLE), 0.01, ACROSS, 1e-4)
    for _ in range(40):
        straight(straight(path, -0.02, ACROSS, 1e-4).row(), 0.02, ACROSS, 1e-4).row()
    return {"mobility": path}


def large_shear(setting):
    return {str(e): rows_along(setting.start(e), 2000, times(0.5, ACROSS)) for e in (DENSE, LOOSE)}


# ---- suction

def wetting(setting):
    """Loose sand at constant net stress, wetted from 500 kPa through the air-entry value to -10 kPa."""
    return {str(e): rows_along(setting.start(e, 100.0, suction=500.0).lead("ssseee"), 100, (0,) * 6, suction=-510.0)
            for e in (MIDDLE, LOOSE)}


def drying(setting):
    path = setting.start(MIDDLE, 100.0).lead("ssseee")
    at = 0.0
    for to in (1.0, 4.0, 6.0, 20.0, 100.0, 1e3, 1e4, 1e5):
        path.go(20, (0,) * 6, to - at).row()
        at = to
    return {"drying": path}


def off_retention(runs):
    """Isotropic drying at constant effective stress changes the bonding only: the void ratio must stay [%]."""
    return max(100 * abs(row["e"] / MIDDLE - 1) for rows in runs.values() for row in rows)


def wet_dry_cycles(setting):
    path = setting.start(0.85, stress=(200.0, 100.0, 100.0, 0, 0, 0), suction=500.0, P_a=0.5, n_x=8.0, m_x=2.5).lead("ssseee")
    for _ in range(5):
        path.go(40, (0,) * 6, -510.0).row().go(40, (0,) * 6, 510.0).row()
    return {"cycles": path}


def sharp_retention(setting):
    """An air-entry value of 0.5 kPa with n_x 8 crossed 100 times by +-0.4 kPa while sheared."""
    path = setting.start(MIDDLE, suction=0.5, P_a=0.5, n_x=8.0, m_x=2.5)
    for i in range(200):
        path.go(2, times(1e-4, AXIAL), (-1) ** i * 0.4)
    return {"crossed": path.row()}


def wetting_at_rest(setting):
    """Wetting at zero strain, at a high stress ratio."""
    path = setting.start(LOOSE, 100.0, suction=200.0).lead("esseee").go(300, (0.03, 0, 0, 0, 0, 0)).row().lead("eeeeee")
    return {"rest": rows_along(path, 100, (0,) * 6, suction=-200.0)}


def unmoved(runs):
    """Change of the stress from the first state beyond the bounding surface to the end of the wetting [%]."""
    held = [row["stress"] for row in runs["rest"] if beyond(row) > 0]
    return max(100 * abs(a - b) / max(map(abs, held[0])) for a, b in zip(held[0], held[-1])) if len(held) > 3 else float("inf")


def suction_pulses(setting):
    path = setting.start(MIDDLE, suction=100.0)
    for i in range(100):
        straight(path, 1e-4)
        path.go(2, (0,) * 6, (-1) ** i * 60.0)
    return {"pulses": path.row()}


# ---- the compression line

def on_the_line(setting):
    return {str(e): rows_along(setting.start(e, 0.999 * line_pressure(e)).lead("ssseee"), 200, times(3 * line_pressure(e), (1, 1, 1, 0, 0, 0)))
            for e in (0.7, 0.9)}


def off_the_line(runs):
    """p' above that of the compression line at the present void ratio [%]."""
    return max(100 * (row.p / line_pressure(row["e"]) - 1) for rows in runs.values() for row in rows)


def beyond_the_line(setting):
    """K0 compression, which runs beyond the line, and unloading."""
    path = rows_along(setting.start(0.9, 1000.0), 500, (0.15, 0, 0, 0, 0, 0))
    return {"k0": path.go(200, (-0.01, 0, 0, 0, 0, 0)).row().go(200, (0.02, 0, 0, 0, 0, 0)).row()}


def high_pressure(setting):
    return {str(e): rows_along(setting.start(e, 1e5), 500, times(0.1, AXIAL)) for e in (0.3, 0.45)}


# ---- large increments, bounds, other sands

def one_increment(setting):
    """10 % of strain in one increment: undrained compression, shear, oedometer."""
    ways = {"undrained": AXIAL, "shear": ACROSS, "oedometer": (1.0, 0, 0, 0, 0, 0)}
    return {f"{name} {e}": setting.start(e).go(1, times(0.1, way)).row() for name, way in ways.items() for e in (DENSE, LOOSE)}


def off_many(setting):
    return {f"{name}, {n}": setting.start(MIDDLE).go(n, times(0.1, way)).row()
            for name, way in (("undrained", AXIAL), ("oedometer", (1.0, 0, 0, 0, 0, 0))) for n in (1, 1000)}


def one_or_many(runs):
    """Stress after one increment of 10 % against 1000 [%]."""
    return max(100 * max(abs(a - b) for a, b in zip(last(runs[f"{name}, 1"])["stress"], last(runs[f"{name}, 1000"])["stress"]))
               / last(runs[f"{name}, 1000"]).p for name in ("undrained", "oedometer"))


def void_ratio_bounds(setting):
    return {str(e): rows_along(setting.start(e, 100.0), 100, times(0.01, AXIAL)) for e in (0.02, 0.05, 2.0, 4.5)}


def parameters_at_bounds(setting):
    ends = ({"n_b": 20.0}, {"n_d": 20.0}, {"A_0": 20.0}, {"h_0": 0.001}, {"h_0": 1e4}, {"c_h": 5.0}, {"c_z": 1e5}, {"z_max": 1e3},
            {"theta": 0.01}, {"theta": 5.0}, {"c": 0.611}, {"c": 1.0}, {"M_c": 2.5}, {"M_c": 0.1}, {"rho_e": 0.01}, {"x_0": 0.0}, {"b_1": 10.0},
            {"b_2": 5.0})
    found = {}
    for end in ends:
        path = setting.start(MIDDLE, suction=20.0, **end)
        straight(straight(straight(path, 0.01, step=1e-4), -0.005, step=1e-4), 0.01, step=1e-4)
        found[" ".join(f"{k}={v:g}" for k, v in end.items())] = path.row()
    return found


def other_sands(setting):
    """40 sands with ordinary parameters, sheared there and back at constant volume."""
    found, dice = {}, random.Random(7)
    for i in range(40):
        sand = {"K_0": dice.uniform(60, 250), "G_0": dice.uniform(60, 250), "M_c": dice.uniform(1.1, 1.5), "n_b": dice.uniform(0.8, 3),
                "n_d": dice.uniform(1, 4), "A_0": dice.uniform(0.2, 1), "h_0": dice.uniform(4, 20), "c_z": dice.uniform(100, 1000),
                "c": dice.uniform(0.68, 0.8)}
        path = setting.start(dice.uniform(0.6, 0.95), 10 ** dice.uniform(0.5, 3), suction=dice.choice((0.0, 30.0)), **sand)
        straight(straight(path, 0.02, step=2e-4), -0.04, step=2e-4)
        found[str(i)] = straight(path, 0.04, step=2e-4).row()
    return found


def ripple_in_a_loop(setting):
    """A point inside a hysteresis loop, with a thousand ripples of suction and without, then sheared. Without the isotropic mechanism,
    which every ripple would load again: what is left of them is what retention remembers."""
    found, still = {}, times(0.0, AXIAL)
    for name, n in (("clean", 0), ("rippled", 1000)):
        path = setting.start(MIDDLE, suction=8.0, hysteresis=1, isotropic=0).go(1, still, 4.0).go(1, still, -3.0)
        for _ in range(n):
            path.go(1, still, 0.1).go(1, still, -0.1)
        found[name] = straight(path, 0.02, step=2e-4).row()
    return found


CASES = (
    Case("tension and back", "little stress", "p' would become negative; the material is held at p_min and released", BOUND, TRAIL, tension, bounded),
    Case("30 cycles through the cut-off", "little stress", "reaching and leaving p_min are events inside increments", BOUND, TRAIL, tension_cycles, bounded),
    Case("reversals at the cut-off", "little stress", "the tangent of a point held at p_min", BOUND, TRAIL, reversals_at_the_cutoff, bounded),
    Case("shear at p' 0.2 kPa", "little stress", "stiffness changes with every substep; stress control", BOUND, TRAIL, low_shear, bounded),
    Case("active failure", "little stress", "lateral stress falls to a few kPa at constant vertical stress", BOUND, TRAIL, apex, bounded),
    Case("tension under suction", "little stress", "bonding at p_min, then wetting there", BOUND, TRAIL, tension_with_suction, bounded),
    Case("static liquefaction", "liquefaction", "p' falls to less than a hundredth without a reversal", BOUND, TRAIL, static_liquefaction, bounded),
    Case("the steady state", "liquefaction", "60 % of shear at constant volume", "p' that of the closed form [%]", 2.0, steady, off_steady),
    Case("cyclic mobility", "liquefaction", "p' nearly vanishes twice a cycle, stiffness over three decades", BOUND, TRAIL, mobility, bounded),
    Case("50 % of shear", "liquefaction", "far beyond every peak", BOUND, TRAIL, large_shear, bounded),
    Case("wetting to saturation", "suction", "stiffness of bonding is lost, S_w reaches 1 at a kink", BOUND, TRAIL, wetting, bounded),
    Case("drying to 1e5 kPa", "suction", "five decades of suction through the air-entry value", "void ratio constant at constant effective stress [%]", 1e-6,
         drying, off_retention),
    Case("five wettings and dryings", "suction", "a steep retention curve crossed in one step of 13 kPa; reversals inside suction steps", ANY, 0.0, wet_dry_cycles,
         nothing),
    Case("the air-entry value 200 times", "suction", "a kink of S_w crossed in every increment", ANY, 0.0, sharp_retention, nothing),
    Case("wetting at rest", "suction", "no strain, all of the change comes from the bonding, at a high stress ratio", BOUND, TRAIL, wetting_at_rest, bounded,
         limit="at zero strain only the isotropic mechanism responds to suction, and its weight w is zero from the bounding surface on "
               "(docs/theory/material.md 4.4 to 4.7): B = 0, so t = 0, so L = 0, and the stress stays while the surface goes on shrinking",
         proof=("change of the stress while the surface shrinks below it [%]", unmoved, 1e-12)),
    Case("pulses of suction", "suction", "suction changes without strain between increments of strain", BOUND, TRAIL, suction_pulses, bounded),
    Case("1000 ripples of suction with hysteresis", "suction", "every ripple turns twice: memory of a branch that does not close pumps water",
         "stress against the path without them [%]", 1e-6, ripple_in_a_loop, off_the_clean),
    Case("along the compression line", "compression line", "the isotropic mechanism becomes singular stiff or soft there", "p' above the line [%]", 0.5,
         on_the_line, off_the_line),
    Case("beyond the compression line", "compression line", "K0 compression runs beyond the line, where the closed form has none", BOUND, TRAIL, beyond_the_line, bounded),
    Case("p' 100 MPa", "compression line", "the critical state line bends; no room above it", BOUND, TRAIL, high_pressure, bounded),
    Case("10 % in one increment", "increments", "peak, dilation and critical state inside one update", BOUND, TRAIL, one_increment, bounded),
    Case("one increment or a thousand", "increments", "the substeps have to find what the host did not resolve", "stress of 10 % in one increment against 1000 [%]",
         0.5, off_many, one_or_many),
    Case("void ratio 0.02 to 4.5", "bounds", "far outside the range of any sand", BOUND, TRAIL, void_ratio_bounds, bounded),
    Case("parameters at their bounds", "bounds", "18 parameters, one at a time, at an end of the range that is accepted", ANY, 0.0, parameters_at_bounds, nothing),
    Case("40 other sands", "bounds", "parameters of no particular sand", ANY, 0.0, other_sands, nothing),
)
