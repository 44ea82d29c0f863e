# SPDX-License-Identifier: MIT
"""mud_lwd: formulas of the devices, scenes that the host takes without a word, drops whose answers are known, a page
with errors, records, charts, ends and resumption."""

import math
import os
import pathlib
import signal
import subprocess
import sys
import time

import numpy as np

from checking import build, check, needs_plain_library, needs_release, root, work

needs_plain_library()
needs_release("tests of the deflectometer are Python over many runs of mud_host, the same in every build")
ENVIRONMENT = {
    **os.environ,
    "PYTHONPATH": str(root / "python"),
    "MUD_LIBRARY_DIR": str(build),
    "OMP_NUM_THREADS": "1",
    "MUD_HOST": str(build / "host/mud_host"),
    "MPLBACKEND": "Agg",
}
sys.path.insert(0, str(root / "python"))
os.environ["MUD_LIBRARY_DIR"] = str(build)
import tables  # noqa: E402 (checking knows its folder)
from mud.errors import InputError  # noqa: E402
from mud.lwd import answers  # noqa: E402
from mud.lwd.device import device_of, record_of  # noqa: E402
from mud.lwd.ground import Layer, Test, scene_of  # noqa: E402
from mud.study.runs import Failed  # noqa: E402

SMALL = ("--width", "0.9", "--depth", "0.9", "--drops", "1", "1")
ELASTIC = ("--material", "elastic:30000:0.3", "--void-ratio", "0.6")
SAND = ("--material", "toyoura", "--drops", "0", "1", "--width", "0.9", "--depth", "0.9", "--step-tolerance", "0.03")


def lwd(*words, **more):
    return subprocess.run(
        [sys.executable, "-m", "mud.lwd", *map(str, words)],
        capture_output=True,
        text=True,
        env=ENVIRONMENT,
        cwd=work,
        **more,
    )


def rows(path):
    return tables.rows(work / path)


def raised(what):
    try:
        what()
    except InputError as problem:
        return str(problem)
    return ""


def test_the_formulas_are_those_of_the_standards():
    # E_vd = 22.5/s, MN/m2 and mm; f (1 - nu^2) sigma r/s of a load cell: pi/2 (1 - 0.35^2) sigma 0.15 m/1 mm.
    check("Zorn", abs(device_of("zorn").modulus(0.5e-3) / 1e3 - 45.0) < 1e-9, device_of("zorn").modulus(0.5e-3))
    # What the Zorn has measured does not count, what the load cell of the Prima has does: 6 kN on 0.0707 m2.
    check("Zorn, another force", device_of("zorn").modulus(0.5e-3, 6.0) == device_of("zorn").modulus(0.5e-3))
    (work / "harder.csv").write_text("time,force\n0,0\n8,8\n16,0\n")
    recorded = device_of("zorn", work / "harder.csv")
    check("Zorn, a record of its force", abs(recorded.modulus(0.5e-3) / 1e3 - 45.0) < 1e-9, recorded)
    check("its largest force is that of the record", recorded.largest == 8.0, recorded.largest)
    measured = device_of("prima", work / "harder.csv", mass=0.012)
    check("Prima, a record", measured.modulus(1e-3) == measured.modulus(1e-3, 8.0), measured)
    for given, word in (
        ({"pulse": 0.017e-3}, "lasts 0.017 ms"),
        ({"mass": 0.015e-3}, "0.015 kg rest on the ground"),
        ({"buffer": 354.0, "fall": 72.0}, "falls from 72 m"),
        ({"record": work / "harder.csv", "pulse": 0.02}, "leave one of the two out"),
    ):
        said = raised(lambda: device_of("zorn", **given))
        check(f"{given} is refused", word in said, said)
    prima = device_of("prima", peak=7.0, pulse=0.018, mass=0.012)
    closed = math.pi / 2 * (1 - 0.35**2) * 6 / (math.pi * 0.15**2) * 0.15 / 1e-3
    check("Prima", abs(prima.modulus(1e-3, 6.0) / closed - 1) < 1e-9, prima.modulus(1e-3, 6.0))
    own = device_of("zorn", peak=10.0, radius=0.1, poisson=0.5, shape=2.0)
    check("own values", abs(own.modulus(1e-3) - 1.5 * 10 / (math.pi * 0.01) * 0.1 / 1e-3) < 1e-6, own.modulus(1e-3))
    f = device_of("zorn").force(np.array([-1e-3, 0, 0.0085, 0.017, 0.02]))
    check("half sine of 7.07 kN", np.allclose(f, [0, 0, 7.0686, 0, 0], atol=1e-4), f)


