# SPDX-License-Identifier: MIT
"""mud_host with laws of others: MUD through its own UMAT gives the files of &mud byte for byte; a foreign UMAT gives
what the host's elastic law gives, and a Mohr-Coulomb one its strength."""
import math
import os
import re
import subprocess

import h5py

from checking import build, check, root, work
import tables  # noqa: E402 (checking knows its folder)

host, describe = build / "host/mud_host", build / "drivers/mud_describe"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}


def run(text, name):
    """What it says, and the folder of its files."""
    scene, folder = work / f"{name}.nml", work / name
    scene.write_text(text)
    done = subprocess.run([host, scene, "--output", folder, "--quiet"], capture_output=True, text=True, env=environment)
    return done, folder


def cells(path):
    """Rows without the rate evaluations, which a UMAT does not count."""
    return [{key: value for key, value in row.items() if key != "rates"} for row in tables.rows(path)]


def last_row(path):
    return tables.numbers(path)[-1]


def table(which, pattern):
    text = subprocess.run([describe, which], capture_output=True, text=True).stdout
    return re.findall(pattern, text, re.MULTILINE)


# An elastic law of others, isotropic by its constants, is that of the host but for rounding.
YOUNG, POISSON = 1e4, 0.25

# Mohr-Coulomb between smooth plates: sigma_1 = N sigma_3 + 2 c sqrt(N), in every point of two elements.
C, PHI, PSI, HELD = 5.0, 30.0, 10.0, 100.0


