# SPDX-License-Identifier: MIT
"""Growth of plane longitudinal waves in the linearised u-p_w-p_c equations, with and without seepage inertia."""
import csv
import math

import mpmath as mp
import numpy as np
from scipy.linalg import eig
from scipy.optimize import brentq
from tools import tables
from tools.results import folder

mp.mp.dps = 60
# The paper's Tables 2 and 3; kPa, m, s, Mg
E_0, RHO_S, RHO_W, RHO_A = 0.8, 2.7, 0.997, 0.0011
BULK_W, BULK_A, PERMEABILITY, ETA_W, ETA_A = 2.25e6, 1.01e2, 5e-10, 1e-6, 1.8e-8
P_ENTRY, N_X, M_X, OMEGA = 5.0, 2.0, 1.0, 2.0
P_ATM, K_0, G_0, REST, GRAVITY = 101.325, 150.0, 125.0, 0.4, 9.81
FLOOR = 1e-4
POROSITY = E_0/(1 + E_0)
SUCTIONS = [3.0, 10.0, 30.0, 100.0, 1000.0]
WAVES = [125.0, 250.0, 500.0]
DEPTH = 0.15                                    # where the benchmark's geostatic stress gives the modulus [m]


def state(suction, modulus=None):
    """Coefficients at a uniform suction; the modulus defaults to MUD's K + 4G/3 at DEPTH."""
    a = (suction*E_0**OMEGA/P_ENTRY)**N_X
    log_sum = math.log(math.e + a)
    s_w = log_sum**-M_X
    slope = -M_X*s_w/log_sum*a/(math.e + a)*N_X                     # dS_w/d ln p*
    rho = (1 - POROSITY)*RHO_S + POROSITY*(s_w*RHO_W + (1 - s_w)*RHO_A)
    if modulus is None:
        p = s_w*suction + (1 + 2*REST)/3*rho*GRAVITY*DEPTH
        bulk = K_0*P_ATM*(1 + E_0)/E_0*(p/P_ATM)**(2/3)
        shear = G_0*P_ATM*(2.97 - E_0)**2/(1 + E_0)*(p/P_ATM)**0.5
        modulus = bulk + 4*shear/3
    return dict(suction=suction, s_w=s_w, ds_dc=slope/suction, ds_dvol=slope*OMEGA/E_0*(1 + E_0), rho=rho,
                modulus=modulus, k_w=PERMEABILITY/ETA_W*max(s_w**3, FLOOR),
                k_a=PERMEABILITY/ETA_A*max((1 - s_w)**2*(1 - s_w**2), FLOOR))


def coefficients(c, rate_of_e=True):
    """Of strain (expansion), p_w and p_c: pore pressure in the total stress, storage, coupling of both balances."""
    s, n = c["s_w"], POROSITY
    bend = -c["suction"]
    total = [bend*c["ds_dvol"], 1.0, (1 - s) + bend*c["ds_dc"]]    # d[p_w + (1-S_w) p_c]
    change = [c["ds_dvol"] if rate_of_e else 0.0, 0.0, c["ds_dc"]]  # S_w'
    water = [s + n*change[0], n*s/BULK_W, n*change[2]]
    air = [(1 - s) - n*change[0], n*(1 - s)/BULK_A, n*(1 - s)/BULK_A - n*change[2]]
    return total, water, air


def pencil(c, wave, inertia, rate_of_e=True):
    """left y' = right y of y = (strain, its rate, p_w, p_c), each a plane wave exp(i wave x); strain = i wave u."""
    total, water, air = coefficients(c, rate_of_e)
    q2 = wave**2
    left, right = np.zeros((4, 4)), np.zeros((4, 4))
    left[0, 0] = right[0, 1] = 1
    left[1, 1] = c["rho"]
    right[1] = [-(c["modulus"] - total[0])*q2, 0, total[1]*q2, total[2]*q2]
    left[2] = [water[0], -inertia*c["k_w"]*RHO_W, water[1], water[2]]
    left[3] = [air[0], -inertia*c["k_a"]*RHO_A, air[1], air[2]]
    right[2, 2] = -c["k_w"]*q2
    right[3, 2:] = -c["k_a"]*q2
    return left, right


def by_eigenvalues(c, wave, inertia, rate_of_e=True):
    left, right = pencil(c, wave, inertia, rate_of_e)
    speed = wave*math.sqrt(c["modulus"]/c["rho"])                   # scales: pressures by modulus, time by speed
    columns = np.array([1, speed, c["modulus"], c["modulus"]])
    left, right = left*columns*speed, right*columns
    rows = np.maximum(np.abs(left).max(axis=1), np.abs(right).max(axis=1))[:, None]
    return eig(right/rows, left/rows, right=False)*speed


