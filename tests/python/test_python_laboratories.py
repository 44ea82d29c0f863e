# SPDX-License-Identifier: MIT
"""Tables of other laboratories: total and effective stresses, logged records, blanks, German heads, units, p and q."""

import os
import sys

import numpy as np
import openpyxl

from checking import build, check, needs_plain_library, root, work

needs_plain_library()
os.environ["MUD_LIBRARY_DIR"] = str(build)
os.environ["MPLBACKEND"] = "Agg"
sys.path[:0] = [str(root / "python")]
import mud  # noqa: E402
from mud.calibration import Effort, calibrate, evaluate, make_task, read_table  # noqa: E402
from mud.calibration.heads import UNITS, head_of, unit_of  # noqa: E402

EPS = (0.0, 2.0, 4.5, 9.0, 14.0)  # [%]
VOLUME = (0.0, 0.2, -0.4, -1.9, -3.1)  # [%]
Q = (0.0, 210.0, 330.0, 345.0, 325.0)
CELL, BACK, E_0 = 150.0, 320.0, 0.74
U = (40.0, 95.0, 118.0, 101.0, 83.0)  # of an undrained test
AT_REST = 190.0  # its cell pressure


def written(text, name="laboratory.csv", encoding="utf-8"):
    (work / name).write_bytes(text.encode(encoding))
    return work / name


def refusal(path, kind):
    try:
        read_table(path, kind)
    except mud.InputError as problem:
        return str(problem)
    return ""


def table(head, *columns, mark=",", end="", point="."):
    """A table of columns; a number alone is a column of it."""
    rows = zip(*(c if isinstance(c, (tuple, list, np.ndarray)) else (c,) * len(columns[0]) for c in columns))
    lines = [mark.join(f"{x:.12g}".replace(".", point) for x in row) for row in rows]
    return head + "\n" + "\n".join(lines) + "\n" + end


def drained(name, path, told=(), sheet=0):
    """Whether a table is that of the drained test above, and says some words."""
    test = read_table(path, "drained")[sheet]
    q = np.array(Q)
    wanted = {"eps_a": np.array(EPS) / 100, "eps_v": np.array(VOLUME) / 100, "q": q, "p": CELL + q / 3}
    off = {key: float(np.max(np.abs(test[key] - value))) for key, value in wanted.items() if key in test}
    check(f"{name} is read", len(off) == 4 and max(off.values()) < 2e-3 and test.e_0 == E_0, (off, test.understood))
    check(f"{name}: the held stress is effective", abs(test.sigma_r - CELL) < 1e-3, test.sigma_r)
    says(name, test, told)
    return test


def undrained(name, path, told=()):
    test = read_table(path, "undrained")[0]
    wanted = AT_REST - np.array(U) + np.array(Q) / 3
    check(
        f"{name} is read",
        np.allclose(test["p"], wanted) and np.allclose(test["q"], Q),
        (test["p"], test["q"], test.understood),
    )
    says(name, test, told)


def says(name, test, told):
    text = " ".join(f"{given} is {meant}." for given, meant in test.understood)
    check(f"{name} is told", all(word in text for word in told), text)


P = tuple(CELL + q / 3 for q in Q)
SUM = tuple(CELL + q / 2 for q in Q)
HALF = tuple(q / 2 for q in Q)
AXIAL = tuple(CELL + q for q in Q)
START = "eps_a_percent,eps_v_percent,"
TAKEN = ("total, because no head says effective", "u is taken off")


def more(values, by):
    return tuple(np.array(values) + by)


