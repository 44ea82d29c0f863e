# SPDX-License-Identifier: MIT
"""The Python package: names of the registry, sentences of the library, updates without copies, the driver's tests."""

import ctypes
import inspect
import os
import pickle
import shutil
import signal
import subprocess
import sys
import threading
import types

import numpy as np

from checking import build, check, needs_plain_library, root, work

needs_plain_library()
os.environ["MUD_LIBRARY_DIR"] = str(build)
os.environ.update(MPLBACKEND="Agg", OMP_WAIT_POLICY="passive", OMP_NUM_THREADS="2")
sys.path[:0] = [str(root / "python"), str(root / "common")]
import mud  # noqa: E402
import mud.calibration  # noqa: E402
import tables  # noqa: E402
from mud import _native  # noqa: E402
from mud.plots import panels  # noqa: E402
from mud.study.histories import Histories  # noqa: E402

COMPRESSION = np.array([-100.0, -100.0, -100.0, 0.0, 0.0, 0.0])
SHEAR = np.array([5e-5, 5e-5, -1e-4, 2e-5, 0.0, 0.0])


def refused(kind, action):
    """The sentence of an exception of this kind, or nothing."""
    try:
        action()
    except kind as problem:
        return str(problem)
    return ""


def case_file(name, *, output=work / "case.csv", options=()):
    done = subprocess.run(
        [build / "drivers/mud_triax", root / f"drivers/cases/{name}.nml", "--output", output, "--quiet", *options],
        capture_output=True,
        text=True,
    )
    return done, tables.columns(output) if done.returncode == 0 else {}


# Materials: the library's own sentences.
sand = mud.Material("toyoura", e_0=0.735, memory_rule="classic")
n = 50


class Frame(dict):
    """What to_frame needs of a pandas.DataFrame."""

    attrs: dict = {}


def set_parameter():
    sand.G_0 = 50


def set_item():
    sand["G_0"] = 50

# Every public function and method says what it takes, what it returns and what it is for.


def public():
    """(name, function) of what the package offers."""
    for module in (mud, mud.calibration):
        for name in module.__all__:
            thing = getattr(module, name)
            if inspect.isfunction(thing):
                yield name, thing
            if inspect.isclass(thing):
                for own, member in vars(thing).items():
                    function = member.fget if isinstance(member, property) else member
                    if not own.startswith("_") and inspect.isfunction(function):
                        yield f"{name}.{own}", function


def test_a_parameter_has_unit_range_default_meaning():
    # Registry: the same as the C functions tell, by name and by place.
    entry = mud.parameters["G_0"]
    check(
        "a parameter has unit, range, default, meaning",
        (entry.unit, entry.lower, entry.default) == ("1", 1e-3, 125.0) and "shear modulus" in entry.meaning,
        entry,
    )
    check(
        "places are those of the library",
        all(
            _native.mud.mud_index(which, name.encode()) == registry[name].index
            for which, registry in ((1, mud.parameters), (2, mud.states))
            for name in registry
        ),
    )
    check("every word of memory_rule has its number", mud.parameters["memory_rule"].options["return_point"] == 3.0)
    check("upper and lower case do not matter", mud.parameters["g_0"].name == "G_0" and "nothing" not in mud.parameters)
    told = refused(mud.UnknownName, lambda: mud.states["void_rato"])
    check("an unknown name is told the nearest", "void_ratio" in told and "'" not in told, told)


def test_a_material_of_the_library():
    check("a material of the library", sand["M_c"] ==
          1.25 and sand["memory_rule"] == 0.0 and sand["e_0"] == 0.735, sand)
    told = refused(mud.InputError, lambda: mud.Material("toyoura", G_0=-1.0))
    check(
        "a value out of range has the library's sentence",
        "G_0" in told and "allowed" in told and "shear modulus" in told,
        told,
    )
    told = refused(mud.InputError, lambda: mud.Material("toyora"))
    check("an unknown material is told which there are", "toyoura" in told, told)
    told = refused(mud.InputError, lambda: mud.Material(memory_rule="classical"))
    check("a wrong word is told which there are", "return_point" in told, told)
    check(
    "the others keep their value", {
        k: v for k, v in sand.changed(
            G_0=99.0).items() if v != sand[k]} == {
                "G_0": 99.0})
    text = work / "sand.nml"
    text.write_text(sand.group())
    check("a material that is written is read as it was", dict(mud.Material(text).items()) == dict(sand.items()))
    text.write_text("&material\n G_0 = 1.0\n G_0 = 2.0\n/\n")
    told = refused(mud.InputError, lambda: mud.Material(text))
    check("a value given twice is refused with its line", "sand.nml:3" in told and "twice" in told, told)


