# SPDX-License-Identifier: MIT
"""Which effects a scene calls for: pilots on a coarse mesh, without each effect, and what each changes in the answers.

A pilot is a run of mud_host of a scene that a user could have written. All pilots take the steps of the first one, so
that what differs then differs by the effect. What pilots may cost is a share of the run that they are for; what they
cannot try stays as the scene has it.
"""

from __future__ import annotations

import copy
import csv
import hashlib
import math

import numpy as np

from ..host import HostRun
from .histories import between
from .runs import DEFAULT_TOLERANCE, Failed, Scene, cut_off
from .switches import Effect, is_present, list_effects, many, one, plain, settled, switch, write_scene

PILOT_FACTOR = 2.0  # an influence is taken so many times as large, for the coarseness of the pilot
GOOD_PILOT = 0.25  # pilots' steps are halved until that changes no answer by a larger share of its range
LEVELS = 5  # the first pilot has steps 2**LEVELS times as long
LEAST_STEPS, LEAST_TOLERANCE = 20, 0.3  # of a stage with given steps; of controlled ones
MANY_ELEMENTS = (60, 1000, 4000)  # above so many elements cells of pilots are twice, three and four times as long
MOST_TIMES_THE_BASE = 5.0  # a pilot without an effect may cost so many times that with it
MOST_TIMES_STILL = 1000.0  # a pilot with inertia, of one without it
SHARE, LEAST_RUN = 0.05, 30.0  # of the run that pilots may cost; below so much there are none [s of processor]
NO_ANSWER, NO_PRESSURE = 1e-4, 1e-3  # smaller ranges are no answers: of the largest of a kind; of the stresses' change
TOLERANCE = 0.01
OVER_SHARE = "not tried: pilots would cost too much"
ADDED = ("inertia", "gravity")
CELLS, GROWTH = 2.2, 2**0.2  # time grows with the cells to this power, and by this factor at half the step tolerance
LEAST_PILOTS = 4  # that of the scene, once more, and one of two effects


class Silent(Exception):
    """No pilots; the sentence says why."""


class Pilot:
    """A run of a reading of the scene, and what its answers did."""

    def __init__(self, run, folder, text):
        self.unknowns = {"u-p_w": ("p_w",), "u-p_w-p_c": ("p_w", "p_c")}.get(one(text).get("fields", "u"), ())
        self.moving = {
            f"{f['group']}.force_{f['field'][-1]}"
            for f in many(text, "fix")
            if f["field"] in ("u_r", "u_z")
            and (f.get("value") or f.get("value_slope"))
            and f.get("motion") != "acceleration"
        }
        self.processor, self.folder = run.processor, folder
        table = HostRun(folder).histories
        self.time = table["time"]
        self.nodes = run.histories.nodes
        self.points = {n: v for n, v in table.items() if n.rsplit(".", 1)[-1] in ("u_r", "u_z", "p_w", "p_c")}
        stresses = [v for n, v in table.items() if n.rsplit(".", 1)[-1].startswith("s_")]
        self.stress = max((float(np.ptp(v)) for v in stresses), default=0.0)
        self.forces = run.histories.forces
        self.steps = len(self.time)


