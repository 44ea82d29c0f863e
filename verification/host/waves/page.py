# SPDX-License-Identifier: MIT
"""Waves that leave a column, and layers that are shaken at the base, against closed forms."""
import numpy as np
from tools import tables
from tools.page import Page, Tolerance

PAGE = Page(
    claim="absorbing boundaries let waves at normal incidence out (shear, pressure, undrained with p_w); layers "
          "between tied sides with Rayleigh damping, shaken by a base acceleration or by a wave that comes in through "
          "a compliant base, have the transfer function of the layered column",
    kind="exact",
    input="`column.nml`: 20 m, a pulse of 10 kPa and 0.1 s on top; `layers.nml`: two layers of 10 m, c_s 150 and 300 "
          "m/s, alpha 4/s, beta 1 ms, Ricker's wavelet of 5 Hz (`ricker.txt`)",
    reference="d'Alembert's wave of velocity load/(rho c); the layered column with complex moduli, solved by hand",
    seconds=16, quick=12, pictures=("waves.png",))

E, NU, VOIDS, LOAD, PULSE = 2e5, 0.25, 0.65, 10.0, 0.1
SHEAR, CONSTRAINED = E / 2 / (1 + NU), E * (1 - NU) / (1 + NU) / (1 - 2 * NU)
REFLECTED = Tolerance("at normal incidence the dashpots are exact; the remaining error is the short waves of the mesh (cells "
                      "of 1/44 of the pulse, quadratic), and in saturated soil the water that flows against the "
                      "skeleton behind the front", absolute=0.01)
ARRIVAL = Tolerance("fourth order in the cells, second in steps of 1/200 of the pulse: 1e-3 of the peak; in saturated "
                    "soil seepage adds as much", relative=3e-3)
TRANSFER = Tolerance("steps of 1/50 of the shortest period that counts (10 Hz): (omega dt)**2/12 = 1.3e-3 of a "
                     "frequency, times 1/(2 xi) = 6 on the flank of a peak; the part cut off after 4 s is below 1e-3",
                     absolute=8e-3)
CONTENT = 0.02   # share of the largest amplitude of the input below which a ratio says nothing


def shape(lower, upper, omega, alpha=4.0, beta=1e-3, rho=2.0, depth=10.0):
    """Displacement at the base and its slope times the modulus, for 1 at the free surface."""
    g = [rho * c**2 * (1 + 1j * omega * beta) for c in (upper, lower)]
    k = [np.sqrt(rho * (omega**2 - 1j * omega * alpha) / m) for m in g]
    a, b = np.cos(k[0] * depth), -g[0] * k[0] * np.sin(k[0] * depth) / (g[1] * k[1])
    here = a * np.cos(k[1] * depth) + b * np.sin(k[1] * depth)
    return here, g[1] * k[1] * (b * np.cos(k[1] * depth) - a * np.sin(k[1] * depth))


def ricker(time, frequency=5.0, centre=0.3):
    """The lines between the pairs of `ricker.txt`."""
    at = np.arange(0, 2 * centre + 1e-9, 0.005)
    a = (np.pi * frequency * (at - centre))**2
    values = (1 - 2 * a) * np.exp(-a)
    values[[0, -1]] = 0
    return np.interp(time, at, values)


def spectrum(time, values):
    step = time[1] - time[0]
    return np.fft.rfftfreq(len(values), step), np.fft.rfft(values) * step


def wave(bench, name, changes, axis, modulus, rho):
    """Velocity half-way, checked while it passes and after it has gone."""
    h = tables.columns(bench.host("column.nml", changes) / "histories.csv")
    c = np.sqrt(modulus / rho)
    v = np.abs(h[f"middle.v_{axis}"]) / (LOAD / (rho * c))
    passed = h["time"] > 10 / c + PULSE + 0.02
    bench.near(f"{name}: peak of the velocity over load/(rho c)", v.max(), 1.0, ARRIVAL)
    bench.below(f"{name}: largest velocity after the wave has passed / peak", v[passed].max() / v.max(), REFLECTED)
    return h["time"], v


def check(bench):
    dry = VOIDS_SOLID * 2.65
    wet = dry + 1 - VOIDS_SOLID
    upwards = [("field = 'u_z'", "field = 'u_r'"), ("'shear_r'", "'pressure'")]
    waves = {"shear": wave(bench, "shear", [("permeability = 'k'\n", "\n"), *NO_K], "r", SHEAR, dry)}
    if not bench.quick:
        waves["pressure"] = wave(bench, "pressure", [("permeability = 'k'\n", "\n"), *NO_K, *upwards], "z",
                                 CONSTRAINED, dry)
    waves["undrained"] = wave(bench, "undrained", [("fields = 'u'", "fields = 'u-p_w' pressures = 'quadratic'"), *upwards,
                                                   ("duration = 0.4", "duration = 0.2")], "z",
                              CONSTRAINED + 2.2e6 / (1 - VOIDS_SOLID), wet)
    results = {"waves": waves}
    cases = {"rigid base": ([], 0.0)}
    compliant = [("   field = 'u_r'\n   motion = 'acceleration'\n   value = 1\n",
                  "   rho = 2.2\n   c_s = 600\n   v_r = 1\n"),
                 ("&fix\n   group = 'bottom'", "&absorbing\n   group = 'bottom'")]
    cases["compliant base"] = (compliant, 2.2 * 600)
    for name, (changes, impedance) in cases.items():
        h = tables.columns(bench.host("layers.nml", changes) / "histories.csv")
        given = ricker(h["time"])
        column = h["surface.a_r"] if impedance == 0 else h["surface.v_r"] / 2
        f, entering = spectrum(h["time"], given)
        _, there = spectrum(h["time"], column)
        counts = (np.abs(entering) > CONTENT * np.abs(entering).max()) & (f > 0.5) & (f < 10)
        base, force = shape(300.0, 150.0, 2 * np.pi * f[counts])
        wanted = 1 / (base + (force / (2j * np.pi * f[counts] * impedance) if impedance else 0))
        ratio = there[counts] / entering[counts]
        bench.near(f"{name}: transfer function, {counts.sum()} frequencies", np.abs(ratio) / np.abs(wanted).max(),
                   np.abs(wanted) / np.abs(wanted).max(), TRANSFER)
        results[name] = f[counts], ratio, wanted
    return results


VOIDS_SOLID = 1 / (1 + VOIDS)
NO_K = [("&permeability\n   name = 'k'\n   intrinsic = 1.0e-10\n   law = 'constant'\n/\n", "")]


def draw(bench, results, plt):
    figure, axes = plt.subplots(1, 2, figsize=(8.4, 3.4), layout="constrained")
    for colour, (name, (time, v)) in zip(("C0", "C1", "C2"), results["waves"].items()):
        axes[0].semilogy(time, np.maximum(v, 1e-8), color=colour, label=name, lw=1)
    axes[0].axhline(0.01, color="k", lw=0.6, ls="--")
    axes[0].set(xlabel="time [s]", ylabel="velocity half-way / (load/(rho c))", ylim=(1e-7, 2))
    axes[0].legend()
    for colour, name in (("C0", "rigid base"), ("C1", "compliant base")):
        f, ratio, wanted = results[name]
        axes[1].plot(f, np.abs(wanted), color=colour, label=f"{name}, closed form")
        axes[1].plot(f, np.abs(ratio), "o", ms=2.5, color=colour)
    axes[1].set(xlabel="frequency [Hz]", ylabel="surface / base, or / outcrop")
    axes[1].legend()
    bench.save(figure, "waves.png")
