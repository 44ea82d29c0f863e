# SPDX-License-Identifier: MIT
"""Why there is no rule for drained cycles, and what a foundation does without one."""
import pathlib

import numpy as np
import study
from point_walk import Path, Soil, Walker
from tools import tables
from tools.page import Page, Script, Tolerance

HERE = pathlib.Path(__file__).parent
PAGE = Page(
    claim="a rule that slows drained cycles down, prototyped in triaxial space, does not keep that in six components: it is not part of the model; "
          "what holds, what fails, and a foundation that settles for ever",
    kind=("code-to-code", "study"),
    input="one point of Karlsruhe fine sand (`point.c`, written apart from the library) with and without the rule; a foundation of 1 m under 30 +- 15 kN "
          "at 25 Hz (`study.py`)",
    reference="without the rule: the library on the same paths; for drained cycles the HCA model of material/drained_cycles",
    seconds=30, quick=6)
MAKES = (Script("study.py", ("results.csv", "foundation.csv"), 700),)

SAME = Tolerance("two integrations, at 1e-4 and 1e-5 a substep", relative=5e-3)
FRAME = Tolerance("stress-led substeps are solved to 1e-10, component by component, and the places of events follow", absolute=1e-5)
FIRST = Tolerance("the rule does not act in first loading", relative=1e-12)


def by_library(walker, rho_e, p, before, loop, count):
    """Strain [%] that stress loops leave after the first one."""
    sand = {**study.SHIPPED, "rho_e": rho_e, "s_chi": 0.0}
    path = Path(Soil(properties=tuple(sand.items())), study.VOIDS, p=p).lead("ssssss")
    for change in before:
        path.go(50, change)
    for i in range(count + 1):
        for change in loop:
            path.go(40, change)
        if i in (0, count):
            path.row(str(i))
    first, last = (np.array(row["strain"]) / (1, 1, 1, 2, 2, 2) for row in walker.run(path))
    return 100 * study.size(last - first)


def by_study(rho_e, p, before, loop, count):
    point = study.Point({**study.SHIPPED, "rho_e": rho_e}, study.NONE, 1e-5, study.isotropic(p))
    for change in before:
        point.go([study.stress(change)])
    legs = [study.stress(change) for change in loop]
    first = point.go(legs)[0, -1]
    return study.apart(point.go(legs, count)[0, -1], first)


def paths():
    axial = np.array((1.0, 0, 0, 0, 0, 0))
    for q, amplitude in ((0.0, 20.0), (150.0, 40.0)):
        yield (f"triaxial, {q:g} +- {amplitude:g}", 2e-5, 200 - q / 3, [q * axial] if q else [], [amplitude * axial, -2 * amplitude * axial, amplitude * axial])
    for bias in ("triaxial bias", "simple shear bias"):
        corners = study.square(32.0, 0.0, 1)
        yield (f"square, {bias}, rho_e 0", 0.0, 300.0, [np.array(study.isotropic(-100.0)), study.BIASES[bias], corners[0]],
               [b - a for a, b in zip(corners[:-1], corners[1:])])


def check(bench):
    walker = Walker(bench.build)
    for name, *path in paths():
        bench.near(f"no rule, {name}: strain after 20", by_study(*path, 20), by_library(walker, *path, 20), SAME, "%")
    bench.near("with the rule, strain of 80 random legs in a turned frame, share", study.in_a_turned_frame(study.RULE), 0.0, FRAME)
    bench.near("q at 5 % in first loading, with the rule", study.first_loading(study.RULE, 1e-4), study.first_loading(study.NONE, 1e-4), FIRST, "kPa")


def texts(bench):
    rows = tables.rows(HERE / "results.csv")
    of = {}
    for row in rows:
        of.setdefault((row["group"], row["path"], row["quantity"]), []).append(row)
    made = {}
    for mark, groups in TABLES.items():
        made[mark] = tables.markdown(("path", "quantity", "without", "with the rule"), [
            (f"{group}, {path}" if len(groups) > 1 else path, quantity, *(" / ".join(f"{float(r[side]):.3g}" for r in sorted(found, key=lambda r: -float(r["tolerance"])))
                                                                           for side in ("without", "with")))
            for (group, path, quantity), found in of.items() if group in groups])
    turns = tables.rows(HERE / "foundation.csv")
    made["foundation"] = tables.markdown(("turn", "settlement since the first began [mm]", "a turn, since the row above [mm]"), [
        (b["turns"], f"{float(b['settlement_mm']):.2f}",
         f"{(float(b['settlement_mm']) - float(a['settlement_mm'])) / (int(b['turns']) - int(a['turns'])):.3f}") for a, b in zip(turns, turns[1:])])
    made["time"] = f"{turns[-1]['turns']} turns take {turns[-1]['seconds']} s of one core."
    return {"README.md": made}


TABLES = {"drained": ("drained, shipped", "drained, stiff", "12 drained paths", "liquefaction"), "loops": ("stress loops", "squares", "axes"),
          "strain": ("strain circles",), "oedometer": ("oedometer",), "others": ("packages", "goes on", "ripples", "first loading", "grazing")}
