#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Attacks on a rule for drained cycles (README.md) at one point (results.csv), and a foundation with the present program
(foundation.csv). Usage: study.py [results | foundation]"""
import concurrent.futures
import ctypes
import functools
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "common"), str(ROOT / "verification"), str(ROOT / "verification/material"),
                str(ROOT / "verification/material/drained_cycles")]
import tables  # noqa: E402
import high_cycles  # noqa: E402
from tools.bench import parameters  # noqa: E402

HERE = pathlib.Path(__file__).parent
NAMES = ("K_0", "G_0", "N_c", "lambda", "alpha_csl", "N_l", "theta", "M_c", "c", "n_b", "n_d", "A_0", "h_0", "c_h", "c_z", "z_max", "p_atm",
         "c_chi", "zeta_chi", "rho_e", "isotropic", "rule", "tolerance")
NONE, RULE, AS_WRITTEN = 0, 1, 2
SHIPPED = {**{k: v for k, v in parameters(high_cycles.SET).items() if k in NAMES}, "rho_e": 2e-5, "isotropic": 2}
# G_0 near G_max, with h_0 G_0 kept: the set that the prototype of the rule was fitted with.
STIFF = {**SHIPPED, "G_0": 290.0, "K_0": 150.0, "c_chi": 0.26, "h_0": SHIPPED["h_0"] * SHIPPED["G_0"] / 290.0}
VOIDS = 0.8
ROW, DOUBLES, INTS = 20, ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int)
COLUMNS = ("group", "path", "quantity", "tolerance", "without", "with")
TRIAXIAL = np.array([2, -1, -1, 0, 0, 0]) / math.sqrt(6)
SIMPLE = np.array([0, 0, 0, 1, 0, 0]) / math.sqrt(2)
OTHER = np.array([0, 0, 0, 0, 1, 0]) / math.sqrt(2)


class Params(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in NAMES]


class Leg(ctypes.Structure):
    _fields_ = [("led", ctypes.c_int * 6), ("goal", ctypes.c_double * 6)]


@functools.cache
def library():
    target = pathlib.Path(tempfile.mkdtemp()) / "point.so"
    subprocess.run(["cc", "-O3", "-std=c11", "-D_DEFAULT_SOURCE", "-shared", "-fPIC", HERE / "point.c", "-o", target, "-lm"], check=True)
    found = ctypes.CDLL(str(target))
    found.cycles.argtypes = [ctypes.POINTER(Params), ctypes.c_char_p, ctypes.c_int, ctypes.POINTER(Leg), ctypes.c_double, DOUBLES,
                               ctypes.c_double, ctypes.c_int, ctypes.c_int, INTS, DOUBLES]
    found.begin.argtypes = [ctypes.POINTER(Params), ctypes.c_char_p, DOUBLES, ctypes.c_double]
    return found


def stress(change):
    return Leg((ctypes.c_int * 6)(), (ctypes.c_double * 6)(*change)), math.nan


def strain(change, until=math.nan):
    return Leg((ctypes.c_int * 6)(*[1] * 6), (ctypes.c_double * 6)(*change)), until


def axial_strain(change):
    return Leg((ctypes.c_int * 6)(1), (ctypes.c_double * 6)(change)), math.nan


def axial(change):
    return stress((change, 0, 0, 0, 0, 0))


class Point:
    def __init__(self, sand, rule, tolerance, sigma, e=0.8):
        self.params = Params(**{**sand, "rule": rule, "tolerance": tolerance})
        self.state, self.failed = ctypes.create_string_buffer(library().size_of_state()), False
        library().begin(self.params, self.state, (ctypes.c_double * 6)(*sigma), e)

    def go(self, legs, count=1, marks=None, ends=0.0, longest=0.2):
        """Rows [mark, leg, number]; NaN where it failed."""
        marks = np.array(marks or [count], np.int32)
        rows = np.full((len(marks), len(legs), ROW), math.nan)
        untils = np.array([until for _, until in legs], float)
        found = library().cycles(self.params, self.state, len(legs), (Leg * len(legs))(*[leg for leg, _ in legs]), ends,
                               untils.ctypes.data_as(DOUBLES), longest, count, len(marks), marks.ctypes.data_as(INTS), rows.ctypes.data_as(DOUBLES))
        self.failed = self.failed or found < 0
        return rows


def strains(row):
    return row[..., 6:12]


def size(tensor):
    return float(np.sqrt((tensor[..., :3] ** 2).sum(-1) + 2 * (tensor[..., 3:] ** 2).sum(-1)))


def apart(a, b):
    return 100 * size(strains(a) - strains(b))


def sheared(a, b):
    e = strains(a) - strains(b)
    return 100 * size(np.concatenate([e[:3] - e[:3].mean(), e[3:]]))


def volume(row):
    return 100 * strains(row)[..., :3].sum(-1)


def q_of(row):
    return row[..., 0] - 0.5 * (row[..., 1] + row[..., 2])


def isotropic(p):
    return (p, p, p, 0, 0, 0)


def triaxial(sand, rule, tolerance, q, p=200.0, e=0.8):
    point = Point(sand, rule, tolerance, isotropic(p - q / 3), e)
    if q:
        point.go([axial(q)])
    return point


def cycle(amplitude):
    return [axial(amplitude), axial(-2 * amplitude), axial(amplitude)]


MARKS = (10, 100, 1000)
LOOPS = 30


def drained(sand, rule, tolerance, q, amplitude, p=200.0, e=0.8, marks=MARKS):
    """Strain [%] that cycles leave, and its factor to the HCA law at the model's own amplitude."""
    point = triaxial(sand, rule, tolerance, q, p, e)
    first = point.go(cycle(amplitude))[0, -1]
    rows = point.go(cycle(amplitude), marks[-1], list(marks))
    own = size(strains(rows[0, 0]) - strains(rows[0, 1])) / 2
    left = [apart(row[-1], first) for row in rows]
    return left, [x / 100 / high_cycles.accumulated(own, q, n, p, first[12]) for x, n in zip(left, marks)]


