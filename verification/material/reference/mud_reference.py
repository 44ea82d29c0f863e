# SPDX-License-Identifier: MIT
"""Independent reference implementation of the soil model MUD: memory and integration along a path.

Written from the equations of docs/theory and the paper alone, without sight of the library: void ratio in closed form
along a segment, and the rates of reference_rates.py integrated by Dormand-Prince 8(5,3) (scipy) with located events for
every reset of the memory.

A "segment" is a straight piece of strain and suction path, s in [0, 1].
"""
from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import DOP853, LSODA, Radau
from scipy.optimize import brentq

from reference_rates import I3, SQ23, Params, Point, cos3t_of, dd, dev, lode, norm, rates


# ---------------------------------------------------------------------------------------------------------------------
# docs/theory/memory-rules.md: memory; state and integration
# ---------------------------------------------------------------------------------------------------------------------
@dataclass(frozen=True)
class Interrupted:
    """A loading process that waits for the path to come back (rule return_point): its memory, direction and turning point."""
    r_in: np.ndarray
    n: np.ndarray
    T: float

    def to_go(self, r, Mb, P):
        """How far r still is from the turning point along n; the bounding surface of now stands in for what lies beyond it."""
        surface = SQ23 * lode(cos3t_of(self.n), P) * Mb / 1.001
        return min(self.T, surface) - dd(r, self.n)


MOST_INTERRUPTED = 4


@dataclass
class State:
    """State at the point.  r_in_before starts as the stress point's own r, J and eqp as zero: docs/theory/material.md section 1.4."""
    sig: np.ndarray
    e: float
    pc: float = 0.0
    z: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))
    r_in: np.ndarray | None = None
    r_in_before: np.ndarray | None = None
    eqp: float = 0.0
    J: float = 0.0
    J_run: float = 0.0
    n_t: np.ndarray | None = None  # rule return_point: direction of the present process, and how far it came along it
    T: float = 0.0
    stack: list = field(default_factory=list)  # rule return_point: interrupted processes, the newest last
    resets: int = 0
    nrate: int = 0
    nsteps: int = 0
    log: list = field(default_factory=list)

    def __post_init__(self):
        if self.r_in is None:
            self.r_in = stress_ratio(self.sig, Params())
        if self.r_in_before is None:
            self.r_in_before = self.r_in.copy()

    @property
    def p(self):
        return float(np.trace(self.sig)) / 3.0

    @property
    def q(self):
        """sigma_11 - sigma_22, the triaxial q with axis 1."""
        return float(self.sig[0, 0] - self.sig[1, 1])


def stress_ratio(sig, P):
    p = float(np.trace(sig)) / 3.0
    return (sig - p * I3) / max(p, P.p_min)


def isotropic(p, e, pc=0.0):
    """An isotropic start."""
    return State(p * I3, e, pc)


def reset(st, rt, P, where):
    """The memory jump, docs/theory/memory-rules.md section 2.  rt is the rate that triggered it (its n is the new direction)."""
    r = stress_ratio(st.sig, P)
    old = st.r_in
    if P.rule == "classic":
        new = r
        st.eqp = 0.0
    elif P.rule in ("threshold", "repositioning"):
        m = max(1.0 - (st.eqp / P.eps_hat) ** P.j, 0.0)
        new = r + m * (st.r_in_before - r) if P.rule == "threshold" else r - m * st.J * rt.n
        if dd(r - new, rt.n) < 0.0:
            new = r
        st.eqp = 0.0
    elif P.rule == "return_point":
        new = r
        if st.n_t is not None and dd(elastic_trial(st.sig, st.e, where[1], P), st.n_t) <= 0.0:
            if len(st.stack) == MOST_INTERRUPTED:
                del st.stack[-2:]
            st.stack.append(Interrupted(old.copy(), st.n_t, st.T))
        st.eqp = 0.0
    else:
        raise ValueError(P.rule)
    st.r_in_before = old
    st.r_in = new
    st.J = st.J_run
    st.J_run = 0.0
    st.resets += 1
    st.log.append(("reset", where[0]))


def elastic_trial(sig, e, deps, P):
    """Elastic trial rate of the stress ratio, (2G d e_dev - r K d eps_v)/p'."""
    z = np.zeros((3, 3))
    pt = Point(sig, e, 0.0, z, z, P)
    return (2.0 * pt.G * dev(deps) - pt.r * (pt.K * np.trace(deps))) / pt.p


def progress(st, r, n, P):
    """How clearly the step that leads to r in the direction n belongs to its process; from 0 on it qualifies.  And the chord."""
    c = r - st.r_in + P.x0 * n
    return min(dd(r - st.r_in, n), dd(c, n) - 0.7 * norm(c)), c


