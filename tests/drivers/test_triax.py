# SPDX-License-Identifier: MIT
"""mud_triax as a user meets it: named cases give published numbers, held stresses are held, mistakes are explained."""
import math
import pathlib
import subprocess

from checking import build, check, root, work
import tables  # noqa: E402 (checking knows its folder)

triax = build / "drivers/mud_triax"
cases = root / "drivers/cases"


def call(*words):
    return subprocess.run([triax, *map(str, words)], capture_output=True, text=True, cwd=work)


def run(case, *words):
    out = work / (case.stem + ".csv")
    done = call(case, "--output", out, "--quiet", *words)
    if done.returncode:
        return done, []
    return done, tables.numbers(out)


def at(rows, column, value):
    return min(rows, key=lambda row: abs(row[column] - value))


# docs/theory/integration.md sections 6.1 and 6.2, to 0.05 %.
EXPECTED = {
    "undrained_e735_p100": [("eps_a", 0.01, 147.354, 219.587), ("eps_a", 0.05, 945.895, 1389.631),
                            ("eps_a", 0.10, 2187.207, 2919.954), ("eps_a", 0.15, 2744.525, 3492.136),
                            ("eps_a", 0.25, 2915.588, 3647.169)],
    "undrained_e833_p2000": [("eps_a", 0.01, 1517.99, 1228.01), ("eps_a", 0.05, 1092.54, 1343.28),
                             ("eps_a", 0.25, 1115.48, 1394.49)],
    "undrained_e907_p100": [("eps_a", 0.01, 68.124, 78.632), ("eps_a", 0.10, 106.355, 134.407),
                            ("eps_a", 0.25, 160.043, 200.922)],
    "extension_e833_p100": [("eps_a", -0.10, 535.656, -505.672)],
    "oedometer_e8_p50": [("eps_v", 0.06, (16088.2 + 2*5401.90)/3, 16088.2 - 5401.90)],
    "isotropic_e8_p50": [("eps_v", 0.06, 10444.51, 0.0)],
    "constant_volume_e8_p20_s100": [("eps_a", 0.10, 5170.21, 7764.07)],
}

# A held stress stays within the stated tolerance at every increment; misfits: docs/theory/integration.md section 6.3.
LAB = {"TMD4": (7.9, .46), "TMD5": (15.0, .83), "TMD6": (32.3, 1.64),
       "TMD1": (7.2, .10), "TMD2": (14.3, .98), "TMD3": (41.1, 1.90)}


def rms(values):
    return 100*math.sqrt(sum(value**2 for value in values)/len(values))

# Newton with the consistent tangent. Without elastic domain an error e becomes at most C e^2 with C the relative
# curvature, here up to 11; a linear contraction, even by a hundred from the first errors of 2e-4, would show 50. With
# the elastic domain substeps follow its turning and the derivative at frozen sizes leaves a contraction of some 1e-3
# at the default tolerance.


def newton_errors(entry):
    text = (cases / "vi_drained_TMD1.nml").read_text()
    text = text.replace("../materials/toyoura.nml'",
                        f"{root}/drivers/materials/toyoura.nml'\n   tangent = 'consistent'\n{entry}")
    newton = work / "newton.nml"
    newton.write_text(text)
    done = call(newton, "--residuals", "--quiet", "--output", work / "newton.csv")
    errors = {}
    for row in tables.parsed(done.stdout):
        errors.setdefault(int(row["increment"]), []).append(float(row["error"]))
    return errors, done.stderr


def test_known_paths_are_met_at_their_strains():
    for case, points in EXPECTED.items():
        done, rows = run(cases / f"{case}.nml")
        for column, strain, p, q in points:
            row = at(rows, column, strain) if rows else {"p_eff": 0, "q": 0, column: 9}
            good = (abs(row[column] - strain) < 1e-9 and abs(row["p_eff"] - p) < 5e-4*p
                    and abs(row["q"] - q) < 5e-4*max(abs(q), 1e-3*p))
            check(f"{case} at {strain}", good, f"p' {row['p_eff']}, q {row['q']}, expected {p}, {q} {done.stderr}")


