# SPDX-License-Identifier: MIT
"""Rows in six components: loops and cycles that are not straight."""
import math
import random

from point_steps import (ACROSS, AXIAL, DENSE, LOOSE, MIDDLE, clean_path, closed, deviation, distance, increments, last, plus,
                   straight, times)
from point_walk import Path

SIDE = times(math.sqrt(3), ACROSS)           # engineering shear 12 of the same tensor length as AXIAL
OTHER = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0)       # engineering shear 13


def loop_rows(walker, soil, shapes, place=0.01, then=0.005, suction=0.0, around=None):
    """Deviation of q [%] `then` after a closed loop at `place`, for every shape and both densities."""
    clean = {e: walker.start(straight(Path(soil, e, suction=suction), place + then).row()) for e in (DENSE, LOOSE)}
    runs = {}
    for name, points in shapes.items():
        for e in (DENSE, LOOSE):
            path = straight(Path(soil, e, suction=suction), place)
            (around or closed)(path, points)
            runs[f"{name} e {e}"] = (e, walker.start(straight(path, then).row()))
    return {name: deviation(run.result(), clean[e].result()) for name, (e, run) in runs.items()}


def turned(walker, soil):
    """deviation of q 0.5 % after a straight loop of 1.5e-4 that leaves turned by 20, 40, 60 degrees [%]"""
    return loop_rows(walker, soil, {f"{angle} deg": [(-1.5e-4 * math.cos(math.radians(angle)),
                                                      1.5e-4 * math.sin(math.radians(angle)))]
                                    for angle in (20, 40, 60)}, around=along_side)


def along_side(path, points):
    return closed(path, points, AXIAL, SIDE)


def ellipse(size, aspect, n=60):
    """A loop that leaves along the path and comes back beside it."""
    return [(-0.5 * size * (1 - math.cos(2 * math.pi * i / n)), 0.5 * aspect * size * math.sin(2 * math.pi * i / n))
            for i in range(1, n)]


def elliptic(walker, soil):
    """deviation of q 0.5 % after an elliptic loop of 1.5e-4 and 5e-4, aspect 0.1 and 0.3 [%]"""
    return loop_rows(walker, soil, {f"{size:.1e} aspect {aspect}": ellipse(size, aspect)
                                    for size in (1.5e-4, 5e-4) for aspect in (0.1, 0.3)}, around=along_side)


def lateral(walker, soil):
    """deviation of q 0.5 % after back by 1.5e-4, sideways by a, forward, sideways back; a 5e-5, 1.5e-4 [%]"""
    return loop_rows(walker, soil, {f"{side:.1e}": [(-1.5e-4, 0), (-1.5e-4, side), (0, side)] for side in (5e-5, 1.5e-4)},
                     around=along_side)


def squares(walker, soil, size=3e-5, loops=200, to=0.05):
    """deviation of q at 5 % after 200 loops of 3e-5 along and across the path: squares by their first legs, a line [%]"""
    shapes = {"back, side": [(-size, 0), (-size, size), (0, size)], "side, back": [(0, size), (-size, size), (-size, 0)],
              "forward, side": [(size, 0), (size, size), (0, size)], "side, forward": [(0, size), (size, size), (size, 0)],
              "line across": [(0, size)]}
    clean = {e: clean_path(walker, soil, e, to) for e in (DENSE, LOOSE)}
    runs = {}
    for name, corners in shapes.items():
        for e in (DENSE, LOOSE):
            path = Path(soil, e)
            for _ in range(loops):
                along_side(straight(path, to / loops), corners)
            runs[f"{name} e {e}"] = (e, walker.start(path.row()))
    return {key: deviation(run.result(), clean[e].result()) for key, (e, run) in runs.items()}


def nested(walker, soil):
    """deviation of q 0.5 % after nine nested excursions, the first 1e-3, each 3/4 of the one before [%]"""
    at, points = 0.0, []
    for i in range(9):
        at += (-1) ** (i + 1) * 1e-3 * 0.75 ** i
        points.append((at, 0.0))
    return loop_rows(walker, soil, {"nine": points})


