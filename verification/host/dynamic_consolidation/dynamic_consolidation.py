# SPDX-License-Identifier: MIT
"""Dynamic consolidation of a half space under a surface load, closed form; and of a column by its modes."""
import csv
import math

import mpmath as mp
import numpy as np
from scipy.integrate import quad
from scipy.special import i0e, i1e
from tools.results import folder

# kPa, m, s, Mg
YOUNG, POISSON, E_0, RHO_S, RHO_W = 10000.0, 0.25, 0.8, 2.7, 1.0
RESISTANCE = 1e-6/3e-8                             # viscosity / intrinsic permeability [kPa s/m2]
MODULUS = YOUNG*(1 - POISSON)/((1 + POISSON)*(1 - 2*POISSON))
POROSITY = E_0/(1 + E_0)
RHO = (1 - POROSITY)*RHO_S + POROSITY*RHO_W
PEAK, PULSE = 1.0, 0.04                            # load PEAK sin^2(pi t/PULSE) until PULSE, then none
DEPTH = 12.0                                       # of the column that stands for the half space
DEPTHS = [0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0]
TIMES = [round(0.005*i, 10) for i in range(1, 21)]


def load(t):
    return PEAK*math.sin(math.pi*t/PULSE)**2 if 0 < t < PULSE else 0.0


class HalfSpace:
    """a u,tt + b u,t = u,zz, -(lambda+2mu) u,z = load at z = 0."""

    def __init__(self, seepage_inertia):
        self.seepage_inertia = seepage_inertia
        self.mass = RHO - RHO_W if seepage_inertia else RHO
        self.a, self.b = self.mass/MODULUS, RESISTANCE/MODULUS
        self.beta = self.b/(2*self.a)

    def integral(self, kernel, delay, t):
        """int from delay to t of load(t-s) kernel(s) ds, in the parts where the load is smooth."""
        if t <= delay:
            return 0.0
        low = max(delay, t - PULSE)
        return quad(lambda s: load(t - s)*kernel(s), low, t, epsabs=0, epsrel=1e-12, limit=400)[0] if t > low else 0.0

    def u(self, z, t):
        """Downwards, the integral of docs/theory/host.md section 10.2."""
        delay = math.sqrt(self.a)*z

        def kernel(s):
            x = self.beta*math.sqrt(max(s*s - delay*delay, 0.0))
            return i0e(x)*math.exp(x - self.beta*s)
        return self.integral(kernel, delay, t)/(math.sqrt(self.a)*MODULUS)

    def effective(self, z, t):
        """Vertical effective stress, compression positive: the load behind its front and what follows it."""
        delay = math.sqrt(self.a)*z

        def kernel(s):
            root = math.sqrt(max(s*s - delay*delay, 0.0))
            x = self.beta*root
            share = 0.5*self.beta if x < 1e-8 else i1e(x)/root
            return self.beta*delay*share*math.exp(x - self.beta*s)
        return load(t - delay)*math.exp(-self.beta*delay) + self.integral(kernel, delay, t)

    def unfiltered(self, t):
        """p_w below the front: the load filtered once."""
        rate = self.b/self.a
        share = RHO_W/self.mass if self.seepage_inertia else 0.0
        return (1 + share)*rate*self.integral(lambda s: math.exp(-rate*s), 0.0, t) - share*load(t)

    def p(self, z, t):
        """p_w = G - G * exp(-kappa z), G the pressure below the front; * with the effective stress's kernel."""
        delay = math.sqrt(self.a)*z
        if t <= delay:
            return self.unfiltered(t)

        def kernel(s):
            root = math.sqrt(max(s*s - delay*delay, 0.0))
            x = self.beta*root
            share = 0.5*self.beta if x < 1e-8 else i1e(x)/root
            return self.beta*delay*share*math.exp(x - self.beta*s)
        points = [t - PULSE] if delay < t - PULSE < t else None
        tail = quad(lambda s: self.unfiltered(t - s)*kernel(s), delay, t, epsabs=1e-12, epsrel=1e-10, limit=400,
                    points=points)[0]
        return self.unfiltered(t) - math.exp(-self.beta*delay)*self.unfiltered(t - delay) - tail

    def by_laplace(self, z, t):
        """u, effective stress and p_w by Talbot's inversion; the delay is taken out of the transform first."""
        mp.mp.dps = 40
        omega = 2*mp.pi/mp.mpf(PULSE)
        a, b, mass = mp.mpf(self.a), mp.mpf(self.b), mp.mpf(self.mass)
        delay = mp.sqrt(a)*z
        share = RHO_W if self.seepage_inertia else 0

        def periodic(s):
            return mp.mpf(PEAK)/2*(1/s - s/(s*s + omega**2))

        def root(s):
            return mp.sqrt(s)*mp.sqrt(a*s + b)

        def lag(s):                                       # exp(-kappa z) without its delay
            return mp.exp(-z*(root(s) - mp.sqrt(a)*s))

        def pressure(s):
            return (RESISTANCE - share*s)/(mass*s + RESISTANCE)

        def invert(transform, time):
            value = mp.mpf(0)
            for shift, sign in ((0, 1), (mp.mpf(PULSE), -1)):
                if time - shift > mp.mpf("1e-12"):
                    value += sign*mp.invertlaplace(transform, time - shift, method="talbot", degree=60)
            return value
        t = mp.mpf(t)
        return (float(invert(lambda s: periodic(s)*lag(s)/(root(s)*MODULUS), t - delay)),
                float(invert(lambda s: periodic(s)*lag(s), t - delay)),
                float(invert(lambda s: periodic(s)*pressure(s), t)
                      - invert(lambda s: periodic(s)*pressure(s)*lag(s), t - delay)))


