# SPDX-License-Identifier: MIT
"""Volumetric and axial strain of many drained stress cycles."""
import recorded
from point_steps import MIDDLE
from point_walk import Path, Soil, Walker
from tools.page import Page, Script
from tools.pictures import COLOURS

PAGE = Page(
    claim="what the published set accumulates in 1000 drained triaxial cycles, and what cyclic preloading leaves of it",
    kind="regression",
    input="drained triaxial cycles of q = 0 +- 10 kPa and q = -30 +- 10 kPa about p' 100 kPa (lateral stress held), e 0.8, led by the axial stress in steps of 1 kPa",
    reference="none: the numbers are stated, and compared with those that were recorded",
    seconds=4, quick=1, pictures=("drained_cycles.png",))
MAKES = (Script("make_results.py", ("results.csv",), 3),)

# What preloading leaves of it: Toyoura sand with the number that Karlsruhe sand has by default.
PRELOADED = "with preloading"


def soils():
    return {**recorded.soils(), PRELOADED: Soil(properties=(("c_chi", 0.26),))}


CENTRES, AMPLITUDE, CYCLES = (0.0, -30.0), 10.0, 1000


def path(soil, centre, rows_at, cycles=CYCLES):
    """Rows at the end of cycles, at q = centre."""
    axial = (1, 0, 0, 0, 0, 0)
    made = Path(soil, MIDDLE).lead("ssseee")
    if centre:
        made.go(30, (centre, *axial[1:]))
    made.row("0")
    for i in range(1, cycles + 1):
        made.go(10, (AMPLITUDE, *axial[1:])).go(20, (-2 * AMPLITUDE, *axial[1:])).go(10, (AMPLITUDE, *axial[1:]))
        if i in rows_at:
            made.row(str(i))
    return made


def strains(rows):
    """cycle -> (axial, volumetric strain since the first cycle) [%]"""
    first = rows[0]["strain"]
    return {int(r["label"]): (100 * (r["strain"][0] - first[0]), 100 * (sum(r["strain"][:3]) - sum(first[:3]))) for r in rows[1:]
            if not r["failed"]}


def measure(bench, marks=(10, 100, 1000)):
    walker, found = Walker(bench.build), {}
    runs = {(centre, name): walker.start(path(soil, centre, marks, max(marks))) for centre in CENTRES for name, soil in soils().items()}
    for centre in CENTRES:
        for k, quantity in enumerate(("axial", "volumetric")):
            for i in marks:
                for name in soils():
                    found[f"q = {centre:g} +- {AMPLITUDE:g}: {quantity} strain after {i} [%]", name] = strains(runs[centre, name].result())[i][k]
    return found


def check(bench):
    measured = measure(bench, (10, 100) if bench.quick else (10, 100, 1000))
    recorded.compare(bench, measured)
    return measured


def texts(bench):
    return {"README.md": {"values": recorded.table(bench, tuple(soils()))}}


def draw(bench, _, plt):
    walker = Walker(bench.build)
    at = sorted({round(10 ** (k / 8)) for k in range(25)})
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    for axis, centre in zip(axes, CENTRES):
        for (name, soil), colour in zip(soils().items(), COLOURS):
            found = strains(walker.run(path(soil, centre, at)))
            for k, (quantity, style) in enumerate((("axial", "--"), ("volumetric", "-"))):
                axis.semilogx(list(found), [v[k] for v in found.values()], style, color=colour, label=f"{quantity}, {name.split(' (')[0]}")
        axis.set(xlabel="cycle", ylabel="strain since the first cycle [%], compression positive", title=f"q = {centre:g} +- {AMPLITUDE:g} kPa")
    axes[0].legend()
    bench.save(figure, "drained_cycles.png")