def test_warnings_that_differ_by_their_time_are_told_once():
    from mud.study.runs import warnings_of

    said = ("stage drop_1, time 2.01 s: stays at 5.9e-4.", "other", "stage drop_2, time 2.1 s: stays at 1e-3.")
    (work / "errors.txt").write_text("".join(f"mud_host: warning: {words}\n" for words in said))
    told = warnings_of(work)
    check("folded", told == ["stage drop_1, time 2.01 s: stays at 5.9e-4. (and 1 more)", "other"], told)


def test_scenes_are_taken_by_the_host_without_a_warning():
    sand, device = Layer("karlsruhe", 0.75), device_of("zorn")
    for name, test in {
        "suction": Test(device, (sand,), suction=25),
        "table": Test(device, (sand,), water_table=1.0),
        "rain": Test(device, (sand,), water_table=1.0, rain=10, rain_hours=2),
        "layers": Test(device, (Layer("elastic:2e5:0.35", 0.3, 0.2), Layer("toyoura", 0.8, 0.3), sand), suction=20),
        "dry": Test(device, (Layer("elastic:3e4"),)),
        "held": Test(device, (sand,), suction=25, fixed=True),
        "tied": Test(device, (sand,), suction=25, tied=True),
        "falls": Test(device_of("zorn", buffer=350.0, damping=0.1), (sand,), suction=25),
    }.items():
        path = work / f"{name}.nml"
        path.write_text(scene_of(test))
        done = subprocess.run(
            [build / "host/mud_host", path, "--check"], capture_output=True, text=True, env=ENVIRONMENT
        )
        warned = [w for w in done.stderr.splitlines() if "begins outside what it was fitted to" not in w]
        check(f"{name} is taken", done.returncode == 0 and not warned, done.stderr)


def test_the_depth_of_influence_ends_at_the_base():
    from mud.lwd.answers import _depth_of

    # Straight logarithms: a tenth lies in the middle between 1 and 0.01. Below the last point a straight line to 0.
    check("between points", abs(_depth_of([0.0, 1.0, 2.0], [1.0, 1.0, 0.01], 5.0) - 1.5) < 1e-12)
    check("above the base", abs(_depth_of([0.0, 1.0], [1.0, 0.4], 2.0) - 1.75) < 1e-12)


def test_rain_wets_the_ground_below_a_plate_that_stands():
    # 20 mm in an hour: the front is broad, and suction falls by more than a tenth 75 mm below. The ground heaves, and
    # the plate with it.
    text = scene_of(Test(device_of("zorn"), (Layer("toyoura", 0.8),), suction=30, seating=0, measured=1, width=0.9,
                         depth=0.9, rain=20, rain_hours=1))
    (work / "rain.nml").write_text(text)
    done = subprocess.run(
        [build / "host/mud_host", work / "rain.nml", "--output", work / "rain", "--fineness", "0.5"]
        + ["--step-tolerance", "0.03", "--quiet"], capture_output=True, text=True, env=ENVIRONMENT)
    check("it runs", done.returncode == 0, done.stderr)
    check("the contact begins with the weight of the plate", "overlap" not in done.stderr, done.stderr)
    table = tables.columns(work / "rain/histories.csv")
    suction = [float(np.interp(t, table["time"], table["d75.p_c"])) for t in (2.0, 3602.0)]
    check("suction falls", suction[0] > 29.9 and suction[1] < 0.9 * suction[0], suction)
    plate = tables.columns(work / "rain/contact.csv")
    rains = (plate["time"] > 2) & (plate["time"] < 3602)
    pushed = plate["face.thrust"][rains]
    check("the plate keeps its weight", np.all(abs(pushed / (0.015 * 9.81) - 1) < 0.01), (pushed.min(), pushed.max()))


