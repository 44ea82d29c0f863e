# SPDX-License-Identifier: MIT
"""Controls of mud_triax: what is held is held, what leads arrives, cycles turn where they should, stops stop."""
import re
import shlex
import subprocess
import sys

import h5py
from checking import build, check, root, work
import tables  # noqa: E402 (checking knows its folder)

triax = build / "drivers/mud_triax"
NORM = 173      # kPa: the stress of 100 kPa as a tensor, which the promise is relative to
HELD = 2e-10    # the driver promises 1e-10 of each increment's stress; compared over a whole stage here
LANDED = 1e-12  # given strains land on their values


def call(*stages, initial="p_eff = 100.0, void_ratio = 0.833", output="case.csv", material="", words=()):
    text = f"&material\n file = '{root}/drivers/materials/toyoura.nml'\n {material}\n/\n&initial\n {initial}\n/\n"
    text += "".join(f"&stage\n {stage}\n/\n" for stage in stages)
    (work / "case.nml").write_text(text)
    (work / output).unlink(missing_ok=True)
    return subprocess.run([triax, work / "case.nml", "--quiet", "--output", work / output, *words],
                          capture_output=True, text=True, cwd=work)


def run(*stages, **options):
    """Rows and comments."""
    done = call(*stages, **options)
    check(f"{stages[-1]} runs", done.returncode == 0, done.stderr)
    if done.returncode:
        sys.exit(1)
    return tables.numbers(work / "case.csv"), tables.comments(work / "case.csv")


def spread(rows, value):
    values = [value(row) for row in rows]
    return max(values) - min(values)


def net(row, name):
    return row[name] - row["s_w"]*row["suction"]


# What is held, what leads, where it should arrive.
CASES = [
    ("drained, q_end = 150.0", lambda r: r["sigma_r"], lambda r: r["q"], 150),
    ("undrained, q_end = 30.0, increment = 0.5", lambda r: 100*r["e"], lambda r: r["q"], 30),
    ("isotropic, p_end = 400.0", lambda r: r["q"] + 100, lambda r: r["p_eff"], 400),
    ("k0, sigma_a_end = 300.0", lambda r: 1 + r["eps_r"], lambda r: r["sigma_a"], 300),
    ("oedometer, p_end = 300.0", lambda r: 1 + r["eps_r"], lambda r: r["p_eff"], 300),
    ("constant_p, eps_a_end = 0.05", lambda r: r["p_eff"], lambda r: r["eps_a"], 0.05),
    ("constant_p, q_end = -60.0", lambda r: r["p_eff"], lambda r: r["q"], -60),
    ("constant_q, p_end = 60.0", lambda r: r["q"] + 100, lambda r: r["p_eff"], 60),
    ("constant_q, eps_v_end = 0.002", lambda r: r["q"] + 100, lambda r: r["eps_v"], 0.002),
    ("simple_shear_drained, gamma_end = 0.05", lambda r: r["sig_33"], lambda r: r["gamma_13"], 0.05),
    ("simple_shear_drained, tau_end = 30.0", lambda r: r["sig_33"], lambda r: r["sig_13"], 30),
    ("simple_shear_constant_volume, gamma_end = 0.05", lambda r: r["e"], lambda r: r["gamma_13"], 0.05),
    ("stress_path, d_sigma = 10, 0, 50, 0, 20, 0", lambda r: r["sig_22"], lambda r: r["sig_13"], 20),
    ("strain_path, d_eps = 0, 0, 0.01, 0, 0.02, 0", lambda r: 1 + r["eps_r"], lambda r: r["gamma_13"], 0.02),
]

