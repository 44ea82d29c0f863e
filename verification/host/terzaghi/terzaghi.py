# SPDX-License-Identifier: MIT
"""Terzaghi's consolidation of a saturated column: series, checked by numerical inversion of the Laplace transform."""
import csv

import mpmath as mp
import numpy as np
from tools.results import folder

# kPa, m, s
HEIGHT, LOAD = 1.0, 1.0
YOUNG, POISSON, E_0 = 10000.0, 0.25, 0.8
K_OVER_ETA = 1e-12/1e-6                         # intrinsic permeability / viscosity [m2/(kPa s)]
OEDOMETER = YOUNG*(1 - POISSON)/((1 + POISSON)*(1 - 2*POISSON))
POROSITY = E_0/(1 + E_0)
RAMP = 0.05                                     # duration of the ramp, as a time factor
CASES = {"stiff_water": 2.2e6, "soft_water": 2.0e4}   # K_w [kPa]
TIME_FACTORS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.5, 2.0]
DEPTHS = np.round(np.linspace(0, 1, 11), 10)
TERMS = 4000                                    # exp(-M^2 T) is below 1e-16 far before that for T >= 0.01

M = (2*np.arange(TERMS) + 1)*np.pi/2


def coefficients(bulk_w):
    """Consolidation coefficient [m2/s] and share of the load that the water takes at once."""
    storage = 1/OEDOMETER + POROSITY/bulk_w
    return K_OVER_ETA/storage, (1/OEDOMETER)/storage


def memory(time_factor, ramped):
    """Time factor of each mode under a sudden load, or under one that grows linearly for RAMP and then stays."""
    if not ramped:
        return np.exp(-M**2*time_factor)
    since_end = max(time_factor - RAMP, 0.0)
    return (np.exp(-M**2*since_end) - np.exp(-M**2*time_factor))/(M**2*RAMP)


def pressure(depth, time_factor, bulk_w, ramped=False):
    _, share = coefficients(bulk_w)
    return LOAD*share*np.sum(2/M*np.sin(M*depth/HEIGHT)*memory(time_factor, ramped))


def settlement(time_factor, bulk_w, ramped=False):
    """Settlement of the top [m]: the strain is (load - p_w)/E_oed everywhere."""
    _, share = coefficients(bulk_w)
    load = LOAD*(min(time_factor/RAMP, 1.0) if ramped else 1.0)
    return HEIGHT/OEDOMETER*(load - LOAD*share*np.sum(2/M**2*memory(time_factor, ramped)))


def by_laplace(time_factor, bulk_w, transform, ramped):
    """Inverse transform in the time factor; the ramp is the difference of two integrated steps."""
    def step(t):
        return mp.invertlaplace(transform, t, method="talbot", degree=40) if t > 0 else mp.mpf(0)
    if not ramped:
        return step(time_factor)

    def grown(t):
        return mp.invertlaplace(lambda s: transform(s)/s, t, method="talbot", degree=40) if t > 0 else mp.mpf(0)
    return (grown(time_factor) - grown(time_factor - RAMP))/RAMP


def check():
    mp.mp.dps = 40
    worst_p = worst_w = 0.0
    for bulk_w in CASES.values():
        _, share = coefficients(bulk_w)
        for ramped in (False, True):
            for t in TIME_FACTORS:
                for depth in DEPTHS[::2]:
                    exact = by_laplace(t, bulk_w, lambda s, d=depth: LOAD*share/s*(
                        1 - mp.cosh(mp.sqrt(s)*(1 - mp.mpf(float(d))))/mp.cosh(mp.sqrt(s))), ramped)
                    worst_p = max(worst_p, abs(float(exact) - pressure(depth, t, bulk_w, ramped)))
                mean = by_laplace(t, bulk_w, lambda s: LOAD*share/s*(1 - mp.tanh(mp.sqrt(s))/mp.sqrt(s)), ramped)
                load = LOAD*(min(t/RAMP, 1.0) if ramped else 1.0)
                exact = HEIGHT/OEDOMETER*(load - float(mean))
                worst_w = max(worst_w, abs(exact - settlement(t, bulk_w, ramped))/(HEIGHT*LOAD/OEDOMETER))
    print(f"series against numerical Laplace inversion: pressure {worst_p:.1e} of the load, "
          f"settlement {worst_w:.1e} of the final one")


if __name__ == "__main__":
    with open(folder(__file__)/"terzaghi.csv", "w", newline="") as file:
        file.write("# Terzaghi: pore pressure and settlement of a saturated column, made by terzaghi.py\n"
                   "# m, s, kPa, compression positive; depth from the drained top; settlement downwards positive\n"
                   "# case,K_w,ramped,time_factor,t,depth,p_w,settlement\n")
        out = csv.writer(file, lineterminator="\n")
        for name, bulk_w in CASES.items():
            c_v, share = coefficients(bulk_w)
            print(f"{name}: E_oed {OEDOMETER:.6g} kPa, c_v {c_v:.10g} m2/s, H^2/c_v {HEIGHT**2/c_v:.10g} s, "
                  f"initial p_w {share*LOAD:.10g} kPa, ramp {RAMP*HEIGHT**2/c_v:.10g} s")
            for ramped in (False, True):
                for t in TIME_FACTORS:
                    w = settlement(t, bulk_w, ramped)
                    for depth in DEPTHS:
                        p = pressure(depth, t, bulk_w, ramped)
                        out.writerow([name, bulk_w, int(ramped), t, f"{t*HEIGHT**2/c_v:.12g}", depth,
                                      f"{p:.12e}", f"{w:.12e}"])
    check()
