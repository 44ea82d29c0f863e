# SPDX-License-Identifier: MIT
"""Boundaries of dynamic stages in mud_host: base motion by acceleration, Rayleigh damping, tied sides, ground that
stays at rest behind an absorbing boundary. Waves and transfer functions: verification/host/waves."""
import sys

import numpy as np

from checking import build, check, root, work
from host_program import ran, start

sys.path.insert(0, str(root / "common"))
import tables  # noqa: E402

ROUNDING = 1e-10   # of a linear problem with hundreds of unknowns
COLUMN = """&scene name = 'c' geometry = 'plane_strain' fields = '{fields}' gravity = {gravity} {more} /
&mesh r = 0, 1 r_cells = 1 z = -4, 0 z_cells = {cells} /
&elastic name = 'soil' young = 2.0e4 poisson = 0.25 /
&permeability name = 'k' intrinsic = 1.0e-10 law = 'constant' /
&region material = 'soil' rho_s = 2 void_ratio = {void} permeability = 'k' {damping} /
&point name = 'top' r = 0 z = 0 /
&point name = 'corner' r = 1 z = 0 /
&point name = 'base' r = 0 z = -4 /
"""


def column(fields="u", gravity=0, more="", cells=4, void=0, damping=""):
    return COLUMN.format(**locals())


def run(text, name, *words):
    ran(name, text, *words)
    return tables.columns(work / name / "histories.csv"), work / name


def stage(name, duration, dt, rho_inf=1.0, more=""):
    return (f"&stage name = '{name}' analysis = 'dynamic' duration = {duration} dt = {dt} rho_inf = {rho_inf} "
            f"tolerance = 1e-6 {more} /\n")


# The base has the acceleration that is given, through the end of a stage and past that of the history, and moves by its
# double integral.
TIED = "&tie first = 'left' second = 'right' /\n&fix group = 'all' field = 'u_z' /\n"
MOVED = "&fix group = 'bottom' field = 'u_r' motion = 'acceleration' value = 3 history = 'h' /\n"


def exact(t):
    """3 times the integral of the integral: 10/3 s from 0.1 on, then 1 - 8 (s - 0.3) for 0.1, then 0.2."""
    s = t - 0.1
    if s <= 0:
        return 0.0
    if s <= 0.3:
        return 3 * s**3 / 0.3 / 6
    x, v, r = 0.3**2 / 6, 0.15, min(s - 0.3, 0.1)
    x, v, r = x + r * (v + r / 2 - 8 * r**2 / 6), v + r - 4 * r**2, s - 0.3 - r
    return 3 * (x + r * v + 0.1 * r**2)


# Rayleigh: a column in its first mode, omega = pi c/(2 H), loses alpha/(2 omega) + beta omega/2 of critical.
ALPHA, BETA, SPEED = 3.0, 2.0e-3, 1.0e-3


def test_the_base_moves_by_the_double_integral_rho_inf():
    shaken = column() + TIED + MOVED + "&history name = 'h' times = 0.1, 0.4, 0.5 values = 0, 1, 0.2 /\n"

    for rho_inf in (1.0, 0.5):
        h, _ = run(shaken + stage("a", 0.3, 0.01, rho_inf) + stage("b", 0.4, 0.005, rho_inf), "motion")
        wanted = np.array([exact(t) for t in h["time"]])
        # Second order: corners of the history cost (slope dt**2) of velocity each, and so 2e-3 of the path.
        check(f"the base moves by the double integral, rho_inf {rho_inf}", np.abs(h["base.u_r"] - wanted).max()
              < 2e-3 * wanted.max(), np.abs(h["base.u_r"] - wanted).max() / wanted.max())
        # The scheme's accelerations belong to (gamma - 1/2) dt before the end of a step: (1 - rho)/(1 + rho) dt.
        steps = np.diff(h["time"])
        given = 3 * np.interp(h["time"][1:] - (1 - rho_inf) / (1 + rho_inf) * steps, [0.1, 0.4, 0.5], [0, 1, 0.2])
        check(f"and has the acceleration, rho_inf {rho_inf}", np.abs(h["base.a_r"][1:] - given).max() < ROUNDING * 1e3,
              np.abs(h["base.a_r"][1:] - given).max())
    check("tied sides move as one", (h["top.u_r"] == h["corner.u_r"]).all() and np.ptp(h["top.u_r"]) > 0)

    for name, old, new, words in (
            ("acceleration without a history", " history = 'h' /\n&history", " /\n&history", "needs a displacement"),
            ("acceleration of a pressure", "'bottom' field = 'u_r' motion", "'bottom' field = 'p_w' motion",
             "needs a displacement"),
            ("a tie of unequal sides", "second = 'right'", "second = 'top'", "as many nodes"),
            ("a tie of different heights", "first = 'left' second = 'right'", "first = 'top' second = 'bottom'",
             "no node of 'bottom' lies at the height"),
            ("no edges", "&tie", "&absorbing group = 'all' /\n&tie", "no edges")):
        text = shaken.replace(old, new) + stage("a", 0.3, 0.02)
        check(f"{name}: changed", text != shaken + stage("a", 0.3, 0.02))
        done = start("refused", text)
        check(f"refused: {name}", done.returncode in (2, 11) and words in done.stderr, done.stderr)


