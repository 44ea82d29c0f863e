# SPDX-License-Identifier: MIT
"""The deflectometer of mud_lwd on an elastic half space and on sand: closed forms, sides, steps, energy, suction."""
import math
import os
import subprocess
import sys

import numpy as np
from tools import tables
from tools.bench import ROOT
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="the plate of `mud_lwd` settles on an elastic layer as the closed form says and answers the pulse of a drop "
          "as Lysmer's analogue does; a mass that falls on its spring gives the pulse of the closed form; its sides "
          "change the peak by less than 1 %, energy is kept, and the errors that it tells hold what `mud_study` finds",
    kind=("exact", "conservation", "study"),
    input="scenes that `mud_lwd` writes: elastic ground of 30 MPa (Poisson's ratio 0.3), plate of 300 mm, half sine of "
          "7.07 kN in 17 ms; Toyoura sand, e = 0.8, suction 30 kPa",
    reference="pi/2 (1 - nu^2) sigma r/E of a rigid plate, with Kausel's (1974) factor of a layer on a rigid base; one "
              "degree of freedom with the stiffness and the dashpot of Lysmer & Richart (1966)",
    seconds=40, quick=10, pictures=("lwd.png",))
MAKES = (Script("chart.py", ("chart.csv", "chart.png", "drops.csv", "plates.csv", "study.csv", "test.png"), 1100),)

YOUNG, POISSON, RADIUS, PEAK = 3e4, 0.3, 0.15, 100 * math.pi * 0.15**2
SHEAR, DENSITY = YOUNG / (2 * (1 + POISSON)), 2.65 / 1.6
FAR = 60   # radii to base and side of the static plate
BASE = Tolerance("cells of a seventh of the radius below the rim, where the stress is singular; sides 60 radii away",
                 relative=0.01)
ANALOGUE = Tolerance("the analogue has constant stiffness and damping, which the half space has not: a few per cent",
                     relative=0.05)
SIDES = Tolerance("what the deflectometer may lose", absolute=0.01)
KEPT = Tolerance("algorithmic damping of steps of tolerance 0.03 over a drop, a share of the work of the loads",
                 absolute=0.02)
LANDS = Tolerance("contact that opens and closes: what algorithmic damping takes falls with the tolerance",
                  absolute=0.03)
PLATE = Tolerance("the plate lifts off after the peak; penalty of the contact", relative=0.01)
TOLD = Tolerance("an error that is told holds: what the study finds with less lies within it", absolute=1.0)
MET = Tolerance("what the study was asked for", absolute=5.0)
RIGID = Tolerance("steps of tolerance 0.03 over the pulse", relative=0.005)


def lwd():
    sys.path.insert(0, str(ROOT / "python"))
    from mud.lwd import answers, device, ground
    return answers, device, ground