def test_elastic_ground_gives_the_same_deflection_every_time_and_takes_it_back():
    done = lwd("test", *ELASTIC, *SMALL, "--output", "elastic", "--fineness", "1")
    check("it runs", done.returncode == 0, done.stderr)
    drops = rows("elastic/drops.csv")
    check("two drops", [d["kind"] for d in drops] == ["seating", "measured"], drops)
    first, last = (float(d["deflection_mm"]) for d in drops)
    errors = sum(float(d["deflection_error_mm"]) for d in drops)
    check("the same deflection", abs(first - last) < errors + 0.01 * last, (first, last, errors))
    # Waves that the base throws back still move the plate a little.
    check("the deflection is taken back", abs(float(drops[1]["settlement_mm"])) < 0.15 * last, drops[1])
    # A rigid plate on a half space: pi/2 (1 - nu^2) sigma r/E = 0.715 mm; on 0.9 m above a rigid base less, by inertia
    # more.
    check("the size of the closed form", 0.5 < last < 0.8, last)
    check("a base so near is told", "the base is within the depth of influence" in done.stderr, done.stderr)
    check("22.5/s", abs(float(drops[1]["modulus_MPa"]) * last / 22.5 - 1) < 1e-3, drops[1])
    page = (work / "elastic/report.html").read_text()
    for words in ("data:image/png;base64,", "22.5/s", "Warnings", "1 (seating)", "2 (measured)", "no water"):
        check(f"the page has {words!r}", words in page)
    check("a picture", (work / "elastic/lwd.png").stat().st_size > 20000)
    table = {r["answer"]: r for r in rows("elastic/results.csv")}
    check(
        "the modulus has an error", 0 < float(table["modulus"]["error"]) < 0.3 * float(table["modulus"]["value"]), table
    )
    check("the last line has both", "+-" in done.stdout.splitlines()[-1], done.stdout)
    history = rows("elastic/histories.csv")
    force = max(float(r["force_kN"]) for r in history)
    check("the peak of the force is in the histories", abs(force - 7.0686) < 0.05, force)
    # The error of the history at the peak of the first drop, which begins it, is that of the drop.
    top = max((r for r in history if float(r["time_ms"]) < 50), key=lambda r: float(r["deflection_mm"]))
    told = float(drops[0]["deflection_error_mm"])
    at_peak = float(top["deflection_error_mm"])
    check("histories have errors at every time", 0.5 * told < at_peak < 2 * told, (at_peak, told))
    check("a force that is given has none", all(float(r["force_error_kN"]) == 0 for r in history))
    whole = float(table["history.deflection"]["error"])
    check("the largest is in the results", whole >= max(float(r["deflection_error_mm"]) for r in history) * 0.99, whole)


def test_a_loose_plate_on_hard_ground_reads_what_a_tied_one_does():
    # The contact is a spring: of its default stiffness it would halve the modulus of this ground.
    read = []
    for tied in ([], ["--tied"]):
        words = ("--material", "elastic:2e7:0.3", "--void-ratio", "0.6", "--drops", "0", "1", *SMALL[:4], *tied)
        done = lwd("test", *words, "--quiet", "--no-page", "--output", "hard" + "".join(tied))
        check("it runs", done.returncode == 0, done.stderr)
        read.append(float(done.stdout.split()[1]) if done.returncode == 0 else math.nan)
    # To the hundredth by which the contact gives way, and what the two models of the plate differ by at its rim.
    check("the modulus of both plates", abs(read[0] / read[1] - 1) < 0.04, read)