# Tests to liquefaction: p' [kPa], e, amplitude of q [kPa], cycles to r_u 0.95 (Wichtmann & Triantafyllidis 2016).
UNDRAINED = ((200, .952, 30, 72), (100, .961, 25, 5), (100, .821, 20, 249), (100, .798, 25, 100), (100, .825, 30, 15), (100, .759, 30, 54),
             (100, .761, 40, 15), (100, .755, 50, 6))


def cycles_to_liquefaction(sand, rule, tolerance, p, e, q, most=600):
    point = Point(sand, rule, tolerance, isotropic(p), e)
    for half in range(2 * most):
        way = 1 - 2 * (half % 2)
        row = point.go([strain(0.1 * way * np.array((1, -.5, -.5, 0, 0, 0)), way * q)], ends=1.0, longest=1e-3)[0, 0]
        if point.failed:
            return math.nan
        if row[17] <= 0.05 * p:
            return 0.25 + 0.5 * half
    return most


def liquefaction(sand, rule, tolerance):
    found = [cycles_to_liquefaction(sand, rule, tolerance, *test[:3]) for test in UNDRAINED]
    return math.sqrt(np.mean([math.log10(n / test[3]) ** 2 for n, test in zip(found, UNDRAINED)]))


def polygon(points):
    return [stress(b - a) for a, b in zip(points[:-1], points[1:])]


def shapes(r, one, two):
    angles = np.linspace(0, 2 * math.pi, 25)
    return {"line": [0 * one, r * one, -r * one, 0 * one], "line across": [0 * one, r * two, -r * two, 0 * one],
            "circle": [r * (math.cos(a) * one + math.sin(a) * two) for a in angles],
            "ellipse 1:0.3": [r * (math.cos(a) * one + .3 * math.sin(a) * two) for a in angles],
            "eight": [r * (math.sin(a) * one + .5 * math.sin(2 * a) * two) for a in angles]}


def square(r, turn, sense):
    corners = [turn + sense * k * math.pi / 2 + math.pi / 4 for k in range(5)]
    return [r * (math.cos(a) * TRIAXIAL + math.sin(a) * SIMPLE) for a in corners]


def loops(rule, tolerance, bias, points, count=LOOPS, rho_e=2e-5):
    """Shear strain [%] that `count` stress loops at p' 200 kPa leave after the first one; isotropically overconsolidated."""
    point = Point({**STIFF, "rho_e": rho_e}, rule, tolerance, isotropic(300.0))
    point.go([stress(isotropic(-100.0))])
    for change in (bias, points[0]):
        if size(change):
            point.go([stress(change)])
    first = point.go(polygon(points))[0, -1]
    return sheared(point.go(polygon(points), count)[0, -1], first)


BIASES = {"isotropic": 0 * TRIAXIAL, "triaxial bias": 80 * TRIAXIAL, "simple shear bias": 80 * SIMPLE}