def test_pore_pressure_is_taken_off_in_every_kind_of_table():
    head = START + "sigma_1_kPa,sigma_3_kPa,u_kPa,e_0"
    drained(
        "sigma_1 and sigma_3 beside u",
        written(table(head, EPS, VOLUME, more(AXIAL, BACK), CELL + BACK, BACK, E_0)),
        TAKEN,
    )
    head = START + "q_kPa,p_kPa,u_kPa,e_0"
    drained("p beside u", written(table(head, EPS, VOLUME, Q, more(P, BACK), BACK, E_0)), TAKEN)
    head = START + "q_kPa,Cell pressure [kPa],Back pressure [kPa],e_0"
    drained(
        "a cell pressure and a back pressure",
        written(table(head, EPS, VOLUME, Q, CELL + BACK, BACK, E_0)),
        ("u is taken off",),
    )
    drained(
        "p smaller than u",
        written(table(START + "q_kPa,p_kPa,u_kPa,e_0", EPS, VOLUME, Q, P, 400, E_0)),
        ("effective, because less than the pore pressure",),
    )
    around = tuple(400 + x for x in (0, 6, -5, 4, -3))
    head = START + "q_kPa,sigma_3_kPa,u_kPa,e_0"
    drained(
        "a small stress beside a back pressure that is not steady",
        written(table(head, EPS, VOLUME, Q, CELL, around, E_0)),
        ("effective, because less",),
    )
    fallen = (0, 70, 99, 100.4, 100.2)
    test = read_table(
        written(table("eps_a_percent,q_kPa,sigma_3_kPa,u_kPa,e_0", EPS, (0, 25, 4, 2, 2), 100, fallen, 0.95)),
        "undrained",
    )[0]
    check("sand that has liquefied", np.allclose(test["sigma_r"], 100 - np.array(fallen)), test["sigma_r"])
    head = "eps_a_percent,q_kPa,p_kPa,u_kPa,e_0"
    total = tuple(AT_REST + q / 3 for q in Q)
    undrained(
        "the total p of an undrained test",
        written(table(head, EPS, Q, total, U, E_0)),
        ("total, because", "stays while u changes"),
    )
    undrained(
        "the effective p of an undrained test",
        written(table(head, EPS, Q, more(total, -np.array(U)), U, E_0)),
        ("effective, because", "the cell pressure, stays"),
    )
    undrained(
        "sigma_3 and q of one",
        written(table("eps_a_percent,q_kPa,sigma_3_kPa,u_kPa,e_0", EPS, Q, AT_REST, U, E_0)),
        ("sigma_3 stays while u changes",),
    )
    undrained(
        "excess pore pressure",
        written(
            table("eps_a_percent,q_kPa,Cell pressure (kPa),Excess pore pressure (kPa),e_0", EPS, Q, AT_REST, U, E_0)
        ),
        ("count from the back pressure",),
    )
    names = "eps_a_percent,q_kPa,cell pressure [kPa],back pressure [kPa],{}pore pressure [kPa],e_0"
    part = EPS, Q, AT_REST + 60, 60
    undrained("back and excess pressure", written(table(names.format("excess "), *part, U, E_0)), ("as their sum",))
    undrained(
        "back and pore pressure",
        written(table(names.format(""), *part, more(U, 60), E_0)),
        ("not used: pore pressure",),
    )
    told = refusal(written(table(names.replace("{}pore pressure", "water level"), *part, U, E_0)), "undrained")
    check("a back pressure alone is no pore pressure there", "u_kPa (zeros where there is none)" in told, told)
    wild = written(table(head, EPS, Q, (200, 260, 190, 300, 210), U, E_0))
    check(
        "an undrained p that nothing explains is asked for",
        "total or effective?" in refusal(wild, "undrained") and "sigma_3'" in refusal(wild, "undrained"),
        refusal(wild, "undrained"),
    )

    stress, e = (60, 120, 240, 480), (0.81, 0.8, 0.785, 0.77)
    oed = read_table(
        written(table("Vertical stress (kPa),Pore pressure (kPa),Void ratio", more(stress, 90), 90, e)), "oedometer"
    )[0]
    check("of an oedometer test", oed["sigma_a"].tolist() == list(stress), oed["sigma_a"])
    says("that", oed, TAKEN)
    iso = read_table(written(table("p_kPa,u_kPa,e", more(stress, 700), 700, e)), "isotropic")[0]
    check("of an isotropic test", iso["p"].tolist() == list(stress), iso["p"])
    head = "control,cycle_by,amplitude_kPa,cycle,p_0_kPa,u_kPa,e_0,eps_v\n"
    cyclic = read_table(
        written(head + "".join(f"drained,q,25,{n},410,250,0.8,{n * 1e-3}\n" for n in (1, 2, 3))), "cyclic"
    )[0]
    check("of a cyclic test", cyclic["p_0"].tolist() == [160.0] * 3, cyclic["p_0"])
    says("that", cyclic, TAKEN)
    moving = written(
        head.replace("eps_v", "r_u") + "".join(f"undrained,q,25,{n},410,{250 + 20 * n},0.8,0.{n}\n" for n in (1, 2, 3))
    )
    check(
        "p_0 beside a pore pressure that grows is asked for",
        "total or effective?" in refusal(moving, "cyclic"),
        refusal(moving, "cyclic"),
    )
    for kind, head, row in (
        ("stiffness", "p_kPa,u_kPa,e,G_max_MPa", (260, 160, 0.8, 90)),
        ("modulus", "gamma,G_ratio,p_0_kPa,u_kPa,e_0", (1e-4, 0.8, 260, 160, 0.8)),
        ("liquefaction", "csr,N,p_0_kPa,u_kPa,e_0", (0.2, 9, 260, 160, 0.8)),
    ):
        test = read_table(written(table(head, *((x,) for x in row))), kind)[0]
        check(f"of a {kind} table", test["p" if kind == "stiffness" else "p_0"][0] == 100.0, test.columns)


