# SPDX-License-Identifier: MIT
"""Hard cases: turns of the path, from rounding to large cycles."""
import math
import random

from bounds import BOUND, TRAIL, bounded
from catalogue import Case, last, off_the_clean, overshoot
from point_steps import ACROSS, AXIAL, DENSE, LOOSE, MIDDLE, increments, plus, straight, times
from tools.bench import parameters

SIDE = times(math.sqrt(3), ACROSS)
OTHER = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
NOISE = 0.3     # % of q: what the default rule was accepted with (docs/theory/memory-rules.md)


def with_reversals(size, events=100, to=0.01, levels=((0.8, 1.0), (0.8, 100.0), (0.735, 5000.0)), step=1e-4):
    """Undrained compression at three stress levels, straight and with reversals; every level has its own clean path."""
    def paths(setting):
        found = {}
        for e, p in levels:
            found[f"clean {p:g}"] = straight(setting.start(e, p), to, step=step).row()
            path = setting.start(e, p)
            for _ in range(events):
                straight(path, to / events, step=step)
                straight(straight(path, -size, step=max(size / 4, 1e-5)), size, step=max(size / 4, 1e-5))
            found[f"turned {p:g}"] = path.row()
        return found
    return paths


def level_overshoot(runs):
    """The largest overshoot over the stress levels or densities [%]."""
    levels = [label[6:] for label in runs if label.startswith("clean ")]
    return max(overshoot({"clean": runs[f"clean {p}"], "turned": runs[f"turned {p}"]}) for p in levels)


def level_distance(runs):
    levels = [label[6:] for label in runs if label.startswith("clean ")]
    return max(off_the_clean({"clean": runs[f"clean {p}"], "turned": runs[f"turned {p}"]}) for p in levels)


def reversal_case(size, judge, criterion, allowed):
    return Case(f"reversals of {size:.0e}", "turns", "a reversal may reset the memory; at this size the answer depends on "
                + ("rounding" if size < 1e-8 else "the tolerance" if size < 1e-6 else "the rule"), criterion, allowed,
                with_reversals(size), judge)


def wide_reversals(setting):
    """Constant volume, +-1 % in increments of 1e-3, at three stress levels."""
    found = {}
    for e, p in ((0.8, 1.0), (0.8, 100.0), (0.735, 5000.0)):
        path = setting.start(e, p)
        for i in range(20):
            path.go(10, times((-1) ** i * 1e-2, AXIAL)).row()
        found[f"{p:g}"] = path
    return found


def noise_paths(size, across=False):
    """Undrained compression to 5 % with 300 random reversals along, or shear of alternating sign across."""
    def paths(setting):
        found = {}
        for e in (DENSE, LOOSE):
            found[f"clean {e}"] = straight(setting.start(e), 0.05, step=1e-4).row()
            path, dice, at = setting.start(e), random.Random(1), 0.0
            if across:
                for i in range(600):
                    path.go(10, plus(times(0.05 / 600, AXIAL), times((-1) ** i * 2 * size, ACROSS)))
            else:
                for place in sorted(dice.uniform(0.002, 0.05) for _ in range(300)):
                    straight(path, place - at, step=1e-4)
                    at = place
                    back = abs(dice.gauss(0, 1)) * size
                    straight(straight(path, -back), back)
                straight(path, 0.05 - at, step=1e-4)
            found[f"turned {e}"] = path.row()
        return found
    return paths


def softening_paths(size):
    """Drained compression of dense sand beyond its peak, 100 loops outside the present bounding surface."""
    def paths(setting):
        found = {}
        for label, loop in (("clean", 0.0), ("turned", size)):
            path = setting.start(DENSE).lead("esseee").go(500, (0.10, 0, 0, 0, 0, 0))
            for _ in range(100):
                path.go(5, (5e-4, 0, 0, 0, 0, 0))
                if loop:
                    path.go(10, (-loop, 0, 0, 0, 0, 0)).go(10, (loop, 0, 0, 0, 0, 0))
            found[label] = path.go(100, (0.005, 0, 0, 0, 0, 0)).row()
        return found
    return paths