def turned(rule, tolerance, eta, count=LOOPS):
    """Principal axes turn at constant p' and q."""
    angles = np.linspace(0, 2 * math.pi, 37)
    points = [200 * eta / 3 * (np.array((.5, .5, -1, 0, 0, 0)) + 1.5 * np.array((math.cos(a), -math.cos(a), 0, math.sin(a), 0, 0))) for a in angles]
    point = Point(STIFF, rule, tolerance, isotropic(200.0))
    point.go([stress(points[0])])
    first = point.go(polygon(points))[0, -1]
    return sheared(point.go(polygon(points), count)[0, -1], first)


def strain_circle(rule, tolerance, radius, one, two, marks=(1, 10, 100)):
    """q [kPa] after closed loops of strain from a sheared state of 125 kPa."""
    point = Point(STIFF, rule, tolerance, isotropic(100.0), 0.75)
    point.go([axial_strain(0.004)])
    points = [radius * (math.cos(a) * one + math.sin(a) * two) for a in np.linspace(0, 2 * math.pi, 17)]
    point.go([strain(points[0])])
    return [float(q_of(row[-1])) for row in point.go([strain(b - a) for a, b in zip(points[:-1], points[1:])], marks[-1], list(marks))]


def oedometer(rule, tolerance, low, high, marks=(1, 10, 100)):
    """Axial strain [%] at the low stress; K_0 there after the last cycle."""
    point = Point(STIFF, rule, tolerance, (low, .45 * low, .45 * low, 0, 0, 0))
    change = 0.1 * np.array((1, 0, 0, 0, 0, 0))
    rows = point.go([strain(change, high), strain(-change, low)], marks[-1], list(marks), longest=1e-2)
    return [100 * float(row[1, 6]) for row in rows], float(rows[-1, 1, 2] / low)


def packages(rule, tolerance, amplitudes):
    """Strain [%] that packages of 100 cycles about q 150 kPa leave."""
    point = triaxial(STIFF, rule, tolerance, 150.0)
    last, left = point.go(cycle(amplitudes[0]))[0, -1], []
    for amplitude in amplitudes:
        row = point.go(cycle(amplitude), 100)[0, -1]
        left.append(apart(row, last))
        last = row
    return left


def goes_on(rule, tolerance, count):
    """q [kPa] after 1 % of axial strain that follows cycles of +-40 about 150 kPa."""
    point = triaxial(STIFF, rule, tolerance, 150.0)
    if count:
        point.go(cycle(40.0), count)
    return float(q_of(point.go([axial_strain(0.01)])[0, 0]))


def ripples(rule, tolerance, amplitude):
    """Shear strain [%] at q 150 kPa, reached with 40 unloadings of twice the amplitude, or at once."""
    point = Point(STIFF, rule, tolerance, isotropic(200.0))
    legs = [leg for _ in range(40) for leg in (axial(150 / 40), axial(-2 * amplitude), axial(2 * amplitude))] if amplitude else [axial(150.0)]
    e = strains(point.go(legs)[0, -1])
    return 2 / 3 * 100 * float(e[0] - 0.5 * (e[1] + e[2]))


def first_loading(rule, tolerance):
    point = Point(STIFF, rule, tolerance, isotropic(300.0), 0.9)
    return float(q_of(point.go([axial_strain(0.05)])[0, 0]))


def grazing(rule, tolerance, growth, count=300):
    """Strain [%] of cycles whose amplitude of 40 kPa grows by a share in each."""
    point = triaxial(STIFF, rule, tolerance, 150.0)
    first = point.go(cycle(40.0))[0, -1]
    return apart(point.go([leg for i in range(count) for leg in cycle(40 * (1 + growth * (i + 1)))])[0, -1], first)


def in_a_turned_frame(rule):
    """Share by which the strain of random legs differs where all of them are turned; substeps are of one size."""
    c, s, made = math.cos(0.7), math.sin(0.7), []
    turn = np.array(((c, -s, 0), (s, c, 0), (0, 0, 1))) @ np.array(((1, 0, 0), (0, 0.8, -0.6), (0, 0.6, 0.8)))
    random = np.random.default_rng(3)
    legs = [way * leg for leg in random.normal(size=(20, 6)) * 20 for way in (1, -1)]

    def turned_tensor(v):
        matrix = turn @ v[np.array(((0, 3, 4), (3, 1, 5), (4, 5, 2)))] @ turn.T
        return matrix[(0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)]
    for change in (np.array, turned_tensor):
        made.append(strains(Point(STIFF, rule, 1.0, isotropic(200.0)).go([stress(change(leg)) for leg in legs], 2, longest=0.02)[0, -1]))
    return size(turned_tensor(made[0]) - made[1]) / size(made[0])


