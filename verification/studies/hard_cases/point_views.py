# SPDX-License-Identifier: MIT
"""What the picture of each case at the point shows: a claim as its title, an axis on which a miss is seen, and the bound of its criterion.

A view takes {label: rows} of a setting and gives curves [(x, y)]; rows are those of `pictures.with_rows`.
"""
import math
from dataclasses import dataclass
from typing import Callable

import numpy as np
from bounds import TRAIL, beyond
from catalogue import P_MIN
from closed_forms import line_pressure, steady_pressure
from point_steps import MIDDLE

FLOOR = 1e-9   # %: what is smaller is drawn there


@dataclass(frozen=True)
class View:
    claim: str
    across: str
    up: str
    curves: Callable
    bound: float = None         # a dashed line
    scale: str = "linear"       # of the vertical axis: linear, log, symlog
    scale_across: str = "linear"
    marks: bool = False         # single states instead of a line
    held_against: bool = False  # the path without events, which has to be drawn finely
    lines: Callable = None      # further curves that the case is held against, dotted


def shear(row):
    """Deviator stress, with the sign of sigma_1 - sigma_3."""
    s, p = row["stress"], row.p
    norm = math.sqrt(1.5 * (sum((x - p) ** 2 for x in s[:3]) + 2 * sum(x * x for x in s[3:])))
    return math.copysign(norm, (s[0] - s[2]) or s[3] or 1.0)


def volume(row):
    return 100 * sum(row["strain"][:3])


def along(x, y):
    """One curve a path, a state a point."""
    return lambda runs: [([x(row) for row in rows], [y(row) for row in rows]) for rows in runs.values()]


def numbered(y):
    return lambda runs: [(range(1, len(rows) + 1), [y(row) for row in rows]) for rows in runs.values()]


def strain(i):
    return lambda row: 100 * row["strain"][i]


def pressure(row):
    return row.p


def suction(row):
    return row["suction"]


def void_ratio(row):
    return row["e"]


def off_void_ratio(row):
    return max(FLOOR, 100 * abs(row["e"] / MIDDLE - 1))


def ratio(row):
    return shear(row) / row.p


def pairs(runs):
    """(clean, turned) rows of every stress level or density."""
    return [(runs[label], runs["turned" + label[5:]]) for label in runs if label.startswith("clean")]


def against_clean(runs):
    """q over that of the path without the events at the same axial strain [%], where the strain is larger than ever before."""
    curves = []
    for clean, turned in pairs(runs):
        forward = [row for i, row in enumerate(turned) if i == 0 or row["strain"][0] >= max(other["strain"][0] for other in turned[:i]) - 1e-9]
        at = [row["strain"][0] for row in forward]
        reference = np.interp(at, [row["strain"][0] for row in clean], [row.q for row in clean], left=math.nan)
        curves.append(([100 * x for x in at], [100 * (row.q / q - 1) for row, q in zip(forward, reference)]))
    return curves


def against_frame(runs):
    """p' in the frame that turns against that in the frame at rest, which takes two steps for each of its turns [%]."""
    clean, turned = pairs(runs)[0]
    at = {int(row["label"]): row for row in clean if row["label"].isdigit()}
    found = [(int(row["label"]), at[2 * int(row["label"])], row) for row in turned if row["label"].isdigit() and 2 * int(row["label"]) in at]
    return [([n for n, _, _ in found], [max(FLOOR, 100 * abs(b.p / a.p - 1)) for _, a, b in found])]


def cycle(row, steps):
    """How many cycles of so many steps there were; the label of a row counts steps."""
    return int(row["label"]) / steps if row["label"].isdigit() else None


def asymmetry(runs):
    """|high + low| of tau over its first range, cycle by cycle [%]."""
    curves = []
    for rows in runs.values():
        tau = [row["stress"][3] for row in rows]
        size = max(tau[:3]) - min(tau[:3])
        found = [(cycle(b, 2), 100 * abs(a["stress"][3] + b["stress"][3]) / size) for a, b in zip(rows, rows[1:])
                 if cycle(a, 2) and cycle(b, 2) and int(b["label"]) == int(a["label"]) + 1]
        curves.append(([n for n, _ in found], [max(1e-4, y) for _, y in found]))
    return curves


