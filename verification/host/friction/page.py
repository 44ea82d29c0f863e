# SPDX-License-Identifier: MIT
"""Coulomb friction of mud_host: a block on an incline, a cylinder under a tangential force (Cattaneo, Mindlin), footings
on Tresca soil."""
import numpy as np
from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="contact with Coulomb friction: a block slides exactly when it should, with the acceleration and the loss that it "
          "should, and stops; partial slip of a cylinder and its unloading; smooth and rough footings",
    kind="exact",
    input="`incline.nml`: 20 degrees, mu 0.2, then 0.6; `cylinder.nml`: radius 10 m, equal materials, mu 0.5, seven edges "
          "of 5 mm to the rim; `footing.nml`: strip and circle on Tresca soil (the UMAT of the tests), cohesion 0 and 100 kPa",
    reference="Newton's second law; Cattaneo and Mindlin with Masing's rule for the way back; limit loads of Prandtl (strip) "
              "and of Cox, Eason and Hopkins (circle)",
    seconds=20, quick=6, pictures=("friction.png",))
MAKES = (Script("make_mesh.py", ("incline.msh", "cylinder.msh"), 1),)

SLOPE, GRAVITY = np.radians(20), 10.0
SPEED = Tolerance("elastic waves of the block and of the penalty remain in the velocities; of the speed at the end of sliding",
                  absolute=1e-4)
FORCE = Tolerance("pressures add up to the weight but for the same waves; of the weight", absolute=1e-4)
REST = Tolerance("what sticks does not move; of the speed at the end of sliding", absolute=1e-6)
LOSS = Tolerance("the block is rigid but for 1e-7 m of its ways, and friction of the first step of a stage grows from zero: a step "
                 "of 200", relative=1e-3)
NEVER = Tolerance("sliding has the sign of its traction", absolute=0.0)
CREATED = Tolerance("Newton's tolerance of 1e-6 in every step; of the work of the weight", absolute=1e-4)
RIM = Tolerance("nodal pressures scatter over the last two edges before the rim, of seven; sums of friction from one rim on, of Q",
                absolute=0.04)
MEANS = Tolerance("seven edges to the rim: the pressure falls from one to zero along them; of p_0", absolute=0.02)
SUM = Tolerance("friction adds up to the force; Newton's tolerance, weight at the end of the step", relative=2e-3)
EDGE = 0.01513   # cell beside the edge of the footing, of 0.5 m
LIMIT = {"strip": 2 + np.pi, "smooth circle": 5.69, "rough circle": 6.05}


def limit(name):
    share = EDGE / 0.5 * (2 if "circle" in name else 1)
    return Tolerance("the stress jumps at the edge, within a cell: the footing is wider by up to the cell beside it; cells below 1 %",
                     relative=share + 0.01)


def along(table, what):
    """Down the slope."""
    return -(np.cos(SLOPE) * table[f"top.{what}_r"] + np.sin(SLOPE) * table[f"top.{what}_z"])


def slide(bench, first=0.2):
    out = bench.host("incline.nml", [("friction = 0.2 ", f"friction = {first} ")])
    return (tables.columns(out / f) for f in ("histories.csv", "ledger.csv", "contact.csv"))


def check_block(bench):
    history, ledger, contact = slide(bench)
    time, speed = history["time"] - 1, along(history, "v")
    down, press = GRAVITY * np.sin(SLOPE), GRAVITY * np.cos(SLOPE)
    top = (down - 0.2 * press) * 0.1
    found = np.interp([0.02, 0.1, 0.12, 0.15], time, speed)
    bench.near("block, mu 0.2: speed gained in 0.08 s, over that in 0.1 s", (found[1] - found[0]) / top, 0.8, SPEED)
    bench.near("block, mu 0.6: speed lost in 0.03 s, over the same", (found[2] - found[3]) / top, (0.6 * press - down) * 0.03 / top, SPEED)
    weight = 2.5 * 0.2 * 0.04 * GRAVITY
    for name, mu, end in (("c", 0.2, 0.1), ("b", 0.6, 0.15)):
        at = np.argmin(abs(contact["time"] - 1 - end))
        bench.near(f"block, mu {mu}: friction over the weight", -contact[f"{name}.drag"][at] / weight, mu * np.cos(SLOPE), FORCE)
    bench.near("block: speed at the end, over that of sliding", speed[-1] / top, 0.0, REST)
    way = along(history, "u")
    sliding = np.interp(0.1, time, way) - way[0]
    normal = weight * np.cos(SLOPE)
    bench.near("block: loss by friction", ledger["friction"][-1], normal * (0.2 * sliding + 0.6 * (way[-1] - way[0] - sliding)), LOSS, "kJ")
    bench.below("block: energy that friction gives back in a step", -np.min(np.diff(ledger["friction"])), NEVER, "kJ")
    moving = ledger["stage"] > 1
    bench.below("block: energy created, of the work of the weight",
                -np.min(ledger["imbalance"][moving] - ledger["imbalance"][moving][0]) / ledger["gravity"][-1], CREATED)
    for mu, slides in ((0.3635, True), (0.3645, False)):
        history, ledger, contact = slide(bench, mu)
        at = np.argmin(abs(contact["time"] - 1.1))
        speed = np.interp(0.1, history["time"] - 1, along(history, "v"))
        bench.near(f"block, mu {mu} about tan 20 = 0.36397: nodes of nine that slide", contact["c.sliding"][at], 9 if slides else 0,
                   Tolerance("it slides below the tangent and sticks above", absolute=0))
        bench.note(f"mu {mu}: {speed:.2g} m/s after 0.1 s")
    return time, along(tables.columns(bench.host("incline.nml") / "histories.csv"), "v")