def both(function, tolerance, *arguments, last=RULE):
    return function(NONE, tolerance, *arguments), function(last, tolerance, *arguments)


def triaxial_cycles(tolerance, name):
    """Of every group: (group, path, quantity, tolerance, without the rule, with it)."""
    sand = {"shipped": SHIPPED, "stiff": STIFF}[name]
    for q, amplitude in high_cycles.CASES:
        (left, factor), (left_2, factor_2) = (drained(sand, rule, tolerance, q, amplitude, marks=(10, 100, 300)) for rule in (NONE, RULE))
        for i, n in enumerate((10, 100, 300)):
            yield f"drained, {name}", f"{q:g} +- {amplitude:g}", f"strain after {n} [%]", tolerance, left[i], left_2[i]
        yield f"drained, {name}", f"{q:g} +- {amplitude:g}", "factor to HCA, 300", tolerance, factor[-1], factor_2[-1]
    yield "liquefaction", name, "rms log10 N", tolerance, *(liquefaction(sand, rule, tolerance) for rule in (NONE, RULE))
    yield "liquefaction", f"{name}, as written", "rms log10 N", tolerance, *(liquefaction(sand, rule, tolerance) for rule in (NONE, AS_WRITTEN))


def stress_loops(tolerance, bias):
    for shape, points in shapes(32.0, TRIAXIAL, SIMPLE).items():
        yield "stress loops", f"{bias}: {shape}", f"shear strain after {LOOPS} [%]", tolerance, *both(loops, tolerance, BIASES[bias], points)


def others(tolerance):
    for eta in (0.3, 0.6, 0.9):
        yield "axes", f"eta {eta:g}", f"shear strain after {LOOPS} [%]", tolerance, *both(turned, tolerance, eta)
    for radius in (5e-5, 1e-4):
        for name, one, two in (("triaxial and simple shear", TRIAXIAL, SIMPLE), ("two simple shears", SIMPLE, OTHER)):
            for n, a, b in zip((1, 10, 100), *both(strain_circle, tolerance, radius, one, two)):
                yield "strain circles", f"{name}, {radius:g}", f"q after {n} [kPa]", tolerance, a, b
    for low, high in ((60, 400), (100, 200)):
        for name, last in (("", RULE), (", as written", AS_WRITTEN)):
            (a, k), (b, k_2) = both(oedometer, tolerance, low, high, last=last)
            for i, n in enumerate((1, 10, 100)):
                yield "oedometer", f"{low} to {high}{name}", f"axial strain after {n} [%]", tolerance, a[i], b[i]
            yield "oedometer", f"{low} to {high}{name}", "K_0, unloaded, after 100", tolerance, k, k_2
    for amplitudes in ((40.0, 10.0), (10.0, 40.0)):
        a, b = both(packages, tolerance, amplitudes)
        yield "packages", " then ".join(f"+- {x:g}" for x in amplitudes), "strain of the second [%]", tolerance, a[-1], b[-1]
    for n in (0, 1, 300):
        yield "goes on", f"after {n} cycles of 150 +- 40", "q at 1 % more [kPa]", tolerance, *both(goes_on, tolerance, n)
    for amplitude in (0.0, 10.0, 40.0):
        yield "ripples", f"40 of -{2 * amplitude:g}" if amplitude else "none", "shear strain at q 150 [%]", tolerance, *both(ripples, tolerance, amplitude)
    yield "first loading", "drained, e 0.9, p' 300", "q at 5 % [kPa]", tolerance, *both(first_loading, tolerance)
    for growth in (0.0, 1e-7, -1e-7, 1e-4, -1e-4):
        yield "grazing", f"150 +- 40, amplitude growing by {growth:g}", "strain after 300 [%]", tolerance, *both(grazing, tolerance, growth)


def squares(tolerance, bias):
    for rho_e in (0.0, 2e-5):
        found = [[loops(rule, tolerance, BIASES[bias], square(32.0, math.radians(15 * k), sense), rho_e=rho_e) for k in (0, 2, 4) for sense in (1, -1)]
                 for rule in (NONE, RULE)]
        for name, of in (("least", np.nanmin), ("largest", np.nanmax)):
            yield ("squares", f"{bias}, rho_e {rho_e:g}", f"{name} of 6 orientations and senses, shear strain after {LOOPS} [%]", tolerance,
                   *(of(x) for x in found))


