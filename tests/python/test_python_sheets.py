# SPDX-License-Identifier: MIT
"""Sheets as laboratories write them: separators, decimal commas, workbooks, heads in words, missing void ratios."""

import os
import sys

import numpy as np

from checking import build, check, needs_plain_library, root, work

needs_plain_library()
os.environ["MUD_LIBRARY_DIR"] = str(build)
os.environ["MPLBACKEND"] = "Agg"
sys.path[:0] = [str(root / "python")]
import mud  # noqa: E402
from mud.calibration import Effort, calibrate, evaluate, make_task, read_table, write_report  # noqa: E402

PLAIN = "test,eps_a_percent,eps_v_percent,q_kPa,p_kPa,e\n"
ROWS = ((0, 0, 0, 100, 0.8), (5, -1, 200, 500 / 3, 0.818), (10, -2, 250, 550 / 3, 0.836), (20, -3, 240, 180, 0.854))


def same(name, test, **others):
    """Whether a test is that of ROWS; others: columns by name."""
    wanted = dict(zip(("eps_a", "eps_v", "q", "p", "e"), np.array(ROWS).T))
    wanted["eps_a"], wanted["eps_v"] = wanted["eps_a"] / 100, wanted["eps_v"] / 100
    off = {k: np.max(np.abs(test[k] - v)) for k, v in {**wanted, **others}.items() if k in test}
    check(name, {"eps_a", "q", "p"} <= set(off) and max(off.values()) < 1e-9, (off, test.understood))


def written(text, name="sheet.csv", encoding="utf-8"):
    (work / name).write_bytes(text.encode(encoding))
    return work / name


def refusal(action):
    """The sentence of a refusal, or nothing."""
    try:
        action()
    except mud.InputError as problem:
        return str(problem)
    return ""


def body(mark=",", row=lambda r: r, point="."):
    return "".join("A" + mark + mark.join(f"{x:.12g}".replace(".", point) for x in row(r)) + "\n" for r in ROWS)


# Workbooks.
import openpyxl  # noqa: E402


def test_of_a_plain_table_nothing_had_to_be_understood():
    test = read_table(written(PLAIN + body()), "drained")[0]
    same("a plain table is read", test)
    check("of a plain table nothing had to be understood", test.understood == [], test.understood)
    test = read_table(written((PLAIN + body(point="#")).replace(",", ";").replace("#", ",")), "drained")[0]
    same("semicolons and decimal commas are read", test)
    check("and told", any("semicolons" in given for given, _ in test.understood), test.understood)
    same("tabs are read", read_table(written((PLAIN + body()).replace(",", "\t")), "drained")[0])
    words = ("Sample;Axial strain (%);Volumetric strain [%];Deviator stress (MPa);Mean effective stress (bar);"
             "Void ratio;;\n")
    heads = "Laboratory of soil;;;\n;;;\nProject 12;dry;;\n\n" + words
    mega = body(";", lambda r: (r[0], r[1], r[2] / 1000, r[3] / 100, r[4]), ",").replace("\n", ";;\n\n;;;;;;\n")
    test = read_table(written(heads + mega), "drained")[0]
    same("heads in words, MPa and bar, blank rows and columns and lines above are read", test)
    told = dict(test.understood)
    check(
        "and the user can check each of them",
        told["Deviator stress (MPa)"] == "q in MPa" and told["Axial strain (%)"] == "eps_a in %" and len(told) >= 7,
        told,
    )
    units = "test,eps_a,eps_v,q,p,e\n,%,%,kPa,kPa,-\n"
    same("a line of units below the names is read", read_table(written(units + body()), "drained")[0])
    letters = "Probe1,ε1 [%],εv [%],σ'1 [kPa],σ'3 [kPa],e\n".replace("Probe1", "test")
    stresses = body(row=lambda r: (r[0], r[1], 100 + r[2], 100, r[4]))
    test = read_table(written(letters + stresses), "drained")[0]
    same("sigma_1 and sigma_3 without q give q and p", test, sigma_r=100.0)
    check("which is told", any("q = sigma_1 - sigma_3" in meant for _, meant in test.understood), test.understood)
    shares = "test,Axial strain [-],eps_v,q,p,e\n" + body(row=lambda r: (r[0] / 100, r[1] / 100, *r[2:]))
    same("fractions stay fractions", read_table(written(shares), "drained")[0])
    test = read_table(
                      written(
                          "Sample,Axial strain (%),q (kPa),p' (kPa),e\n" +
                          body(row=lambda r: (r[0],
                                             *r[2:])).replace("A", "Prüfung"),
                          encoding="cp1252"),
                      "drained") [0]
    same("letters of Windows are read", test)
    check("a name with them too", test.name == "Prüfung", test.name)

    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "CD tests"
    for row in (["Triaxial tests"], [], words.strip(";\n").split(";"), []):
        sheet.append(row)
    for r in ROWS:
        sheet.append(["A", r[0], r[1], r[2] / 1000, r[3] / 100, r[4]])
    book.create_sheet("notes").append(["nothing"])
    book.save(work / "lab.xlsx")
    test = read_table(work / "lab.xlsx", "drained")[0]
    same("a workbook is read", test)
    unread = any("not read: notes" in meant for _, meant in test.understood)
    check("what was not read of it is told", unread, test.understood)
    told = refusal(lambda: read_table(written("no workbook", "bad.xlsx"), "drained"))
    check("what is no workbook is refused", "no workbook" in told, told)


