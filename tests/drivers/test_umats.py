# SPDX-License-Identifier: MIT
"""mud_triax with laws of others: UMATs from shared libraries against closed forms, MUD through its own UMAT."""
import math
import re
import subprocess

from checking import build, check, light, root, work
import tables  # noqa: E402 (checking knows its folder)

triax, describe = build / "drivers/mud_triax", build / "drivers/mud_describe"
umats = build / "tests/umats"
START = "&initial\n   p_eff = 100\n   void_ratio = 0.8\n   suction = {}\n/\n"
# Held stresses are met to 1e-10 of themselves; a strain of 1e-2 in 100 increments adds up that many roundings.
EXACT = 1e-9


def run(text, name="case", *words):
    """Exit code, complaint and rows of a case."""
    case, out = work / f"{name}.nml", work / f"{name}.csv"
    case.write_text(text)
    out.unlink(missing_ok=True)
    done = subprocess.run([triax, case, "--output", out, "--quiet", *words], capture_output=True, text=True, cwd=work)
    lines = [line for line in out.read_text().splitlines() if line[0] != "#"] if out.exists() else []
    return done, lines, tables.numbers(out) if out.exists() else []


def material(library, props, *more):
    lines = ["&material", "law = 'umat'", f"library = '{umats / library}.so'", f"props = {props}", *more]
    return "\n   ".join(lines) + "\n/\n"


def stage(*lines):
    return "\n   ".join(["&stage", *lines]) + "\n/\n"


def near(a, b, size=1.0):
    return abs(a - b) <= EXACT*max(abs(b), size)


# Linear elasticity, E = 1e4 kPa, nu = 0.25: G = 4000, K = 6666.7 kPa. Shear moduli of their own in the three planes.
YOUNG, POISSON, SHEAR = 1e4, 0.25, (3000.0, 4000.0, 5000.0)
SPRING = f"{YOUNG}, {POISSON}, {', '.join(map(str, SHEAR))}"

# Mohr-Coulomb: sigma_1 = N sigma_3 + 2 c sqrt(N); on the edges d eps_v/d eps_a of plastic flow is 1 - N(psi) in
# compression and 1 - 1/N(psi) in extension, where the axis is the minor principal direction.
C, PHI, PSI = 5.0, 30.0, 10.0

# MUD through umat_ of its own shared library: the same library, so every digit of every column.


def table(which, pattern):
    text = subprocess.run([describe, which], capture_output=True, text=True).stdout
    return re.findall(pattern, text, re.MULTILINE)


names, keys = table("statev", r"^\| \d+ \| `(\w+)`"), table("namelist", r"^   (\w+) = ")


def props_of(text, place):
    """PROPS of a case, from the file of an update that the library saved: it holds all of them, to the last bit."""
    case, saved = work / "probe.nml", work / "probe_saved.nml"
    saved.unlink(missing_ok=True)
    case.write_text(re.sub(r"&stage.*", "", text, flags=re.S).replace("'../", f"'{place}/../")
                    + stage("control = 'drained'", "eps_a_end = 1.0", "increment = 1.0", "output_interval = 1.0"))
    words = [triax, case, "--output", work / "probe.csv", "--quiet", "--save-failed", saved]
    subprocess.run(words, capture_output=True)
    values = dict(re.findall(r"^   (\w+) = (\S+)", saved.read_text(), re.MULTILINE))
    return [values[key] for key in keys]


