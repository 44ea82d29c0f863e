# SPDX-License-Identifier: MIT
"""What a fit says of itself: tests that fail, several minima, priors, bands, tests that disagree, unloading; a fit that
is interrupted and goes on; a material that is compared and not fitted."""

import os
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import numpy as np
from scipy import stats

from checking import build, check, light, needs_plain_library, root, work

needs_plain_library()
os.environ["MUD_LIBRARY_DIR"] = str(build)
os.environ["MPLBACKEND"] = "Agg"
sys.path[:0] = [str(root / "python")]
import mud  # noqa: E402
from mud.calibration import Effort, answers_of, calibrate, evaluate, make_task, read_table, use_of  # noqa: E402
from mud.calibration.command import UNFINISHED, main  # noqa: E402
from mud.calibration.ensemble import Ensemble, _weights, quantile  # noqa: E402
from mud.calibration.fit import NOISE, PRIOR, Fit, Minimum, observations, posterior, spread_of, trial_sets  # noqa: E402
from mud.calibration.screen import screen  # noqa: E402
from mud.calibration.simulation import SETTINGS  # noqa: E402
from mud.calibration.soundness import disagreeing, unloading  # noqa: E402

DATA = root / "calibration/data"
truth = mud.Material("toyoura", h_0=5.0, n_d=3.0)
HEAD = "test,eps_a_percent,eps_v_percent,q_kPa,p_kPa,e\n"
STATES = (("A", 0.75, 100.0), ("B", 0.85, 100.0), ("C", 0.8, 200.0), ("D", 0.9, 100.0), ("E", 0.78, 300.0))


def refusal(action):
    """The sentence of a refusal, or nothing."""
    try:
        action()
    except mud.InputError as problem:
        return str(problem)
    return ""


runs = {
    name: mud.element_test(
        truth, mud.Stage("drained", eps_a_end=0.2, increment=2e-3, output_interval=2e-2), p_eff=p, void_ratio=e
    )
    for name, e, p in STATES
}


def table(name, factors=None):
    """Drained tests of the model as a table; q of some times a factor."""
    lines = [HEAD]
    for test, e, p in STATES:
        run, factor = runs[test], (factors or {}).get(test, 1.0)
        lines += [
            f"{test},{100*a:.8f},{100*v:.8f},{factor*q:.6f},{p + factor*q/3:.6f},{e_:.8f}\n"
            for a, v, q, e_ in zip(run.axial_strain, run.volumetric_strain, run["q"], run["e"])
        ]
    (work / name).write_text("".join(lines))
    return [{"file": work / name, "kind": "drained"}]


from mud.calibration.ensemble import _band  # noqa: E402