def test_of_two_supports_of_a_node_the_later_one_counts_also_after_an_acceleration():
    shaken = column() + TIED + MOVED + "&history name = 'h' times = 0, 0.1 values = 0, 1 /\n"
    held, _ = run(shaken + "&fix group = 'bottom' field = 'u_r' /\n" + stage("a", 0.2, 0.02), "held")
    check("the base stays where the later one holds it", not any(held["base.u_r"]), held["base.u_r"])


def test_what_the_balance_of_a_shaken_column_leaves_open_is_of_second():
    # Works of one step are those of the same moment: what a moving base does against reactions of another one would be
    # of first order in the step, and energy out of nothing or into nothing.
    open_at = {}
    for dt in (0.01, 0.005):
        _, folder = run(column(damping="damping = 2") + TIED + MOVED.replace("value = 3", "value = 1")
                        + "&history name = 'h' times = 0, 0.05, 0.1, 0.15, 0.2, 0.3 values = 0, 1, 0, -1, 0, 0 /\n"
                        + stage("a", 0.3, dt, 0.6), "works")
        ledger = tables.columns(folder / "ledger.csv")
        open_at[dt] = np.abs(ledger["imbalance"]).max() / np.abs(ledger["supports"]).max()
    check("what the balance of a shaken column leaves open is of second order",
          open_at[0.005] < open_at[0.01] / 3, open_at)
    omega = np.pi / 8 * np.sqrt(2.4e4 / 2)
    # A wave of compression under zero lateral strain: modulus 2.4e4 kPa, and 4/3 of the viscosity of shear.
    keys = "damping = {alpha} stiffness_damping = {beta}"
    for name, alpha, beta, given in (
            ("mass", ALPHA, 0, keys), ("stiffness", 0, BETA, keys), ("both", ALPHA, BETA, keys),
            ("viscosity", 0, BETA, f"viscosity = {0.75 * 2.4e4 * BETA}")):
        text = column(cells=8, damping=given.format(alpha=alpha, beta=beta)) + (
            "&fix group = 'all' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /\n"
            f"&initial wave = {SPEED} wave_number = {np.pi / 8} datum = -4 /\n") + stage("swing", 0.6, 1e-3)
        h, folder = run(text, f"rayleigh_{name}")
        xi = alpha / 2 / omega + beta * omega / 2
        free = omega * np.sqrt(1 - xi**2)
        wanted = SPEED / free * np.exp(-xi * omega * h["time"]) * np.sin(free * h["time"])
        # Steps of 1/146 of a period: (omega dt)**2/12 of the phase in four
        # periods, and as much of the first step of beta.
        check(f"Rayleigh damping, {name}", np.abs(h["top.u_z"] - wanted).max() < 5e-3 * wanted.max(),
              np.abs(h["top.u_z"] - wanted).max() / wanted.max())
        ledger = tables.columns(folder / "ledger.csv")
        check(f"its loss is booked, {name}", np.abs(ledger["imbalance"]).max() < 5e-3 * 0.5 * 2 * 4 * SPEED**2 / 2
              and ledger["damping"][-1] > 0, ledger["imbalance"][-1])


