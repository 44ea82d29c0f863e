# SPDX-License-Identifier: MIT
"""Rows of stress paths, long histories and numerical robustness."""
import math
import random

from memory_published import biased_path, noise_path, strains_after, symmetric_path, turns
from point_steps import (ACROSS, AXIAL, DENSE, LOOSE, MIDDLE, clean_path, closed, deviation, distance, last, per_cent, plus, straight, times)
from point_walk import Path

AMPLITUDES = (1e-6, 1e-5, 3e-5, 1e-4, 3e-4)


def long_symmetric(walker, soil, cycles=1000):
    """asymmetry abs(high + low) of tau in cycle 1000 over the range of cycle 1, gamma 1e-6 to 3e-4; cuts of increments [%]"""
    runs = walker.run_all({size: symmetric_path(soil, size, cycles, (1, cycles)).row() for size in AMPLITUDES})
    found = {}
    for size, rows in runs.items():
        tau = turns(rows)
        found[f"{size:.0e}"] = 100 * abs(sum(tau[cycles])) / (tau[1][1] - tau[1][0]) if cycles in tau else math.nan
    found["cuts"] = max(rows[-1]["cuts"] for rows in runs.values())
    return found


def seeds(walker, soil, n=8):
    """smallest and largest deviation of q over eight seeds of the noise of 5e-5, dense and loose [%]"""
    clean = {e: clean_path(walker, soil, e, 0.05) for e in (DENSE, LOOSE)}
    found = {}
    for e in (DENSE, LOOSE):
        off = [deviation(rows, clean[e].result()) for rows in walker.run_all([noise_path(soil, e, 5e-5, seed) for seed in range(1, n + 1)])]
        found[f"e {e}, smallest"], found[f"e {e}, largest"] = min(off), max(off)
    return found


def reversed_bias(walker, soil):
    """axial strain after 100 and 1000 drained triaxial cycles of q = -30 +- 10 kPa [%]"""
    return strains_after(walker.run(biased_path(soil, -30, 10, 1000, (100, 1000), steps=10)), (100, 1000))


def k0_path(soil, loops, depth, top=200.0, then=220.0):
    """One-dimensional compression from 20 kPa; at `top` loops of unloading to depth*top."""
    path = Path(soil, MIDDLE, p=20.0).lead("seeeee").go(180, times(top - 20, (1, 0, 0, 0, 0, 0)))
    for _ in range(loops):
        size = top * (1 - depth)
        path.go(max(10, round(size)), times(-size, (1, 0, 0, 0, 0, 0)))
        path.go(max(10, round(size)), times(size, (1, 0, 0, 0, 0, 0)))
    return path.row("back").go(40, times(then - top, (1, 0, 0, 0, 0, 0))).row()


def k0_loops(walker, soil):
    """K0: lateral stress at 220 kPa and void ratio after five loops from 200 to 190, 100, 25 kPa, against none [%]"""
    runs = walker.run_all({depth: k0_path(soil, 5 if depth < 1 else 0, depth) for depth in (1.0, 0.95, 0.5, 0.125)})
    found = {}
    for depth in (0.95, 0.5, 0.125):
        a, b = last(runs[depth]), last(runs[1.0])
        found[f"to {200 * depth:g} sigma_r"] = per_cent(a["stress"][1], b["stress"][1]) if a else math.nan
        found[f"to {200 * depth:g} e"] = per_cent(a["e"], b["e"]) if a else math.nan
    return found


def softening(walker, soil, loops=200):
    """drained compression beyond the peak (dense, 10 to 15 %) with 200 loops of 1e-4: q 0.5 % later and volume against none [%]; cuts"""
    def path(size):
        made = Path(soil, DENSE).lead("esseee").go(1000, times(0.10, (1, 0, 0, 0, 0, 0)))
        for _ in range(loops):
            made.go(5, (0.05 / loops, 0, 0, 0, 0, 0))
            if size:
                made.go(10, (-size, 0, 0, 0, 0, 0)).go(10, (size, 0, 0, 0, 0, 0))
        return made.go(100, (0.005, 0, 0, 0, 0, 0)).row()
    with_loops, clean = walker.run_all([path(1e-4), path(0.0)])
    a, b = last(with_loops), last(clean)
    return {"q": per_cent(a.q, b.q) if a else math.nan,
            "volume": 100 * (sum(a["strain"][:3]) - sum(b["strain"][:3])) if a else math.nan, "cuts": with_loops[-1]["cuts"]}