def nested_paths(setting):
    found = {}
    for e in (DENSE, LOOSE):
        found[f"clean {e}"] = straight(setting.start(e), 0.015, step=1e-4).row()
        path, at = straight(setting.start(e), 0.01, step=1e-4), 0.0
        for i in range(9):
            to = at + (-1) ** (i + 1) * 1e-3 * 0.75 ** i
            straight(path, to - at)
            at = to
        straight(path, -at)
        found[f"turned {e}"] = straight(path, 0.005, step=1e-4).row()
    return found


def symmetric_paths(sizes, cycles):
    def paths(setting):
        found = {}
        for size in sizes:
            path = setting.start(MIDDLE).lead("ssseee").go(10, times(size, ACROSS)).row("first_up").go(20, times(-2 * size, ACROSS))
            path.row("first_down")
            for _ in range(cycles - 1):
                path.go(20, times(2 * size, ACROSS)).go(20, times(-2 * size, ACROSS))
            found[f"{size:g}"] = path.go(20, times(2 * size, ACROSS)).row("up").go(20, times(-2 * size, ACROSS)).row("down")
        return found
    return paths


def asymmetry(runs):
    """Largest (high + low) of tau in the last cycle over the range of the first [%]."""
    def of(rows):
        tau = {row["label"]: row["stress"][3] for row in rows}
        return 100 * abs(tau["up"] + tau["down"]) / (tau["first_up"] - tau["first_down"])
    return max(map(of, runs.values()))


def many_cycles(setting):
    """10,000 drained cycles of two shear components at once, in increments of half the amplitude; all three would have a Lode angle, which
    tells one side from the other."""
    both = (0.0, 0.0, 0.0, 1e-4, 0.7e-4, 0.0)
    path = setting.start(MIDDLE).lead("ssseee").go(2, both).row("first_up").go(4, times(-2, both)).row("first_down")
    for _ in range(9999):
        path.go(4, times(2, both)).go(4, times(-2, both))
    return {"cycles": path.go(4, times(2, both)).row("up").go(4, times(-2, both)).row("down")}


def asymmetry_of_all(runs):
    """The same of both shear components, the larger [%]."""
    at = {row["label"]: row["stress"][3:5] for row in runs["cycles"]}
    return max(100 * abs(up + down) / abs(first_up - first_down)
               for up, down, first_up, first_down in zip(at["up"], at["down"], at["first_up"], at["first_down"]))


