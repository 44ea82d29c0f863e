# SPDX-License-Identifier: MIT
"""The balances of momentum and of water at the points, as docs/theory/host.md sections 2 to 4 have them, with air at
rest: what every point adds to the residual, thirteen numbers, and their derivatives."""
import dataclasses

import numpy as np

from .laws import M, permeability
from .space import GRADIENT, MOTION, NUMBERS, PRESSURE, STRAIN

STATIC, QUASI_STATIC, DYNAMIC = "static", "quasi_static", "dynamic"


@dataclasses.dataclass
class Scheme:
    """Generalised-alpha for one step: docs/theory/host.md section 4."""
    kind: str
    rho_inf: float
    dt: float
    begins: bool = False   # The rates before say nothing of those to come: section 4.2.

    def __post_init__(self):
        rho = self.rho_inf
        self.gamma, self.beta = (3.0 - rho)/(2.0*(1.0 + rho)), 1.0/(1.0 + rho)**2
        self.l_f, self.l_a = 1.0/(1.0 + rho), (2.0 - rho)/(1.0 + rho)
        self.l_p, self.gamma_1 = (3.0 - rho)/(2.0*(1.0 + rho)), 1.0/(1.0 + rho)
        if self.kind == QUASI_STATIC and self.begins:
            self.l_p = self.gamma_1 = 1.0
        if self.kind == STATIC:
            self.l_f = 1.0
        self.l_v = self.l_f if self.kind == DYNAMIC else self.l_p

    def first_order(self, x0, v0, x1):
        if self.kind == STATIC:
            return np.zeros_like(x1)
        return (x1 - x0)/(self.gamma_1*self.dt) - (1.0 - self.gamma_1)/self.gamma_1*v0

    def rates(self, space, x0, v0, a0, x1):
        """Rates and accelerations at the end of the step."""
        v1, a1 = self.first_order(x0, v0, x1), np.zeros_like(x1)
        if self.kind == DYNAMIC:
            u, b, dt = space.is_u, self.beta, self.dt
            a1[u] = (x1 - x0)[u]/(b*dt**2) - v0[u]/(b*dt) - (0.5/b - 1.0)*a0[u]
            v1[u] = v0[u] + dt*((1.0 - self.gamma)*a0[u] + self.gamma*a1[u])
        return v1, a1

    @property
    def rate_slope(self):
        """d p-rate(1)/d p(1), of S_w too."""
        return 0.0 if self.kind == STATIC else 1.0/(self.gamma_1*self.dt)

    @property
    def velocity_slope(self):
        return self.gamma/(self.beta*self.dt) if self.kind == DYNAMIC else self.rate_slope

    @property
    def acceleration_slope(self):
        return 1.0/(self.beta*self.dt**2) if self.kind == DYNAMIC else 0.0


def between(x0, x1, level):
    return x0 + level*(x1 - x0)


class Ground:
    """Constants of every point: fluids, and what its region gives."""

    def __init__(self, scene, region):
        fluids = scene.fluids
        self.k_w, self.rho_w, self.eta_w, self.rho_a = fluids.k_w, fluids.rho_w, fluids.eta_w, fluids.rho_a
        self.saturated, self.wet = not scene.air_at_rest, scene.has_water
        self.rho_s, self.damping, self.lag = (np.array([r[key] for r in scene.regions])[region] for key in
                                              ("rho_s", "damping", "stiffness_damping"))
        self.laws = [scene.one("permeabilitys", r.permeability) if self.wet else None for r in scene.regions]
        self.region = region
        self.intrinsic = np.array([law.intrinsic if law else 0.0 for law in self.laws])[region]

    def conductivity(self, s):
        """k k_rw/eta and its slope against S_w."""
        k, slope = np.ones_like(s), np.zeros_like(s)
        for number, law in enumerate(self.laws):
            i = self.region == number
            k[i], slope[i] = permeability(law, s[i])
        scale = self.intrinsic/self.eta_w
        return scale*k, scale*slope

    def suction(self, p):
        """Suction of the pore water and its slope against p_w."""
        if self.saturated or not self.wet:
            return np.zeros_like(p), np.zeros_like(p)
        return np.maximum(-p, 0.0), np.where(p < 0.0, -1.0, 0.0)

    def density(self, n, s):
        if not self.wet:
            return (1.0 - n)*self.rho_s
        return (1.0 - n)*self.rho_s + n*s*self.rho_w + n*(1.0 - s)*self.rho_a


def start_numbers(points, ground, begin, weight):
    """Total stress and weight at the start of a step, as s: what its changes are measured from."""
    s = np.zeros((points.n, NUMBERS))
    n = points.e0/(1.0 + points.e0)
    suction, _ = ground.suction(begin[:, PRESSURE])
    s[:, STRAIN] = points.stress0
    if ground.wet:
        s[:, STRAIN] -= (begin[:, PRESSURE] + (1.0 - points.s0)*suction)[:, None]*M
    s[:, MOTION] = -ground.density(n, points.s0)[:, None]*weight
    return s


