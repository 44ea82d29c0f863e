# SPDX-License-Identifier: MIT
"""Kinds of measurements that a calibration takes beside curves: small-strain stiffness, G/G_max and damping, cycles to
liquefaction, loops of retention, isotropic cycles, radial stress on unloading."""

import os
import sys

import numpy as np

from checking import build, check, needs_plain_library, root, work

needs_plain_library()
os.environ["MUD_LIBRARY_DIR"] = str(build)
os.environ["MPLBACKEND"] = "Agg"
sys.path[:0] = [str(root / "python")]
import mud  # noqa: E402
from mud.calibration import (  # noqa: E402
    Effort, answers_of, calibrate, evaluate, make_task, misfits_of, write_material, write_report,
)
from mud.calibration import simulation  # noqa: E402
from mud.calibration.simulation import SETTINGS  # noqa: E402
from mud.calibration.simulation import loops as paths_of_cycles  # noqa: E402

sand = mud.Material("toyoura")


def written(name, text):
    (work / name).write_text(text)
    return {"file": work / name, "kind": name.removesuffix(".csv").split("_")[0]}


def missed(table, material=sand, **settings):
    """The misfit of the one test of a table, and the model's answer."""
    task = make_task("one", [table])
    answers = answers_of(material.changed(**{**SETTINGS, **settings}), task.items)
    return misfits_of(task.items, answers)[0], next(iter(answers.values()))


def test_retention_without_a_void_ratio_tells_at_which_it_is_taken():
    rows = "".join(f"{s},{sand.saturation(s, 0.6)}\n" for s in (1.0, 5.0, 20.0))
    table = written("retention_blind.csv", "suction_kPa,S_w\n" + rows)
    told = " ".join(evaluate(make_task("r", [table]), sand).notes)
    check("the void ratio that is taken is told", "e_0 of the material, 0.8, is taken" in told, told)
    told = " ".join(evaluate(make_task("r", [table]), sand.changed(Omega=0.0)).notes)
    check("where it moves the curve", "is taken" not in told, told)


def test_compression_at_a_suction_is_computed_at_it():
    # Made by the model at a suction of 50 kPa: the misfit of the truth is that of interpolation, not of saturation.
    starts = {"oedometer": {"sigma_a": 50.0, "sigma_r": 25.0}, "isotropic": {"p_eff": 50.0}}
    for kind, name in (("oedometer", "sigma_a"), ("isotropic", "p")):
        stage = mud.Stage(kind, **{f"{name}_end": 1600.0}, stress="effective", increment=10.0, output_interval=100.0)
        made = mud.element_test(sand, stage, void_ratio=0.9, suction=50.0, **starts[kind])
        rows = zip(made["p_eff" if kind == "isotropic" else "sigma_a"], made["e"], made["sigma_r"])
        head = f"{name}_kPa,e,sigma_r_kPa,suction_kPa\n"
        text = "".join(f"{stress},{e},{radial},50\n" for stress, e, radial in rows)
        answer, _ = missed(written(f"{kind}_dry.csv", head + text))
        check(f"{kind} test at a suction", answer.e < 3e-4, answer.e)
        wet, _ = missed(written(f"{kind}_wet.csv", head + text.replace(",50\n", ",0\n")))
        check("which is not that of a saturated sample", wet.e > 5e-4, wet.e)


def test_a_suction_that_a_test_is_not_computed_at_is_refused():
    for name, text, word in (
        ("isotropic_wetted.csv", "p_kPa,e,suction_kPa\n50,0.9,50\n100,0.89,50\n100.1,0.85,0\n", "goes from 0 to 50"),
        ("modulus_dry.csv", "gamma,G_ratio,p_0,e_0,suction\n1e-4,0.8,100,0.8,50\n", "computed saturated"),
    ):
        try:
            told = str(make_task("s", [written(name, text)]))
        except mud.InputError as problem:
            told = str(problem)
        check(f"{name} is refused", word in told, told)


def test_a_suction_scatters_about_its_median():
    rows = "50,0.9,4\n100,0.89,4.4\n200,0.87,3.6\n400,0.85,4\n"
    item = make_task("s", [written("isotropic_tensiometer.csv", "p_kPa,e,suction_kPa\n" + rows)]).items[0]
    check("a measured suction is read", item.test.suction == 4.0, item.test.columns)


