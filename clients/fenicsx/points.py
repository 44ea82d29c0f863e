# SPDX-License-Identifier: MIT
"""Points of the batch call alone: four equal points follow a JSON file with strains, suction, void_ratio, stress,
parameters. points.py GIVEN.json --result RESULT.json
"""
import json
import sys

import numpy as np

import mud


def follow(given):
    strains, suction = np.array(given["strains"]), np.array(given["suction"])
    sand, n, rows, water = mud.Material(**given.get("parameters", {})), 4, [], []
    place = list(mud.states).index("saturation")
    points = sand.init_batch(np.tile([given["stress"]]*3 + [0.0]*3, (n, 1)), np.full(n, suction[0]),
                             np.full(n, given["void_ratio"]))
    for i in range(1, len(strains)):
        step = np.tile(strains[i] - strains[i - 1], (n, 1))
        sand.update_batch(points.stress, points.statev, step, np.full(n, suction[i]), "consistent", out=points)
        if points.failed:
            sys.exit(str(points.fault()))
        if np.ptp(points.stress, axis=0).any():
            sys.exit("equal points have different answers")
        rows.append(points.stress[0].tolist())
        water.append(float(points.statev[0, place]))
    return {"stress": rows, "saturation": water, "state_variables": points.statev.shape[1]}


path, _, result = sys.argv[1:4]
with open(path) as source:
    answer = follow(json.load(source))
with open(result, "w") as target:
    json.dump(answer, target)
