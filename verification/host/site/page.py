# SPDX-License-Identifier: MIT
"""A column of saturated sand, shaken until it liquefies: pore pressures, stress paths and what reaches the surface."""
import numpy as np
from tools import tables
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="a column of loose saturated sand between tied sides, shaken with 2 Hz and 0.1 g, liquefies: r_u approaches 1, the "
          "surface comes to rest, and momentum, volume and energy stay in balance, with the settings of the program",
    kind="conservation",
    input="`scene.nml`: 10 m, e 0.88, permeability 1e-11 m2, surcharge 5 kPa, 10 cells, steps of 10 ms; `shake.txt`",
    reference="weight of the column, its momentum, the volume that it loses; the same with half the step",
    seconds=60, quick=4, pictures=("site.png",))

DEPTHS = {"2 m": "z020", "5 m": "z050", "8 m": "z080"}
VOIDS, WIDTH, SURCHARGE, G = 0.88, 0.5, 5.0, 9.81
K_W = 2.2e6
SIMPSON = np.array([1] + [4, 2] * 9 + [4, 1]) / 6     # along the column, as the quadratic cells of 1 m have it
RHO = (2.65 + VOIDS) / (1 + VOIDS)
LIQUEFIED = Tolerance("the usual criterion of liquefaction, r_u of at least 0.95", absolute=0.05)
AT_REST = Tolerance("sand without effective stress carries no shear waves: a quarter of the base's motion", absolute=0.25)
WEIGHT = Tolerance("the stress of a node is that of the nearest quadrature point, in cells of 1 m where it grows by 8.6 kPa/m: "
                   "a tenth of a cell", absolute=1.0)
MOMENTUM = Tolerance("second order: (omega dt)**2/12 = 1.3e-3 of the peak at 2 Hz; the spikes of dilation have "
                     "harmonics of three times that frequency", absolute=0.01)
VOLUME = Tolerance("small strains, and Newton's tolerance: the outflow itself follows what is stored", relative=5e-3)
ENERGY = Tolerance("the guard acts at 1 %; the error of Newton's tolerance and steps of 10 ms is to be a tenth of it, and four "
                   "times as much with twice the step", absolute=1e-3)
HALF = Tolerance("of second order: a quarter of the difference remains; 2 % of the quantity is the usual requirement of engineers",
                 absolute=0.02)


def run(bench, changes=()):
    folder = bench.host("scene.nml", changes)
    return [tables.columns(folder / name) for name in ("histories.csv", "ledger.csv", "reactions_shake.csv")]


def pore_pressure_ratio(h, name):
    """1 less the vertical effective stress over the first one, smoothed stresses of both."""
    return 1 - h[f"{name}.s_zz"] / h[f"{name}.s_zz"][0]


def balances(bench, h, ledger, reactions, coarse=1):
    for depth, name in DEPTHS.items():
        total = h[f"{name}.p_w"] - h[f"{name}.s_zz"]
        bench.near(f"{depth}: vertical total stress, every step", total, SURCHARGE + RHO * G * float(depth[:-2]), WEIGHT,
                   "kPa")
    v = np.array([h[f"z{5 * i:03d}.v_r"] for i in range(21)])
    momentum = RHO * WIDTH * SIMPSON @ v
    at = reactions["time_of_forces"]
    force = reactions["bottom.force_r"]
    impulse = np.concatenate([[0], np.cumsum(np.diff(at) * (force[1:] + force[:-1]) / 2)])
    mean = np.interp(at, h["time"], momentum)
    bench.near("impulse of the base less momentum of the column / its peak", (impulse - mean + mean[0]) / np.abs(mean).max(),
               0.0, MOMENTUM)
    bench.below("energy left open / work of the base, over the square of the step / 10 ms",
                np.abs(ledger["imbalance"]).max() / np.abs(ledger["supports"]).max() / coarse**2, ENERGY)


def check(bench):
    if bench.quick:
        balances(bench, *run(bench, [("duration = 5.5", "duration = 1.5"), ("dt = 0.01 ", "dt = 0.02 ")]), coarse=2)
        return None
    h, ledger, reactions = run(bench)
    balances(bench, h, ledger, reactions)
    for depth in ("5 m", "8 m"):
        bench.below(f"{depth}: 1 - r_u at the end", 1 - pore_pressure_ratio(h, DEPTHS[depth])[-1], LIQUEFIED)
    late = (h["time"] > 4.5) & (h["time"] < 5.5)
    bench.below("surface / base: peak acceleration of the last second before the taper ends",
                np.abs(h["z000.a_r"][late]).max() / np.abs(h["z100.a_r"][late]).max(), AT_REST)
    settled = -(h["z000.u_z"][-1] - h["z000.u_z"][0])
    rise = np.array([h[f"z{5 * i:03d}.p_w"][-1] - h[f"z{5 * i:03d}.p_w"][0] for i in range(21)])
    pressed = VOIDS / (1 + VOIDS) / K_W * WIDTH * SIMPSON @ rise
    bench.near("settlement times width less what the water is pressed together, against the outflow",
               settled * WIDTH - pressed, ledger["outflow"][-1], VOLUME, "m3")
    fine, _, _ = run(bench, [("dt = 0.01 ", "dt = 0.005 ")])
    for depth, name in DEPTHS.items():
        bench.near(f"{depth}: r_u, against half the step", pore_pressure_ratio(h, name),
                   np.interp(h["time"], fine["time"], pore_pressure_ratio(fine, name)), HALF)
    bench.near("settlement / that of half the step", settled / -(fine["z000.u_z"][-1] - fine["z000.u_z"][0]), 1.0, HALF)
    return h


def draw(bench, h, plt):
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.3))
    for colour, (depth, name) in zip(COLOURS, DEPTHS.items()):
        axes[0].plot(h["time"], pore_pressure_ratio(h, name), color=colour, label=depth)
        axes[1].plot(-h[f"{name}.s_zz"], h[f"{name}.s_rz"], color=colour, label=depth, lw=0.7)
    axes[0].set(xlabel="time [s]", ylabel="r_u", ylim=(0, 1.02))
    axes[0].legend(title="depth")
    axes[1].set(xlabel="vertical effective stress [kPa]", ylabel="shear stress [kPa]", xlim=(0, None))
    axes[2].plot(h["time"], h["z100.a_r"], color="0.6", label="base")
    axes[2].plot(h["time"], h["z000.a_r"], color=COLOURS[1], label="surface")
    axes[2].set(xlabel="time [s]", ylabel="acceleration [m/s2]")
    axes[2].legend()
    bench.save(figure, "site.png")
