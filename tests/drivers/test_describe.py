# SPDX-License-Identifier: MIT
"""mud_describe writes a material so that every host reads the same bits, and says what is wrong with its input."""
import json
import re
import subprocess
import xml.etree.ElementTree as tree

from checking import build, check, root, work

program = build / "drivers/mud_describe"
SHEAR_ORDER, STRESS_LIKE = "shear_order", {"alpha_csl", "P_a", "p_atm", "p_min"}
TO_LAMBDA = {"N_c", "N_l"}


def run(*words):
    return subprocess.run([str(word) for word in (program, *words)], cwd=work, capture_output=True, text=True)


def said(*words):
    done = run(*words)
    check(f"mud_describe {' '.join(map(str, words))} ends well", done.returncode == 0 and not done.stderr, done.stderr)
    return done.stdout


def numbers(text):
    """Of cards: what lies between commas and line ends."""
    return [float(word) for word in re.split(r"[,\s]+", text.strip())]


def card(text, keyword):
    """Data lines of a card."""
    lines = text.splitlines()
    start = next(i for i, line in enumerate(lines) if line.upper().startswith(keyword)) + 1
    stop = next((i for i in range(start, len(lines)) if lines[i].startswith("*")), len(lines))
    return "\n".join(lines[start:stop])


# Numbers that need 17 digits, of either size.
awkward = {"K_0": 1000.0/7.0, "e_0": 2.0/3.0, "tolerance": 1.0e-5/3.0, "P_a": 0.7 + 0.1, "theta": 0.2}