def test_ground_behind_an_absorbing_side_stays_at_rest():
    # Ground at rest stays at rest when a side becomes absorbing: saturated, with weight, held by a support before.
    still = column("u-p_w", 9.81, void=0.6, more="{}") + (
        "&initial p_w_slope = -9.81 stress = 'geostatic' k_0 = 0.6 surface = 0 surcharge = 10 /\n"
        "&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-10 /\n"
        "&fix group = 'left' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /\n"
        "&fix group = 'top' field = 'p_w' /\n"
        "&fix group = 'right' field = 'u_r' stages = 'rest' /\n&absorbing group = 'right' /\n"
        "&load group = 'top' kind = 'pressure' value = 10 {} /\n")
    # The base, which lets waves out in the first stage alone, shares a corner with it.
    quiet = still.format("", "") + "&absorbing group = 'bottom' stages = 'go' /\n" + stage("go", 0.1, 2e-3) + stage(
        "on", 0.02, 2e-3)
    h, _ = run(quiet, "still")
    check("ground behind an absorbing side stays at rest",
          max(np.abs(h[f"corner.{u}"]).max() for u in ("u_r", "u_z")) < 1e-9,
          np.abs(h["corner.u_r"]).max())

    # Pushed, it moves, the balance of energy closes, and a run taken up from a checkpoint writes the same bytes.
    pushed = still.format("checkpoint_steps = 20", "history = 'push'") + stage("go", 0.1, 2e-3) + (
        "&history name = 'push' times = 1, 1.02 values = 1, 2 /\n")
    h, whole = run(pushed, "pushed")
    ledger = tables.columns(whole / "ledger.csv")
    check("pushed, it moves", np.abs(h["corner.u_r"]).max() > 1e-6, h["corner.u_r"][-1])
    check("the dashpots' work is booked", np.abs(ledger["imbalance"][1:] - ledger["imbalance"][0]).max()
          < 0.02 * np.abs(ledger["damping"]).max() and ledger["damping"][-1] > 0, ledger["imbalance"][-1])
    names = [p.name for p in whole.iterdir() if p.suffix == ".csv"]
    before = {name: (whole / name).read_bytes() for name in names}
    run(pushed, "pushed", "--restart", whole / "checkpoint.h5")
    check("restart with an absorbing side: same bytes", all(
        (whole / name).read_bytes() == before[name] for name in names))


def test_ground_with_its_weight_stays_at_rest():
    # Its stress grows with depth, so that the mean of an element is not the traction on its edge. Two waves through one
    # boundary, both of nothing, and supports of whole sides that end as the sides begin to absorb, or while they do.
    ground = """&scene name = 'w' geometry = 'plane_strain' fields = 'u' gravity = 9.81 /
&mesh r = 0, 4 r_cells = 2 z = -4, 0 z_cells = 4 /
&elastic name = 'soil' young = 1e5 poisson = 0.3 /
&region material = 'soil' void_ratio = 0.6 rho_s = 2.65 /
&initial stress = 'geostatic' k_0 = 0.5 surface = 0 /
&history name = 'none' times = 0, 9 values = 0, 0 /
&point name = 'top' r = 2 z = 0 /
&point name = 'corner' r = 4 z = -4 /
&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-8 /
""" + stage("quake", 0.2, 0.01)
    sides = "".join(f"&absorbing group = '{side}' stages = 'quake' /\n" for side in ("left", "right"))
    bottom = "&absorbing group = 'bottom' stages = 'quake' {} /\n"
    held = "".join(f"&fix group = '{side}' field = '{field}' {{0}} /\n" for side, field in (
        ("left", "u_r"), ("right", "u_r"), ("bottom", "u_z"), ("bottom", "u_r")))
    waves = bottom.format("v_r = 0.1 history = 'none'") + bottom.format("v_z = 0.1 history = 'none'")
    for case, text in (("two waves", held.format("stages = 'rest'") + sides + waves),
                       ("ends with the stage", held.format("until = 1") + sides + bottom.format("")),
                       ("ends within", held.format("until = 1.1") + sides + bottom.format("")),
                       ("the base alone", held.format("until = 1.1") + bottom.format("") + "".join(
                           f"&fix group = '{side}' field = 'u_r' from = 1.1 /\n" for side in ("left", "right")))):
        h, _ = run(ground + text, "weight_" + case.replace(" ", "_"))
        moved = max(np.abs(h[f"{point}.{u}"]).max() for point in ("top", "corner") for u in ("u_r", "u_z"))
        check(f"{case}: nothing moves", moved < 1e-12, moved)