# Mistakes: exit code 2, the line, what is meant, nothing written.
MISTAKES = {
    "control = 'undrained', q_endd = 3": ["q_endd", "q_end", ":9:"],
    "control = 'undrained', eps_a_end = 0.1, q_end = 3": ["q_end", "eps_a_end"],
    "control = 'constant_q', eps_a_end = 0.1": ["eps_a_end", "which takes eps_v_end, p_end;"],
    "control = 'undrained', cycle_by = 'p', amplitude = 1, cycles = 2": ["cycle_by", "eps_a, q"],
    "control = 'undrained', cycle_by = 'q', amplitude = 1": ["cycles"],
    "control = 'undrained', cycle_by = 'q', amplitude = 1, cycles = 2.5": ["2.5", "integer"],
    "control = 'undrained', amplitude = 1, eps_a_end = 0.1": ["amplitude", "cycle_by"],
    "control = 'drained', stop_r_u = 0.9, eps_a_end = 0.1": ["stop_r_u", "drained"],
    "control = 'undrained', stop_r_u = 1.9, eps_a_end = 0.1": ["stop_r_u", "0.001", "1"],
    "control = 'drained', stress = 'total', eps_a_end = 0.1": ["total", "effective"],
    "control = 'drained', water = 'constant', suction_end = 5, eps_a_end = 0.1": ["suction_end"],
    "control = 'constant_net_stress'": ["needs suction_end or d_suction:"],
    "control = 'linear', strain_1 = 1,0,0,0,0,0": ["constraint 2"],
    "control = 'drained', air = 'constant', eps_a_end = 0.1": ["air", "water = 'constant'", "dissolved"],
    "control = 'stress_path', d_sigma = 0,0,0,0,0,0": ["d_sigma"],
}


# Keys that are written for something else: the key, and why it has no effect.
UNSATURATED = "p_eff = 90, void_ratio = 0.81, suction = 6"
IDLE = {
    "drained, eps_a_end = 0.01, change_2 = 0.03": "change_2 has no effect with control = 'drained', which takes eps_a",
    "k0, p_end = 120, strain_1 = 1, 0, 0, 0, 0, 0": "strain_1 has no effect with control = 'k0'",
    "strain_path, d_eps = 0, 0, 0.01, 0, 0, 0, stress_6 = 0, 0, 0, 0, 0, 2": "stress_6 has no effect",
    "linear, d_eps = 0, 0, 0.01, 0, 0, 0": "d_eps has no effect with control = 'linear', which takes strain_1,",
    "isotropic, p_end = 120, cycle_by = 'q'": "cycle_by has no effect with control = 'isotropic'",
    "drained, eps_a_end = 0.01, centre = 2": "centre has no effect without cycle_by",
    "undrained, eps_a_end = 0.01, stress = 'effective'": "stress has no effect in a stage that prescribes no mean",
    "k0, eps_v_end = 0, suction_end = 3, increment = 1e-4": "increment has no effect: what eps_v_end prescribes stays",
    "k0, eps_v_end = 0, suction_end = 3, output_interval = 1e-4": "output_interval has no effect: what eps_v_end",
    "constant_net_stress, d_suction = -7": "d_suction = -7 is outside its range (from -6 kPa: the stage begins at a",
    "k0, eps_v_end = 0, d_suction = -7": "d_suction = -7 is outside its range (from -6 kPa: the stage begins at a",
}


def test_a_key_without_effect_is_refused():
    for stage, words in IDLE.items():
        control, _, rest = stage.partition(", ")
        done = call(f"control = '{control}', {rest}", initial=UNSATURATED)
        check(f"refused: {stage}", done.returncode in (2, 3) and words in done.stderr, done.stderr)
    for key in ("air_pressure = 30", "henry = 0.01", "k_w = 2e6"):
        done = call("control = 'drained', water = 'constant', eps_a_end = 1e-3", initial=f"{UNSATURATED}, {key}")
        check(f"refused where the air is free: {key}", done.returncode == 2 and f"{key.split()[0]} has no effect where "
              "no stage has air = 'constant'" in done.stderr, done.stderr)
    case = ("&material law = 'elastic' young = 3e4 poisson = 0.2 /\n&retention law = 'power' a = 0.01 m = 2 /\n"
            "&initial p_eff = 60 void_ratio = 0.7 suction = 2 /\n&stage control = 'drained' eps_a_end = 1e-3 /\n")
    (work / "elastic.nml").write_text(case)
    done = subprocess.run([triax, work / "elastic.nml", "--quiet"], capture_output=True, text=True, cwd=work)
    check("a key of another retention curve is refused", done.returncode == 2
          and "m has no effect with law = 'power', which takes s_min, a, b; remove it." in done.stderr, done.stderr)