def run(bench, text, fineness=1, tolerance=0.03):
    folder = bench.folder()
    (folder / "scene.nml").write_text(text, encoding="utf-8")
    done = subprocess.run([bench.program("host/mud_host"), folder / "scene.nml", "--output", folder / "out", "--quiet",
                           "--fineness", str(fineness), "--step-tolerance", str(tolerance)],
                          capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    return folder / "out"


def static_settlement(bench, ground, device):
    """Of the plate under its load at rest, far from base and sides [m]."""
    test = ground.Test(device.device_of("zorn"), (ground.Layer(f"elastic:{YOUNG:g}:{POISSON:g}"),), width=FAR * RADIUS,
                       depth=FAR * RADIUS)
    text = "\n".join(["&scene name = 'plate' fields = 'u' /", *ground.mesh_of(test), *ground.regions_of(test),
                      "&stage name = 'load' analysis = 'static' duration = 1 dt = 1 /",
                      f"&plate name = 'plate' group = 'top_1' mass = 0.015 force = {-PEAK} /",
                      "&fix group = 'left' field = 'u_r' /", "&fix group = 'right' field = 'u_r' /",
                      "&fix group = 'bottom' field = 'u_z' /", ""])
    return -tables.columns(run(bench, text, 2) / "contact.csv")["plate.u_z"][-1]


def analogue(mass):
    """Times and displacements of a mass on Lysmer's spring and dashpot under the half sine."""
    k = 4 * SHEAR * RADIUS / (1 - POISSON)
    c = 3.4 * RADIUS**2 * math.sqrt(SHEAR * DENSITY) / (1 - POISSON)
    dt, pulse = 1e-6, 0.017
    t = np.arange(0, 0.03, dt)
    u, v, path = 0.0, 0.0, []
    for time in t:
        path.append(u)
        force = PEAK * math.sin(math.pi * time / pulse) if time < pulse else 0.0
        v += dt * (force - c * v - k * u) / mass   # symplectic Euler: error of the order of dt
        u += dt * v
    return t, np.array(path)


def drop(bench, parts, layer, fineness=1, tolerance=0.03, buffer=None, **more):
    """A single drop: the answers, and the folder."""
    answers, device, ground = parts
    test = ground.Test(device.device_of("zorn", buffer=buffer), (layer,), seating=0, measured=1, **more)
    folder = run(bench, ground.scene_of(test), fineness, tolerance)
    return answers.answers_of(test, folder), folder


def check(bench):
    os.environ["MUD_LIBRARY_DIR"] = str(bench.build)
    parts = answers, device, ground = lwd()
    elastic = ground.Layer(f"elastic:{YOUNG:g}:{POISSON:g}")
    # On a layer of the thickness H the stiffness is 1 + 1.28 r/H times that of the half space.
    closed = math.pi / 2 * (1 - POISSON**2) * 100 * RADIUS / YOUNG / (1 + 1.28 / FAR)
    moved = static_settlement(bench, ground, device)
    bench.near("settlement of the static plate", 1e3 * moved, 1e3 * closed, BASE, "mm")
    t, u = analogue(0.015)
    wide, _ = drop(bench, parts, elastic, 2, width=4.8, depth=4.8)
    bench.near("largest deflection of a drop", 1e3 * wide.deflection, 1e3 * u.max(), ANALOGUE, "mm")
    usual, folder = drop(bench, parts, elastic)
    held, _ = drop(bench, parts, elastic, fixed=True)
    bench.below("held sides against absorbing ones, share of the peak",
                abs(held.deflection / usual.deflection - 1), SIDES)
    far, _ = drop(bench, parts, elastic, width=4.8)
    bench.below("sides twice as far away, share of the peak", abs(far.deflection / usual.deflection - 1), SIDES)
    hard, _ = drop(bench, parts, ground.Layer("elastic:3e7:0.3"), buffer=250.0)
    weight = 0.01 * device.G
    bench.near("peak of 10 kg from 0.72 m on 250 kN/m and hard ground", hard.drops[0].force,
               weight + math.sqrt(weight**2 + 2 * weight * 0.72 * 250), RIGID, "kN")
    bench.below("energy that is not accounted for up to the peak, of the work of the loads",
                unaccounted(folder, usual.drops[0].at), KEPT)
    tied, folder = drop(bench, parts, elastic, tied=True)
    bench.below("a tied plate: the same of all the drop", unaccounted(folder), KEPT)
    bench.near("the first peak of a loose plate beside that of a tied one", 1e3 * usual.deflection,
               1e3 * tied.deflection, PLATE, "mm")
    curves = {"time": 1e3 * t, "analogue": 1e3 * u, "host": history_of(wide)}
    if bench.quick:
        return curves
    sand = ground.Layer("toyoura", 0.8)
    grounds = {"elastic": (elastic, {}), "sand": (sand, {"suction": 30.0})}
    for name, (layer, more) in grounds.items():
        rough, coarse, usual = (
            drop(bench, parts, layer, f, a, **more) for f, a in ((0.5, 0.03 * 10**0.5), (0.5, 0.03), (1, 0.03)))
        told = (abs(usual[0].deflection - coarse[0].deflection) / 2
                + abs(coarse[0].deflection - rough[0].deflection))
        last = study(bench)[name][-1]
        bench.below(f"{name}: total error that the study tells, per cent", float(last["total_percent"]), MET)
        bench.below(f"{name}: what the study finds apart from a test, over what a test tells",
                    abs(1e-3 * float(last["deflection_mm"]) - usual[0].deflection) / told, TOLD)
    held, _ = drop(bench, parts, sand, suction=30.0, fixed=True)
    bench.below("sand: held sides against absorbing ones, share of the peak",
                abs(held.deflection / usual[0].deflection - 1), SIDES)
    bench.below("sand: energy that is not accounted for up to the peak, of the work of the loads",
                unaccounted(usual[1], usual[0].drops[0].at), KEPT)
    folder = drop(bench, parts, elastic, tolerance=0.003)[1]
    bench.below("a loose plate that lands again, steps of a tenth of the tolerance: the same of all the drop",
                unaccounted(folder), LANDS)
    return curves


def unaccounted(folder, until=math.inf):
    """Largest imbalance of energy up to a time since the drop, over the largest work of the loads."""
    ledger = tables.columns(folder / "ledger.csv")
    seen = ledger["time"] <= 2 + until
    return np.abs(ledger["imbalance"][seen]).max() / np.abs(ledger["loads"]).max()


def history_of(answers):
    time, moved = answers.history["time"], answers.history["deflection"]
    seen = time >= 2 - 1e-9
    return 1e3 * (time[seen] - 2), 1e3 * (moved[seen] - moved[seen][0])


def study(bench):
    """Rows of study.csv, by ground."""
    rows = tables.rows(bench.here / "study.csv")
    return {name: [r for r in rows if r["ground"] == name] for name in dict.fromkeys(r["ground"] for r in rows)}


def stiffness(row):
    """Shear modulus by eq. (3) at rest, a radius below the surface, over G_0 p_atm [-].

    Its mean effective stress is that of suction and of the weight with K_0 = 0.5.
    """
    e, s_w, suction = (float(row[key]) for key in ("void_ratio", "S_w", "suction_kPa"))
    weight = 9.81 * RADIUS * (2.65 + s_w * e) / (1 + e)
    return (2.97 - e)**2 / (1 + e) * math.sqrt((s_w * suction + 2 / 3 * weight) / 101.325)


def texts(bench):
    """The committed tables, and how the modulus grows with suction."""
    rows, drops = (tables.rows(bench.here / f"{name}.csv") for name in ("chart", "drops"))
    chart = tables.markdown(
        ("void ratio", "suction [kPa]", "S_w", "modulus [MN/m2]", "error", "deflection [mm]", "modulus over the first",
         "G of eq. (3) over the first"),
        [(r["void_ratio"], r["suction_kPa"], r["S_w"], r["modulus_MPa"], r["error_MPa"], r["deflection_mm"],
          f"{float(r['modulus_MPa']) / float(rows[0]['modulus_MPa']):.2f}", f"{stiffness(r) / stiffness(rows[0]):.2f}")
         for r in rows])
    for ratio in dict.fromkeys(r["void_ratio"] for r in rows):
        kept = [r for r in rows if r["void_ratio"] == ratio and r["modulus_MPa"]]
        stress = [float(r["S_w"]) * float(r["suction_kPa"]) for r in kept]
        power = np.polyfit(np.log(stress), np.log([float(r["modulus_MPa"]) for r in kept]), 1)[0]
        chart += f"\ne = {ratio}: the modulus grows with the power {power:.2f} of S_w p_c.\n"
    return {"README.md": {
        "chart": chart,
        "drops": tables.markdown(
            ("drop", "kind", "deflection [mm]", "error", "modulus [MN/m2]", "error", "rebound [mm]", "settlement [mm]"),
            [(r["drop"], r["kind"], r["deflection_mm"], r["deflection_error_mm"], r["modulus_MPa"],
              r["modulus_error_MPa"], r["rebound_mm"], r["settlement_mm"]) for r in drops]),
        "plates": tables.markdown(
            ("plate", "drop", "deflection [mm]", "error", "rebound [mm]", "settlement [mm]", "error", "lift [mm]",
             "force [kN]", "modulus of the test [MN/m2]", "error"),
            [tuple(r.values()) for r in tables.rows(bench.here / "plates.csv")]),
        "study": tables.markdown(
            ("ground", "fineness", "step tolerance", "mesh [%]", "steps [%]", "Newton, stress [%]", "total [%]",
             "deflection [mm]", "seconds", "state"),
            [tuple(r.values()) for rows in study(bench).values() for r in rows])}}


def draw(bench, curves, plt):
    figure, axis = plt.subplots(figsize=(4.4, 3.2))
    axis.plot(curves["time"], curves["analogue"], "k--", lw=1, label="Lysmer's analogue")
    t, u = curves["host"]
    axis.plot(t[t < 30], u[t < 30], "o-", ms=2.5, lw=0.8, mfc="w", label="mud_lwd")
    axis.set(xlabel="time since the drop [ms]", ylabel="deflection [mm]")
    axis.legend()
    bench.save(figure, "lwd.png")
