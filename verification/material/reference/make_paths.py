# SPDX-License-Identifier: MIT
"""Writes paths.csv: general six-component, strain-driven paths integrated by mud_reference.py at tight tolerance."""
import sys
import time
from dataclasses import replace

import numpy as np

from tools.results import folder

from mud_reference import State, segment, stress_ratio
from reference_rates import Params, Point, dd, norm, rates, saturation, six, tensor

RULES = ("classic", "threshold", "repositioning", "return_point")
EFFECTS = ("isotropic", "retention", "bonding", "fabric", "lode")

# base directions, none aligned with an axis, all six components nonzero and different (11, 22, 33, 12, 13, 23), x 1e-3
A = (5.1, -3.3, -1.2, 2.3, -1.1, 0.7)
B = (3.2, -4.4, 1.9, 3.1, 1.6, -0.9)
C = (-1.4, -2.6, 4.8, 1.2, 2.9, -1.7)
D = (2.7, 1.3, -3.6, -1.8, 0.6, 2.2)
V = (0.83, 0.46, 0.71, 0.19, -0.23, 0.11)  # mostly volumetric


def mix(*pairs):
    """Sum of factor x base direction, in strain, rounded to 8 decimals."""
    s = np.zeros(6)
    for k, v in zip(pairs[0::2], pairs[1::2]):
        s += k * 1e-3 * np.array(v)
    return tuple(float(x) for x in np.round(s, 8))


ZERO = (0.0,) * 6
ROT = [(mix(1, A), 0), (mix(2, A, 1, B), 0), (mix(1, A, 2, B), 0), (mix(3, B, 0.2, V), 0), (mix(2, B, 1, C, 0.3, V), 0)]
UNS = [(mix(0.5, A), -2.0), (mix(1, A, 0.5, B, 0.2, V), -6.0), (ZERO, -9.0), (mix(1, B, 0.4, V), 8.0),
       (mix(1, B, 0.5, C), 14.0), (ZERO, 5.0), (mix(0.5, B, 1, C, -0.1, V), -20.0)]
NOISE = [(mix(4, A), 0), (mix(-0.008, A), 0), (mix(0.008, A), 0), (mix(1, A, 0.1, B), 0)]
SOFT = [(mix(0.6, A), 0), (mix(-0.015, A), 0), (mix(0.02, A), 0), (mix(0.4, A, 0.1, B), 0)]
NEST = [(mix(1, A), 0), (mix(-0.2, A, -0.02, B), 0), (mix(0.08, A, 0.01, B), 0), (mix(-0.03, A, 0.005, C), 0), (mix(0.025, A), 0),
        (mix(0.2, A, 0.02, B), 0), (mix(0.5, A, 0.2, B), 0)]
PULSE = [(mix(1, A), 0), (mix(-0.08, A), 6.0), (mix(0.04, A), -9.0), (mix(0.1, A, 0.01, B), 4.0), (mix(0.5, A, 0.1, B), -6.0)]
TURN = [(mix(-1, B, -0.5, C), 0.0), (mix(-0.5, B, -1, A), 3.0)]

