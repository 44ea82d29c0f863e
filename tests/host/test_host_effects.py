# SPDX-License-Identifier: MIT
"""Effects that mud_host derives from a scene: each on and off, by hand, the table, the monitored effects, restarts,
and whether what is dropped is as small as promised."""
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
from checking import build, check, finish, work  # noqa: E402
import tables  # noqa: E402 (checking knows its folder)

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}

ELASTIC = "&elastic name = 'soil' young = 1.0e4 poisson = 0.25 /"
WATER = "&permeability name = 'k' intrinsic = 1.0e-10 law = 'constant' /"
CURVE = "&retention name = 'c' /"
POROUS = "permeability = 'k'"
UNSATURATED = "permeability = 'k' retention = 'c'"
MODULUS = 1.0e4 * 0.75 / (1.25 * 0.5)     # E (1 - nu)/((1 + nu)(1 - 2 nu)): 12000 kPa
TOLERANCE = 0.01                          # the default


def column(keys="gravity = 0", stage="duration = 10 dt = 0.1", times="0, 10", values="0, 1", load=10, height=1, laws="",
           region="", more="", soil=ELASTIC, effects="effects = 'auto'"):
    """A column under a pressure, smooth side walls, base held."""
    return f"""&scene name = 'column' geometry = 'plane_strain' {effects} {keys} /
&mesh r = 0, 0.1 r_cells = 1 z = 0, {height} z_cells = 10 /
{soil}
{laws}
&region material = 'soil' void_ratio = 0.8 {region} /
&history name = 'h' times = {times} values = {values} /
&stage name = 'load' tolerance = 1.0e-8 {stage} /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = {load} history = 'h' /
{more}
&point name = 'top' r = 0 z = {height} /
&point name = 'base' r = 0 z = 0 /
"""


def start(text, name, *more):
    scene = work / f"{name}.nml"
    scene.write_text(text)
    return subprocess.run([host, scene, "--output", work / name, *more], capture_output=True, text=True,
                          env=environment)


def run(text, name="run", *more):
    """What it prints, and its table of effects (empty without one)."""
    shutil.rmtree(work / name, ignore_errors=True)
    done = start(text, name, *more)
    check(f"{name} runs", done.returncode == 0, done.stderr)
    table = work / name / "effects.csv"
    rows = tables.rows(table) if table.exists() else []
    return done.stdout, {row["effect"]: row for row in rows}


def history(name, column):
    return {round(row["time"], 9): row[column] for row in tables.numbers(work / name / "histories.csv")}


def apart(one, other, column):
    """Largest difference of two histories at common times, as a share of the larger peak."""
    a, b = history(one, column), history(other, column)
    common = a.keys() & b.keys()
    check(f"{one}, {other}: common times", len(common) > 5, len(common))
    return max(abs(a[t] - b[t]) for t in common) / max(map(abs, [*a.values(), *b.values()]))


def is_on(what, table, effect, on, by="scene"):
    row = table.get(effect, {})
    check(f"{what}: {effect} is {'on' if on else 'off'} by {by}",
          row.get("on", "").strip("!") == ("on" if on else "off") and row.get("by") == by, row)


def same_run(what, auto, hand):
    for name in ("histories.csv", "ledger.csv", "nodes_load.csv", "points_load.csv"):
        one, other = (work / auto / name).read_bytes(), (work / hand / name).read_bytes()
        check(f"{what}: {name} as by hand, byte for byte", one == other)