def test_heads_say_what_is_effective():
    for a, r in (
        ("sigma_1'", "sigma_3'"),
        ("σ'1", "σ'3"),
        ("σ₁′", "σ₃′"),
        ("Eff. axial stress", "Eff. radial stress"),
        ("sig1eff", "sig3eff"),
        ("effective vertical stress", "Effective confining pressure"),
        ("Wirksame Axialspannung", "Effektive Radialspannung"),
        ("Effektivspannung σ1", "Effektivspannung σ3"),
        ("sigma_1_eff", "sigma_3_eff"),
    ):
        head = f"{START}{a} [kPa],{r} [kPa],u [kPa],e_0"
        drained(
            f"{a} and {r} beside u", written(table(head, EPS, VOLUME, AXIAL, CELL, 77, E_0)), ("effective sigma_r",)
        )
    head = START + "sigma1 [kPa],sigma1' [kPa],sigma3 [kPa],sigma3' [kPa],u [kPa],e_0"
    both = written(
        table(head, EPS, VOLUME, more(AXIAL, 90), AXIAL, CELL + 90, CELL, 95, E_0)
    )  # 90 and 95: which ones were taken
    drained("a table with both", both, ("sigma3 [kPa] is not used: sigma3' [kPa] is the effective one",))
    head = START + "sigma_1_kPa,sigma_3' [kPa],u_kPa,e_0"
    drained(
        "one of each",
        written(table(head, EPS, VOLUME, more(AXIAL, 60), CELL, 60, E_0)),
        ("total, because others are called effective",),
    )
    head = START + "sigma_1_total_kPa,sigma_3_kPa,u_kPa,e_0"
    drained(
        "the other of each",
        written(table(head, EPS, VOLUME, more(AXIAL, 60), CELL, 60, E_0)),
        ("effective, because others are called total",),
    )
    cell = START + "p_kPa,q_kPa,cell pressure [kPa],u_kPa,e_0"
    for name, p in (("total", more(P, BACK)), ("effective", P), ("total", more(SUM, BACK))):
        path = written(table(cell, EPS, VOLUME, p, Q, CELL + BACK, BACK, E_0))
        drained(f"{name} p beside a cell pressure", path, (name, "u is taken off"))
    told = refusal(written(table(cell, EPS, VOLUME, P, Q, CELL + BACK, 0.3 * BACK, E_0)), "drained")
    check("p that does not fit cell pressure and u is refused", "contradict each other" in told, told)
    beside = START + "sigma_1_kPa,cell pressure [kPa],u_kPa,e_0"
    path = written(table(beside, EPS, VOLUME, more(AXIAL, BACK), CELL + BACK, BACK, E_0))
    drained("sigma_1 beside a cell pressure", path, ("total, because beside a cell pressure",))
    plain = written(table(START + "sigma_1_kPa,sigma_3_kPa,e_0", EPS, VOLUME, AXIAL, CELL, E_0))
    drained("without a pore pressure", plain, ("taken as effective stresses: the table has no pore pressure u",))
    alone = written(table(START + "q_kPa,cell pressure [kPa],e_0", EPS, VOLUME, Q, CELL, E_0))
    check(
        "a total stress without a pore pressure is asked for",
        "u_kPa (zeros where there is none)" in refusal(alone, "drained"),
        refusal(alone, "drained"),
    )
    beside = written(table(START + "q_kPa,p' [kPa],cell pressure [kPa],e_0", EPS, VOLUME, Q, P, 999, E_0))
    drained(
        "a cell pressure that nobody needs", beside, ("not read: a total stress, and the table has no pore pressure",)
    )
    test = read_table(written(table("eps_a_percent,q_kPa,sigma_3_kPa,e_0", EPS, Q, CELL, E_0)), "drained")[0]
    says("a drained test whose volume was not measured", test, ("q alone is compared",))
    task = make_task("q_alone", [{"file": work / "laboratory.csv", "kind": "drained"}])
    result = calibrate(task, Effort(samples=1, starts=1, joint=2, members=0), 1, None)
    check(
        "its q is fitted alone", np.isfinite(result.misfits[0].q) and np.isnan(result.misfits[0].eps_v), result.misfits
    )