def test_plain_has_every_parameter_once():
    file = work / "sand.nml"
    entries = "".join(f"   {key} = {value!r}\n" for key, value in awkward.items())
    file.write_text(f"&material\n   name = 'Sand of the test'\n{entries}/\n", encoding="utf-8")
    every = [line.split("|")[2].strip(" `") for line in said("props").splitlines()[2:]]
    names = every[:every.index("hysteresis")]   # what stands behind it is printed where it is on
    variables = [line.split("|")[2].strip(" `") for line in said("statev").splitlines()[2:]]
    variables = variables[:variables.index("turns")]   # likewise: numbers that exist with hysteresis
    plain = [float(line) for line in said("plain", file).split()]
    given = dict(zip(names, plain))
    check("plain has every parameter once", len(plain) == len(names) > 40, str(len(plain)))
    check("plain has the bits of the file", all(given[key] == value for key, value in awkward.items()), str(given))
    defaults = [float(line) for line in said("plain").split()]
    check("without a file it is the library's material", defaults[names.index("e_0")] == 0.8 and defaults != plain)

    hysteretic = work / "hysteresis.nml"
    hysteretic.write_text("&material\n   hysteresis = 1\n   P_aw = 2.0\n/\n", encoding="utf-8")
    longer = dict(zip(every, (float(line) for line in said("plain", hysteretic).split())))
    check("with hysteresis a host gets its parameters too", len(longer) == every.index("c_chi")
          and longer["P_aw"] == 2.0, longer)
    preloaded = work / "preloading.nml"
    preloaded.write_text("&material\n   c_chi = 0.26\n/\n", encoding="utf-8")
    longest = dict(zip(every, (float(line) for line in said("plain", preloaded).split())))
    check("with cyclic preloading a host gets its parameters too", len(longest) == every.index("c_ell")
          and longest["c_chi"] == 0.26, longest)
    depvar = said("abaqus", preloaded)
    check("and its state variables", card(depvar, "*DEPVAR").splitlines()[-1].split(", ")[1] == "contraction_4",
          depvar)
    done = subprocess.run([program, "ogs", preloaded], capture_output=True, text=True)
    check("ogs refuses cyclic preloading by a sentence", done.returncode == 2 and "c_chi is on, and " in done.stderr,
          done.stderr)
    fluid = work / "fluidity.nml"
    fluid.write_text("&material\n   c_ell = 200.0\n/\n", encoding="utf-8")
    all_of_it = dict(zip(every, (float(line) for line in said("plain", fluid).split())))
    check("with fluidity a host gets all", len(all_of_it) == len(every) and all_of_it["c_ell"] == 200.0, all_of_it)
    last = card(said("abaqus", fluid), "*DEPVAR").splitlines()[-1]
    check("and every state variable", last.split(", ")[1] == "fluidity", last)
    done = subprocess.run([program, "ogs", fluid], capture_output=True, text=True)
    check("ogs refuses fluidity by a sentence", done.returncode == 2 and "c_ell is on, and " in done.stderr,
          done.stderr)
    for host in ("ogs", "ogs-unsaturated", "udsm", "kratos-udsm"):
        done = subprocess.run([program, host, hysteretic], capture_output=True, text=True)
        check(f"{host} refuses hysteresis by a sentence", done.returncode ==
              2 and "hysteresis is 1, and " in done.stderr, done.stderr)

    abaqus = said("abaqus", file)
    check("Abaqus reads the same", numbers(card(abaqus, "*USER MATERIAL")) == plain
          and f"constants={len(names)}\n" in abaqus)
    check("Abaqus gets every state variable by its name", [line.split(", ")[1] for line in card(abaqus, "*DEPVAR")
                                                           .splitlines()[1:]] == variables)
    calculix = said("calculix", file)
    check("CalculiX reads the same", numbers(card(calculix, "*USER MATERIAL")) == plain
          and int(card(calculix, "*DEPVAR")) == len(variables) and "*MATERIAL, NAME=@ABAQUS_MUD\n" in calculix)
    commas = [line.count(",") for line in card(calculix, "*USER MATERIAL").splitlines()]
    check("no card has more than eight numbers", max(commas) <= 8 and "Sand of the test" in calculix, str(commas))

    for host, law in (("kratos", "UMAT"), ("kratos-udsm", "UDSM")):
        entry = json.loads(said(host, file))["properties"][0]["Material"]
        values = entry["Variables"]
        expected = [1.0 if name == SHEAR_ORDER and law == "UMAT" else value for name, value in zip(names, plain)]
        check(f"{host} reads the same, in the order of shear that it has", values["UMAT_PARAMETERS"] == expected)
        check(f"{host} names a law of its kind", law in entry["constitutive_law"]["name"]
              and values["IS_FORTRAN_UDSM"] is True)
        check(f"{host} has what its law asks for", values.get("UDSM_NUMBER", 0) == 1 if law == "UDSM"
              else values["STATE_VARIABLES"] == [0.0] * len(variables))

    for host, behaviour in (("ogs", "MUD"), ("ogs-unsaturated", "MUD_StressSaturation")):
        pieces = tree.fromstring("<all>" + said(host, file) + "</all>")
        values = {entry.findtext("name"): float(entry.findtext("value")) for entry in pieces.findall("parameter")}
        listed = [(entry.get("name"), values[entry.get("parameter")]) for entry in pieces.iter("material_property")]
        check(f"{host} reads the same, each property by its parameter", listed == list(zip(names, plain)))
        check(f"{host} names its behaviour", pieces.find("constitutive_relation").findtext("behaviour") == behaviour)

    lines = said("incrementaldriver", file).splitlines()
    check("incrementalDriver reads the same", lines[0].startswith("MUD #") and int(lines[1]) == len(names)
          and [float(line) for line in lines[2:]] == plain)
    lines = [float(line) for line in said("incrementaldriver-start", file).splitlines()]
    check("incrementalDriver starts with the void ratio of the material",
          lines[:8] == [6, -100, -100, -100, 0, 0, 0, len(variables)] and len(lines) == 8 + len(variables)
          and lines[8 + variables.index("void_ratio")] == awkward["e_0"] and lines.count(0) == len(variables) + 2)
    rows = [line.split() for line in said("udsm", file).splitlines()[1:]]
    check("the list for PLAXIS has number, name, unit and value",
          [(int(row[0]), row[1], float(row[3])) for row in rows]
          == [(i + 1, *pair) for i, pair in enumerate(zip(names, plain))])

    in_pa = dict(zip(names, (float(line) for line in said("plain", file, "--unit", "Pa").split())))
    factor = {**dict.fromkeys(STRESS_LIKE, 1000.0), **dict.fromkeys(TO_LAMBDA, 1000.0**given["lambda"])}

    # Two roundings: of the power and of the product.
    wrong = [name for name in names if abs(in_pa[name] - factor.get(name, 1.0)*given[name]) > 1e-15*abs(in_pa[name])]
    check("--unit Pa is the same sand", not wrong, str(wrong))
    check("--unit is said", "stresses in Pa" in said("calculix", file, "--unit", "Pa"))
    check("the stress of the start is in that unit",
          said("incrementaldriver-start", file, "--unit", "MPa").splitlines()[1] == "-0.1")

    deep = "./"*200 + 'we"ird.nml'
    (work / deep).write_bytes(file.read_bytes())
    check("a path is read whatever its length and letters", said("plain", deep) == said("plain", file))
    for words, sentence in ((["abaqs"], "There is no table and no host abaqs"), ([], "No table or host is named"),
                            (["plain", "none.nml"], "none.nml: cannot be read"), (["props", file], "no material"),
                            (["plain", file, "--unit", "atm"], "There is no unit atm"),
                            (["plain", file, "another"], "at a time"), (["plain", "--unit"], "--unit needs")):
        done = run(*words)
        check(f"{words} is a mistake with a sentence", done.returncode !=
              0 and sentence in done.stderr and not done.stdout, done.stderr)
    (work / "bad.nml").write_text("&material\n   K_0 = -1.0\n/\n", encoding="utf-8")
    check("a parameter out of its range is refused with its range", run("kratos", "bad.nml").returncode != 0
          and "K_0" in run("kratos", "bad.nml").stderr and "0.001" in run("kratos", "bad.nml").stderr)
    check("--help names every host", all(word in said("--help") for word in (
        "abaqus", "calculix", "kratos-udsm", "ogs-unsaturated", "incrementaldriver-start", "udsm", "plain")))
    for material in sorted((root / "drivers/materials").glob("*.nml")):
        words = material.read_text(encoding="utf-8")
        listed = every[:every.index("c_chi")] if "hysteresis = 1" in words else names
        listed = every[:every.index("c_ell")] if "c_chi = " in words else listed
        listed = every if "c_ell = " in words else listed
        check(f"{material.name} is read, hysteresis with it where it is on",
              len(said("plain", material).split()) == len(listed))
