# SPDX-License-Identifier: MIT
"""Points of MUD side by side (lanes of &scene), and the points of several elements in one batch."""
import re

from checking import check, root, work
from host_program import ran, start
import tables  # noqa: E402 (checking knows its folder)

# 70 elements, so that two threads share them; three fields, reversal of a displacement that is given.
PUSHED = f"""&scene name = 'pushed' geometry = 'plane_strain' fields = 'u-p_w-p_c' gravity = 9.81 checkpoint_steps = 2 /
&mesh r = 0, 0.5, 1.5 r_cells = 3, 2 z = -1, 0 z_cells = 7 z_ratio = 0.8 /
&mud name = 'sand' file = '{root}/drivers/materials/toyoura.nml' /
&permeability name = 'k' intrinsic = 1e-10 /
&region material = 'sand' retention = 'mud' permeability = 'k' void_ratio = 0.8 /
&initial p_w = -10 p_c = 10 stress = 'geostatic' k_0 = 0.5 surcharge = 5 /
&history name = 'ramp' times = 0, 0.4, 0.6 values = 0, 0.4, 0.3 /
&stage name = 'push' analysis = 'quasi_static' duration = 0.6 dt = 0.2 cuts = 0 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top_1' field = 'u_z' value = -0.002 history = 'ramp' /
&load group = 'top_2' kind = 'pressure' value = 5 /
&point name = 'edge' r = 0.5 z = 0 /
"""
NO_EFFECT = "lanes of &scene has no effect"
FILES = ("histories.csv", "points_push.csv")


def with_(text, *keys):
    return text.replace("&scene", f"&scene {' '.join(keys)}", 1)


def answers(name):
    return [(work / name / file).read_bytes() for file in FILES]


def test_lanes_give_the_answer_of_points_one_by_one_on_any_number_of_threads_and_after_a_restart():
    one, lanes, two = PUSHED, with_(PUSHED, "lanes = 'yes'"), with_(PUSHED, "lanes = 'yes'", "threads = 2")
    done = start("lanes", lanes)
    check("lanes run", done.returncode == 0, done.stderr)
    if not (ran("one", one) and ran("two", two)):
        return
    # Updates agree to 1e-14 of their stress; a step of Newton's method, here to 1e-6 of the forces, multiplies that by
    # the condition of the equations, some 1e4.
    for file in FILES:
        rows = [tables.numbers(work / name / file) for name in ("one", "lanes")]
        largest = {key: max(abs(row[key]) for row in rows[0]) for key in rows[0][0]}
        apart = max(abs(a[key] - b[key])/(largest[key] or 1) for a, b in zip(*rows) for key in largest)
        check(f"{file}: lanes give the answer of points one by one", len(rows[0]) == len(rows[1]) and apart <= 1e-9,
              apart)
    # Where lanes act digits move; where they cannot the reader is told.
    check("lanes act or are told to have no effect",
          (answers("one") == answers("lanes")) == (NO_EFFECT in done.stderr), done.stderr)
    check("two threads give the same bytes", answers("lanes") == answers("two"))
    whole = answers("lanes")
    if ran("lanes", lanes, "--restart", work / "lanes" / "checkpoint.h5"):
        check("a restart gives the same bytes", answers("lanes") == whole)


def test_lanes_that_no_material_has_are_told():
    elastic = re.sub(r"&mud .*", "&elastic name = 'sand' young = 1e4 poisson = 0.2 /", with_(PUSHED, "lanes = 'yes'"))
    elastic = elastic.replace("fields = 'u-p_w-p_c'", "fields = 'u'")
    elastic = elastic.replace("retention = 'mud' permeability = 'k' ", "").replace("p_w = -10 p_c = 10 ", "")
    done = start("elastic", elastic, "--check")
    check("no region is of &mud", done.returncode == 0 and NO_EFFECT in done.stderr, done.stderr)
    with_memory = with_(PUSHED, "lanes = 'yes'").replace("toyoura.nml'", "toyoura.nml' hysteresis = 1")
    done = start("hysteresis", with_memory, "--check")
    check("no region is of a &mud with lanes", done.returncode == 0 and NO_EFFECT in done.stderr, done.stderr)
    check("without the key nothing is said", NO_EFFECT not in start("quiet", PUSHED, "--check").stderr)


def test_the_first_point_that_fails_is_told_wherever_it_stands_in_its_batch():
    # Elements and points as a program tells that updates one element after another. A strain beyond 1 is told before
    # any law is asked.
    for value, keys, place in ((1, "", "element 44, point 5, refuses"),
                               (1, "lanes = 'yes'", "element 44, point 5, refuses"),
                               (2, "threads = 2", "element 11, point 1, refuses"),
                               (3, "", "element 1, point 2, is strained")):
        text = PUSHED.replace("value = -0.002", f"value = -{value}").replace("dt = 0.2", "dt = 0.4")
        done = start("fails", with_(text, keys))
        check(f"{value} m, {keys}: the point is told", done.returncode > 0 and place in done.stderr, done.stderr)