def test_numbers_as_spreadsheets_write_them():
    large = [(0, 0, 0, 3000, "0.8"), (5, -1, 1200, 3400, "0.818"), (10, -2, "1500.5", 3500, "0.836"),
             (20, -3, 1400, 3467, "0.854")]
    wanted = ([0, 1200, 1500.5, 1400], [3000, 3400, 3500, 3467])

    def read(changes, separator=";", quote=""):
        text = PLAIN.replace(",", separator)
        for row in large:
            line = separator.join(f"{quote}{cell}{quote}" for cell in ("A", *row))
            for old, new in changes:
                line = line.replace(old, new)
            text += line + "\n"
        test = read_table(written(text), "drained")[0]
        return (test["q"].tolist(), test["p"].tolist()), [meant for _, meant in test.understood]

    check("1500.5 is read", read([])[0] == wanted, read([]))
    numbers, told = read([(".", ","), ("1200", "1.200"), ("1500,5", "1.500,5"), ("3500", "3.500")])
    good = numbers == wanted and "between thousands" in told
    check("points between thousands, decimal commas", good, (numbers, told))
    numbers, told = read([("1200", "1,200"), ("1500.5", "1,500.5"), ("3500", "3,500")])
    good = numbers == wanted and "between thousands" in told
    check("commas between thousands, decimal points", good, (numbers, told))
    numbers, told = read([(".", "#"), ("#", ",")], ",", '"')
    check("decimal commas within quotes", numbers == wanted and "decimal marks" in told, (numbers, told))
    numbers, told = read([("1200", "1.200")])
    check("1.200 beside 1500.5 is 1.2", numbers[0][1] == 1.2 and "between thousands" not in told, (numbers, told))
    test = read_table(written((PLAIN + body()).replace(",", "\t"), encoding="utf-16"), "drained")[0]
    same("Excel's Unicode text is read", test)
    check("and told", ("letters", "UTF-16") in test.understood, test.understood)
    psi = 6.894757293168361
    pounds = PLAIN.replace("kPa", "psi") + body(row=lambda r: (r[0], r[1], r[2] / psi, r[3] / psi, r[4]))
    same("pounds per square inch are read", read_table(written(pounds), "drained")[0])
    book = openpyxl.Workbook()
    book.active.append(["test", "eps_a_percent", "eps_v_percent", "q_kPa", "p_kPa", "e"])
    for r in ROWS:
        book.active.append(["A", *r[:4], str(r[4]).replace(".", ",")])
    book.save(work / "text.xlsx")
    test = read_table(work / "text.xlsx", "drained")[0]
    same("cells of text with decimal commas in a workbook", test)
    check("which is told", any("decimal commas" in meant for _, meant in test.understood), test.understood)


def test_sheets_with_merged_cells_and_columns_that_are_not_read():
    head = "Probe,eps_a_percent,eps_v_percent,q_kPa,sigma_3_kPa,e_0,operator\n"
    rows = "".join(
        f"{name if i == 0 else ''},{a},{v},{q},{100 if i == 0 else ''},{0.8 if i == 0 else ''},me\n"
        for name in "AB" for i, (a, v, q, _, _) in enumerate(ROWS)
    )
    tests = read_table(written(head + rows), "drained")
    check("a name, a stress and a void ratio in the first row of a test", [t.name for t in tests] == ["A", "B"], tests)
    for test in tests:
        same(f"are those of its other rows, {test.name}", test, sigma_r=100.0, e_0=0.8)
    told = dict(tests[0].understood)
    check("they are told, and what is not read", told.get("operator") == "not read" and told["Probe"] == "test, no unit"
          and "the same in its other rows" in told.values(), told)
    measured = "sigma_a_kPa,sigma_r_kPa,e\n10,5,.8\n50,,.79\n100,,.78\n"
    told = refusal(lambda: read_table(written(measured), "oedometer"))
    check("a radial stress that is measured must be there", "sheet.csv:3: sigma_r_kPa = ''" in told, told)

    # Compression as the apparatus tells it.
    oed = read_table(written("sigma_a_kPa,eps_a_percent,e_0\n10,0,0.8\n100,.5,\n200,1.2,\n50,1.1,\n"), "oedometer")[0]
    off = np.abs(oed["e"] - [0.8, 0.791, 0.7784, 0.7802])
    check("void ratios of an oedometer's strain", off.max() < 1e-12, oed["e"])
    iso = read_table(written("p_kPa,eps_v,e_0\n10,0,0.8\n100,.01,\n200,.02,\n"), "isotropic")[0]
    check("void ratios of volumetric strain", np.allclose(iso["e"], [0.8, 0.782, 0.764], atol=1e-12), iso["e"])
    told = refusal(lambda: read_table(written("sigma_a_kPa,eps_a_percent\n10,0\n100,.5\n200,1.2\n"), "oedometer"))
    check("a strain without a void ratio is refused", "give e_0 too" in told, told)
    told = refusal(lambda: read_table(written("sigma_a_kPa,eps_a,e_0\n10,0,.8\n100,.5,\n200,1.2,\n"), "oedometer"))
    check("per cent without the unit too", "eps_a_percent" in told, told)


