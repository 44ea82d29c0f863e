# SPDX-License-Identifier: MIT
"""Strength that follows a &history: where bodies fail, what a change does to a state, restarts, what is refused."""
import subprocess

from checking import build, check, work
from host_program import ENVIRONMENT, HOST, ran, start
import tables  # noqa: E402 (checking knows its folder)

CLAY = f"""&umat name = 'clay' library = '{build}/tests/umats/tresca.so' components = 4 tangent = 'consistent'
      props = 1e4, 0.3, 10 /
"""
#: A block in plane strain under 10 kPa; s_u = 10 kPa carries 20. It fades after the load.
BLOCK = """&scene name = 'block' fields = 'u' geometry = 'plane_strain' quadrature = 3 /
&mesh r = 0, 1 r_cells = 2 z = 0, 1 z_cells = 2 /
""" + CLAY + """&region material = 'clay' void_ratio = 0 /
&strength material = 'clay' parameter = 'props(3)' history = 'fade' /
&history name = 'ramp' times = 0, 1 values = 0, 1 /
&history name = 'fade' times = 0, 1, 2 values = 1, 1, 0 /
&stage name = 'load' analysis = 'static' duration = 1 dt = 0.5 /
&stage name = 'fade' analysis = 'static' duration = 1 dt = 0.04 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 10 history = 'ramp' /
&point name = 'top' r = 0 z = 1 /
"""
#: A triaxial sample of MUD; loose: its bounding stress ratio is M_c.
SAMPLE = """&scene name = 'sample' fields = 'u' quadrature = 3 /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&mud name = 'sand' e_0 = 0.95 /
&region material = 'sand' /
&strength material = 'sand' parameter = 'M_c' history = 'fade' /
&history name = 'fade' times = 0, 1 values = 1, 0.2 /
&initial stress = 'uniform' sigma = -75, -150, -75 /
&stage name = 'fade' analysis = 'static' duration = 1 dt = 0.01 tolerance = 1e-6 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 150 /
&load group = 'right' kind = 'pressure' value = 75 /
&point name = 'top' r = 0 z = 1 /
"""
M_C = 1.25
ABOVE, BESIDE = ("&load group = 'top' kind = 'pressure' value = 150 /",
                 "&load group = 'right' kind = 'pressure' value = 75 /")
HELD = SAMPLE.replace(ABOVE, "&fix group = 'top' field = 'u_z' /").replace(
    BESIDE, "&fix group = 'right' field = 'u_r' /")


def ends(name, text):
    """A run that fails, and the rows before."""
    done = start(name, text)
    check(f"{name}: it fails", done.returncode == 14, (done.returncode, done.stderr))
    return done, tables.numbers(work / name / "histories.csv")


def invariants(row):
    a, r = -row["top.s_zz"], -row["top.s_rr"]
    return a - r, (a + 2*r)/3


def test_a_block_fails_where_its_strength_is_used_up():
    # 10 kPa need 2 s_u f = 10 kPa: f = 0.5 at 1.5 s. Until then nothing yields, and nothing moves.
    done, rows = ends("block", BLOCK)
    last = rows[-1]["time"]
    check("the block fails at half its strength", 1.5 - 1e-4 < last < 1.5 + 1e-4, last)
    check("the message says what is left of the strength",
          "&strength props(3) of 'clay' is at 0.4999" in done.stderr, done.stderr)
    # With the elastic DDSDDE a slope of Mohr-Coulomb soil ends at a factor that is a quarter too small.
    words = "its tangent is approximate"
    check("with the tangent of the law that is a failure", words not in done.stderr, done.stderr)
    done, _ = ends("approximate", BLOCK.replace("tangent = 'consistent'", ""))
    check("without it may be Newton's method that fails", words in done.stderr, done.stderr)
    rest = next(row for row in rows if row["time"] == 1)
    check("before it yields it does not move", abs(rows[-2]["top.u_z"]/rest["top.u_z"] - 1) < 1e-9, rows[-2])


def test_a_failure_before_the_strength_changes_is_not_blamed_on_it():
    for load, blamed in (("10", True), ("30", False)):
        done, _ = ends(f"blame_{load}", BLOCK.replace("value = 10 history", f"value = {load} history"))
        check(f"{load} kPa: &strength is named: {blamed}", ("By &strength" in done.stderr) == blamed, done.stderr)