def test_a_side_that_ends_takes_its_share_of_a_corner_with_it():
    # A uniform stress, sides that begin together or one after the other, and in place of the one that ends the pressure
    # that it held: nothing moves. The support that holds the base beside a side that begins is released as well.
    ground = """&scene name = 'c' geometry = '{}' fields = '{}' checkpoint_steps = 3 /
&mesh r = 0, 2 r_cells = 3 z = 0, 1 z_cells = 2 /
&elastic name = 'soil' young = 1e4 poisson = 0.25 /
&permeability name = 'k' intrinsic = 1e-10 law = 'constant' /
&region material = 'soil' void_ratio = 0.6 rho_s = 2 permeability = 'k' /
&initial stress = 'uniform' sigma = -30, -50, -30 p_w = 20 /
&fix group = 'left' field = 'u_r' /
&load group = 'top' kind = 'pressure' value = {} /
&point name = 'corner' r = 2 z = 0 /
&point name = 'middle' r = 1 z = 0.5 /
""" + stage("one", 0.05, 5e-3) + stage("two", 0.05, 5e-3) + stage("three", 0.05, 5e-3)
    for fields, water in (("u", 0), ("u-p_w", 20)):
        sides = {"right": 30 + water, "bottom": 50 + water}
        for other, ends in (("bottom", "right"), ("right", "bottom")):
            until = f"&load group = '{ends}' kind = 'pressure' value = {sides[ends]} stages = "
            whole, late = f"&absorbing group = '{other}' ", f"&absorbing group = '{ends}' "
            for case, text in (
                    ("together", whole + "/\n" + late + "stages = 'one' /\n" + until + "'two', 'three' /\n"),
                    ("later", whole + "/\n" + late + "stages = 'two' /\n" + until + "'one', 'three' /\n"),
                    ("support", whole + "/\n" + until + "'two', 'three' /\n&fix group = "
                     f"'{ends}' field = 'u_{'r' if ends == 'right' else 'z'}' stages = 'one' /\n")):
                name = f"ends_{fields}_{ends}_{case}"
                geometry = "axisymmetric" if case == "together" else "plane_strain"
                h, folder = run(ground.format(geometry, fields, 50 + water) + text, name)
                moved = max(np.abs(h[f"{point}.{u}"]).max() for point in ("corner", "middle") for u in ("u_r", "u_z"))
                check(f"{name}: nothing moves", moved < 1e-12, moved)
    before = (folder / "histories.csv").read_bytes()
    run(ground.format(geometry, fields, 50 + water) + text, name, "--restart", folder / "checkpoint.h5")
    check("a restart writes the same bytes", (folder / "histories.csv").read_bytes() == before)


def test_two_waves_come_in_through_one_boundary():
    # A bar along r, held sideways: pulses of velocity from the right at c_p, 20 ms apart, leave on the left. Two
    # &absorbing of one group have its dashpots once.
    bar = column(cells=1).replace("r = 0, 1 r_cells = 1 z = -4, 0", "r = 0, 10 r_cells = 40 z = -4, 0") + (
        "&fix group = 'all' field = 'u_z' /\n" + stage("go", 0.3, 5e-4, 0.9) + "&absorbing group = 'left' /\n"
        "&history name = 'early' kind = 'haversine' period = 0.05 /\n"
        "&history name = 'late' kind = 'haversine' period = 0.05 start = 0.02 /\n")
    pair = "".join(f"&absorbing group = 'right' {{}} v_r = {v} history = '{name}' /\n"
                   for v, name in ((-0.01, "early"), (-0.02, "late")))
    h, _ = run(bar + pair.format("", ""), "two_waves")
    c_p = (2e4*0.75/1.25/0.5/2)**0.5

    def pulse(t):
        return np.where((t > 0) & (t < 0.05), 0.5*(1 - np.cos(2*np.pi*t/0.05)), 0)

    t = h["time"] - 10/c_p
    off = np.abs(h["top.v_r"] + 0.01*pulse(t) + 0.02*pulse(t - 0.02)).max()
    check("both waves pass", off < 0.01*0.03, off)
    for what, first, second in (("another density", "rho = 2", "rho = 2.5"), ("another stage", "", "stages = 'on'")):
        refused = start("two_refused", bar + stage("on", 0.1, 1e-3) + pair.format(first, second), "--check")
        check(f"{what}: refused", refused.returncode == 2 and "their dashpots would count twice" in refused.stderr,
              refused.stderr)
    kept = start("two_kept", bar + stage("on", 0.1, 1e-3)
                 + pair.format("stages = 'go'", "rho = 2.5 stages = 'on'"), "--check")
    check("one after the other they differ", kept.returncode == 0, kept.stderr)


