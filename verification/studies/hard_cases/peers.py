# SPDX-License-Identifier: MIT
"""A few hard paths of the catalogue in OpenSees: ManzariDafalias (after Dafalias & Manzari 2004) with three of its integration schemes.

Usage: peers.py; needs openseespy of PyPI (measured with 3.7.1.2), which no check run does. Writes peers.csv.
One SSPbrick, all of its displacements prescribed, so that the material alone answers: nothing is sought but its stress. Parameters are those of Toyoura sand in its
authors' paper; isotropic start at p' 100 kPa, e 0.735. The paths and what is asked of them are those of the point: a reversal may not
change what comes later, the answer may not hang on the size of the increments, tension ends in a state that can be loaded again.
"""
import math
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "material"), str(HERE.parents[1])]
from tools import results, tables  # noqa: E402

SAND = (125.0, 0.05, 0.735, 1.25, 0.712, 0.019, 0.934, 0.7, 101.3, 0.01, 7.05, 0.968, 1.1, 0.704, 3.5, 4.0, 600.0, 1.6)
# Integration scheme, tangent, Jacobian, tolerances; none: what the program takes by itself.
SCHEMES = {"as it comes": (), "modified Euler, 1e-7": (1, 1, 1, 1e-7, 1e-7), "Runge-Kutta, 1e-7": (3, 1, 1, 1e-7, 1e-7)}
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
SECONDS = 600


def shear(n, total):
    """n increments of gamma_xy at constant volume."""
    return [(0.0, total / n)] * n


def reversals(amplitude):
    """To 0.4 % of shear in steps of 1e-5; from 0.2 % on ten loops of that size, one every 2e-5."""
    path = shear(200, 2e-3)
    for _ in range(10):
        path += [(0.0, -amplitude), (0.0, amplitude), *shear(2, 2e-5)]
    return path + shear(180, 1.8e-3)


# Name: the increments (volume, shear), the same without the event or with many increments, what is asked.
CASES = {
    "pauses (reversals of 0)": (reversals(0.0), shear(400, 4e-3)),
    "reversals of 1e-9": (reversals(1e-9), shear(400, 4e-3)),
    "reversals of 1e-6": (reversals(1e-6), shear(400, 4e-3)),
    "reversals of 1e-4": (reversals(1e-4), shear(400, 4e-3)),
    "10 % in one increment": (shear(1, 0.1), shear(10000, 0.1)),
    "10 % in ten increments": (shear(10, 0.1), shear(10000, 0.1)),
    "tension and back": ([(1e-4, 0.0)] * 50 + [(-1e-4, 0.0)] * 100, [(-1e-4, 0.0)] * 50),
}


def drive(scheme, path):
    """Last stress (six components, tension positive) after the path; None if the program gives up."""
    import openseespy.opensees as ops
    down = compression(ops, scheme)
    values = [down * i / 20 for i in range(21)], [0.0] * 21
    volume, gamma = down * 3, 0.0
    for more, turn in path:
        volume, gamma = volume + more, gamma + turn
        values[0].append(volume / 3)
        values[1].append(gamma)
    begin(ops, scheme, values)
    if ops.analyze(20):
        return None
    ops.updateMaterialStage("-material", 1, "-stage", 1)
    if ops.analyze(len(path)):
        return None
    return [float(x) for x in ops.eleResponse(1, "stress")[:6]]


def begin(ops, scheme, values):
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 3)
    for tag, corner in enumerate(CORNERS, 1):
        ops.node(tag, *map(float, corner))
    ops.nDMaterial("ManzariDafalias", 1, *SAND, *scheme)
    ops.element("SSPbrick", 1, *range(1, 9), 1)
    ops.updateMaterialStage("-material", 1, "-stage", 0)
    for pattern, series in enumerate(values, 1):
        ops.timeSeries("Path", pattern, "-dt", 1.0, "-values", *series, "-useLast")
        ops.pattern("Plain", pattern, pattern)
        for tag, (x, y, z) in enumerate(CORNERS, 1):
            if pattern == 1:
                for dof, place in ((1, x), (2, y), (3, z)):
                    ops.sp(tag, dof, float(place))
            else:
                ops.sp(tag, 1, float(y))
    ops.constraints("Penalty", 1e14, 1e14)
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", 1e-9, 20)
    ops.algorithm("Newton")
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")


def compression(ops, scheme):
    """Linear strain at which the elastic stage has p' 100 kPa."""
    steps = 400
    begin(ops, scheme, ([-1e-5 * i for i in range(steps + 1)], [0.0] * (steps + 1)))
    before = 0.0
    for i in range(1, steps + 1):
        if ops.analyze(1):
            raise RuntimeError("the elastic stage fails")
        p = -sum(ops.eleResponse(1, "stress")[:3]) / 3
        if p >= 100:
            return -1e-5 * (i - (p - 100) / (p - before))
        before = p
    raise RuntimeError(f"p' is {p} kPa only")


def one(name, scheme):
    """A process of its own, because a material may end it: JSON of both answers on the last line."""
    import json
    path, reference = CASES[name]
    print("\n" + json.dumps([drive(SCHEMES[scheme], path), drive(SCHEMES[scheme], reference)]), flush=True)


def own(name):
    """The same by MUD with its defaults, other parameters: Toyoura sand as its authors' model has it; tension positive as above."""
    from catalogue import SETTINGS
    from point_walk import ROOT, Walker
    walker, answers = Walker(os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release"), []
    for path in CASES[name]:
        way = SETTINGS[0].start(0.735, 100.0)
        for volume, gamma in path:
            way.go(1, (-volume / 3, -volume / 3, -volume / 3, gamma, 0.0, 0.0))
        row = walker.run(way.row())[-1]
        answers.append(None if row["failed"] else [-x for x in row["stress"]])
    return verdict(name, *answers)


def judged(name, scheme):
    import json
    try:
        done = subprocess.run([sys.executable, __file__, name, scheme], capture_output=True, text=True, timeout=SECONDS, env=os.environ)
    except subprocess.TimeoutExpired:
        return f"does not end in {SECONDS} s", math.nan
    lines = [line for line in done.stdout.splitlines() if line.startswith("[")]
    if done.returncode or not lines:
        return f"ends with code {done.returncode}", math.nan
    return verdict(name, *json.loads(lines[-1]))


def verdict(name, here, there):
    if here is None or not all(map(math.isfinite, here)):
        return "gives up" if here is None else "no number", math.nan
    if there is None or not all(map(math.isfinite, there)):
        return "gives up on the reference", math.nan
    if name == "tension and back":
        return "p' at the end [kPa]", -sum(here[:3]) / 3
    size = math.sqrt(sum(x * x for x in there))
    return "distance from the reference [%]", 100 * math.sqrt(sum((x - y) ** 2 for x, y in zip(here, there))) / size


def main():
    rows = []
    for name in CASES:
        for scheme in SCHEMES:
            told, value = judged(name, scheme)
            rows.append((name, scheme, told, f"{value:.3g}"))
            print(*rows[-1], flush=True)
        told, value = own(name)
        rows.append((name, "MUD, defaults", told, f"{value:.3g}"))
        print(*rows[-1], flush=True)
    tables.write(results.folder(__file__) / "peers.csv", ("case", "scheme", "told", "value"), rows, ("made by peers.py with OpenSees 3.7.1 (openseespy 3.7.1.2)",))


if __name__ == "__main__":
    main() if len(sys.argv) < 3 else one(*sys.argv[1:])