def test_drained_compression_has_the_slope_e_and_poissons_ratio():
    elastic = material("orthotropic", SPRING, "nstatv = 2", "state_names = n_substep, state_parameter",
                       "tangent = 'consistent'")

    done, lines, rows = run(elastic + START.format(0) + stage("control = 'drained'", "eps_a_end = 0.01"))
    last = rows[-1] if rows else {}
    check("drained compression has the slope E and Poisson's ratio", last and near(last["q"], YOUNG*0.01)
          and near(last["eps_r"], -POISSON*0.01, 0.01) and near(last["sigma_r"], 100), f"{last} {done.stderr}")
    check("the void ratio follows the volume", last and near(last["e"], 1.8*math.exp(-0.01*(1 - 2*POISSON)) - 1), last)
    check("columns of a state that the law does not have are left out",
          last and not {"n_rate", "n_guard", "n_reset"} & set(last), lines[:1])

    # The UMAT was told to call its time n_substep and its strain 33 state_parameter: 100 increments after the one of
    # zero strain at the start.
    check("TIME counts the updates", last and last["n_substep"] == 101, last)
    check("STRAN is the strain since the start, tension positive", last and near(last["psi"], -0.01, 0.01), last)
    done, _, rows = run(elastic + START.format(0) + stage("control = 'undrained'", "eps_a_end = 0.01"))
    check("undrained compression has the slope 3 G and keeps the mean stress",
          rows and near(rows[-1]["q"], 3*4000*0.01) and near(rows[-1]["p_eff"], 100), f"{rows[-1:]} {done.stderr}")

    # S_w = 1 - 0.002 p_c. A law of effective stress shrinks by the change of S_w p_c over K, one of total stress does
    # not, and the effective stress of both is the held net stress plus S_w p_c.
    curve = "&retention\n   law = 'power'\n   a = 0.002\n/\n"
    drying = START.format(10) + stage("control = 'constant_net_stress'", "suction_end = 60")
    before, after = (1 - 0.002*10)*10, (1 - 0.002*60)*60
    for stress, strain in (("effective", (after - before)/(YOUNG/3/(1 - 2*POISSON))), ("total", 0.0)):
        done, _, rows = run(material("orthotropic", SPRING, f"stress = '{stress}'") + curve + drying)
        last = rows[-1] if rows else {}
        check(f"drying of a law of {stress} stress",
    last and near(last["eps_v"],
    strain,
    1e-2) and near(last["s_w"],
    1 - 0.002*60) and near(last["p_eff"],
    100 + after - before),
     f"{last} {done.stderr}")
    done, _, rows = run(material("orthotropic", SPRING) + drying)
    check("without a curve a UMAT is saturated", rows and all(row["s_w"] == 1 for row in rows), done.stderr)
    n_phi, n_psi = [(1 + math.sin(math.radians(a)))/(1 - math.sin(math.radians(a))) for a in (PHI, PSI)]
    soil = material("mohr_coulomb", f"{YOUNG}, {POISSON}, {C}, {PHI}, {PSI}")
    for way, end, axial, slope in (("compression", 0.06, n_phi*100 + 2*C*math.sqrt(n_phi), 1 - n_psi),
                                   ("extension", -0.03, (100 - 2*C*math.sqrt(n_phi))/n_phi, 1 - 1/n_psi)):
        done, _, rows = run(soil + START.format(0) + stage("control = 'drained'", f"eps_a_end = {end}"))
        last, back = (rows[-1], rows[-4]) if len(rows) > 4 else ({}, {})
        check(f"Mohr-Coulomb in drained {way} fails at its strength", last and near(last["sigma_a"], axial),
              f"{last.get('sigma_a')} for {axial} {done.stderr}")
        seen = (last["eps_v"] - back["eps_v"])/(last["eps_a"] - back["eps_a"]) if last else 9
        check(f"and dilates by its angle in {way}", abs(seen - slope) < 1e-6, f"{seen} for {slope}")

    # Mistakes.
    MISTAKES = {
    "an absent library": (
        material(
            "absent",
            "1"),
            "absent.so"),
            "an absent symbol": (
                material(
                    "orthotropic",
                    SPRING,
                    "symbol = 'vumat_'"),
                    "vumat_"),
                    "a place beyond STATEV": (
                        material(
                            "orthotropic",
                            SPRING,
                            "nstatv = 2",
                            "void_ratio_at = 3"),
                            "void_ratio_at = 3"),
                            "no library": (
                                "&material\n   law = 'umat'\n/\n",
                                "needs library"),
                                "an unknown law": (
                                    "&material\n   law = 'umta'\n/\n",
                                    "the nearest is umat"),
                                    "five components": (
                                        material(
                                            "orthotropic",
                                            SPRING,
                                            "components = 5"),
                                            "4 or 6"),
                                            "a second retention": (
                                                "&material\n/\n" + curve,
                                                "one saturation"),
                                                 }
    for name, (text, word) in MISTAKES.items():
        done, lines, _ = run(text + START.format(0) + stage("control = 'drained'", "eps_a_end = 0.01"))
        told = word in done.stderr and "case.nml:" in done.stderr
        check(f"{name} is explained", done.returncode == 2 and told and not lines, f"{done.returncode} {done.stderr}")
    leap = stage("control = 'strain_path'", "d_eps = 0, 0, 0.08, 0, 0, 0", "increment = 0.1")
    done, _, rows = run(elastic + START.format(0) + leap)

    # lambda + 2 G = 12000 kPa: no part of the strain is lost.
    check("an increment that the UMAT refuses is halved", done.returncode == 0 and rows
          and near(rows[-1]["eps_a"], 0.08)
          and near(rows[-1]["sig_33"], 100 + 12000*0.08), f"{done.returncode} {rows[-1:]} {done.stderr}")
    drained = START.format(0) + stage("control = 'drained'", "eps_a_end = 0.01")
    done, _, rows = run(material("orthotropic", "nan, 0.25") + drained)
    check("PROPS that are not numbers are refused", done.returncode == 2 and "nan" in done.stderr, done.stderr)
    done, _, rows = run(material("orthotropic", "1e4, 0.5") + drained)

    # Builds that trap end in the division of the UMAT itself.
    check("a stress that is not finite is no answer", done.returncode != 0 and (light or "not finite" in done.stderr),
          done.stderr)