def test_a_support_that_keeps_waves_in_draws_a_word():
    ground = column() + stage("go", 0.1, 2e-3) + "&fix group = 'left' field = 'u_r' /\n&absorbing group = '{}' {} /\n"
    shake = "v_r = 0.01 history = 'h'"
    for what, side, keys, held, said in (
            ("rollers beside", "right", "", "group = 'right' field = 'u_r'", "u_r of every node of this &absorbing"),
            ("rollers below", "bottom", "", "group = 'bottom' field = 'u_z'", "along z no wave"),
            ("a wave that cannot come in", "bottom", shake, "group = 'bottom' field = 'u_r'", "along r no wave"),
            ("a base that is shaken sideways", "bottom", shake, "group = 'bottom' field = 'u_z'", ""),
            ("a support of another stage", "right", "", "group = 'right' field = 'u_r' stages = 'rest'", ""),
            ("a bar that is held sideways", "right", "", "group = 'all' field = 'u_r'", "")):
        text = ground.format(side, keys) + f"&fix {held} /\n&history name = 'h' times = 0, 1 values = 0, 1 /\n" + (
            "&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 /\n&fix group = 'bottom' field = 'u_z' "
            "stages = 'rest' /\n")
        told = start("kept_in", text, "--check").stderr
        check(what, ("of every node of this &absorbing is prescribed" in told) == bool(said) and said in told, told)


def test_ground_behind_a_side_given_alike():
    # The ground behind a side is that of the scene, or what rho, c_p and c_s say: given alike they give the same
    # answer, given softer another.
    behind = column() + "&fix group = 'left' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /\n" + (
        "&load group = 'top' kind = 'pressure' value = 10 history = 'h' /\n"
        "&history name = 'h' times = 0, 0.02 values = 0, 1 /\n") + stage("go", 0.1, 2e-3)
    sides = {name: run(behind + f"&absorbing group = 'right' {given} /\n", f"behind_{name}")[0]["corner.u_r"]
             for name, given in (("scene", ""), ("alike", f"rho = 2 c_p = {12000 ** 0.5!r} c_s = {4000 ** 0.5!r}"),
                                 ("softer", f"rho = 2 c_p = {3000 ** 0.5!r} c_s = {4000 ** 0.5!r}"))}
    check("ground behind a side, given alike", np.abs(sides["alike"] - sides["scene"]).max()
          < ROUNDING * np.abs(sides["scene"]).max(), np.abs(sides["alike"] - sides["scene"]).max())
    check("softer ground behind a side gives way more", sides["softer"][-1] > 1.02 * sides["scene"][-1] > 0,
          (sides["softer"][-1], sides["scene"][-1]))