def test_what_is_held():
    for stage, held, lead, end in CASES:
        control, _, rest = stage.partition(", ")
        rows, _ = run(f"control = '{control}', {rest}")
        check(f"{stage}: what is held", spread(rows, held) <= HELD*abs(held(rows[0])), spread(rows, held))
        check(f"{stage}: what leads", abs(lead(rows[-1]) - end) <= HELD*(NORM if abs(end) > 1 else 1), lead(rows[-1]))
        check(f"{stage}: something happens", rows[-1]["n_substep"] > 0)


def test_the_least_output_interval_gives_every_increment():
    # As many intervals as no integer of four bytes counts: every increment has its row.
    rows, _ = run("control = 'undrained', eps_a_end = 0.02, increment = 1e-3, output_interval = 1e-12")
    check("the least output_interval gives every increment", len(rows) == 21, len(rows))


def test_net_radial_stress_is_held():
    rows, _ = run("control = 'drained', eps_a_end = 0.02", initial="p_eff = 100.0, void_ratio = 0.833, suction = 50.0")
    check("net radial stress is held", spread(rows, lambda r: net(r, "sigma_r")) <= HELD*100, "")
    check("and the effective one is not", spread(rows, lambda r: r["sigma_r"]) > 1e-3, "")
    rows, _ = run("control = 'drained', stress = 'effective', eps_a_end = 0.02",
                  initial="p_eff = 100.0, void_ratio = 0.833, suction = 50.0")
    check("effective radial stress is held", spread(rows, lambda r: r["sigma_r"]) <= HELD*100, "")
    rows, _ = run("control = 'drained', water = 'constant', eps_a_end = 0.02",
                  initial="p_eff = 100.0, void_ratio = 0.833, suction = 50.0")
    check("water content is held", spread(rows, lambda r: r["s_w"]*r["e"]) <= HELD, "")
    check("suction follows", spread(rows, lambda r: r["suction"]) > 1e-3, "")
    check("net radial stress is held beside it", spread(rows, lambda r: net(r, "sigma_r")) <= HELD*100, "")


def test_a_change_of_suction_leads_as_its_end_does():
    # From 20 kPa by -5 is to 15; the second stage knows where the first has ended.
    ends, changes = (run(*(f"control = 'constant_net_stress', {key}, increment = 0.5" for key in keys),
                         initial="p_eff = 100.0, void_ratio = 0.833, suction = 20.0")[0]
                     for keys in (("suction_end = 15", "suction_end = 32"), ("d_suction = -5", "d_suction = 17")))
    check("the suction is there", changes[-1]["suction"] == 32, changes[-1])
    check("by the same rows", ends == changes, (len(ends), len(changes)))
    # An increment that a host asked for is repeated whatever its end.
    held = ", ".join(f"strain_{i + 1} = {', '.join(str(int(i == j)) for j in range(6))}" for i in range(6))
    rows, _ = run(f"control = 'linear', {held}, d_suction = -7, increment = 0.5", initial=UNSATURATED)
    check("linear leads below a suction of 0", rows[-1]["suction"] == -1, rows[-1])


