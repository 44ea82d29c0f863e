# SPDX-License-Identifier: MIT
"""Volumetric and axial strain of many drained stress cycles."""
import high_cycles
import recorded
from point_steps import MIDDLE
from point_walk import Path, Soil, Walker
from tools import tables
from tools.page import Page, Script
from tools.pictures import COLOURS

PAGE = Page(
    claim="what the published set accumulates in 1000 drained triaxial cycles, what cyclic preloading leaves of it, and how far Karlsruhe fine sand with "
          "every option is from the high-cycle accumulation model",
    kind=("regression", "study"),
    input="drained triaxial cycles of q = 0 +- 10 kPa and q = -30 +- 10 kPa about p' 100 kPa (lateral stress held), e 0.8, led by the axial stress in steps of "
          "1 kPa; q = 0 +- 20, 0 +- 40 and 150 +- 40 kPa about p' 200 kPa with `karlsruhe_cyclic`",
    reference="HCA model of Niemunis, Wichtmann & Triantafyllidis (2005) with published constants of that sand; else the numbers that were recorded",
    seconds=6, quick=1, pictures=("drained_cycles.png", "high_cycles.png"))
MAKES = (Script("make_results.py", ("results.csv",), 18),)

# What preloading leaves of it: Toyoura sand, to which nobody has fitted it, with a number of the size that Karlsruhe sand has (0.165).
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


def measure(bench, marks=(10, 100, 1000), high_marks=high_cycles.MARKS):
    walker, found = Walker(bench.build), {}
    high = {(case, name): walker.start(high_cycles.path(changes, *case, high_marks)) for case in high_cycles.CASES if high_marks for name, changes in high_cycles.SETS.items()}
    runs = {(centre, name): walker.start(path(soil, centre, marks, max(marks))) for centre in CENTRES for name, soil in soils().items()}
    for centre in CENTRES:
        for k, quantity in enumerate(("axial", "volumetric")):
            for i in marks:
                for name in soils():
                    found[f"q = {centre:g} +- {AMPLITUDE:g}: {quantity} strain after {i} [%]", name] = strains(runs[centre, name].result())[i][k]
    for (case, name), run in high.items():
        for i, values in high_cycles.found(run.result(), case[0]).items():
            for quantity, value in zip(HIGH, values):
                found[of_high(case, quantity, i), name] = 100 * value
    return found


HIGH = ("amplitude", "strain", "volume", "HCA")


def of_high(case, quantity, cycles):
    return f"{quantity} of q = {case[0]:g} +- {case[1]:g} after {cycles} [%]"


def check(bench):
    measured = measure(bench, (10, 100), ()) if bench.quick else measure(bench, high_marks=(10, 30))
    recorded.compare(bench, measured)
    return measured


def texts(bench):
    return {"README.md": {"values": recorded.table(bench, tuple(soils())), "high cycles": high_table(recorded.read(bench))}}


def high_table(values):
    lines = []
    for case in high_cycles.CASES:
        for name in high_cycles.SETS:
            def of(quantity, i):
                return values[of_high(case, quantity, i), name]
            lines.append((f"{case[0]:g} +- {case[1]:g}", name, f"{of('amplitude', 10):.3f}",
                          *(f"{of('strain', i):.2g} ({of('volume', i):.2g})" if i < 1000 else f"{of('strain', i):.1f} ({of('volume', i):.2g})"
                            for i in high_cycles.TOLD),
                          *(f"{of('HCA', i):.2g}" for i in high_cycles.TOLD), f"{of('strain', 1000) / of('HCA', 1000):.0f}"))
    return tables.markdown(("q [kPa]", "karlsruhe_cyclic", "strain amplitude [%]", *(f"strain (volume) after {i} [%]" for i in high_cycles.TOLD),
                            *(f"HCA, {i} [%]" for i in high_cycles.TOLD), "model/HCA, 1000"), lines)


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
    draw_high(bench, plt)


def draw_high(bench, plt):
    values = recorded.read(bench)
    figure, axes = plt.subplots(1, 3, figsize=(12, 4), layout="constrained")
    long = [10 ** (k / 10) for k in range(41)]
    for axis, case in zip(axes.flat, high_cycles.CASES):
        for (name, changes), colour in zip(high_cycles.SETS.items(), COLOURS):
            axis.loglog(high_cycles.MARKS, [values[of_high(case, "strain", i), name] for i in high_cycles.MARKS], "o-", ms=3, color=colour, label=name)
            if not changes:
                amplitude = values[of_high(case, "amplitude", high_cycles.AMPLITUDE_OF), name] / 100
        axis.loglog(long, [100 * high_cycles.accumulated(amplitude, case[0], i) for i in long], "k--", label="HCA")
        axis.set(title=f"q = {case[0]:g} +- {case[1]:g} kPa")
        axis.set(xlabel="cycle, logarithmic")
    axes[0].set(ylabel="strain that is left [%], logarithmic")
    axes[0].legend()
    bench.save(figure, "high_cycles.png")