def column(times, depths, bulk_w, seepage_inertia, modes):
    """u downwards and p_w of a column held and impervious at the base, drained at the top, by its exact modes.

    With x from the base, u = sum U sin(q x), p_w = sum P cos(q x), q = (2m+1) pi/(2 DEPTH); load on the top.
    """
    q = (2*np.arange(modes) + 1)*np.pi/(2*DEPTH)
    storage = POROSITY/bulk_w
    drive = -2/DEPTH*np.sin(q*DEPTH)/RHO                  # of U'' per unit load, U upwards
    rates = np.zeros((modes, 3, 3))
    rates[:, 0, 1] = 1
    rates[:, 1, 0], rates[:, 1, 2] = -MODULUS*q**2/RHO, q/RHO
    rates[:, 2, 1], rates[:, 2, 2] = -q/storage, -q**2/RESISTANCE/storage
    right = np.zeros((modes, 3))
    right[:, 1] = drive
    if seepage_inertia:
        rates[:, 2, :] += (RHO_W*q/RESISTANCE/storage)[:, None]*rates[:, 1, :]
        right[:, 2] = RHO_W*q/RESISTANCE/storage*drive
    value, vector = np.linalg.eig(rates)
    share = np.linalg.solve(vector, right[:, :, None].astype(complex))[:, :, 0]
    omega = 2*np.pi/PULSE

    def since(t):
        """int of exp(value (t-s)) (1 - cos(omega s))/2 ds from 0 to t."""
        if t <= 0:
            return np.zeros_like(value)
        growth = np.exp(value*t)
        wave = (growth*value - value*np.cos(omega*t) + omega*np.sin(omega*t))/(value**2 + omega**2)
        return 0.5*((growth - 1)/value - wave)
    u, p = np.zeros((len(times), len(depths))), np.zeros((len(times), len(depths)))
    x = DEPTH - np.array(depths)
    sine, cosine = np.sin(np.outer(q, x)), np.cos(np.outer(q, x))
    for i, t in enumerate(times):
        state = np.einsum("mij,mj->mi", vector, share*PEAK*(since(t) - since(t - PULSE))).real
        u[i], p[i] = -state[:, 0] @ sine, state[:, 2] @ cosine
    return u, p


def extrapolated(times, depths, bulk_w, seepage_inertia, modes):
    """The modes left out carry u ~ 1/q^2 at the surface: their sum halves when the modes double."""
    few, many = (column(times, depths, bulk_w, seepage_inertia, n) for n in (modes, 2*modes))
    return 2*many[0] - few[0], many[1]


def main():
    worst = {}
    with open(folder(__file__)/"dynamic_consolidation.csv", "w", newline="") as file:
        file.write("# dynamic consolidation of a half space, closed form, made by dynamic_consolidation.py\n"
                   "# m, s, kPa; stress and pressure compression positive; z and u downwards, z from the drained top\n"
                   "# seepage_inertia,t,z,u,effective_stress,p_w,u_column,p_w_column\n")
        out = csv.writer(file, lineterminator="\n")
        for inertia in (0, 1):
            half = HalfSpace(inertia)
            print(f"seepage inertia {inertia}: a {half.a:.10g} s2/m2, b {half.b:.10g} s/m2, "
                  f"front {half.a**-0.5:.8g} m/s"
                  f", at {DEPTH} m at {DEPTH*half.a**0.5:.6g} s, b/2a {half.beta:.8g} per second")
            u_c, p_c = extrapolated(TIMES, DEPTHS, 2.2e6, inertia, 6000)
            for i, t in enumerate(TIMES):
                for j, z in enumerate(DEPTHS):
                    found = (half.u(z, t), half.effective(z, t), half.p(z, t))
                    other = half.by_laplace(z, t)
                    for name, x, y in zip(("u", "effective", "p"), found, other):
                        key = name, inertia
                        scale = PEAK if name != "u" else 1e-4
                        worst[key] = max(worst.get(key, 0.0), abs(x - y)/scale)
                    out.writerow([inertia, t, z] + [f"{v:.12e}" for v in (*found, u_c[i, j], p_c[i, j])])
    print("closed form against Laplace inversion, of 1e-4 m or 1 kPa:", {k: f"{v:.1e}" for k, v in worst.items()})
    for inertia in (0, 1):
        half = HalfSpace(inertia)
        times = [t for t in TIMES if t in (0.02, 0.05, 0.1)]
        u = np.array([[half.u(z, t) for z in DEPTHS] for t in times])
        p = np.array([[half.p(z, t) for z in DEPTHS] for t in times])
        for bulk_w in (2.2e6, 1e8, 1e9, 1e10):
            for modes in (3000, 6000):
                u_c, p_c = extrapolated(times, DEPTHS, bulk_w, inertia, modes)
                print(f"seepage inertia {inertia}: column, K_w {bulk_w:.1e} kPa, {modes} modes, differs from the half "
                      f"space: u {np.abs(u_c - u).max()/np.abs(u).max():.1e}, "
                      f"p_w {np.abs(p_c - p).max()/np.abs(p).max():.1e}")


if __name__ == "__main__":
    main()