def test_shut_valves_keep_water_and_air():
    # Boyle's law with what water dissolves (Henry): (p_at + p_a) (e - (1 - h) S_w e) and S_w e stay; the total radial
    # stress, sigma' - S_w p_c + p_a, is held; u is the rise of the water pressure.
    start = "p_eff = 100.0, void_ratio = 0.833, suction = 4.0, air_pressure = 200.0, henry = 0.02"
    rows, _ = run("control = 'drained', water = 'constant', air = 'constant', eps_a_end = 0.02", initial=start)
    mass = [(101.325 + r["p_a"])*r["e"]*(1 - 0.98*r["s_w"]) for r in rows]
    check("mass of air is held", max(mass) - min(mass) <= 1e-9*mass[0], mass)
    check("water content is held", spread(rows, lambda r: r["s_w"]*r["e"]) <= HELD, "")
    check("total radial stress is held", spread(rows, lambda r: net(r, "sigma_r") + r["p_a"]) <= HELD*100, "")
    check("the pressure of the air moves", spread(rows, lambda r: r["p_a"]) > 1, "")
    rise = [r["p_a"] - r["suction"] - 196 for r in rows]
    check("u is the rise of the water pressure", all(abs(r["u"] - x) <= 1e-9 for r, x in zip(rows, rise)), rise)
    other, _ = run("control = 'drained', water = 'constant', air = 'constant', stress = 'effective', eps_a_end = 0.02",
                   initial=start)
    check("effective radial stress where asked for", spread(other, lambda r: r["sigma_r"]) <= HELD*100, "")


def test_air_that_is_dissolved_or_below_vacuum_is_explained():
    # S_w near 1 with much pressure to come: what is left of the bubbles goes into solution, 2 % of the water's volume.
    done = call("control = 'isotropic', water = 'constant', air = 'constant', p_end = 1000.0",
                initial="p_eff = 100.0, void_ratio = 0.833, suction = 0.5, henry = 0.02")
    check("dissolved air is explained", done.returncode == 3 and "no air is left" in done.stderr, done.stderr)
    done = call("control = 'isotropic', water = 'constant', air = 'constant', p_end = 200.0",
                initial="p_eff = 100.0, void_ratio = 0.833, suction = 0.5, air_pressure = -101.4")
    check("below vacuum is refused", done.returncode == 2 and "air_pressure" in done.stderr, done.stderr)
    # The bulk modulus of water, in MPa.
    done = call("control = 'drained', water = 'constant', air = 'constant', eps_a_end = 0.01",
                initial="p_eff = 100.0, void_ratio = 0.833, suction = 0.5, k_w = 2200")
    check("a bulk modulus in MPa is refused", done.returncode == 2 and "k_w = 2200 kPa" in done.stderr
          and "2.2e6 kPa" in done.stderr, done.stderr)


def test_linear_constraints_give_a_named_control():
    # The same path, by name and as linear constraints; a mixed constraint of strain and stress (an elastic membrane).
    named, _ = run("control = 'constant_p', eps_a_end = 0.01")
    free, _ = run("control = 'linear'\n strain_1 = 0,0,1,0,0,0\n change_1 = 0.01\n strain_2 = 1,-1,0,0,0,0\n "
                  "stress_3 = 1,1,1,0,0,0\n strain_4 = 0,0,0,1,0,0\n strain_5 = 0,0,0,0,1,0\n strain_6 = 0,0,0,0,0,1\n "
                  "increment = 0.01")
    check("linear constraints give a named control", abs(named[-1]["q"] - free[-1]["q"]) <= 1e-8*named[-1]["q"],
          f"{named[-1]['q']} {free[-1]['q']}")
    membrane = "control = 'linear'\n strain_1 = 0,0,1,0,0,0\n change_1 = 0.01\n"
    for i, j in ((2, 1), (3, 2)):
        row = ",".join("1" if k == j else "0" for k in range(1, 7))
        stiff = ",".join("5000" if k == j else "0" for k in range(1, 7))
        membrane += f" stress_{i} = {row}\n strain_{i} = {stiff}\n"
    membrane += " strain_4 = 0,0,0,1,0,0\n strain_5 = 0,0,0,0,1,0\n strain_6 = 0,0,0,0,0,1"
    rows, _ = run(membrane)
    check("an elastic membrane: sigma_r + 5000 eps_r is constant",
          spread(rows, lambda r: r["sigma_r"] + 5000*r["eps_r"]) <= 100*HELD, "")
    check("and the radial stress grows", rows[-1]["sigma_r"] > 101, rows[-1]["sigma_r"])


