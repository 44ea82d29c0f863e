# SPDX-License-Identifier: MIT
"""Liakopoulos' drainage test with mobile air: finite volumes in one dimension, second order in space and time.

Unknowns at nodes of a uniform grid, z upwards from the base: p_w, p_c and the weight above. The strain follows from
equilibrium. BDF2 with variable steps, Newton with a complex-step Jacobian. Pa, m, s, kg.
"""
import sys

import numpy as np
from scipy.linalg import solve_banded
from tools import tables
from tools.results import folder

HEIGHT, GRAVITY, ATMOSPHERE, SUCTION = 1.0, 9.81, 101325.0, 100.0
PERMEABILITY, ETA_W, ETA_A, POROSITY = 4.5e-13, 1e-3, 1.8e-5, 0.2975
YOUNG, POISSON = 1.3e6, 0.4
MODULUS = YOUNG*(1 - POISSON)/((1 + POISSON)*(1 - 2*POISSON))
RHO_W, RHO_S, BULK_W = 1000.0, 2000.0, 2.2e9
GAS = 0.028949/(8.31446*300)                       # rho_a = GAS p_a
FLOOR, S_MIN = 1e-4, 0.2
STEP = 10.0                                        # largest of the tables [s]
TIMES = [120.0, 300.0, 600.0, 1200.0, 2400.0, 4800.0, 7200.0]


class Options:
    """What a host may do differently; the defaults are the full equations."""

    def __init__(self, **given):
        self.gas = "ideal"                 # ideal: div(rho_a q_a)/rho_a; no_gradient: K_a = p_a, div q_a; constant: K_a
        self.porosity_follows = True       # n = 1 - (1-n_0) exp(-strain)
        self.balanced = "atmosphere"       # traction of the top: the atmosphere, or "start": what leaves sigma' = 0
        self.gravity = GRAVITY
        self.cells, self.step, self.growth = 800, 2.0, 1.05
        self.euler = 0.0                   # if positive: implicit Euler with this step [s], for comparison
        for name, value in given.items():
            if not hasattr(self, name):
                raise AttributeError(name)
            setattr(self, name, value)


def saturation(p_c):
    positive = np.where(p_c.real > 0, p_c, 1.0)
    s = np.where(p_c.real > 0, 1 - 1.9722e-11*positive**2.4279, 1.0 + 0*p_c)
    return np.where(s.real < S_MIN, S_MIN + 0*s, s)


def relative(s):
    dry = np.where(s.real < 1, 1 - s, 1.0)
    k_w = np.where(s.real < 1, 1 - 2.207*dry**1.0121, 1.0 + 0*s)
    s_e = (s - S_MIN)/(1 - S_MIN)
    base = np.where(s_e.real > 0, s_e, 1.0)
    k_a = (1 - s_e)**2*np.where(s_e.real > 0, 1 - base**(5/3), 1.0 + 0*s)
    return tuple(np.where(k.real < FLOOR, FLOOR + 0*k, k) for k in (k_w, k_a))