def test_both_run():
    umats = build / "tests/umats"

    # The same words for the same numbers, as keys of &mud and as PROPS of its UMAT.
    states, props = table("statev", r"^\| \d+ \| `(\w+)`"), dict(table("namelist", r"^   (\w+) = (\S+)"))

    # The stages ask for 1e-6, which &mud follows and a UMAT does not: both have it.
    props.update(memory_rule="1", tangent="3", theta="0.2", tolerance="1.0E-6")
    own = "&mud\n   name = 'sand'\n   " + "\n   ".join(f"{key} = {value}" for key, value in props.items()) + "\n/\n"
    places = {"void_ratio_at": "void_ratio", "saturation_at": "saturation", "saturation_slopes_at": "dsw_dpc",
              "suction_slope_at": "dsigma_dpc_11"}
    lines = ["name = 'sand'", f"library = '{build}/umat/libmud.so'", "props = " + ",\n".join(props.values()),
             f"nstatv = {len(states)}", "state_names = " + ",\n".join(states), "tangent = 'consistent'"]
    lines += [f"{key} = {states.index(name) + 1}" for key, name in places.items()]
    foreign = "&umat\n   " + "\n   ".join(lines) + "\n/\n"
    for name, file, changes in (
            ("suction", "verification/host/element/suction.nml", [("duration = 1.0e7", "duration = 1.0e6")]),
            ("pulse", "tests/host/scenes/restart.nml", [("checkpoint_steps = 2", "")])):
        text = (root / file).read_text()
        for old, new in changes:
            assert old in text, (name, old)
            text = text.replace(old, new)
        (one, left), (other, right) = (
            run(re.sub(r"&mud\n.*?^/\n", lambda _: law, text, flags=re.S |re.M),
                f"{name}_{n}") for n, law in (("own", own),
                                             ("foreign", foreign)))
        check(f"{name}: both run", one.returncode == other.returncode == 0, one.stderr + other.stderr)
        files = sorted(file.name for file in left.glob("*.csv"))
        check(f"{name}: there are tables to compare", len(files) >= 4, files)
        for file in files:
            check(f"{name}: MUD as a UMAT is MUD, digit by digit, in {file}", cells(left / file) == cells(right / file))

    # The start asks for S_w before the UMAT has begun a point: for the weight above it and the part of suction.
    text = """&scene name = 'start' fields = 'u-p_w-p_c' gravity = 9.81 /
&mesh r = 0, 1 r_cells = 1 z = -2, 0 z_cells = 2 /
LAW&permeability name = 'k' intrinsic = 1e-12 /
&region material = 'sand' retention = 'material' permeability = 'k' void_ratio = 0.7 /
&initial stress = 'geostatic' surface = 0 water_table = -4 surcharge = 20 /
&stage name = 'wet' analysis = 'quasi_static' duration = 100 dt = 50 tolerance = 1e-6 /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 20 /
&load group = 'top' kind = 'rain' value = 1e-7 /
&point name = 'mid' r = 0.5 z = -1 /
"""
    (one, left), (other, right) = (run(text.replace("LAW", law), f"start_{n}") for n, law in (("own", own),
                                                                                              ("foreign", foreign)))
    check("start: both run", one.returncode == other.returncode == 0, one.stderr + other.stderr)
    for file in ("histories.csv", "ledger.csv", "points_wet.csv"):
        check(f"start: MUD as a UMAT is MUD, digit by digit, in {file}", cells(left / file) == cells(right / file))
    wrong = re.sub("saturation_at = .*", f"saturation_at = {states.index('memory_11') + 1}", foreign)
    done, _ = run(text.replace("LAW", wrong), "start_wrong")
    check("start: an S_w that follows from the stress is refused", done.returncode == 15 and
          "for weights at the start, S_w = 0 " in done.stderr, f"{done.returncode} {done.stderr}")

    # One void ratio and one degree of saturation a point: what the host computes with is what the law keeps.
    text = (root / "tests/host/scenes/restart.nml").read_text()
    done, folder = run(re.sub(r"&mud\n.*?^/\n", lambda _: own, text, flags=re.S | re.M), "one_value")
    check("a scene with checkpoints runs", done.returncode == 0, done.stderr)
    with h5py.File(folder / "checkpoint.h5") as file:
        for name, field in (("void_ratio", "e"), ("saturation", "s")):
            kept, used = file["state"][:, states.index(name)], file[field][:]
            check(f"{name} of the law is that of the host", len(used) == 12 and (kept == used).all(), (kept, used))
    text = (root / "verification/host/terzaghi/scene.nml").read_text()
    assert "young = 1.0e4\n   poisson = 0.25" in text
    shear = YOUNG / (2 * (1 + POISSON))
    group = f"""&umat
   name = 'soil'
   library = '{umats}/orthotropic.so'
   props = {YOUNG}, {POISSON}, {shear}, {shear}, {shear}
   tangent = 'consistent'
/
"""
    (one, left), (other, right) = (
        run(re.sub(r"&elastic\n.*?^/\n", lambda _: law, text, flags=re.S | re.M), f"terzaghi_{n}")
        for n, law in (("own", re.search(r"&elastic\n.*?^/\n", text, re.S | re.M)[0]), ("foreign", group)))
    check("consolidation: both run", one.returncode == other.returncode == 0, one.stderr + other.stderr)
    if one.returncode == other.returncode == 0:
        mine, theirs = last_row(left / "histories.csv"), last_row(right / "histories.csv")
        # 500 steps, each solved to 1e-8 of the loads of 100 kPa.
        for key, size in (("top.u_z", 1e-2), ("base.p_w", 100), ("base.s_zz", 100), ("base.e", 1)):
            check(f"consolidation: {key}", abs(mine[key] - theirs[key]) <= 1e-8 * size, (mine[key], theirs[key]))
    n_phi = (1 + math.sin(math.radians(PHI))) / (1 - math.sin(math.radians(PHI)))
    done, folder = run(f"""&scene name = 'sample' fields = 'u' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&umat name = 'soil' library = '{umats}/mohr_coulomb.so' props = {YOUNG}, {POISSON}, {C}, {PHI}, {PSI} /
&region material = 'soil' void_ratio = 0.8 /
&initial stress = 'uniform' sigma = -{HELD}, -{HELD}, -{HELD} /
&history name = 'ramp' times = 0, 1 values = 0, 1 /
&stage name = 'shear' analysis = 'static' duration = 1 dt = 0.02 tolerance = 1e-10 max_iterations = 60 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'u_z' value = -0.06 history = 'ramp' /
&load group = 'right' kind = 'pressure' value = {HELD} /
""", "sample")
    check("Mohr-Coulomb runs", done.returncode == 0, done.stderr)
    if done.returncode == 0:
        rows = tables.numbers(folder / "points_shear.csv")
        strength = n_phi * HELD + 2 * C * math.sqrt(n_phi)
        apart = max(abs(-row["s_zz"] / strength - 1) for row in rows)
        # Newton's tolerance, 1e-10 of the forces, is what is left.
        check("Mohr-Coulomb fails at its strength in every point", apart < 1e-8, apart)