def test_strain_cycles_turn_at_the_amplitude():
    # Cycles.
    rows, notes = run("control = 'undrained', cycle_by = 'eps_a', amplitude = 1e-3, cycles = 3")
    turns = [r["eps_a"] for r in rows]
    turns = [a for b, a, c in zip(turns, turns[1:], turns[2:]) if (a - b)*(c - a) < 0]
    check("strain cycles turn at the amplitude", [round(t, 12) for t in turns] == [1e-3, -1e-3]*3, turns)
    check("and end at the centre", abs(rows[-1]["eps_a"]) < LANDED and rows[-1]["cycle"] == 3, rows[-1]["eps_a"])
    rows, _ = run("control = 'drained', cycle_by = 'q', amplitude = -30.0, centre = 10.0, cycles = 2, increment = 2e-5")
    turns = [r["q"] for r in rows]
    check("stress cycles turn at centre and amplitude, the first way backwards",
          abs(min(turns) + 20) < 30e-7 and abs(max(turns) - 40) < 30e-7
          and [q for q in turns if abs(q - 10) > 29.9][0] < 0, f"{min(turns)} {max(turns)}")
    check("they end at the centre", abs(turns[-1] - 10) < 30e-7, turns[-1])
    rows, notes = run("control = 'undrained', cycle_by = 'q', amplitude = 25, cycles = 50, stop_r_u = 0.6, "
                      "increment = 2e-5")
    check("r_u stops a stage", 0.6 <= rows[-1]["r_u"] < 0.65 and rows[-1]["cycle"] < 50, rows[-1])
    check("and says so", any("pore pressure ratio 0.6 reached in cycle" in note for note in notes), notes)
    check("r_u is u over the confining stress", abs(rows[-1]["u"]/100 - rows[-1]["r_u"]) < 1e-12, rows[-1])
    rows, notes = run("control = 'simple_shear_constant_volume', cycle_by = 'tau', amplitude = 15, cycles = 50, "
                      "stop_double_amplitude = 0.02, increment = 1e-4")
    check("double amplitude stops a stage", any("double amplitude 0.02 reached" in note for note in notes), notes)


def test_a_reversal_belongs_to_the_cycle_that_it_ends():
    # Rows at reversals alone: +A and -A carry the number of their cycle, the return that of the last one.
    far = ", output_interval = 1e6"
    for stage, name, size in (("control = 'drained', cycle_by = 'eps_a', amplitude = 5e-4", "eps_a", 5e-4),
                              ("control = 'undrained', cycle_by = 'q', amplitude = 12, increment = 1e-5", "q", 12)):
        rows, _ = run(f"{stage}, cycles = 3{far}")
        found = [(r["cycle"], round(r[name]/size, 3)) for r in rows]
        check(f"both reversals carry the number of the cycle, led by {name}",
              found == [(0, 0), (1, 1), (1, -1), (2, 1), (2, -1), (3, 1), (3, -1), (3, 0)], found)
    # Stopped just where a cycle ends: begun backwards, loose sand has its largest r_u so far at the second turn.
    stage = "control = 'undrained', cycle_by = 'q', amplitude = -15, cycles = 6, increment = 1e-5" + far
    loose = "p_eff = 100, void_ratio = 0.9"
    rows, _ = run(stage, initial=loose)
    ratio = rows[6]["r_u"]*(1 - 1e-14)   # A row has sixteen digits, which may lie above the number.
    rows, notes = run(f"{stage}, stop_r_u = {ratio!r}", initial=loose)
    told = [note for note in notes if "pore pressure ratio" in note]
    check("a stop at a reversal is told in the cycle that it ends", len(rows) == 7 and rows[-1]["cycle"] == 3
          and told[0].endswith("reached in cycle 3"), (rows[-1], told))