def test_shear_components_in_the_order_of():
    # The axis is 3 and the shear 13: fifth component as Abaqus orders them, sixth as Kratos does.
    shear = START.format(0) + stage("control = 'simple_shear_constant_volume'", "gamma_end = 0.01")
    for order, modulus in (("abaqus", SHEAR[1]), ("kratos", SHEAR[2])):
        done, _, rows = run(material("orthotropic", SPRING, f"shear_order = '{order}'") + shear)
        check(f"shear components in the order of {order}", rows and near(rows[-1]["sig_13"], modulus*0.01),
              f"{rows[-1:]} {done.stderr}")


def test_mud_as_a_umat_is_mud_digit_by_digit():
    for name in ("undrained_e735_p100", "vi_drained_TMD1", "constant_water", "lode_simple_shear"):
        text = (root / f"drivers/cases/{name}.nml").read_text()
        props = props_of(text, root / "drivers/cases")
        kind = "consistent" if float(props[keys.index("tangent")]) == 3 else "approximate"
        # One value a line: the longest line of a case is 1023 characters.
        group = material("../../umat/libmud", ",\n".join(props), f"nstatv = {len(names)}",
                         "state_names = " + ",\n".join(names),
                         f"tangent = '{kind}'", *[f"{key} = {names.index(at) + 1}" for key, at in (
                             ("void_ratio_at", "void_ratio"), ("saturation_at", "saturation"),
                             ("saturation_slopes_at", "dsw_dpc"), ("suction_slope_at", "dsigma_dpc_11"))])
        done, lines, _ = run(re.sub(r"&material.*?^/", lambda _: group, text, flags=re.S | re.M))
        _, wanted, _ = run(text.replace("'../", f"'{root}/drivers/"), "plain")
        check(f"{name}: MUD as a UMAT is MUD, digit by digit", lines == wanted and len(wanted) > 20,
              f"{len(lines)} and {len(wanted)} lines {done.stderr}")