def by_polynomial(c, wave, inertia, rate_of_e=True):
    """Roots of the determinant of the three equations in s, with 60 digits."""
    total, water, air = coefficients(c, rate_of_e)
    q2 = mp.mpf(wave)**2
    scale = mp.mpf(wave)*mp.sqrt(mp.mpf(c["modulus"])/c["rho"])

    def determinant(s):
        i = inertia*s*s
        m = mp.matrix([[c["rho"]*s*s + (c["modulus"] - total[0])*q2, -total[1]*q2, -total[2]*q2],
                       [s*water[0] - c["k_w"]*RHO_W*i, s*water[1] + c["k_w"]*q2, s*water[2]],
                       [s*air[0] - c["k_a"]*RHO_A*i, s*air[1] + c["k_a"]*q2, s*air[2] + c["k_a"]*q2]])
        return (m[0, 0]*(m[1, 1]*m[2, 2] - m[1, 2]*m[2, 1]) - m[0, 1]*(m[1, 0]*m[2, 2] - m[1, 2]*m[2, 0])
                + m[0, 2]*(m[1, 0]*m[2, 1] - m[1, 1]*m[2, 0]))
    nodes = [mp.expjpi(mp.mpf(2)*j/8) for j in range(8)]            # the polynomial of degree 4 from values on a circle
    values = [determinant(scale*z) for z in nodes]
    powers = [mp.re(mp.fsum(v*z**-k for v, z in zip(values, nodes))/8) for k in range(5)]
    return [r*scale for r in mp.polyroots(powers[::-1], maxsteps=2000, extraprec=400)]


def limit(c, inertia=1, rate_of_e=True):
    """Growth of the wave as its number tends to infinity."""
    total, water, air = coefficients(c, rate_of_e)
    # In p_w, p_a: p_c = p_a - p_w.
    pore = np.array([total[1] - total[2], total[2]])
    storage = np.array([[water[1] - water[2], water[2]], [air[1] - air[2], air[2]]])
    carried = inertia*np.array([RHO_W, RHO_A])
    flow = np.diag([1/c["k_w"], 1/c["k_a"]])
    mass, stiffness = c["rho"] - pore @ carried, c["modulus"] - total[0]
    return (stiffness/mass*(pore @ flow @ storage @ carried) - pore @ flow @ np.array([water[0], air[0]]))/(2*mass)


def largest(roots):
    return max(roots, key=lambda v: (v.real, v.imag))


def history(c, wave, inertia):
    """First mode of a column of length pi/(2 wave) that starts at rest with u = 1e-10 sin(wave x)."""
    left, right = pencil(c, wave, inertia)
    rates = mp.inverse(mp.matrix(left.tolist()))*mp.matrix(right.tolist())
    for k in range(13):
        t = k*mp.mpf("2.5e-4")
        yield float(t), [float(v) for v in mp.expm(rates*t)*mp.matrix([1e-10*wave, 0, 0, 0])]