def test_a_sand_fails_where_its_ratio_is_the_strength():
    # q/p' = 0.75 stays; loose sand carries M_c f, so that it fails at f = 0.6, 0.5 s.
    _, rows = ends("sample", SAMPLE)
    check("the sample fails where M_c is its stress ratio", abs(rows[-1]["time"] - 0.5) < 1e-3, rows[-1]["time"])
    q, p = invariants(rows[-1])
    check("its stress is that of the load", abs(q/p - 0.75) < 1e-6, q/p)
    check("it has settled on the way", rows[-1]["top.u_z"] < -0.01, rows[-1]["top.u_z"])


def test_held_soil_keeps_its_share_of_the_strength():
    # Where nothing moves q/M_c and p' stay while M_c falls, and the stress stays where M_c rises again.
    text = HELD.replace("times = 0, 1 values = 1, 0.2", "times = 0, 0.5, 1 values = 1, 0.4, 0.9")
    rows = tables.numbers(work / "held/histories.csv") if ran("held", text) else []
    for row in rows:
        q, p = invariants(row)
        wanted = 75*(1 - 0.6*min(row["time"], 0.5)/0.5)
        check(f"held, {row['time']} s: q", abs(q/wanted - 1) < 1e-10, (q, wanted))
        check(f"held, {row['time']} s: p'", abs(p/100 - 1) < 1e-10, p)


def test_each_material_follows_its_own_history():
    # Beside the held sand another one, whose M_c falls to a half; the ground moves nowhere.
    text = HELD.replace("r = 0, 1 r_cells = 1", "r = 0, 1, 2 r_cells = 1, 1").replace(
        "&region material = 'sand' /", "&region group = 'block_1_1' material = 'sand' /\n"
        "&mud name = 'other' e_0 = 0.95 /\n&region group = 'block_2_1' material = 'other' /\n"
        "&strength material = 'other' parameter = 'M_c' history = 'half' /\n"
        "&history name = 'half' times = 0, 1 values = 1, 0.5 /\n&fix group = 'all' field = 'u_r' /\n"
        "&point name = 'far' r = 2 z = 1 /")
    rows = tables.numbers(work / "pair/histories.csv") if ran("pair", text) else []
    for name, share in (("top", 0.2), ("far", 0.5)):
        q = rows and rows[-1][f"{name}.s_rr"] - rows[-1][f"{name}.s_zz"]
        check(f"{name}: q is its share", q and abs(q/(75*share) - 1) < 1e-10, (q, 75*share))


def test_shearing_at_the_critical_state_follows_the_strength():
    # Sheared far, then on while M_c falls to 0.6 of itself: q/(M_c f p') is what it was.
    text = SAMPLE.replace("times = 0, 1 values = 1, 0.2", "times = 0, 1, 1.2 values = 1, 1, 0.6").replace(
        ABOVE,
        "&history name = 'push' times = 0, 1.2 values = 0, 1 /\n"
        "&fix group = 'top' field = 'u_z' value = -0.6 history = 'push' /").replace(
        "sigma = -75, -150, -75", "sigma = -75, -75, -75").replace("duration = 1 ", "duration = 1.2 ")
    rows = tables.numbers(work / "critical/histories.csv") if ran("critical", text) else []
    before = after = None
    for row in rows:
        q, p = invariants(row)
        if abs(row["time"] - 1) < 1e-9:
            before = q/p/M_C
        after = q/p/M_C/0.6
    check("at the critical state before the strength falls", before and abs(before - 1) < 0.03, before)
    check("and as near to it behind", after and abs(after/before - 1) < 0.01, (before, after))


def test_steps_of_their_own_end_at_its_kinks():
    text = BLOCK.replace("name = 'block'", "name = 'block' step_tolerance = 1e-2").replace(
        "times = 0, 1, 2 values = 1, 1, 0", "times = 0, 1.237, 1.613, 2 values = 1, 1, 0.6, 0.6").replace(
        "duration = 1 dt = 0.04", "duration = 1")
    rows = tables.numbers(work / "kinks/histories.csv") if ran("kinks", text) else []
    times = [row["time"] for row in rows]
    for kink in (1.237, 1.613):
        check(f"a step ends at {kink} s", any(abs(t - kink) < 1e-9 for t in times), times)


