# SPDX-License-Identifier: MIT
"""A rigid foundation of mud_host with three degrees of freedom: harmonic compliances of a strip, an eccentric drop, the
rocking of a block that uplifts."""
import numpy as np
from scipy.integrate import solve_ivp
from tools import tables
from tools.page import Page, Script, Tolerance
from half_plane import compliance
from make_waves import PERIOD, SLOWEST, STEPS

PAGE = Page(
    claim="a rigid foundation that moves in the plane: swaying, rocking and vertical compliances of a strip that is tied "
          "to a half plane, against frequency; an eccentric drop; uplift and rocking of a block with its losses",
    kind="exact",
    input="`impedance.nml`: strip of 2 m, waves of 100 m/s, Poisson's ratio 1/4, absorbing sides at 20 m; `drop.nml`: 1 Mg falls "
          "5 cm on a foot 0.21 m beside its centre; `rocking.nml`: Housner's block on two feet",
    reference="the mixed boundary value problem of Luco and Westmann (1972), solved here by panels (`half_plane.py`); "
              "equations of motion of a rigid body on a spring; Housner (1963)",
    seconds=90, quick=4, pictures=("foundation.png",))
MAKES = (Script("make_waves.py", ("waves.txt",), 1),)

G, NU, RHO, B, LIGHT = 2e4, 0.25, 2.0, 1.0, 0.01
CURVE = Tolerance("the stress beside the edges of the strip is singular: cells of 6 cm there cost 1.5 % (static, by meshes); "
                  "absorbing sides at twenty half widths; of the magnitude", absolute=0.04)
SAME = Tolerance("Newton's tolerance of 1e-6", absolute=1e-4)
STATIC = Tolerance("panels of constant traction err in proportion to their width, which is extrapolated; frequency 0.005",
                   relative=1e-3)
BOUNCE = Tolerance("errors of steps, 0.1 % asked for, of the speed at the impact", absolute=2e-3)
FLIGHT = Tolerance("as above", relative=2e-3)
QUARTER = Tolerance("steps of 2 ms, feet of 2 mm on a penalty; of the quarter period", relative=3e-3)
PERIODS = Tolerance("half periods depend on the amplitude that impacts leave, which is good to 5 %", relative=0.05)
LOSS = Tolerance("Housner's impact is a blow at one corner: feet of 2 mm (2 % of the half width), and a coming foot that may bounce; "
                 "of the first amplitude", absolute=0.03)


def reference(frequency):
    """Compliance with the light mass of the strip."""
    of_ground = 2 * compliance(frequency, B, G, NU, RHO, 96) - compliance(frequency, B, G, NU, RHO, 48)
    return np.linalg.inv(np.linalg.inv(of_ground) - LIGHT * frequency**2 * np.eye(3))


def harmonics(bench, changes):
    """Complex amplitudes of u_r, u_z and the rotation at the four frequencies, in the last period."""
    table = tables.columns(bench.host("impedance.nml", changes) / "contact.csv")
    last = slice(-STEPS, None)
    waves = np.exp(-1j * np.outer(SLOWEST * np.arange(1, 5), table["time"][last]))
    return [2j / STEPS * waves @ table[f"strip.{name}"][last] for name in ("u_r", "u_z", "turn")]


def check_impedance(bench):
    smooth = [compliance(0.5, B, G, NU, RHO, n, bonded=False)[2, 2].real for n in (48, 96)]
    bench.near("half plane, smooth strip: static rocking compliance G b^2 c", G * (2 * smooth[1] - smooth[0]), 2 * (1 - NU) / np.pi,
               STATIC)
    turned = harmonics(bench, [])
    swayed = harmonics(bench, [("moment=1 force=1 force_r=0", "moment=0 force=0 force_r=1")])
    wanted = np.array([reference(SLOWEST * k) for k in range(1, 5)])
    pairs = {"rocking": (turned[2], wanted[:, 2, 2]), "vertical": (turned[1], wanted[:, 1, 1]),
             "swaying": (swayed[0], wanted[:, 0, 0])}
    for name, (found, exact) in pairs.items():
        bench.near(f"strip, {name}: compliances at four frequencies", abs(found - exact) / abs(exact), 0, CURVE)
    both = np.sqrt(abs(wanted[:, 0, 0] * wanted[:, 2, 2]))
    bench.near("strip, swaying under a moment, over the root of rocking times swaying", abs(turned[0] - wanted[:, 0, 2]) / both, 0, CURVE)
    bench.near("strip: swaying under a moment and rocking under a force are one", abs(turned[0] - swayed[2]) / abs(turned[0]), 0, SAME)
    return pairs