def test_p_and_q_of_other_textbooks_show_by_what_is_held():
    head = START + "q_kPa,p_kPa,e_0"
    held = ("so the radial stress is held", "turned into")
    drained(
        "half of the sum",
        written(table(head, EPS, VOLUME, Q, SUM, E_0)),
        ("p = (sigma_1 + sigma_3)/2 and q = sigma_1 - sigma_3", *held),
    )
    drained(
        "half of both",
        written(table(head, EPS, VOLUME, HALF, SUM, E_0)),
        ("p = (sigma_1 + sigma_3)/2 and q = (sigma_1 - sigma_3)/2", *held),
    )
    drained(
        "half of the difference", written(table(head, EPS, VOLUME, HALF, P, E_0)), ("q = (sigma_1 - sigma_3)/2", *held)
    )
    usual = drained("the library's own", written(table(head, EPS, VOLUME, Q, P, E_0)))
    check("of which nothing is told", usual.understood == [], usual.understood)
    head = START + "q_kPa,p_kPa,sigma_3_kPa,e_0"
    drained("sigma_3 shows it too", written(table(head, EPS, VOLUME, HALF, SUM, CELL, E_0)), ("so says sigma_3",))
    head = START + "q_kPa,sigma_1_kPa,sigma_3_kPa,e_0"
    drained("q beside both stresses", written(table(head, EPS, VOLUME, HALF, AXIAL, CELL, E_0)), ("doubled",))
    wrong = written(table(head, EPS, VOLUME, more(Q, 80), AXIAL, CELL, E_0))
    check(
        "q that no meaning explains is refused",
        "neither sigma_1 - sigma_3 nor half" in refusal(wrong, "drained"),
        refusal(wrong, "drained"),
    )
    head = "eps_a_percent,q_kPa,p' [kPa],u_kPa,e_0"
    for name, q, p in (("both", HALF, SUM), ("the sum", Q, SUM)):
        undrained(
            f"half of {name} in an undrained test",
            written(table(head, EPS, q, more(p, AT_REST - CELL - np.array(U)), U, E_0)),
            ("the cell pressure, the radial stress + u, is held",),
        )
    test = read_table(written(table("eps_a_percent,q_kPa,p_kPa,e_0", EPS, Q, more(P, -np.array(U)), E_0)), "undrained")[
        0
    ]
    says(
        "an undrained test without a pore pressure",
        test,
        ("as no pore pressure or radial stress shows another meaning",),
    )


