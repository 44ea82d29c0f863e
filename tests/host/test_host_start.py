# SPDX-License-Identifier: MIT
"""Whether a scene begins in balance: the stress of layers and slopes, and what is told of a start that is not."""
import re

from checking import check, root, work
from host_program import start
import tables  # noqa: E402 (checking knows its folder)

LAYERS = """&scene name = 'layers' geometry = 'plane_strain' gravity = 10 fields = '{fields}' /
&mesh r = 0, 1, 2 r_cells = 1, 1 z = -3, -2, -0.5, 0 z_cells = 2, 3, 1 /
&elastic name = 'e' young = 1e4 poisson = 0.3 /
&permeability name = 'k' intrinsic = 1e-12 /
&region material = 'e' void_ratio = 0.5 rho_s = 3 permeability = 'k' /
&region group = 'block_1_2' material = 'e' void_ratio = 1 rho_s = 3 permeability = 'k' /
&region group = 'block_2_2' material = 'e' void_ratio = 1 rho_s = 3 permeability = 'k' {stages} /
&initial stress = 'geostatic' k_0 = 0.4 surface = 0 surcharge = 2 {water} /
&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 zero_displacements = 'yes' /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 2 /
&point name = 'deep' r = 0.5 z = -3 /
"""


def scene(fields="u", water="", stages="", *pairs):
    text = LAYERS.format(**locals())
    for old, new in pairs:
        check(f"the scene has {old!r}", old in text)
        text = text.replace(old, new)
    return text


def told(done):
    return [line for line in done.stderr.splitlines() if "not in balance" in line]


def test_the_weights_of_layers_are_summed():
    # Densities 3/1.5 = 2 above and below, 3/2 = 1.5 in the middle: 2 + 10 (0.5 2 + 1.5 1.5 + d 2) at a depth d below
    # the middle; with water the pores have 1/3 and 1/2 of it.
    for fields, water, above, below in (("u", "", 2 + 10*(0.5*2 + 1.5*1.5), 20), (
            "u-p_w", "p_w_slope = -10", 2 + 10*(0.5*(2 + 1/3) + 1.5*(1.5 + 1/2)), 10*(2 + 1/3))):
        done = start("layers", scene(fields, water))
        check(f"layers of {fields} run without a word", done.returncode == 0 and not told(done), done.stderr)
        rows = tables.columns(work / "layers/histories.csv")
        # At the quadrature point nearest to the bottom; the pressure there is 10 times its depth.
        for row in (0, 1):
            depth = (rows["deep.s_zz"][row]*-1 - above + (20 if water else 0))/(below - (10 if water else 0))
            check(f"{fields}: the stress below three layers, row {row}", 0.75 < depth < 1, rows["deep.s_zz"])
        check(f"{fields}: nothing moves", max(abs(rows["deep.s_zz"][1] - rows["deep.s_zz"][0]),
                                              abs(rows["deep.s_rr"][1] - rows["deep.s_rr"][0])) < 1e-9, rows)


def test_a_layer_that_has_its_own_surface_is_as_it_was():
    # Surfaces and surcharges of the layers by hand say the same.
    by_hand = scene("u", "", "", ("&initial stress = 'geostatic' k_0 = 0.4 surface = 0 surcharge = 2  /",
                                  "&initial stress = 'geostatic' k_0 = 0.4 surface = 0 surcharge = 2 /\n" + "".join(
        f"&initial group = 'block_{i}_{j}' stress = 'geostatic' k_0 = 0.4 surface = {s} surcharge = {q} /\n"
        for i in (1, 2) for j, s, q in ((2, -0.5, 12), (1, -2, 34.5)))))
    done = start("by_hand", by_hand)
    check("by hand runs without a word", done.returncode == 0 and not told(done), done.stderr)
    start("layers", scene())
    one, two = (tables.columns(work / name / "histories.csv")["deep.s_zz"][0] for name in ("by_hand", "layers"))
    check("the same stress", abs(one - two) < 1e-10, (one, two))