def many(tolerance):
    cases = [(p, eta * p, a * p) for p in (200.0,) for eta in (0.0, 0.4, 0.75, 1.0) for a in (0.1, 0.2, 0.3)]
    factors = [np.array([drained(STIFF, rule, tolerance, q, a, p, 0.82)[1] for p, q, a in cases]) for rule in (NONE, RULE)]
    for i, n in enumerate(MARKS):
        for name, of in (("10 %", lambda x: np.nanquantile(x, 0.1)), ("median", np.nanmedian), ("90 %", lambda x: np.nanquantile(x, 0.9)),
                         ("paths that fail", lambda x: np.isnan(x).sum())):
            yield (f"{len(cases)} drained paths", "p' 200; eta 0, 0.4, 0.75, 1; amplitudes of 0.1, 0.2, 0.3 p'; e 0.82", f"factor to HCA, {n}: {name}", tolerance,
                   *(of(x[:, i]) for x in factors))


PARTS = (*((triaxial_cycles, tolerance, name) for name in ("shipped", "stiff") for tolerance in (1e-4, 2e-5)), (many, 3e-4),
         *((stress_loops, tolerance, bias) for bias in BIASES for tolerance in (1e-4, 2e-5)), *((squares, 1e-4, bias) for bias in BIASES),
         *((others, tolerance) for tolerance in (1e-4, 2e-5)))


def rows_of(part):
    return [(*words, f"{tolerance:g}", f"{a:.5g}", f"{b:.5g}") for *words, tolerance, a, b in part[0](*part[1:])]


def results():
    with concurrent.futures.ProcessPoolExecutor() as pool:
        lines = [line for part in pool.map(rows_of, PARTS) for line in part]
    tables.write(HERE / "results.csv", COLUMNS, lines)


TURNS = (1, 2, 5, 10, 20, 50, 100, 200, 500)
PERIOD, STEPS, LOADED = 0.04, 20, 2.0
# A foundation of 1 m diameter under 30 +- 15 kN at 25 Hz on dry Toyoura sand, e 0.8.
SCENE = f"""&scene name='foundation' fields='u' gravity=9.81 threads=1 /
&mesh r=0,0.5,2,4 r_cells=4,5,3 r_ratio=0.85,1.3,1.5 z=-4,-1,0 z_cells=4,6 z_ratio=0.7,0.8 /
&mud name='sand' file='{ROOT}/drivers/materials/toyoura.nml' isotropic=2 /
&region material='sand' rho_s=2.65 void_ratio=0.8 /
&initial stress='geostatic' k_0=0.5 /
&history name='force' file='force.csv' /
&plate name='block' group='top_1' mass=3.06 force=-30 history='force' /
&stage name='rest' analysis='static' duration=1 zero_displacements='yes' /
&stage name='load' analysis='static' duration=1 dt=0.05 /
&stage name='run' analysis='dynamic' duration={PERIOD * TURNS[-1]:g} dt=0.002 /
&fix group='left' field='u_r' /
&fix group='right' field='u_r' /
&fix group='bottom' field='u_z' /
&point name='centre' r=0 z=0 /
"""


def foundation():
    """Settlement of the foundation at the end of turns, by the present program."""
    with tempfile.TemporaryDirectory() as folder:
        force = [(0, 0), (1, 0), (LOADED, 1)]
        force += [(LOADED + PERIOD * i / STEPS, 1 + 0.5 * math.sin(2 * math.pi * i / STEPS)) for i in range(1, STEPS * TURNS[-1] + 1)]
        pathlib.Path(folder, "force.csv").write_text("".join(f"{t:.6f}, {f:.8f}\n" for t, f in force))
        pathlib.Path(folder, "scene.nml").write_text(SCENE)
        build = os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release"
        subprocess.run([pathlib.Path(build) / "host/mud_host", "scene.nml", "--output", "out", "--quiet"], cwd=folder, check=True, capture_output=True)
        seconds = os.times().children_user
        rows = tables.columns(pathlib.Path(folder, "out/histories.csv"))
        at = [float(np.interp(LOADED + PERIOD * n, rows["time"], -1e3 * rows["centre.u_z"])) for n in (0, *TURNS)]
        tables.write(HERE / "foundation.csv", ("turns", "settlement_mm", "seconds"),
                     [(n, f"{x - at[0]:.4f}", f"{seconds:.0f}") for n, x in zip((0, *TURNS), at)])


if __name__ == "__main__":
    for name in sys.argv[1:] or ("results", "foundation"):
        {"results": results, "foundation": foundation}[name]()