def cutoff(walker, soil, cycles=30):
    """30 undrained cycles of gamma +-1 % from p' 20, loose, and on to 5 %: smallest p' at a turn, p' at the end, cuts"""
    path = straight(Path(soil, LOOSE, p=20.0), 0.01, ACROSS, 1e-4)
    for _ in range(cycles):
        straight(path, -0.02, ACROSS, 1e-4).row()
        straight(path, 0.02, ACROSS, 1e-4).row()
    rows = walker.run(straight(path, 0.04, ACROSS, 1e-4).row())
    return {"smallest p'": min(row.p for row in rows), "p' at the end": last(rows).p if last(rows) else math.nan,
            "cuts": rows[-1]["cuts"], "rates an increment": rows[-1]["rates"] / (100 + cycles * 400 + 400)}


def random_increments(walker, soil, paths=50, n=2000):
    """1e5 random six-component increments (50 starts, sizes 1e-6 to 2e-4): increments done, cuts, rates an increment"""
    made = []
    for seed in range(paths):
        dice = random.Random(seed)
        size = math.exp(dice.uniform(math.log(1e-6), math.log(2e-4)))
        path, volume = Path(soil, dice.uniform(0.6, 0.9), p=math.exp(dice.uniform(math.log(50), math.log(1000)))), 0.0
        for _ in range(n):
            d = [dice.gauss(0, size) for _ in range(6)]
            mean = sum(d[:3]) / 3
            change = 0.1 * dice.gauss(0, size) - 0.01 * volume   # the volume stays near its start
            volume += 3 * change
            path.go(1, [x - mean + change for x in d[:3]] + d[3:])
        made.append(path.row())
    ends = [rows[-1] for rows in walker.run_all(made)]
    return {"done": sum(n for end in ends if not end["failed"]), "cuts": sum(end["cuts"] for end in ends),
            "rates": sum(end["rates"] for end in ends) / (n * paths)}


def excursions(soil, factor=lambda: 1.0, turned=None):
    """A path with loops of several sizes and shapes; `turned` rotates the point before every step."""
    path, frame = Path(soil, DENSE), None
    steps = []
    for size in (5e-5, 1.5e-4, 5e-4):
        steps += [times(0.005, AXIAL), times(-size, AXIAL), times(0.5 * size, AXIAL), times(-0.3 * size, AXIAL),
                  times(0.8 * size, AXIAL), times(2 * size, ACROSS), times(-2 * size, ACROSS)]
    for step in [*steps, times(0.005, AXIAL)]:
        if turned:
            rotation = turned()
            path.turn(rotation)
            frame = rotation if frame is None else product(rotation, frame)
            step = rotated_strain(step, frame)
        scale = factor()
        path.go(max(1, math.ceil(max(map(abs, step)) / 1e-5)), times(scale, step))
    return path.row(), frame


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def rotated_stress(s, r):
    full = [[s[0], s[3], s[4]], [s[3], s[1], s[5]], [s[4], s[5], s[2]]]
    full = product(product(r, full), [list(column) for column in zip(*r)])
    return (full[0][0], full[1][1], full[2][2], full[0][1], full[0][2], full[1][2])


def rotated_strain(e, r):
    turned = rotated_stress((*e[:3], *(0.5 * x for x in e[3:])), r)
    return (*turned[:3], *(2 * x for x in turned[3:]))


