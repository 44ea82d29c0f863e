# SPDX-License-Identifier: MIT
"""Texts: what the package writes it reads, and it reads every material file that mud_triax reads."""

import os
import subprocess
import sys

import numpy as np

from checking import build, check, needs_plain_library, root, work

needs_plain_library()
os.environ["MUD_LIBRARY_DIR"] = str(build)
os.environ["MPLBACKEND"] = "Agg"
sys.path[:0] = [str(root / "python")]
import mud  # noqa: E402
from mud.calibration import Effort, calibrate, make_task, read_task, write_material  # noqa: E402
from mud.namelist import quoted  # noqa: E402

STAGE = "&initial p_eff = 80 void_ratio = 0.8 /\n&stage control = 'undrained' eps_a_end = 0.002 /\n"
BODY = "&material\n   name = {name}\n   G_0 = 111.0   ! kept\n   h_0 = 7.5d0\n/\n"
NAMES = ("Terzaghi's clay", 'sand of 3 "feet"', """both ' and " marks""", "Größe & Höhe = 3 / 4 ! no comment", "", "77")


def driven(file):
    """(whether mud_triax takes a material file, what it calls the material, its last row)."""
    (work / "texts.nml").write_text(f"&material file = '{file.name}' /\n{STAGE}")
    done = subprocess.run([build / "drivers/mud_triax", work / "texts.nml", "--quiet", "--output", work / "texts.csv"],
                          capture_output=True)
    if done.returncode:
        return False, done.stderr, None
    text = (work / "texts.csv").read_bytes()
    title = next(line for line in text.splitlines() if line.startswith(b"# material: "))[12:]
    return True, title, [float(x) for x in text.splitlines()[-1].split(b",")]


def same_as_mud_triax(what, file):
    taken, title, row = driven(file)
    sand = mud.Material(file)
    run = mud.element_test(sand, mud.Stage("undrained", eps_a_end=0.002), p_eff=80.0, void_ratio=0.8)  # CSV: 16 digits
    check(f"{what}: mud_triax reads it", taken, title)
    ours = [run[name][-1] for name in ("eps_a", "eps_v", "p_eff", "q", "e")]
    check(f"{what}: Python reads the same", np.allclose(ours, row[:5], rtol=2e-15, atol=0), (ours, row[:5]))
    return sand


def test_python_reads_what_mud_triax_reads():
    for what, text, encoding in (
        ("a byte-order mark", BODY, "utf-8-sig"),
        ("letters in Latin-1", "! Prüfstand Weißbach\n" + BODY, "latin-1"),
        ("capital letters", BODY.replace("material\n   name", "MATERIAL Name").replace("G_0", "g_0"), "utf-8"),
        ("commas, one line", BODY.replace("   ! kept", ",").replace("\n", " ") + "\n", "utf-8"),
        ("a word in capitals", BODY.replace("h_0", "memory_rule = CLASSIC h_0"), "utf-8"),
        ("numbers between quotes", BODY.replace("111.0", "'111.0'"), "utf-8"),
        ("ends of lines of Windows", BODY.replace("\n", "\r\n"), "utf-8"),
    ):
        file = work / "material.nml"
        file.write_bytes(text.format(name='"Weald\'s"').encode(encoding))
        sand = same_as_mud_triax(what, file)
        check(f"{what}: values and name", (sand["G_0"], sand["h_0"], sand.title) == (111.0, 7.5, "Weald's"), sand)
    for text in ("&material name = 'open\n G_0 = 1 /\n", "&material G_0 = 100 g_0 = 120 /\n", "&material G_0 = 1_0 /\n",
                 "&material G_0 = inf /\n", "&material G_0 = 100 120 /\n", "G_0 = 3 &material /\n",
                 "&material G_0 = 100\n", "&soil G_0 = 100 /\n", ""):
        (work / "wrong.nml").write_text(text)
        try:
            mud.Material(work / "wrong.nml")
            told = ""
        except mud.InputError as problem:
            told = str(problem)
        check(f"what mud_triax refuses is refused: {text.strip()!r}", told and not driven(work / "wrong.nml")[0], told)


def test_every_text_that_is_written_is_read_again():
    for name in NAMES:
        file = work / "written.nml"
        file.write_text(BODY.format(name=quoted(name)), encoding="utf-8")
        sand = same_as_mud_triax(repr(name), file)
        check(f"the name {name!r} comes back", sand.title == name, sand.title)
        stage = mud.Stage("drained", eps_a_end=1e-3)
        remarks = mud.element_test(sand, stage, p_eff=50.0, void_ratio=0.8, name=name or "t").remarks
        check("also from a test", f"material: {name}".strip() in map(str.strip, remarks), remarks)
    check("lines become one", quoted("a\nb") == "'a b'", quoted("a\nb"))
    long = quoted("ü" * 300, 200)
    check("a text is cut between letters", long == "'" + "ü" * 100 + "'", long)


def test_a_fitted_material_with_an_apostrophe_is_read_again():
    (work / "quoted.csv").write_text("p_kPa,e,G_max_MPa\n100,0.8,90\n200,0.79,130\n")
    task = make_task("quoted", [{"file": work / "quoted.csv", "kind": "stiffness"}],
                     title="Casagrande's sand", reference='D\'Appolonia & "others" (1968)')
    written = write_material(calibrate(task, Effort(samples=1, starts=1, joint=2, members=0), 1, None), work / "quoted")
    check("it is read", mud.Material(written).title == "Casagrande's sand (fitted)", written.read_text()[:400])
    check("mud_triax reads it too", driven_elsewhere(written), written.read_text()[:400])


def test_a_task_is_read_in_any_letters():
    for encoding in ("utf-8-sig", "latin-1"):
        text = "title = 'Sand der Düne'\n[[tables]]\nfile = 'task.csv'\nkind = 'stiffness'\n"
        (work / "task.toml").write_bytes(text.encode(encoding))
        (work / "task.csv").write_bytes("test,p_kPa,e,G_max_MPa\nDüne,100,0.8,90\n".encode(encoding))
        task = read_task(work / "task.toml")
        check(f"in {encoding}", (task.title, task.items[0].test.name) == ("Sand der Düne", "Düne"), task)


def driven_elsewhere(file):
    case = file.parent / "case.nml"
    case.write_text(f"&material file = '{file.name}' /\n{STAGE}")
    command = [build / "drivers/mud_triax", case, "--quiet", "--output", "-"]
    return subprocess.run(command, capture_output=True).returncode == 0


def test_a_result_says_its_texts_in_any_letters():
    # The file of a material in Latin-1 goes through the library as it is.
    (work / "latin.nml").write_bytes("&material name = 'Düne' /\n".encode("latin-1"))
    stage = mud.Stage("drained", eps_a_end=1e-3)
    run = mud.element_test({"file": work / "latin.nml"}, stage, p_eff=50.0, void_ratio=0.8)
    check("the remark is readable", "material: Düne" in run.remarks, run.remarks)


def test_cycles_are_counted_on_within_each_stage():
    from mud.plots import values_of
    stage, cycle = np.array([0, 1, 1, 1, 2, 2, 2.0]), np.array([0, 1, 1, 2, 1, 1, 2.0])
    counted = values_of({"stage": stage, "cycle": cycle}, "cycle")
    check("every cycle ends at a whole number", counted.tolist() == [0, 0.5, 1, 2, 0.5, 1, 2], counted)