def test_cycles_beyond_the_tenth_are_told_not_to_be_trusted():
    # Eleven cycles turn twenty-two times. At constant volume nothing settles.
    for control, cycles, told in (("drained", 11, 1), ("drained", 10, 0), ("undrained", 11, 0)):
        stage = f"control = '{control}', cycle_by = 'eps_a', amplitude = 1e-5, cycles = {cycles}, increment = 1e-5"
        warned = call(stage, initial="p_eff = 100, void_ratio = 0.8").stderr
        check(f"{cycles} {control} cycles", warned.count("settlement that cycles accumulate") == told, warned)


def test_turns_are_counted_over_stages():
    # Every half cycle is a stage of its own: 22 ways turn 21 times. Ways of 2e-7 move the stress by less than 0.1 kPa.
    def told(size, ways, control="drained"):
        stages = [f"control = '{control}', eps_a_end = {size*(-1)**i:g}, increment = {size/4:g}" for i in range(ways)]
        return call(*stages, initial="p_eff = 140, void_ratio = 0.78").stderr.count("the load has turned 21 times")

    check("22 ways turn 21 times", told(2e-4, 22) == 1)
    check("21 ways turn 20 times", told(2e-4, 21) == 0)
    check("at constant volume nothing settles", told(2e-4, 22, "undrained") == 0)
    check("nor in tiny ways", told(2e-7, 22) == 0)


def test_a_way_of_no_length_is_passed_over():
    # The first turn is where the sample stands: the cycles begin with the way to the other turn.
    rows, _ = run("control = 'drained', cycle_by = 'eps_a', amplitude = 4e-4, centre = -4e-4, cycles = 2, "
                  "output_interval = 1e6")
    check("the other turns are there", [(r["cycle"], round(r["eps_a"]*1e4, 6)) for r in rows]
          == [(0, 0), (1, -8), (2, 0), (2, -8), (2, -4)], rows)


def test_a_stage_of_no_length_has_its_row():
    # Asked for what is there already: every stage ends in a row, and the rows of the others keep their numbers.
    rows, _ = run("control = 'isotropic', p_end = 100.0", "control = 'drained', eps_a_end = 0.004",
                  "control = 'drained', eps_a_end = 0.004", "control = 'undrained', eps_a_end = 0.006")
    ends = [i for i, (a, b) in enumerate(zip(rows, rows[1:])) if a["stage"] != b["stage"]] + [len(rows) - 1]
    check("four stages and the start have their last rows", [rows[i]["stage"] for i in ends] == [0, 1, 2, 3, 4], ends)
    check("where they should be", [round(rows[i]["eps_a"], 12) for i in ends] == [0, 0, 0.004, 0.004, 0.006], ends)
    moved = [name for name in rows[0] if rows[ends[3]][name] != rows[ends[2]][name]]
    check("the row of a stage of no length is that before it", set(moved) == {"stage", "control_error"}, moved)


def test_a_title_in_latin_1_comes_back():
    case = ("&case title = 'Größe ''M'' der Prüfung' /\n&material /\n&initial p_eff = 50 void_ratio = 0.8 /\n"
            "&stage control = 'drained' eps_a_end = 1e-3 /\n")
    (work / "old.nml").write_bytes(case.encode("latin-1"))
    done = subprocess.run([triax, work / "old.nml", "--quiet", "--output", work / "old.csv"], capture_output=True)
    check("it runs", done.returncode == 0, done.stderr)
    told = tables.comments(work / "old.csv")
    check("and scripts read it", "title: Größe 'M' der Prüfung" in told, told)
    done = subprocess.run([sys.executable, root / "drivers/plot_case.py", work / "old.csv"],
                          capture_output=True, text=True)
    check("a picture is drawn of it", done.returncode == 0, done.stderr)


def test_three_stages():
    # Stages follow one another.
    rows, _ = run("control = 'k0', sigma_a_end = 200.0", "control = 'undrained', eps_a_end = 0.02",
                  "control = 'constant_p', q_end = 0.0")
    check("three stages", [r["stage"] for r in rows][-1] == 3 and abs(rows[-1]["q"]) < 1e-7, rows[-1])