def note(st, r, n, P):
    """Rule return_point: direction of the present process and its farthest point, where a plastic step qualifies.  That the
    path goes forwards (t:n > 0) needs no test here: without an elastic domain |w| < pi/2."""
    how, c = progress(st, r, n, P)
    if how >= 0.0:
        st.n_t = c / norm(c)
        st.T = dd(r, st.n_t)


def watched(st, t):
    """Index of the interrupted process the path may come back to, or None: the newest, or else the one before."""
    for k in (len(st.stack) - 1, len(st.stack) - 2):
        if k >= 0 and dd(t, st.stack[k].n) > 0.0:
            return k
    return None


def come_back(st, deps, P, s, landed=False):
    """Rule return_point: lets every process go on whose turning point is reached.  landed: an event found it so."""
    while True:
        t = elastic_trial(st.sig, st.e, deps, P)
        k = watched(st, t)
        if k is None:
            return
        r = stress_ratio(st.sig, P)
        Mb = Point(st.sig, st.e, st.pc, st.z, st.r_in, P).Mb
        if not landed and st.stack[k].to_go(r, Mb, P) > 0.0:
            return
        landed = False
        back = st.stack[k]
        st.r_in = max((back.r_in, st.r_in), key=lambda a: dd(r - a, t))
        st.n_t, st.T = back.n, back.T
        st.eqp = 0.0
        del st.stack[k:]
        st.log.append(("return", s))


class _Segment:
    """One straight segment on its way: smooth pieces, each from one event to the next."""

    def __init__(self, st, deps, dpc, P, nscan):
        self.st, self.deps, self.dpc, self.P, self.nscan = st, deps, dpc, P, nscan
        self.e0, self.pc0, self.dv = st.e, st.pc, float(np.trace(deps))
        self.x_rev = P.x_rev if P.hysteresis else 0.0
        self.remembers = P.rule == "return_point"
        self.may_reset = True   # not directly after a reset
        self.landed = False     # an event found that an interrupted process is reached

    def e_of(self, s):
        return (1.0 + self.e0) * math.exp(-self.dv * s) - 1.0

    def pc_of(self, s):
        return self.pc0 + self.dpc * s

    @staticmethod
    def unpack(y):
        return y[:9].reshape(3, 3), y[9:18].reshape(3, 3), y[18]

    def rate_at(self, s, y):
        self.st.nrate += 1
        sig, z, _ = self.unpack(y)
        return rates(sig, self.e_of(s), self.pc_of(s), z, self.st.r_in, self.deps, self.dpc, self.P, nscan=self.nscan)

    def rhs(self, s, y):
        q = self.rate_at(s, y)
        return np.concatenate([q.dsig.ravel(), q.dz.ravel(), [q.deqp]])

    def store(self, s, y):
        st = self.st
        sig, z, _ = self.unpack(y)
        st.sig, st.z, st.eqp, st.e, st.pc = sig.copy(), z.copy(), float(y[18]), self.e_of(s), self.pc_of(s)

    def memory_resets(self, s, y, max_resets):
        """Memory at the start of a smooth piece. Whether it was reset, so that the piece begins anew."""
        st = self.st
        if self.remembers:
            come_back(st, self.deps, self.P, s, self.landed)
            self.landed = False
            y[18] = st.eqp
        rt = self.rate_at(s, y)
        behind = rt.n is not None and rt.x < -self.x_rev
        if behind and self.may_reset:
            reset(st, rt, self.P, (s, self.deps))
            if st.resets > max_resets:
                raise RuntimeError("too many resets of the memory")
            y[18] = st.eqp
            self.may_reset = False
            return True
        if behind:
            st.log.append(("still behind", s))  # the new rates would ask for another reset: not in this substep
        self.may_reset = True
        t = elastic_trial(st.sig, st.e, self.deps, self.P)
        self.k_watched = watched(st, t) if self.remembers else None
        self.sides = [math.copysign(1.0, dd(t, i.n)) for i in st.stack[-2:]]
        return False

    def events(self, s, y):
        """Values that are positive inside the smooth piece."""
        st, P = self.st, self.P
        sg, zz, eqp = self.unpack(y)
        q = self.rate_at(s, y)
        ev = {"reset": (q.x + self.x_rev) if q.n is not None else 1.0, "_x": q.x, "_n": q.n}
        if self.remembers:
            rr = stress_ratio(sg, P)
            if q.n is not None:
                ev["leaves its process"] = progress(st, rr, q.n, P)[0]
            tt = elastic_trial(sg, self.e_of(s), self.deps, P)
            for name, side, i in zip(("side of a", "side of b"), self.sides, st.stack[-2:]):
                ev[name] = side * dd(tt, i.n)
            if self.k_watched is not None:
                pt = Point(sg, self.e_of(s), self.pc_of(s), zz, st.r_in, P)
                ev["return"] = st.stack[self.k_watched].to_go(rr, pt.Mb, P)
        return ev

    def crossings(self, solver, before, after):
        """(place, event) of every value that became negative in the solver's last step."""
        hits, dense = [], None
        for k, v in after.items():
            if k.startswith("_") or v is None or not (v < 0.0 and before.get(k, 1.0) >= 0.0):
                continue
            dense = dense or solver.dense_output()
            ta, tb = solver.t_old, solver.t

            def value(tt, k=k):
                return self.events(tt, dense(tt))[k]
            hits.append((ta if value(ta) <= 0.0 else brentq(value, ta, tb, xtol=1e-15, rtol=8.9e-16), k))
        return hits, dense

    def smooth_piece(self, s, y, rtol, method, max_step, hook):
        """Place, state and event at its end; no event at the end of the segment."""
        st, P = self.st, self.P
        scale = max(float(np.max(np.abs(st.sig))), P.p_min)
        atol = np.concatenate([np.full(9, rtol * 0.1 * scale), np.full(9, rtol * 0.1), [rtol * 1e-3]])
        kw = {"first_step": min(1e-4, 1.0 - s)} if method == "DOP853" else {}
        solver = {"DOP853": DOP853, "LSODA": LSODA, "Radau": Radau}[method](
            self.rhs, s, y.copy(), 1.0, rtol=rtol, atol=atol, max_step=max_step, **kw)
        before = self.events(s, y)
        while solver.status == "running":
            msg = solver.step()
            if solver.status == "failed":
                raise RuntimeError(f"integrator failed at s={solver.t}: {msg}")
            st.nsteps += 1
            after = self.events(solver.t, solver.y)
            hits, dense = self.crossings(solver, before, after)
            if after.get("_n") is not None:
                if after["_x"] >= 0.0:
                    st.J_run = after["_x"]
                if self.remembers and not hits:
                    note(st, stress_ratio(self.unpack(solver.y)[0], P), after["_n"], P)
            if hits:
                at, event = min(hits)
                return at, np.array(dense(at)), event
            before = after
            if hook is not None:
                hook(solver.t, solver.y)
        return 1.0, solver.y.copy(), None

    def after_event(self, s, y, event):
        """Place and state from which the next smooth piece begins."""
        st, P = self.st, self.P
        self.store(s, y)
        if event == "reset":
            q = self.rate_at(s, y)
            st.J_run = 0.0  # its last value at x >= 0 was zero
            reset(st, q, P, (s, self.deps))
            y[18] = st.eqp
            self.may_reset = False
        elif event == "return":
            self.landed = True
        else:
            st.log.append((event, s))
            if event == "leaves its process":  # the last point that qualifies
                q = self.rate_at(s, y)
                c = progress(st, stress_ratio(st.sig, P), q.n, P)[1]
                st.n_t = c / norm(c)
                st.T = dd(stress_ratio(st.sig, P), st.n_t)
            # the switch sits on its own zero: step over it
            h = 1e-13
            y = y + h * self.rhs(s, y)
            s = s + h
        return s, y