# Inertia. A ramp of 10 s leaves 1/10 s over the slowest frequency, pi/2 sqrt(M/rho) for a column of 1 m; the bound is
# met from above by at most 1 % (Rayleigh's quotient is cut by 0.6 %, the mesh adds less).
rho = 2.65 / 1.8
omega = math.pi / 2 * math.sqrt(MODULUS / rho)
said, table = run(column(), "slow")
is_on("slow ramp", table, "inertia in load", False)
estimate = float(table["inertia in load"]["estimate"])
check("slow ramp: the estimate is the bend over the frequency", 0.1 / omega <= estimate <= 1.01 * 0.1 / omega, estimate)
is_on("no permeability", table, "field p_w", False)
is_on("no retention", table, "field p_c", False)
run(column("fields = 'u'", "analysis = 'static' duration = 10 dt = 0.1", effects=""), "slow_hand")
same_run("slow ramp", "slow", "slow_hand")
check("given: no table", not (work / "slow_hand/effects.csv").exists())
said, table = run(column(stage="duration = 0.02 dt = 0.001", times="0, 0.02"), "fast")
is_on("fast ramp", table, "inertia in load", True)
run(column("fields = 'u'", "analysis = 'dynamic' duration = 0.02 dt = 0.001", times="0, 0.02", effects=""), "fast_hand")
same_run("fast ramp", "fast", "fast_hand")
_, table = run(column(stage="duration = 1 dt = 0.1", times="0, 1", values="1, 1"), "sudden")
is_on("sudden load", table, "inertia in load", True)
_, table = run(column(stage="duration = 1 dt = 0.1", more="&initial v_z = -1.0e-3 /"), "moving")
is_on("initial velocity", table, "inertia in load", True)
check("initial velocity: not bounded", table["inertia in load"]["estimate"] == "not bounded")
_, table = run(column(region="damping = 1"), "damped")
is_on("damped", table, "inertia in load", True)
check("damped: says so", "a damping is given" in table["inertia in load"]["because"], table)

# What dropping inertia changes is no more than its estimate says, and more than a tenth of it: 1 s of ramp and half a
# second of rest, 18 steps to a slowest period (their error is below 2 % of the vibration).
ramp = dict(times="0, 1", load=10)
step = 0.0025
_, table = run(column("gravity = 0 effects_tolerance = 0.03", f"duration = 1.5 dt = {step}", **ramp), "still")
is_on("a tolerance of 3 %", table, "inertia in load", False)
estimate = float(table["inertia in load"]["estimate"])
_, table = run(column(stage=f"duration = 1.5 dt = {step} rho_inf = 1", **ramp), "waves")
is_on("a tolerance of 1 %", table, "inertia in load", True)
difference = apart("still", "waves", "top.u_z")
check("inertia dropped: no more than the estimate", estimate / 10 < difference <= estimate * 1.02,
      (difference, estimate))

# p_c. A column under 300 kPa of water cannot lose its saturation by 10 kPa of load; without that water it may.
deep = ("&initial p_w = 300 p_c = -300 /\n&fix group = 'top' field = 'p_w' value = 300 /\n"
        "&load group = 'top' kind = 'pressure' value = 300 /\n")
atmosphere = "&fix group = 'bottom' field = 'p_a' /\n"
pulse = dict(times="0, 0.05, 0.1", values="0, 1, 0", stage="duration = 0.1 dt = 0.002")
wet = dict(laws=WATER.replace("constant", "corey") + "\n" + CURVE, region=UNSATURATED)
_, table = run(column(more=deep + atmosphere, **pulse, **wet), "deep")
is_on("deep", table, "field p_c", False)
is_on("deep", table, "field p_w", True)
by_hand = {**pulse, "stage": "analysis = 'dynamic' duration = 0.1 dt = 0.002"}
run(column("fields = 'u-p_w' seepage_inertia = 'yes'", more=deep, region=POROUS, effects="", **by_hand,
           laws=wet["laws"]), "deep_hand")
same_run("deep", "deep", "deep_hand")
is_on("deep", table, "relative acceleration", True)
no = "gravity = 0 seepage_inertia = 'no'"
_, table = run(column(no, more=deep + atmosphere, **pulse, **wet), "deep_two")
is_on("deep without seepage inertia", table, "field p_c", False)
_, table = run(column(no + " fields = 'u-p_w-p_c'", more=deep + atmosphere, **pulse, **wet), "deep_three")
is_on("deep, three fields", table, "field p_c", True, "hand")
for name in ("top.u_z", "base.p_w"):
    difference = apart("deep_two", "deep_three", name)
    check(f"p_c dropped: {name} changes by less than the tolerance", 0 < difference < TOLERANCE, difference)
