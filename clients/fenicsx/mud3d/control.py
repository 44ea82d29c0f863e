# SPDX-License-Identifier: MIT
"""Steps: given ones with cuts and growth, or by their error, docs/theory/host.md sections 4.4 and 4.5.

Of the control of mud_host it has the errors of a step, the allowance and the controller; of the allowance of motions
the share of the time that is left. All ranks see the same norms and decide alike.
"""
import numpy as np

from .balances import DYNAMIC, STATIC

REJECTED, SAFETY, DEADBAND, LEAST, MOST, REJECTIONS = 1.2, 0.9, 1.2, 0.2, 2.0, 3
SHARE = 0.015  # of the accuracy that a step may always take


class Controller:
    def __init__(self, run, stage):
        self.run, self.stage, self.controlled = run, stage, run.controlled
        self.end = run.begun + stage.duration
        self.accuracy = run.scene.scene.step_tolerance or 1e-2
        turns = run.scene.breaks()
        self.breaks = turns[(turns > run.begun) & (turns < self.end)]
        span = (self.breaks[0] if len(self.breaks) else self.end) - run.begun
        if not self.controlled:
            self.dt = stage.dt
        elif stage.dt is not None:
            self.dt = stage.dt
        elif stage.analysis == DYNAMIC:
            self.dt = 0.04*np.sqrt(self.accuracy)*span
        elif stage.analysis == STATIC:
            self.dt = min(self.accuracy, 0.05)*span
        else:
            self.dt = self.accuracy**2*span
        self.nominal, self.factor, self.good = self.dt, 1.0, 0
        self.known, self.fresh, self.sudden = False, 0, run.begun
        self.last_ratio, self.rejections, self.held, self.spent = 1.0, 0, False, 0.0
        self.change = {}
        self.start = run.x.copy()
        self.estimate = 0.0

    def next(self, time, end):
        if not self.controlled:
            dt = self.nominal*self.factor
            left = end - time
            return left if dt > left*(1.0 - 1e-9) else dt
        dt = min(self.dt, self.stage.dt_max or np.inf)
        later = self.breaks[self.breaks > time + 1e-12*self.stage.duration]
        left = (later[0] if len(later) else end) - time
        return left if dt > left*(1.0 - 1e-9) else 0.5*left if 2.0*dt > left else dt

    def cut(self, dt):
        self.good = 0
        if self.controlled:
            self.dt = 0.5*dt
        else:
            self.factor *= 0.5

    def move_rates(self, scheme):
        """Rates of the start where a step of another length expects them."""
        run = self.run
        if not self.controlled:
            return
        if not hasattr(self, "base_v") or self.base_v is None:
            self.base_v, self.base_s = run.v.copy(), run.points.rate0.copy()
        if scheme.kind == STATIC or not self.known:
            return
        share = (scheme.l_f - scheme.l_p)*(min(scheme.dt, 2.0*self.dt_before) - self.dt_before)/self.dt_before
        moved = self.base_v + share*(self.base_v - self.v_before)
        which = ~run.space.is_u if scheme.kind == DYNAMIC else slice(None)
        run.v[which] = moved[which]
        run.points.rate0 = self.base_s + share*(self.base_s - self.s_before)

    def error(self, scheme, x1, v1, a1):
        """Error of every unknown in this step, and of which fields (u, p) it is known."""
        run, dt = self.run, scheme.dt
        u, error = run.space.is_u, np.zeros_like(x1)
        known = [self.known, self.known]
        if scheme.kind == STATIC:
            if self.known:
                rate = (x1 - run.x)/dt
                bend = (rate - self.v_before)/(0.5*(dt + self.dt_before))
                size = max(run.space.norm(rate), run.space.norm(self.v_before), 1e-300)
                error = min(1.0, dt*run.space.norm(bend)/size)*dt**2/12.0*bend
            return error, known
        if self.known:
            off = scheme.l_f - scheme.l_p
            last = self.base_v if self.base_v is not None else run.v
            third = ((v1 - run.v)/dt - (last - self.v_before)/self.dt_before) \
                / (0.5*(dt + self.dt_before) + off*(min(dt, 2.0*self.dt_before) - self.dt_before))
            error = (1.0/12.0 + (scheme.l_p - scheme.l_f)**2)*dt**3*third
        if scheme.kind == DYNAMIC:
            error[u] = (1.0/12.0 + 0.375*(scheme.l_a - scheme.l_f)**2)*dt**2*(a1 - run.a)[u]
            known[0] = True
        return error, known

    def stands(self, scheme, x1, v1, a1):
        """Whether a step stands; chooses the next one. Alike on all ranks."""
        if not self.controlled:
            return True
        run, dt = self.run, scheme.dt
        error, known = self.error(scheme, x1, v1, a1)
        ratio, self.own = -1.0, 0.0
        if self.fresh < 3 and scheme.kind != DYNAMIC:
            known = [False, False]
        for which, is_known, key in ((run.space.is_u, known[0], "u"), (~run.space.is_u, known[1], "p")):
            if not is_known:
                continue
            count = max(1, run.comm.allreduce(int(which[:run.space.owned].sum())))
            change = max(self.change.get(key, 0.0), run.space.norm(x1 - self.start, which)/np.sqrt(count),
                         1e-9*run.space.norm(x1, which)/np.sqrt(count))
            self.change[key] = change
            if change == 0.0:
                continue
            share = run.space.norm(error, which)/np.sqrt(count)/change
            time = run.time + dt - self.sudden
            if key == "u" and scheme.kind == DYNAMIC:
                left = max(self.end - run.time, dt)
                allowed = max((self.accuracy - self.spent)*dt/left, SHARE*self.accuracy)
                self.own = share
            elif scheme.kind == DYNAMIC:
                allowed = 0.3*self.accuracy
            else:
                allowed = self.accuracy*max(dt/time, SHARE)
            ratio = max(ratio, share/allowed)
        return self._judge(dt, ratio)

    def _judge(self, dt, ratio):
        if ratio > REJECTED and self.rejections < REJECTIONS:
            self.rejections += 1
            self.dt, self.held = dt*max(LEAST, min(SAFETY, SAFETY*ratio**-0.5)), True
            return False
        self.rejections = 0
        if ratio < 0.0:
            self.last_ratio, self.held = 1.0, False
            return True
        r = max(ratio, 1e-10)
        factor = max(LEAST, min(MOST, SAFETY*r**-0.35*(self.last_ratio/r)**0.2))
        self.last_ratio = r
        if factor > 1.0:
            if factor < DEADBAND or self.held:
                factor = 1.0
            self.dt = max(self.dt, dt*factor)
        elif ratio > 1.0 and not self.held:
            self.dt = min(self.dt, dt*factor)
        self.held = False
        return True

    def accept(self, scheme, x1, v1, a1):
        run = self.run
        if not self.controlled:
            self.good, self.fresh = self.good + 1, self.fresh + 1
            if self.factor < 1.0 and self.good >= 2:
                self.factor, self.good = min(1.0, 2.0*self.factor), 0
            elif self.factor == 1.0:
                self.nominal = min(self.nominal*self.stage.dt_growth, self.stage.dt_max or np.inf)
            return
        self.spent = min(self.spent + self.own, 0.9*self.accuracy)
        self.v_before = (x1 - run.x)/scheme.dt if scheme.kind == STATIC else run.v.copy()
        self.s_before, self.dt_before = run.points.rate0.copy(), scheme.dt
        self.known, self.fresh, self.base_v = True, self.fresh + 1, None
        if np.any(np.abs(self.breaks - run.time - scheme.dt) < 1e-9*self.stage.duration) and scheme.kind != DYNAMIC:
            self.known, self.fresh, self.sudden = False, 0, run.time + scheme.dt

    KEPT = ("dt", "nominal", "factor", "good", "known", "fresh", "sudden", "last_ratio", "rejections", "held", "spent",
            "change")

    def kept(self):
        return {name: getattr(self, name) for name in self.KEPT} | {"dt_before": getattr(self, "dt_before", 0.0)}
