# SPDX-License-Identifier: MIT
"""Lateral stress in one-dimensional compression and unloading."""
import math

import recorded
from point_walk import Path, Walker
from tools.page import Page, Script
from tools.pictures import COLOURS

PAGE = Page(
    claim="what the published set gives for K0 at first loading and on unloading, beside Jaky's and Mayne & Kulhawy's relations",
    kind=("experiment", "regression"),
    input="one-dimensional compression from an isotropic 1 or 20 kPa to an axial stress of 400 kPa, then unloading to an overconsolidation ratio of 16; "
          "e 0.85, 0.75, 0.65 at the start; led by the axial stress in steps of 1 kPa",
    reference="K0 = 1 - sin phi (Jaky 1944), with the friction angle of the published M_c: sin phi = 3 M_c/(6 + M_c); unloading K0 OCR^(sin phi) "
              "(Mayne & Kulhawy 1982)",
    seconds=3, quick=1, pictures=("k0.png",))
MAKES = (Script("make_results.py", ("results.csv",), 3),)

TOP, VOID_RATIOS, STARTS, OCRS = 400.0, (0.85, 0.75, 0.65), (1.0, 20.0), (1, 2, 4, 8, 16)
SIN_PHI = 3 * 1.25 / (6 + 1.25)
LITERATURE = "Jaky; Mayne & Kulhawy"


def path(soil, e, start):
    """Rows named by the axial stress on the way up, by OCR on the way down."""
    made, at = Path(soil, e, p=start).lead("seeeee"), start
    for stress in [*(TOP * 10 ** (-k / 10) for k in range(13, -1, -1))]:
        if stress > at:
            made.go(max(4, math.ceil(stress - at)), (stress - at, 0, 0, 0, 0, 0)).row("up")
            at = stress
    for k in range(1, 13):
        stress = TOP * 2 ** (-k / 3)
        made.go(max(4, math.ceil(at - stress)), (stress - at, 0, 0, 0, 0, 0)).row(f"ocr_{2 ** (k / 3):.3g}")
        at = stress
    return made


def k0(row):
    return row["stress"][1] / row["stress"][0]


def measure(bench):
    walker, found = Walker(bench.build), {}
    runs = {(e, start, name): walker.start(path(soil, e, start)) for start in STARTS for e in VOID_RATIOS for name, soil in recorded.soils().items()}
    for start in STARTS:
        for e in VOID_RATIOS:
            for ocr in OCRS:
                quantity = f"from {start:g} kPa, e {e}, OCR {ocr}"
                found[quantity, LITERATURE] = (1 - SIN_PHI) * ocr ** SIN_PHI
                for name in recorded.PARAMETERS:
                    rows = runs[e, start, name].result()
                    label = "up" if ocr == 1 else f"ocr_{ocr}"
                    found[quantity, name] = k0([row for row in rows if row["label"] == label][-1])
    return found


def check(bench):
    measured = measure(bench)
    recorded.compare(bench, measured)
    return measured


def texts(bench):
    return {"README.md": {"values": recorded.table(bench, (LITERATURE, *recorded.PARAMETERS), "K0 = sigma_r/sigma_a")}}


def draw(bench, _, plt):
    walker = Walker(bench.build)
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    for axis, start in zip(axes, STARTS):
        for e, colour in zip(VOID_RATIOS, COLOURS):
            for (name, soil), style in zip(recorded.soils().items(), ("--", "-")):
                rows = walker.run(path(soil, e, start))
                axis.semilogx([r["stress"][0] for r in rows], [k0(r) for r in rows], style, color=colour,
                              label=f"e {e}, {name.split(' (')[0]}")
        axis.axhline(1 - SIN_PHI, color="black", lw=0.8)
        down = [TOP * 2 ** (-k / 3) for k in range(13)]
        axis.semilogx(down, [(1 - SIN_PHI) * (TOP / s) ** SIN_PHI for s in down], "k:", lw=1.2, label=LITERATURE)
        axis.set_xticks((25, 50, 100, 200, 400), ("25", "50", "100", "200", "400"))
        axis.minorticks_off()
        axis.set(xlabel="axial stress [kPa]", ylabel="sigma_r/sigma_a [-]", title=f"from an isotropic {start:g} kPa", ylim=(0, 2))
    axes[0].legend(fontsize=7)
    bench.save(figure, "k0.png")