def test_ground_behind_a_side_is_that_where_it_begins_to_act():
    # Sand of 10 kPa that a static stage loads to 100 kPa is 10**(1/4) times as fast: of a wave of unloading, elastic,
    # dashpots of the start would send a quarter back. A restart on the way finds the same dashpots.
    text = """&scene name = 'c' geometry = 'plane_strain' checkpoint_steps = 30 /
&mesh r = 0, 1 r_cells = 1 z = 0, 8 z_cells = 16 /
&mud name = 'sand' /
&region material = 'sand' void_ratio = 0.8 /
&initial stress = 'uniform' sigma = -10, -10, -10 /
&history name = 'up' times = 0, 1 values = 0.1, 1 /
&history name = 'pulse' kind = 'haversine' period = 0.02 stages = 'shake' /
&stage name = 'load' analysis = 'static' duration = 1 dt = 0.1 /
&stage name = 'shake' analysis = 'dynamic' duration = 0.08 dt = 1e-3 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' stages = 'load' /
&fix group = 'bottom' field = 'u_z' motion = 'acceleration' value = -0.1 history = 'pulse' stages = 'shake' /
&load group = 'top' kind = 'pressure' value = 100 history = 'up' /
&absorbing group = 'top' /
&point name = 'top' r = 0 z = 8 /
"""
    h, folder = run(text, "loaded")
    late = h["top.v_z"][-1]
    check("a wave leaves through ground that was loaded before", abs(late / -0.001 - 1) < 0.01, late)
    before = (folder / "histories.csv").read_bytes()
    run(text, "loaded", "--restart", folder / "checkpoint.h5")
    check("restart within the dynamic stage: same bytes", (folder / "histories.csv").read_bytes() == before)
    # So does a law whose PROPS have fallen to a quarter by then, which halves the speed.
    fallen = text.replace("&mud name = 'sand'", f"&umat name = 'sand' library = '{build}/tests/umats/orthotropic.so' "
                          "props = 2e4, 0.25, 8e3, 8e3, 8e3 tangent = 'consistent'")
    fallen = fallen.replace("sigma = -10, -10, -10", "sigma = 0, 0, 0").replace("values = 0.1, 1 ", "values = 1, 0.25 ")
    fallen = fallen.replace("&load group = 'top' kind = 'pressure' value = 100 history = 'up' /\n", "") + "".join(
        f"&strength material = 'sand' parameter = 'props({i})' history = 'up' /\n" for i in (1, 3, 4, 5))
    late = run(fallen.replace("duration = 0.08", "duration = 0.25"), "fallen")[0]["top.v_z"][-1]
    check("a wave leaves through ground whose PROPS have changed before", abs(late / -0.001 - 1) < 0.01, late)


def test_pressures_of_tied_sides():
    # Pressures of tied sides are one where that is asked for, though one side alone has an inflow.
    flow = column("u-p_w", void=0.6) + ("&fix group = 'all' field = 'u_r' /\n&fix group = 'all' field = 'u_z' /\n"
                                        "&fix group = 'bottom' field = 'p_w' /\n&stage name = 'q' "
                                        "analysis = 'quasi_static' duration = 1 dt = 0.1 /\n"
                                        "&load group = 'left' kind = 'water' value = 1e-5 /\n"
                                        "&tie first = 'left' second = 'right' {} /\n")
    for words, same in (("", False), ("pressures = 'yes'", True)):
        h, _ = run(flow.format(words), f"flow_{same}")
        check(f"pressures of tied sides {words}", (h["top.p_w"][-1] == h["corner.p_w"][-1]) is np.bool_(same)
              and h["top.p_w"][-1] > 0, (h["top.p_w"][-1], h["corner.p_w"][-1]))


def test_tied_sides_begin_with_one_velocity():
    # What one side alone is given: without that they would move apart by it for ever.
    h, _ = run(column() + "&initial group = 'left' v_z = 1 /\n&fix group = 'bottom' field = 'u_z' /\n"
               "&fix group = 'all' field = 'u_r' /\n&tie first = 'left' second = 'right' /\n"
               + stage("fly", 1e-3, 1e-4, more="created_energy = 1"), "fly")
    check("they move as one", (h["top.u_z"] == h["corner.u_z"]).all() and h["top.u_z"][-1] > 0, h["top.u_z"][-1])