def test_a_bound_that_the_tests_do_not_press_on_is_no_warning():
    # The truth has S_min = 0 and S_max = 1, where soil ends: nothing outside fits better.
    rows = "".join(f"{s},{sand.saturation(s, 0.6)},0.6\n" for s in np.geomspace(0.5, 300.0, 12))
    table = written("retention_bound.csv", "suction_kPa,S_w,e\n" + rows)
    result = calibrate(make_task("r", [table], start="toyoura"), Effort(samples=16, starts=1, members=8), 1, None)
    at = {f.variable.name for f in result.diagnosis.findings if f.at_bound}
    told = " ".join(result.diagnosis.warnings)
    check("values at a bound are met", "S_max" in at and result.misfits[0].S_w < 1e-3, (at, result.misfits))
    check("and are no warning", "outside the bounds" not in told, told)


# Loops of retention with hysteresis: 72 points, rms 0.0159 (calibration/hostun_hysteresis).
loops = {"file": root / "calibration/data/hostun_sand_retention_loops.csv", "kind": "retention"}


def test_loops_of_retention_are_fitted_with_hysteresis():
    # The main wetting curve and the scanning slopes come back from a path that the model made.
    truth = mud.Material("hostun_hysteresis")
    branches = ((0.1, 3, 20), (3, 1, 10), (1, 50, 15), (50, 0.1, 25))
    path = np.concatenate([np.geomspace(*branch) for branch in branches])
    table = written("retention_loops.csv", "suction_kPa,S_w\n" + "".join(f"{s:.10f},0.5\n" for s in path))
    _, answer = missed(table, truth)
    lines = "".join(f"{s:.10f},{sw:.10f}\n" for s, sw in zip(path, answer.columns["S_w"]))
    table = written("retention_loops.csv", "suction_kPa,S_w\n" + lines)
    task = make_task("h", [table], known={"Omega": 0.0})
    check("suction that turns is followed with hysteresis", task.base["hysteresis"] == 1, task.origins)
    result = calibrate(task, Effort(samples=16, starts=1, members=4), 1, None)
    check("the path is met", result.misfits[0].S_w < 1e-3, result.misfits)
    for name in ("P_a", "P_aw", "n_w"):
        off = result.material[name] / truth[name] - 1
        check(f"{name} comes back", abs(off) < 0.03, (name, result.material[name], truth[name]))
    page = write_report(result, work / "h")
    file = mud.Material(write_material(result, work / "h"))
    off = abs(file["P_aw"] / result.material["P_aw"] - 1)
    check("the material file has the wetting curve", file["hysteresis"] == 1 and off < 1e-5, (page, dict(file.items())))

    # One curve on request; a known wetting curve needs the drying curve beside which it lies.
    one = make_task("h", [table], known={"Omega": 0.0, "hysteresis": 0.0})
    names = {v.name for v in one.variables()}
    check("one curve on request", one.base["hysteresis"] == 0 and "P_aw_ratio" not in names and "P_a" in names, names)
    try:
        make_task("h", [table], known={"P_aw": 1.0})
    except mud.InputError as problem:
        check("P_aw is known with P_a", "P_aw acts together with P_a" in str(problem), problem)
    else:
        check("P_aw without P_a is refused", False)