shallow = "&fix group = 'top' field = 'p_w' /\n"
said = start(column(more=shallow, **pulse, **wet), "shallow", "--check").stdout
check("shallow: p_c is on", re.search(r"^ *field p_c +on +scene", said, re.MULTILINE), said)
check("shallow: the estimate is twice the load", re.search(r"field p_c +on +scene 20 kPa", said), said)
said = start(column(more=deep.replace("value = 300", "value = 200") + atmosphere, **pulse, **wet), "loose",
             "--check").stdout
check("without balance: p_c is on", re.search(r"field p_c +on +scene not bounded .* without balance", said), said)
said = start(column("gravity = 0", more=shallow, laws=WATER + "\n&retention name = 'c' law = 'saturated' /",
                    region=UNSATURATED, **pulse), "shallow", "--check").stdout
check("saturated by its law: p_c is off", re.search(r"^ *field p_c +off +scene", said, re.MULTILINE), said)

for what, more, why in [
        ("driven", "&fix group = 'top' field = 'u_z' value = -1.0e-3 history = 'h' /", "boundaries that move"),
        ("pumped", "&load group = 'bottom' kind = 'water' value = -1.0e-6 history = 'h' /", "outflow of water"),
        ("blown", "&load group = 'bottom' kind = 'air' value = 1.0e-6 history = 'h' /", "inflow of air"),
        ("pushed", "&load group = 'bottom' kind = 'force_r' value = 1 history = 'h' /", "forces on nodes"),
        ("thrown", "&initial group = 'all' p_w = 300 p_c = -300 v_z = 1.0e-3 /", "it moves at the start"),
        ("tied", "&fix group = 'bottom' field = 'p_c' value = -300 /", "p_c and p_a prescribe p_w")]:
    said = start(column(more=deep + atmosphere + more, **pulse, **wet), "kept", "--check").stdout
    check(f"{what}: p_c is on", re.search(rf"field p_c +on +scene not bounded .*{why}", said), said)
full = WATER + "\n&retention name = 'c' law = 'saturated' /"
said = start(column(more=shallow + "&load group = 'bottom' kind = 'air' value = 1.0e-6 /", laws=full,
                    region=UNSATURATED, **pulse), "blown", "--check").stdout
check("blown, saturated by its law: p_c is on", re.search(r"field p_c +on +scene", said), said)

# p_w. Consolidation takes L**2 eta/(k M): drained within seconds under a load that takes a thousand.
porous = dict(laws=WATER, region=POROUS, more="&fix group = 'top' field = 'p_w' /")
slow = dict(times="0, 1000", stage="duration = 1000 dt = 20 rho_inf = 0")
_, table = run(column(**slow, **porous), "drained")
is_on("drained", table, "field p_w", False)
is_on("drained", table, "inertia in load", False)
time = 1e-6 / 1e-10 * (1 / MODULUS + 1 / 2.2e6)
estimate = float(table["field p_w"]["estimate"])
check("drained: time of consolidation over that of the load", math.isclose(estimate, time / 1000, rel_tol=1e-5),
      estimate)
run(column("fields = 'u'", "analysis = 'static' duration = 1000 dt = 20", times="0, 1000", effects=""), "drained_hand")
same_run("drained", "drained", "drained_hand")
_, table = run(column("gravity = 0 fields = 'u-p_w'", **slow, **porous), "draining")
is_on("draining", table, "field p_w", True, "hand")
share = [*history("draining", "base.p_w").values()][-1] / 10
check("p_w dropped: the pressure is half the estimate, as for a slab", math.isclose(share, estimate / 2, rel_tol=0.01),
      (share, estimate))
