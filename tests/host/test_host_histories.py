# SPDX-License-Identifier: MIT
"""Histories of known shape: what they prescribe at given times, the impulse that they give, where steps end, stages
that they count from, and combinations that are refused. Host theory, sections 4.5 and 7.2."""
import math

import numpy as np
import pytest

from checking import check, work
from host_program import ran, start
import tables  # noqa: E402 (checking knows its folder)

SHAPES = {"sine": lambda x: math.sin(2*math.pi*x), "half_sine": lambda x: abs(math.sin(math.pi*x)),
          "haversine": lambda x: (1 - math.cos(2*math.pi*x))/2, "triangle": lambda x: 1 - abs(2*(x % 1) - 1)}
# A block of 1 m, E 1e4 kPa, Poisson's ratio 0: 10 kPa shorten it by 1 mm.
BLOCK = """&scene name = 'block' geometry = 'plane_strain' fields = 'u' {scene} /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'e' young = 1e4 poisson = 0 /
&region material = 'e' void_ratio = 0 /
&stage name = 'first' analysis = 'static' duration = 2 {step} /
&stage name = 'then' analysis = 'static' duration = 3 {step} /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 10 history = 'h' /
&history name = 'h' {history} /
&point name = 'top' r = 0 z = 1 /
"""


def block(history, step="dt = 0.1", scene=""):
    return BLOCK.format(history=history, step=step, scene=scene)


@pytest.mark.parametrize("kind", SHAPES)
def test_a_block_is_shortened_by_the_closed_form(kind):
    # Two pulses of 0.9 s from 0.35 s on.
    if ran(kind, block(f"kind = '{kind}' start = 0.35 period = 0.9 repeats = 2")):
        rows = tables.columns(work / f"{kind}/histories.csv")
        exact = [-1e-3*SHAPES[kind]((t - 0.35)/0.9) if 0.35 < t < 2.15 else 0 for t in rows["time"]]
        check(f"{kind}: displacement of the block", np.allclose(rows["top.u_z"], exact, atol=1e-12, rtol=0),
              np.array(rows["top.u_z"]) - exact)
        check(f"{kind}: it is not at rest", min(rows["top.u_z"]) < -0.9e-3, rows["top.u_z"])


def test_given_steps_end_at_the_kinks_and_no_others():
    # Feet of the half sine at 0.35 and 0.75 s; the peak, at 0.55 s, is none.
    for kind, kinks in (("half_sine", [0.35, 0.75]), ("triangle", [0.35, 0.55, 0.75]), ("haversine", [])):
        if ran("kinks", block(f"kind = '{kind}' start = 0.35 period = 0.4")):
            ends = np.array(tables.columns(work / "kinks/histories.csv")["time"])[1:]
            check(f"{kind}: steps end at its kinks", all(np.min(abs(ends - t)) < 1e-9 for t in kinks), ends)
            # The next step is as long as given: the stage ends with a shorter one.
            check(f"{kind}: no other step is added", len(ends) == 50 + (len(kinks) > 0), (len(ends), ends))


def test_controlled_steps_see_a_pulse_that_they_could_jump_over():
    # A pulse of 20 ms in stages of 2 and 3 s.
    if ran("short", block("kind = 'half_sine' start = 1.1 period = 0.02", "", "step_tolerance = 1e-2")):
        rows = tables.columns(work / "short/histories.csv")
        exact = [-1e-3*SHAPES["half_sine"]((t - 1.1)/0.02) if 1.1 < t < 1.12 else 0 for t in rows["time"]]
        check("the pulse is there", min(rows["top.u_z"]) == pytest.approx(-1e-3, rel=1e-9), rows["top.u_z"])
        check("the block follows it", np.allclose(rows["top.u_z"], exact, atol=1e-12, rtol=0), rows["top.u_z"])


def test_times_count_from_the_starts_of_stages():
    # One pulse in each stage, half a second after its start: at 0.5 and at 2.5 s.
    pulse = "kind = 'triangle' start = 0.5 period = 0.4 "
    table = "times = 0.5, 0.7, 0.9 values = 0, 1, 0 "
    for name, keys in (("pulse", pulse), ("table", table)):
        done = start(name, block(keys + "stages = 'then', 'first'"))
        check(f"{name} runs without a word", done.returncode == 0 and not done.stderr, done.stderr)
        rows = tables.columns(work / f"{name}/histories.csv")
        exact = np.interp(rows["time"], [0.5, 0.7, 0.9, 2.5, 2.7, 2.9], [0, -1e-3, 0, 0, -1e-3, 0])
        check(f"{name}: a pulse in each stage", np.allclose(rows["top.u_z"], exact, atol=1e-12, rtol=0),
              rows["top.u_z"])
    if ran("one", block("times = 0, 1 values = 0, 1 stages = 'then'")):
        rows = tables.columns(work / "one/histories.csv")
        check("a ramp from the second stage on", np.allclose(rows["top.u_z"], -1e-3*np.clip(
            np.array(rows["time"]) - 2, 0, 1), atol=1e-12, rtol=0), rows["top.u_z"])
    # Nothing between two pulses that touch.
    if ran("touching", block("kind = 'triangle' period = 2 stages = 'first', 'then'")):
        rows = tables.columns(work / "touching/histories.csv")
        check("pulses that touch", np.allclose(rows["top.u_z"], np.interp(
            rows["time"], [0, 1, 2, 3, 4], [0, -1e-3, 0, -1e-3, 0]), atol=1e-12, rtol=0), rows["top.u_z"])


