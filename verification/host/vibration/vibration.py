# SPDX-License-Identifier: MIT
"""Generalised-alpha on single modes: spectral radius, damping and period error, and the very numbers of each step.

The scheme: u, u', p at a_f = 1/(1+rho); u'' at a_m = (2-rho)/(1+rho); p' at a_p = (3-rho)/(2(1+rho)), all counted as
weights of the new instant; Newmark updates with gamma = 1/2 + a_m - a_f, beta = (1 + a_m - a_f)^2/4, for p
gamma_p = 1/2 + a_p - a_f.
"""
import csv
import math

import mpmath as mp
import numpy as np
from scipy.linalg import expm
from tools.results import folder

RADII = [1.0, 0.8, 0.5, 0.0]
# Column and bar; kPa, m, s, Mg
LENGTH, STIFFNESS, E_0, RHO_S, RHO_W = 1.0, 10000.0, 0.8, 2.7, 1.0
BULK_W, MOBILITY = 2.2e6, 2e-8/1e-6
POROSITY = E_0/(1 + E_0)
AMPLITUDE = 1e-5
STEPS_PER_PERIOD, STEPS = 20, 100
WAVE = math.pi/(2*LENGTH)


class Scheme:
    def __init__(self, rho):
        self.a_f = 1/(1 + rho)
        self.a_m = (2 - rho)/(1 + rho)
        self.a_p = (3 - rho)/(2*(1 + rho))
        self.gamma = 0.5 + self.a_m - self.a_f
        self.beta = (1 + self.a_m - self.a_f)**2/4
        self.gamma_p = 0.5 + self.a_p - self.a_f


def mode(mass, stiffness, coupling=0.0, storage=1.0, flow=0.0, seepage=0.0):
    """Coefficients of mass u'' + stiffness u - coupling p = 0, coupling u' + storage p' + flow p - seepage u'' = 0."""
    return dict(mass=mass, stiffness=stiffness, coupling=coupling, storage=storage, flow=flow, seepage=seepage)


def amplification(m, rho, dt):
    """The matrix that takes (u, u', u'', p, p') to the next instant: both equations and three updates, solved."""
    s = Scheme(rho)
    new, old = np.zeros((5, 5)), np.zeros((5, 5))
    f, a, p = s.a_f, s.a_m, s.a_p
    new[0] = [m["stiffness"]*f, 0, m["mass"]*a, -m["coupling"]*f, 0]
    old[0] = [-m["stiffness"]*(1 - f), 0, -m["mass"]*(1 - a), m["coupling"]*(1 - f), 0]
    new[1] = [0, m["coupling"]*f, -m["seepage"]*a, m["flow"]*f, m["storage"]*p]
    old[1] = [0, -m["coupling"]*(1 - f), m["seepage"]*(1 - a), -m["flow"]*(1 - f), -m["storage"]*(1 - p)]
    new[2] = [1, 0, -dt**2*s.beta, 0, 0]
    old[2] = [1, dt, dt**2*(0.5 - s.beta), 0, 0]
    new[3] = [0, 1, -dt*s.gamma, 0, 0]
    old[3] = [0, 1, dt*(1 - s.gamma), 0, 0]
    new[4] = [0, 0, 0, 1, -dt*s.gamma_p]
    old[4] = [0, 0, 0, 1, dt*(1 - s.gamma_p)]
    scale = np.abs(new).max(axis=1, keepdims=True)
    return np.linalg.solve(new/scale, old/scale)


def continuous(m):
    """Rates of (u, u', p)."""
    acceleration = np.array([-m["stiffness"], 0, m["coupling"]])/m["mass"]
    p_rate = (m["seepage"]*acceleration - np.array([0, m["coupling"], m["flow"]]))/m["storage"]
    return np.array([[0, 1, 0], acceleration, p_rate])