def test_total_stresses_less_the_pore_pressure_are_effective_e_0_is_the():
    # Undrained: total stresses and a pore pressure; e_0 in place of e.
    head = "test,eps_a_percent,sigma_1_kPa,sigma_3_kPa,u_kPa,e_0\n"
    rows = ((0, 200, 200, 100), (1, 240, 200, 140), (5, 260, 200, 150), (10, 280, 200, 145))
    test = read_table(written(head + "".join(f"U,{a},{s},{t},{u},0.8\n" for a, s, t, u in rows)), "undrained")[0]
    check(
        "total stresses less the pore pressure are effective, e_0 is the void ratio of every row",
        np.allclose(test["p"], [100, 240 / 3 + 400 / 3 - 140, 260 / 3 + 400 / 3 - 150, 280 / 3 + 400 / 3 - 145])
        and np.allclose(test["q"], [0, 40, 60, 80])
        and np.allclose(test["e"], 0.8)
        and any("u is taken off" in meant for _, meant in test.understood),
        (test["p"], test.understood),
    )
    check("S_w in per cent with its unit is read", read_table(
        written("Suction [kPa],Degree of saturation (%)\n1,98\n5,60\n10,20\n"), "retention")[0]["S_w"][0] == 0.98)
    for head in ("Sr [%]", "S_r (%)", "sr_percent"):
        wet = read_table(written(f"Suction [kPa],{head}\n1,98\n5,60\n10,20\n"), "retention")[0]
        check(f"{head} of a retention table is S_w", wet["S_w"].tolist() == [0.98, 0.6, 0.2], wet.columns)
    ratio = "test,eps_a_percent,eps_v_percent,sr,sigma_r_kPa,e\n"
    ratio += body(row=lambda r: (*r[:2], 1 + r[2] / 100, 100, r[4]))
    same("sr of a shear test is the stress ratio", read_table(written(ratio), "drained")[0])
    told = refusal(lambda: read_table(written("suction_kPa,e_percent,S_w\n1,80,1\n2,80,.9\n3,80,.8\n"), "retention"))
    check("a unit that a void ratio cannot have is still refused", "e_percent" in told, told)
    told = refusal(lambda: read_table(written(PLAIN.replace("q_kPa", "load (N)") + body()), "drained"))
    check("a head that nobody understands is still refused", "needs the column q" in told and "load (N)" in told, told)
    told = refusal(lambda: read_table(written("\0\1\2"), "drained"))
    check("what is no text is refused", "no text" in told, told)


def test_its_prior_is_the_mean_of_the_others():
    # A missing void ratio is an unknown of the fit: the one of the sample that the model made comes back.
    sand, lines = mud.Material("toyoura"), ["test;eps_a_percent;eps_v_percent;q_kPa;p_kPa;e_0"]
    for name, e in (("A", 0.75), ("B", 0.9), ("C", 0.82)):
        run = mud.element_test(
            sand, mud.Stage("drained", eps_a_end=0.2, increment=2e-3, output_interval=2e-2), p_eff=100.0, void_ratio=e
        )
        lines += [
            f"{name};{100 * a:.8f};{100 * v:.8f};{q:.6f};{100 + q / 3:.6f};{'' if name == 'C' else e}"
            for a, v, q in zip(run.axial_strain, run.volumetric_strain, run["q"])
        ]
    path = written("\n".join(lines).replace(".", ","))
    names = ("M_c", "N_c", "lambda", "alpha_csl", "A_0", "G_0", "K_0", "N_l", "n_b", "theta", "n_d", "c_h")
    known = {n: sand[n] for n in names}
    task = make_task("missing", [{"file": path, "kind": "drained"}], start="toyoura", known=known)
    check("its prior is the mean of the others", abs(task.items[2].test.e_0 - 0.825) < 1e-12, task.items[2].test.e_0)
    result = calibrate(task, Effort(samples=1, starts=1, joint=8, members=4), 1, None)
    check(
        "a missing void ratio is found",
        abs(result.values["e_0 of C"] - 0.82) < 2e-3 and abs(result.item("C").test.e_0 - 0.82) < 2e-3,
        result.values,
    )
    check("and told before the fit", any("no void ratio in test C" in note for note in result.notes), result.notes)
    page = write_report(result, work / "page").read_text()
    check(
        "the page has the table of what was understood",
        "understood to say" in page and "| semicolons between cells |" in page and "`e_0 of C`" in page
        and page.count("semicolons between cells") == 1,
        page[:800],
    )
    check("a material is compared with such tests too", len(evaluate(task, "toyoura").misfits) == 3)
    alone = "\n".join(line for line in lines if line[:2] not in ("A;", "B;"))
    told = refusal(lambda: read_table(written(alone), "drained"))
    check("a table without any void ratio is refused", "no test of the table has a void ratio" in told, told)