def test_nine_tests_that_cannot_run_are_no_fit():
    known = {n: truth[n] for n in ("M_c", "N_c", "lambda", "alpha_csl", "A_0", "G_0", "K_0", "N_l", "n_b", "theta")}
    effort = Effort(samples=4, starts=2, trial=4, joint=8, members=24)

    # Tests that no set of parameters brings to their end: from a stress of
    # nothing, and beyond what the model can reach.
    bad = make_task("bad", [{"file": DATA / "karlsruhe_fine_sand_oedometer.csv", "kind": "oedometer", "first": 1e-9}])
    told = refusal(lambda: calibrate(bad, effort, 1, None))
    words = ("no test can be fitted", "OE12", "first")
    check("nine tests that cannot run are no fit", all(word in told for word in words), told)
    (work / "cut.csv").write_text(
        "test,eps_a_percent,q_kPa,p_kPa,e_0\n"
        + "".join(f"U,{a},{50 + a},{p},0.7\n" for a, p in zip(range(8), range(100, 108)))
    )
    task = make_task("cut", [*table("good.csv"), {"file": work / "cut.csv", "kind": "undrained"}], known=known)
    item = task.items[-1]
    item.test.columns["eps_a"][-3:] = [0.9, 0.95, 0.9999]  # a natural strain of 9: no set of parameters comes there
    screened = screen(task, trial_sets(task, task.variables(), 4))
    kept = [i for i in screened.task.items if i.test.name == "U"]
    check(
        "a test that stops under every set is cut there or left out, with the reason",
        len(screened.notes) == 1
        and screened.notes[0].startswith("U is ")
        and (not kept or len(kept[0].use.rows) < len(item.use.rows))
        and [i.test.name for i in screened.task.items[:5]] == list("ABCDE"),
        screened.notes,
    )

    # What the tests say nothing about keeps its prior; what they tell comes back, from several starts, with bands.
    # Drained compression that is never reversed tells nothing of extension (c) and of fabric (c_z, z_max).
    freed = {k: v for k, v in known.items() if k != "theta"}
    task = make_task("again", table("good.csv"), held_out=["E"], start="toyoura", known=freed)
    result = calibrate(task, effort, 1, None)
    told = " ".join(result.diagnosis.sentences)
    check(
        "what drained tests do not tell keeps its prior, and the page says so",
        all(
            result.material[name] == mud.Material("toyoura")[name] and f"do not determine {name}: " in told
            for name in ("c", "c_z", "z_max")
        ),
        told,
    )
    check(
        "what they tell is found",
        abs(result.values["h_0"] / 5.0 - 1) < 0.05 and abs(result.values["n_d"] / 3.0 - 1) < 0.05,
        result.values,
    )
    findings = {f.variable.name: f for f in result.diagnosis.findings}
    check(
        "intervals hold the truth",
        all(findings[name].low <= truth[name] <= findings[name].high for name in ("h_0", "n_d")),
        [(findings[name].low, findings[name].high) for name in ("h_0", "n_d")],
    )
    # The tests are the model's own: what is left over is the error of its simulations.
    check("and are narrow where the tests are without error",
          all(findings[name].high / findings[name].low < 1.1 for name in ("h_0", "n_d")),
          [(findings[name].low, findings[name].high) for name in ("h_0", "n_d")])
    check("every variable of the ensemble is within its bounds", all(
        f.variable.lower <= m[f.variable.name] <= f.variable.upper
        for m in result.ensemble.members for f in result.diagnosis.findings if f.fitted))
    shares = result.ensemble.coverage(result.task.items, True)
    check("the bands hold what the model itself made", shares[""][0] > 0.97 and shares[""][1] == 20, shares)

    # Without an error of the parameters a band is 1.645 times the scatter to
    # both sides: hypotenuse of 3 kPa and 5 % of q.
    alone = Ensemble([result.values], np.ones(1), 1.0, 1.0, {}, {})

    item, answer = result.item("E"), result.answers["E"]
    band = _band(item, "q", [answer], alone.weights, 1.0)
    q = answer.columns["q"]

    # Nine nodes stand for the normal distribution: the outermost are the 5 and 95 % points within 10 %.
    off = np.abs((band.high - q) / (1.645 * np.hypot(3.0, 0.05 * q)) - 1)
    check("a band of one member is that of the measurement", off.max() < 0.15 and np.all(band.low < q), off)
    check("weighted quantiles", quantile(np.array([3.0, 1.0, 2.0]), np.array([0.2, 0.5, 0.3]), 0.6) == 2.0)
    weights, exponent = _weights(-50.0 * np.arange(16.0))
    effective = 1 / np.sum(weights**2)
    check("weights that leave one member are evened out, and tell it", exponent < 1 and effective >= 4, effective)

    # Retention and mechanics do not interact: together they are fitted as well as alone.
    (work / "r.csv").write_text(
        "suction_kPa,S_w,e\n"
        + "".join(f"{s},{truth.saturation(s, 0.8):.12f},0.8\n" for s in (1.0, 3.0, 8.0, 20.0, 100.0))
    )
    fixed = {"Omega": truth["Omega"], "S_max": 1.0}
    curve = {"file": work / "r.csv", "kind": "retention"}
    both = make_task("both", [*table("good.csv"), curve], start="karlsruhe", known={**known, **fixed})
    fit = Fit(both, effort, 1, None)
    check(
        "retention is a part of its own",
        [sorted({both.items[i].test.kind for i in p.numbers}) for p in fit.parts] == [["retention"], ["drained"]]
        and {v.group for v in fit.parts[0].variables} == {"retention"},
    )
    if not light:  # the checking builds have seen a fit
        joint = calibrate(both, Effort(samples=4, starts=1, trial=4, joint=12, members=0), 1, None)
        missed = {m.name: m for m in joint.misfits}
        check("a joint fit meets the retention curve", missed["r"].S_w < 0.01, missed["r"])

    # A test whose q is 1.3 times too large is named, and no other; without it nothing is said.
    for factors, names in (({}, []), ({"C": 1.3}, ["C"]))[light:]:
        one = Effort(samples=1, starts=1, joint=6)
        fit = Fit(make_task("odd", table("odd.csv", factors), start="toyoura", known=known), one, 1, None)
        values = fit.run()
        answers = answers_of(fit.evaluator.material(values, **SETTINGS), fit.task.items)
        told = disagreeing(fit, fit.jacobian(fit.variables, values), answers)
        named = [sentence.split()[0] for sentence in told if "its q is" in sentence]
        check(f"q of {names or 'no test'} times 1.3: it alone is named", named == names, told)

    # Unloading: what a set with K/G of 2.4 does wrongly.
    stiff = mud.Material("karlsruhe", K_0=327.0, G_0=136.0, **SETTINGS)
    told = unloading(stiff, task.items[:1], {task.items[0].test.name: answer})
    check("K0 that does not rise on unloading is told", any("K0 does not rise" in t for t in told), told)
    only = {"file": DATA / "karlsruhe_fine_sand_oedometer.csv", "kind": "oedometer", "only": ["OE4"]}
    item = make_task("o", [only]).items[0]
    wrong = answers_of(mud.Material("karlsruhe", **SETTINGS), [item])
    top = int(np.argmax(np.diff(item.test["sigma_a"][item.use.rows]) < 0))  # where unloading begins
    wrong["OE4"].columns["e"][top + 1 :] += 0.05
    told = unloading(mud.Material("karlsruhe", **SETTINGS), [item], wrong)
    wrongly = any(t.startswith("OE4: on unloading") for t in told)
    check("a void ratio that rises wrongly on unloading is told", wrongly, told)

    # The command: a folder that cannot be written, a material that is compared, a fit that is interrupted.
    (work / "file").write_text("in the way")
    words = ["--name", "again", "--drained", str(work / "good.csv"), "--start", "toyoura", "--workers", "1"]
    for name in known:
        words += ["--known", f"{name}={truth[name]!r}"]
    check("a place that cannot be written is refused before the fit",
          main([*words, "--output", str(work / "file")]) == 2)
    code = main([*words[:4], "--evaluate", "toyoura", "--held-out", "A", "--output", str(work / "seen"), "--quiet"])
    page = (work / "seen/again/README.md").read_text()
    check(
        "a material is compared and nothing fitted, with every test held out too",
        code == 0
        and "comparison" in page
        and "| A | **held out**" in page
        and "| B | compared |" in page
        and "| fitted" not in page
        and not (work / "seen/materials").exists()
        and evaluate(make_task("x", table("good.csv"), held_out=list("ABCDE")), "toyoura").diagnosis is None,
        page[:300],
    )
    if not light:
        words += ["--samples", "2", "--starts", "1", "--evaluations", "4", "--members", "4"]
        words += ["--output", str(work / "going")]
        environment = {**os.environ, "PYTHONPATH": str(root / "python")}
        command = [sys.executable, "-m", "mud.calibration.command", *words]
        place = work / "going/again" / UNFINISHED
        # What a shell starts in the background ignores the interrupt, and hands that on.
        begun = subprocess.Popen(
            command,
            env=environment,
            stderr=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )
        while begun.poll() is None and not (place.exists() and place.stat().st_size > 30000):
            time.sleep(0.01)
        begun.send_signal(signal.SIGINT)
        _, told = begun.communicate()
        saved = begun.returncode == 130 and place.exists()
        check("an interrupted fit saves what it has", saved and "same command" in told, told)
        done = subprocess.run(command, env=environment, capture_output=True, text=True)
        check(
            "the same command goes on from there",
            done.returncode == 0 and "goes on from" in done.stderr and not place.exists(),
            done.stderr,
        )
        whole = main([*words[:-1], str(work / "whole"), "--quiet"])
        first, second = ((work / f"{name}/materials/again.nml").read_text() for name in ("going", "whole"))
        check("and ends where a fit without interruption ends", whole == 0 and first == second)


