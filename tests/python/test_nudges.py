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
# Karlsruhe sand with cyclic preloading as first fitted, whose walks met what is looked for.
FIRST_FIT = {"K_0": 237.295, "G_0": 144.69, "N_c": 2.21305, "lambda": 0.106198, "alpha_csl": 1546.74, "N_l": 1.93088,
             "theta": 4.27609, "n_b": 1.07055, "n_d": 1.47694, "A_0": 0.762078, "h_0": 3.11469, "c_h": 0.92251,
             "c_chi": 0.0915755, "s_chi": 0.000549607}


def test_rounding_of_a_strain_decides_nothing_at_an_event():
    # Where the event that ended a substep is met again by rounding, the sizes of the substeps after it stay: otherwise
    # 18 increments of the first walks jump, at most by 8e-4 of the stress. Whether shear turns only because the
    # isotropic mechanism rests is not asked where a reversal was located: otherwise two of the second and five of the
    # third jump, at most by 2e-3.
    jumps = []
    for name, changes, seed in (("toyoura", {}, 7), ("toyoura", {}, 69), ("karlsruhe_cyclic", FIRST_FIT, 47)):
        jumps += [(name, *found) for found in jumps_of_walks(mud.Material(name, **changes), seed)]
    check("of 10,800 increments none jumps", not jumps, jumps)


def test_a_drift_without_length_divides_nothing():
    # Compressed and taken back, sand meets a reversal in the fourth increment back, and rounding decides whether the
    # new process first drifts by a millionth of a substep: if all substeps behind it divided the rest, the stress would
    # jump by 2.4e-6 of its size.
    sand = mud.Material(K_0=95.1, M_c=1.19, h_0=7.47, scheme=2.0)
    there = np.array([1.22, 1.43, 0.977, 0.814, 0.289, 0.316])
    in_parts = [there*np.array(parts) for parts in (
        [0, 0, 0, 1, 0, 0], [1, 1, 1, 0, 0, 0], [0, 1, 1, 0, 0, 0], [1, 1, 1, 0, 0, 0], [1, 1, 0, 0, 0, 0],
        [1, 1, 1, 0, 0, 0])]
    stress, statev = sand.initial_state([-62.6, -43.8, -43.8, 0, 0, 0], 0.0, 0.566)
    for strain in [*in_parts, there, there, -there, -there, -there]:
        answer = sand.update(stress, statev, 1e-3*strain)
        stress, statev = answer.stress, answer.statev
    ends = np.array([sand.update(stress, statev, -1e-3*there*(1 + k*1e-14)).stress for k in range(-12, 13)])
    moved = np.abs(ends - ends[12]).max()/np.linalg.norm(ends[12])
    check("the last digits of a strain move the last digits of the stress", moved < 1e-9, moved)


def jumps_of_walks(sand, seed):
    """(walk, step, largest change of the stress) of increments whose answer does not follow their strain."""
    random = np.random.default_rng(seed)
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
                yield path, step, moved
            stress, statev = answer.stress, answer.statev