def test_a_stress_that_cannot_be_reached_ends_with_code_3():
    # Failures are explained.
    done = call("control = 'drained', q_end = 800.0")
    check("a stress that cannot be reached ends with code 3", done.returncode == 3, done.returncode)
    check("and says where", "halved 20 times" in done.stderr and "eps_a" in done.stderr, done.stderr)
    check("and keeps its rows", (work / "case.csv").read_text().count("\n") > 20)
    done = call("control = 'undrained', cycle_by = 'q', amplitude = 500.0, cycles = 2",
                initial="p_eff = 100.0, void_ratio = 0.95")
    check("a stress cycle beyond the strength is explained", done.returncode ==
          3 and "does not reach 500" in done.stderr, done.stderr)
    done = call("control = 'drained', water = 'constant', eps_a_end = 0.01")
    check("constant water needs suction", done.returncode == 3 and "suction" in done.stderr, done.stderr)
    for stage, words in MISTAKES.items():
        done = call(stage)
        check(f"refused: {stage}", done.returncode == 2 and all(word in done.stderr for word in words)
              and not (work / "case.csv").exists(), f"{done.returncode} {done.stderr}")
    help_text = subprocess.run([triax, "--help"], capture_output=True, text=True).stdout
    check("--help lists keys and controls",
          all(w in help_text for w in ("stop_r_u", "constant_q", "cycle_by", "strain_6", "suction_end or d_suction")))

    try:
        import matplotlib  # noqa: F401
    except ImportError:
        matplotlib = None
    if matplotlib is not None:
        run("control = 'undrained', eps_a_end = 0.01")
        plot = [sys.executable, root / "drivers/plot_case.py"]
        done = subprocess.run([*plot, work / "case.csv"], capture_output=True, text=True)
        check("plot_case draws a page", done.returncode == 0 and (work / "case.png").stat().st_size > 20000,
              done.stderr)
        text = (work / "case.csv").read_text()
        (work / "mpa.csv").write_text(text.replace("effective [kPa]", "effective [MPa]"))
        done = subprocess.run([*plot, work / "case.csv", work / "mpa.csv"], capture_output=True, text=True)
        check("plot_case does not draw two units together", "effective [kPa]" in text and done.returncode == 1
              and "in kPa, " in done.stderr and "in MPa" in done.stderr, done.stderr)
        done = subprocess.run([*plot, work / "case.nml"], capture_output=True, text=True)
        check("plot_case refuses what is no result", done.returncode ==
              1 and "cannot be read" in done.stderr, done.stderr)


def test_hdf5_is_made_of_the_csv_file_by_the_line_of_the_readme():
    stage = "control = 'simple_shear_constant_volume', cycle_by = 'tau', amplitude = 15, cycles = 2"
    done = call(stage, output="case.h5")
    check("the driver writes none and says what helps", done.returncode == 4 and not (work / "case.h5").exists()
          and all(words in done.stderr for words in ("writes CSV", ".csv", "drivers/README.md, Columns")), done.stderr)
    rows, _ = run(stage)
    page = (root / "drivers/README.md").read_text(encoding="utf-8").split("\n## Columns\n")[1]
    line = re.search(r"^PYTHONPATH=.*h5py.*$", page, re.MULTILINE)[0]
    line = line.replace("build/venv/bin/python3", shlex.quote(sys.executable))
    done = subprocess.run(line.replace("=common", f"={shlex.quote(str(root))}/common"), shell=True, cwd=work,
                          capture_output=True, text=True)
    check("the line runs", done.returncode == 0, done.stderr)
    with h5py.File(work / "case.h5") as file:
        check("every column is there to the last digit", set(file) == set(rows[0]) and len(file["q"]) == len(rows)
              and all(value == row[name] for name in file for value, row in zip(file[name], rows)), list(file))