def test_compression_that_begins_at_zero_stress_counts_from_10_kpa_on():
    # Compression that begins near zero counts from 10 kPa on, and says so.
    tests = read_table(DATA / "karlsruhe_fine_sand_oedometer.csv", "oedometer")
    use = use_of(tests[0])
    check(
        "compression that begins at zero stress counts from 10 kPa on, and says so",
        tests[0]["sigma_a"][0] == 0.0 and tests[0]["sigma_a"][use.start] >= 10.0 and "10 kPa" in use.note,
        (tests[0]["sigma_a"][use.start], use.note),
    )
    check("a first that is given is taken without a word", not use_of(tests[0], first=5.0).note)
    task = make_task("oed", [{"file": DATA / "karlsruhe_fine_sand_oedometer.csv", "kind": "oedometer"}])
    answers = answers_of(mud.Material("karlsruhe", **SETTINGS), task.items)
    check("so the oedometer tests of the library run", not any(a.stopped for a in answers.values()))


def test_the_posterior_is_that_of_prior_and_data():
    # One parameter and one residual r = a s: the posterior deviation is that
    # of the product of two normal distributions.
    spread = posterior(np.array([[3.0]]), 2.0)
    check("the posterior is that of prior and data", abs(1 / spread[0, 0] - (9.0 / 2.0 + 1 / PRIOR**2)) < 1e-12, spread)
    ends = [Minimum({"h_0": value}, 1.0, np.eye(1), 1) for value in (1.0, 9.0)]
    told = Ensemble([{"h_0": 5.0}, {"h_0": 5.1}], np.full(2, 0.5), 2.0, 1.0, {}, {}).interval("h_0", ends)
    check("an interval holds every minimum that is told", told == (1.0, 9.0), told)