class Column:
    def __init__(self, options):
        self.o = options
        self.n = options.cells + 1
        self.h = HEIGHT/options.cells
        self.z = np.linspace(0, HEIGHT, self.n)
        self.volume = np.full(self.n, self.h)
        self.volume[[0, -1]] = self.h/2
        p_w, p_c = np.full(self.n, ATMOSPHERE - SUCTION), np.full(self.n, SUCTION)
        self.y = np.vstack([p_w, p_c, np.zeros(self.n)])
        s = saturation(p_c)
        self.top = ATMOSPHERE if options.balanced == "atmosphere" else (p_w + (1 - s)*p_c)[-1]

    def strain(self, y):
        """Expansion: total stress = top + weight = -MODULUS strain + p_w + (1-S_w) p_c."""
        return (y[0] + (1 - saturation(y[1]))*y[1] - self.top - y[2])/MODULUS

    def porosity(self, strain):
        return 1 - (1 - POROSITY)*np.exp(-strain) if self.o.porosity_follows else POROSITY + 0*strain

    def rate(self, new, old, older):
        """BDF2 (implicit Euler without `older`); each of the three is (value, ...)."""
        if older is None:
            return (new - old)/self.dt
        w = self.dt/self.dt_old
        return ((1 + 2*w)/(1 + w)*new - (1 + w)*old + w*w/(1 + w)*older)/self.dt

    def kept(self, y):
        """What is differentiated in time: p_w, p_a, S_w, strain."""
        return y[0], y[0] + y[1], saturation(y[1]), self.strain(y)

    def residual(self, y):
        o, h = self.o, self.h
        p_w, p_c, weight = y
        p_a = p_w + p_c
        s, strain = saturation(p_c), self.strain(y)
        n = self.porosity(strain)
        d_w, d_a, d_s, d_strain = (self.rate(*three) for three in zip(self.kept(y), self.old, self.older))
        k_w, k_a = relative(s)
        rho_a = GAS*p_a
        drive_w = np.diff(p_w)/h + RHO_W*o.gravity
        drive_a = np.diff(p_a)/h + 0.5*(rho_a[1:] + rho_a[:-1])*o.gravity
        face_w, face_a = 0.5*(k_w[1:] + k_w[:-1]), 0.5*(k_a[1:] + k_a[:-1])
        q_w = -PERMEABILITY/ETA_W*face_w*drive_w
        q_a = -PERMEABILITY/ETA_A*face_a*drive_a
        if o.gas == "ideal":
            q_a = q_a*0.5*(rho_a[1:] + rho_a[:-1])
        bulk_a = ATMOSPHERE if o.gas == "constant" else p_a
        water = self.volume*(n*s/BULK_W*d_w + n*d_s + s*d_strain)
        water[:-1] += q_w
        water[1:] -= q_w
        air = self.volume*(n*(1 - s)/bulk_a*d_a - n*d_s + (1 - s)*d_strain)
        if o.gas == "ideal":
            air = air*rho_a
        air[:-1] += q_a
        air[1:] -= q_a
        if o.gas == "ideal":
            air = air/(GAS*ATMOSPHERE)             # for the size of the equation only
        rho = (1 - n)*RHO_S + n*s*RHO_W + n*(1 - s)*rho_a
        balance = weight.copy()
        balance[:-1] -= weight[1:] + 0.5*h*o.gravity*(rho[1:] + rho[:-1])
        # Boundary values: both pressures at the base, the air at the top.
        water[0] = (p_w[0] - (ATMOSPHERE - SUCTION))*1e-9
        air[0] = (p_c[0] - SUCTION)*1e-9
        air[-1] = (p_a[-1] - ATMOSPHERE)*1e-9
        return np.vstack([water, air, balance])

    def newton(self):
        n = self.n
        for _ in range(25):
            r = self.residual(self.y)
            band = np.zeros((11, 3*n))
            for colour in range(3):
                for k in range(3):
                    y = self.y.astype(complex)
                    y[k, colour::3] += 1e-20j
                    slope = self.residual(y).imag/1e-20
                    column = np.arange(colour, n, 3)
                    for shift in (-1, 0, 1):
                        row = column + shift
                        ok = (row >= 0) & (row < n)
                        for i in range(3):
                            band[5 + 3*shift + i - k, 3*column[ok] + k] = slope[i, row[ok]]
            change = solve_banded((5, 5), band, -r.T.ravel()).reshape(n, 3).T
            self.y = self.y + change
            if np.abs(change[:2]).max() < 1e-6:
                return True
        return False

    def run(self, stops):
        """Yields the state at each time."""
        t, self.dt, self.dt_old = 0.0, self.o.euler or 1e-4, None
        self.old, self.older = self.kept(self.y)[:3] + (np.zeros(self.n),), (None,)*4     # no strain at the start
        ramp = 0                           # the first three steps are implicit Euler: the weight arrives at t = 0
        for stop in stops:
            while t < stop - 1e-9:
                left = stop - t
                largest = self.o.euler or min(self.o.step, self.dt*(self.o.growth if ramp > 5 else 1.0))
                parts = np.ceil(left/largest - 1e-9)
                self.dt = left/parts
                keep = self.y.copy()
                if not self.newton():
                    self.y, self.dt = keep, self.dt/4
                    continue
                t += self.dt
                ramp += 1
                self.dt_old = self.dt
                self.older, self.old = (None,)*4 if ramp < 3 or self.o.euler else self.old, self.kept(self.y)
            yield stop

    def summary(self):
        u = self.displacement()
        return (self.y[1].max(), (self.y[0] + self.y[1]).min(), saturation(self.y[1]).min(), np.abs(u).max())

    def displacement(self):
        e = self.strain(self.y)
        return np.concatenate([[0], np.cumsum(0.5*self.h*(e[1:] + e[:-1]))])


HEIGHTS = sorted({round(0.05*i, 10) for i in range(21)} | {i/9 for i in range(10)})
VARIANTS = {"ideal": {}, "no_gradient": {"gas": "no_gradient"}, "constant": {"gas": "constant"},
            "n_fixed": {"porosity_follows": False, "gravity": 9.80665}}


def profiles(options):
    """Rows (t, z, p_w, p_c, p_a, S_w, u) at TIMES and HEIGHTS; and the four figures at the last time."""
    column, rows = Column(options), []
    for t in column.run(TIMES):
        p_w, p_c = column.y[:2]
        for z in HEIGHTS:
            w, c, u = (np.interp(z, column.z, v) for v in (p_w, p_c, column.displacement()))
            rows.append((t, z, w, c, w + c, float(saturation(np.array([c]))[0]), u))
    return rows, column.summary(), column