def test_the_state_begins_with_the_void_ratio_of_the_material():
    # Updates: those of the C interface, bit by bit, in whatever way they are asked for.
    stress, state = sand.initial_state(COMPRESSION)
    check(
        "the state begins with the void ratio of the material",
        mud.state(state, "void_ratio") == 0.735 and mud.state(state, "fabric").shape == (6,),
    )
    answer = sand.update(stress, state, SHEAR, tangent="consistent")
    direct = np.empty(6), np.zeros(len(mud.states))
    library, material = ctypes.CDLL(str(build / "umat/libmud.so")), np.zeros(_native.mud.mud_prepared_size())
    pointer, number, count = ctypes.c_void_p, ctypes.c_double, ctypes.c_int
    library.mud_prepare.argtypes = [pointer, count, pointer, count, pointer, count]
    library.mud_update.argtypes = [pointer, pointer, pointer, count, pointer, number, count] + 4 * [pointer]
    library.mud_prepare(sand.props.ctypes.data, len(sand.props), material.ctypes.data, len(material), None, 0)
    library.mud_update(
        *(a.ctypes.data for a in (material, stress, state)),
        len(state),
        SHEAR.ctypes.data,
        0.0,
        3,
        *(a.ctypes.data for a in direct),
        None,
        None,
    )
    check(
        "an update is that of mud_update",
        np.array_equal(answer.stress, direct[0]) and np.array_equal(answer.statev, direct[1]),
    )
    check("its report counts", answer.report.n_substep >= 1 and answer.report.status == 0)
    step = 1e-7
    tight = sand.changed(tolerance=1e-9)
    slope = tight.update(stress, state, SHEAR, tangent="consistent").dsig_deps
    # central differences are good to about 1e-5 here: tolerance 1e-9 over a step of 1e-7 of 1e-4 strain
    for j in (0, 3):
        e_j = step * np.eye(6)[j]
        difference = (tight.update(stress, state, SHEAR + e_j).stress - tight.update(stress,
                      state, SHEAR - e_j).stress) / ( 2 * step )
        off = np.max(np.abs(slope[:, j] - difference)) / np.max(np.abs(difference))
        check(f"column {j} of the tangent is the derivative, not its transpose", off < 1e-3, off)
    told = refused(mud.IncrementError, lambda: sand.update(stress, state, 1e5 * SHEAR))
    check("a hard increment has the library's sentence", "too large" in told or "cut" in told, told)
    before = state.copy()
    told = refused(mud.InputError, lambda: sand.update(np.full(6, np.nan), state, SHEAR))
    check(
        "not finite is the caller's mistake, and nothing changes",
        "not finite" in told and np.array_equal(state, before),
        told,
    )
    check("a wrong shape is told", "(3,)" in refused(mud.InputError, lambda: sand.update(stress[:3], state, SHEAR)))
    many = np.tile(stress, (n, 1)), np.tile(state, (n, 1))
    strains = np.ascontiguousarray(SHEAR * np.linspace(0.0, 2.0, n)[:, None])
    batch = sand.update_batch(*many, strains, tangent="continuum", threads=2)
    one = [sand.update(stress, state, strain, tangent="continuum") for strain in strains]
    check(
        "a batch has the bits of single updates, its tangent their order",
        np.array_equal(batch.stress, [o.stress for o in one])
        and np.array_equal(batch.dsig_deps, [o.dsig_deps for o in one])
        and np.array_equal(batch.columns.transpose(0, 2, 1), batch.dsig_deps)
        and np.array_equal(batch.dsw_dpc, [o.dsw_dpc for o in one]),
    )
    out = mud.BatchResponse(*many, columns=np.zeros((n, 6, 6)))
    places = [a.ctypes.data for a in (*many, out.columns)]
    inside = sand.update_batch(*many, strains, tangent="continuum", out=out)
    check(
        "a batch in place writes to the arrays themselves, tangents too",
        inside is out
        and places == [a.ctypes.data for a in (out.stress, out.statev, out.columns)]
        and np.array_equal(many[0], batch.stress)
        and np.array_equal(out.columns, batch.columns)
        and out.dsig_dpc is None,
    )
    told = refused(mud.InputError, lambda: sand.update_batch(many[0][::2], many[1][::2], strains[::2]))
    check("an array that would have to be copied is refused", "contiguous" in told, told)
    strains[3] *= 1e5
    batch = sand.update_batch(*many, strains)
    check(
        "a point that fails keeps what it had",
        batch.failed == 1 and batch.status[3] > 0 and np.array_equal(batch.stress[3], many[0][3]) and batch.sentence(3),
        batch.status[:5],
    )
    strains[7, 4] = np.nan
    batch = sand.update_batch(*many, strains)
    fault = batch.fault()
    check(
        "a batch tells how many failed, the worst, its sentence and the factor",
        (batch.failed, batch.worst, batch.status[7]) == (2, 3, -6)
        and 0.0 < batch.pnewdt < 1.0
        and str(fault).startswith("point 3: strain increment")
        and isinstance(fault, mud.IncrementError),
        fault,
    )
    sent = pickle.loads(pickle.dumps((fault, batch)))
    check(
        "they go to other processes",
        str(sent[0]) == str(fault) and sent[0].report.pnewdt == fault.report.pnewdt and sent[1].worst == 3,
        sent,
    )
    told = refused(mud.InputError, lambda: sand.update(stress, state, strains[7]))
    check("a strain of NaN is told by its component", "strain increment 13 is not finite" in told, told)

    # Points that begin, lists, several materials, suction, total stress, slopes of the present state.
    stresses, suctions = np.tile(COMPRESSION, (4, 1)), np.array([0.0, 10.0, 20.0, 30.0])
    stresses[1] = 0.0
    begun = sand.init_batch(stresses, suctions, np.full(4, 0.7))
    alone = sand.initial_state(stresses[2], 20.0, 0.7)
    check(
        "points begin as alone, and those that are lifted are counted",
        begun.n_lifted == 1 and begun.stress[1, 0] < 0.0 and np.array_equal(begun.statev[2], alone[1]),
        begun,
    )
    other = sand.changed(M_c=1.4)
    ground, kinds = mud.MaterialList([sand, other]), np.array([0, 1, 0, 1], dtype=np.intc)
    for said, word in {
        refused(mud.InputError, lambda: sand.changed(M_c=[1.2])): "M_c = [1.2] is not one number",
        refused(mud.InputError, lambda: sand.converted(-1)): "factor = -1: it is a number above 0",
        refused(mud.InputError, lambda: sand.converted("MPa")): "factor = 'MPa'",
        refused(mud.InputError, lambda: sand.saturation(10.0, [0.8, 80.0])): "void_ratio is 80, allowed 0.01 to 5",
        refused(mud.InputError, lambda: sand.init_batch(stresses.tolist(), points=[0])): "stress must be",
        refused(mud.InputError, lambda: sand.init_batch(stresses, points=[0])): "points must be",
        refused(mud.InputError, lambda: mud.plot_test("a")): "test 1 is 'a'",
    }.items():
        check(f"{word}: refused by the name and the value that were given", word in said, said)
    told = refused(mud.InputError, lambda: mud.MaterialList([sand, sand.converted(1e3)]))
    one_unit = "materials[1] has p_atm = " in told and "one unit" in told
    check("materials of two units of stress are refused", one_unit, told)
    told = refused(mud.InputError, lambda: mud.MaterialList([sand, "toyoura"]))
    check("a name is no material", "materials[1] is 'toyoura'" in told and "mud.Material" in told, told)
    shear, some = np.tile(SHEAR, (4, 1)), np.array([3, 0], dtype=np.intc)
    part = ground.update_batch(begun.stress, begun.statev, shear, points=some, material=kinds)
    whole = other.update_batch(begun.stress, begun.statev, shear)
    check(
        "a list of points, each with its material, and no other",
        np.array_equal(part.stress[3], whole.stress[3])
        and np.array_equal(part.stress[1:3], begun.stress[1:3])
        and not np.array_equal(part.stress[0], whole.stress[0]),
    )
    told = refused(mud.InputError, lambda: ground.update_batch(begun.stress, begun.statev, shear))
    check("several materials without the numbers of the points are refused", "material" in told, told)
    told = refused(mud.InputError, lambda: sand.update_batch(begun.stress, begun.statev, shear, points=some + 1))
    check("a number beyond the points is refused", "4" in told, told)
    check("a number that is too large is told", "there are" in told, told)
    for list_of_points, word in (([0, -1], "the number -1"), ([1, 0, 1], "1 more than once")):
        listed = np.array(list_of_points, dtype=np.intc)
        told = refused(mud.InputError, lambda: sand.update_batch(begun.stress, begun.statev, shear, points=listed))
        check(f"points {list_of_points} are refused", word in told, told)
    wrong = np.array([0, 2, 0, 0], dtype=np.intc)
    told = refused(mud.InputError, lambda: ground.update_batch(begun.stress, begun.statev, shear, material=wrong))
    check("a material that the list does not have is refused", "the number 2; the list has 2" in told, told)
    many = sand.update_batch(begun.stress, begun.statev, shear, threads=10**6)
    one = sand.update_batch(begun.stress, begun.statev, shear, threads=1)
    check("a million threads are as many as there can be", np.array_equal(many.stress, one.stress))
    rows, fixed = np.tile(COMPRESSION, (5, 1)), begun.stress.copy()
    fixed.flags.writeable = False
    for given, result, word in ((rows[:4], rows[1:], "overlaps stress0"), (begun.stress, fixed, "read-only")):
        out = mud.BatchResponse(stress=result, statev=begun.statev.copy())
        told = refused(mud.InputError, lambda: sand.update_batch(given, begun.statev, shear, out=out))
        check(f"a result is refused that is {word}", word in told, told)
    listed, twice, codes = np.arange(4, dtype=np.intc), np.zeros((4, 6)), np.zeros(4, dtype=np.intc)
    codes.flags.writeable = False
    for results, word in (
        ({"status": listed}, "status overlaps list"),
        ({"status": codes}, "status is read-only"),
        ({"dsig_dpc": twice, "dsw_deps": twice}, "dsw_deps overlaps dsig_dpc"),
    ):
        out = mud.BatchResponse(stress=begun.stress.copy(), statev=begun.statev.copy(), **results)
        told = refused(
            mud.InputError, lambda: sand.update_batch(begun.stress, begun.statev, shear, points=listed, out=out)
        )
        check(f"refused: {word}", word in told, told)
    wetter = sand.update_batch(begun.stress, begun.statev, shear, 0.5 * suctions, tangent="consistent")
    kept = sand.update_batch(begun.stress, begun.statev, shear)
    check(
        "suction is that at the end; left out it stays",
        np.array_equal(mud.state(wetter.statev, "suction"), 0.5 * suctions)
        and np.array_equal(mud.state(kept.statev, "suction"), suctions)
        and np.array_equal(sand.update(begun.stress[2], begun.statev[2], SHEAR, 10.0).stress, wetter.stress[2]),
    )
    side = sand.update_batch(begun.stress, begun.statev, shear, 0.5 * suctions, tangent="consistent", lanes=True)
    check(
        "points side by side have the answers of points one by one but for rounding",
        np.allclose(side.stress, wetter.stress, rtol=1e-13, atol=0.0)
        and np.allclose(side.columns, wetter.columns, rtol=1e-9, atol=1e-9 * np.abs(wetter.columns).max()),
    )
    curve = sand.saturation_batch(wetter.statev)
    check( "the degree of saturation of points is that of their update, with its slopes", np.array_equal(
        curve.s_w, mud.state(wetter.statev, "saturation")) and np.array_equal(curve.dsw_dpc, wetter.dsw_dpc), )
    water = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    total = stresses + (sand.saturation(suctions, 0.7) * suctions)[:, None] * water
    start = sand.init_batch(total, suctions, np.full(4, 0.7), total_stress=True)
    ended = sand.update_batch(start.stress, start.statev, shear, 0.5 * suctions, total_stress=True)
    expected = wetter.stress + (mud.state(wetter.statev, "saturation") * 0.5 * suctions)[:, None] * water
    check("total stress is effective stress and its water", np.allclose(ended.stress[2:], expected[2:], rtol=1e-9))
    ahead = sand.tangent_batch(wetter.stress, wetter.statev, shear)
    last, none = (sand.tangent_batch(wetter.stress, wetter.statev, *a) for a in ((), (None, suctions)))
    plain = sand.update_batch(wetter.stress, wetter.statev, 0.0 * shear, tangent="elastic")
    check(
        "slopes of the present state follow the direction, or the last strain whatever suction does",
        np.allclose(ahead.columns, last.columns, rtol=1e-4, atol=1.0)
        and np.allclose(last.columns, none.columns, rtol=1e-3, atol=10.0)
        and np.abs(ahead.columns[2] - plain.columns[2]).max() > 0.05 * plain.columns[2].max(),
    )
    mega = sand.converted(0.001)
    check(
    "a material in another unit of stress",
    mega["p_atm"] == 0.101325 and np.allclose(
        1e3 *
        mega.update(
            *
            mega.initial_state(
                COMPRESSION /
                1e3),
                SHEAR).stress,
                sand.update(
                    *
                    sand.initial_state(COMPRESSION),
                    SHEAR).stress),
                     )
    sand.save_increment(work / "increment.nml", *sand.initial_state(COMPRESSION), SHEAR)
    told = refused(mud.InputError, lambda: sand.save_increment(work / "increment.nml", stress, state, SHEAR))
    check("an increment is saved to a new file", "&material" in (work / "increment.nml").read_text() and told, told)
    check("a material can be sent to another process", np.array_equal(
        pickle.loads(pickle.dumps(sand)).update(stress, state, SHEAR).stress, sand.update(stress, state, SHEAR).stress))
    curve = sand.saturation(np.array([0.0, 10.0]), 0.8)
    closed = np.log(np.e + (10.0 * 0.8**2 / 5.0) ** 2) ** -1.0  # eq. (24), Omega 2, n_x 2, m_x 1, P_a 5
    check("the retention curve is eq. (24)", curve[0] == 1.0 and abs(curve[1] - closed) < 1e-14, curve)