def test_a_logged_record_is_read_in_one_run():
    # 6000 rows: strain with a scatter of 0.003 %, in steps of 0.002 %, so that half of the rows lie behind others.
    scatter = np.random.default_rng(54)
    ways = np.linspace(0, 12, 6000)
    strain = np.maximum(ways + scatter.normal(0, 0.003, len(ways)), 0)
    q = 350 * (1 - np.exp(-ways / 2)) + scatter.normal(0, 0.4, len(ways))
    text = "eps_a_percent,eps_v_percent,q_kPa,sigma_3_kPa,e_0\n"
    text += "".join(f"{a:.4f},{-0.2 * max(w - 1, 0):.4f},{s:.2f},150,0.74\n" for a, w, s in zip(strain, ways, q))
    test = read_table(written(text), "drained")[0]
    away = np.max(np.abs(test["q"] - 350 * (1 - np.exp(-test["eps_a"] * 50))))
    check(
        "what is left is the test",
        1000 < len(test.lines) < 6000 and np.all(np.diff(test["eps_a"]) > 0) and away < 5,
        (len(test.lines), away),
    )
    dropped = [
        meant for given, meant in test.understood if "equal to the one before or behind it by at most 0.0" in given
    ]
    check(
        "what is dropped is counted in one sentence",
        len(dropped) == 1 and f": {6000 - len(test.lines)} rows dropped" in dropped[0],
        test.understood,
    )
    result = evaluate(make_task("logged", [{"file": work / "laboratory.csv", "kind": "drained"}]), "karlsruhe")
    check("and it is compared", np.isfinite(result.misfits[0].q), result.misfits)

    rows = [
        "0,0,0,150,0.74",
        "2,0.1,150,150,0.74",
        "2,0.1,151,150,0.74",
        "1.995,0.1,151,150,0.74",
        "5,-0.3,280,150,0.74",
        "9,-1,300,150,0.74",
    ]
    test = read_table(written(text.partition("\n")[0] + "\n" + "\n".join(rows)), "drained")[0]
    check("an equal row and one a step back", test.lines.tolist() == [2, 3, 6, 7], test.lines)
    says("them", test, ("behind it by at most 0.005 %", "2 rows dropped, the first in line 4"))
    for name, back in (
        ("of five rows", [0, 5, 4, 9, 12]),
        ("of a record", [*np.linspace(0, 3, 300), *np.linspace(3, 2.7, 30), *np.linspace(2.7, 9, 600)]),
        ("at the end", [*np.linspace(0, 9, 90), *np.linspace(9, 8.5, 6)]),
    ):
        path = written(table("eps_a_percent,q_kPa,sigma_3_kPa,e_0", back, 200, 150, 0.74))
        check(
            f"an unloading {name} is refused with its line",
            "moves one way" in refusal(path, "drained") and "laboratory.csv:" in refusal(path, "drained"),
            refusal(path, "drained"),
        )

    # Compression: noise of a share of the stress; unloading and reloading stay, and of equal stresses the last row.
    branches = [np.geomspace(*ends, 400) for ends in ((20, 800), (800, 100), (100, 1600))]
    stress = np.concatenate(branches) * (1 + scatter.normal(0, 0.002, 1200))
    e = 0.8 - 0.01 * np.log(np.maximum.accumulate(np.concatenate(branches)))
    test = read_table(written(table("sigma_a_kPa,e", stress, e)), "oedometer")[0]
    way = np.sign(np.diff(np.log(test["sigma_a"])))
    check(
        "a logged oedometer test turns twice",
        np.sum(way[1:] * way[:-1] < 0) == 2 and len(test.lines) > 300,
        len(test.lines),
    )
    settled = read_table(
        written(table("sigma_a_kPa,e", (50, 100, 100, 100, 200, 200), (0.8, 0.795, 0.793, 0.792, 0.785, 0.78))),
        "oedometer",
    )[0]
    check("of equal stresses the last row stays", settled["e"].tolist() == [0.8, 0.792, 0.78], settled["e"])
    held = np.repeat((8, 30, 120, 480, 120, 30, 240), 60) + scatter.normal(0, 0.15, 420)
    test = read_table(written(table("sigma_a_kPa,e", held, 0.8 - 0.0001 * np.arange(420))), "oedometer")[0]
    way = np.sign(np.diff(test["sigma_a"]))
    check("stresses that are held turn nowhere", np.sum(way[1:] * way[:-1] < 0) == 2, test["sigma_a"])
    head = "control,cycle_by,amplitude_kPa,cycle,p_0_kPa,e_0,eps_v\n"
    twice = written(head + "".join(f"drained,q,20,{n},90,0.8,0.00{n}\n" for n in (1, 2, 2, 3)))
    says("an equal row of a cyclic test", read_table(twice, "cyclic")[0], ("1 row dropped, the first in line 4",))
    curve = read_table(written("suction_kPa,S_w\n1,1\n1,0.99\n5,0.7\n20,0.3\n"), "retention")[0]
    check("points of a retention curve at one suction stay", len(curve.lines) == 4, curve.lines)


