# SPDX-License-Identifier: MIT
"""Rows of the published table: cycles and noise along and across a path."""
import math
import random

from point_steps import ACROSS, AXIAL, DENSE, LOOSE, MIDDLE, clean_path, deviation, increments, plus, straight, times
from point_walk import Path


def symmetric_path(soil, amplitude, cycles, write):
    """Drained simple shear: gamma_12 = +-amplitude, normal stresses held."""
    path = Path(soil, MIDDLE).lead("ssseee").go(10, times(amplitude, ACROSS))
    for i in range(1, cycles + 1):
        if i in write:
            path.row(f"up_{i}")
        path.go(20, times(-2 * amplitude, ACROSS))
        if i in write:
            path.row(f"down_{i}")
        path.go(20, times(2 * amplitude, ACROSS))
    return path


def turns(rows):
    """cycle -> (smallest, largest tau) of a symmetric path."""
    taus = {row["label"]: row["stress"][3] for row in rows}
    return {int(k[3:]): (taus[f"down_{k[3:]}"], tau) for k, tau in taus.items()
            if k.startswith("up_") and f"down_{k[3:]}" in taus}


def symmetric(walker, soil):
    """tau at the turns of cycles 1, 100, 300 of gamma +-1e-4, drained simple shear [kPa]"""
    found = turns(walker.run(symmetric_path(soil, 1e-4, 300, (1, 100, 300))))
    return {f"{i} {end}": found.get(i, (math.nan,) * 2)[k] for i in (1, 100, 300) for k, end in enumerate(("low", "high"))}


def biased_path(soil, q0, amplitude, cycles, write, steps=4):
    """Drained triaxial cycles of q0 +- amplitude [kPa] under stress control."""
    sign = math.copysign(1, q0)
    path = Path(soil, MIDDLE).lead("ssseee").go(50, times(q0, (1, 0, 0, 0, 0, 0))).row("0")
    path.go(steps, times(sign * amplitude, (1, 0, 0, 0, 0, 0)))
    for i in range(1, cycles + 1):
        path.go(2 * steps, times(-2 * sign * amplitude, (1, 0, 0, 0, 0, 0)))
        last_one = i in write
        path.go(steps if last_one else 2 * steps, times(sign * amplitude * (1 if last_one else 2), (1, 0, 0, 0, 0, 0)))
        if last_one:
            path.row(str(i)).go(steps, times(sign * amplitude, (1, 0, 0, 0, 0, 0)))
    return path


def strains_after(rows, write):
    """Axial strain since the first row [%]."""
    axial = {row["label"]: row["strain"][0] for row in rows if not row["failed"]}
    return {str(i): 100 * (axial[str(i)] - axial["0"]) if str(i) in axial else math.nan for i in write}


def biased(walker, soil):
    """axial strain after 100 and 1000 drained triaxial cycles of q = 50 +- 2 kPa [%]"""
    return strains_after(walker.run(biased_path(soil, 50, 2, 1000, (100, 1000))), (100, 1000))


def noise_path(soil, e, size, seed, events=300, first=0.002, to=0.05):
    """Undrained compression with reversals of |N(0, 1)| size at random places."""
    dice = random.Random(seed)
    places = sorted(dice.uniform(first, to) for _ in range(events))
    path, at = Path(soil, e), 0.0
    for place in places:
        straight(path, place - at)
        at = place
        back = abs(dice.gauss(0, 1)) * size
        straight(path, -back)
        straight(path, back)
    return straight(path, to - at).row()


def noise(walker, soil, sizes=(1e-6, 1e-5, 5e-5), seed=1):
    """deviation of q at 5 % after 300 random reversals of 1e-6, 1e-5, 5e-5, undrained, dense and loose [%]"""
    clean = {e: clean_path(walker, soil, e, 0.05) for e in (DENSE, LOOSE)}
    noisy = {(size, e): walker.start(noise_path(soil, e, size, seed)) for size in sizes for e in (DENSE, LOOSE)}
    return {f"{size:.0e} e {e}": deviation(run.result(), clean[e].result()) for (size, e), run in noisy.items()}


WALK_END = 0.055   # beyond the sum of 2000 steps at either size


def walk_path(soil, size, seed):
    dice = random.Random(seed)
    path, at = Path(soil, DENSE), 0.0
    for _ in range(2000):
        step = 2.5e-5 + size * dice.gauss(0, 1)
        straight(path, step)
        at += step
    return straight(path, WALK_END - at).row()


def walk(walker, soil, seed=1):
    """deviation of q at 5.5 % after 2000 increments of 2.5e-5 + a N(0, 1), a 1e-5 and 5e-5, dense [%]"""
    clean = clean_path(walker, soil, DENSE, WALK_END)
    runs = {size: walker.start(walk_path(soil, size, seed)) for size in (1e-5, 5e-5)}
    return {f"{size:.0e}": deviation(run.result(), clean.result()) for size, run in runs.items()}


def across_path(soil, e, size, events=600, to=0.05):
    path = Path(soil, e)
    for i in range(events):
        path.go(increments(to / events), plus(times(to / events, AXIAL), times((-1) ** i * 2 * size, ACROSS)))
    return path.row()


def across(walker, soil):
    """deviation of q after 600 increments with a tensor shear of +-1e-5 across the path, dense [%]"""
    clean = clean_path(walker, soil, DENSE, 0.05)
    return {"1e-05": deviation(walker.run(across_path(soil, DENSE, 1e-5)), clean.result())}


LOOP_SIZES = (2e-5, 5e-5, 1.5e-4, 5e-4)


def loop_path(soil, e, place, size, then=0.005):
    path = straight(Path(soil, e), place)
    straight(path, -size)
    straight(path, size)
    return straight(path, then).row()


def loops(walker, soil):
    """deviation of q 0.5 % after one loop of 2e-5, 5e-5, 1.5e-4, 5e-4 at 1 and 10 %, undrained, dense and loose [%]"""
    places = [(e, place) for e in (DENSE, LOOSE) for place in (0.01, 0.10)]
    clean = {key: clean_path(walker, soil, key[0], key[1] + 0.005) for key in places}
    runs = {(key, size): walker.start(loop_path(soil, *key, size)) for key in places for size in LOOP_SIZES}
    return {f"e {e} at {place:g}, {size:.1e}": deviation(run.result(), clean[e, place].result())
            for ((e, place), size), run in runs.items()}


def fig1(walker, soil):
    """Fig. 1: q at the turn, back at 0.10, at 0.105 and 0.12 (loop of 1.5e-4 at 10 %, dense) [kPa]"""
    path = straight(straight(Path(soil, DENSE), 0.10), -1.5e-4).row("turn")
    straight(straight(straight(path, 1.5e-4).row("back"), 0.005).row("0.105"), 0.015).row("0.12")
    return {row["label"]: row.q for row in walker.run(path)}


ROWS = (symmetric, biased, noise, walk, across, loops, fig1)
