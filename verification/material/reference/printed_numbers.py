# SPDX-License-Identifier: MIT
"""Runs what docs/theory/integration.md section 6 and the other chapters print as numbers; writes printed_numbers.csv."""
import pathlib
from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tools import tables
from tools.results import folder

from mud_reference import State, isotropic, oedometric, segment, stress_ratio, undrained
from reference_rates import I3, Params, Point, bonding, rates, saturation, six, tensor

DATA = pathlib.Path(__file__).resolve().parents[1] / "verdugo_ishihara/verdugo_ishihara_1996_drained_TC.csv"
RTOL = 1e-11
TABLE = []  # (chapter and section of docs/theory, path, quantity, printed, reference)


def put(section, path, quantity, printed, ref):
    TABLE.append((section, path, quantity, printed, float(ref)))


def last_place(v):
    """The unit of the last decimal with which a printed number is written here."""
    from decimal import Decimal
    return float(Decimal(1).scaleb(Decimal(repr(v)).as_tuple().exponent))


def march(st, marks, make, P):
    """Strain-driven to each mark in turn; yields the state there."""
    at = 0.0
    for m in marks:
        segment(st, make(m - at), 0.0, P, rtol=RTOL)
        at = m
        yield m, st


def monotone():
    P = Params()
    undr = "undrained triaxial compression e %g p' %g"
    for e, p, want in (
        (0.735, 100, {0.01: (147.354, 219.587), 0.05: (945.895, 1389.631), 0.10: (2187.207, 2919.954), 0.15: (2744.524, 3492.136),
                      0.25: (2915.588, 3647.169)}),
        (0.833, 2000, {0.01: (1517.99, 1228.01), 0.05: (1092.54, 1343.28), 0.25: (1115.48, 1394.49)}),
        (0.907, 100, {0.01: (68.124, 78.632), 0.10: (106.355, 134.407), 0.25: (160.043, 200.922)})):
        for m, st in march(isotropic(p, e), list(want), undrained, P):
            put("integration 6.1", undr % (e, p), f"p' at {m}", want[m][0], st.p)
            put("integration 6.1", undr % (e, p), f"q at {m}", want[m][1], st.q)
    for m, st in march(isotropic(100, 0.833), [-0.10], undrained, P):
        put("integration 6.1", "undrained extension e 0.833 p' 100", "p' at -0.10", 535.656, st.p)
        put("integration 6.1", "undrained extension e 0.833 p' 100", "q at -0.10", -505.672, st.q)
    for m, st in march(isotropic(50, 0.8), [0.06], oedometric, P):
        name = "oedometer e 0.8 p' 50"
        put("integration 6.1", name, "sigma_a", 16088.2, st.sig[0, 0])
        put("integration 6.1", name, "sigma_r", 5401.90, st.sig[1, 1])
        put("integration 6.1", name, "e", 0.695176, st.e)
        put("material 7.3", name, "(p'/alpha_hat)(1 + 2 eta^2/M^2)", 1.58, Point(st.sig, st.e, 0.0, st.z, st.r_in, P).ratio)
    for m, st in march(isotropic(50, 0.8), [0.06], lambda d: d / 3.0 * I3, P):
        put("integration 6.1", "isotropic e 0.8 p' 50", "p'", 10444.51, st.p)
    name = "constant volume shear e 0.8 p' 20 p_c 100"
    S, Sp, Se = saturation(0.8, 100.0, P)
    put("integration 6.1", name, "S_w", 0.195490, S)
    put("integration 6.1", name, "dS_w/dp_c", -7.51854e-4, Sp)
    put("integration 6.1", name, "dS_w/de", -0.187964, Se)
    for m, st in march(isotropic(20, 0.8, 100.0), [0.10], undrained, P):
        put("integration 6.1", name, "p'", 5170.21, st.p)
        put("integration 6.1", name, "q", 7764.07, st.q)
    for e, p, pc, qc in ((0.735, 100, 2922.1, 3652.6), (0.833, 100, 1116.2, 1395.3), (0.907, 100, 194.4, 243.0)):
        ps = (P.N_c / e) ** (1.0 / P.lam) - P.alpha_csl
        put("material 7.1", f"steady state e {e}", "p'", pc, ps)
        put("material 7.1", f"steady state e {e}", "q", qc, P.M_c * ps)
    sa = 3.0 * 60.0 / 1.8
    for r_in, printed, what in ((None, 83.2, "r_in = r"), (np.zeros((3, 3)), 69.1, "r_in = 0")):
        st = State(np.diag([sa, 0.4 * sa, 0.4 * sa]), 0.8, r_in=r_in)
        segment(st, undrained(1e-3), 0.0, P, rtol=RTOL)
        put("material 1.4", "K0 0.4 p' 60 e 0.8, eps_a 1e-3 undrained", f"q, {what}", printed, st.q)