def main():
    worst = 0.0
    with open(folder(__file__)/"growth.csv", "w", newline="") as file:
        file.write("# growth rates per second of plane waves, made by growth.py; modulus K + 4G/3 of MUD, 0.15 m deep\n"
                   "# suction,s_w,modulus,wave_number,growth,frequency,growth_without_inertia,limit_of_growth\n")
        out = csv.writer(file, lineterminator="\n")
        for suction in SUCTIONS:
            c = state(suction)
            for wave in WAVES:
                top = largest(by_eigenvalues(c, wave, 1))
                without = largest(by_eigenvalues(c, wave, 0))
                for found, inertia in ((top, 1), (without, 0)):
                    exact = largest([complex(r) for r in by_polynomial(c, wave, inertia)])
                    worst = max(worst, abs(found.real - exact.real)/max(1.0, abs(exact.real)))
                out.writerow([suction, f"{c['s_w']:.9f}", f"{c['modulus']:.8g}", wave, f"{top.real:.8g}",
                              f"{abs(top.imag):.8g}", f"{without.real:.8g}", f"{limit(c):.8g}"])
    print(f"eigenvalues against roots of the determinant: {worst:.1e} of the growth, or per second")

    fitted = brentq(lambda m: largest(by_eigenvalues(state(3.0, m), 125.0, 1)).real - 1283, 1e4, 2e4, xtol=1e-9)
    c = state(3.0, fitted)
    print(f"suction 3: growth 1283 at 125 per metre needs a modulus of {fitted:.2f} kPa; then",
          {w: f"{largest(by_eigenvalues(c, w, 1)).real:.2f}" for w in WAVES},
          f"; at {DEPTH} m MUD has {state(3.0)['modulus']:.2f} kPa")
    print("dS_w/de left out of the rate:", {w: f"{largest(by_eigenvalues(c, w, 1, False)).real:.2f}" for w in WAVES})

    print("largest growth with the wave number, suction 3:",
          {w: f"{float(largest(by_polynomial(c, w, 1)).real):.6g}" for w in (10, 125, 500, 1e3, 1e4, 1e5, 1e7)},
          f"limit {limit(c):.6g}")
    agreement = [("growth by eigenvalues against roots of the determinant with 60 digits, relative or per second", "all",
                  f"{worst:.1e}")]
    for suction in SUCTIONS:
        c = state(suction)
        far = float(largest(by_polynomial(c, 1e8, 1)).real)
        turns = [w for w in np.geomspace(1, 1e5, 400) if largest(by_eigenvalues(c, w, 1)).real > 1e-6]
        print(f"suction {suction}: growth at 1e8 per metre {far:.8g}, limit {limit(c):.8g}; "
              f"grows above {turns[0]:.3g} per metre")
        agreement.append(("limit of the growth against the root at 1e8 per metre, relative", f"{suction:g}",
                          f"{abs(limit(c)/far - 1):.1e}"))
    tables.write(folder(__file__)/"agreement.csv", ("check", "suction", "off_by"), agreement)

    for rate_of_e in (True, False):
        calm = [(limit(state(s), 0, rate_of_e), s) for s in np.geomspace(0.5, 2000, 400)]
        grows = [s for g, s in calm if g > 0]
        print(f"without seepage inertia, dS_w/de in the rate {rate_of_e}: limit at most {max(calm)[0]:.4g} at suction "
              f"{max(calm)[1]:.4g}" + (f", positive from {grows[0]:.4g} to {grows[-1]:.4g}" if grows else ""))
        found = max((float(largest(by_polynomial(state(s, m), w, 0, rate_of_e)).real), s, m, w)
                    for s in np.geomspace(0.5, 2000, 25) for m in (1e3, 1e4, 1e5) for w in np.geomspace(1, 1e5, 11))
        print("  scan over suction, modulus 1e3 to 1e5 kPa, 1 to 1e5 per metre: at most {:.4g} per second at suction "
              "{:.4g}, modulus {:.3g}, {:.3g} per metre".format(*found))
    for suction in (15.0, 22.4, 30.0):
        c = state(suction)
        grows = [w for w in np.geomspace(10, 1e6, 600) if largest(by_eigenvalues(c, w, 0)).real > 1e-3]
        print(f"  suction {suction}, modulus {c['modulus']:.0f}: grows above", f"{grows[0]:.3g}" if grows else "none",
              f"per metre, limit {limit(c, 0):.4g}")

    # The criterion of docs/theory/host.md section 2.5, saturated: Q (rho - rho_w) > rho_w E.
    rng, wrong = np.random.default_rng(3), 0
    for _ in range(2000):
        modulus, q, rho, k, wave = 10**rng.uniform(2, 6), 10**rng.uniform(2, 7), rng.uniform(1.1, 2.3), \
            10**rng.uniform(-6, 1), 10**rng.uniform(-1, 4)
        cubic = [rho/q/wave**2, k*(rho - RHO_W), modulus/q + 1, modulus*k*wave**2]
        unit = wave*math.sqrt(modulus/rho)
        scaled = [mp.mpf(x)*mp.mpf(unit)**(3 - i) for i, x in enumerate(cubic)]
        roots = mp.polyroots(scaled, maxsteps=500, extraprec=200)
        wrong += (max(mp.re(r) for r in roots) > 0) != (q*(rho - RHO_W) < RHO_W*modulus)
    print(f"criterion Q (rho - rho_w) > rho_w E against the roots: wrong in {wrong} of 2000 random saturated soils")

    with open(folder(__file__)/"history.csv", "w", newline="") as file:
        file.write("# first mode of a column, suction 3 kPa, modulus 13656.35 kPa, 125 per metre, made by growth.py\n"
                   "# u of the free end [m]; p_w, p_c at the base less their initial values [kPa]\n"
                   "# seepage_inertia,t,u,p_w,p_c\n")
        out = csv.writer(file, lineterminator="\n")
        for inertia in (1, 0):
            for t, y in history(state(3.0, 13656.35), 125.0, inertia):
                out.writerow([inertia, f"{t:.6g}"] + [f"{v:.10e}" for v in (y[0]/125.0, y[2], y[3])])


if __name__ == "__main__":
    main()
