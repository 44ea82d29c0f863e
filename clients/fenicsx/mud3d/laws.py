# SPDX-License-Identifier: MIT
"""The points of a rank: their laws, states and answers, and the laws of water at them.

MUD answers by the batch call of the Python package, with every block; an elastic skeleton and the retention curves
beside it are a few lines here. Stress is effective and positive in tension, suction is what the water lacks to the
pressure of the atmosphere.
"""
import numpy as np

import mud

from .scene import SceneError

M = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])


class Refused(Exception):
    """Some point of any rank has no answer to its increment; nothing was written there."""


class Points:
    """n points. Ends of a step: 0 is its start, 1 the present guess of its end."""

    def __init__(self, comm, scene, region_of_point, saturated, lanes=False):
        self.comm, self.n, self.saturated, self.lanes = comm, len(region_of_point), saturated, lanes
        self.region = region_of_point
        laws = [scene.material(region.material) for region in scene.regions]
        sands = [law for law in laws if isinstance(law, mud.Material)]
        self.sands = mud.MaterialList(sands) if sands else None
        number = np.cumsum([isinstance(law, mud.Material) for law in laws]) - 1
        is_sand = np.array([isinstance(law, mud.Material) for law in laws])
        self.mud = np.nonzero(is_sand[region_of_point])[0].astype(np.intc)
        self.elastic = np.nonzero(~is_sand[region_of_point])[0]
        self.material = np.ascontiguousarray(number[region_of_point], np.intc)
        stiffness, self.curves = np.zeros((len(laws), 6, 6)), []
        for i, (law, region) in enumerate(zip(laws, scene.regions)):
            own = isinstance(law, mud.Material)
            if own and region.retention not in ("", "material", "mud"):
                raise SceneError(f"&region of '{region.material}': MUD has its own retention curve")
            if not own:
                stiffness[i] = hooke(law.young, law.poisson)
            needs = scene.air_at_rest and not own
            if needs and not region.retention:
                raise SceneError(f"&region of '{region.material}': the key retention is missing")
            self.curves.append(scene.one("retentions", region.retention) if needs else None)
        self.stiffness = stiffness
        n = self.n
        self.stress0, self.stress1 = np.zeros((n, 6)), np.zeros((n, 6))
        self.state0, self.state1 = (np.zeros((n if sands else 0, len(mud.states))) for _ in range(2))
        self.e0, self.e1 = np.zeros(n), np.zeros(n)
        self.s0, self.s1 = np.ones(n), np.ones(n)
        self.rate0 = np.zeros(n)  #: of S_w at the start of the step
        self.tangent, self.dsig_dpc = np.zeros((n, 6, 6)), np.zeros((n, 6))
        self.ds_de, self.ds_dpc = np.zeros(n), np.zeros(n)
        self._slopes = np.zeros((n, 6))
        self.laws, self.own_void_ratio = laws, [law["e_0"] if own else None for law, own in zip(laws, is_sand)]
        if sands:
            self.place_e = list(mud.states).index("void_ratio")
            self.place_s = list(mud.states).index("saturation")
            columns = np.zeros((n, 6, 6))
            self.answer = mud.BatchResponse(self.stress1, self.state1, columns, self.dsig_dpc, self._slopes,
                                            self.ds_dpc, self.s1)

    def begin(self, stress, suction, void_ratio):
        """Initial state of all points."""
        self.stress0[:], self.e0[:] = stress, void_ratio
        if len(self.mud):
            begun = self.sands.init_batch(self.stress0, suction, np.ascontiguousarray(self.e0), points=self.mud,
                                          material=self.material,
                                          out=mud.BatchResponse(self.stress0, self.state0))
            self._refuse(begun)
            self.s0[self.mud] = 1.0 if self.saturated else self.state0[self.mud, self.place_s]
        if len(self.elastic):
            self.retain(suction, self.s0)
        self.stress1[:], self.state1[:], self.e1[:], self.s1[:] = self.stress0, self.state0, self.e0, self.s0

    def _refuse(self, answer):
        failed = answer.failed if answer else 0
        if self.comm.allreduce(failed):
            sentences = self.comm.allgather(str(answer.fault() or "") if answer else "")
            raise Refused(next(sentence for sentence in sentences if sentence))

    def update(self, strain, suction, present=False):
        """Answers to an increment of strain; present: the slopes with which the states go on, nothing moves."""
        answer = None
        if len(self.mud):
            arguments = dict(points=self.mud, material=self.material, threads=1, out=self.answer)
            if present:
                answer = self.sands.tangent_batch(self.stress0, self.state0, **arguments)
                self.stress1[:], self.state1[:] = self.stress0, self.state0
            else:
                answer = self.sands.update_batch(self.stress0, self.state0, np.ascontiguousarray(strain),
                                                 np.ascontiguousarray(suction), "consistent", lanes=self.lanes,
                                                 **arguments)
        self._refuse(answer)
        if len(self.mud):
            i = self.mud
            self.tangent[i] = self.answer.columns[i].transpose(0, 2, 1)
            self.ds_de[i] = self._slopes[i, :3].mean(1)
            self.e1[i] = self.state1[i, self.place_e]
        if len(self.elastic):
            i, region = self.elastic, self.region[self.elastic]
            if present:
                strain = np.zeros_like(strain)
            self.tangent[i] = self.stiffness[region]
            self.stress1[i] = self.stress0[i] + np.einsum("nij,nj->ni", self.tangent[i], strain[i])
            self.e1[i] = (1.0 + self.e0[i])*np.exp(strain[i, :3].sum(1)) - 1.0
            self.retain(suction, self.s1)
        if present:
            self.s1[:] = self.s0
        if self.saturated:
            self.s1[:], self.ds_de[:], self.ds_dpc[:] = 1.0, 0.0, 0.0
            self.dsig_dpc[:] = 0.0

    def retain(self, suction, into):
        """S_w of elastic points into an array of all."""
        for number, law in enumerate(self.curves):
            i = self.elastic[self.region[self.elastic] == number]
            if law is None:
                into[i] = 1.0
            else:
                into[i], self.ds_dpc[i] = retention(law, suction[i])

    def accept(self, rate):
        self.rate0 = rate
        for name in ("stress", "state", "e", "s"):
            getattr(self, name + "0")[:] = getattr(self, name + "1")

    def kept(self):
        """What a checkpoint holds of every point: (points, numbers)."""
        state = self.state0 if len(self.state0) else np.zeros((self.n, 0))
        return np.concatenate([self.stress0, np.stack([self.e0, self.s0, self.rate0], 1), state], 1)

    def take(self, kept):
        self.stress0[:], self.e0[:], self.s0[:] = kept[:, :6], kept[:, 6], kept[:, 7]
        self.rate0 = kept[:, 8].copy()
        if len(self.state0):
            self.state0[:] = kept[:, 9:]