def linear(random, errors, fitted=6, rows=40):
    """A linear problem of as many curves as errors has: matrix, measurement and the true shares.

    errors : (curves, rows) in standard deviations."""
    along = np.linspace(0, 1, rows)[:, None] ** np.arange(fitted)
    matrix = np.concatenate([8 * along * random.standard_normal(fitted) / np.sqrt(rows) for _ in errors])
    shares = random.uniform(0.2, 0.8, fitted)
    return matrix, matrix @ shares + errors.ravel() / np.sqrt(rows), shares


def solved(matrix, measured, curves):
    """Least squares: shares, their deviations as a fit tells them, and its residuals by curve."""
    shares = np.linalg.lstsq(matrix, measured, rcond=None)[0]
    left = np.split(matrix @ shares - measured, curves)
    return shares, np.sqrt(np.diag(posterior(matrix, spread_of(left, len(shares))))), left


def test_deviations_of_a_linear_fit_are_those_of_the_closed_form():
    # White noise of deviation s in every row of n: a residual is row/sqrt(n), so the covariance is s^2/n (A^T A)^-1.
    # The mean of 100 estimates of s^2 with 314 degrees of freedom is right to 1 %; counting the rows loses 3 % at most.
    random = np.random.default_rng(5)
    for s in (0.2, 1.0, 4.0):
        ratios = []
        for _ in range(100):
            problem = linear(random, s * random.standard_normal((8, 40)))
            _, deviations, _ = solved(*problem[:2], 8)
            exact = np.linalg.inv(40 / s**2 * problem[0].T @ problem[0] + np.eye(6) / PRIOR**2)
            ratios.append(deviations / np.sqrt(np.diag(exact)))
        check(f"deviations of a linear fit to noise of {s:g} scatters are those of the closed form",
              abs(np.mean(ratios) - 1) < 0.04, np.mean(ratios))


def test_intervals_hold_the_truth_as_often_as_they_say():
    # 1800 intervals of 95 %, six of a fit together: the share that holds the truth scatters by less than 1.3 %.
    for word, make, least, most in (
        ("noise", lambda random: 0.3 * random.standard_normal((8, 40)), 0.93, 0.97),
        ("a misfit of whole curves", lambda random: 3 * np.repeat(random.standard_normal((8, 1)), 40, 1), 0.93, 1.0),
    ):
        random, held = np.random.default_rng(3), []
        for _ in range(300):
            matrix, measured, shares = linear(random, make(random), 4 if word != "noise" else 6)
            found, deviations, _ = solved(matrix, measured, 8)
            held += list(np.abs(found - shares) < 1.96 * deviations)
        check(f"intervals of 95 % hold the truth as often under {word}", least < np.mean(held) < most, np.mean(held))


def test_rows_whose_errors_follow_each_other_count_once():
    random = np.random.default_rng(2)
    whole, noise = [np.full(40, z) for z in (1.0, -2.0, 0.5)], list(random.standard_normal((3, 40)))
    # The autocorrelation of a constant falls linearly with the lag; its sum is the number of rows.
    check("a curve that is missed by the same everywhere is one observation", abs(observations(whole) - 3) < 1e-9)
    check("noise has as many observations as rows", observations(noise) > 0.8 * 120, observations(noise))
    check("without an observation left over the told scatter counts", spread_of([np.full(2, 1e-6)], 5) >= 1.0 / 2)
    check("a perfect fit keeps the error of the simulations", spread_of([np.zeros(40)] * 2, 3) == NOISE**2)