def reversals():
    want = {(0.01, "clean"): (312.0,), (0.01, "classic"): (319.5,), (0.01, "threshold"): (294.0,), (0.01, "repositioning"): (292.6,),
            (0.01, "return_point"): (310.0,),
            (0.05, "clean"): (1574.0,), (0.05, "classic"): (1522.9,), (0.05, "threshold"): (1524.2,),
            (0.05, "repositioning"): (1524.2,), (0.05, "return_point"): (1536.6,),
            (0.10, "clean"): (3015.6, 3242.0, 3492.1), (0.10, "classic"): (2936.1, 3139.8, 3396.7),
            (0.10, "threshold"): (2943.1, 3178.1, 3456.4), (0.10, "repositioning"): (2943.1,), (0.10, "return_point"): (2946.5, 3181.4, 3459.4)}
    around = {"threshold": ((0, "before", 2920.0), (1, "turn", 2845.0), (2, "return", 2848.0)),
              "return_point": ((1, "turn", 2845.0), (2, "return", 2851.2))}
    for (at, rule), printed in want.items():
        P = replace(Params(), rule="classic" if rule == "clean" else rule)
        st = isotropic(100, 0.735)
        segment(st, undrained(at), 0.0, P, rtol=RTOL)
        name = f"reversal of 1.5e-4 at {at}, {rule}"
        if rule != "clean":
            q = [st.q]
            for d in (-1.5e-4, 1.5e-4):
                segment(st, undrained(d), 0.0, P, rtol=RTOL)
                q.append(st.q)
            if at == 0.10:
                for k, what, v in around.get(rule, ()):
                    put("integration 6.2", name, f"q {what}", v, q[k])
        pos = at
        for m, v in zip((at + 0.005, 0.12, 0.15), printed):
            segment(st, undrained(m - pos), 0.0, P, rtol=RTOL)
            pos = m
            put("integration 6.2", name, f"q at {m:g}", v, st.q)


def noise40():
    """40 reversals of 1e-5, taken here as equally spaced: after 0.01 + 0.001 k, k = 0..39 (the table of the reversals does not say where)."""
    base = 1389.6314
    for rule, printed in (("classic", -3.8), ("threshold", -10.0), ("repositioning", -10.5), ("return_point", -4.7)):
        P = replace(Params(), rule=rule)
        st = isotropic(100, 0.735)
        segment(st, undrained(0.01), 0.0, P, rtol=1e-9)
        for _ in range(40):
            for d in (-1e-5, 1e-5, 1e-3):
                segment(st, undrained(d), 0.0, P, rtol=1e-9)
        put("-", "40 reversals of 1e-5, equally spaced", f"{rule} [%]", printed, 100.0 * (st.q / base - 1.0))


def drained(s3, e0, marks, P):
    """Drained triaxial compression at constant radial effective stress: q and eps_v at the marks."""
    r_in = np.zeros((3, 3))

    def rate(y):
        sig, z = np.diag([y[0], y[1], y[1]]), np.diag([y[3], -0.5 * y[3], -0.5 * y[3]])

        def f(k):
            return rates(sig, y[2], 0.0, z, r_in, np.diag([1.0, k, k]), 0.0, P, nscan=3)
        k = brentq(lambda v: f(v).dsig[1, 1], -3.0, 1.0, xtol=1e-14)
        q = f(k)
        dv = 1.0 + 2.0 * k
        return np.array([q.dsig[0, 0], q.dsig[1, 1], -(1.0 + y[2]) * dv, q.dz[0, 0], dv]), q

    def behind(s, y):
        return rate(y)[1].x + P.x_rev
    behind.terminal, behind.direction = True, -1
    y, t, out = np.array([s3, s3, e0, 0.0, 0.0]), 0.0, []
    for m in marks:
        while t < m:
            so = solve_ivp(lambda s, v: rate(v)[0], (t, m), y, method="DOP853", rtol=1e-9, atol=1e-9, events=behind)
            y, t = so.y[:, -1], so.t[-1]
            if so.status == 1:
                r_in = stress_ratio(np.diag([y[0], y[1], y[1]]), P)
        out.append((y[0] - y[1], 100.0 * y[4]))
    return np.array(out)