def test_a_mass_that_falls_on_a_spring_gives_the_pulse_of_the_closed_form():
    # 10 kg from 0.72 m on 250 kN/m and ground that hardly moves: m g + root((m g)^2 + 2 m g h k) = 6.042 kN.
    words = ("--void-ratio", "0.6", "--drops", "0", "1", "--width", "0.9", "--depth", "0.9")
    done = lwd("test", "--material", "elastic:3e7:0.3", *words, "--buffer", "250", "--output", "rigid")
    check("it runs", done.returncode == 0, done.stderr)
    weight = 0.01 * 9.81
    exact = weight + math.sqrt(weight**2 + 2 * weight * 0.72 * 250)
    drop = rows("rigid/drops.csv")[0]
    force, error = float(drop["force_kN"]), float(drop["force_error_kN"])
    check("its peak", abs(force - exact) < error < 0.01 * exact, (force, exact, error))
    on = [float(r["time_ms"]) for r in rows("rigid/histories.csv") if float(r["force_kN"]) > 0]
    closed = device_of("zorn", buffer=250.0).on_rigid_base()
    check("the peak that is expected", abs(closed[0] - exact) < 1e-9, closed)
    check("its duration", abs(on[-1] - on[0] - 1e3 * closed[1]) < 0.8, (on[0], on[-1], closed))
    check("a Zorn keeps its formula", abs(float(drop["modulus_MPa"]) * float(drop["deflection_mm"]) - 22.5) < 0.01)

    # On softer ground the pulse is another one; given as a record it moves the plate by as much.
    done = lwd("test", *ELASTIC, *words[2:], "--device", "prima", "--buffer", "250", "--fall", "0.72", "--fall-mass",
               "10", "--plate-mass", "15", "--output", "soft")
    check("a Prima whose values are given runs", done.returncode == 0, done.stderr)
    soft = rows("soft/drops.csv")[0]
    force, moved = float(soft["force_kN"]), float(soft["deflection_mm"])
    check("soft ground gives way to the mass", 0.8 * exact < force < 0.99 * exact, (force, exact))
    modulus = math.pi / 2 * (1 - 0.35**2) * force / (math.pi * 0.15) / moved
    check("the modulus of the measured force", abs(float(soft["modulus_MPa"]) / modulus - 1) < 1e-3, (soft, modulus))
    pulse = [r for r in rows("soft/histories.csv") if float(r["time_ms"]) < 24]
    (work / "pulse.csv").write_text(
        "time,force\n" + "".join(f"{r['time_ms']},{r['force_kN']}\n" for r in pulse)
    )
    done = lwd("test", *ELASTIC, *words[2:], "--force", "pulse.csv", "--output", "given")
    check("the record runs", done.returncode == 0, done.stderr)
    again, told = (float(rows("given/drops.csv")[0][k]) for k in ("deflection_mm", "deflection_error_mm"))
    told += float(soft["deflection_error_mm"])
    check("the same pulse moves the plate by as much", abs(again - moved) < told < 0.2 * moved, (again, moved, told))


def test_a_loose_plate_is_thrown_up_and_a_tied_one_pulls_at_the_ground():
    words = (*ELASTIC, *SMALL)
    loose, tied = lwd("test", *words, "--output", "elastic"), lwd("test", *words, "--tied", "--output", "tied")
    check("both run", loose.returncode == 0 and tied.returncode == 0, (loose.stderr, tied.stderr))
    heights = [float(rows(f"{name}/drops.csv")[0]["lift_mm"]) for name in ("elastic", "tied")]
    check("the loose one leaves the ground", heights[0] > 2 * heights[1] and heights[0] > 0.1, heights)
    check("the tied one pulls, and that is told", "the tied plate pulls at the ground" in tied.stderr, tied.stderr)
    check("the loose one does not", "pulls at the ground" not in loose.stderr, loose.stderr)
    # The first peak comes before the plate could leave the ground.
    peaks = [float(rows(f"{name}/drops.csv")[0]["deflection_mm"]) for name in ("elastic", "tied")]
    check("the first peak is the same", abs(peaks[0] / peaks[1] - 1) < 0.02, peaks)
    short = lwd("test", *words, "--interval", "40", "--output", "short")
    check("a plate that still moves is told", "settlements are not the last word" in short.stderr, short.stderr)


def test_a_record_of_the_force_replaces_the_half_sine():
    t = np.linspace(0, 17, 200)
    lines = [f"{x:.4f},{7.0686 * math.sin(math.pi * x / 17):.5f},{0.6 * math.sin(math.pi * x / 25):.5f}" for x in t]
    (work / "record.csv").write_text("time,force,deflection\n" + "\n".join(lines) + "\n")
    done = lwd("test", *ELASTIC, *SMALL, "--force", "record.csv", "--measured", "record.csv", "--output", "recorded")
    check("it runs", done.returncode == 0, done.stderr)
    check(
        "the record is laid beside it",
        "force: record 7.06" in done.stdout and "deflection: record 0.6 mm" in done.stdout,
        done.stdout,
    )
    lwd("test", *ELASTIC, *SMALL, "--output", "elastic")
    pair = [float(rows(f"{name}/drops.csv")[-1]["deflection_mm"]) for name in ("recorded", "elastic")]
    check("the same half sine, as a record", abs(pair[0] / pair[1] - 1) < 0.01, pair)
    for text, words in (
        ("t,f\n1,2\n", "the first line of a record is time,force,deflection"),
        ("time,force\n0,0\n1,x\n2,0\n", "every line has 2 numbers"),
        ("time,force\n0,0\n1,1\n1,0\n", "times that ascend"),
    ):
        (work / "wrong.csv").write_text(text)
        said = raised(lambda: record_of(work / "wrong.csv"))
        check(f"{text!r} is refused", words in said, said)
    (work / "wrong.csv").write_text("time,force\n0,0\n1,1\n2,0.7\n")
    check(
        "a force that does not end",
        "begins and ends below 5 %" in raised(lambda: device_of("zorn", work / "wrong.csv")),
    )