# id: (title, sig(6), e, p_c, rule, effects off, segments)
PATHS = {
    1: ("dense, p' 100, saturated, rotating", (130, 90, 80, 12, -9, 6), 0.735, 0.0, "threshold", (), ROT),
    2: ("loose, p' 100, saturated, rotating", (130, 90, 80, 12, -9, 6), 0.91, 0.0, "threshold", (), ROT),
    3: ("dense, p' 20, saturated, rotating, large strain", (26, 15, 19, 2.5, 1.1, -1.7), 0.76, 0.0, "threshold", (),
        [(mix(3, B), 0), (mix(3, B, 2, A), 0), (mix(6, A), 0), (mix(4, A, 2, D), 0)]),
    4: ("loose, p' 1000, saturated, rotating", (1250, 820, 930, 95, -60, 75), 0.89, 0.0, "threshold", (),
        [(mix(2, C), 0), (mix(2, C, 1, B), 0), (mix(1, C, 3, B), 0), (mix(4, B, 1, A), 0)]),
    5: ("dense, p' 50, suction 3, dried and wetted", (65, 45, 40, 6, 4, -3), 0.75, 3.0, "threshold", (),
        [(mix(0.5, A), 2.0), (mix(1, A, 0.5, B), 20.0), (ZERO, -10.0), (mix(1, B), -14.0), (mix(1, B, 0.5, A, 0.2, V), 1.0)]),
    6: ("medium, p' 200, suction 30, wetted, dried", (260, 170, 170, 25, -18, 11), 0.83, 30.0, "threshold", (), UNS),
    7: ("loose, p' 300, suction 100, wetted to saturation", (380, 260, 260, 30, 22, -15), 0.93, 100.0, "threshold", (),
        [(mix(0.5, B, 0.3, V), -30.0), (ZERO, -40.0), (mix(1, B, 0.5, A), -25.0), (mix(0.3, A), -5.0), (mix(1, A, 0.3, D), -3.0),
         (mix(0.5, A, 0.4, V), 40.0)]),
    8: ("medium, p' 150, two genuine reversals", (180, 140, 130, 15, -8, 12), 0.80, 0.0, "threshold", (),
        [(mix(3, A), 0), (mix(-2, A, -0.3, B), 0), (mix(-2, B, -0.5, C), 0), (mix(4, A, 1, B, 0.2, V), 0)]),
    9: ("as 8, suction 30 held", (180, 140, 130, 15, -8, 12), 0.80, 30.0, "classic", (),
        [(mix(3, A), 0), (mix(-2, A, -0.3, B), 0), (mix(-2, B, -0.5, C), 0), (mix(4, A, 1, B, 0.2, V), 0)]),
    10: ("small reversal, rule classic", (130, 90, 80, 12, -9, 6), 0.78, 0.0, "classic", (), NOISE),
    11: ("small reversal, rule threshold", (130, 90, 80, 12, -9, 6), 0.78, 0.0, "threshold", (), NOISE),
    12: ("small reversal, rule repositioning", (130, 90, 80, 12, -9, 6), 0.78, 0.0, "repositioning", (), NOISE),
    13: ("small reversal, rule return_point", (130, 90, 80, 12, -9, 6), 0.78, 0.0, "return_point", (), NOISE),
    14: ("unloading towards p_min", (26, 18, 17, 2.2, -1.3, 1.7), 0.85, 0.0, "threshold", (),
         [(mix(0.2, A), 0), (mix(-1.2, V, 0.05, A), 0), (mix(-0.7, V, 0.02, B), 0), (mix(-0.25, V, 0.01, B), 0),
          (mix(0.02, B, 0.02, V), 0), (mix(0.3, B, 0.5, V), 0)]),
    15: ("compression onto the line, p' 1000 up, suction 30", (1200, 950, 900, 60, -50, 40), 0.84, 30.0, "threshold", (),
         [(mix(15, V), 0), (mix(15, V, 0.5, A), -10.0), (mix(10, V, 1, A), 15.0)]),
    16: ("outside the bounding surface: dense, suction 60, sheared, wetted, small turn, reloaded (softening cap)",
         (260, 180, 160, 25, -15, 10), 0.74, 60.0, "classic", (),
         [(mix(2, A), 0), (ZERO, -54.0), (mix(-0.02, A), 0), (mix(0.02, A), 0), (mix(0.05, A, 0.05, B), 0), (mix(0.5, A, 0.5, B), 0)]),
    30: ("small reversal while hardening, rule classic", (130, 90, 80, 12, -9, 6), 0.90, 0.0, "classic", (), SOFT),
    31: ("small reversal while hardening, rule threshold", (130, 90, 80, 12, -9, 6), 0.90, 0.0, "threshold", (), SOFT),
    32: ("small reversal while hardening, rule repositioning", (130, 90, 80, 12, -9, 6), 0.90, 0.0, "repositioning", (), SOFT),
    33: ("small reversal while hardening, rule return_point", (130, 90, 80, 12, -9, 6), 0.90, 0.0, "return_point", (), SOFT),
    34: ("loops inside loops, rule return_point", (130, 90, 80, 12, -9, 6), 0.80, 0.0, "return_point", (), NEST),
    35: ("loop while suction changes, rule return_point", (180, 140, 130, 15, -8, 12), 0.80, 30.0, "return_point", (), PULSE),
    20: ("all effects on, suction 20 (as 21-26)", (330, 220, 230, 28, -20, 14), 0.84, 20.0, "threshold", (), UNS + TURN),
    21: ("isotropic mechanism off", (330, 220, 230, 28, -20, 14), 0.84, 20.0, "threshold", ("isotropic",), UNS + TURN),
    22: ("retention off (S_w = S_max)", (330, 220, 230, 28, -20, 14), 0.84, 20.0, "threshold", ("retention",), UNS + TURN),
    23: ("bonding off (f = 1)", (330, 220, 230, 28, -20, 14), 0.84, 20.0, "threshold", ("bonding",), UNS + TURN),
    24: ("fabric off (A_d = A_0, dz = 0)", (330, 220, 230, 28, -20, 14), 0.84, 20.0, "threshold", ("fabric",), UNS + TURN),
    25: ("Lode off (g = 1)", (330, 220, 230, 28, -20, 14), 0.84, 20.0, "threshold", ("lode",), UNS + TURN),
    26: ("all five off", (330, 220, 230, 28, -20, 14), 0.84, 20.0, "threshold", EFFECTS, UNS + TURN),
}


