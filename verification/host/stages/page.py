# SPDX-License-Identifier: MIT
"""Parts of the ground that leave and join between stages: an excavation, an embankment, saturated ground that is cut."""
from tools import tables
from tools.page import Page, Tolerance

PAGE = Page(
    claim="ground that leaves and joins: an elastic excavation does not depend on its lifts, layers settle as their weights ask, "
          "saturated ground that is cut keeps its water and then drains",
    kind="exact",
    input="`excavation.nml`: a cut of 4 m in four lifts and in one; `embankment.nml`: three layers of 1 m on 2 m; `water.nml`: the upper "
          "metre of five leaves within a second, then water drains",
    reference="superposition; sums of layer weights over the constrained modulus; hydrostatic pressures",
    seconds=5, quick=2)

SAME = Tolerance("weights follow the void ratio, which strains of 1e-4 move by 1e-4: of second order in them, 1e-8, with room", relative=1e-7)
BALANCED = Tolerance("Newton's tolerance of 1e-10 a step; of the work of the weight", absolute=1e-9)
LAYERS = Tolerance("weights follow the void ratio: strains are below 1e-5", relative=1e-5)
WATER = Tolerance("strains of 1e-4 move void ratios and weights by as much, Newton's tolerance is 1e-8", relative=1e-3)


def check_excavation(bench):
    lifts = [bench.host("excavation.nml")]
    one = [("stages = 'rest', 'lift1', 'lift2', 'lift3'", "stages = 'rest'"), ("stages = 'rest', 'lift1', 'lift2' /", "stages = 'rest' /"),
           ("stages = 'rest', 'lift1' /", "stages = 'rest' /")]
    one += [(f"&stage   name = 'lift{i}'  analysis = 'static'  duration = 1  dt = 0.5  tolerance = 1e-10 /\n", "") for i in (1, 2, 3)]
    lifts.append(bench.host("excavation.nml", one))
    four, single = (tables.columns(folder / "histories.csv") for folder in lifts)
    for name in ("base.u_z", "edge.u_r", "edge.u_z", "toe.u_z"):
        bench.near(f"excavation in four lifts against one: {name}", four[name][-1], single[name][-1], SAME, "m")
    ledger = tables.columns(lifts[0] / "ledger.csv")
    bench.near("excavation: open balance of energy, over the work of the weight", ledger["imbalance"][-1] / abs(ledger["gravity"][-1]), 0, BALANCED)


def check_embankment(bench):
    rows = tables.columns(bench.host("embankment.nml") / "histories.csv")
    weight, modulus = 2.7 / 1.8 * 10, 1e7 * 0.7 / (1.3 * 0.4)
    for z in (2, 3, 4, 5):
        above = 5 - z
        wanted = above * weight * z + (0 if z == 2 else weight * (z - 1) + weight / 2)
        bench.near(f"embankment: settlement at {z} m", -rows[f"z{z}.u_z"][-1], wanted / modulus, LAYERS, "m")


def check_water(bench):
    rows = tables.columns(bench.host("water.nml") / "histories.csv")
    unit, modulus = (2.7 + 0.8) / 1.8 * 10, 1e5 * 0.75 / (1.25 * 0.5)
    share = 1 / (1 + 0.8 / 1.8 * modulus / 2.2e8)
    cut = abs(rows["time"] - 2).argmin()
    bench.near("water: pressure at the base after the cut", rows["base.p_w"][cut], 50 - share * unit, WATER, "kPa")
    bench.near("water: pressure at the base, drained", rows["base.p_w"][-1], 40, WATER, "kPa")
    bench.near("water: heave, drained", rows["top.u_z"][-1], (unit - 10) * 4 / modulus, WATER, "m")


def check(bench):
    check_excavation(bench)
    check_embankment(bench)
    check_water(bench)