def test_what_cannot_be_computed_is_refused_in_a_sentence():
    for words, said in (
        (("--material", "toyoura", "--void-ratio", "0.8"), "give the suction [kPa] or the depth of the water table"),
        (("--material", "nosand", "--void-ratio", "0.8", "--suction", "9"), "there is no material nosand"),
        (("--material", "elastic:30000", "--void-ratio", "60"), "it is above 0 and below 10: it is no per cent"),
        (("--material", "elastic:30", "--void-ratio", "0.8"), "30 MPa are elastic:30000"),
        (("--material", "elastic:x", "--void-ratio", "0.8"), "an elastic layer is elastic:YOUNG"),
        ((*ELASTIC, "--interval", "20"), "at least one and a half times as long"),
        ((*ELASTIC, "--width", "0.5"), "at least six radii"),
        ((*ELASTIC, "--layer", "3", "elastic:1e5", "0.3"), "the layers reach below the base"),
        ((*ELASTIC, "--layer", "a", "elastic:1e5", "0.3"), "thickness and void ratio are numbers"),
        ((*ELASTIC, "--peak", "-1"), "peak of the device is -1 (--peak); it is above 0"),
        ((*ELASTIC, "--radius", "nan"), "radius of the device is nan"),
        ((*ELASTIC, "--device", "prima"), "the device prima needs --peak, --pulse, --plate-mass"),
        ((*ELASTIC, "--device", "prima", "--buffer", "300"), "needs --fall-mass, --fall, --plate-mass"),
        ((*ELASTIC, "--fall", "0.5"), "needs the stiffness of the buffer in kN/m: --buffer"),
        ((*ELASTIC, "--buffer", "300", "--pulse", "17"), "--pulse gives the pulse"),
        ((*ELASTIC, "--peak", "7070"), "with up to 1e+05 kPa, as in no device: forces are in kN"),
        ((*ELASTIC, "--radius", "0.15"), "the radius in mm"),
        ((*ELASTIC, "--drops", "3", "0"), "at least one drop is measured"),
        ((*ELASTIC, "--step-tolerance", "0.5"), "--step-tolerance is 0.5; it is above 0 and at most 0.0316"),
        ((*ELASTIC, "--fineness", "0"), "--fineness is 0"),
        ((*ELASTIC, "--measured", "norecord.csv"), "norecord.csv"),
        ((*ELASTIC, "--rain-hours", "2"), "rain needs its rate in mm/h and its duration"),
        (("--material", "toyoura", "--void-ratio", "0.8", "--suction", "-5"), "the suction is -5; it is 0 or more kPa"),
        (("--material", "toyoura", "--void-ratio", "0.8", "--water-table", "-1"), "a plate stands on ground"),
        (("--material", "toyoura", "--void-ratio", "-0.8", "--suction", "9"), "the void ratio is -0.8; it is above 0"),
        ((*ELASTIC, "--poisson", "0.6"), "it lies from 0 to 0.5"),
        ((*ELASTIC, "--rain", "5"), "rain needs its rate in mm/h and its duration"),
        ((*ELASTIC, "--rain", "5", "--rain-hours", "1"), "rain falls on soil: the upper layer is elastic"),
        ((*ELASTIC, "--suction", "30"), "elastic ground is dry"),
        (("--material", "elastic:3e4:0.3:1", "--void-ratio", "0.6"), "an elastic layer is elastic:YOUNG"),
        ((*ELASTIC, "--plate-mass", "15000"), "1.5e+04 kg rest on the ground, as in no device"),
        ((*ELASTIC, "--buffer", "354", "--fall-mass", "10000"), "1e+04 kg fall, as in no device"),
        ((*ELASTIC, "--grains", "26.5"), "the density of the grains is 26.5; it is above 0 and below 10 Mg/m3"),
        ((*ELASTIC, "--permeability", "1e-4"), "below 1e-06 m2, of 10 m/s of water"),
    ):
        done = lwd("test", *words, "--output", "refused")
        check(f"{words} is refused", done.returncode == 2 and said in done.stderr, done.stderr)
    (work / "taken").write_text("a file")
    done = lwd("test", *ELASTIC, "--output", "taken")
    check("a folder that is a file", done.returncode == 2 and "mud_lwd: [Errno" in done.stderr, done.stderr)
    # A run that ends on its own: the host's sentence.
    done = lwd("test", *SAND, "--void-ratio", "5", "--suction", "20", "--output", "fails")
    check("a run that fails", done.returncode == 3 and "the run with fineness 0.5" in done.stderr, done.stderr)