def suction_pulse(walker, soil):
    """deviation of q 0.5 % after a loop of 4.2e-5, a suction pulse of 100 -> 50 -> 100 kPa, and both together [%]"""
    def pulse(path, points):
        for a, pulsed in points:
            straight(path, -a)
            if pulsed:
                path.go(20, (0.0,) * 6, -50.0).go(20, (0.0,) * 6, 50.0)
            straight(path, a)
    return loop_rows(walker, soil, {"loop": [(4.2e-5, False)], "pulse": [(0.0, True)], "both": [(4.2e-5, True)]},
                     suction=100.0, around=pulse)


def small_in_large(walker, soil, cycles=10):
    """stress at the end of 10 cycles of +-1e-3 with a loop of 1e-4 inside every leg, against those without [%]"""
    def large(drained, small):
        path = Path(soil, MIDDLE).lead("ssseee" if drained else "eeeeee")
        straight(path, 1e-3, ACROSS)
        for sign in (-1, 1) * cycles:
            for leg in (1.2e-3, 0.8e-3):
                straight(path, sign * leg, ACROSS)
                if small and leg == 1.2e-3:
                    straight(straight(path, -sign * small, ACROSS), sign * small, ACROSS)
        return path.row()
    paths = {(name, small): large(name == "drained", small) for name in ("drained", "undrained") for small in (0.0, 1e-4)}
    runs = walker.run_all(paths)
    return {name: distance(runs[name, 1e-4], runs[name, 0.0]) for name in ("drained", "undrained")}


def circle_path(soil, radius, aspect, cycles=20, bias=0.0, n=80):
    """Undrained ellipses of gamma_12, gamma_13 about the origin, after a drained bias of tau_12."""
    path = Path(soil, MIDDLE)
    if bias:
        path.lead("sssses").go(40, times(bias, ACROSS)).lead("eeeeee")
    path.go(increments(radius), times(radius, ACROSS))
    corner = [(radius * math.cos(2 * math.pi * i / n), aspect * radius * math.sin(2 * math.pi * i / n))
              for i in range(n + 1)]
    sides = [plus(times(b[0] - a[0], ACROSS), times(b[1] - a[1], OTHER)) for a, b in zip(corner, corner[1:])]
    for _ in range(cycles):
        for side in sides:
            path.go(increments(max(map(abs, side))), side)
    return path.row()


def circles(walker, soil):
    """p' [kPa] after 20 undrained cycles of radius 5e-4, aspect 0 (straight), 0.5, 1 (circle); with a bias tau 20 kPa"""
    runs = walker.run_all({f"aspect {aspect}{' biased' if bias else ''}": circle_path(soil, 5e-4, aspect, bias=bias)
                           for bias in (0.0, 20.0) for aspect in (0.0, 0.5, 1.0)})
    return {name: last(rows).p if last(rows) else math.nan for name, rows in runs.items()}


def sideways(walker, soil):
    """tau_13 [kPa], which the path does not favour, after 20 undrained circles of 1e-4 about a bias tau_12 = 20 kPa"""
    rows = walker.run(circle_path(soil, 1e-4, 1.0, bias=20.0))
    return {"tau_13": last(rows)["stress"][4] if last(rows) else math.nan}


def figure_eight_path(soil, size, n, cycles=20):
    corner = [(size * math.sin(2 * math.pi * i / n), 0.5 * size * math.sin(4 * math.pi * i / n)) for i in range(n + 1)]
    path = Path(soil, MIDDLE)
    for _ in range(cycles):
        for a, b in zip(corner, corner[1:]):
            path.go(increments(2 * size / n), plus(times(b[0] - a[0], ACROSS), times(b[1] - a[1], OTHER)))
    return path.row()