def test_given_steps_end_at_the_breaks_that_they_would_jump_over():
    # Two pulses of 9 and 5 ms under steps of 20 ms, statically: the peaks press the column of 4 m together by
    # 5 kPa/2.4e4 kPa (M of E = 2e4, nu = 0.25) times 4 m, and what follows goes on in steps as given.
    text = (column() + "&history name = 'h' times = 0, 0.004, 0.009, 0.05, 0.052, 0.055 values = 0, 1, 0, 0, -1, 0 /\n"
            "&stage name = 's' analysis = 'static' duration = 0.1 dt = 0.02 /\n&fix group = 'left' field = 'u_r' /\n"
            "&fix group = 'right' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /\n"
            "&load group = 'top' kind = 'pressure' value = 5 history = 'h' /\n")
    rows, _ = run(text, "pulses")
    times = [0, 0.004, 0.009, 0.029, 0.049, 0.05, 0.052, 0.055, 0.075, 0.095, 0.1]
    check("times of the steps", len(rows["time"]) == len(times) and np.allclose(rows["time"], times, atol=1e-12),
          rows["time"])
    by_time = dict(zip(np.round(rows["time"], 6), rows["top.u_z"]))
    for time, share in ((0.004, -1), (0.009, 0), (0.052, 1), (0.055, 0)):
        check(f"the peak at {time} s", abs(by_time[time] - share*5/2.4e4*4) < 1e-12, by_time)
    # A support that acts within a step alone; a ramp that a step does not pass is no reason for a shorter one.
    kept = text.replace("&load", "&fix group = 'top' field = 'u_z' value = 0.001 from = 0.062 until = 0.07 /\n&load")
    rows, _ = run(kept, "support")
    check("a support of 8 ms is met", np.any(np.abs(rows["top.u_z"] - 0.001) < 1e-12), (rows["time"], rows["top.u_z"]))
    ramp = text.replace("0, 0.004, 0.009, 0.05, 0.052, 0.055 values = 0, 1, 0, 0, -1, 0", "0, 0.05 values = 0, 1")
    rows, _ = run(ramp, "ramp")
    check("steps of a ramp stay", len(rows["time"]) == 6, rows["time"])


CREEP = """&scene name = 'creep' fields = 'u' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'soil' young = 3.0e3 poisson = 0.25 /
&region material = 'soil' void_ratio = 0.5 rho_s = 2 {viscosity} /
&stage name = 'creep' analysis = '{kind}' duration = 1 dt = {dt} tolerance = 1e-9 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 12 /
&point name = 'top' r = 0 z = 1 /
"""


def test_a_viscous_sample_creeps_as_kelvin_and_voigts_element():
    # s_zz = 2 G e + 2 eta de/dt, two thirds of the load from t = 0 on; the volume answers at once. G 1200, K 2000 kPa.
    shear, bulk, eta, load = 1200.0, 2000.0, 240.0, 12.0
    off = {}
    for dt in (0.02, 0.01, 0.005):
        h, folder = run(CREEP.format(viscosity=f"viscosity = {eta}", kind="quasi_static", dt=dt), "creep")
        wanted = -load / 3 / shear * (1 - np.exp(-shear * h["time"] / eta)) - load / 9 / bulk
        off[dt] = np.abs(h["top.u_z"] - wanted)[1:].max() / load * 3 * shear
        ledger = tables.columns(folder / "ledger.csv")
        # In the end the load has given 2/3 of its work on the deviator to the spring, half of it, and half is lost.
        check(f"half of the work on the shape is lost, dt {dt}",
              abs(ledger["damping"][-1] / (np.pi * load**2 / 6 / shear) - 1) < 4 * dt, ledger["damping"][-1])
    # The load acts at once, and the rates of the start do not know it: the first step lacks a third of dt/0.2 s.
    check("creep follows the closed form", all(off[dt] < 0.5 * dt / 0.2 for dt in off), off)
    check("and what is off falls with the step", off[0.005] < 0.6 * off[0.01] < 0.36 * off[0.02], off)

    # A static stage has no time: the same bytes, and a scene without another stage is told so.
    texts = [CREEP.format(viscosity=v, kind="static", dt=1) for v in ("", f"viscosity = {eta}")]
    (plain, _), (viscous, _) = (run(text, "creep_static") for text in texts)
    check("a static stage has no viscous stress", (plain["top.u_z"] == viscous["top.u_z"]).all(), viscous["top.u_z"])
    told = [start("creep_told", text, "--check").stderr for text in texts]
    check("a viscosity that no stage can feel is told", "viscosity" in told[1] and "static" in told[1]
          and "viscosity" not in told[0], told)

    # `without = 'damping'` takes it out where it is the only damping: the bytes of a scene that has none.
    texts = [CREEP.format(viscosity=v, kind="quasi_static", dt=0.1).replace("fields = 'u'", f"fields = 'u' {word}")
             for v, word in (("", ""), (f"viscosity = {eta}", "without = 'damping'"))]
    (plain, _), (viscous, _) = (run(text, "creep_without") for text in texts)
    check("without damping there is no viscous stress", (plain["top.u_z"] == viscous["top.u_z"]).all(),
          viscous["top.u_z"])
    said = start("creep_told", texts[1], "--check").stderr
    check("and the scene is not told that it has none", "no effect" not in said, said)
