# SPDX-License-Identifier: MIT
"""Every block of the derivatives of a point (13 by 13) against central differences: blocks.py FOLDER --result RESULT

MUD and an elastic skeleton with a retention curve, at 30 and 3 kPa of suction and under 20 kPa of water, in steps with
inertia and without. The error of a block is counted from its largest entry.
"""
import json
import pathlib
import sys

import numpy as np
from mpi4py import MPI

from mud3d import balances, engine
from mud3d.scene import Scene
from mud3d.space import NUMBERS, PRESSURE, STRAIN

SCENE = """
&scene geometry = 'plane_strain' fields = 'u-p_w-p_c' pressures = 'linear' gravity = 9.81 quadrature = 3 /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&mud name = 'sand' tolerance = 1e-9 /
&elastic name = 'rock' young = 1e4 poisson = 0.3 /
&retention name = 'curve' law = 'van_genuchten' alpha = 0.1 n = 2 /
&permeability name = 'k' intrinsic = 1e-10 law = 'mualem' m = 0.5 /
&region material = '@' retention = '@' permeability = 'k' void_ratio = 0.8 damping = 2 stiffness_damping = 1e-3 /
&initial p_w = @ p_c = @ stress = 'uniform' sigma = -60, -90, -60 /
&stage name = 's' analysis = 'dynamic' duration = 1 dt = 0.01 /
&fix group = 'all' field = 'p_a' /
"""
ROWS = {"stress": STRAIN, "momentum": slice(6, 9), "water": slice(9, 10), "flow": slice(10, 13)}
STEP = np.array([1e-8]*6 + [1e-7]*3 + [1e-4]*4)


def worst(folder, words, kind):
    path, text = folder/"blocks.nml", SCENE
    for word in words:
        text = text.replace("@", word, 1)
    path.write_text(text)
    run = engine.Run(MPI.COMM_WORLD, Scene(path), engine.Options(thickness=1.0, cells="tetrahedra"))
    scheme, points = balances.Scheme(kind, 0.5, 0.01), run.points
    n, random = points.n, np.random.default_rng(1)
    begin = run.space.numbers(run.x)[0].reshape(n, NUMBERS)
    sizes = np.array([2e-4]*6 + [1e-4]*3 + [0.5] + [1.0]*3)
    end = begin + random.normal(size=(n, NUMBERS))*sizes
    v0, a0 = 1e-3*random.normal(size=(n, NUMBERS)), random.normal(size=(n, NUMBERS))

    def evaluate(end, slopes=False):
        v1, a1 = scheme.first_order(begin, v0, end), np.zeros_like(end)
        if kind == balances.DYNAMIC:
            b, dt = scheme.beta, scheme.dt
            a1 = (end - begin)/(b*dt**2) - v0/(b*dt) - (0.5/b - 1.0)*a0
            v1[:, :9] = (v0 + dt*((1.0 - scheme.gamma)*a0 + scheme.gamma*a1))[:, :9]
        level = np.full(NUMBERS, scheme.l_p)
        level[:9] = scheme.l_v
        velocity = v0 + level*(v1 - v0)
        points.update(end[:, STRAIN] - begin[:, STRAIN], run.ground.suction(end[:, PRESSURE])[0])
        return balances.evaluate(points, run.ground, scheme, begin, end, velocity, balances.between(a0, a1, scheme.l_a),
                                 velocity, run.weight, slopes)

    J = evaluate(end, True)[1]
    difference = np.empty_like(J)
    for j in range(NUMBERS):
        move = np.where(np.arange(NUMBERS) == j, STEP, 0.0)
        difference[:, :, j] = (evaluate(end + move)[0] - evaluate(end - move)[0])/(2.0*STEP[j])
    found = {}
    for row, i in ROWS.items():
        for column, j in ROWS.items():
            size = np.abs(J[:, i, j]).max()
            found[f"{row}/{column}"] = float(np.abs(difference[:, i, j] - J[:, i, j]).max()/max(size, 1e-9))
    return found


folder, _, result = sys.argv[1:4]
told = {}
for material, curve in (("sand", ""), ("rock", "curve")):
    for p in (-30.0, -3.0, 20.0):
        for kind in (balances.DYNAMIC, balances.QUASI_STATIC):
            told[f"{material}, {p}, {kind}"] = worst(pathlib.Path(folder), (material, curve, repr(p), repr(-p)), kind)
with open(result, "w") as file:
    json.dump(told, file, indent=1)
