"""Free vibration of one degree of freedom: frequency, energy, and the algorithm's damping against rho_inf."""
import pathlib
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(here.parent))
import numpy as np  # noqa: E402
from host_tools import Checks, arguments, figure, read, run  # noqa: E402

STIFFNESS, MASS, FORCE = 1.2e4, 3.0, 12.0
OMEGA = np.sqrt(STIFFNESS / MASS)
U0 = -FORCE / STIFFNESS


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


args = arguments(__doc__)
checks = Checks("vibration")
curves = {}
for rho in (1.0, 0.8, 0.5, 0.0):
    folder = run(here / "scene.nml", [("rho_inf = 0.8", f"rho_inf = {rho}")])
    h, ledger = read(folder / "histories.csv"), read(folder / "ledger.csv")
    t, u = h["time"][1:] - 1, h["top.u_z"][1:]
    curves[rho] = t, u
    # The column's own mass is 1e-7 of the body's; over 5 periods it shifts the phase by 1e-6.
    checks.near(f"rho_inf {rho}: recursion / amplitude", u / U0, recursion(rho, 0.005, len(u) - 1) / U0, 2e-6)
    if rho == 1.0:
        # Period elongation of the trapezoidal rule: (omega dt)**2 / 12.
        fine = read(run(here / "scene.nml", [("rho_inf = 0.8", "rho_inf = 1"), ("dt = 0.005", "dt = 0.0005")])
                    / "histories.csv")
        t_fine, u_fine = fine["time"][1:] - 1, fine["top.u_z"][1:]
        allowed = OMEGA * 0.5 * (OMEGA * 0.0005) ** 2 / 12 * 1.1
        checks.near("closed form, dt = period/200", u_fine / U0, np.cos(OMEGA * t_fine), allowed)
        energy = ledger["kinetic"] + ledger["skeleton"]
        checks.small("energy kept / energy (rho_inf 1)", np.ptp(energy[2:]) / (0.5 * STIFFNESS * U0**2), 1e-6)
# High frequencies: amplitude ratio a step tends to rho_inf.
for rho in (0.8, 0.5):
    h = read(run(here / "scene.nml", [("rho_inf = 0.8", f"rho_inf = {rho}"), ("duration = 0.5", "duration = 4000"),
                                     ("dt = 0.005", "dt = 100\n   predictor = 'none'")]) / "histories.csv")
    u = h["top.u_z"][1:]
    reference = recursion(rho, 100.0, len(u) - 1)
    checks.near(f"rho_inf {rho}: 40 steps of 1000 periods", u / U0, reference / U0, 1e-6)
    if rho == 0.5:
        ratio = np.abs(reference[20] / reference[19])
        print(f"   amplitude ratio a step at omega dt = 6300: {ratio:.4f}")
if args.plot:
    fig, axes = figure(1)
    for rho, (t, u) in curves.items():
        axes.plot(t, u * 1e3, ".-", ms=3, label=f"rho_inf {rho}")
    t = np.linspace(0, 0.5, 500)
    axes.plot(t, U0 * 1e3 * np.cos(OMEGA * t), "k-", lw=0.6, label="exact")
    axes.set(xlabel="time [s]", ylabel="displacement [mm]")
    fig.legend(ncols=3, loc="outside upper center", fontsize=7)
    fig.savefig(here / "vibration.png", dpi=130)
checks.end()
