# SPDX-License-Identifier: MIT
"""Cases of verification/references for other programs: what is given, the mesh, the comparison, the table of results."""
import csv
import json
import math
import re
import tomllib

import clients

FOLDER = clients.root / "verification/references"
NAMES = {**{name: getattr(math, name) for name in ("cos", "exp", "log", "pi")}, "max": max, "min": min, "abs": abs}


class Refused(Exception):
    """What a case asks and a program has not: one sentence."""


def names():
    return sorted(path.parent.name for path in FOLDER.glob("*/case.toml"))


def value(of, **at):
    """A number, or an expression of t, x, y and others as a case writes it."""
    return eval(of.replace("^", "**"), {"__builtins__": {}}, NAMES | at) if isinstance(of, str) else float(of)


class Case:
    """A case: `model` and `properties` of case.toml, `rows` (t, x, y, value) of every quantity, and the mesh: places,
    triangles of six nodes, edges of three by the boundary's name; of three and two if the case has linear pressures."""

    def __init__(self, name, halved=False):
        declared = tomllib.loads((FOLDER / name / "case.toml").read_text(encoding="utf-8"))
        self.name, self.quantities = name, declared["quantity"]
        self.model, self.properties = declared["model"], declared["properties"]
        self.unknowns = tuple(self.model["unknowns"])
        self.end = declared["problem"]["end_s"]
        with open(FOLDER / name / "reference.csv", encoding="utf-8") as file:
            table = list(csv.DictReader(line for line in file if line[0] != "#"))
        self.rows = {q: [tuple(float(row[k]) if row[k] else None for k in ("t", "x", "y", "value"))
                         for row in table if row["quantity"] == q] for q in self.quantities}
        self.places, self.triangles, self.edges = mesh(FOLDER / name / "mesh.msh")
        if halved:
            self.halve()
        if self.model.get("pressures") == "linear":
            self.corners()

    def halve(self):
        """Four triangles for each, straight and quadratic."""
        between = {}

        def middle(a, b):
            key = min(a, b), max(a, b)
            if key not in between:
                between[key] = len(self.places)
                self.places.append(tuple((p + q)/2 for p, q in zip(self.places[a], self.places[b])))
            return between[key]

        self.triangles = [[*corners, *(middle(*pair) for pair in zip(corners, (*corners[1:], corners[0])))]
                          for a, b, c, ab, bc, ca in self.triangles
                          for corners in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        self.edges = {name: [[*pair, middle(*pair)] for a, b, m in found for pair in ((a, m), (m, b))]
                      for name, found in self.edges.items()}

    def corners(self):
        """Linear triangles, as a sharp curve of retention asks."""
        used = sorted({n for triangle in self.triangles for n in triangle[:3]})
        number = {n: i for i, n in enumerate(used)}
        self.places = [self.places[n] for n in used]
        self.triangles = [[number[n] for n in triangle[:3]] for triangle in self.triangles]
        self.edges = {name: [[number[n] for n in edge[:2]] for edge in found] for name, found in self.edges.items()}

    def linear(self):
        return len(self.triangles[0]) == 3

    def conditions(self, *kinds):
        """(boundary, kind, value) of the conditions of these kinds."""
        return [(given["on"], kind, given[kind]) for given in self.model["conditions"] for kind in kinds
                if kind in given]

    def property(self, *keys, **default):
        """The first of these properties that the case has."""
        found = [self.properties[key] for key in keys if key in self.properties]
        return found[0] if found else default["default"]

    def porosity(self):
        e = self.properties.get("void_ratio", 1.0)
        return self.property("porosity", default=e/(1.0 + e))

    def permeability(self):
        """[m2], and the viscosity of water [kPa s]."""
        viscosity = self.property("viscosity_kPa_s", "viscosity_of_water_kPa_s", default=1e-6)
        if "permeability_m2" in self.properties:
            return self.properties["permeability_m2"], viscosity
        return self.properties["saturated_conductivity_m_s"]*viscosity/self.model["gravity_m_s2"], viscosity

    def steps(self, divided=1):
        """Ends of the steps of the case, each divided, with every time of the reference among them."""
        given = self.model.get("steps", {"first": self.end, "growth": 1.0, "longest": self.end})
        wanted = sorted({row[0] for rows in self.rows.values() for row in rows if 0 < row[0] <= self.end} | {self.end})
        t, length, ends = 0.0, given["first"]/divided, []
        while wanted:
            ends.append(min(wanted[0], t + length) if t + 1.01*length < wanted[0] else wanted[0])
            t = ends[-1]
            if t == wanted[0]:
                wanted.pop(0)
            length = min(length*given["growth"]**(1/divided), given["longest"]/divided)
        return ends

    def times(self):
        """Times of the reference; None where every step is asked."""
        if any("first_above" in told["read"] for told in self.quantities.values()):
            return None
        return sorted({row[0] for rows in self.rows.values() for row in rows if 0 < row[0] <= self.end})

    def node(self, x, y):
        """The node at a place."""
        near = min(range(len(self.places)), key=lambda i: math.dist(self.places[i], (x, y)))
        if math.dist(self.places[near], (x, y)) > 1e-9 + 1e-6*abs(x):
            raise ValueError(f"{self.name}: no node at {x}, {y}")
        return near

    def on(self, boundary):
        """Nodes of a boundary, or of the body `soil`."""
        if boundary == "soil":
            return list(range(len(self.places)))
        return sorted({n for edge in self.edges[boundary] for n in edge})

    def of(self, quantity):
        """How a quantity is read: its field (or, on a boundary, its sum), scale and offset, and (time, node) of rows."""
        read = self.quantities[quantity]["read"]
        if "on" in read:
            return read, [(row[0], None) for row in self.rows[quantity]]
        at = read.get("at", (None, None))
        return read, [(row[0], self.node(*(given if own is None else own for given, own in zip(at, row[1:3]))))
                      for row in self.rows[quantity]]


def mesh(path):
    """Places, quadratic triangles and edges of a mesh of these cases (a b c ab bc ca; a b ab)."""
    text = path.read_text(encoding="utf-8")
    part = {name: [line.split() for line in body.strip().splitlines()]
            for name, body in re.findall(r"\$(\w+)\n(.*?)\$End\1", text, re.DOTALL)}
    of = [word[2].strip('"') for word in part["PhysicalNames"][1:] if word[0] == "1"]
    count = int(part["Nodes"][0][1])
    places = [tuple(map(float, line[:2])) for line in part["Nodes"][2 + count:2 + 2*count]]
    triangles, edges, lines = [], {}, iter(part["Elements"][1:])
    for dimension, entity, _, members in (map(int, line) for line in lines):
        found = [[int(n) - 1 for n in next(lines)[1:]] for _ in range(members)]
        if dimension == 1:
            edges[of[entity - 1]] = found
        else:
            triangles += found
    return places, triangles, edges


def check(host, version, run, finer):
    """Runs every case by run(case, divided) and keeps what is off in references.json of the host. finer: cases for which
    half the cells are tried too, and how many steps for one: what converges by that is no disagreement."""
    results = {}
    for name in names():
        case = Case(name)
        try:
            off = differences(case, run(case, 1))
            finer_off = (differences(case, run(Case(name, halved=True), finer[name]))
                         if name in finer else {})
        except Refused as reason:
            results[name] = str(reason)
            print(f"{name}: {host} cannot: {reason}")
            continue
        except RuntimeError as reason:
            results[name] = "no convergence"
            clients.verdict(False, f"reference case {name}", str(reason))
            continue
        results[name] = {}
        for quantity, told in case.quantities.items():
            shares = [d[quantity]/told["tolerance"] for d in (off, finer_off) if d]
            results[name][quantity] = rounded = [float(f"{share:.2g}") for share in shares]
            clients.verdict(shares[0] <= 1 or len(shares) == 2 and shares[1] <= max(1.0, 0.6*shares[0]),
                            f"reference case {name}, {quantity}",
                            " and, finer, ".join(map(str, rounded)) + " of its tolerance")
    kept = clients.root / "clients" / host / "references.json"
    kept.write_text(json.dumps({"version": version, "cases": results}, indent=1) + "\n", encoding="utf-8")


def differences(case, answers):
    """Largest difference of every quantity from the reference, in its unit."""
    return {quantity: max((abs(a - row[3]) for a, row in zip(answers[quantity], case.rows[quantity], strict=True)),
                          key=lambda d: (d != d, d)) for quantity in case.quantities}