def test_fig1_threshold_at():
    done, rows = run(cases / "fig1_threshold.nml")
    for strain, q in ((0.105, 2943.1), (0.12, 3178.0), (0.15, 3456.4)):
        row = at(rows[::-1], "eps_a", strain)
        check(f"fig1_threshold at {strain}", abs(row["q"] - q) < 5e-4*q, f"q {row['q']}, expected {q}")


def test_vi_drained_holds_the_radial_stress():
    data = tables.rows(root / "verification/material/verdugo_ishihara/verdugo_ishihara_1996_drained_TC.csv")
    for test, (q_page, v_page) in LAB.items():
        done, rows = run(cases / f"vi_drained_{test}.nml")
        worst = max(row["control_error"] for row in rows)
        check(f"vi_drained_{test} holds the radial stress", worst <= 1e-10, f"{worst}")
        pairs = [(at(rows, "eps_a", float(x["eps_a_pct"])/100), x) for x in data
                 if x["test"] == test and 1 <= float(x["eps_a_pct"]) <= 25]
        q = rms([m["q"]/float(x["q_kPa_derived"]) - 1 for m, x in pairs])
        e_0 = rows[0]["e"]
        v = rms([(e_0 - m["e"])/(1 + e_0) - float(x["eps_v_pct"])/100 for m, x in pairs])
        check(f"vi_drained_{test} misfit", abs(q - q_page) < 1 and abs(v - v_page) < 0.05,
              f"q {q:.2f} %, eps_v {v:.3f} points")


def test_newton_converges_quadratically_with_the_consistent_tangent():
    errors, complaint = newton_errors("   rho_e = 0.0")
    pairs = [(a, b) for e in errors.values() for a, b in zip(e, e[1:]) if b > 1e-12]
    slow = [(a, b) for a, b in pairs if b > 30*a**2]
    # Where p' has its peak the isotropic mechanism ceases, at a place that is as sensitive as a maximum.
    check("Newton converges quadratically with the consistent tangent, but where p' has its peak",
          len(pairs) > 50 and len(slow) <= 2 and all(b < 1e-9 for _, b in slow),
          f"{len(pairs)} pairs {slow} {complaint}")
    check("Newton needs at most 4 iterations", max(map(len, errors.values())) <= 4, f"{max(map(len, errors.values()))}")
    errors, complaint = newton_errors("")
    check("with the elastic domain Newton needs at most 5 iterations", max(map(len, errors.values())) <= 5,
          f"{max(map(len, errors.values()))} {complaint}")


def test_across_resets_of_the_memory_newton_needs_at_most_5_iterations():
    # Held stresses across resets of the memory: events are differentiated, so that an increment with one inside takes
    # what the others take. Increments that do not divide the amplitude put the reversals anywhere; with frozen events
    # 15.
    newton = work / "resets.nml"
    newton.write_text(f"&material\n file = '{root}/drivers/materials/toyoura.nml'\n tangent = 'consistent'\n/\n"
                      "&initial\n p_eff = 100.0\n void_ratio = 0.8\n/\n"
                      "&stage\n control = 'drained'\n cycle_by = 'eps_a'\n amplitude = 1e-3\n cycles = 5\n"
                      " increment = 1.1e-4\n/\n"
                      "&stage\n control = 'simple_shear_drained'\n cycle_by = 'gamma'\n amplitude = 5e-4\n cycles = 5\n"
                      " increment = 0.9e-4\n/\n")
    done = call(newton, "--residuals", "--quiet", "--output", work / "resets.csv")
    most = max((int(row["iteration"]) for row in tables.parsed(done.stdout)), default=99)
    resets = tables.numbers(work / "resets.csv")[-1]["n_reset"]
    check("across resets of the memory Newton needs at most 5 iterations",
          most <= 5 and resets >= 20, f"{most}, {resets}")