def integrate(pid, rtol, method="DOP853", nscan=121, pieces=1, max_step=np.inf, **change):
    title, sig, e, pc, rule, off, segs = PATHS[pid]
    P = replace(Params(), rule=rule, **{k: False for k in off}, **change)
    st = State(tensor(sig), e, pc)
    out = []
    info = []
    for de, dpc in segs:
        de = tensor(de)
        q0 = rates(st.sig, st.e, st.pc, st.z, st.r_in, de, dpc, P, nscan=2001, refine=True)
        nlog = len(st.log)
        for _ in range(pieces):
            segment(st, de / pieces, dpc / pieces, P, rtol=rtol, method=method, nscan=nscan, max_step=max_step)
        q1 = rates(st.sig, st.e, st.pc, st.z, st.r_in, de, dpc, P, nscan=2001, refine=True)
        pt = Point(st.sig, st.e, st.pc, st.z, st.r_in, P)
        info.append((q0.x, q1.x, q0.iso, q1.iso, q1.flags, st.log[nlog:], st.p, np.sqrt(pt.eta2), pt.Mb, pt.psi, pt.ratio, q0.roots,
                     q1.roots))
        S = saturation(st.e, st.pc, P)[0]
        out.append(np.array([*six(st.sig), st.e, st.pc, S, *six(st.z), st.eqp, st.resets]))
    return np.array(out), info, st


def distance(a, b):
    """Largest difference per row, relative to |sig|, e, z_max, 0.01 (the error norm of docs/theory/integration.md section 3)."""
    w = np.array([1, 1, 1, 2, 2, 2.0])
    ds = np.sqrt(((a[:, :6] - b[:, :6]) ** 2 * w).sum(1) / (b[:, :6] ** 2 * w).sum(1))
    dz = np.sqrt(((a[:, 9:15] - b[:, 9:15]) ** 2 * w).sum(1)) / 4.0
    return np.maximum.reduce([ds, np.abs(a[:, 6] - b[:, 6]) / b[:, 6], dz, np.abs(a[:, 15] - b[:, 15]) / 0.01,
                              np.abs(a[:, 8] - b[:, 8])])


def show(pid):
    """A readable trace of one path."""
    a, info, st = integrate(pid, 1e-9)
    print(f"== {pid} {PATHS[pid][0]}: rates {st.nrate} steps {st.nsteps} resets {st.resets}")
    for row, i in zip(a, info):
        print("   sig", np.array2string(row[:6], precision=2, floatmode="fixed"),
              "e %.4f Sw %.4f eqp %.5f |z| %.3f" % (row[6], row[8], row[15], norm(tensor(row[9:15]))),
              "x %.4f %.4f iso %d %d p %.2f eta %.3f Mb %.3f psi %.3f ratio %.3g roots %d %d" % (*i[:4], *i[6:]),
              {k for k, v in i[4].items() if v}, i[5])


