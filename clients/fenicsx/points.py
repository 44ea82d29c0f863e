# SPDX-License-Identifier: MIT
"""Points of the batch call alone. A JSON file with strains, suction, void_ratio, stress: four equal points follow it.
An .npz that footing.py --record wrote: the last increment of every point again, compared bit by bit.
"""
import json
import sys

import numpy as np

import mud_points


def follow(given):
    strains, suction = np.array(given["strains"]), np.array(given["suction"])
    sand, n = mud_points.Material(), 4
    stress, state = sand.points(n, [given["stress"]]*3 + [0.0]*3, given["void_ratio"], suction[0])
    new_stress, new_state, tangent, rows = stress.copy(), state.copy(), np.zeros((n, 36)), []
    for i in range(1, len(strains)):
        sand.update(stress, state, np.tile(strains[i] - strains[i - 1], (n, 1)), new_stress, new_state, tangent,
                    np.full(n, suction[i - 1]), np.full(n, suction[i] - suction[i - 1]))
        stress, new_stress, state, new_state = new_stress, stress, new_state, state
        if np.ptp(stress, axis=0).any():
            sys.exit("equal points have different answers")
        rows.append(stress[0].tolist())
    return {"stress": rows}


def again(file):
    sand = mud_points.Material()
    sand.set_props(file["props"])
    stress, strain = (file[name].reshape(-1, 6) for name in ("stress", "strain"))
    state = file["state"].reshape(len(stress), -1)
    new_stress, new_state, tangent = np.zeros_like(stress), np.zeros_like(state), np.zeros((len(stress), 36))
    sand.update(stress, state, strain, new_stress, new_state, tangent)
    same = new_stress.tobytes() == file["new_stress"].tobytes() and new_state.tobytes() == file["new_state"].tobytes()
    return {"same": same, "points": len(stress)}


path, _, result = sys.argv[1:4]  # FILE --result RESULT
if path.endswith(".npz"):
    answer = again(np.load(path))
else:
    with open(path) as source:
        answer = follow(json.load(source))
with open(result, "w") as target:
    json.dump(answer, target)