def compare(rows, path):
    """Largest differences from the digitised curves, by code and time; the heights of `ogs` are ninths."""
    table = {}
    for line in tables.rows(path):
        code, t, y = line["code"], float(line["t_s"]), float(line["y_m"])
        z = round(9*y)/9 if code == "ogs" else y
        if y == 1.0 and code == "ogs":
            z = 1.0
        row = next((r for r in rows if r[0] == t and abs(r[1] - z) < 1e-6), None)
        if row is None:
            continue
        p_c, s, p_a, u = (float(line[name]) for name in ("pc_Pa", "Sl", "pg_Pa", "uy_m"))
        found = np.abs([row[3] - p_c, row[5] - s, row[4] - p_a, row[6] - u])
        table[code, t] = np.maximum(table.get((code, t), 0), found)
    for (code, t), d in table.items():
        print(f"  {code} {t:5.0f} s: p_c {d[0]:.1f} Pa, S_w {d[1]:.5f}, p_a {d[2]:.1f} Pa, u {d[3]:.2e} m")


def off_terzaghi():
    """Until air enters: largest difference of p_w from Terzaghi's series, all the weight on the water at first."""
    m = (2*np.arange(4000) + 1)*np.pi/2
    share = 1/(1 + POROSITY*MODULUS/BULK_W)
    c_v = PERMEABILITY/ETA_W*MODULUS*share
    weight = ((1 - POROSITY)*RHO_S + POROSITY*RHO_W)*GRAVITY
    level = share*(weight*HEIGHT + SUCTION)                # p_w less its final value at the start: level + slope z
    slope = RHO_W*GRAVITY - share*weight
    mode = 2*(level*(1 - np.cos(m))/m + slope*(np.sin(m)/m**2 - np.cos(m)/m))
    column, worst = Column(Options(cells=360, porosity_follows=False)), 0.0
    for t in column.run([10.0, 60.0, 120.0]):
        exact = ATMOSPHERE - SUCTION - RHO_W*GRAVITY*column.z + np.sin(np.outer(column.z, m)) @ (
            mode*np.exp(-m*m*c_v*t))
        worst = max(worst, np.abs(column.y[0] - exact).max())
    return worst


def number(values):
    return [f"{v:.9g}" for v in values]


def main():
    results, whole, ends = folder(__file__), {}, []
    for name, given in VARIANTS.items():
        rows, summary, _ = profiles(Options(cells=720, step=STEP, **given))
        whole[name] = np.array(rows)
        ends.append((f"`{name}`", *number(summary)))
        print(*ends[-1], flush=True)
    tables.write(results/"liakopoulos.csv", ("variant", "t", "z", "p_w", "p_c", "p_a", "s_w", "u"),
                 [(name, f"{row[0]:g}", f"{row[1]:.12g}", *number(row[2:])) for name, rows in whole.items()
                  for row in rows],
                 ["drainage of a column with mobile air, finite volumes, made by liakopoulos.py; Pa, m, s",
                  "z and u upwards from the base; pressures compression positive, p_c = p_a - p_w"])
    off = [(f"`{name}` against `ideal`", *differences(whole[name], whole["ideal"])) for name in ("no_gradient",
                                                                                               "constant")]
    coarse = {}
    for name, given in (("360 cells", {}), ("360 cells, half the steps", {"step": STEP/2, "growth": 1.025}),
                        ("360 cells, the top in balance", {"balanced": "start"}),
                        ("`n_fixed`, 360 cells, implicit Euler, 20 s a step", {**VARIANTS["n_fixed"], "euler": 20.0})):
        rows, summary, _ = profiles(Options(**{"cells": 360, "step": STEP, **given}))
        coarse[name] = np.array(rows)
        ends.append((name, *number(summary)))
        print(*ends[-1], flush=True)
    off += [("360 instead of 720 cells", *differences(coarse["360 cells"], whole["ideal"])),
            ("half the steps", *differences(coarse["360 cells, half the steps"], coarse["360 cells"])),
            ("Terzaghi's series with the weight, while S_w = 1: p_w", f"{off_terzaghi():.3g}", "", "", "")]
    tables.write(results/"ends.csv", ("variant", "p_c", "p_a", "s_w", "u"), ends)
    tables.write(results/"differences.csv", ("what", "p_w", "p_c", "p_a", "u"), off)
    if len(sys.argv) > 1:
        for given in ({}, VARIANTS["n_fixed"], {"euler": 10.0}, {"euler": 15.0}, {"euler": 30.0}):
            print(f"{given}:")
            compare(profiles(Options(**{"cells": 360, "step": STEP, **given}))[0], sys.argv[1])


def differences(rows, others):
    """Largest ones over all times and heights: p_w, p_c, p_a, u."""
    return [f"{v:.3g}" for v in np.abs(rows - others).max(axis=0)[[2, 3, 4, 6]]]


if __name__ == "__main__":
    main()