def profile(x, a, c):
    root = np.sqrt(np.maximum(0, 1 - (x / a) ** 2))
    return root - c / a * np.sqrt(np.maximum(0, 1 - (x / c) ** 2))


def check_cylinder(bench):
    out = bench.host("cylinder.nml")
    modulus, mu, first, shown = 1e4 / (1 - 0.3**2) / 2, 0.5, None, {}
    for stage in ("shift", "back"):
        row, node = tables.columns(out / f"reactions_{stage}.csv"), tables.columns(out / f"contact_{stage}.csv")
        press, force = -row["cylinder_top.force_z"][-1], row["cylinder_top.force_r"][-1]
        a = np.sqrt(4 * press * 10.0 / (np.pi * modulus))
        peak = mu * 2 * press / (np.pi * a)
        first = first or force
        x = np.linspace(-1.3 * a, 1.3 * a, 26001)
        wanted = profile(x, a, a * np.sqrt(1 - first / (mu * press)))
        if stage == "back":
            wanted = wanted - 2 * profile(x, a, a * np.sqrt(1 - (first - force) / (2 * mu * press)))
        order = np.argsort(node["r"])
        r, t, w = (node[name][order] for name in ("r", "shear", "weight"))
        sums = np.concatenate([[0], np.cumsum((wanted[1:] + wanted[:-1]) / 2 * np.diff(x))]) * peak
        middles = (r[1:] + r[:-1]) / 2
        bench.near(f"cylinder, {stage}: friction up to every node", np.cumsum(t * w)[:-1] / first, np.interp(middles, x, sums) / first, RIM)
        bench.near(f"cylinder, {stage}: all of it", np.sum(t * w), force, SUM, "kN")
        bench.note(f"cylinder, {stage}: Q/(mu P) {force / mu / press:.3f}")
        if stage == "shift":
            press_of = node["pressure"][order] / (2 * press / (np.pi * a))
            means = np.convolve(press_of, [0.25, 0.5, 0.25], mode="same")
            inside = abs(r) < 0.9 * a
            bench.near("cylinder: means of the pressures of three nodes, within 0.9 of the half width", means[inside],
                       np.sqrt(1 - (r[inside] / a) ** 2), MEANS)
            bench.note(f"cylinder: single pressures are off by up to {np.max(abs(press_of[inside] - np.sqrt(1 - (r[inside] / a) ** 2))):.2g} of p_0")
        shown[stage] = x / a, wanted, r / a, t / peak
    return shown


def check_footings(bench):
    change = [("'tresca.so'", f"'{bench.program('tests/umats/tresca.so').resolve()}'")]
    for name in ("smooth strip", "rough strip", "smooth circle", "rough circle"):
        if bench.quick and name != "smooth strip":
            continue
        more = [("cohesion=0", "cohesion=100")] if "rough" in name else []
        if "strip" in name:
            more.append(("fields='u'", "fields='u' geometry='plane_strain'"))
        thrust = tables.columns(bench.host("footing.nml", change + more) / "contact.csv")["base.thrust"][-1]
        area = 0.5 if "strip" in name else np.pi * 0.25
        bench.near(f"{name}: limit load / s_u", thrust / area / 10, LIMIT["strip" if "strip" in name else name], limit(name))


def check(bench):
    """What the picture shows."""
    block = check_block(bench)
    shown = None if bench.quick else check_cylinder(bench)
    check_footings(bench)
    return block, shown


def draw(bench, found, plt):
    (time, speed), shown = found
    figure, axes = plt.subplots(1, 3, figsize=(10.5, 3.2), layout="constrained")
    axes[0].plot(time, speed)
    axes[0].set(xlabel="time [s]", ylabel="speed [m/s]", title="Block: mu 0.2, from 0.1 s on 0.6", xlim=(0, 0.3))
    for axis, stage in zip(axes[1:], shown or {}):
        x, wanted, r, t = shown[stage]
        axis.plot(x, wanted, lw=1, label="closed form")
        axis.plot(r, t, "o", ms=3, label="host, nodes")
        axis.set(xlabel="x/a", ylabel="shear stress / (mu p_0)", title=f"Cylinder, stage {stage}", xlim=(-1.3, 1.3))
        axis.legend(fontsize=8)
    bench.save(figure, "friction.png")
