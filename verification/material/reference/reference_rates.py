# SPDX-License-Identifier: MIT
"""Independent reference implementation of the soil model MUD, the continuous part: the state at a point and its rates.

Written from the equations of docs/theory and the paper alone, without sight of the library. It does things differently
on purpose: full 3x3 tensors (no Voigt), tr(n^3) = 3 det(n), the direction equation solved by a dense scan of the angle w
followed by Brent's method.

Conventions: compression positive, true tensor shear components, kPa. Everything needs numpy and scipy only.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import brentq

I3 = np.eye(3)
SQ23 = math.sqrt(2.0 / 3.0)
HALF_PI = 0.5 * math.pi


# ---------------------------------------------------------------------------------------------------------------------
# tensors
# ---------------------------------------------------------------------------------------------------------------------
def tensor(c):
    """Six components, order 11, 22, 33, 12, 13, 23 (true tensor shear) -> full 3x3."""
    return np.array([[c[0], c[3], c[4]], [c[3], c[1], c[5]], [c[4], c[5], c[2]]], float)


def six(a):
    """Full 3x3 -> six components, order 11, 22, 33, 12, 13, 23."""
    return np.array([a[0, 0], a[1, 1], a[2, 2], a[0, 1], a[0, 2], a[1, 2]])


def dev(a):
    """Deviator."""
    return a - (a[0, 0] + a[1, 1] + a[2, 2]) / 3.0 * I3


def dd(a, b):
    """Full contraction a:b."""
    return float(np.vdot(a, b))


def norm(a):
    """sqrt(a:a)."""
    return math.sqrt(float(np.vdot(a, a)))


def cos3t_of(n):
    """sqrt(6) tr(n^3) of a unit deviator; the trace of the cube of a traceless tensor is three times its determinant."""
    return 3.0 * math.sqrt(6.0) * float(np.linalg.det(n))


# ---------------------------------------------------------------------------------------------------------------------
# parameters
# ---------------------------------------------------------------------------------------------------------------------
@dataclass(frozen=True)
class Params:
    """Paper Table 2 and Table 3, the guards of docs/theory/material.md section 5, and one switch per effect."""
    # Table 2
    K0: float = 150.0
    G0: float = 125.0
    N_l: float = 25.0
    h0: float = 12.0
    c_h: float = 0.968
    n_d: float = 2.1
    n_b: float = 1.25
    A0: float = 0.4
    c_z: float = 600.0
    z_max: float = 4.0
    lam: float = 0.37
    alpha_csl: float = 3370.0
    N_c: float = 18.7
    M_c: float = 1.25
    c: float = 0.712
    b1: float = 0.5
    b2: float = 0.5
    theta: float = 0.2
    p_atm: float = 101.325
    # Table 3
    n_x: float = 2.0
    m_x: float = 1.0
    P_a: float = 5.0
    Omega: float = 2.0
    S_max: float = 1.0
    S_min: float = 0.0
    # guards, docs/theory/material.md section 5
    floor: bool = True
    x0: float = 3.0e-3
    contraction_cap: bool = True
    softening_cap: bool = True
    kappa_c: float = 0.5
    hysteresis: bool = True
    x_rev: float = 1.0e-3
    p_min_ratio: float = 1.0e-3
    # memory, docs/theory/memory-rules.md section 2
    rule: str = "threshold"  # classic, threshold, repositioning, return_point
    eps_hat: float = 1.0e-4
    j: float = 1.0
    # switches
    isotropic: bool = True
    retention: bool = True
    bonding: bool = True
    fabric: bool = True
    lode: bool = True

    @property
    def p_min(self):
        return self.p_min_ratio * self.p_atm


# ---------------------------------------------------------------------------------------------------------------------
# docs/theory/material.md sections 1 to 3: functions of the state
# ---------------------------------------------------------------------------------------------------------------------
def saturation(e, pc, P):
    """S_w, dS_w/dp_c (constant e), dS_w/de (constant p_c).  Eqs (23), (24); S_max and zero slopes for p_c <= 0.
    Switch retention off: the soil stays at S_max."""
    if pc <= 0.0 or not P.retention:
        return P.S_max, 0.0, 0.0
    u = (pc * e ** P.Omega / P.P_a) ** P.n_x
    a = math.e + u
    la = math.log(a)
    S = P.S_min + (P.S_max - P.S_min) * la ** (-P.m_x)
    dS_du = -(P.S_max - P.S_min) * P.m_x * la ** (-P.m_x - 1.0) / a
    return S, dS_du * P.n_x * u / pc, dS_du * P.n_x * P.Omega * u / e


def bonding(e, pc, P):
    """f(zeta), df/dp_c, df/de with eq (1), g = 1 + t/(10.7 + 2.4 t), and f = 1 - b1 (1 - exp(b2 zeta))."""
    if not P.bonding:
        return 1.0, 0.0, 0.0
    S, S_p, S_e = saturation(e, pc, P)
    t = max(pc, 0.0) / P.p_atm
    g = 1.0 + t / (10.7 + 2.4 * t)
    g_p = 10.7 / (10.7 + 2.4 * t) ** 2 / P.p_atm if pc > 0.0 else 0.0
    zeta = (1.0 - S) * g
    f = 1.0 - P.b1 * (1.0 - math.exp(P.b2 * zeta))
    df = P.b1 * P.b2 * math.exp(P.b2 * zeta)
    return f, df * (-S_p * g + (1.0 - S) * g_p), df * (-S_e * g)


def lode(cos3t, P):
    """g(n) = [2 c^4/(1 + c^4 - (1 - c^4) cos3t)]^(1/4); works on arrays."""
    if not P.lode:
        return np.ones_like(cos3t) if isinstance(cos3t, np.ndarray) else 1.0
    c4 = P.c ** 4
    return (2.0 * c4 / (1.0 + c4 - (1.0 - c4) * cos3t)) ** 0.25


class Point:
    """Everything that depends on the state alone (not on the direction of loading)."""

    def __init__(self, sig, e, pc, z, r_in, P):
        self.P, self.e, self.pc, self.z, self.r_in = P, e, pc, z, r_in
        p_raw = (sig[0, 0] + sig[1, 1] + sig[2, 2]) / 3.0
        self.p = p = max(p_raw, P.p_min)
        self.r = r = (sig - p_raw * I3) / p
        self.K = P.K0 * P.p_atm * (1.0 + e) / e * (p / P.p_atm) ** (2.0 / 3.0)  # (2)
        self.G = P.G0 * P.p_atm * (2.97 - e) ** 2 / (1.0 + e) * (p / P.p_atm) ** 0.5  # (3)
        f, f_p, f_e = bonding(e, pc, P)
        self.f, self.f_p, self.f_e = f, f_p, f_e
        self.psi = e - P.N_c * f * (p + P.alpha_csl) ** (-P.lam)  # (8)
        self.Mb = P.M_c * math.exp(max(-P.n_b * self.psi, 0.0))  # (12)
        self.Md = P.M_c * math.exp(P.n_d * self.psi)  # (10)
        self.b0 = P.h0 * P.G0 * max(1.0 - P.c_h * e, 0.01) * (p / P.p_atm) ** (-0.5)  # (13)
        # isotropic mechanism, docs/theory/material.md section 4.4
        eta2 = 1.5 * dd(r, r)
        self.eta2 = eta2
        self.alpha_hat = (P.N_l * f / e) ** (1.0 / P.lam)  # (7)
        self.ratio = p / self.alpha_hat * (1.0 + 2.0 * eta2 / P.M_c ** 2)
        self.delta = delta = 1.0 - self.ratio  # (6)
        F = 1.0 - math.copysign(abs(delta) ** P.theta, delta)
        kappa = p / self.K * (1.0 + e) / e
        C = -e * f_e / f * F
        nr = norm(r)
        if nr > 0.0:
            gr = lode(cos3t_of(r / nr), P)
            w = max(1.0 - eta2 / (gr * self.Mb) ** 2, 0.0)
        else:
            w = 1.0
        if not P.isotropic:
            w = 0.0
        self.F, self.C, self.w = F, C, w
        self.A = w * e / (1.0 + e) * ((P.lam - kappa) * F - kappa * C) / (1.0 + C)
        self.B1 = -w * e / (1.0 + e) * F * f_p / (f * (1.0 + C))  # times dp_c


# ---------------------------------------------------------------------------------------------------------------------
# docs/theory/material.md section 4.6: the direction
# ---------------------------------------------------------------------------------------------------------------------
class _Plane:
    """gamma(w), beta(w), D, hb on n(w) = cos(w) t/|t| + sin(w) q.  Scalars or arrays of angles."""

    def __init__(self, pt, t, Ke):
        self.pt, self.Ke = pt, Ke
        P = pt.P
        self.tn = norm(t)
        self.T = T = t / self.tn
        r = pt.r
        self.rt = dd(r, T)
        rp = r - self.rt * T
        rp = rp - dd(rp, T) * T
        self.rq = norm(rp)
        if self.rq <= 1.0e-13 * max(norm(r), 1.0e-3):
            self.rq, self.Q = 0.0, None
            Q = np.zeros((3, 3))
        else:
            self.Q = Q = rp / self.rq
        rho = r - pt.r_in
        self.x_t, self.x_q = dd(rho, T), dd(rho, Q)
        self.z_t, self.z_q = dd(pt.z, T), dd(pt.z, Q)
        self.Qm = Q

    def at(self, w):
        pt, P, T, Q = self.pt, self.pt.P, self.T, self.Qm
        arr = isinstance(w, np.ndarray)
        m = np if arr else math
        mx = np.maximum if arr else max
        c, s = m.cos(w), m.sin(w)
        n11, n22, n33 = c * T[0, 0] + s * Q[0, 0], c * T[1, 1] + s * Q[1, 1], c * T[2, 2] + s * Q[2, 2]
        n12, n13, n23 = c * T[0, 1] + s * Q[0, 1], c * T[0, 2] + s * Q[0, 2], c * T[1, 2] + s * Q[1, 2]
        det = n11 * (n22 * n33 - n23 * n23) - n12 * (n12 * n33 - n23 * n13) + n13 * (n12 * n23 - n22 * n13)
        g = lode(3.0 * math.sqrt(6.0) * det, P)
        rn = c * self.rt + s * self.rq
        x = c * self.x_t + s * self.x_q
        zn = c * self.z_t + s * self.z_q
        Rb = SQ23 * g * pt.Mb
        Ad = P.A0 * (1.0 + mx(zn, 0.0)) if P.fabric else P.A0
        D = Ad * (SQ23 * g * pt.Md - rn)
        Ke, G = self.Ke, pt.G
        fl = {}
        if arr:
            if P.contraction_cap:
                pos = rn > 0.0
                D = np.where(pos, np.minimum(D, 0.95 * 2.0 * G / (Ke * np.where(pos, rn, 1.0))), D)
            hb = (np.maximum(x, P.x0) if P.floor else x) / pt.b0
            if P.softening_cap:
                E = 2.0 * G - Ke * D * rn
                on = (rn > Rb) & (E > 0.0)
                lim = (2.0 / 3.0) * pt.p * (rn - Rb) / ((1.0 - P.kappa_c) * np.where(on, E, 1.0))
                hb = np.where(on, np.maximum(hb, lim), hb)
        else:
            if P.contraction_cap and rn > 0.0:
                lim = 0.95 * 2.0 * G / (Ke * rn)
                fl["ccap"] = D > lim
                D = min(D, lim)
            fl["floor"] = P.floor and x < P.x0
            hb = (max(x, P.x0) if P.floor else x) / pt.b0
            E = 2.0 * G - Ke * D * rn
            if P.softening_cap and rn > Rb and E > 0.0:
                lim = (2.0 / 3.0) * pt.p * (rn - Rb) / ((1.0 - P.kappa_c) * E)
                fl["scap"] = lim > hb
                hb = max(hb, lim)
        beta = (2.0 / 3.0) * pt.p + hb * Ke * D
        gamma = (2.0 / 3.0) * pt.p * Rb + 2.0 * G * hb
        return c, s, gamma, beta, D, hb, x, fl

    def fun(self, w):
        """gamma sin w - beta (r:q)."""
        c, s, gamma, beta, *_ = self.at(w)
        return gamma * s - beta * self.rq

    def normal(self, w):
        return math.cos(w) * self.T + math.sin(w) * self.Qm


_GRIDS = {}


def _grid(n):
    if n not in _GRIDS:
        _GRIDS[n] = np.linspace(-HALF_PI, HALF_PI, n)
    return _GRIDS[n]


def roots_of(pl, nscan, refine=False):
    """All admissible angles (|w| < pi/2, y > 0), sorted by |w|."""
    if pl.Q is None:
        cand = [0.0]
    else:
        W = _grid(nscan)
        Fv = pl.fun(W)
        sgn = np.sign(Fv)
        cand = [float(w) for w in W[1:-1][sgn[1:-1] == 0.0]]
        idx = np.nonzero(sgn[:-1] * sgn[1:] < 0.0)[0]
        br = [(float(W[i]), float(W[i + 1])) for i in idx]
        if refine:  # close pairs inside one cell: look at the local minima of |F|
            a = np.abs(Fv)
            loc = np.nonzero((a[1:-1] < a[:-2]) & (a[1:-1] < a[2:]) & (sgn[:-2] == sgn[2:]) & (sgn[1:-1] == sgn[2:]))[0] + 1
            for i in loc:
                ww = np.linspace(W[i - 1], W[i + 1], 401)
                sg = np.sign(pl.fun(ww))
                for k in np.nonzero(sg[:-1] * sg[1:] < 0.0)[0]:
                    br.append((float(ww[k]), float(ww[k + 1])))
        for a, b in br:
            cand.append(brentq(pl.fun, a, b, xtol=1e-16, rtol=8.9e-16, maxiter=200))
    out = []
    for w in cand:
        c, s, gamma, beta, *_ = pl.at(w)
        if gamma * c - beta * pl.rt > 0.0:
            out.append(w)
    return sorted(out, key=abs)


@dataclass
class Rate:
    """The answer of one evaluation."""
    dsig: np.ndarray
    dz: np.ndarray
    deqp: float
    L: float
    n: np.ndarray | None
    x: float  # (r - r_in):n, before the floor
    iso: int  # 0 off, 1 on, 2 second solution rejected
    roots: int
    w: float
    flags: dict = field(default_factory=dict)
    all_roots: tuple = ()


def _mechanism(pt, deps, dpc, Ke, B, nscan, refine):
    dv = deps[0, 0] + deps[1, 1] + deps[2, 2]
    de = deps - dv / 3.0 * I3
    G = pt.G
    t = 2.0 * G * de - pt.r * (Ke * (dv - B))
    scale = 2.0 * G * norm(de) + Ke * norm(pt.r) * abs(dv - B)
    n, L, D, x, w, rts, fl = None, 0.0, 0.0, 0.0, 0.0, (), {}
    if norm(t) > 1.0e-14 * scale and scale > 0.0:
        pl = _Plane(pt, t, Ke)
        rts = tuple(roots_of(pl, nscan, refine))
        if rts:
            w = rts[0]
            c, s, gamma, beta, D, hb, x, fl = pl.at(w)
            n = pl.normal(w)
            y = (gamma * c - beta * pl.rt) / pl.tn
            L = hb / y
        else:
            fl = {"noroot": True}
    dp = Ke * (dv - L * D - B)
    ds = 2.0 * G * (de - L * n) if n is not None else 2.0 * G * de
    return dp, ds, n, L, D, x, w, rts, fl


def rates(sig, e, pc, z, r_in, deps, dpc, P, nscan=121, refine=False):
    """docs/theory/material.md section 4.  sig, z, r_in, deps are full 3x3."""
    pt = Point(sig, e, pc, z, r_in, P)
    A, B = pt.A, pt.B1 * dpc
    dp, ds, n, L, D, x, w, rts, fl = _mechanism(pt, deps, dpc, pt.K, 0.0, nscan, refine)
    iso = 0
    if A * dp / pt.p + B > 0.0:
        Ke = pt.K / (1.0 + pt.K * A / pt.p)
        second = _mechanism(pt, deps, dpc, Ke, B, nscan, refine)
        if A * second[0] / pt.p + B < 0.0:
            iso = 2
        else:
            iso = 1
            dp, ds, n, L, D, x, w, rts, fl = second
    dsig = ds + dp * I3
    if n is not None and P.fabric:
        dz = -P.c_z * max(-L * D, 0.0) * (P.z_max * n + z)
    else:
        dz = np.zeros((3, 3))
    return Rate(dsig, dz, SQ23 * L, L, n, x, iso, len(rts), w, fl, rts)