BODY = """&scene name = 'body' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'e' young = 1e4 poisson = 0 /
&region material = 'e' void_ratio = 0 /
&plate name = 'body' r = 0, 1 z = 5 mass = 0.02 force = {force} history = 'h' /
&history name = 'h' kind = '{kind}' start = 0.003 period = 0.017 /
&stage name = 'push' analysis = 'dynamic' duration = 0.03 {step} rho_inf = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
"""


@pytest.mark.parametrize("kind", SHAPES)
def test_the_impulse_of_a_pulse_becomes_velocity(kind):
    # 6 kN for 17 ms on 20 kg that float: the integral of the shape times F T/m; the trapezoidal rule over a pulse is
    # off by (pi^2/12) (dt/T)^2 of it, 2.4e-4 at most. A sine gives none, but a way: F T^2/(2 pi m).
    share = {"sine": 0, "half_sine": 2/math.pi, "haversine": 0.5, "triangle": 0.5}[kind]
    if ran(f"body_{kind}", BODY.format(kind=kind, force=6, step="dt = 2.9e-4")):
        rows = tables.columns(work / f"body_{kind}/contact.csv")
        full = 6*0.017/0.02
        check(f"{kind}: velocity after the pulse", abs(rows["body.v_z"][-1] - share*full) < 3e-4*full,
              (rows["body.v_z"][-1], share*full))
        if kind == "sine":
            way = full*0.017/(2*math.pi)
            check("a sine moves the body", abs(rows["body.u_z"][-1] - way) < 3e-3*way, (rows["body.u_z"][-1], way))


def test_what_contradicts_itself_is_refused_by_its_place():
    for keys, words in (
            ("kind = 'sine'", "history h has a kind that needs its period [s], and neither times and values"),
            ("kind = 'sine' period = 1 times = 0, 1 values = 0, 1", "neither times and values nor a file"),
            ("times = 0, 1 values = 0, 1 period = 1", "start, period and repeats are those of a sine or a pulse"),
            ("times = 0, 1 values = 0, 1 repeats = 2", "and history h is a table; give kind = 'sine'"),
            ("kind = 'sine' period = 0", "period"), ("kind = 'sines' period = 1", "sine"),
            ("kind = 'sine' period = 1 repeats = 0", "repeats"),
            ("kind = 'sine' period = 1 stages = 'third'", "there is no stage 'third'"),
            ("kind = 'half_sine' period = 2.5 stages = 'first', 'then'",
             "history 'h' lasts up to 2.5 s, and begins anew at 2 s with stage then: shorten it"),
            ("times = 0, 1 values = 0, 1 stages = 'first', 'then'", "with the factor 0 after 1: it would jump")):
        done = start("refused", block(keys))
        check(f"{keys} is refused", done.returncode in (2, 11) and "refused.nml:10: " in done.stderr
              and words in done.stderr, done.stderr)


def test_a_history_of_a_stage_is_told_of_no_wrong_times():
    # The pulse of both stages begins before the load, which acts in the second alone.
    text = block("kind = 'half_sine' period = 1 stages = 'first', 'then'").replace(
        "history = 'h' /", "history = 'h' stages = 'then' /", 1)
    done = start("late", text)
    check("no word about times", done.returncode == 0 and not done.stderr, done.stderr)
    rows = tables.columns(work / "late/histories.csv")
    check("the load begins with its stage", np.allclose(rows["top.u_z"], [
        -1e-3*SHAPES["half_sine"](t - 2) if 2 < t < 3 else 0 for t in rows["time"]], atol=1e-12, rtol=0),
        rows["top.u_z"])


def test_given_steps_end_at_the_same_kinks_late_in_a_run():
    # The drop within a tenth of a step is jumped over by none, whatever the sum of 31 steps misses its beginning by.
    ends = []
    for first in (1, 100000):
        name = f"late_{first}"
        text = block("times = 0, 0.003, 0.00301 values = 0, 1, 0 stages = 'then'").replace(
            "duration = 2 dt = 0.1", f"duration = {first} dt = {first}").replace(
            "duration = 3 dt = 0.1", "duration = 0.005 dt = 1e-4")
        if ran(name, text):
            times = tables.columns(work / f"{name}/histories.csv")["time"] - first
            ends.append(times[times > 1e-6])
    check("as many steps late as early", [len(one) for one in ends] == [51, 51], ends)
    check("one ends with the drop", all(any(abs(one - 0.00301) < 1e-9) for one in ends), ends)