def test_a_plate_that_does_not_go_down_has_no_modulus(monkeypatch):
    # A heavy plate that still rises after the drop before; a modulus divides by the deflection.
    test = Test(device_of("zorn"), (Layer("elastic:30000"),), seating=0, measured=1)
    time = np.linspace(0.0, test.starts[0] + test.interval, 50)
    plate = {"time": time, "plate.u_z": time, "plate.v_z": np.ones(50), "plate.a_z": np.zeros(50)}
    run = type("Run", (), {"table": lambda self, name: plate, "histories": {}})
    monkeypatch.setattr(answers, "HostRun", lambda folder: run())
    try:
        answers.answers_of(test, "folder")
        told = "an answer"
    except Failed as problem:
        told = str(problem)
    check("it fails in a sentence", "the plate does not go down in drop_1" in told, told)


def test_a_finished_test_is_found_and_an_interrupted_one_goes_on():
    words = ("test", *ELASTIC, *SMALL, "--output", "again")
    process = subprocess.Popen(
        [sys.executable, "-m", "mud.lwd", *words],
        env=ENVIRONMENT,
        cwd=work,
        stderr=subprocess.PIPE,
        text=True,
        stdout=subprocess.DEVNULL,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    until = time.monotonic() + 120
    while not list(pathlib.Path(work / "again").glob("runs/*/run.json")) and time.monotonic() < until:
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    said = process.communicate()[1]
    check("interrupted", process.returncode == 130 and "the same command goes on" in said, (process.returncode, said))
    done = lwd(*words)
    check("what was finished is found", done.returncode == 0 and "found: fineness 0.5" in done.stdout, done.stdout)
    check("the rest is run, with the time that is left", "s left" in done.stdout, done.stdout)
    done = lwd(*words)
    check("nothing is run twice", done.stdout.count("found: ") == 4 and "run 1" not in done.stdout, done.stdout)


def test_a_chart_shows_that_suction_stiffens_the_ground():
    words = ("chart", *SAND, "--void-ratios", "0.8", "--suctions", "15", "60", "--output", "chart")
    done = lwd(*words)
    check("it runs", done.returncode == 0 and "2 of 2 tests" in done.stdout, (done.stdout, done.stderr))
    table = rows("chart/chart.csv")
    moduli, errors = ([float(r[k]) for r in table] for k in ("modulus_MPa", "error_MPa"))
    check("the modulus grows with suction", moduli[1] > moduli[0] + sum(errors), (moduli, errors))
    check("the saturation falls", float(table[0]["S_w"]) > float(table[1]["S_w"]) > 0, table)
    check("a picture", (work / "chart/chart.png").stat().st_size > 10000)
    before = time.monotonic()
    again = lwd(*words)
    check("finished tests are found", again.returncode == 0 and time.monotonic() - before < 60, again.stderr)
    # One of the grid that fails is told, and the others stay.
    done = lwd("chart", *SAND, "--void-ratios", "0.8", "5", "--suctions", "60", "--output", "chart")
    check(
        "a failure is told",
        done.returncode == 3 and "1 of 2 tests" in done.stdout and "e = 5, 60 kPa" in done.stderr,
        (done.stdout, done.stderr),
    )