def test_is_the_programs_digit_by_digit():
    # Element tests: the driver's own, every control.
    for name in ("vi_drained_TMD4", "undrained_e735_p100", "lode_simple_shear", "constant_water"):
        done, wanted = case_file(name)
        result = mud.run_case((root / f"drivers/cases/{name}.nml").read_text(), root / "drivers/cases")
        same = all(np.allclose(result[k], wanted[k], rtol=1e-14, atol=0) for k in wanted)
        same &= set(result) - set(wanted) == {"q_mises", "b", "lode"}
        check(f"{name} is the program's, digit by digit", same, done.stderr)
    stages = {
        "drained": {"eps_a_end": 0.01},
        "undrained": {"eps_a_end": 0.01},
        "isotropic": {"p_end": 150.0},
        "oedometer": {"sigma_a_end": 150.0},
        "k0": {"eps_v_end": 0.002},
        "constant_p": {"q_end": 30.0},
        "constant_q": {"p_end": 150.0},
        "simple_shear_drained": {"gamma_end": 0.01},
        "simple_shear_constant_volume": {"tau_end": 10.0},
        "strain_path": {"d_eps": [1e-3, 0, 0, 0, 5e-4, 0]},
        "stress_path": {"d_sigma": [1.0, 2.0, 5.0, 0, 1.0, 0]},
        "constant_net_stress": {"suction_end": 5.0},
        "linear": {**{f"strain_{i}": np.eye(6)[i - 1] for i in range(1, 7)}, "change_3": 1e-3},
    }
    listed = subprocess.run([build / "drivers/mud_triax", "--help"], capture_output=True, text=True).stdout.split(
        "Controls, and"
    )[1]
    named = {line[6:34].strip() for line in listed.splitlines()[1:]}  # of 28 letters
    check("every control of the driver is tried here", named == set(stages), named ^ set(stages))
    for control, keys in stages.items():
        result = mud.element_test(sand, mud.Stage(control, **keys), p_eff=100.0, void_ratio=0.8)
        check(f"{control} runs", len(result["q"]) > 1 and result["control_error"].max() <= 1e-10, result.remarks)
    result = mud.element_test(
    sand,
    mud.Stage(
        "undrained",
        cycle_by="q",
        amplitude=20.0,
        cycles=2,
        increment=1e-4),
        p_eff=100.0,
         void_ratio=0.8 )
    cyclic = result
    check(
        "cycles are counted, and units told",
        result["cycle"].max() == 2 and result.units["q"] == "kPa" and result.meanings["psi"],
    )

    # Wetting under a constant load is a path of suction, whatever leads the stage: the same as constant_net_stress.
    start = {"p_net": 100.0, "void_ratio": 0.9, "suction": 30.0}
    collapse = mud.element_test(sand, mud.Stage("constant_net_stress", suction_end=0.0), **start)
    for control, keys in (
    ("isotropic", {
        "p_end": 100.0}), ("constant_q", {
            "p_end": 100.0}), ("drained", {
                "q_end": 0.0})):
        wetted = mud.element_test(sand, mud.Stage(control, suction_end=0.0, **keys), **start)
        # Isotropic strain or isotropic stress: the same path of an isotropic sample, solved to 1e-10 of the stress.
        check(
            f"wetting in a stage {control} takes the steps of its suction",
            len(wetted["e"]) == len(collapse["e"]) > 30 and abs(wetted["e"][-1] / collapse["e"][-1] - 1) < 1e-6,
            (len(wetted["e"]), wetted["e"][-1], collapse["e"][-1]),
        )
    coarse = mud.element_test(sand, mud.Stage("isotropic", p_end=100.0, suction_end=0.0, increment=10.0), **start)
    check("an increment in kPa counts for suction too", len(coarse["e"]) == 4, len(coarse["e"]))
    saturated = sand.saturation(30.0, 0.9)
    check(
        "a start at net stress has the effective stress of its suction",
        abs(collapse["p_eff"][0] - (100.0 + saturated * 30.0)) < 1e-9 and abs(collapse["s_w"][0] - saturated) < 1e-12,
        collapse["p_eff"][0],
    )
    precise = mud.element_test(
        sand, mud.Stage("drained", eps_a_end=0.02, output_interval=1e-3), p_eff=100.0, void_ratio=0.8, accuracy=1e-3
    )
    exact = mud.element_test(
        sand.changed(tolerance=1e-9), mud.Stage("drained", eps_a_end=0.02, increment=1e-4), p_eff=100.0, void_ratio=0.8
    )
    check(
        "an accuracy is asked for, told and met",
        any("asked 0.1 %" in r for r in precise.remarks)
        and abs(precise["q"][-1] / exact["q"][-1] - 1) < 1e-3
        and abs(precise["eps_v"][-1] - exact["eps_v"][-1]) < 1e-3 * np.ptp(exact["eps_v"]),
        precise.remarks,
    )
    shear = mud.Stage("drained", eps_a_end=0.01)
    for words, given in (
        (("net stress", "tension"), {"p_eff": 10.0, "suction": 50.0}),
        (("2.25", "bounding surface"), {"sigma_a": 250.0, "sigma_r": 25.0}),  # q/p' 2.25
        (("p_eff", "50000"), {"p_eff": 1e5}),
        (("not both",), {"p_eff": 10.0, "p_net": 10.0}),
    ):
        told = refused(mud.InputError, lambda: mud.element_test(sand, shear, void_ratio=0.8, **given))
        check(f"the start {given} is refused", told and all(word in told for word in words), told)
    for stages in ((), ("drained",)):
        told = refused(mud.InputError, lambda: mud.element_test(sand, *stages, p_eff=100.0, void_ratio=0.8))
        check(f"{stages} for stages is refused in a sentence", "mud.Stage" in told, told)
    told = refused(mud.InputError, lambda: sand.initial_state([100.0, 100.0, 100.0, 0.0, 0.0, 0.0]))
    check("compression with the sign of tension is refused", "tension is positive" in told and "-100" in told, told)
    check("nearly no stress is lifted as before", sand.initial_state(np.zeros(6))[0][0] < 0.0)

    told = refused(
        mud.InputError, lambda: mud.element_test(sand, mud.Stage("draned", eps_a_end=0.1), p_eff=100.0, void_ratio=0.8)
    )
    check("a refused case has the driver's sentence", "nearest is drained" in told, told)
    try:
        mud.element_test(sand, mud.Stage("drained", q_end=1e5, increment=20.0), p_eff=100.0, void_ratio=0.8)
        stopped = None
    except mud.TestStopped as problem:
        stopped = problem
    check(
        "a test that stops says where and keeps its rows",
        stopped and "stage 1" in str(stopped) and len(stopped.result["q"]) > 1,
    )
    sent = pickle.loads(pickle.dumps(stopped))
    check("it goes to other processes with them", len(sent.result["q"]) == len(stopped.result["q"]))
    told = refused(
    mud.TestStopped,
    lambda: mud.element_test(
        sand,
        mud.Stage(
            "drained",
            eps_a_end=0.1),
            p_eff=100.0,
            void_ratio=0.8,
            max_updates=50),
             )
    check("max_updates ends a test", "max_updates" in told, told)
    loose = mud.element_test(
        sand, mud.Stage("drained", eps_a_end=0.05), p_eff=100.0, void_ratio=0.8, control_tolerance=1e-4
    )
    tight = mud.element_test(sand, mud.Stage("drained", eps_a_end=0.05), p_eff=100.0, void_ratio=0.8)
    check(
        "control_tolerance is what is held to",
        1e-10 < loose["control_error"].max() <= 1e-4 and abs(loose["q"][-1] / tight["q"][-1] - 1) < 1e-3,
        loose["control_error"].max(),
    )
    check(
        "linear strains are the laboratory's",
        np.allclose(tight.axial_strain, 1 - np.exp(-tight["eps_a"]))
        and np.allclose(tight.volumetric_strain, 1 - np.exp(-tight["eps_v"]), atol=1e-6),
    )
    elastic = mud.element_test(
        {"law": "elastic", "young": 1e4, "poisson": 0.25},
        mud.Stage("drained", eps_a_end=0.01),
        p_eff=100.0, void_ratio=0.8)
    check("another law runs too", abs(elastic["q"][-1] - 100.0) < 1e-6, elastic["q"][-1])
    answers = []
    threads = [
        threading.Thread(
            target=lambda: answers.append(
                mud.element_test(sand, mud.Stage("drained", eps_a_end=0.02), p_eff=100.0, void_ratio=0.8)["q"][-1]
            )
        )
        for _ in range(3)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    check("threads have one answer", len(set(answers)) == 1 and len(answers) == 3, answers)

    # Results of the host, as it writes them.
    folder = work / "run"
    folder.mkdir()
    (folder / "histories.csv").write_text("time,top.u_z,top.p_w\n0.0,0.0,1.0\n1.0,-0.5,0.25\n")
    (folder / "nodes_load.csv").write_text("node,r,z\n1,0.0,0.5\n2,1.0,0.5\n")
    run = mud.HostRun(folder)
    check("histories are columns", np.array_equal(run.histories["top.u_z"], [0.0, -0.5]) and run.stages == ["load"])
    check("tables by name", np.array_equal(run.table("nodes_load")["r"], [0.0, 1.0]))
    for text, words in (("", "is empty"), ("time,dt\n1.0,0.5\n2.0", "ledger.csv:3: 1 values of 2")):
        (folder / "ledger.csv").write_text(text)
        check(f"a table that {words}", words in refused(mud.InputError, lambda: run.ledger))
    copied = work / "copied"  # in which files are as old as the copy, in any order
    shutil.copytree(folder, copied)
    for time, stage in ((3.0, "a"), (2.0, "b"), (1.0, "load")):
        (copied / f"nodes_{stage}.csv").write_text("r,z\n0.0,0.5\n")
        (copied / f"reactions_{stage}.csv").write_text(f"time,time_of_forces,bottom.force_z\n{time},{time},{time}\n")
    check("stages are in the order of their times", mud.HostRun(copied).stages == ["load", "b", "a"])
    forces = Histories(copied).forces["bottom.force_z"]
    check("so are the forces of all stages", np.array_equal(forces, [[1.0, 2.0, 3.0]] * 2), forces)
    check("a table that is not there", "nodes_load" in refused(mud.InputError, lambda: run.table("nodes")))
    check("a folder without a run", "histories.csv" in refused(mud.InputError, lambda: mud.HostRun(work)))
    import matplotlib

    theirs = dict(matplotlib.rcParams)
    mud.plot_histories(run, ["top.u_z"], work / "history.png")
    mud.plot_test({"a": tight, "b": loose}, work / "test.png", {"eps_a": [0.0, 0.05], "q": [0.0, 200.0]})
    for before, after in (
        ("import matplotlib; matplotlib.use('svg')", "svg"), ("import matplotlib.pyplot; matplotlib.use('svg')", "svg"),
        ("import matplotlib", "agg"),
    ):
        words = f"{before}; from mud.plots import pyplot; pyplot(); print(matplotlib.get_backend())"
        bare = {name: value for name, value in os.environ.items() if name != "MPLBACKEND"}
        done = subprocess.run([sys.executable, "-c", words], capture_output=True, text=True,
                              env={**bare, "PYTHONPATH": str(root / "python")})
        check(f"{before}: the backend", done.stdout.strip().lower() == after, done.stdout + done.stderr)
    many = {f"test {i}": tight for i in range(8)}
    figure = mud.plot_test(many)
    ours = not figure.axes[0].spines["top"].get_visible()
    check("pictures have the style of the project and leave the user's", ours and dict(matplotlib.rcParams) == theirs)
    check("eight tests are eight lines of their own", len({
        (line.get_color(),
         str(line.get_linestyle())) for line in figure.axes[0].lines if len(line.get_xdata()) > 1}) == 8)
    check("all eight stand in the key", len(figure.legends[0].get_texts()) == 8 and not figure.axes[0].get_legend())
    sheared = mud.element_test(sand, mud.Stage("simple_shear_drained", gamma_end=0.02), p_eff=100.0, void_ratio=0.8)
    labels = [axis.get_xlabel() for axis in mud.plot_test([sheared, sheared]).axes]
    check("simple shear is drawn over shear strain", labels[0] == "shear strain [%]", labels)
    in_mpa = mud.element_test(sand.converted(1e-3), mud.Stage("drained", eps_a_end=0.02), p_eff=0.1, void_ratio=0.8)
    labels = [axis.get_ylabel() for axis in mud.plot_test(in_mpa).axes]
    check("stresses in MPa are drawn as such", labels[0] == "deviator stress q [MPa]", labels)
    told = refused(mud.InputError, lambda: mud.plot_test({"a": tight, "b": in_mpa}))
    check("tests of two units are not drawn together", "a in kPa, b in MPa" in told, told)
    titles = [axis.get_title() for axis in mud.plot_test(collapse).axes]
    check("wetting is drawn over suction", "retention" in titles and "wetting and drying" in titles, titles)
    round_off = {**collapse, "q": collapse["q"][0] + 1e-11 * np.arange(len(collapse["q"]))}
    titles = [title for title, *_ in panels([round_off])]
    quiet = "stress and strain" not in titles and "retention" in titles
    check("a deviator that is rounding is not drawn", quiet, titles)
    titles = [axis.get_title() for axis in mud.plot_test(cyclic).axes]
    drawn = {"pore pressure by cycles", "strain by cycles", "pore pressure"} <= set(titles)
    check("cycles are drawn", drawn, titles)
    axis = mud.plot_test(cyclic).axes[titles.index("strain by cycles")]
    count = axis.lines[0].get_xdata()
    check("cycles are counted on within each of them", np.all(np.diff(count) > 0)
          and count[0] == 0 and count[-1] == cyclic["cycle"][-1], count)
    told = refused(mud.InputError, lambda: mud.plot_test(tight, laboratory={"epsa": [0.0], "q": [0.0]}))
    check("a wrong name of a laboratory's column is told", "epsa" in told and "eps_a" in told, told)
    told = refused(mud.InputError, lambda: mud.plot_test(tight, laboratory={"q": [0.0]}))
    check("a column alone is told", "no panel shows" in told, told)
    told = refused(mud.UnknownName, lambda: mud.plot_histories(run, ["top.u_x"]))
    check("a history that is not there is told", "top.u_z" in told, told)
    check("the name of one history is a list of one", len(mud.plot_histories(run, "top.u_z").axes) == 1)
    check("no history", "columns is empty" in refused(mud.InputError, lambda: mud.plot_histories(run, [])))
    check("pictures are drawn", (work / "history.png").stat().st_size > 5000
          and (work / "test.png").stat().st_size > 5000)
    if (build / "host/mud_host").exists():
        scene = (root / "host/README.md").read_text().split("<!-- first scene -->\n```\n")[1].split("```")[0]
        (work / "scene.nml").write_text(scene)
        done = subprocess.run(
            [build / "host/mud_host", work / "scene.nml", "--output", work / "out", "--quiet"],
            capture_output=True,
            text=True,
        )
        run = mud.HostRun(work / "out")
        # A laterally unconstrained elastic block of 1 m under 10 kPa: 10/1e4 m.
        check(
            "the host's first scene is read",
            done.returncode == 0 and run.stages == ["load"] and abs(run.histories["top.u_z"][-1]) > 1e-5,
            done.stderr,
        )
        if (work / "out/results.xdmf").exists():
            nodes, elements = run.mesh()
            check(
                "and its fields",
                run.field("displacement").shape == (len(nodes), 3)
                and np.allclose(run.field("displacement")[:, 2], 0.0)
                and elements.shape[1] == 6 and run.times()[-1] == 1.0,
            )


def test_b_lode_angle_and_von_mises_stress_where_the_axes_turn():
    # Principal stresses, in closed form: simple shear of an isotropic elastic sample of constant volume has the
    # principal stresses p + tau, p, p - tau, so b 1/2, a Lode angle of 30 degrees and sqrt(3) tau.
    elastic_law = {"law": "elastic", "young": 1e4, "poisson": 0.25}
    result = mud.element_test(
        elastic_law, mud.Stage("simple_shear_constant_volume", tau_end=10.0), p_eff=100.0, void_ratio=0.8
    )
    check(
        "b, Lode angle and von Mises stress where the axes turn",
        abs(result["b"][-1] - 0.5) < 1e-9
        and abs(result["lode"][-1] - 30.0) < 1e-6
        and abs(result["q_mises"][-1] - 10.0 * np.sqrt(3.0)) < 1e-9
        and abs(result["q"][-1]) < 1e-9
        and np.isnan(result["b"][0]),
        (result["b"][-1], result["lode"][-1], result["q_mises"][-1]),
    )
    for end, b, angle in ((0.01, 0.0, 0.0), (-0.01, 1.0, 60.0)):
        result = mud.element_test(sand, mud.Stage("undrained", eps_a_end=end), p_eff=100.0, void_ratio=0.8)
        check(
            f"triaxial tests have b {b:g}, a Lode angle of {angle:g} and |q|",
            abs(result["b"][-1] - b) < 1e-9
            and abs(result["lode"][-1] - angle) < 1e-6
            and np.allclose(result["q_mises"], np.abs(result["q"])),
        )
    check("a result tells what it is", all(word in repr(result) for word in ("eps_a -0.01", "rows", "q_mises")), result)
    told = refused(mud.UnknownName, lambda: result["p_ef"]), refused(AttributeError, lambda: result.q)
    check("a wrong column and a column as attribute are told", "p_eff" in told[0] and "result['q']" in told[1], told)

    stand_in = types.ModuleType("pandas")
    stand_in.DataFrame = Frame
    there = sys.modules.get("pandas")
    sys.modules["pandas"] = stand_in
    frame = result.to_frame()
    check("to_frame gives every column, and the units", list(frame)
          == list(result) and frame.attrs["units"]["q"] == "kPa")
    sys.modules["pandas"] = None
    check("without pandas it is told how to get it", "mud-soil[frames]" in refused(ImportError, result.to_frame))
    sys.modules.pop("pandas")
    if there:
        sys.modules["pandas"] = there

    # Examples run as they stand.
    environment = {**os.environ, "PYTHONPATH": str(root / "python")}
    for name, words in (
        ("drained_test", [work / "picture.png"]),
        ("many_points", []),
        ("fit_a_sand", [work / "fitted"])):
        done = subprocess.run(
            [sys.executable, root / f"python/examples/{name}.py", *words],
            env=environment,
            cwd=work,
            capture_output=True,
            text=True,
        )
        check(f"the example {name} runs", done.returncode == 0 and len(done.stdout) > 40, done.stdout + done.stderr)
    lines = [ line for line in (root / "python/examples/drained_test.py").read_text().split('"""')
                                [2].splitlines() if line.strip() ]
    check("a drained test with a picture in ten lines", len(lines)
          <= 10 and (work / "picture.png").exists(), len(lines))


def test_a_parameter_of_a_material_raises():
    for name, action in (("as attribute", set_parameter), ("by name", set_item), ("read", lambda: sand.G_0)):
        told = refused(AttributeError, action)
        check(f"a parameter {name} of a material raises", "G_0" in told and sand["G_0"] == 125.0, told)


def test_material_takes_a_set_by_its_name_and_replaces_that_of_the_case():
    # The library of materials in the driver.
    done, by_name = case_file("undrained_e833_p100", options=("--material", "karlsruhe"))
    result = mud.element_test(
        "karlsruhe",
        mud.Stage("undrained", eps_a_end=by_name["eps_a"][-1] if by_name else 0.1),
        p_eff=100.0,
        void_ratio=0.833,
    )
    check(
        "--material takes a set by its name, and replaces that of the case",
        done.returncode == 0 and abs(by_name["q"][-1] / result["q"][-1] - 1) < 1e-4,
        done.stderr,
    )
    done, _ = case_file("undrained_e833_p100", options=("--material", "karlsruher"))
    check(
        "a name that is not there is refused with the folder",
        done.returncode == 2 and "drivers/materials" in done.stderr,
        done.stderr,
    )
    check(
        "the library has what its page lists",
        {"toyoura", "toyoura_fitted", "karlsruhe", "hostun_hysteresis"} <= set(mud.materials()),
    )
    for name in mud.materials():
        material = mud.Material(name)
        check(f"material {name} is complete", material.title and np.all(np.isfinite(material.props)))


FORKS = """
import multiprocessing, os, sys
import numpy as np
import mud

sand, n = mud.Material("toyoura"), 40
stress = np.tile([-90.0, -70.0, -80.0, 4.0, 0.0, 0.0], (n, 1))*np.linspace(0.5, 2.0, n)[:, None]
begun = sand.init_batch(stress, np.full(n, 5.0))
strain = np.linspace(-4e-4, 4e-4, 6*n).reshape(n, 6)

def update(threads):
    return sand.update_batch(begun.stress, begun.statev, strain, tangent="consistent", threads=threads).stress

if sys.argv[1] == "threads":
    update(3)
with multiprocessing.get_context("fork").Pool(2) as pool:
    forked = pool.map(update, [2, 3, 1, 0])
child = os.fork()
if child == 0:
    if os.fork() == 0:   # and a child of that
        os._exit(0 if np.array_equal(update(2), forked[0]) else 1)
    os._exit(os.waitstatus_to_exitcode(os.wait()[1]))
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
assert all(np.array_equal(one, update(3)) for one in forked)
"""


def test_a_batch_in_a_forked_process_ends_with_the_same_answer():
    # OpenMP's threads stay in the parent: a child that waited for them would never end.
    for name in ("threads", "none"):
        process = subprocess.Popen(
            [sys.executable, "-W", "ignore", "-c", FORKS, name],   # Python 3.12 warns of forks beside threads
            env={**os.environ, "PYTHONPATH": str(root / "python")},
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        try:
            said = process.communicate(timeout=60)[1]
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            said = process.communicate()[1] + "it did not end within 60 s"
        check(f"children of a process that used {name} update points bit by bit as it does",
              process.returncode == 0 and said == "", said)


def test_public_functions_have_type_hints_and_a_docstring():
    bare = []
    for name, function in public():
        signature = inspect.signature(function)
        hints = [p.annotation for p in signature.parameters.values() if p.name not in ("self", "cls")]
        if not function.__doc__ or inspect.Signature.empty in (*hints, signature.return_annotation):
            bare.append(name)
    check("public functions have type hints and a docstring", len(list(public())) > 40 and not bare, bare)
    check("type checkers are told that there are hints", (root / "python/mud/py.typed").exists())


def test_a_material_knows_the_range_of_its_tests():
    sand = mud.Material("karlsruhe")
    wanted = {"tested_e_min": 0.693, "tested_e_max": 1.007, "tested_p_min": 12.0, "tested_p_max": 859.0}
    check("ranges of the file", sand.tested == wanted, sand.tested)
    check("another parameter keeps them", sand.changed(G_0=100.0).tested == wanted)
    check("in MPa", sand.converted(1e-3).tested["tested_p_max"] == 0.859, sand.converted(1e-3).tested)
    check("no ranges, none told", mud.Material("toyoura").tested == {})
    (work / "again.nml").write_text(sand.group())
    check("they are written and read again", mud.Material(work / "again.nml").tested == wanted)
    (work / "wrong.nml").write_text("&material\n   tested_e_min = 'loose'\n/\n")
    (work / "slip.nml").write_text("&material\n   G_O = 120\n/\n")
    told = refused(mud.UnknownName, lambda: mud.Material(work / "slip.nml"))
    check("a slip is told with its file", "slip.nml: there is no parameter G_O" in told, told)
    check("no number: refused", "tested_e_min" in refused(mud.InputError, lambda: mud.Material(work / "wrong.nml")))
