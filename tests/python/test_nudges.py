# SPDX-License-Identifier: MIT
"""Answers follow what is asked: a strain that differs in its last digits gives the same stress, wherever an increment
meets a reversal or another event."""
import os
import sys

import numpy as np
from checking import build, check, needs_plain_library, root

needs_plain_library()
os.environ["MUD_LIBRARY_DIR"] = str(build)
sys.path.insert(0, str(root / "python"))
import mud  # noqa: E402

NUDGES = (1e-13, -1e-13, 1e-12, -1e-12)


def test_rounding_of_a_strain_decides_nothing_at_an_event():
    # Where the event that ended a substep is met again by rounding, the sizes of the substeps after it stay. Otherwise
    # 18 of these increments jump, at most by 8e-4 of the stress. Of 28,800 like them 2 jump, and 101 otherwise.
    random = np.random.default_rng(7)
    sand = mud.Material("toyoura")
    jumps = []
    for path in range(60):
        pressure = 10.0**random.uniform(1.0, 2.5)
        start = -pressure*np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
        stress, statev = sand.initial_state(start, 0.0, random.uniform(0.7, 0.9))
        shear = random.normal(size=6)
        shear[:3] -= 0.7*shear[:3].mean()
        shear /= np.linalg.norm(shear)
        for step in range(60):
            strain = (-1)**step*10.0**random.uniform(-4.5, -3.5)*shear + 3e-5*random.normal(size=6)
            answer = sand.update(stress, statev, strain)
            others = [sand.update(stress, statev, (1.0 + nudge)*strain).stress for nudge in NUDGES]
            moved = max(np.abs(other - answer.stress).max() for other in others)
            if moved > 1e-9*np.abs(answer.stress).max():
                jumps.append((path, step, moved))
            stress, statev = answer.stress, answer.statev
    check("of 3600 increments at most one jumps", len(jumps) <= 1, jumps)