def test_the_cap_of_the_told_scatter_holds_where_the_fit_agrees_with_it():
    # Six rows for five variables: one degree of freedom is left over.
    rows = np.array([1.0, -1.0, 0.2, -0.3, 1.2, -1.1]) / np.sqrt(6)
    quiet, loud = rows / np.linalg.norm(rows) * 0.5, rows / np.linalg.norm(rows) * 3
    student = (stats.t.ppf(0.975, 1) / stats.norm.ppf(0.975)) ** 2
    told = [spread_of([curve], 5) for curve in (quiet, loud)]
    check("within the told scatter it is the most", abs(told[0] - 2 / 6) < 1e-12, told)
    check("beyond it Student's t is", abs(told[1] / (9 * student) - 1) < 1e-12, told)


def test_weights_of_tests_make_no_interval_narrower():
    # 8 tests of 20 rows with noise, of which six have another weight, by the variance that a fit takes of them; weights
    # of all tests together change nothing.
    use = SimpleNamespace(rows=range(20), scatter={"q": 1.0})
    part = SimpleNamespace(numbers=range(8), variables=range(4))
    for weights in ([1.0] * 2 + [0.1] * 6, [1.0] * 2 + [3.5] * 6, [3.5] * 8):
        random, held = np.random.default_rng(4), []
        fit = SimpleNamespace(evaluator=SimpleNamespace(items=[SimpleNamespace(weight=w, use=use) for w in weights]))
        weight = np.repeat(weights, 20)
        for _ in range(150):
            matrix, measured, shares = linear(random, 0.3 * random.standard_normal((8, 20)), 4, 20)
            matrix, measured = weight[:, None] * matrix, weight * measured
            found = np.linalg.lstsq(matrix, measured, rcond=None)[0]
            variance = Fit.variance(fit, matrix @ found - measured, part)
            held += list(np.abs(found - shares) < 1.96 * np.sqrt(np.diag(posterior(matrix, variance))))
        check(f"intervals of 95 % hold the truth with weights from {weights[0]:g} to {weights[-1]:g}",
              np.mean(held) > 0.93, np.mean(held))


def test_intervals_of_a_retention_curve_hold_the_truth():
    # A whole fit, forty times: S_w with noise of half of the scatter. Of 120 intervals of 95 % at least 104 hold the
    # truth (binomial: fewer once in a thousand).
    suctions, widths, held = np.geomspace(0.5, 200.0, 40), [], []
    fixed = {"Omega": truth["Omega"], "S_max": truth["S_max"], "S_min": truth["S_min"]}
    for seed in range(40 if not light else 4):
        random = np.random.default_rng(seed)
        noisy = truth.saturation(suctions, 0.8) + 0.01 * random.standard_normal(40)
        (work / "noisy.csv").write_text(
            "suction_kPa,S_w,e\n"
            + "".join(f"{s},{S!r},0.8\n" for s, S in zip(suctions, np.clip(noisy, 0, 1).tolist()))
        )
        task = make_task("noisy", [{"file": work / "noisy.csv", "kind": "retention"}], start="karlsruhe", known=fixed)
        told = calibrate(task, Effort(samples=4, starts=1, joint=20, members=0), 1, None).diagnosis
        for f in told.findings:
            if f.fitted:
                held.append(f.low <= truth[f.variable.name] <= f.high)
                widths.append(np.log(f.high / f.low))
    check("intervals of a retention curve hold the truth", np.mean(held) > 0.86, np.mean(held))
    check("and are not wider than the noise makes them", len(held) >= 12 and np.median(widths) < 0.5, np.median(widths))


def test_a_quiet_fit_says_nothing_of_the_sets_that_it_tries():
    # A void ratio of 1.9 lies far above every compression line: the library remarks on such a start.
    (work / "loose.csv").write_text("p_kPa,e,G_max_kPa\n100,1.9,60000\n200,1.9,90000\n300,1.9,100000\n")
    words = ["--name", "loose", "--stiffness", "loose.csv", "--samples", "4", "--starts", "1", "--evaluations", "2"]
    words += ["--members", "0", "--workers", "1", "--output", "l"]
    command = [sys.executable, "-m", "mud.calibration.command", *words]
    environment = {**os.environ, "PYTHONPATH": str(root / "python")}
    told = [subprocess.run([*command, *more], cwd=work, env=environment, capture_output=True, text=True).stderr
            for more in ([], ["--quiet"])]
    check("a fit lets the library remark on a start", "remark of mud_init" in told[0], told[0])
    check("a quiet fit says nothing of the sets that it tries", told[1] == "", told[1])