def check_drop(bench):
    out = bench.host("drop.nml")
    table = tables.columns(out / "contact.csv")
    mass, inertia, arms, height, stiffness = 1.0, 0.05, (0.2, 0.22), 0.05, 1e8
    g = 9.81

    def forces(u, w):
        """Of the part of the foot that presses: force and moment."""
        depth = [-(u + height + arm * w) for arm in arms]
        if max(depth) <= 0:
            return 0.0, 0.0
        x, weight = np.polynomial.legendre.leggauss(8)
        arm = (arms[0] + arms[1]) / 2 + (arms[1] - arms[0]) / 2 * x
        press = stiffness * np.maximum(0, -(u + height + arm * w)) * weight * (arms[1] - arms[0]) / 2
        return press.sum(), (press * arm).sum()

    def rate(_, y):
        force, moment = forces(y[0], y[1])
        return [y[2], y[3], force / mass - g, moment / inertia]

    fall = np.sqrt(2 * height / g)
    impact = solve_ivp(rate, (fall, 0.16), [-height, 0, -g * fall, 0], rtol=1e-9, atol=1e-12, max_step=2e-5)
    end = {"v_z": impact.y[2, -1], "v_turn": impact.y[3, -1]}
    bench.near("drop: vertical speed at the end, over that of the impact", table["body.v_z"][-1] / (g * fall), end["v_z"] / (g * fall), BOUNCE)
    bench.near("drop: rotation at the end, speed of the foot over that of the impact", table["body.v_turn"][-1] * 0.21 / (g * fall),
               end["v_turn"] * 0.21 / (g * fall), BOUNCE)
    middle = np.interp(0.16, table["time"], table["body.turn"])
    bench.near("drop: angle at the end", middle, impact.y[1, -1], FLIGHT)
    return table, impact


def housner(angle, duration):
    """Times of impacts, amplitudes after them, and the motion: exact pendulum about the corners."""
    half, slender, g = 0.5, 0.2, 9.81
    p2 = 3 * g / (4 * half)
    time, tilt, speed, side = 0.0, angle, 0.0, 1
    impacts, peaks, shown = [], [angle], []

    def touches(_, y):
        return y[0]
    touches.terminal, touches.direction = True, -1
    while time < duration:
        swing = solve_ivp(lambda _, y: [y[1], -p2 * np.sin(slender - y[0])], (0, 5), [tilt, speed], events=touches, rtol=1e-9,
                          atol=1e-12, max_step=5e-3)
        shown.append((time + swing.t, side * swing.y[0]))
        if impacts:
            peaks.append(swing.y[0].max())
        time += swing.t[-1]
        impacts.append(time)
        tilt, speed, side = 1e-13, -swing.y[1, -1] * (1 - 1.5 * np.sin(slender) ** 2), -side
    return np.array(impacts), np.array(peaks), np.concatenate([np.array(s) for s in shown], axis=1)


def check_rocking(bench):
    table = tables.columns(bench.host("rocking.nml") / "contact.csv")
    moving = table["time"] > 1
    time, tilt = table["time"][moving] - 1, table["block.turn"][moving]
    impacts, peaks, shown = housner(0.1, 2.5)
    at = np.flatnonzero(tilt[1:] * tilt[:-1] < 0)
    crossings = time[at] - tilt[at] * (time[at + 1] - time[at]) / (tilt[at + 1] - tilt[at])
    ends = [0, *at, len(tilt)]
    found = np.array([abs(tilt[i:k + 1]).max() for i, k in zip(ends[:-1], ends[1:])])
    n = 4
    bench.near("rocking: time of the first impact", crossings[0], impacts[0], QUARTER, "s")
    bench.near("rocking: half periods, three of them", np.diff(crossings)[:n - 1], np.diff(impacts)[:n - 1], PERIODS, "s")
    bench.near("rocking: amplitudes after impacts, over the first", found[:n] / 0.1, peaks[:n] / 0.1, LOSS)
    bench.note("rocking: amplitudes", np.round(found[:n], 4), "Housner", np.round(peaks[:n], 4))
    return time, tilt, shown


def check(bench):
    """What the picture shows."""
    drop, rocking = check_drop(bench), check_rocking(bench)
    return None if bench.quick else (check_impedance(bench), drop, rocking)


def draw(bench, found, plt):
    pairs, (table, impact), (time, tilt, shown) = found
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.4), layout="constrained")
    curve = np.linspace(0.2, 2.2, 21)
    exact = np.array([reference(SLOWEST * 2 * a) for a in curve])
    places = {"rocking": (2, 2), "vertical": (1, 1), "swaying": (0, 0)}
    for i, (name, (r, c)) in enumerate(places.items()):
        line, = axes[0].plot(curve, G * exact[:, r, c].real, color=f"C{i}", lw=1, label=name)
        axes[0].plot(curve, G * exact[:, r, c].imag, color=f"C{i}", lw=1, ls="--")
        for part in (pairs[name][0].real, pairs[name][0].imag):
            axes[0].plot([0.5, 1, 1.5, 2], G * part, "o", ms=4, color=line.get_color())
    axes[0].set(xlabel="omega b / c_s", ylabel="G times compliance", title="Strip: lines panels, dots host", ylim=(-0.75, 0.75))
    axes[0].legend(fontsize=8, ncols=3, loc="upper center")
    axes[1].plot(table["time"], table["body.v_z"], color="C0", label="host, v_z")
    axes[1].plot(table["time"], 0.21 * table["body.v_turn"], color="C1", label="host, foot by rotation")
    axes[1].plot(impact.t[::40], impact.y[2, ::40], ".", ms=3, color="k", label="rigid body on a spring")
    axes[1].plot(impact.t[::40], 0.21 * impact.y[3, ::40], ".", ms=3, color="k")
    axes[1].set(xlabel="time [s]", ylabel="speed [m/s]", title="Eccentric drop")
    axes[1].legend(fontsize=8)
    axes[2].plot(shown[0], shown[1], color="k", lw=1, label="Housner")
    axes[2].plot(time, tilt, color="C1", lw=1, label="host")
    axes[2].set(xlabel="time [s]", ylabel="rotation [-]", title="Rocking block", xlim=(0, 2.5))
    axes[2].legend(fontsize=8)
    bench.save(figure, "foundation.png")