difference = apart("drained", "draining", "top.u_z")
check("p_w dropped: the settlement changes by less than the estimate", difference < estimate, (difference, estimate))
for what, keys in {"faster": dict(times="0, 10", stage="duration = 10 dt = 1"),
                   "sealed": dict(slow, more=""),
                   "squeezed": dict(slow, more="&fix group = 'top' field = 'p_w' /\n"
                                               "&fix group = 'right' field = 'u_r' value = -0.001 history = 'h' /"),
                   "suddenly": dict(slow, values="1, 1"),
                   "pressed": dict(slow, more="&fix group = 'top' field = 'p_w' value = 5 /"),
                   "filled": dict(slow, more="&fix group = 'top' field = 'p_w' /\n"
                                             "&load group = 'bottom' kind = 'water' value = 1.0e-9 /")}.items():
    said = start(column(**{**porous, **keys}), "kept", "--check").stdout
    check(f"{what}: p_w is on", re.search(r"^ *field p_w +on +scene", said, re.MULTILINE), said)

# Gravity: rho g H of a millimetre and of a metre of soil against 1 % of 10 kPa.
_, table = run(column("", height=0.001, stage="duration = 10 dt = 1"), "thin")
is_on("thin", table, "gravity", False)
weight = rho * 9.81 * 0.001
check("thin: its weight", math.isclose(float(table["gravity"]["estimate"]), weight, rel_tol=1e-5), table["gravity"])
run(column("fields = 'u'", "analysis = 'static' duration = 10 dt = 1", height=0.001, effects=""), "thin_hand")
same_run("thin", "thin", "thin_hand")
said, table = run(column("", stage="duration = 1 dt = 0.1"), "heavy")
is_on("heavy", table, "gravity", True)
is_on("heavy", table, "inertia in load", True)     # its weight comes all at once
run(column("gravity = 9.81", "analysis = 'dynamic' duration = 1 dt = 0.1", effects=""), "heavy_hand")
same_run("heavy", "heavy", "heavy_hand")

# Relative acceleration: on in saturated soil where the loads are fast, off where they are slow, never in unsaturated
# soil; there the table marks it where the loads are beyond the limit of the u-p form, n eta_w/(k rho_w).
LIMIT = 0.8 / 1.8 * 1e-6 / 1e-10
quick = dict(times="0, 0.001, 0.002", values="0, 1, 0", stage="duration = 0.002 dt = 0.0001", more=shallow)
_, table = run(column(laws=WATER, region=POROUS, **quick), "quick")
is_on("quick", table, "relative acceleration", True)
row = table["relative acceleration"]
check("quick: bends of 1/ms at the start, twice that at the peak",
      math.isclose(float(row["estimate"]), 3e3, rel_tol=1e-5), row)
check("quick: a hundredth of the limit", math.isclose(float(row["threshold"]), LIMIT / 100, rel_tol=1e-5), row)
_, table = run(column(laws=WATER.replace("e-10", "e-13"), region=POROUS, **quick), "tight")
is_on("tight", table, "relative acceleration", False)
# Half full at any suction: the total stress at the start is -1.5 + 3 - 0.5 3 = 0.
half = "&retention name = 'c' law = 'table' suction = 0, 1000 saturation = 0.5, 0.5 /"
state = "&initial p_w = -3 p_c = 3 stress = 'uniform' sigma = -1.5, -1.5, -1.5 /\n&fix group = 'top' field = 'p_a' /"
_, table = run(column(laws=WATER.replace("e-10", "e-9") + "\n" + half, region=UNSATURATED, **{**quick, "more": state}),
               "unsaturated")
is_on("unsaturated", table, "relative acceleration", False)
row = table["relative acceleration"]
check("unsaturated: quarter waves of 1 ms", math.isclose(float(row["estimate"]), math.pi / 2 / 1e-3, rel_tol=1e-5), row)
check("unsaturated: the limit itself", math.isclose(float(row["threshold"]), LIMIT / 10, rel_tol=1e-5), row)
check("unsaturated: marked, and called unstable", row["on"] == "off!" and "unstable" in row["because"], row)