def against_kilopascals(runs):
    """p' computed in MPa against that in kPa, state by state [%]."""
    return [(range(1, len(runs["kPa"]) + 1), [max(FLOOR, 100 * abs(1e3 * b.p / a.p - 1)) for a, b in zip(runs["kPa"], runs["MPa"])])]


def gained(runs):
    """Axial strain gained since the first state, at the end of each cycle [%]."""
    rows = runs["biased"]
    found = [(cycle(row, 2), 100 * (row["strain"][0] - rows[0]["strain"][0])) for row in rows if cycle(row, 2) and int(row["label"]) % 2 == 0]
    return [tuple(zip(*found))]


def by_cycle(y, steps=80):
    return lambda runs: [tuple(zip(*[(cycle(row, steps), y(row)) for row in rows if cycle(row, steps)])) for rows in runs.values()]


def margins(runs):
    return [(range(1, len(runs) + 1), [max(beyond(row) for row in rows) for rows in runs.values()])]


def compression_line(runs):
    values = [void_ratio(row) for rows in runs.values() for row in rows]
    grid = [min(values) + (max(values) - min(values)) * i / 40 for i in range(41)]
    return [([line_pressure(e) for e in grid], grid)]


def steady_lines(runs):
    return [([0, 60], [steady_pressure(float(e))] * 2) for e in runs]


def single_states(runs):
    """The end of every path."""
    return [([rows[-1].p for rows in runs.values()], [shear(rows[-1]) for rows in runs.values()])]


def noise(claim, bound=0.3):
    return View(claim, "axial strain [%]", "q against that of the straight path [%]", against_clean, bound, "symlog", held_against=True)


def margin(claim, x, told, scale_across="linear"):
    return View(claim, told, "beyond the bounding surface [%]", along(x, beyond) if x else numbered(beyond), TRAIL, scale_across=scale_across)