def segment(st, deps, dpc, P, rtol=1e-10, method="DOP853", nscan=121, hook=None, max_resets=100000, max_step=np.inf):
    """Integrate one straight segment (deps 3x3, dpc) in place.  Every reset of the memory is located as the root of
    (r-r_in):n + x_rev on the dense output and the integration restarted there; so are the events of return_point."""
    way = _Segment(st, deps, dpc, P, nscan)
    s, y = 0.0, np.concatenate([st.sig.ravel(), st.z.ravel(), [st.eqp]])
    while s < 1.0:
        way.store(s, y)
        if way.memory_resets(s, y, max_resets):
            continue
        s, y, event = way.smooth_piece(s, y, rtol, method, max_step, hook)
        if event is None:
            break
        s, y = way.after_event(s, y, event)
    way.store(1.0, y)
    # running values at the end of the segment
    q = way.rate_at(1.0, y)
    if q.n is not None:
        if q.x >= 0.0:
            st.J_run = q.x
        if way.remembers:
            note(st, stress_ratio(st.sig, P), q.n, P)
    return st


# ---------------------------------------------------------------------------------------------------------------------
# triaxial helpers
# ---------------------------------------------------------------------------------------------------------------------
def undrained(d_eps_a):
    """Isochoric triaxial strain increment, axis 1."""
    return np.diag([d_eps_a, -0.5 * d_eps_a, -0.5 * d_eps_a])


def oedometric(d_eps_a):
    return np.diag([d_eps_a, 0.0, 0.0])