# MUD: a tenth of the frequency, for a stiffness of a hundredth; its dilatancy leaves suction without a bound. The
# initial stress of 100 kPa carries the load, which then rises to 110 kPa.
sand = dict(soil="&mud name = 'soil' tangent = 3 /", values="1, 1.1", load=100, laws=WATER + "\n" + CURVE,
            region=UNSATURATED.replace("'c'", "'mud'"),
            more="&initial stress = 'uniform' sigma = -100, -100, -100 /\n" + shallow)
said = start(column(**sand), "sand", "--check").stdout
slowest, bound = map(float, re.search(r"free vibrations from (\S+) rad/s, bound with (\S+)", said).groups())
check("sand: a tenth of the frequency", math.isclose(bound, slowest / 10, rel_tol=1e-5), said)
estimate = float(re.search(r"inertia in load +off +scene (\S+)", said)[1])
check("sand: the bend over it", math.isclose(estimate, 0.1 / bound, rel_tol=1e-5), said)
check("sand: suction has no bound", re.search(r"field p_c +on +scene not bounded .*dilatancy", said), said)

# By hand wins, and the table says so.
said, table = run(column("gravity = 9.81 fields = 'u-p_w' seepage_inertia = 'yes'",
                         "analysis = 'quasi_static' duration = 0.02 dt = 0.01", times="0, 0.02", **porous), "hands")
for effect, on in {"field p_w": True, "field p_c": False, "inertia in load": False, "gravity": True,
                   "relative acceleration": True}.items():
    is_on("hands", table, effect, on, "hand")
check("hands: inertia is marked", table["inertia in load"]["on"] == "off!", table["inertia in load"])
check("hands: it is told what the mark means", "off!: off although" in said, said)
for effect, row in table.items():
    check(f"printed: {effect}", re.search(rf"^ *{effect} +{row['on']} +{row['by']} ", said, re.MULTILINE), said)

# Cost: 11 rows of vertices and 10 of middle nodes, 3 to a row.
row = table["field p_w"]
check("cost: unknowns of p_w", row["unknowns"] == "63", row)
whole = int(re.search(r"(\d+) entries", said)[1])
_, dry = run(column("gravity = 0 fields = 'u'"), "dry")
rest = int(re.search(r"(\d+) entries", start(column("gravity = 0 fields = 'u'"), "dry", "--check").stdout)[1])
check("cost: entries of p_w", int(row["entries"]) == whole - rest, (row, whole, rest))

# Monitored effects. From 0.1 s on the water is drawn down to -4 kPa within 0.1 s: 1 % of the 10 kPa of load are
# passed in the eleventh step of 0.01 s.
crossing = dict(keys="gravity = 0 fields = 'u-p_w' seepage_inertia = 'no' checkpoint_steps = 10", times="0, 0.1",
                stage="analysis = 'quasi_static' duration = 0.25 dt = 0.01", laws=WATER, region=POROUS,
                more="&history name = 'd' times = 0.1, 0.2 values = 0, 1 /\n"
                     "&fix group = 'all' field = 'p_w' value = -4 history = 'd' /")
said, table = run(column(**crossing), "sucks")
warnings = [line for line in said.splitlines() if line.startswith("Warning: field p_c")]
check("suction: one warning", len(warnings) == 1, said)
check("suction: repeated at the end", said.count("Warning: field p_c") == 2, said)
check("suction: time, threshold, what to set",
      re.search(r"at 0\.11 s .* above 0\.1 kPa.* fields = 'u-p_w-p_c'", warnings[0]), warnings)
row = table["field p_c"]
check("suction: the largest is noted", math.isclose(float(row["largest_seen"]), 4, rel_tol=1e-6), row)
check("suction: when it crossed", math.isclose(float(row["crossed_at"]), 0.11, rel_tol=1e-6), row)
check("suction: quiet says nothing", not run(column(**crossing), "quiet", "--quiet")[0])
check("suction: but the table does",
      (work / "quiet/effects.csv").read_bytes() == (work / "sucks/effects.csv").read_bytes())

