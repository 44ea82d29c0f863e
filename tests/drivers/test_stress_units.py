# SPDX-License-Identifier: MIT
"""mud_triax in any unit of stress: a case in Pa, MPa or psi gives what it gives in kPa, limits and texts follow the
unit that p_atm tells, and mixed units draw a warning."""
import re
import subprocess

from checking import build, check, root, work
import tables  # noqa: E402 (checking knows its folder)

triax, describe = build / "drivers/mud_triax", build / "drivers/mud_describe"
TOYOURA = root / "drivers/materials/toyoura.nml"
UNITS = {"kPa": 1.0, "Pa": 1000.0, "MPa": 1.0e-3, "psi": 0.1450377377302092, "bar": 0.01}
ALIKE = 1e-6   # of the largest value of a column; the rounding of the conversion (1e-16) grows on the way


def call(text, *words):
    (work / "case.nml").write_text(text)
    return subprocess.run([triax, work / "case.nml", "--quiet", "--output", work / "case.csv", *words],
                          capture_output=True, text=True, cwd=work)


def said(*words):
    return subprocess.run([describe, *map(str, words)], capture_output=True, text=True, check=True).stdout


def material(unit):
    """&material of the sand with every parameter in a unit."""
    names = [line.split("|")[2].strip(" `") for line in said("props").splitlines()[2:]]
    values = said("plain", TOYOURA, "--unit", unit).split()
    return "&material\n" + "".join(f" {name} = {value}\n" for name, value in zip(names, values)) + "/\n"


def stresses(*values):
    return ", ".join(repr(value*factor) for value in values)


# Stages led by strain and by stress, with increments and without, saturated and not, cycles: every key with a unit.
ends = {}
for unit, factor in UNITS.items():
    wet = (f"&initial\n p_eff = {stresses(120.0)}\n void_ratio = 0.8\n/\n"
           "&stage\n control = 'undrained'\n eps_a_end = 0.01\n/\n"
           f"&stage\n control = 'drained'\n q_end = {stresses(20.0)}\n/\n"
           f"&stage\n control = 'undrained'\n cycle_by = 'q'\n amplitude = {stresses(15.0)}\n"
           f" centre = {stresses(30.0)}\n cycles = 3\n/\n"
           f"&stage\n control = 'stress_path'\n d_sigma = {stresses(5.0, 0.0, 9.0, 0.0, 4.0, 0.0)}\n"
           f" increment = {stresses(0.5)}\n output_interval = {stresses(1.0)}\n/\n")
    dry = (f"&initial\n sigma_a = {stresses(90.0)}\n sigma_r = {stresses(60.0)}\n suction = {stresses(40.0)}\n"
           " void_ratio = 0.85\n/\n"
           f"&stage\n control = 'k0'\n sigma_a_end = {stresses(150.0)}\n/\n"
           f"&stage\n control = 'constant_net_stress'\n suction_end = {stresses(10.0)}\n/\n"
           "&stage\n control = 'linear'\n strain_1 = 1, -1, 0, 0, 0, 0\n stress_2 = 1, 0, 0, 0, 0, 0\n"
           f" change_2 = {stresses(2.0)}\n stress_3 = 0, 0, 1, 0, 0, 0\n change_3 = {stresses(9.0)}\n"
           " strain_4 = 0, 0, 0, 1, 0, 0\n strain_5 = 0, 0, 0, 0, 1, 0\n strain_6 = 0, 0, 0, 0, 0, 1\n/\n"
           f"&stage\n control = 'constant_q'\n p_end = {stresses(80.0)}\n/\n"
           f"&stage\n control = 'simple_shear_drained'\n tau_end = {stresses(15.0)}\n/\n")
    for name, path in (("wet", wet), ("dry", dry)):
        done = call(material(unit) + path)
        check(f"{name} in {unit} runs without a message", done.returncode == 0 and not done.stderr, done.stderr)
        if done.returncode == 0:
            ends[name, unit] = tables.numbers(work / "case.csv")
            check(f"{name}: its stresses are in {unit}",
                  f"effective [{unit}], suction and u [{unit}]" in str(tables.comments(work / "case.csv")))