P, Q, AXIAL, SHEAR = "p' [kPa]", "q [kPa]", "axial strain [%]", "shear strain [%]"
VIEWS = {
    "reversals of 1e-09": noise("reversals of 1e-9 change nothing", 0.1),
    "reversals of 1e-07": noise("reversals of 1e-7 change nothing", 0.1),
    "reversals of 2e-05": noise("reversals of 2e-5 give no strength"),
    "reversals of 1e-04": noise("reversals of 1e-4 give no strength"),
    "reversals of 1e-2": margin("cycles of 1 %: within the bound", pressure, P, "log"),
    "noise of 1e-6 along": noise("noise of 1e-6 gives no strength"),
    "noise of 5e-5 along": noise("noise of 5e-5 gives no strength"),
    "noise of 1e-5 across": noise("noise across gives no strength"),
    "loops in softening": noise("loops in softening give no strength"),
    "tiny loops in softening": noise("tiny loops change nothing", 1.0),
    "nine nested loops": View("nested loops close one after the other", AXIAL, Q, along(strain(0), shear)),
    "1000 symmetric cycles": View("1000 symmetric cycles stay symmetric", "cycle", "asymmetry of tau [%]", asymmetry, 0.3, "log", "log"),
    "10,000 cycles of two shears": View("10,000 cycles of two shears stay symmetric", "cycle", "asymmetry of tau [%]", asymmetry, 0.3, "log", "log"),
    "1000 biased cycles": View("1000 biased cycles gain little strain", "cycle", "axial strain gained [%]", gained, 0.1, "symlog"),
    "circles": View("circles of strain: p' never rises", "cycle", P, by_cycle(pressure), 100.0),
    "figure eights": View("figure eights: p' never rises", "cycle", P, by_cycle(pressure), 100.0),
    "100 rotations of the principal axes": View("rotating axes: strain accumulates evenly", "cycle", "volumetric strain [%]", by_cycle(volume)),
    "a frame that turns ten times": View("a rotating frame changes nothing", "turn of 3.6 degrees", "p' against the frame at rest [%]", against_frame, 0.1, "log"),
    "kPa or MPa": View("the same in MPa", "state", "p' against that in kPa [%]", against_kilopascals, 0.1, "log"),
    "random walks": View("random walks stay inside the surface", P, Q, along(pressure, shear)),
    "10,000 increments of 1e-12": noise("10,000 increments of 1e-12: unchanged", 0.1),
    "tension and back": View("held at p_min, then compressed again", "volumetric strain [%]", P, along(volume, pressure), P_MIN, "log"),
    "30 cycles through the cut-off": View("30 times down to p_min and back", "volumetric strain [%]", P, along(volume, pressure), P_MIN, "log"),
    "reversals at the cut-off": View("reversals at p_min: p' stays there", "state", P, numbered(pressure), P_MIN, "log"),
    "shear at p' 0.2 kPa": View("sheared at p' 0.2 and 1 kPa", AXIAL, "q/p' [-]", along(strain(0), ratio)),
    "active failure": View("active failure: a critical state", AXIAL, "q/p' [-]", along(lambda row: -100 * row["strain"][1], ratio)),
    "tension under suction": View("at p_min under suction, wetted, compressed", "volumetric strain [%]", P, along(volume, pressure), P_MIN, "log"),
    "static liquefaction": View("static liquefaction: p' falls a hundredfold", P, Q, along(pressure, shear)),
    "the steady state": View("the steady state of the closed form", AXIAL, P, along(strain(0), pressure), lines=steady_lines),
    "cyclic mobility": View("cyclic mobility, 40 cycles", P, Q, along(pressure, shear), scale_across="log"),
    "50 % of shear": View("50 % of shear: the critical state", SHEAR, "q/p' [-]", along(strain(3), ratio)),
    "wetting to saturation": View("wetting to saturation: no jump of strain", "suction [kPa]", "volumetric strain [%]", along(suction, volume), scale_across="symlog"),
    "drying to 1e5 kPa": View("drying to 1e5 kPa: e stays constant", "suction [kPa]", "change of e [%]", along(suction, off_void_ratio), 1e-6, "log", "symlog"),
    "five wettings and dryings": View("five wettings: strain without a jump", "suction [kPa]", "volumetric strain [%]", along(suction, volume), scale_across="symlog"),
    "the air-entry value 200 times": View("200 times through the air-entry value", P, Q, along(pressure, shear)),
    "wetting at rest": View("wetting at rest: the surface shrinks below", "suction [kPa]", "beyond the bounding surface [%]", along(suction, beyond), TRAIL),
    "pulses of suction": View("pulses of suction while sheared", AXIAL, "beyond the bounding surface [%]", along(strain(0), beyond), TRAIL),
    "1000 ripples of suction with hysteresis": View("sheared after 1000 ripples of suction, and without", AXIAL, Q, along(strain(0), shear)),
    "along the compression line": View("along the line (dotted) to 60 MPa", P, "void ratio [-]", along(pressure, void_ratio), scale_across="log", lines=compression_line),
    "beyond the compression line": View("K0 compression across the line (dotted)", P, "void ratio [-]", along(pressure, void_ratio), scale_across="log",
                                        lines=compression_line),
    "p' 100 MPa": View("undrained from p' 100 MPa", P, Q, along(pressure, shear)),
    "10 % in one increment": View("10 % in one increment: within the bound", "path", "beyond the bounding surface [%]", margins, TRAIL, marks=True),
    "one increment or a thousand": View("one increment (dots) or a thousand", P, Q, along(pressure, shear), scale="log", scale_across="log"),
    "void ratio 0.02 to 4.5": View("void ratios 0.02 to 4.5", AXIAL, "beyond the bounding surface [%]", along(strain(0), beyond), TRAIL),
    "parameters at their bounds": View("18 parameters at their bounds: last states", P, Q, single_states, scale_across="log", marks=True),
    "40 other sands": View("40 other sands: sheared there and back", P, Q, along(pressure, shear)),
}