def closed_loops(soil, corners, loops=100):
    """Loops of gamma_12, gamma_13 through corners, one increment a side, a row after each."""
    path = Path(soil, MIDDLE)
    for i in range(1, loops + 1):
        for a, b in zip(corners, corners[1:]):
            path.go(1, plus(times(b[0] - a[0], ACROSS), times(b[1] - a[1], OTHER)))
        path.row(str(i))
    return path


def on_ellipse(radius, n, aspect=1.0):
    """Corners of a polygon that begins and ends at the origin; tensor shear."""
    return [(2 * radius * (1 - math.cos(2 * math.pi * i / n)), 2 * radius * aspect * math.sin(2 * math.pi * i / n)) for i in range(n + 1)]


def on_eight(size, n):
    return [(2 * size * math.sin(2 * math.pi * i / n), size * math.sin(4 * math.pi * i / n)) for i in range(n + 1)]


TURNS = {"circle 5e-5, 80 sides": on_ellipse(5e-5, 80), "circle 1e-4, 80 sides": on_ellipse(1e-4, 80), "circle 2e-4, 80 sides": on_ellipse(2e-4, 80),
         "circle 2e-4, 332 sides": on_ellipse(2e-4, 332), "circle 5e-4, 80 sides": on_ellipse(5e-4, 80),
         "ellipse 2e-4, aspect 0.5": on_ellipse(2e-4, 80, 0.5), "ellipse 2e-4, aspect 0.2": on_ellipse(2e-4, 80, 0.2),
         "square 2e-4": [(4e-4 * x, 4e-4 * y) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1), (0, 0))],
         "eight 1e-4, 80 sides": on_eight(1e-4, 80), "eight 2e-4, 80 sides": on_eight(2e-4, 80)}


#: Relative changes of size with which a loop that grazes a reversal or a return is on its other side.
SHIFTS = (-1e-3, -3e-4, -1e-4, 1e-4, 3e-4, 1e-3)


def tolerance_on_turns(walker, soil, turns=tuple(TURNS)):
    """largest difference of stress after any of 100 undrained loops in two tensor shears between the tolerances 1e-5 and 1e-8 [%]"""
    fine = soil.having(tolerance=1e-8, scheme=3)
    runs = walker.run_all({(name, s): closed_loops(s, TURNS[name]) for name in turns for s in (soil, fine)})
    return {name: max(distance([a], [b]) for a, b in zip(runs[name, soil], runs[name, fine])) for name in turns}