def test_blanks_between_cells_and_names_in_a_comment():
    columns = EPS, VOLUME, Q, CELL, E_0
    head = "eps_a_percent eps_v_percent q_kPa sigma_3_kPa e_0"
    drained("blanks", written(table(head, *columns, mark=" ")), ("blanks between cells is the separator",))
    drained(
        "many blanks", written(table(head.replace(" ", "     "), *columns, mark="   ", point=",")), ("decimal marks",)
    )
    drained(
        "names with blanks in them",
        written(table("Axial strain [%]  Volume strain [%]  q [kPa]  Radial stress [kPa]  e0", *columns, mark="  ")),
    )
    drained("names with one blank", written(table("eps1 [%] epsv [%] q / kPa sigma3 [kPa] e_0", *columns, mark=" ")))
    drained(
        "units below",
        written(table("eps_a eps_v q sigma_3 e_0\n% % kPa kPa -", *columns, mark=" ")),
        ("units of the names",),
    )
    for mark, name in ((",", "commas"), (" ", "blanks"), ("\t", "tabs"), (";", "semicolons")):
        file = work / "saved.txt"
        np.savetxt(
            file,
            np.array([c if isinstance(c, tuple) else (c,) * 5 for c in columns]).T,
            delimiter=mark,
            header=head.replace(" ", mark),
        )
        drained(f"what numpy.savetxt writes with {name}", file, ("the comment in line 1 is the line of names",))
    drained(
        "names behind other comments",
        written("# Test of June\n#\n" + table("# " + head, *columns, mark=" ", end="# end\n")),
        ("line 3",),
    )
    drained(
        "a comment with names above a line of names",
        written("# eps_a q e, as measured\n" + table(head, *columns, mark=" ")),
    )
    preamble = "".join(f"Setting {i} of the cell, as chosen: yes\n" for i in range(40))
    for mark in (" ", ",", "\t"):
        path = written(preamble + table(head.replace(" ", mark), *columns, mark=mark))
        drained(f"a long preamble before cells with {mark!r}", path, ("lines 1 to 40 is above the line of names",))
        path = written(preamble + table("# " + head.replace(" ", mark), *columns, mark=mark))
        drained("the same before names in a comment", path, ("the comment in line 41 is the line of names",))
    check(
        "numbers without any names are refused",
        "needs the column eps_a" in refusal(written(table("# nothing", *columns)), "drained"),
    )