def hooke(young, poisson):
    shear = young/(2.0*(1.0 + poisson))
    D = young*poisson/((1.0 + poisson)*(1.0 - 2.0*poisson))*np.outer(M, M)
    D[np.arange(6), np.arange(6)] += np.where(M > 0, 2.0*shear, shear)
    return D


def retention(law, suction):
    """S_w and its slope against suction."""
    p = np.maximum(suction, 0.0)
    span = law.s_max - law.s_min
    if law.law == "power":
        full, slope = 1.0 - law.a*p**law.b, -law.a*law.b*np.maximum(p, 1e-30)**(law.b - 1.0)
        return np.maximum(full, law.s_min), np.where(full > law.s_min, slope, 0.0)
    m = 1.0 - 1.0/law.n if law.m is None else law.m
    x = (law.alpha*p)**law.n
    return (law.s_min + span*(1.0 + x)**-m,
            -span*m*(1.0 + x)**(-m - 1.0)*law.n*law.alpha*(law.alpha*p)**(law.n - 1.0))


def permeability(law, s):
    """Relative permeability to water and its slope against S_w."""
    if law.law == "constant":
        return np.full_like(s, law.k_rw), np.zeros_like(s)
    if law.law == "power":
        dry = np.maximum(1.0 - s, 0.0)
        k, slope = 1.0 - law.a*dry**law.b, law.a*law.b*np.maximum(dry, 1e-30)**(law.b - 1.0)
    else:
        x = np.clip((s - law.s_min)/(law.s_max - law.s_min), 0.0, 1.0)
        inside = (x > 0.0) & (x < 1.0)
        if law.law == "corey":
            k, slope = x**law.b, law.b*x**(law.b - 1.0)
        else:
            inner = np.clip(x, 1e-12, 1.0 - 1e-12)
            y = (1.0 - inner**(1.0/law.m))**law.m
            k = np.where(x >= 1.0, 1.0, np.sqrt(inner)*(1.0 - y)**2)
            dy = -(1.0 - inner**(1.0/law.m))**(law.m - 1.0)*inner**(1.0/law.m - 1.0)
            slope = 0.5/np.sqrt(inner)*(1.0 - y)**2 - 2.0*np.sqrt(inner)*(1.0 - y)*dy
        slope = np.where(inside, slope, 0.0)/(law.s_max - law.s_min)
    low = k < law.floor
    return np.where(low, law.floor, k), np.where(low, 0.0, slope)
