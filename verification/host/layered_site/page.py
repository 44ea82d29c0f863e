# SPDX-License-Identifier: MIT
"""A layered site with Rayleigh damping on ground that carries waves away, against its exact transfer function."""
import numpy as np
from tools import tables
from tools.page import Page, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="three layers with Rayleigh damping on a compliant base answer six waves that come in as their exact transfer "
          "function says, within 1 % at the settings of the program, and no run ends as if it had created energy",
    kind="exact",
    input="`scene.nml`: 26 m of three layers, alpha 1.5 to 3/s, beta 1 to 2.5 ms, a base of 2.4 Mg/m3 and 1000 m/s; six "
          "waves of 0.1 m/s: Ricker's wavelets of 2 and 5 Hz, a triangle, a step, a burst, noise",
    reference="the layers with complex moduli, solved from the surface downwards at every frequency",
    seconds=12, quick=4, pictures=("layered_site.png",))

LAYERS = ((6.0, 1.053e5, 1.8, 2.0, 2.5e-3), (8.0, 2.6e5, 2.0, 3.0, 1.5e-3), (12.0, 9.36e5, 2.1, 1.5, 1.0e-3))
IMPEDANCE, PEAK, POISSON = 2.4 * 1000, 0.1, 0.3
ASKED = Tolerance("what the default step tolerance leaves here: 1 % of the range of a displacement", absolute=0.01)
LEFT = Tolerance("a hundredth of what ends a run", absolute=1e-4)
STEP = 2.5e-4   # of the exact history [s]: a tenth of the shortest time of an input divides it


def ricker(frequency, centre, step):
    time = np.arange(0, 2 * centre + 1e-9, step)
    a = (np.pi * frequency * (time - centre))**2
    return time, (1 - 2 * a) * np.exp(-a)


def burst(frequency, length):
    time = np.arange(0, length + 1e-9, 0.01)
    return time, np.sin(2 * np.pi * frequency * time) * np.sin(np.pi * time / length)**2


def noise(length, seed=7):
    time = np.arange(0, length + 1e-9, 0.01)
    parts = np.fft.rfft(np.random.default_rng(seed).standard_normal(len(time)))
    frequency = np.fft.rfftfreq(len(time), 0.01)
    parts[(frequency < 0.5) | (frequency > 12)] = 0
    values = np.fft.irfft(parts, len(time)) * np.sin(np.pi * time / length)**2
    return time, values / np.abs(values).max()


WAVES = {"triangle": (np.array([0, 0.1, 0.2]), np.array([0, 1.0, 0])), "Ricker, 5 Hz": ricker(5.0, 0.3, 0.005),
         "Ricker, 2 Hz": ricker(2.0, 0.8, 0.01), "step": (np.array([0, 0.05, 1, 1.05]), np.array([0, 1.0, 1, 0])),
         "burst, 3 Hz": burst(3.0, 2.0), "noise, 0.5 to 12 Hz": noise(3.0)}


def transfer(omega):
    """Velocity of the surface over that of the wave that comes in."""
    u, stress = np.ones(len(omega), complex), np.zeros(len(omega), complex)
    for depth, young, rho, alpha, beta in LAYERS:
        modulus = young / 2 / (1 + POISSON) * (1 + 1j * omega * beta)
        k = np.sqrt(rho * (omega**2 - 1j * omega * alpha) / modulus)
        c, s = np.cos(k * depth), np.sin(k * depth)
        u, stress = u * c - stress * s / (modulus * k), stress * c + u * modulus * k * s
    # traction -rho c (v - 2 v_in) at the base, whose outward normal looks down
    return 1j * omega / (0.5 * (1j * omega * u - stress / IMPEDANCE))


def exact(time, values, until):
    """Times and displacements of the surface; the velocity of the input is linear between its points."""
    n = 1 << int(np.ceil(np.log2(3 * until / STEP)))
    at = np.arange(n) * STEP
    omega = 2 * np.pi * np.fft.rfftfreq(n, STEP)
    ratio = np.empty(len(omega), complex)
    ratio[1:] = transfer(omega[1:])
    # a steady motion is held by the damping of the mass alone
    ratio[0] = 2 / (1 + sum(depth * rho * alpha for depth, _, rho, alpha, _ in LAYERS) / IMPEDANCE)
    v = np.fft.irfft(np.fft.rfft(np.interp(at, time, PEAK * values, right=0)) * ratio, n)
    return at, np.concatenate([[0], np.cumsum((v[1:] + v[:-1]) / 2 * STEP)]), v


def listed(numbers):
    """A list of a namelist, broken into lines."""
    words = [f"{x:.10g}" for x in numbers]
    return ",\n   ".join(", ".join(words[i:i + 8]) for i in range(0, len(words), 8))


def check(bench):
    results = {}
    for name, (time, values) in list(WAVES.items())[:2 if bench.quick else None]:
        values = values.copy()
        values[[0, -1]] = 0
        until = round(time[-1] + 1, 3)
        folder = bench.host("scene.nml", [("times = 0, 0.1, 0.2 values = 0, 1, 0",
                                           f"times = {listed(time)}\n   values = {listed(values)}"),
                                          ("duration = 1.2", f"duration = {until}")])
        h, ledger = (tables.columns(folder / table) for table in ("histories.csv", "ledger.csv"))
        at, u, v = exact(time, values, until)
        bench.near(f"{name}: displacement of the surface / its largest",
                   h["surface.u_r"] / np.abs(u).max(), np.interp(h["time"], at, u) / np.abs(u).max(), ASKED)
        bench.below(f"{name}: energy created / largest work of the wave",
                    -ledger["imbalance"].min() / np.abs(ledger["loads"]).max(), LEFT)
        results[name] = h, at, v
    return results


def draw(bench, results, plt):
    figure, axes = plt.subplots(2, 3, figsize=(11, 5), layout="constrained")
    for axis, (name, (h, at, v)) in zip(axes.flat, results.items()):
        shown = at <= h["time"][-1]
        axis.plot(at[shown], v[shown], color="0.6", lw=2.5, label="exact")
        axis.plot(h["time"], h["surface.v_r"], color=COLOURS[1], lw=0.9, label="mud_host")
        axis.set(title=name, xlabel="time [s]", ylabel="velocity of the surface [m/s]")
    axes.flat[0].legend()
    bench.save(figure, "layered_site.png")