class Effects:
    """The search for what a scene calls for."""

    def __init__(self, scene: Scene, share: float = SHARE, least_run: float = LEAST_RUN):
        self.scene, self.share, self.least_run = scene, share, least_run
        self.folder = scene.path.parent
        self.given = plain(scene.groups)
        self.tolerance = float(one(self.given).get("effects_tolerance", TOLERANCE))
        self.accuracy = float(one(self.given).get("step_tolerance", DEFAULT_TOLERANCE))
        self.rows = list_effects(self.given, self.folder)
        self.reading = settled(self.given)
        self.has_fields = {}
        self.spent, self.quote, self.noise, self.pilots = 0.0, 0.0, 0.0, 0
        self.cells = self._cells()
        for row in self.rows:
            row.tried_in = row.present

    # Pilots -------------------------------------------------------------------------------------------------------

    def left(self) -> float:
        """Processor time that pilots may still take [s]."""
        if self.share == math.inf:
            return math.inf
        # Until the first pilot has told what the run costs, the share of the least that is worth it.
        return self.share * max(self.quote, self.least_run) - self.spent

    def pilot(self, reading, level, most=math.inf, ends=None) -> Pilot:
        """A pilot; Failed where it fails or takes more than it may."""
        most = min(most, self.left())
        if most <= 0:
            raise Failed(OVER_SHARE)
        text = copy.deepcopy(reading)
        for i, stage in enumerate(many(text, "stage"), 1):
            stage["created_energy"] = 1e9  # a bad pilot shows in its own error
            stage.pop("output_dt", None)
            if ends:
                stage.update(ends[i - 1])
        tolerance = min(2**level * self.accuracy, LEAST_TOLERANCE)
        if not ends:
            self._lengthen(text, 2**level)
        made = self._run(text, tolerance, most)
        self.spent += made[0].processor
        self.pilots += 1
        return Pilot(*made, text)

    def _run(self, text, tolerance, most):
        path = self.scene.folder / "pilot.nml"
        self.scene.folder.mkdir(parents=True, exist_ok=True)
        write_scene(text, path, self.folder)
        pilots = Scene(
            path,
            self.scene.folder / "pilots" / hash_of(path.read_bytes()),
            self.scene.host,
            self.scene.left,
            quiet=True,
            scale=False,
        )
        fineness = 1 / self.cells
        try:
            run = pilots.run(fineness, tolerance, most=most)
        except Failed:
            self.spent += pilots.lost
            self.pilots += 1
            raise
        return run, pilots.folder / run.key.folder

    def _lengthen(self, text, times):
        for stage in many(text, "stage"):
            if not self._is_given(stage):
                continue
            longer = max(1.0, min(times, stage["duration"] / (stage["dt"] * LEAST_STEPS)))
            stage["steps"] = "given"
            stage["dt"] = longer * stage["dt"]
            if "dt_max" in stage:
                stage["dt_max"] = longer * stage["dt_max"]
            if longer > 1 and many(text, "contact"):
                stage["rho_inf"] = 0.0

    def _is_given(self, stage):
        """Whether a stage has given steps."""
        asked = "step_tolerance" in one(self.given)
        return "dt" in stage and str(stage.get("steps", "controlled" if asked else "given")).lower() == "given"

    def _cells(self):
        mesh = many(self.given, "mesh")[0]
        if "file" in mesh:
            return 1
        elements = 2 * int(np.sum(mesh["r_cells"])) * int(np.sum(mesh["z_cells"]))
        if elements == 2:
            return 1
        cells = 1 + sum(elements > n for n in MANY_ELEMENTS)
        # Where pilots may cost a share of the run they are as coarse as a mesh of few tens of elements.
        return cells if self.share == math.inf else max(cells, math.isqrt(elements // MANY_ELEMENTS[0]))

    def _afford(self):
        """Silent where the mesh and the steps of pilots cannot be so much coarser that the least of them are within
        their share: then the first one would be lost."""
        times = self.cells**CELLS * GROWTH ** math.log2(LEAST_TOLERANCE / self.accuracy)
        for stage in many(self.reading, "stage"):
            if self._is_given(stage):
                longer = min(2**LEVELS, max(1.0, stage["duration"] / (stage["dt"] * LEAST_STEPS)))
                times = max(times, self.cells**CELLS * longer)
        if self.share * times < LEAST_PILOTS:
            raise Silent(f"pilots would take more than {100 * self.share:g} % of the run, as few cells can be spared")

    def base_of(self, reading, most=math.inf):
        """The pilot of a reading, its steps halved until that changes the answers little, and run once more with these
        steps prescribed: (reading, ends of the steps, pilot, level), or Failed."""
        base, why, before = None, "", self.spent
        for level in range(LEVELS, -1, -1):
            if base and 4 * base[0].processor > min(self.left(), most - (self.spent - before)):
                break
            try:
                finer = self.pilot(reading, level, most - (self.spent - before))
            except Failed as failure:
                why = str(failure)
                if cut_off(why) or why == OVER_SHARE:
                    break
                continue
            apart = difference(finer, base[0])[0] if base else math.inf
            self._quote(finer, level, base)
            base = (finer, level)
            if apart <= GOOD_PILOT:
                break
        if base is None:
            raise Failed(why)
        ends = self._ends(reading, *base)
        try:
            again = self.pilot(reading, base[1], MOST_TIMES_THE_BASE * base[0].processor, ends)
            self.noise = max(self.noise, difference(base[0], again)[0])
        except Failed:
            return reading, None, *base
        return reading, ends, again, base[1]

    def _quote(self, pilot, level, before):
        """Processor time of the run, from that of a pilot: elements, and steps as they grew from pilot to pilot."""
        more = GROWTH
        if before and before[1] > level and before[0].steps:
            more = min(math.sqrt(2.0), max(1.0, (pilot.steps / before[0].steps) ** (1 / (before[1] - level))))
        tolerances = math.log2(min(2**level * self.accuracy, LEAST_TOLERANCE) / self.accuracy)
        given = [s for s in many(self.reading, "stage") if self._is_given(s)]
        steps = more ** max(tolerances, 0.0)
        if given:
            steps = max(s["duration"] / s["dt"] for s in given) / max(1, pilot.steps)
        self.quote = pilot.processor * self.cells**CELLS * max(steps, 1.0)
        if self.share != math.inf and self.quote < self.least_run:
            raise Silent(f"the run is quoted at {self.quote:.2g} s of processor time, less than {self.least_run:g} s")

    def _ends(self, reading, pilot, level):
        """Keys of every stage that prescribe the steps which a pilot took."""
        table = HostRun(pilot.folder).ledger
        said = (pilot.folder / "said.txt").read_text(encoding="utf-8")
        keys, start = [], 0.0
        for i, stage in enumerate(many(reading, "stage"), 1):
            rows = table["stage"] == i
            times = table["time"][rows] - start
            # Named by what it holds, so that the same command finds the pilots that it made.
            file = self.scene.folder / "pilots" / f"steps_{hash_of(np.stack([times, table['dt'][rows]]).tobytes())}.txt"
            np.savetxt(file, np.column_stack([times, table["dt"][rows]]), fmt="%.17e")
            start += float(stage["duration"])
            words = {
                "steps": "given",
                "step_ends": str(file.resolve()),
                "dt": float(table["dt"][rows][0]),
                "dt_growth": 1.0,
            }
            if "tolerance" not in stage:
                words["tolerance"] = min(1e-4, 0.1 * min(2**level * self.accuracy, LEAST_TOLERANCE))
            word = f"Stage {stage['name']}: "
            line = next((x for x in said.splitlines() if x.startswith(word) and "rho_inf" in x), "")
            if line:
                words["rho_inf"] = float(line.rsplit("rho_inf", 1)[1].strip(" .,"))
            keys.append(words)
        return keys

    # Search -------------------------------------------------------------------------------------------------------

    def search(self) -> list[Effect]:
        """The table: what is on in the run. Silent where pilots may not be run; Failed where the scene's own fails."""
        why = ""
        self._afford()
        try:
            self.base = self.base_of(self.reading)
        except Failed as failure:
            self.base, why = None, str(failure)
            if cut_off(why) or why == OVER_SHARE:
                raise Silent(
                    f"a pilot takes more than {100 * self.share:g} % of the run: all stays as the scene has it"
                ) from None
        self._added(why)
        if self.base is None:
            raise Failed(f"the pilot of the scene fails, so that nothing can be said of any effect: {why}")
        moving = any(s["analysis"] == "dynamic" for s in many(self.base[0], "stage"))
        tried = []
        for row in self.rows:
            if row.influence is not None or row.why or not (row.present or not row.by_hand):
                continue
            if row.kind in ADDED and not row.present:
                continue
            if row.kind == "relative_acceleration" and not moving:
                row.why = "not tried: no stage has inertia"
                continue
            tried.append(row)
        price = self.base[2].processor
        if price * (len(tried) + 1) > self.left():
            tried = [row for row in tried if not row.by_hand and row.kind != "flow"]
        if price * (len(tried) + 1) > self.left():
            tried = []
        for row in tried:
            self._try(row, self.base)
        self._decide()
        return self.rows

    def _try(self, row, base):
        """One pilot without (with) an effect."""
        reading, ends, pilot, level = base
        other = copy.deepcopy(reading)
        why = switch(other, row, not row.tried_in)
        found = None
        if not why:
            try:
                found = self.pilot(other, level, MOST_TIMES_THE_BASE * pilot.processor + 1, ends)
            except Failed as failure:
                why = str(failure)
        if why:
            row.on = row.tried_in
            row.why = f"cannot be {'left out' if row.tried_in else 'put in'}: {why}"
        else:
            influence, answer = difference(pilot, found)
            if not answer:
                row.why = "no point and no force of a moving support changes: nothing to judge by"
            else:
                row.influence, row.answer = influence, answer
                row.processor = found.processor / max(pilot.processor, 1e-9)
        self._tell(row)

    def _tell(self, row):
        words = row.why if row.influence is None else f"{100 * row.influence:.2g} % of {row.answer}"
        self.scene.say(f"   pilot {self.pilots}, {'without' if row.tried_in else 'with'} {row.name}: {words}")

    def matters(self, row):
        return row.on if row.influence is None else PILOT_FACTOR * row.influence > self.tolerance

    def _added(self, why):
        """What the scene leaves open and its cheapest reading does not have: weight, and inertia with its own steps."""
        open_rows = [r for r in self.rows if r.kind == "inertia" and not r.by_hand and not r.present]
        weight = next((r for r in self.rows if r.kind == "gravity" and not r.by_hand and not r.present), None)
        if self.base and weight:
            self._try(weight, self.base)
            weight.on = self.matters(weight)
        dynamic = None
        if open_rows:
            moving = copy.deepcopy(self.reading)
            for row in open_rows:
                switch(moving, row, True)
            still = self.base[2].processor if self.base else 0.0
            most = (
                max(60.0, MOST_TIMES_STILL * still)
                if self.share == math.inf
                else (self.left() - 2 * (len(self.rows) + 2) * still)
            )
            try:
                dynamic = self.base_of(moving, most)
            except Failed as failure:
                for row in open_rows:
                    row.why = (
                        "its pilot was cut off: as the scene says"
                        if cut_off(str(failure)) or str(failure) == OVER_SHARE
                        else f"cannot be put in: {failure}"
                    )
        if dynamic:
            for row in open_rows:
                row.tried_in = True
                self._try(row, dynamic)
                row.on = self.matters(row)
                row.tried_in = False
            if self.base:
                self._together(open_rows, weight, dynamic)
        self._choose_base(open_rows, weight, dynamic, why)

    def _together(self, open_rows, weight, dynamic):
        """Weak alone: the weight is put into the pilot with inertia, all is taken out of the other."""
        going = [r for r in open_rows if not r.on]
        light = bool(weight and weight.influence is not None and not weight.on)
        if len(going) + light < 2:
            return
        reading, ends, pilot, level = dynamic
        other, none = copy.deepcopy(reading), copy.deepcopy(reading)
        for row in going:
            switch(none, row, False)
        try:
            if light:
                switch(other, weight, True)
                pilot = self.pilot(other, level, ends=ends)
            apart = difference(pilot, self.pilot(none, level, ends=ends))[0]
        except Failed:
            return
        if apart > self.tolerance:
            row = max([*going, *([weight] if light else [])], key=lambda r: r.influence or 0.0)
            row.on = True
            row.why = "weak alone, but not together with the others that are to go"

    def _choose_base(self, open_rows, weight, dynamic, why):
        """With weight and inertia as they are decided: what is left is compared with that."""
        moves = any(r.on for r in open_rows)
        if self.base is None and dynamic:
            for row in open_rows:  # a body that nothing holds needs its inertia
                row.on, row.why = True, f"cannot be left out: {why}"
            moves = True
        if moves and dynamic:
            self.base = dynamic
        if self.base is None:
            return
        reading, ends, pilot, level = self.base
        before, reading = reading, copy.deepcopy(reading)
        for row in open_rows:
            if moves and not row.on:
                switch(reading, row, False)
            row.tried_in = row.on
        if weight:
            weight.tried_in = weight.on
            if weight.on:
                switch(reading, weight, True)
        if reading == before:
            return
        try:
            self.base = (
                reading,
                ends,
                self.pilot(reading, level, MOST_TIMES_THE_BASE * pilot.processor + 1, ends),
                level,
            )
        except Failed:
            for row in open_rows:
                row.tried_in = moves
            if weight:
                weight.tried_in = False

    def _decide(self):
        """What no key says goes or stays; what is to go together is tried together."""
        for row in self.rows:
            if row.by_hand:
                row.why = row.why or ("not tried: by hand" if row.influence is None else "by hand")
            elif row.influence is None:
                row.why = row.why or OVER_SHARE
            elif row.present or row.kind not in ADDED:
                row.on = self.matters(row)
                if row.kind == "relative_acceleration" and row.on and one(self.base[0]).get("fields") == "u-p_w-p_c":
                    row.on, row.why = False, "unstable in unsaturated soil: it stays off"
            if row.influence and row.influence <= self.noise:
                row.why = (row.why + "; " if row.why else "") + "within the noise of the pilots"
        while True:
            going = [r for r in self.rows if r.tried_in and not r.on and r.influence is not None]
            if len(going) < 2:
                return
            reading, ends, pilot, level = self.base
            other = copy.deepcopy(reading)
            for row in going:
                switch(other, row, False)
            try:
                apart, answer = difference(
                    pilot, self.pilot(other, level, MOST_TIMES_THE_BASE * pilot.processor + 1, ends)
                )
                self.scene.say(f"   pilot {self.pilots}, without all that is to go: {100 * apart:.2g} % of {answer}")
                if apart <= self.tolerance:
                    return
                why = "weak alone, but not together with the others that are to go"
                back = [max(going, key=lambda r: r.influence)]
            except Failed as failure:
                why = f"weak alone; the pilot without all that are to go: {failure}"
                back = (
                    going
                    if str(failure) == OVER_SHARE or cut_off(str(failure))
                    else [max(going, key=lambda r: r.influence)]
                )
            for row in back:
                row.on, row.why = True, why

    def reduced(self) -> dict:
        """The scene with the effects as the table says."""
        scene = settled(self.given)
        for row in self.rows:
            if row.on != is_there(scene, row, self.folder):
                switch(scene, row, row.on)
        for key in ("step_tolerance", "goals"):
            if key in one(self.given):
                one(scene)[key] = one(self.given)[key]
        return scene

    def write(self, path):
        """effects.csv."""
        with open(path, "w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(("effect", "on", "by", "influence", "answer", "cost", "remark"))
            number = lambda x: "" if x is None else f"{x:.4g}"  # noqa: E731
            for r in self.rows:
                table.writerow(
                    (
                        r.name,
                        "on" if r.on else "off",
                        "hand" if r.by_hand else "pilot",
                        number(r.influence),
                        r.answer,
                        number(r.processor),
                        r.why,
                    )
                )


def is_there(scene, row, folder):
    if row.kind == "flow":
        return many(scene, "region")[row.at].get("drainage", "coupled") == "coupled"
    return is_present(scene, row.kind, row.at, folder)


def hash_of(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:10]


def difference(a: Pilot, b: Pilot) -> tuple[float, str]:
    """How far the answers of two pilots of one mesh lie apart, as shares of the range of each answer in the first, and
    the answer that differs most. A pressure that one of them lacks is measured by its change against the largest change
    of an effective stress."""
    ranges = {n: float(np.ptp(v)) for n, v in a.points.items()}
    lacks = {n for n in a.points if _lacks(a, n)} | {n for n in b.points if _lacks(b, n)}
    kind = lambda n: n.rsplit(".", 1)[-1][0]  # noqa: E731
    largest = {k: max([x for n, x in ranges.items() if kind(n) == k], default=0.0) for k in "up"}
    largest["p"] = max(largest["p"], NO_PRESSURE / NO_ANSWER * a.stress)
    worst = (0.0, "")
    for n in a.points:
        if n not in b.points:
            continue
        if n in lacks:
            if _lacks(a, n) and _lacks(b, n):
                continue
            there = b if _lacks(a, n) else a
            value = there.points[n] if n.endswith(".p_w") else np.maximum(0.0, there.points[n])
            apart = float(np.ptp(value)) / max(there.stress, 1e-300)
        else:
            span, least = ranges[n], NO_ANSWER * largest[kind(n)]
            if span <= least:  # no answer, unless the other pilot makes one of it
                span = float(np.ptp(b.points[n]))
                if span <= 10 * least or span == 0:
                    continue
            apart = _farthest(a.time, a.points[n], b.time, b.points[n]) / span
        if apart > worst[0] or not worst[1]:
            worst = (apart, n)
    moving = {n: v for n, v in a.forces.items() if n in b.forces and n in a.moving}
    spans = {n: float(np.ptp(v[1])) for n, v in moving.items()}
    for n, (t, y) in moving.items():
        if spans[n] <= NO_ANSWER * max(spans.values()):
            continue
        apart = _farthest(t, y, *b.forces[n]) / spans[n]
        if apart > worst[0] or not worst[1]:
            worst = (apart, n)
    return worst


def _lacks(pilot, name):
    """Whether a field is no unknown of the scene: it stays at one value."""
    return name.endswith((".p_w", ".p_c")) and name.rsplit(".", 1)[-1] not in pilot.unknowns


def _farthest(t, y, s, z):
    seen = (t >= s[min(1, len(s) - 1)]) & (t <= s[-1])
    if not seen.any():
        return float(abs(y[-1] - z[-1]))
    return float(np.max(np.abs(y[seen] - between(s, z, t[seen]))))