def in_two_units(setting):
    """Loops and suction in kPa and in MPa: all parameters that have a unit are converted."""
    values = parameters()
    converted = {name: 1e-3 * values[name] for name in ("alpha_csl", "P_a", "p_atm")}
    converted |= {name: 1e-3 ** values["lambda"] * values[name] for name in ("N_c", "N_l")}
    found = {}
    for label, unit, more in (("kPa", 1.0, {}), ("MPa", 1e-3, converted)):
        path = setting.start(MIDDLE, p=100 * unit, suction=20 * unit, **more)
        for i in range(40):
            straight(path, (-1) ** i * (1e-3 + 2e-5 * i), plus(AXIAL, times(0.3, OTHER)), step=1e-4)
            path.go(2, (0.0,) * 6, suction=(-1) ** (i // 2) * 3 * unit)
        found[label] = path.row()
    return found


def off_between_units(runs):
    a, b = (last(runs[label])["stress"] for label in ("kPa", "MPa"))
    return 100 * math.dist(a, times(1e3, b)) / math.hypot(*a)


def biased_paths(setting):
    path = setting.start(MIDDLE).lead("ssseee").go(50, (50, 0, 0, 0, 0, 0)).row("0").go(4, (2, 0, 0, 0, 0, 0))
    for _ in range(1000):
        path.go(8, (-4, 0, 0, 0, 0, 0)).go(8, (4, 0, 0, 0, 0, 0))
    return {"biased": path.row()}


def gain(label):
    """Axial strain since the first row [%]."""
    def judge(runs):
        rows = runs[label]
        return 100 * abs(rows[-1]["strain"][0] - rows[0]["strain"][0])
    return judge


def polygon(path, radius, cycles, n=80, first=ACROSS, second=OTHER):
    corner = [(radius * math.cos(2 * math.pi * i / n), radius * math.sin(2 * math.pi * i / n)) for i in range(n + 1)]
    sides = [plus(times(b[0] - a[0], first), times(b[1] - a[1], second)) for a, b in zip(corner, corner[1:])]
    path.go(increments(radius), times(radius, first))
    for _ in range(cycles):
        for side in sides:
            path.go(increments(max(map(abs, side))), side)
    return path


def circles(setting):
    """Constant volume, shear 12 and 13 on a circle, at two sizes; the small one is half elastic."""
    return {f"{radius:g}": polygon(setting.start(MIDDLE), radius, cycles).row() for radius, cycles in ((5e-5, 40), (5e-4, 20))}


def rotating_paths(setting):
    """Drained, q constant, principal axes turned by +-10 degrees, 100 cycles."""
    def stress(angle):
        c, s = math.cos(math.radians(2 * angle)), math.sin(math.radians(2 * angle))
        return (25 * c, -25 * c, 0.0, 25 * s, 0.0, 0.0)
    path = setting.start(MIDDLE).lead("ssssss").go(50, (100 / 3, -50 / 3, -50 / 3, 0, 0, 0)).row("0")
    angles = [10 * math.sin(2 * math.pi * i / 80) for i in range(81)]
    for _ in range(100):
        for a, b in zip(angles, angles[1:]):
            path.go(1, tuple(y - x for x, y in zip(stress(a), stress(b))))
    return {"axes": path.row()}


def turning_frame(setting):
    """The same undrained path in a frame at rest and in one that turns by 3.6 degrees a step, ten times round."""
    c, s = math.cos(math.radians(3.6)), math.sin(math.radians(3.6))
    turn = ((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))
    still, turned = setting.start(MIDDLE), setting.start(MIDDLE)
    for i in range(1000):
        sign = 1 if i % 50 < 30 else -1
        still.go(1, (0, 0, 0, 0, 0, 0)).go(1, times(sign * 2e-5, (-0.5, -0.5, 1.0, 0, 0, 0)))
        turned.turn(turn).go(1, times(sign * 2e-5, (-0.5, -0.5, 1.0, 0, 0, 0)))
    return {"clean": still.row(), "turned": turned.row()}


def walks(setting):
    """Six-component random walks of 5e-4 a leg, ten of them."""
    found = {}
    for seed in range(10):
        dice, path = random.Random(seed), setting.start(MIDDLE)
        for _ in range(20):
            d = [dice.gauss(0, 1) for _ in range(6)]
            mean = sum(d[:3]) / 3
            path.go(20, times(2e-4, [x - mean for x in d[:3]] + [2 * x for x in d[3:]]))
        found[str(seed)] = path.row()
    return found


def eights(setting):
    n, size, path = 80, 2e-4, setting.start(MIDDLE)
    corner = [(size * math.sin(2 * math.pi * i / n), 0.5 * size * math.sin(4 * math.pi * i / n)) for i in range(n + 1)]
    for _ in range(20):
        for a, b in zip(corner, corner[1:]):
            path.go(2, plus(times(b[0] - a[0], ACROSS), times(b[1] - a[1], OTHER)))
    return {"eights": path.row()}


def trembling(setting):
    """10,000 increments of +-1e-12 at a stress ratio, then on; against the path without."""
    found = {}
    for label, n in (("clean", 0), ("turned", 5000)):
        path = straight(setting.start(MIDDLE), 0.005, step=1e-4)
        for _ in range(n):
            path.go(1, times(1e-12, AXIAL)).go(1, times(-1e-12, AXIAL))
        found[label] = straight(path, 0.005, step=1e-4).row()
    return found


def pressure(runs):
    """How far the largest p' exceeds the initial one of 100 kPa [%]: contraction at constant volume can only lower it."""
    return max(100 * (last(rows).p / 100 - 1) for rows in runs.values())


LOSES = "q later does not exceed that of the uninterrupted path [%]"

CASES = (
    reversal_case(1e-9, level_distance, "stress at the end that of the uninterrupted path [%]", 0.1),
    reversal_case(1e-7, level_distance, "stress at the end that of the uninterrupted path [%]", 0.1),
    reversal_case(2e-5, level_overshoot, LOSES, NOISE),
    reversal_case(1e-4, level_overshoot, LOSES, NOISE),
    Case("reversals of 1e-2", "turns", "every leg passes the elastic domain, contraction and dilation in a few increments", BOUND, TRAIL,
         wide_reversals, bounded),
    Case("noise of 1e-6 along", "turns", "reversals far below the strain to which sand responds", LOSES, NOISE, noise_paths(1e-6), level_overshoot),
    Case("noise of 5e-5 along", "turns", "reversals of the size of the elastic domain", LOSES, NOISE, noise_paths(5e-5), level_overshoot),
    Case("noise of 1e-5 across", "turns", "the direction of loading turns in every increment and never reverses", LOSES, NOISE,
         noise_paths(1e-5, across=True), level_overshoot),
    Case("loops in softening", "turns", "the state lies outside the bounding surface, which shrinks: a reversal there has no image stress",
         LOSES, NOISE, softening_paths(1e-4), overshoot),
    Case("tiny loops in softening", "turns", "as before, loops inside the elastic domain", "stress that of the uninterrupted path [%]", 1.0,
         softening_paths(1e-5), off_the_clean),
    Case("nine nested loops", "turns", "the memory holds four", LOSES, NOISE, nested_paths, level_overshoot),
    Case("1000 symmetric cycles", "cycles", "any bias of the rule adds up", "asymmetry of tau over its range [%]", 0.3,
         symmetric_paths((1e-6, 1e-5, 1e-4, 3e-4), 1000), asymmetry),
    Case("10,000 cycles of two shears", "cycles", "any bias of the rule adds up, and components may differ", "asymmetry of each shear stress over its range [%]", 0.3,
         many_cycles, asymmetry_of_all),
    Case("1000 biased cycles", "cycles", "every cycle leaves a little strain, a rule that overshoots leaves none or too much",
         "axial strain, q 50 +- 2 kPa [%]", 0.1, biased_paths, gain("biased")),
    Case("circles", "cycles", "the direction turns all the time; the elastic domain is left and entered in one increment",
         "p' not above its first value [%]", 0.1, circles, pressure),
    Case("figure eights", "cycles", "two lobes, turned opposite ways: no rule converges on them with the increments",
         "p' not above its first value [%]", 0.1, eights, pressure),
    Case("100 rotations of the principal axes", "cycles", "stress control while the stress turns at constant ratio: Newton meets resets of the memory",
         BOUND, TRAIL, rotating_paths, bounded),
    Case("a frame that turns ten times", "cycles", "stress, image points and memory must turn with it", "stress about the axis as in the frame at rest [%]",
         0.1, turning_frame, lambda runs: 100 * max(abs(a / b - 1) for a, b in ((last(runs["turned"]).p, last(runs["clean"]).p),
                                                   (last(runs["turned"])["stress"][2], last(runs["clean"])["stress"][2])))),
    Case("kPa or MPa", "cycles", "a number inside that has a unit", "stress after 40 loops with suction in kPa against MPa [%]", 0.1, in_two_units, off_between_units),
    Case("random walks", "cycles", "six components, every leg in another direction", BOUND, TRAIL, walks, bounded),
    Case("10,000 increments of 1e-12", "turns", "increments of the size of rounding in strain", "stress that of the path without [%]", 0.1,
         trembling, off_the_clean),
)