def measures(rho, share):
    """Spectral radius, damping ratio and period elongation of an undamped oscillator at dt = share of its period.

    The characteristic polynomial in units of dt is solved with 50 digits: at rho 0 and 1 its roots coincide in limits.
    """
    mp.mp.dps = 50
    rho, omega = mp.mpf(rho), 2*mp.pi*mp.mpf(share)
    f, a = 1/(1 + rho), (2 - rho)/(1 + rho)
    gamma, beta = mp.mpf(1)/2 + a - f, (1 + a - f)**2/4
    # state (u, dt u', dt^2 u''): the new u'' from the equation, with the updates put in.
    d = a + f*omega**2*beta
    row = [-omega**2/d, -f*omega**2/d, -((1 - a) + f*omega**2*(mp.mpf(1)/2 - beta))/d]
    matrix = mp.matrix([[1 + beta*row[0], 1 + beta*row[1], mp.mpf(1)/2 - beta + beta*row[2]],
                        [gamma*row[0], 1 + gamma*row[1], 1 - gamma + gamma*row[2]], row])
    roots = sorted(mp.eig(matrix, left=False, right=False), key=lambda v: -abs(v))
    radius = abs(roots[0])
    principal = max(roots, key=lambda v: (abs(mp.im(v)) > mp.mpf("1e-20"), mp.im(v)))
    if mp.im(principal) < mp.mpf("1e-20"):
        return float(radius), math.nan, math.nan
    angle, decay = mp.arg(principal), -mp.log(abs(principal))
    damping = decay/mp.sqrt(angle**2 + decay**2)
    return float(radius), float(damping) if abs(damping) > mp.mpf("1e-30") else 0.0, float(omega/angle - 1)


WET, DRY = (1 - POROSITY)*RHO_S + POROSITY*RHO_W, (1 - POROSITY)*RHO_S
DRAINED = dict(stiffness=STIFFNESS*WAVE**2, coupling=WAVE, storage=POROSITY/BULK_W, flow=MOBILITY*WAVE**2)
MODES = {
    "dry_bar": mode(DRY, STIFFNESS*WAVE**2),
    "saturated": mode(WET, **DRAINED),
    "saturated_seepage_inertia": mode(WET, **DRAINED, seepage=MOBILITY*RHO_W*WAVE),
}


def history(m, rho, dt):
    """The scheme's own numbers, from rest at u = AMPLITUDE, p = 0 with u'' and p' that satisfy the equations."""
    rates = continuous(m)
    start = np.array([AMPLITUDE, 0, 0])
    a_0, p_0 = (rates @ start)[1:]
    state = np.array([AMPLITUDE, 0, a_0, 0, p_0])
    matrix = amplification(m, rho, dt)
    exact = expm(rates*dt)
    for k in range(STEPS + 1):
        yield k, k*dt, state, start
        state, start = matrix @ state, exact @ start


def main():
    shares = [0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 1.0, 2.0, 5.0, 10.0, 100.0, 1000.0, 1e4]
    with open(folder(__file__)/"amplification.csv", "w", newline="") as file:
        file.write("# generalised-alpha on u'' + omega^2 u = 0, made by vibration.py; the ratio is dt/(2 pi/omega)\n"
                   "# nan: the principal roots are real. The last rows tend to rho_inf\n"
                   "# rho_inf,ratio,spectral_radius,damping_ratio,period_elongation\n")
        out = csv.writer(file, lineterminator="\n")
        for rho in RADII:
            for share in shares:
                out.writerow([rho, share] + [f"{v:.12g}" for v in measures(rho, share)])
    with open(folder(__file__)/"first_order.csv", "w", newline="") as file:
        file.write("# generalised-alpha on p' + lambda p = 0, made by vibration.py: roots of its amplification matrix\n"
                   "# principal: the one that tends to exp(-lambda dt)\n"
                   "# rho_inf,lambda_dt,principal,spectral_radius\n")
        out = csv.writer(file, lineterminator="\n")
        for rho in RADII:
            for x in [0.01, 0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 100.0, 1e4, 1e6]:
                s = Scheme(rho)
                d = s.a_p + s.a_f*s.gamma_p*x
                rate = np.array([-x, -(1 - s.a_p) - s.a_f*x*(1 - s.gamma_p)])/d      # dt p' of the new instant
                matrix = np.array([[1 + s.gamma_p*rate[0], 1 - s.gamma_p + s.gamma_p*rate[1]], rate])
                roots = np.linalg.eigvals(matrix)
                principal = roots[np.argmin(abs(roots - math.exp(-x)))]
                value = f"{principal.real:.12g}"
                if abs(principal.imag) > 1e-12:
                    value += f"+-{abs(principal.imag):.12g}i"
                out.writerow([rho, x, value, f"{max(abs(roots)):.12g}"])
    with open(folder(__file__)/"history.csv", "w", newline="") as file:
        file.write("# free vibration of the first mode, made by vibration.py\n"
                   "# scheme: generalised-alpha itself; exact: the equations\n"
                   "# u of the free end [m], p_w at the base [kPa], compression positive\n"
                   "# case,rho_inf,step,t,u_scheme,p_scheme,u_exact,p_exact\n")
        out = csv.writer(file, lineterminator="\n")
        for name, m in MODES.items():
            omega = max(abs(np.linalg.eigvals(continuous(m)).imag))
            dt = 2*math.pi/omega/STEPS_PER_PERIOD
            print(f"{name}: eigenvalues {np.linalg.eigvals(continuous(m))} per second, dt {dt:.12g} s")
            for rho in RADII:
                for k, t, state, exact in history(m, rho, dt):
                    if k % 5 == 0:
                        values = (t, state[0], state[3], exact[0], exact[2])
                        out.writerow([name, rho, k] + [f"{v:.12e}" for v in values])
    with open(folder(__file__)/"frequencies.csv", "w", newline="") as file:
        file.write("# frequencies [Hz] of an elastic bar, one end held, nu = 0, made by vibration.py\n"
                   "# (2n-1)/(4L) sqrt(E/rho)\n# n,frequency\n")
        for n in range(1, 7):
            f = (2*n - 1)/(4*LENGTH)*math.sqrt(STIFFNESS/MODES["dry_bar"]["mass"])
            file.write(f"{n},{f:.12g}\n")


