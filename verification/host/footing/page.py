# SPDX-License-Identifier: MIT
"""A footing on sand: bearing pressures by the default tolerance against tight ones, and how far it goes in which soil."""
import numpy as np
from tools import tables
from tools.page import Page, Script, Tolerance
from tools.pictures import COLOURS

import matrix

PAGE = Page(
    claim="bearing pressures by the default settings are those of tight ones at every settlement, and tolerances down to "
          "1e-8 converge, on loose dry, dense, saturated drained and unsaturated sand",
    kind="regression",
    input="`scene.nml`: radius 0.5 m, loose dry sand (e 0.907), weight, surcharge 2 kPa, static, 144 elements, steps of "
          "2.5 mm to 3 cm; dense sand has e 0.75",
    reference="the same scenes with the tolerance 1e-8",
    seconds=70, quick=8, pictures=("footing.png",))
MAKES = (Script("matrix.py", ("matrix.csv",), 280),)

SOILS = {"loose, dry": "loose, dry, surcharge 2, rough", "dense, dry": "dense, dry, surcharge 2, rough",
         "saturated, drained": "loose, drained, surcharge 2, rough", "suction 30": "loose, suction 30, surcharge 2, rough"}
STEPS = "duration=1.0 dt=0.025 /"
TWO_PER_CENT = Tolerance("what an engineer asks of a bearing pressure", relative=0.02)
VISIBLE = Tolerance("against all forces the weight hides the error: if this measure were as good, the page would prove nothing",
                    absolute=-0.02)


def pressures(bench, name, tolerance, measure="auto"):
    """Settlement [cm] and pressure [kPa] at the end of every step."""
    to = "0.05" if bench.quick else "0.3"   # 0.5 or 3 cm
    changes = [*matrix.CASES[name], (STEPS, f"duration={to} dt=0.025 tolerance={tolerance} measure='{measure}' /")]
    return matrix.curve(bench.host("scene.nml", changes))


def both(curve, tight):
    """Pressures of two runs at the settlements that both have: where one cuts a step it has a row in between."""
    there = np.isclose(curve[0][:, None], tight[0][None, :], rtol=1e-9, atol=0)
    assert there.sum() >= min(len(curve[0]), len(tight[0])) and there[-1, -1], "a step of one run is not in the other"
    return curve[1][there.any(axis=1)], tight[1][there.any(axis=0)]


def check(bench):
    for name in list(SOILS)[:1 if bench.quick else None]:
        tight = pressures(bench, SOILS[name], 1e-8)
        bench.near(f"{name}: the default, every step", *both(pressures(bench, SOILS[name], 1e-3), tight), TWO_PER_CENT, "kPa")
        if name != "loose, dry" or bench.quick:
            continue
        bench.near(f"{name}: 1e-6, every step", *both(pressures(bench, SOILS[name], 1e-6), tight), TWO_PER_CENT, "kPa")
        before, there = both(pressures(bench, SOILS[name], 1e-3, "forces"), tight)
        bench.below(f"{name}: less the worst error against all forces", -np.abs(before / there - 1).max(), VISIBLE)
    return tables.rows(bench.here / "matrix.csv")


def texts(bench):
    rows = tables.rows(bench.here / "matrix.csv")
    head = ("soil, surcharge [kPa], face", *(f"{s:g} cm" for s in matrix.SETTLEMENTS), "reached [cm]", "iterations", "cuts", "end")
    reached = sum(row["end"] == "done" for row in rows)
    cuts = [int(row["cuts"] or 0) for row in rows]
    sums = (f"{len(rows)} of {len(matrix.CASES)} cases, {reached} of them to 10 cm, in 40 steps each before cuts; "
            f"{sum(int(row['iterations']) for row in rows)} iterations, {sum(cuts)} cuts, at most {max(cuts)} in a case.")
    return {"README.md": {"matrix": tables.markdown(head, [tuple(row.values()) for row in rows]) + "\n\n" + sums}}


def draw(bench, rows, plt):
    figure, axes = plt.subplots(1, 2, figsize=(8.4, 3.2))
    colours = {}
    for row in rows:
        density, soil, surcharge, face = row["case"].split(", ")
        axis = axes[int(density == "dense")]
        points = [(s, float(row[f"q_{s:g}cm"])) for s in matrix.SETTLEMENTS if row[f"q_{s:g}cm"]]
        colour = colours.setdefault(soil, COLOURS[len(colours) % len(COLOURS)])
        axis.plot(*zip(*points), color=colour, ls="--" if face == "plate" else "-",
                  lw=1.4 if surcharge == "surcharge 2" else 0.8)
    for axis, density in zip(axes, ("loose", "dense")):
        axis.set(title=density, xlabel="settlement [cm]", ylabel="pressure [kPa]", yscale="log")
    axes[0].legend([plt.Line2D([], [], color=c) for c in colours.values()], colours, fontsize=7)
    bench.save(figure, "footing.png")
