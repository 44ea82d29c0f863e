# SPDX-License-Identifier: MIT
"""Shear that localises, as a run tells it: the column of the ledger, the sentence, checkpoints, threads, and the study
that ends with it. Drucker-Prager's law tells by itself when; bands: verification/host/localisation."""
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

from checking import NO_LIBRARY, build, check, preset, root, work
from host_program import ENVIRONMENT, start

sys.path.insert(0, str(root / "common"))
import tables  # noqa: E402

SHEAR, POISSON, FRICTION, START, HARDENING, LAST = 2.0e4 / 2.4, 0.2, 0.6, -30.0, 5.0e3, 0.01
# A sample under 100 kPa on its side is pressed together by 3 %.
SAMPLE = f"""&scene name = 'sample' geometry = 'plane_strain' fields = 'u' checkpoint_steps = {{every}}
       threads = {{threads}} /
&mesh r = 0, 1 r_cells = {{cells}} z = 0, 2 z_cells = {{cells}} /
&umat name = 'soil' library = '{build}/tests/umats/drucker_prager.so' nstatv = 1
      props = 2.0e4, {POISSON}, {FRICTION}, {{dilatancy}}, {START}, {HARDENING}, {LAST}, -15, 0 /
&region material = 'soil' void_ratio = 0.8 {{region}} /
&initial stress = 'uniform' sigma = -100, -100, -100 /
&history name = 'ramp' times = 0, 1 values = 0, 1 /
&stage name = 'shear' analysis = '{{kind}}' duration = {{end}} dt = 0.01 tolerance = 1e-10 max_iterations = 60
       steps = 'given' zero_displacements = '{{zero}}' /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'u_z' value = -0.06 history = 'ramp' stages = 'shear' /
&load group = 'right' kind = 'pressure' value = 100 /
&point name = 'top' r = 0 z = 2 /
{{more}}"""


def scene(**keys):
    given = dict(dilatancy=0.1, cells=1, threads=1, every=0, kind="static", region="", end=0.8, zero="no", more="")
    return SAMPLE.format(**given | keys)


def sample(name, *words, **keys):
    done = start(name, scene(**keys), *words)
    check(f"{name} runs", done.returncode == 0, done.stderr)
    return done, work / name


def moduli(folder, dilatancy):
    """Hardening modulus of the law after every step, from the stress that it carries, and the largest at which Rudnicki
    & Rice have a band at this stress; both over G."""
    rows = tables.columns(folder / "histories.csv")
    mean = sum(rows[f"top.s_{c}"] for c in ("rr", "zz", "tt")) / 3
    deviators = [rows[f"top.s_{c}"] - mean for c in ("rr", "zz", "tt")]
    tau = np.sqrt(sum(s**2 for s in deviators) / 2 + rows["top.s_rz"] ** 2)
    carried = (tau + FRICTION * mean - START) / HARDENING / LAST   # g - g^2/2 of the plastic shear g over LAST
    falls = np.arange(len(carried)) > carried.argmax()
    left = np.sqrt(np.maximum(0, 1 - 2 * carried)) * np.where(falls, -1, 1)
    out = deviators[2] / np.maximum(tau, 1e-9)
    critical = (1 + POISSON) / (9 * (1 - POISSON)) * (dilatancy - FRICTION) ** 2 - (1 + POISSON) / 2 * (
        out + (dilatancy + FRICTION) / 3) ** 2
    yields = carried > 1e-9
    return (HARDENING / SHEAR * left)[1:], critical[1:], yields[1:]