def main():
    rows, notes = [], []
    for pid, (title, sig, e, pc, rule, off, segs) in PATHS.items():
        ref, info, st = integrate(pid, 1e-13, max_step=0.02)
        log = [k for i in info for k in i[5]]
        b = integrate(pid, 1e-12, nscan=401, pieces=3, max_step=0.05)[0]
        c = integrate(pid, 1e-11, method="LSODA", max_step=0.05)[0]
        u = np.maximum(distance(b, ref), 1e-12)
        ul = distance(c, ref).max()
        drift = sum(1 for k in log if k[0] == "reset" and k[1] > 0.0)
        again = sum(1 for k in log if k[0] == "still behind")
        note = f"# path {pid}: {title}; rule {rule}; converged to {u.max():.0e} (DOP853), LSODA differs by {ul:.0e}"
        if drift:
            late = integrate(pid, 1e-11, x_rev=1.1e-3)[0]
            ds = np.abs(late[:, :6] - ref[:, :6]).max() / np.abs(ref[:, :6]).max()
            note += (f"; {drift} resets inside segments: if each came 1e-4 (in x) late the stress would move by {ds:.0e},"
                     f" eps_q^p by {np.abs(late[:, 15] - ref[:, 15]).max():.0e} absolute")
        back = sum(1 for k in log if k[0] == "return")
        if back:
            note += f"; {back} returns to an interrupted process"
        if again:
            note += f"; {again} times still behind after a reset"
        print(note, flush=True)
        notes.append(note)
        mask = sum(1 << k for k, name in enumerate(EFFECTS) if name in off)
        rule_id = RULES.index(rule)
        S0 = saturation(e, pc, replace(Params(), **{k: False for k in off}))[0]
        first = [*map(float, sig), e, pc, S0, *(0.0,) * 6, 0.0]
        table = [(0, ZERO, 0.0, first, 0, 0.0)]
        for k, ((de, dpc), r, uu) in enumerate(zip(segs, ref, u), 1):
            table.append((k, de, dpc, r[:16], int(r[16]), uu))
        for k, de, dpc, r, nre, uu in table:
            ins = [f"{v + 0.0:.8g}" for v in (*de, dpc)]
            rows.append(",".join([str(pid), str(k), str(rule_id), str(mask), *ins, *(f"{v + 0.0:.11e}" for v in r), str(nre), f"{uu:.0e}"]))
    head = [
        "# general six-component reference paths of MUD; made by mud_reference.py (make_paths.py), independent of the library",
        "# units kPa and -, compression positive, true tensor shear (not engineering), component order 11 22 33 12 13 23",
        "# sig = effective stress. Default parameters (paper Tables 2, 3; p_atm 101.325, theta 0.2, eps_hat 1e-4, guards on), no elastic domain",
        "# segment 0 holds the initial state (z = 0, eps_q^p = 0, J = 0, r_in = r_in_before = r); its deps, dpc are zero",
        "# segment k > 0: deps, dpc applied linearly from the state of segment k-1; then the state at its end",
        "# de = -(1+e) tr(deps), so e = (1+e_start) exp(-tr(deps)) - 1",
        "# rule: 0 classic 1 threshold 2 repositioning 3 return_point",
        "# off: effects switched off, 1 isotropic mechanism 2 retention (S_w = S_max = 1) 4 bonding (f = 1; b1 = 0) 8 fabric (A_d = A_0, dz = 0) 16 Lode (g = 1; c = 1)",
        "# resets: number since the start; unc: change on a 10 times looser tolerance with every segment cut in 3",
        "# (largest of |d sig|/|sig|, |d e|/e, |d z|/z_max, |d eps_q^p|/0.01, |d S_w|; 1e-12 is the smallest stated)",
        "# eps_q^p is that of the present loading process: zero after a reset, and zero again where an interrupted process goes on (rule return_point)",
        *notes,
        "# path, segment, rule, off, deps(6), dpc, sig(6), e, p_c, S_w, z(6), eps_q^p, resets, unc",
    ]
    with open(folder(__file__) / "paths.csv", "w") as fh:
        fh.write("\n".join(head + rows) + "\n")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        for arg in sys.argv[1:]:
            show(int(arg))
    else:
        t0 = time.time()
        main()
        print(f"{time.time() - t0:.0f} s")