def test_german_heads():
    columns = EPS, VOLUME, Q, CELL, E_0
    head = "Dehnung [%];Volumendehnung [%];Deviatorspannung [kN/m²];Radialspannung [kN/m²];Anfangsporenzahl [-]"
    for encoding in ("utf-8", "latin-1"):
        drained(
            f"German in {encoding}",
            written(table(head, *columns, mark=";", point=","), encoding=encoding),
            ("decimal marks",),
        )
    head = (
        "Axiale Stauchung ε1 / %;Volumenänderung / %;Hauptspannungsdifferenz / kPa;Wirksame Seitenspannung / kPa;"
        "Porenzahl e0"
    )
    drained("German with strokes", written(table(head, *columns, mark=";", point=",")))
    head = "Axialdehnung (%);Volumendehnung (%);Spannung σ1 (kPa);Spannung σ3 (kPa);Porenwasserdruck (kPa);e0"
    drained(
        "total stresses in German",
        written(table(head, EPS, VOLUME, more(AXIAL, BACK), CELL + BACK, BACK, E_0, mark=";")),
        TAKEN,
    )
    test = read_table(written("Spannung;Porenzahl\nkN/m^2;-\n25;0,8\n50;0,78\n100;0,76\n"), "oedometer")[0]
    check("an oedometer test", test["sigma_a"].tolist() == [25, 50, 100] and test["e"][2] == 0.76, test.columns)
    test = read_table(written("Saugspannung in hPa;Sättigungsgrad in %\n0;100\n40;80\n90;30\n"), "retention")[0]
    check(
        "a retention curve",
        np.allclose(test["suction"], [0, 4, 9]) and np.allclose(test["S_w"], [1, 0.8, 0.3]),
        test.columns,
    )
    curve = read_table(written("pF-Wert;Sättigung\n1;1\n2;0,6\n3;0,2\n"), "retention")[0]
    check("pF", np.allclose(curve["suction"], [0.980665, 9.80665, 98.0665]), curve["suction"])


def test_a_name_its_symbol_and_what_it_says_of_the_stress():
    for head, wanted in (
        ("Porenwasserdruck u_w [kPa]", ("u", "", "kPa")),
        ("Porenwasserüberdruck Δu / kPa", ("u", "excess", "kPa")),
        ("Zelldruck σ3 [bar]", ("sigma_r", "cell", "bar")),
        ("Effektiver Zelldruck [kPa]", ("sigma_r", "effective", "kPa")),
        ("mittlere effektive Spannung p' in kN/m²", ("p", "effective", "kPa")),
        ("Total vertical stress, σv (psi)", ("sigma_a", "total", "psi")),
        ("axiale Dehnung ε_1 in %", ("eps_a", "", "percent")),
        ("Sättigungsgrad S_w", ("S_w", "", "")),
        ("(σ1-σ3) [MPa]", ("q", "", "MPa")),
        ("Anfangsporenzahl e_0 [-]", ("e_0", "", "")),
        ("sigma'_3_kPa", ("sigma_r", "effective", "kPa")),
        ("eps_v_percent_derived", ("eps_v", "", "percent")),
    ):
        found = head_of(head, "drained")
        check(f"{head} is understood", (found.quantity, found.state, found.unit) == wanted, found)