def test_small_strain_moduli_are_those_of_eq_3():
    # G_max in closed form, eq. (3): G_0 p_atm (2.97 - e)^2/(1 + e) sqrt(p/p_atm).
    points = [(50.0, 0.7), (100.0, 0.8), (400.0, 0.9)]
    moduli = [125.0 * 101.325 * (2.97 - e) ** 2 / (1 + e) * np.sqrt(p / 101.325) for p, e in points]
    rows = "".join(f"{p / 1000},{e},{g / 1000:.10f}\n" for (p, e), g in zip(points, moduli))
    stiffness = written("stiffness.csv", "p_MPa,e,Gmax [MPa]\n" + rows)
    told, _ = missed(stiffness)
    check("small-strain moduli are those of eq. (3)", told.G < 1e-4, told)
    known = {"K_0": 150.0, "e_l10": 0.8278, "theta": 0.2}
    task = make_task("g", [stiffness], known=known, groups=["elasticity and compression"])
    task.base["G_0"] = 60.0
    result = calibrate(task, Effort(samples=2, starts=1, joint=10, members=4), 1, None)
    check("G_0 comes back from them", abs(result.values["G_0"] / 125.0 - 1) < 2e-3, result.values)

    # G/G_max and damping: an elastic loop at small strain, then softer and wider, never more than a plastic one (2/pi).
    head = "test,gamma,G_ratio,damping_percent,p_0_kPa,e_0\n"
    strains = (1e-6, 1e-4, 1e-3, 5e-3)
    told, answer = missed(written("modulus.csv", head + "".join(f"m,{g},0.5,10,100,0.8\n" for g in strains)))
    ratio, damping = answer.columns["G_ratio"], answer.columns["damping"]
    small = abs(ratio[0] - 1) < 1e-3 and damping[0] < 1e-3
    check("a loop inside the elastic domain has G_max and no damping", small, (ratio, damping))
    check("the modulus falls with strain", np.all(np.diff(ratio) < 0) and ratio[-1] > 0, ratio)
    check("damping rises with strain, below 2/pi", np.all(np.diff(damping) > 0) and damping[-1] < 2 / np.pi, damping)

    # The secant modulus again, from the stresses at the turns of a run of its own.
    run = mud.element_test(
        sand, mud.Stage("simple_shear_drained", cycle_by="gamma", amplitude=1e-3, cycles=2, increment=1e-5),
        p_eff=100.0, void_ratio=0.8,
    )
    ends = [run["sig_13"][np.argmin(np.abs(run["gamma_13"] - end) + (run["cycle"] != 2))] for end in (-1e-3, 1e-3)]
    off = (ends[1] - ends[0]) / 2e-3 / moduli[1] - ratio[2]
    check("the secant modulus is that between the turns of the second cycle", abs(off) < 0.01, (off, ratio))
    check("misfits of both are told", told.G > 1 and told.damping > 1, told)

    # Cycles to liquefaction: those of a test by hand; a sample that stands counts as standing four times as long.
    stage = mud.Stage("undrained", cycle_by="q", amplitude=30.0, cycles=60, stop_r_u=0.95, increment=1e-4)
    run = mud.element_test(sand, stage, p_eff=100.0, void_ratio=0.907)
    count = run["cycle"][-1]
    head = "Test,CSR,N,p_0_kPa,e_0\n"
    told, answer = missed(written("liquefaction.csv", head + f"L,0.15,{count:.0f},100,0.907\n"))
    check("cycles to liquefaction are those of a test by hand", 1 < count < 60 and abs(told.N - 1) < 1e-9,
          (count, told))
    cycles = written("liquefaction.csv", head + f"L,0.15,{count:.0f},100,0.907\n")
    plain = {v.name for v in make_task("l", [cycles]).variables()}
    asked = {v.name for v in make_task("l", [cycles], groups=["hardening", "preloading"]).variables()}
    check("cyclic preloading is fitted where its group is asked for, and there alone",
          {"c_chi", "zeta_chi", "s_chi"} <= asked and not {"c_chi", "zeta_chi", "s_chi"} & plain, (plain, asked))
    _, answer = missed(written("liquefaction_stands.csv", head + "L,0.01,2,100,0.7\n"))
    check("a sample that stands counts as standing so long", abs(10 ** answer.columns["log_N"][0] - 9) < 1e-9, answer)
    # A sample that no longer bears the stress has failed in the cycle in which the driver says that it is not reached.
    before, simulation.LIQUEFIED = simulation.LIQUEFIED, 0.9999
    for csr, number in ((0.1, 5), (0.15, 2), (0.2, 2), (0.25, 1)):
        _, answer = missed(written("liquefaction_fails.csv", head + f"L,{csr},9,100,0.93\n"))
        off = abs(10 ** answer.columns["log_N"][0] - number)
        check(f"a sample that fails under {csr} does so in cycle {number}", off < 1e-9, answer)
    simulation.LIQUEFIED = before
    told, _ = missed(loops, mud.Material("hostun_hysteresis"))
    check("loops of retention are followed with hysteresis", abs(told.S_w - 0.0159) < 3e-4, told)
    told, _ = missed(loops, mud.Material("hostun_hysteresis"), hysteresis=0)
    check("and missed without it", told.S_w > 0.1, told)

    # Isotropic cycles and the radial stress of an oedometer test, made by the model and met by it.
    ends = (400.0, 100.0, 400.0, 50.0, 800.0)
    run = mud.element_test(
        sand, *(mud.Stage("isotropic", p_end=end, increment=5.0, output_interval=25.0) for end in ends),
        p_eff=50.0, void_ratio=0.85,
    )
    lines = "".join(f"{p:.8f},{e:.10f}\n" for p, e in zip(run["p_eff"], run["e"]))
    told, _ = missed(written("isotropic.csv", "p_kPa,e\n" + lines))
    check("isotropic cycles are met", not told.stopped and told.e < 3e-4, told)
    run = mud.element_test(
        sand, *(mud.Stage("oedometer", sigma_a_end=end, increment=5.0, output_interval=25.0) for end in (400.0, 50.0)),
        sigma_a=50.0, sigma_r=25.0, void_ratio=0.85,
    )
    lines = "".join(f"{a:.8f},{r:.8f},{e:.10f}\n" for a, r, e in zip(run["sigma_a"], run["sigma_r"], run["e"]))
    oedometer = written("oedometer.csv", "sigma_1_kPa,sigma_3_kPa,e\n" + lines)
    told, _ = missed(oedometer)
    check("the radial stress is met in loading and unloading", told.sigma_r < 0.5 and told.e < 3e-4, told)
    told, _ = missed(oedometer, M_c=1.0)
    check("and missed by another strength", told.sigma_r > 1.0, told)

    # The loops of a cyclic test pass through the reversals that are compared.
    names = "test,control,cycle_by,amplitude_kPa,cycle,p_0_kPa,e_0,r_u\n"
    cyclic = written("cyclic.csv", names + "".join(f"C,undrained,q,30,{cycle},200,0.85,0.1\n" for cycle in (1, 2, 3)))
    item = make_task("c", [cyclic]).items[0]
    path = paths_of_cycles(sand.changed(**SETTINGS), item.test, item.use)
    ends = path["r_u"][np.isclose(path["q"], -30, atol=0.01)]
    off = np.max(np.abs(missed(cyclic)[1].columns["r_u"] - ends)) if len(ends) == 3 else 1.0
    check("loops reach both amplitudes", abs(max(path["q"]) - 30) < 0.01 and abs(min(path["q"]) + 30) < 0.01, path)
    check("and pass through the reversals that are compared", off < 1e-9 and len(path["q"]) > 40, (off, ends))

    # The page has a picture and a line for each kind.
    tables = [stiffness, oedometer, loops, cyclic, *({"file": work / f"{k}.csv", "kind": k}
                                                     for k in ("modulus", "liquefaction"))]
    page = write_report(evaluate(make_task("kinds", tables), sand), work / "page")
    text = page.read_text()
    check(
        "every kind has its part of the page",
        all((page.parent / f"compared_{name}.png").stat().st_size > 5000
            for name in [*(table["kind"] for table in tables), "loops"])
        and
        all(word in text for word in ("shear modulus", "damping", "cycles to liquefaction", "radial stress", "S_w")),
        text[: 1500],)
    told = ""
    try:
        make_task("bad", [written("liquefaction_bad.csv", head + "L,0.2,0,100,0.8\n")])
    except mud.InputError as problem:
        told = str(problem)
    check("no cycles are refused", "N must be above zero" in told, told)


def test_the_last_row_of_a_measured_test_is_met_whatever_its_strain():
    # The driver adds up increments: at about half of these strains its end and the laboratory's differ by a rounding.
    for kind in ("drained", "undrained"):
        for way in (1, -1):
            names = [f"T{k}" for k in range(12)]
            rows = [
                f"{name},{way * share * (4.0 + 1.37 * k):.4f},{way * 20 * share},{100 + way * 20 * share / 3},0.8\n"
                for k, name in enumerate(names) for share in (0.0, 0.25, 0.5, 0.75, 1.0)
            ]
            table = written(f"{kind}_ends.csv", "test,eps_a_percent,q_kPa,p_kPa,e\n" + "".join(rows))
            answers = answers_of(sand.changed(**SETTINGS), make_task("ends", [table]).items)
            lost = [n for n, a in answers.items() if not a.stopped and not np.isfinite(a.columns["q"]).all()]
            check(f"every row of {kind} tests is met, {'compression' if way > 0 else 'extension'}", not lost, lost)
            check("which came to their ends", not any(a.stopped for a in answers.values()), answers)