def tolerance_on_random_turns(walker, soil, loops=100):
    """that difference for 100 random loops (ellipses, squares, eights of 3e-5 to 6e-4) of 40 rounds: quantiles [%]; how many above 0.1 %; the largest if those
    are compared with the nearest of the fine answers for sizes 0.01 to 0.1 % larger or smaller"""
    dice = random.Random(11)
    fine = soil.having(tolerance=1e-8, scheme=3)
    corners = []
    for _ in range(loops):
        size, n, aspect = 10 ** dice.uniform(-4.5, -3.2), dice.choice((40, 80, 120, 200, 332)), dice.uniform(0.1, 1.0)
        corners.append(dice.choice((on_ellipse(size, n, aspect), on_ellipse(size, n), [(x, aspect * y) for x, y in on_eight(size, n)],
                                    [(2 * size * x, 2 * size * aspect * y) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1), (0, 0))])))
    runs = walker.run_all({(i, s): closed_loops(s, corners[i], 40) for i in range(loops) for s in (soil, fine)})

    def largest(one, other):
        return max(distance([a], [b]) for a, b in zip(one, other))
    off = [largest(runs[i, soil], runs[i, fine]) for i in range(loops)]
    grazing = [i for i in range(loops) if off[i] > 0.1]
    shifted = walker.run_all({(i, shift): closed_loops(fine, [((1 + shift) * x, (1 + shift) * y) for x, y in corners[i]], 40)
                              for i in grazing for shift in SHIFTS})
    near = [min(largest(runs[i, soil], shifted[i, shift]) for shift in SHIFTS) if i in grazing else off[i] for i in range(loops)]
    off.sort()
    return {"median": off[loops // 2], "90 % quantile": off[round(0.9 * loops) - 1], "largest": off[-1], "above 0.1 %": len(grazing),
            "largest, shifted": max(near)}


def turning(walker, soil):
    """dependence of the end of 20 circles (2e-4, 5e-4) and eights (2e-4) on the tolerance (1e-5, 1e-8) and the polygon [%]"""
    fine = soil.having(tolerance=1e-8)
    found = {}
    for name, make in (("circle 2e-4", lambda s, n: circle_path(s, 2e-4, 1.0, n=n)),
                       ("circle 5e-4", lambda s, n: circle_path(s, 5e-4, 1.0, n=n)),
                       ("eight 2e-4", lambda s, n: figure_eight_path(s, 2e-4, n))):
        runs = walker.run_all({"coarse": make(soil, 80), "fine": make(fine, 80), "sides": make(fine, 320)})
        found[f"{name}, tolerance"] = distance(runs["coarse"], runs["fine"])
        found[f"{name}, polygon"] = distance(runs["fine"], runs["sides"])
    return found


def rotating_axes(walker, soil, cycles=50):
    """drained, principal axes rotated by +-10 degrees at p' 100, q 50: cycles done, strains after them [%]"""
    def stress(angle):
        c, s = math.cos(math.radians(2 * angle)), math.sin(math.radians(2 * angle))
        return (25 * c, -25 * c, 0.0, 25 * s, 0.0, 0.0)
    path = Path(soil, MIDDLE).lead("ssssss")
    path.go(50, (100 / 3, -50 / 3, -50 / 3, 0, 0, 0)).row("0")
    angles = [10 * math.sin(2 * math.pi * i / 80) for i in range(81)]
    for i in range(1, cycles + 1):
        for a, b in zip(angles, angles[1:]):
            path.go(1, tuple(y - x for x, y in zip(stress(a), stress(b))))
        path.row(str(i))
    rows = walker.run(path)
    done = [row for row in rows if not row["failed"]]
    strain = [100 * (b - a) for a, b in zip(done[0]["strain"], done[-1]["strain"])]
    return {"cycles": int(done[-1]["label"]), "axial": strain[0], "volume": sum(strain[:3]), "cuts": rows[-1]["cuts"]}


def random_walk_path(soil, size, drift, seed, parts, legs=20):
    dice = random.Random(seed)
    path = Path(soil, MIDDLE)
    for _ in range(legs):
        d = [dice.gauss(0, 1) for _ in range(6)]
        mean = sum(d[:3]) / 3
        d = [x - mean for x in d[:3]] + d[3:]
        norm = math.sqrt(sum(x * x for x in d[:3]) + 2 * sum(x * x for x in d[3:]))
        step = [size * x / norm for x in d[:3]] + [2 * size * x / norm for x in d[3:]]
        path.go(parts, plus(step, times(drift * size, AXIAL)))
    return path.row()


def random_walks(walker, soil, walks=40):
    """90 % quantile over 40 random walks (20 legs at constant volume) of the distance of 20 from 200 increments a leg [%]"""
    found = {}
    for drift in (0.0, 2.0):
        for size in (2e-4, 1e-3):
            runs = walker.run_all({(seed, parts): random_walk_path(soil, size, drift, seed, parts)
                                   for seed in range(walks) for parts in (20, 200)})
            off = sorted(distance(runs[seed, 20], runs[seed, 200]) for seed in range(walks))
            found[f"{size:.0e}{' with drift' if drift else ''}"] = off[round(0.9 * walks) - 1]
    return found


ROWS = (turned, elliptic, lateral, squares, nested, suction_pulse, small_in_large, circles, sideways, tolerance_on_turns,
        tolerance_on_random_turns, turning, rotating_axes, random_walks)