def test_the_ledger_counts_from_the_onset_of_rudnicki_and_rice():
    # Far from associated: while the soil hardens. Associated: not before it softens.
    for dilatancy, hardens in ((-0.4, True), (0.1, False), (0.6, False)):
        done, folder = sample(f"onset_{dilatancy}", dilatancy=dilatancy)
        share = tables.columns(folder / "ledger.csv")["localised"]
        modulus, critical, yields = moduli(folder, dilatancy)
        first = int((share > 0).argmax())
        check(f"dilatancy {dilatancy}: a step before nothing is lost", first > 1 and not share[:first].any()
              and (modulus - critical)[:first][yields[:first]].min() > 0, (first, (modulus - critical)[first - 1]))
        check(f"dilatancy {dilatancy}: the first step below the critical modulus counts",
              modulus[first] <= critical[first], (modulus[first], critical[first]))
        check(f"dilatancy {dilatancy}: it hardens there", (modulus[first] > 0) == hardens, modulus[first])
        told = re.findall(r"shear localises.*?(\d+\.?\d*) % of the shear work.*?since (\S+) s.*normal at (\d+) degrees"
                          r".*state the cell.*viscosity", done.stderr)
        above = tables.columns(folder / "ledger.csv")["time"][(share > 0.05).argmax()]
        check(f"dilatancy {dilatancy}: told once, with the time",
              len(told) == 1 and abs(float(told[0][1]) - above) < 1e-9, done.stderr)


def test_what_does_not_localise_is_not_told():
    done, folder = sample("short", end=0.2)
    check("a share of zero", not tables.columns(folder / "ledger.csv")["localised"].any()
          and "localis" not in done.stderr, done.stderr)
    # Displacements that begin to count anew begin a new account; the sample is let go, which is elastic.
    on = ("&stage name = 'on' analysis = 'static' duration = 0.1 dt = 0.05 tolerance = 1e-10 max_iterations = 60 /\n"
          "&fix group = 'top' field = 'u_z' value = 1e-3 history = 'back' stages = 'on' /\n"
          "&history name = 'back' times = 0.8, 0.9 values = 0, 1 /\n")
    done, folder = sample("zeroed", zero="yes", more=on)
    ledger = tables.columns(folder / "ledger.csv")
    check("the account starts anew", (ledger["localised"][ledger["stage"] == 1] > 0.05).any()
          and not ledger["localised"][ledger["stage"] == 2].any(), ledger["localised"])


def test_threads_and_checkpoints_leave_the_share_as_it_is():
    # 128 elements, so that threads share them, with the viscosity that lets a band of softening soil be followed.
    viscous = dict(cells=8, kind="quasi_static", region="viscosity = 50")
    told, one = sample("one", **viscous)
    _, two = sample("two", threads=2, **viscous)
    check("it is told with a viscosity as well", "shear localises" in told.stderr, told.stderr)
    for name in ("ledger.csv", "histories.csv"):
        check(f"two threads: {name}", (one / name).read_bytes() == (two / name).read_bytes())
    # A run that is taken up writes the same bytes; what it has said before its checkpoint, it says at its end alone.
    whole, folder = sample("whole", every=60)
    bytes_ = (folder / "ledger.csv").read_bytes()
    again, _ = sample("whole", "--restart", str(folder / "checkpoint.h5"), every=60)
    check("a run that is taken up", "shear localises" in whole.stderr and "shear localises" not in again.stderr
          and (folder / "ledger.csv").read_bytes() == bytes_, again.stderr)


@pytest.mark.skipif(preset == "sanitize", reason=NO_LIBRARY)
def test_a_study_ends_as_localised():
    path, folder = work / "studied.nml", work / "studied"
    path.write_text(scene(cells=2))
    environment = {**ENVIRONMENT, "PYTHONPATH": str(root / "python"), "MUD_HOST": str(build / "host/mud_host"),
                    "MUD_LIBRARY_DIR": str(build)}
    done = subprocess.run([sys.executable, "-m", "mud.study", "accuracy", path, "--output", folder],
                          capture_output=True, text=True, env=environment)
    check("exit code 21", done.returncode == 21, done.stderr + done.stdout)
    check("with the words of the run", "localised: stage shear" in done.stderr and "lost ellipticity" in done.stderr
          and done.stderr.count("viscosity") == 1, done.stderr)
    check("and no finer mesh", not list(pathlib.Path(folder).glob("F4*")), sorted(p.name for p in folder.iterdir()))