# A fast ramp by hand without inertia: the speed of the motion is seen, u/t against u omega.
ramp = dict(times="0, 0.02", stage="analysis = 'quasi_static' duration = 0.02 dt = 0.001 rho_inf = 0")
said, table = run(column(**ramp), "hasty")
row = table["inertia in load"]
check("speed: warned of", "Warning: inertia in load" in said and "analysis = 'dynamic'" in said, said)
# The speed u z/L of a column against the strain energy: sqrt(rho L/3)/sqrt(M/L)/t; nodes of equal mass are 6 % off.
speed = math.sqrt(rho / 3 / MODULUS) / 0.02
check("speed: as large as that of the column", math.isclose(float(row["largest_seen"]), speed, rel_tol=0.1),
      (row, speed))
said, table = run(column(), "slow")
check("slow: no warning", "Warning: inertia" not in said and not table["inertia in load"]["crossed_at"], said)
seen = float(table["inertia in load"]["largest_seen"])
check("slow: seen, and below the estimate", 0 < seen < float(table["inertia in load"]["estimate"]), table)

# A sudden load on a freely drained column: after a quarter of the slowest period all of the expected strain energy is
# kinetic, whatever the modes, so that its frequency is seen; the time step damps less than 1 %.
said, table = run(column(no, "analysis = 'dynamic' duration = 0.1 dt = 0.001 rho_inf = 1", times="0, 1",
                         values="1, 1", laws=WATER.replace("e-10", "e-7"), region=POROUS, more=shallow), "ring")
row = table["relative acceleration"]
slowest = math.pi / 2 * math.sqrt(MODULUS / (3.45 / 1.8))
check("frequency: warned of", row["crossed_at"] and "Warning: relative acceleration" in said, row)
check("frequency: the slowest", math.isclose(float(row["largest_seen"]), slowest, rel_tol=0.02), (row, slowest))
# Half full soil: the largest acceleration over the largest speed, once a wave has passed; here above the limit.
said, table = run(column(laws=WATER.replace("e-10", "e-8") + "\n" + half, region=UNSATURATED,
                         **{**quick, "more": state}), "waving")
row = table["relative acceleration"]
check("frequency of unsaturated soil: warned of", row["crossed_at"] and "Warning: relative acceleration" in said, row)
check("frequency of unsaturated soil: of the order of the load's",
      0.3e3 < float(row["largest_seen"]) < 10e3, row)

# Pore pressure by drainage where p_w was dropped: that of a slab, the strain rate times L**2 eta/(2 k).
_, table = run(column(**slow, **porous), "drained")
row = table["field p_w"]
check("drainage: seen", math.isclose(float(row["largest_seen"]), 1e-6 / 1e-10 / MODULUS / 1000 / 2, rel_tol=1e-3), row)

# A run that is taken up again remembers what it has seen, and derives the same.
if (work / "sucks/checkpoint.h5").exists():
    files = {path.name: path.read_bytes() for path in (work / "sucks").iterdir()}
    again = start(column(**crossing), "sucks", "--restart", work / "sucks/checkpoint.h5")
    check("restart: runs", again.returncode == 0, again.stderr)
    for name, content in files.items():
        check(f"restart: {name}", (work / "sucks" / name).read_bytes() == content)
    check("restart: the warning is in the summary alone", again.stdout.count("Warning: field p_c") == 1, again.stdout)
    check("restart: another tolerance is another scene", start(column(**{**crossing, "keys": crossing["keys"] +
          " effects_tolerance = 0.02"}), "sucks", "--restart", work / "sucks/checkpoint.h5").returncode == 17)

# Mistakes.
for what, text, words in [("no analysis", column("gravity = 0", effects=""), ("needs analysis", "quasi_static")),
                          ("unknown word", column(effects="effects = 'all'"), ("given|auto",)),
                          ("tolerance", column("effects_tolerance = 2"), ("outside",))]:
    done = start(text, "mistake")
    check(f"{what}: refused", done.returncode == 2 and len(done.stderr.splitlines()) == 1, done.stderr)
    for word in words:
        check(f"{what}: says {word}", word in done.stderr, done.stderr)

finish()