def test_a_missing_file_is_named():
    # Mistakes: what, where, value, range, remedy; exit code 2; nothing written.
    good = (cases / "undrained_e735_p100.nml").read_text().replace("../materials", f"{root}/drivers/materials")
    MISTAKES = {
        "an unknown key is named": (good.replace("&material", "&material\n   h_O = 12.0"), ["h_O", "h_0", ":6"]),
        "a value out of range is named": (good.replace("&material", "&material\n   M_c = -1.0"), ["M_c", "0.1", "2.5"]),
        "an unknown control names the known ones": (good.replace("'undrained'", "'undraind'"), ["undraind", "drained"]),
        "a void ratio that is no number is refused": (good.replace("= 0.735", "= nan"), ["void_ratio"]),
    }
    for name, (text, words) in MISTAKES.items():
        case = work / "mistake.nml"
        case.write_text(text)
        out = work / "mistake.csv"
        done = call(case, "--output", out)
        told = all(word in done.stderr for word in words)
        check(name, done.returncode == 2 and told and not out.exists(), f"{done.returncode} {done.stderr}")
    done = call(work / "absent.nml")
    check("a missing file is named", done.returncode == 2 and "absent.nml" in done.stderr, done.stderr)
    if pathlib.Path("/dev/full").exists():
        done = call(cases / "undrained_e735_p100.nml", "--quiet", "--output", "/dev/full")
        check("a full disk is an error, not a short file", done.returncode ==
              4 and "disk full" in done.stderr, done.stderr)
        with open("/dev/full", "w") as full:
            done = subprocess.run([triax, cases / "undrained_e735_p100.nml", "--quiet", "--output", "-"], stdout=full,
                                  stderr=subprocess.PIPE, text=True)
        check("also on the standard output", done.returncode == 4 and "disk full" in done.stderr, done.stderr)
    done = call("--help")
    check("--help explains", done.returncode == 0 and "CASE.nml" in done.stdout, done.stdout[:80])
    template = work / "template.nml"
    template.write_text(call("--template").stdout)
    done = call(template, "--output", work / "template.csv", "--quiet")
    check("the template runs unchanged", done.returncode == 0, done.stderr)


def test_p_below_zero_is_told_times():
    # Expanded without a tension cut-off, p' falls below zero, where the model
    # has no meaning: one warning, also when quiet.
    for what, keys, said in (("with the cut-off", "", 0), ("without it", "cutoff = 0", 1)):
        case = work / "expanded.nml"
        case.write_text(f"&material {keys} /\n&initial p_eff = 20 void_ratio = 0.7 /\n"
                        "&stage control = 'isotropic' eps_v_end = -0.02 increment = 1e-4 /\n")
        done = call(case, "--output", work / "expanded.csv", "--quiet")
        check(f"{what}, p' below zero is told {said} times", done.returncode == 0 and
              done.stderr.count("the mean effective stress p' fell to -") == said == done.stderr.count("warning"),
              done.stderr)


def test_a_case_outside_the_tests_of_its_material_is_told():
    # The ranges of a fitted material are data of its file: e 0.693 to 1.007, p' 12 to 859 kPa.
    for name, p, e, words in (("inside", 100, 0.8, ()),
                              ("dense", 100, 0.65, ("void ratio is 0.65, in its tests 0.693",)),
                              ("deep", 900, 0.8, ("mean effective stress is 900 kPa, in its tests 12 to 859",)),
                              ("both", 5, 1.02, ("void ratio is 1.02", "stress is 5 kPa"))):
        (work / f"{name}.nml").write_text(
            f"&material file = '{root}/drivers/materials/karlsruhe.nml' /\n&initial p_eff = {p} void_ratio = {e} /\n"
            "&stage control = 'drained' eps_a_end = 0.002 increment = 1e-3 output_interval = 1e-3 /\n")
        done = call(work / f"{name}.nml", "--output", work / f"{name}.csv", "--quiet")
        told = [line for line in done.stderr.splitlines() if "fitted to" in line]
        check(f"{name}", done.returncode == 0 and len(told) == bool(words) and all(w in told[0] for w in words),
              done.stderr)
    (work / "none.nml").write_text("&material tested_e_min = 'loose' /\n&initial p_eff = 100 void_ratio = 0.8 /\n"
                                   "&stage control = 'drained' eps_a_end = 0.01 increment = 1e-3 /\n")
    done = call(work / "none.nml")
    check("a range that is no number is refused",
          done.returncode != 0 and "tested_e_min = loose is not a number" in done.stderr, done.stderr)