def test_a_restart_gives_the_same_bytes():
    text = SAMPLE.replace("values = 1, 0.2", "values = 1, 0.7").replace("fields = 'u'",
                                                                        "fields = 'u' checkpoint_steps = 37")
    if not ran("whole", text):
        return
    kept = work / "whole/checkpoint.h5"
    files = {path.name: path.read_bytes() for path in (work / "whole").iterdir() if path.suffix == ".csv"}
    if ran("whole", text, "--restart", kept):
        for name, content in files.items():
            check(f"restart: {name}", (work / "whole" / name).read_bytes() == content)
    done = start("other", text.replace("values = 1, 0.7", "values = 1, 0.6"), "--restart", kept, "--check")
    check("restart with another strength so far: refused with its history",
          done.returncode == 17 and "&history in line " in done.stderr, done.stderr)


def test_what_it_works_with():
    plain = BLOCK.replace("values = 1, 1, 0 ", "values = 1, 1, 0.6 ")
    never = plain.replace("&strength material = 'clay' parameter = 'props(3)' history = 'fade' /\n", "").replace(
        "&history name = 'fade' times = 0, 1, 2 values = 1, 1, 0.6 /\n", "")
    if ran("never", never) and ran("without", plain.replace("fields = 'u'", "fields = 'u' without = 'strength'")):
        check("without strength: as without the group, byte for byte", (work / "without/histories.csv").read_bytes()
              == (work / "never/histories.csv").read_bytes())
    soft = SAMPLE.replace("values = 1, 0.2", "values = 1, 0.7")
    # The ledger: slow settling creates and loses no energy.
    if ran("ledger", soft.replace("dt = 0.01", "dt = 0.005")):
        last = tables.numbers(work / "ledger/ledger.csv")[-1]
        check("the balance of energy is closed", abs(last["imbalance"]) < 1e-6*abs(last["loads"]), last)


def test_what_is_refused():
    again = "&strength material = 'clay' parameter = 'props(3)' history = 'ramp' /\n&history name = 'ramp'"
    two = BLOCK.replace("&history name = 'ramp'", again, 1)
    hooke = BLOCK.replace(CLAY, "&elastic name = 'clay' young = 1e4 poisson = 0.3 /\n")
    for what, text, code, words in (
            ("a material that is not there",
             BLOCK.replace("&strength material = 'clay'", "&strength material = 'peat'"), 11,
             "material = 'peat' is defined nowhere"),
            ("a history that is not there", BLOCK.replace("history = 'fade'", "history = 'fate'"), 11,
             "history = 'fate' is defined nowhere"),
            ("an elastic law", hooke, 2, "the law has no strength that could change"),
            ("a fourth of three PROPS", BLOCK.replace("props(3)", "props(4)"), 2,
             "one of props(1) to props(3) may change"),
            ("another parameter of MUD", SAMPLE.replace("'M_c'", "'h_0'"), 2, "of &mud M_c may change"),
            ("a start that is not 1", BLOCK.replace("values = 1, 1, 0", "values = 0.9, 1, 0"), 2,
             "it must be 1 there"),
            ("a value that the law refuses", SAMPLE.replace("1, 0.2", "1, 0.01"), 2,
             "with the factor 0.01 of history"),
            ("two histories of one", two, 2, "follows a history already")):
        done = start("refused", text, "--check")
        check(f"{what} is refused", done.returncode == code, (done.returncode, done.stderr))
        check(f"{what}: {words}", words in done.stderr, done.stderr)
    idle = BLOCK.replace("&region material = 'clay'", "&elastic name = 'rock' young = 1e4 poisson = 0.3 /\n"
                         "&region material = 'rock'")
    (work / "idle.nml").write_text(idle)
    done = subprocess.run([HOST, work / "idle.nml", "--check"], capture_output=True, text=True, env=ENVIRONMENT)
    check("the strength of ground that is not there: a warning", done.returncode == 0
          and "&umat 'clay' has no effect" in done.stdout + done.stderr, done.stdout + done.stderr)