STRESSES = {"p_eff", "q", "sigma_a", "sigma_r", "suction", "u"}
COUNTS = {"n_substep", "n_rate", "n_reject", "n_guard", "n_reset", "control_error"}   # may differ by a rounding
for (name, unit), rows in ends.items():
    expected = ends[name, "kPa"]
    check(f"{name} in {unit} has as many rows", len(rows) == len(expected) > 20, len(rows))
    for column in set(expected[0]) - COUNTS:
        factor = UNITS[unit] if column in STRESSES or column.startswith("sig_") else 1.0
        size = max(abs(row[column]) for row in expected)
        off = max(abs(row[column]/factor - other[column]) for row, other in zip(rows, expected))
        check(f"{name} in {unit}: {column}", off <= ALIKE*size or size < 1e-9, (off, size))

# Limits: 1e-6 to 1e7 kPa in any unit.
REST = " void_ratio = 0.8\n/\n&stage\n control = 'undrained'\n eps_a_end = 0.0001\n/\n"


def test_more_than_the_limit_in():
    for unit, limit in (("kPa", 1e7), ("Pa", 1e10), ("MPa", 1e4)):
        done = call(material(unit) + f"&initial\n p_eff = {1.01*limit}\n{REST}")
        check(f"more than the limit in {unit}", done.returncode == 2 and f"p_eff = {1.01*limit}" in done.stderr
              and f"{unit}: mean effective stress" in done.stderr, done.stderr)
    done = call(material("Pa") + f"&initial\n p_eff = 3e7\n{REST}")
    check("30 MPa said in Pa are no more than the limit in kPa", done.returncode == 0, done.stderr)
    done = call(re.sub(r"P_a = .*", "P_a = 2e9", material("Pa")) + f"&initial\n p_eff = 1e5\n{REST}")
    check("the range of a parameter is told in its unit", done.returncode == 2 and " Pa: air-entry" in done.stderr,
          done.stderr)
    done = call("&material\n p_atm = 101325\n alpha_csl = 3.37e6\n P_a = 5000\n N_c = 240.9\n N_l = 322.06\n/\n"
                f"&initial\n p_eff = 1e5\n{REST}")
    check("limits of parameters follow a p_atm of the same group",
          done.returncode == 0 and not done.stderr, done.stderr)


def test_mixed_units_draw_a_warning():
    # A warning where p_atm and the others disagree: heard, kept with the rows, and no refusal.
    done = call(f"&material\n file = '{TOYOURA}'\n p_atm = 101325.0\n/\n&initial\n p_eff = 1e5\n{REST}")
    told = [line for line in done.stderr.splitlines() if line.startswith("mud_triax: warning: ")]
    check("mixed units draw a warning", done.returncode == 0 and len(told) ==
          1 and "P_a" in told[0] and "p_atm" in told[0] and "case.nml:" in told[0], done.stderr)
    check("which stands with the rows", "warning" in str(tables.comments(work / "case.csv")))
    done = call(f"&material\n file = '{TOYOURA}'\n P_a = 5000\n/\n&initial\n p_eff = 100\n{REST}")
    check("it names the line", "case.nml:3: " in done.stderr and "P_a" in done.stderr, done.stderr)
    mixed = work / "mixed.nml"
    mixed.write_text("&material\n p_atm = 101325.0\n/\n")
    for how, words, text in (("--material", ["--material", mixed], "&material\n/\n"),
                             ("file = ...", [], f"&material\n file = '{mixed}'\n/\n")):
        done = call(text + f"&initial\n p_eff = 1e5\n{REST}", *words)
        check(f"a file read by {how} is named with its line", f"mud_triax: warning: {mixed}:2: " in done.stderr,
              done.stderr)
    done = subprocess.run([describe, "plain", mixed], capture_output=True, text=True)
    check("mud_describe warns too", done.returncode == 0 and "mud_describe: warning: " in done.stderr, done.stderr)


def test_a_file_in_pa_comes_back_to_kpa():
    # A file in another unit is converted from its own.
    (work / "pascal.nml").write_text(material("Pa"))
    back = [float(word) for word in said("plain", work / "pascal.nml", "--unit", "kPa").split()]
    there = [float(word) for word in said("plain", TOYOURA).split()]
    check("a file in Pa comes back to kPa", all(abs(a - b) <= 1e-12*abs(b) for a, b in zip(back, there)), back)