def test_units():
    suctions = np.array([0.5, 4.0, 30.0])  # [kPa]
    for unit, worth in (
        ("cm", 0.0980665),
        ("m", 9.80665),
        ("mm", 0.00980665),
        ("hPa", 0.1),
        ("mbar", 0.1),
        ("kN/m^2", 1),
        ("kN/m²", 1),
        ("kN m-2", 1),
        ("bar", 100),
        ("psf", 0.04788026),
        ("tsf", 95.76052),
        ("kp/cm²", 98.0665),
        ("MPa", 1000),
        ("cm H2O", 0.0980665),
    ):
        for head in (f"suction [{unit}]", f"suction / {unit}", f"Matric suction in {unit}", f"suction_{unit}"):
            test = read_table(written(table(f"{head},S_w", suctions / worth, (1.0, 0.6, 0.1))), "retention")[0]
            check(
                f"{head} is read", np.allclose(test["suction"], suctions, rtol=1e-6), (test["suction"], test.understood)
            )
    for unit, (measures, worth, words) in UNITS.items():
        check(f"{unit}: every spelling is found", all(unit_of(word) == unit for word in (unit, *words.split())), words)
    drained(
        "q / kPa and sigma_3 / tsf",
        written(
            table("eps_a / %,eps_v / %,q / kPa,sigma_3 / tsf,e_0 / -", EPS, VOLUME, Q, CELL / 95.76051796067168, E_0)
        ),
    )
    drained(
        "permille",
        written(
            table(
                "eps_a [‰],eps_v [‰],q_kPa,sigma_3_kPa,e_0",
                tuple(10 * x for x in EPS),
                tuple(10 * x for x in VOLUME),
                Q,
                CELL,
                E_0,
            )
        ),
    )
    columns = EPS, [7 * v for v in VOLUME], VOLUME, Q, CELL, E_0
    test = drained(
        "a volume beside its strain",
        written(table("eps_a_percent,Volume change [cm3],eps_v_percent,q_kPa,sigma_3_kPa,e_0", *columns)),
    )
    check("is not read", ("Volume change [cm3]", "not read") in test.understood, test.understood)
    for head, name in (
        ("suction [furlong]", "furlong"),
        ("suction / ell", "ell"),
        ("suction_lbs", "lbs"),
        ("suction [kN]", "kN"),
        ("suction in inHg", "inHg"),
    ):
        told = refusal(written(f"{head},S_w\n1,1\n5,0.5\n9,0.2\n"), "retention")
        check(
            f"{head}: the unit is called unknown, and the known ones are named",
            f"{name} is no unit that is known" in told
            and "kPa" in told
            and "hPa" in told
            and "cm" in told
            and "pF" in told,
            told,
        )
    told = refusal(written(table(START + "q [cm],sigma_3_kPa,e_0", EPS, VOLUME, Q, CELL, E_0)), "drained")
    check(
        "a unit of something else is refused",
        "cm is a unit that q cannot have" in told and "kN/m2" not in told.split("cannot")[0],
        told,
    )
    told = refusal(
        written(table(START + "sigma_1_kPa,sigma_3_kPa,u [inHg],e_0", EPS, VOLUME, AXIAL, CELL, 3, E_0)), "drained"
    )
    check("of a pore pressure too, which could be overlooked", "inHg is no unit that is known" in told, told)
    for head, wanted in (
        ("q/p'", ""),
        ("P [kN]", ""),
        ("P' [kPa]", "p"),
        ("E [MPa]", ""),
        ("Load (N)", ""),
        ("eta = q/p", ""),
        ("p = (s1+2 s3)/3 [kPa]", "p"),
        ("effective saturation", ""),
        ("p_m", ""),
        ("G/Gmax", "G_ratio"),
        ("Deviator stress, q [kPa]", "q"),
        ("Time [s]", ""),
    ):
        check(
            f"{head} is {wanted or 'not understood'}",
            head_of(head, "drained").quantity == wanted,
            head_of(head, "drained"),
        )


def test_the_sheets_of_a_workbook():
    book = openpyxl.Workbook()
    book.active.title = "cover"
    book.active.append(["Tests of the campaign", "in 2024"])
    for name, factor in (("CD 1", 1.0), ("CD 2", 1.1)):
        sheet = book.create_sheet(name)
        sheet.append(["eps_a_percent", "eps_v_percent", "q_kPa", "sigma_3_kPa", "e_0"])
        for a, v, q in zip(EPS, VOLUME, Q):
            sheet.append([a, v, factor * q, CELL, E_0])
    sheet = book.create_sheet("oedometer")
    for row in (["sigma_a_kPa", "e"], [10, 0.8], [20, 0.79], [40, 0.78]):
        sheet.append(row)
    book.save(work / "campaign.xlsx")
    tests = read_table(work / "campaign.xlsx", "drained")
    check(
        "every sheet with a test is read, and called by its title",
        [t.name for t in tests] == ["CD 1", "CD 2"] and np.allclose(tests[1]["q"], 1.1 * np.array(Q)),
        tests,
    )
    drained(
        "the first of them",
        work / "campaign.xlsx",
        ("the sheets CD 1, CD 2 is a table each; not read: cover (no eps_a), oedometer (no eps_a)",),
    )
    test = read_table(work / "campaign.xlsx", "oedometer")[0]
    check("of another kind the other sheet", test.name == "campaign" and test["sigma_a"].tolist() == [10, 20, 40], test)
    sheet = book["CD 2"]
    sheet["A4"] = "2O"
    book.save(work / "campaign.xlsx")
    told = refusal(work / "campaign.xlsx", "drained")
    check("a mistake is named with its sheet and line", "sheet CD 2:4: eps_a_percent = '2O'" in told, told)