def laboratory():
    tests = {}
    for d in tables.rows(DATA):
        tests.setdefault((float(d["sigma3_kPa"]), float(d["e0"])), []).append(
            [float(d[k]) for k in ("eps_a_pct", "q_kPa_derived", "eps_v_pct")])
    want = {(100, 0.831): (7.9, 0.46), (100, 0.917): (15.0, 0.83), (100, 0.996): (32.3, 1.64), (500, 0.81): (7.2, 0.10),
            (500, 0.886): (14.3, 0.98), (500, 0.96): (41.1, 1.90)}
    for key, printed in want.items():
        d = np.array(tests[key])
        got = drained(*key, d[:, 0] / 100.0, Params())
        use = (d[:, 0] > 0.999) & (d[:, 0] < 25.001)
        name = f"Verdugo & Ishihara {key[0]:g} kPa e {key[1]:g}, rms over the rows from 1 to 25 %"
        put("integration 6.3", name, "q [%]", printed[0], 100.0 * np.sqrt(np.mean((got[use, 0] / d[use, 1] - 1.0) ** 2)))
        put("integration 6.3", name, "eps_v [points]", printed[1], np.sqrt(np.mean((got[use, 1] - d[use, 2]) ** 2)))


def self_checks():
    """Rotation of the input rotates the answer; degree one; derivatives of S_w and f against differences."""
    rng = np.random.default_rng(1)
    P = Params()
    sig, z, ri, de = (tensor(v) for v in ((130, 90, 80, 12, -9, 6), (.5, -.2, -.3, .4, .1, -.2), (.1, 0, -.1, .05, 0, .02),
                                          (5e-5, -3e-5, -1e-5, 2e-5, -1e-5, 7e-6)))
    Q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    a = rates(sig, 0.8, 30.0, z, ri, de, -1.0, P)
    b = rates(*(Q @ m @ Q.T if isinstance(m, np.ndarray) else m for m in (sig, 0.8, 30.0, z, ri, de)), -1.0, P)
    c = rates(sig, 0.8, 30.0, z, ri, 7.0 * de, -7.0, P)
    print("rotation", np.abs(Q @ a.dsig @ Q.T - b.dsig).max() / np.abs(a.dsig).max(),
          "degree one", np.abs(7 * a.dsig - c.dsig).max() / np.abs(c.dsig).max())
    h = 1e-5
    for fn in (saturation, bonding):
        v = fn(0.8, 30.0, P)
        print(fn.__name__, "slopes against central differences",
              (fn(0.8, 30 + h, P)[0] - fn(0.8, 30 - h, P)[0]) / (2 * h) - v[1], (fn(.8 + h, 30., P)[0] - fn(.8 - h, 30., P)[0]) / (2 * h) - v[2])
    th = np.linspace(0.0, np.pi / 3.0, 200001)
    for label, g, cs in (("fourth root", lambda c, x: (2 * c**4 / (1 + c**4 - (1 - c**4) * x)) ** 0.25, np.arange(0.605, 0.616, 1e-3)),
                         ("common", lambda c, x: 2 * c / (1 + c - (1 - c) * x), np.arange(0.770, 0.785, 1e-3))):
        ok = []
        for c in cs:
            u = 1.0 / g(c, np.cos(3 * th))
            curv = np.gradient(np.gradient(u, th), th)[3:-3] + u[3:-3]
            if curv.min() >= -1e-6:
                ok.append(c)
        print("Lode", label, "convex from c =", round(float(min(ok)), 4))


def main():
    monotone()
    reversals()
    noise40()
    laboratory()
    with open(folder(__file__) / "printed_numbers.csv", "w") as fh:
        fh.write("# numbers that the chapters of docs/theory print, by mud_reference.py, independent of the library\n")
        fh.write("# default parameters, kPa, compression positive; printed: in the chapter; reference: integrated at rtol 1e-11\n")
        fh.write("# chapter and section, path, quantity, printed, reference, relative difference\n")
        for sec, path, what, printed, ref in TABLE:
            fh.write(f'{sec},"{path}","{what}",{printed:.9g},{ref:.10g},{ref / printed - 1.0:.1e}\n')
            unit = last_place(printed)
            mark = "" if abs(ref - printed) <= 0.5001 * unit else f"   <-- {abs(ref - printed) / unit:.1f} units of the last printed place"
            print(f"{sec:16s} {path:60s} {what:34s} {printed:12.9g} {ref:16.10g} {ref / printed - 1.0:9.1e}{mark}")
    self_checks()


if __name__ == "__main__":
    main()