def test_ground_that_is_not_there_does_not_weigh():
    # The middle of the right column joins later: below it weigh 0.5 m of the top, 0.75 to 1 m of what is there.
    later = scene("u", "", "stages = 'later'", ("&initial stress", "&initial group = 'block_1_1' stress"),
                  (" zero_displacements = 'yes' /",
                   " /\n&stage name = 'later' analysis = 'static' duration = 1 dt = 1 /"),
                  ("r = 0.5 z = -3", "r = 1.5 z = -3"))
    done = start("later", later + "&initial group = 'block_2_1' stress = 'geostatic' surface = 0 /\n")
    check("the layer that joins later runs", done.returncode == 0, done.stderr)
    found = -tables.columns(work / "later/histories.csv")["deep.s_zz"][0]
    check("what is not there weighs nothing", 10 + 0.75*20 < found < 10 + 20, found)


def test_what_is_told_of_a_start_that_is_not_in_balance():
    for what, pairs, words in (
            ("a surface 1 m too high", [("surface = 0", "surface = 1")], ["20 kPa away", "Stage rest begins"]),
            ("a surcharge without its load", [("value = 2", "value = 0")], ["2 kPa away", "(0", ", 0) m"]),
            ("a load that is more than the surcharge", [("value = 2", "value = 5")], []),
            ("a load that grows from the surcharge", [("value = 2", "value = 2 history = 'h'"),
             ("&point", "&history name = 'h' times = 0, 1 values = 1, 9 /\n&point")], None)):
        for more in (["--check"], []):
            done = start("told", scene("u", "", "", *pairs), *more)
            lines = told(done)
            check(f"{what} {more}: runs", done.returncode == 0, done.stderr)
            check(f"{what} {more}: told", len(lines) == (0 if words is None else 1)
                  and all(word in lines[0] for word in words or []), done.stderr)
    # The stage zeroes its displacements: the histories show nothing of it, the warning does.
    loads = scene("u", "", "", ("&initial stress", "! &initial stress"))
    check("a static stage finds the balance where no stress is given", not told(start("none", loads)))
    done = start("waves", loads.replace("analysis = 'static'", "analysis = 'dynamic'").replace(
        "&fix group = 'bottom' field = 'u_z' /", "&absorbing group = 'bottom' /"), "--check")
    check("weight on dashpots is told", len(told(done)) == 1 and "dashpots of &absorbing hold no weight" in done.stderr,
          done.stderr)


def test_a_slope_begins_in_balance_as_the_page_says():
    page = (root / "docs/how-to/start.md").read_text(encoding="utf-8")
    lines = re.search(r"^## A slope$.*?^```\n(.*?)^```", page, re.MULTILINE | re.DOTALL)[1]
    text = f"""&scene name = 'slope' geometry = 'plane_strain' gravity = 9.81 /
&mesh file = '{root}/verification/host/seepage_face/slope.msh' /
&mud name = 'sand' file = '{root}/drivers/materials/toyoura.nml' /
&region material = 'sand' void_ratio = 0.75 rho_s = 2.65 /
&stage name = 'wait' analysis = 'static' duration = 1 dt = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&point name = 'crest' r = 6 z = 4 /
"""
    moved = {}
    for name, of_page in (("slope", lines), ("level", lines.replace("column = 'ground'", "surface = 4"))):
        done = start(name, text.replace("&stage", of_page + "&stage", 1))
        check(f"{name} runs", done.returncode == 0, done.stderr)
        moved[name] = told(done), tables.columns(work / name / "histories.csv")
    check("columns that follow the slope are nearly in balance",
          re.search(r" 1\d\.?\d* % of", "".join(moved["slope"][0])), moved["slope"][0])
    check("those of the level of the crest are not", re.search(r" 8\d\.?\d* % of", "".join(moved["level"][0])),
          moved["level"][0])
    rows = moved["slope"][1]
    check("the stage finds the balance", abs(rows["crest.s_rr"][1] - rows["crest.s_rr"][0]) > 0.1, rows["crest.s_rr"])
    check("nothing moves afterwards", abs(rows["crest.u_r"][-1]) + abs(rows["crest.u_z"][-1]) < 1e-6, rows["crest.u_r"])
