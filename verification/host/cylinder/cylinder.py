# SPDX-License-Identifier: MIT
"""Lame: thick cylinder in plane strain under internal pressure; and the same wall filled with water at steady flow."""
import csv

import numpy as np
from scipy.integrate import solve_bvp
from tools.results import folder

# kPa, m
INNER, OUTER, PRESSURE = 1.0, 2.0, 10.0
YOUNG = 10000.0
RADII = np.round(np.linspace(INNER, OUTER, 11), 10)
CASES = [(0.3, 0.0), (0.49, 0.0), (0.0, 0.0), (0.3, 5.0)]   # Poisson's ratio; pore pressure at the inner wall [kPa]


def moduli(poisson):
    mu = YOUNG/(2*(1 + poisson))
    return 2*mu*poisson/(1 - 2*poisson), mu


def solution(r, poisson, pore):
    """u_r and total stresses rr, tt, zz, compression positive, and p_w = pore ln(b/r)/ln(b/a).

    With effective stress sigma' = -(D : strain): (lambda + 2 mu) (div u),r = p_w,r, so
    u = A r + B/r + part(r), where part solves (1/r (r part)')' = p_w,r/(lambda + 2 mu).
    """
    lam, mu = moduli(poisson)
    slope = -pore/np.log(OUTER/INNER)/(lam + 2*mu)       # p_w,r = (lambda + 2 mu) slope/r
    # (1/r)(r part)' = slope ln r, so r part = slope (r^2/2 ln r - r^2/4)
    part = slope*(r/2*np.log(r) - r/4)
    part_r = slope*(np.log(r)/2 + 0.25)
    p_w = pore*np.log(OUTER/r)/np.log(OUTER/INNER)

    def traction(radius):
        """Total radial stress, tension positive, of A, B and of the part with p_w."""
        q = slope*(np.log(radius)/2 + 0.25)
        h = slope*(np.log(radius)/2 - 0.25)
        p = pore*np.log(OUTER/radius)/np.log(OUTER/INNER)
        return [2*(lam + mu), -2*mu/radius**2], (lam + 2*mu)*q + lam*h - p
    rows = [traction(INNER), traction(OUTER)]
    a, b = np.linalg.solve([rows[0][0], rows[1][0]], [-PRESSURE - rows[0][1], -rows[1][1]])
    u = a*r + b/r + part
    e_r, e_t = a - b/r**2 + part_r, a + b/r**2 + part/r
    volume = e_r + e_t
    return u, [-lam*volume - 2*mu*e + p_w for e in (e_r, e_t, 0*e_r)], p_w


def by_lame(r):
    """Stresses of Lame in their usual form, compression positive, and u_r; no pore pressure."""
    c = PRESSURE*INNER**2/(OUTER**2 - INNER**2)
    return -c*(1 - OUTER**2/r**2), -c*(1 + OUTER**2/r**2)


def check():
    worst = 0.0
    for poisson, pore in CASES:
        lam, mu = moduli(poisson)
        u, stress, _ = solution(RADII, poisson, pore)
        if pore == 0.0:
            rr, tt = by_lame(RADII)
            c = PRESSURE*INNER**2/(OUTER**2 - INNER**2)
            lame_u = (1 + poisson)/YOUNG*c*((1 - 2*poisson)*RADII + OUTER**2/RADII)
            worst = max(worst, np.abs(stress[0] - rr).max()/PRESSURE, np.abs(stress[1] - tt).max()/PRESSURE,
                        np.abs(u/lame_u - 1).max())
        p_r = -pore/np.log(OUTER/INNER)

        def rates(r, y):
            # y = u, u'; (lam + 2 mu)(u'' + u'/r - u/r^2) = p_w,r
            return np.vstack([y[1], p_r/r/(lam + 2*mu) - y[1]/r + y[0]/r**2])

        def ends(ya, yb):
            return np.array([(lam + 2*mu)*ya[1] + lam*ya[0]/INNER - pore + PRESSURE,
                             (lam + 2*mu)*yb[1] + lam*yb[0]/OUTER])/PRESSURE
        numeric = solve_bvp(rates, ends, np.linspace(INNER, OUTER, 201), np.zeros((2, 201)), tol=1e-11,
                            max_nodes=200000)
        difference = np.abs(numeric.sol(RADII)[0]/u - 1).max()
        print(f"nu {poisson}, pore pressure {pore}: u(a) {u[0]:.10e}, u(b) {u[-1]:.10e}, "
              f"boundary value solver {difference:.1e}")
    print(f"against Lame's formulas: {worst:.1e}")


if __name__ == "__main__":
    with open(folder(__file__)/"cylinder.csv", "w", newline="") as file:
        file.write("# thick cylinder in plane strain, internal pressure 10 kPa, made by cylinder.py\n"
                   "# kPa, m; stress total, compression positive; u_r outwards positive\n"
                   "# poisson,p_w_inner,r,u_r,sigma_rr,sigma_tt,sigma_zz,p_w\n")
        out = csv.writer(file, lineterminator="\n")
        for poisson, pore in CASES:
            u, stress, p_w = solution(RADII, poisson, pore)
            for i, radius in enumerate(RADII):
                out.writerow([poisson, pore, radius] + [f"{v:.12e}" for v in (u[i], *(s[i] for s in stress), p_w[i])])
    check()