def drot(walker, soil):
    """a path with loops whose point is turned by umat_ (DROT) before every step, against the unturned one [%]"""
    dice = random.Random(5)

    def rotation():
        axis = [dice.gauss(0, 1) for _ in range(3)]
        length, angle = math.sqrt(sum(x * x for x in axis)), dice.uniform(-0.5, 0.5)
        x, y, z = (component / length for component in axis)
        c, s = math.cos(angle), math.sin(angle)
        return [[c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s],
                [y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s],
                [z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)]]
    fine = soil.having(tolerance=1e-8)   # increments differ with the frame: at 1e-5 the integration would be seen
    path, frame = excursions(fine, turned=rotation)
    plain = walker.run(excursions(fine)[0])
    rows = walker.run(path)
    if last(rows):
        rows[-1]["stress"] = list(rotated_stress(rows[-1]["stress"], [list(column) for column in zip(*frame)]))
    return {"distance": distance(rows, plain)}


def schemes(walker, soil):
    """largest distance between the three schemes at tolerance 1e-7: a path with loops, noise of 5e-5, 20 cycles [%]"""
    found = {}
    for name, make in (("loops", lambda s: excursions(s)[0]), ("noise", lambda s: noise_path(s, DENSE, 5e-5, 1)),
                       ("cycles", lambda s: symmetric_path(s, 3e-4, 20, ()).row())):
        runs = walker.run_all([make(soil.having(scheme=scheme, tolerance=1e-7)) for scheme in (1, 2, 3)])
        found[name] = max(distance(run, runs[0]) for run in runs[1:])
    return found


def perturbation(walker, soil):
    """a path with loops, noise of 5e-5 and square loops, every step changed by 1e-9 of itself: distance at the end [%]"""
    def noisy(e, factor):
        dice, path = random.Random(9), Path(soil, e)
        for _ in range(300):
            straight(path, 0.05 / 300 * factor())
            back = abs(dice.gauss(0, 1)) * 5e-5
            straight(straight(path, -back * factor()), back * factor())
        return path.row()

    def square(e, factor):
        path = Path(soil, e)
        for _ in range(200):
            straight(path, 2.5e-4)
            size = 3e-5 * factor()
            closed(path, [(-size, 0), (-size, size), (0, size)])
        return path.row()
    found = {}
    for name, make in (("loops", lambda f: excursions(soil, f)[0]), ("noise dense", lambda f: noisy(DENSE, f)),
                       ("noise loose", lambda f: noisy(LOOSE, f)), ("squares", lambda f: square(DENSE, f))):
        dice = random.Random(11)
        runs = walker.run_all([make(lambda: 1.0), make(lambda: 1 + 1e-9 * dice.gauss(0, 1))])
        found[name] = distance(runs[1], runs[0])
    return found


def energy_path(soil, size, loops=100, steps=10):
    """Square loops of volume and shear from K0 = 0.5, a row at every increment."""
    volume = (size / 3, size / 3, size / 3, 0, 0, 0)
    path = Path(soil, MIDDLE, stress=(150.0, 75.0, 75.0, 0, 0, 0)).row("start")
    for _ in range(loops):
        for side in (volume, times(size, ACROSS), times(-1, volume), times(-size, ACROSS)):
            for _ in range(steps):
                path.go(1, times(1 / steps, side)).row()
    return path


def energy(walker, soil):
    """100 square loops of volume and shear about K0 = 0.5, sides 1e-5, 2e-5, 1e-4: work of all [J/m3], drift of stress [kPa]"""
    found = {}
    for size in (1e-5, 2e-5, 1e-4):
        rows = walker.run(energy_path(soil, size))
        work = 0.0
        for a, b in zip(rows, rows[1:]):
            work += sum(0.5 * (x + y) * (v - u) for x, y, u, v in zip(a["stress"], b["stress"], a["strain"], b["strain"]))
        drift = max(abs(y - x) for x, y in zip(rows[0]["stress"], rows[-1]["stress"]))
        found[f"{size:.0e} work"] = 1000 * work
        found[f"{size:.0e} drift"] = drift
    return found


ROWS = (long_symmetric, seeds, reversed_bias, k0_loops, softening, cutoff, random_increments, drot, schemes, perturbation, energy)