def check():
    """Known limits, the order in time, and a scan for growth in the coupled scheme."""
    for rho in RADII:
        radius, _, _ = measures(rho, 1e6)
        assert abs(radius - rho) < 1e-4, (rho, radius)
        # Against the matrix of the coupled program with the coupling off.
        w = 2*math.pi
        for share in (0.05, 0.3, 2.0):
            other = np.abs(np.linalg.eigvals(amplification(mode(1.0, w*w), rho, share)[:3, :3])).max()
            assert abs(other - measures(rho, share)[0]) < 1e-7, (rho, share)
    for name, m in MODES.items():
        rates = continuous(m)
        omega = max(abs(np.linalg.eigvals(rates).imag))
        for rho in RADII:
            errors = []
            for parts in (320, 640, 1280):
                dt, steps = 2*math.pi/omega/parts, parts*37//20
                start = np.array([AMPLITUDE, 0, 0])
                a_0, p_0 = (rates @ start)[1:]
                state = np.array([AMPLITUDE, 0, a_0, 0, p_0])
                state = np.linalg.matrix_power(amplification(m, rho, dt), steps) @ state
                exact = expm(rates*dt*steps) @ start
                errors.append([abs(state[0] - exact[0]), abs(state[3] - exact[2])])
            order = [math.log2(errors[1][i]/errors[2][i]) if errors[2][i] else math.nan for i in range(2)]
            print(f"{name}, rho_inf {rho}: order in time of u {order[0]:.3f}" +
                  (f", of p {order[1]:.3f}" if m["coupling"] else ""))
    rng = np.random.default_rng(1)
    worst = [-1.0, -1.0]                       # without, with seepage inertia
    for _ in range(20000):
        # Scaled: unit mass and stiffness; storage, flow, coupling and step over many decades.
        c, h, dt = 10.0**rng.uniform(-6, 2), 10.0**rng.uniform(-4, 4), 10.0**rng.uniform(-3, 3)
        rho = rng.choice(RADII[1:])
        for i, m in enumerate([mode(1, 1, 1, c, h), mode(1, 1, 1, c, h, h*rng.uniform(0, 1))]):
            if np.linalg.eigvals(continuous(m)).real.max() < 0:          # with seepage inertia some modes grow
                worst[i] = max(worst[i], np.abs(np.linalg.eigvals(amplification(m, rho, dt))).max() - 1)
    print(f"coupled modes that decay, 20000 at random: spectral radius - 1 at most {worst[0]:.1e} "
          f"without, {worst[1]:.1e} with seepage inertia")


if __name__ == "__main__":
    main()
    check()