def evaluate(points, ground, scheme, begin, end, velocity, acceleration, p_rate, weight, slopes=True):
    """Residual s (n, 13) and its derivative J (n, 13, 13) against the numbers of the nodes at the end of the step.

    begin, end: numbers of the nodes at both ends; velocity, acceleration, p_rate: numbers of nodal rates at their
    levels; weight: acceleration of gravity at l_f.
    """
    l, dt = scheme.l_f, scheme.dt
    n0, n1 = points.e0/(1.0 + points.e0), points.e1/(1.0 + points.e1)
    n, dn = between(n0, n1, l), l*(1.0 - n1)
    s = between(points.s0, points.s1, l)
    p0, p1 = begin[:, PRESSURE], end[:, PRESSURE]
    p = between(p0, p1, l)
    (c0, _), (c1, turn) = ground.suction(p0), ground.suction(p1)
    c = between(c0, c1, l)
    s_e, s_p = l*points.ds_de, l*points.ds_dpc*turn
    lag = ground.lag/dt if scheme.kind == DYNAMIC else 0.0*ground.lag
    out = np.zeros((points.n, NUMBERS))
    rise = points.stress1 - points.stress0
    out[:, STRAIN] = points.stress0 + (l + lag)[:, None]*rise
    if ground.wet:
        out[:, STRAIN] -= (p + (1.0 - s)*c)[:, None]*M
    rho = ground.density(n, s)
    push = -weight[None, :]*np.ones((points.n, 1))
    if scheme.kind == DYNAMIC:
        push = push + acceleration[:, MOTION] + ground.damping[:, None]*velocity[:, MOTION]
    out[:, MOTION] = rho[:, None]*push
    flows = ground.wet and scheme.kind != STATIC
    if flows:
        rate = scheme.first_order(points.s0, points.rate0, points.s1)
        s_rate = between(points.rate0, rate, scheme.l_p)
        swell = velocity[:, STRAIN] @ M
        out[:, PRESSURE] = n*s/ground.k_w*p_rate[:, PRESSURE] + n*s_rate + s*swell
        k, dk = ground.conductivity(s)
        head = between(begin[:, GRADIENT], end[:, GRADIENT], l) - ground.rho_w*weight
        out[:, GRADIENT] = k[:, None]*head
    if not slopes:
        return out, None
    J = np.zeros((points.n, NUMBERS, NUMBERS))
    J[:, STRAIN, STRAIN] = (l + lag)[:, None, None]*points.tangent
    dirac = np.arange(6, 9)
    d_rho_n = (-ground.rho_s + s*ground.rho_w + (1.0 - s)*ground.rho_a) if ground.wet else -ground.rho_s
    d_rho_s = n*(ground.rho_w - ground.rho_a) if ground.wet else 0.0*n
    J[:, MOTION, STRAIN] = (d_rho_n*dn + d_rho_s*s_e)[:, None, None]*push[:, :, None]*M
    if scheme.kind == DYNAMIC:
        J[:, dirac, dirac] = (rho*(scheme.l_a*scheme.acceleration_slope
                                   + ground.damping*scheme.l_v*scheme.velocity_slope))[:, None]
    if ground.wet:
        J[:, STRAIN, STRAIN] += (s_e*c)[:, None, None]*np.outer(M, M)
        J[:, STRAIN, PRESSURE] = (l + lag)[:, None]*points.dsig_dpc*turn[:, None] \
            - (l + (1.0 - s)*l*turn - s_p*c)[:, None]*M
        J[:, MOTION, PRESSURE] = (d_rho_s*s_p)[:, None]*push
    if flows:
        storage = p_rate[:, PRESSURE]/ground.k_w
        J[:, PRESSURE, STRAIN] = (s*scheme.l_v*scheme.velocity_slope + dn*(s*storage + s_rate)
                                  + s_e*(n*storage + swell)
                                  + n*scheme.l_p*scheme.rate_slope*points.ds_de)[:, None]*M
        J[:, PRESSURE, PRESSURE] = n*s/ground.k_w*scheme.l_p*scheme.rate_slope + s_p*(n*storage + swell) \
            + n*scheme.l_p*scheme.rate_slope*points.ds_dpc*turn
        J[:, GRADIENT, STRAIN] = (dk*s_e)[:, None, None]*head[:, :, None]*M
        J[:, GRADIENT, PRESSURE] = (dk*s_p)[:, None]*head
        grad = np.arange(10, 13)
        J[:, grad, grad] = l*k[:, None]
    return out, J


def mass(points, ground):
    """J of the mass alone."""
    J = np.zeros((points.n, NUMBERS, NUMBERS))
    at = np.arange(6, 9)
    J[:, at, at] = ground.density(points.e0/(1.0 + points.e0), points.s0)[:, None]
    return J
