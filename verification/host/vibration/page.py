# SPDX-License-Identifier: MIT
"""Free vibration of one degree of freedom: frequency, energy, and the algorithm's damping against rho_inf."""
import numpy as np
from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="the host's generalised-alpha has the spectral radius, damping and period error of the scheme with the given "
          "rho_inf",
    kind=("exact", "code-to-code", "conservation"),
    input="`scene.nml`: a mass of 3 Mg on a column of 3e-7 of its mass, released from 1 mm: one degree of freedom, 20 "
          "steps a period; rho_inf 1, 0.8, 0.5, 0",
    reference="the scheme of Chung & Hulbert written for one degree of freedom, step by step; cos(omega t)",
    seconds=3, quick=3, every_build=True, pictures=("vibration.png",))
MAKES = (Script("vibration.py", ("amplification.csv", "first_order.csv", "frequencies.csv", "history.csv"), 4),)

STIFFNESS, MASS, FORCE = 1.2e4, 3.0, 12.0
OMEGA = np.sqrt(STIFFNESS / MASS)
U0 = -FORCE / STIFFNESS
FINE = 0.0005   # s: 200 steps a period
OWN_MASS = Tolerance("the column's own mass is 1e-7 of the body's: over 5 periods it shifts the phase by 1e-6",
                     absolute=2e-6)
ELONGATION = Tolerance("period elongation of the trapezoidal rule, (omega dt)**2/12, over 5 periods, and a tenth more",
                       absolute=OMEGA * 0.5 * (OMEGA * FINE) ** 2 / 12 * 1.1)
KEPT = Tolerance("the trapezoidal rule keeps the energy of a linear system: Newton's tolerance and the column's own "
                 "mass", absolute=1e-6)
LONG_STEPS = Tolerance("the same recursion: Newton's tolerance", absolute=1e-6)


def recursion(rho, dt, steps):
    """Generalised-alpha of Chung & Hulbert written for one degree of freedom: displacements."""
    a_m, a_f = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    gamma, beta = 0.5 - a_m + a_f, 0.25 * (1 - a_m + a_f) ** 2
    u, v, a = U0, 0.0, -STIFFNESS / MASS * U0
    out = [u]
    for _ in range(steps):
        # m ((1-a_m) a1 + a_m a) + k ((1-a_f) u1 + a_f u) = 0 with Newmark's u1(a1)
        free = u + dt * v + dt * dt * (0.5 - beta) * a
        a1 = -(MASS * a_m * a + STIFFNESS * ((1 - a_f) * free + a_f * u)) / (
            MASS * (1 - a_m) + STIFFNESS * (1 - a_f) * beta * dt * dt)
        u, v, a = free + beta * dt * dt * a1, v + dt * ((1 - gamma) * a + gamma * a1), a1
        out.append(u)
    return np.array(out)


def check(bench):
    """Time and displacement by rho_inf."""
    curves = {}
    for rho in (1.0, 0.8, 0.5, 0.0):
        folder = bench.host("scene.nml", [("rho_inf = 0.8", f"rho_inf = {rho}")])
        h, ledger = tables.columns(folder / "histories.csv"), tables.columns(folder / "ledger.csv")
        t, u = h["time"][1:] - 1, h["top.u_z"][1:]
        curves[rho] = t, u
        bench.near(f"rho_inf {rho}: recursion / amplitude", u / U0, recursion(rho, 0.005, len(u) - 1) / U0, OWN_MASS)
        if rho == 1.0:
            fine = tables.columns(bench.host("scene.nml", [("rho_inf = 0.8", "rho_inf = 1"),
                                                           ("dt = 0.005", f"dt = {FINE}")]) / "histories.csv")
            t_fine, u_fine = fine["time"][1:] - 1, fine["top.u_z"][1:]
            bench.near("closed form, dt = period/200", u_fine / U0, np.cos(OMEGA * t_fine), ELONGATION)
            energy = ledger["kinetic"] + ledger["skeleton"]
            bench.below("energy kept / energy (rho_inf 1)", np.ptp(energy[2:]) / (0.5 * STIFFNESS * U0**2), KEPT)
    # High frequencies: amplitude ratio a step tends to rho_inf.
    for rho in (0.8, 0.5):
        h = tables.columns(bench.host("scene.nml", [("rho_inf = 0.8", f"rho_inf = {rho}"),
                                                    ("duration = 0.5", "duration = 4000"),
                                                    ("dt = 0.005",
                                                     "dt = 100\n   predictor = 'none'\n   created_energy = 1e9")]) \
            / "histories.csv")
        u = h["top.u_z"][1:]
        reference = recursion(rho, 100.0, len(u) - 1)
        bench.near(f"rho_inf {rho}: 40 steps of 1000 periods", u / U0, reference / U0, LONG_STEPS)
        if rho == 0.5:
            bench.note(f"amplitude ratio a step at omega dt = 6300: {np.abs(reference[20] / reference[19]):.4f}")
    return curves


def draw(bench, curves, plt):
    figure, axis = plt.subplots(figsize=(3.8, 3.2))
    for rho, (t, u) in curves.items():
        axis.plot(t, u * 1e3, ".-", ms=3, label=f"rho_inf {rho}")
    t = np.linspace(0, 0.5, 500)
    axis.plot(t, U0 * 1e3 * np.cos(OMEGA * t), "k-", lw=0.6, label="exact")
    axis.set(xlabel="time [s]", ylabel="displacement [mm]")
    figure.legend(ncols=3, loc="outside upper center", fontsize=7)
    bench.save(figure, "vibration.png")
