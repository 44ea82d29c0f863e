# SPDX-License-Identifier: MIT
"""A few hard paths of the catalogue in OpenSees: ManzariDafalias (after Dafalias & Manzari 2004) with three of its integration schemes,
and PM4Sand (Boulanger & Ziotopoulou) as it comes.

Usage: peers.py; needs openseespy of PyPI (measured with 3.7.1.2), which no check run does. Writes peers.csv.
One SSPbrick, or one SSPquad in plane strain for PM4Sand, all of its displacements prescribed, so that the material alone answers: nothing is sought but its
stress. Parameters are those of Toyoura sand in the paper of Dafalias & Manzari, and a relative density of 0.55 with the ordinary G_o and h_po of that density for PM4Sand; start at
p' 100 kPa (e 0.735), isotropic in the directions that the model knows. A change of volume is shared by three directions, or by the two of the plane. The paths and what is asked of them are those of the point: a reversal may not
change what comes later, the answer may not depend on the size of the increments, tension ends in a state that can be loaded again.
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
PM4 = "PM4Sand, as it comes"
PM4_SAND = (0.55, 677.0, 0.5, 1.8)   # D_r, G_o, h_po, density
# Integration scheme, tangent, Jacobian, tolerances; none: what the program takes by itself.
SCHEMES = {"as it comes": (), "modified Euler, 1e-7": (1, 1, 1, 1e-7, 1e-7), "Runge-Kutta, 1e-7": (3, 1, 1, 1e-7, 1e-7),
           PM4: None}
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
    """Last stress (tension positive) after the path; None if the program gives up."""
    import openseespy.opensees as ops
    element = Square(ops) if scheme is None else Brick(ops, scheme)
    down, share = element.compression(), 1 / element.size
    values = [[part * i / 20 for i in range(21)] for part in down] + [[0.0] * 21]
    for more, turn in path:
        for series, change in zip(values, [more * share] * element.size + [turn]):
            series.append(series[-1] + change)
    element.begin(values)
    if ops.analyze(20):
        return None
    element.ready()
    if ops.analyze(len(path)):
        return None
    return element.stress()


class Element:
    """One element of unit edges, its displacements prescribed by a strain in each direction and the shear of the first two."""

    def __init__(self, ops):
        self.ops = ops

    def begin(self, values):
        ops = self.ops
        ops.wipe()
        ops.model("basic", "-ndm", self.size, "-ndf", self.size)
        for tag, corner in enumerate(self.corners, 1):
            ops.node(tag, *map(float, corner))
        self.place()
        ops.updateMaterialStage("-material", 1, "-stage", 0)
        # One prescribed value for every component of every node: two of them on one component would be shared by the penalty.
        *normal, shears = values
        for tag, corner in enumerate(self.corners, 1):
            for i, series in enumerate(normal):
                at = [corner[i] * x + (corner[1] * gamma if i == 0 else 0.0) for x, gamma in zip(series, shears)]
                pattern = self.size * (tag - 1) + i + 1
                ops.timeSeries("Path", pattern, "-dt", 1.0, "-values", *at, "-useLast")
                ops.pattern("Plain", pattern, pattern)
                ops.sp(tag, i + 1, 1.0)
        ops.constraints("Penalty", 1e14, 1e14)
        ops.numberer("Plain")
        ops.system("FullGeneral")
        ops.test("NormDispIncr", 1e-9, 20)
        ops.algorithm("Newton")
        ops.integrator("LoadControl", 1.0)
        ops.analysis("Static")

    def ready(self):
        self.ops.updateMaterialStage("-material", 1, "-stage", 1)


class Brick(Element):
    size = 3
    corners = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))

    def __init__(self, ops, scheme):
        super().__init__(ops)
        self.scheme = scheme

    def place(self):
        self.ops.nDMaterial("ManzariDafalias", 1, *SAND, *self.scheme)
        self.ops.element("SSPbrick", 1, *range(1, 9), 1)

    def stress(self):
        return [float(x) for x in self.ops.eleResponse(1, "stress")[:6]]

    def compression(self):
        """Linear strains at which the elastic stage has p' 100 kPa; its stiffness grows with p'."""
        steps = 400
        self.begin([[-1e-5 * i for i in range(steps + 1)]] * 3 + [[0.0] * (steps + 1)])
        before = 0.0
        for i in range(1, steps + 1):
            if self.ops.analyze(1):
                raise RuntimeError("the elastic stage fails")
            p = -sum(self.stress()[:3]) / 3
            if p >= 100:
                return [-1e-5 * (i - (p - 100) / (p - before))] * 3
            before = p
        raise RuntimeError(f"p' is {p} kPa only")


class Square(Element):
    size = 2
    corners = ((0, 0), (1, 0), (1, 1), (0, 1))

    def place(self):
        self.ops.nDMaterial("PM4Sand", 1, *PM4_SAND)
        self.ops.element("SSPquad", 1, 1, 2, 3, 4, 1, "PlaneStrain", 1.0, 0.0, 0.0)

    def ready(self):
        super().ready()
        self.ops.setParameter("-val", 0, "-ele", 1, "FirstCall", "1")

    def stress(self):
        return [float(x) for x in self.ops.eleResponse(1, "stress")[:3]]

    def compression(self):
        """Strains of the plane at which the elastic stage, which is linear, has 100 kPa in both directions."""
        columns = []
        for direction in range(2):
            self.begin([[0.0, -1e-5 * (direction == 0)], [0.0, -1e-5 * (direction == 1)], [0.0, 0.0]])
            if self.ops.analyze(1):
                raise RuntimeError("the elastic stage fails")
            columns.append([-x for x in self.stress()[:2]])
        (a, c), (b, d) = columns   # stress_x = a n_x + b n_y, stress_y = c n_x + d n_y
        return [-1e-5 * 100 * (d - b) / (a * d - b * c), -1e-5 * 100 * (a - c) / (a * d - b * c)]


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
        normal = here[:3] if len(here) == 6 else here[:2]
        return "p' at the end [kPa]", -sum(normal) / len(normal)
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
