# SPDX-License-Identifier: MIT
"""Which effects a scene calls for: a pilot with all that no key rules out, one without each effect, one without all
that are to go, and what differs in the answers.

A pilot is a run of the scene on a coarse mesh. All pilots take the steps of the first one, so that what differs then
differs by the effect. What pilots may cost is a share of the run that they are for; what they cannot try stays as the
scene has it. The key `without` of the host takes effects out, so that nothing here knows how.
"""

from __future__ import annotations

import copy
import hashlib
import math
import subprocess
from dataclasses import dataclass

import numpy as np

from ..host import HostRun
from ..namelist import quoted
from .histories import between
from .runs import DEFAULT_TOLERANCE, Failed, Run, Scene, files_of, list_of, processor, write_csv

EARTH = 9.81  # [m/s2]
FIELDS = ("u", "u-p_w", "u-p_w-p_c")
# Words of `without` beside inertia, which is left out stage by stage; the key of &mud that says an effect.
MUD = {w: w for w in ("hysteresis", "bonding", "fabric", "isotropic", "lode", "memory_rule")} | {
    "elastic_domain": "rho_e"
}
WORDS = ("relative_acceleration", "p_w", "p_c", "gravity", "contact", "damping", "absorbing", "contact_drainage",
         "seepage_face", "friction", "strength", "void_ratio_in_retention", *MUD)
OF_STUDY = ("effects", "effects_tolerance", "effects_pilot_share", "effects_on_warning")  # keys that the host refuses

TOLERANCE = 0.01  # an effect that changes an answer by more matters
PILOT_FACTOR = 2.0  # an influence is taken so many times as large, for the coarseness of the pilot
PILOT_STEPS, PILOT_NEWTON = 1e-2, 1e-4  # step tolerance of pilots, and Newton's beside given steps
ELEMENTS = 60  # that a pilot's mesh has at least, where the scene's has
MOST_TIMES, MOST_ALONE = 5.0, 60.0  # a pilot may cost so many times that of all effects; that one so many seconds
SHARE, LEAST_RUN = 0.05, 30.0  # of the run that pilots may cost; below so much there are none [s of processor]
LEAST_PILOTS = 5  # three of the scene, and two of effects
NO_ANSWER, NO_PRESSURE = 1e-4, 1e-3  # smaller ranges are no answers: of the largest of a kind; of the stresses' change
OVER_SHARE = "not tried: pilots would cost too much"


class Silent(Exception):
    """No pilots; the sentence says why."""


@dataclass
class Effect:
    """A row of the table."""

    name: str
    word: str = ""  # of `without`
    setting: str = ""  # or the key that leaves it out
    by_hand: bool = True  # a key says it, so that nothing else decides
    on: bool = True  # in the run
    influence: float | None = None  # largest change of an answer without it, over the answer's range
    answer: str = ""
    processor: float | None = None  # of its pilot over that of all effects
    why: str = ""


def leaves_open(groups) -> bool:
    """Whether a scene leaves to a study what no key says."""
    return str(groups["scene"].get("effects", "given")).lower() == "auto"


def settled(groups, full=False):
    """A scene that says what it left open, as the host reads it: in the cheapest reading that serves what the scene
    asks for, or (full) with all that no key rules out."""
    scene = copy.deepcopy(groups)
    one, stages = scene["scene"], list_of(scene, "stage")
    auto = leaves_open(groups)
    if auto and "fields" not in one:
        regions = list_of(scene, "region")
        water = any(r.get("permeability") or r.get("drainage") in ("drained", "undrained") for r in regions)
        one["fields"] = FIELDS[2 if any(r.get("retention") for r in regions) else int(water)]
    if auto and not {"gravity", "gravity_history"} & set(one):
        asked = any(i.get("stress") == "geostatic" for i in list_of(scene, "initial"))
        asked = asked or any(p.get("weight") == "yes" for p in list_of(scene, "plate"))
        one["gravity"] = EARTH if full or asked else 0.0
    for i, stage in enumerate(stages):
        if "analysis" not in stage:
            stage["analysis"] = "dynamic" if full or _needs_inertia(scene, i) else "quasi_static"
    moving = any(str(s["analysis"]).lower() == "dynamic" for s in stages)
    # With p_c it makes waves that grow: it is never put in there.
    if auto and full and moving and "seepage_inertia" not in one and one.get("fields") == FIELDS[1]:
        one["seepage_inertia"] = "yes"
    for key in OF_STUDY:
        one.pop(key, None)
    return scene


def _needs_inertia(scene, i):
    """Whether a stage has keys that act with inertia alone."""
    name = list_of(scene, "stage")[i]["name"]
    acts = [x for g in ("absorbing", "fix") for x in list_of(scene, g)
            if (g == "absorbing" or x.get("motion") == "acceleration") and name in np.ravel(x.get("stages", name))]
    damped = any(r.get("damping") or r.get("stiffness_damping") for r in list_of(scene, "region"))
    return bool(acts or damped or (i == 0 and any(x.get("v_z") or x.get("wave") for x in list_of(scene, "initial"))))


def write_scene(scene, path, folder):
    """A scene as a file; files that it names are seen from `folder`."""
    scene = copy.deepcopy(scene)
    for group, key, named in files_of(scene, folder):
        group[key] = str(named.resolve())
    scene.write(path, force=True)


class Effects:
    """The search for what a scene calls for."""

    def __init__(self, scene: Scene, share: float = SHARE, least_run: float = LEAST_RUN):
        self.scene, self.share, self.least_run = scene, share, least_run
        one = scene.list_of("scene")[0]
        self.tolerance = float(one.get("effects_tolerance", TOLERANCE))
        self.accuracy = float(one.get("step_tolerance", DEFAULT_TOLERANCE))
        self.full, self.rows, self.auto = settled(scene.groups, full=True), [], leaves_open(scene.groups)
        self.spent, self.quote, self.pilots, self.start = 0.0, 0.0, 0, 0.0
        scene.folder.mkdir(parents=True, exist_ok=True)
        path = scene.folder / "pilot.nml"
        text = copy.deepcopy(self.full)
        for stage in list_of(text, "stage"):
            stage["created_energy"], stage["steps"] = 1e9, "controlled"  # a bad pilot shows in its own error
            for key in ("output_dt", "dt_max"):
                stage.pop(key, None)
        write_scene(text, path, scene.path.parent)
        self.runs = Scene(path, scene.folder / "pilots", scene.host, scene.left, quiet=True, scale=False)
        self.moving = {f"{f['group']}.force_{f['field'][-1]}" for f in list_of(text, "fix")
                       if f["field"] in ("u_r", "u_z") and (f.get("value") or f.get("value_slope"))
                       and f.get("motion") != "acceleration"}
        mesh = scene.list_of("mesh")[0]
        axes = [] if "file" in mesh else [np.ravel(mesh[axis]) for axis in ("r_cells", "z_cells")]
        self.cells = max(1, math.isqrt(2 * math.prod(int(n.sum()) for n in axes) // ELEMENTS))
        coarse = [np.maximum(1, np.rint(n / self.cells)) for n in axes]
        # How many times as many nodes the run has as a pilot.
        self.nodes = math.prod((2 * n.sum() + 1) / (2 * m.sum() + 1) for n, m in zip(axes, coarse))
        self._list_open()

    # Rows ---------------------------------------------------------------------------------------------------------

    def _list_open(self):
        """What no key says and the cheapest reading does not have."""
        cheap, given = settled(self.scene.groups), self.scene.list_of("stage")
        for i, (stage, its) in enumerate(zip(list_of(self.full, "stage"), list_of(cheap, "stage")), 1):
            if str(stage["analysis"]).lower() == "dynamic":
                self.rows.append(Effect(f"inertia in {stage['name']}", setting=f"stage[{i}].analysis=quasi_static",
                                        by_hand="analysis" in given[i - 1], on=its["analysis"] == "dynamic"))
        one = self.scene.list_of("scene")[0]
        if self.auto and self.rows and "seepage_inertia" not in one and self.full["scene"].get("fields", "u") != "u":
            word, why = "relative_acceleration", ""
            if "seepage_inertia" not in self.full["scene"]:
                word, why = "", "not tried: with p_c its waves grow"
            self.rows.append(Effect("relative_acceleration", word, by_hand=False, on=False, why=why))
        if self.full["scene"].get("gravity") != cheap["scene"].get("gravity"):
            self.rows.append(Effect("gravity", "gravity", by_hand=False, on=False))

    def _list_others(self):
        """What the scene has: the host says of a word of `without` that the scene does not have it."""
        one, known = self.scene.list_of("scene")[0], {row.name for row in self.rows}
        words = [w for w in WORDS if w not in known]
        said = self._check(words)
        # Where all together cannot be left out, one by one.
        absent = {w for w in words if f"'{w}' of &scene has no effect" in (said or self._check([w]))}
        for word in (w for w in words if w not in absent):
            key = {"relative_acceleration": "seepage_inertia", "p_w": "fields", "p_c": "fields"}.get(word, word)
            says = key in one if word not in MUD else any(MUD[word] in m for m in self.scene.list_of("mud"))
            may = word in (*MUD, "relative_acceleration", "p_w", "p_c", "gravity")
            self.rows.append(Effect(word, word, by_hand=says or not (self.auto and may)))
        regions = self.scene.list_of("region")
        if self.auto and self.full["scene"].get("fields", "u") != "u" and len(regions) > 1:
            self.rows += [
                Effect(f"flow in {r.get('group', '')}", setting=f"region[{i}].drainage=drained", by_hand=False)
                for i, r in enumerate(regions, 1) if "drainage" not in r
            ]

    def _check(self, out) -> str:
        """What the host says of the scene without effects, before it runs it; nothing if it refuses several."""
        before = processor()
        words = [self.scene.host, self.runs.path, "--check", "--quiet", "--fineness", f"{1 / self.cells:g}"]
        done = subprocess.run([*words, "--set", f"scene.without={','.join(out)}"], capture_output=True, text=True)
        self.start = processor() - before
        self.spent += self.start
        return "" if done.returncode and len(out) > 1 else done.stderr + " "

    def without(self, rows) -> tuple[str, ...]:
        """Settings that leave effects out."""
        given = np.ravel(self.full["scene"].get("without", [])).tolist()
        words = [*given, *(r.word for r in rows if r.word)]
        return (*(r.setting for r in rows if r.setting), *([f"scene.without={','.join(words)}"] if words else []))

    # Pilots -------------------------------------------------------------------------------------------------------

    def left(self) -> float:
        """Processor time that pilots may still take [s]; until one has told what the run costs, of the least run."""
        return math.inf if self.share == math.inf else self.share * max(self.quote, self.least_run) - self.spent

    def pilot(self, out, steps=(), most=math.inf) -> Run:
        """A pilot without the rows `out`; Failed where it fails or takes more than it may."""
        most = min(most, self.left())
        if most <= 0:
            raise Failed(OVER_SHARE, cut=True)
        before, self.pilots = self.runs.spent, self.pilots + 1
        try:
            tolerance, settings = max(PILOT_STEPS, self.accuracy), (*self.without(out), *steps)
            return self.runs.run(1 / self.cells, tolerance, settings=settings, most=most)
        finally:
            self.spent += self.runs.spent - before

    def base_of(self, out):
        """The pilot that others are compared with: (what it is without, keys that prescribe its steps, run)."""
        most = MOST_ALONE if self.share == math.inf and len(out) < len(self.rows) else math.inf
        first = self.pilot(out, most=most)
        table, keys, start = HostRun(self.runs.folder / first.key.folder).ledger, [], 0.0
        for i, stage in enumerate(list_of(self.full, "stage"), 1):
            here = table["stage"] == i
            times = np.column_stack([table["time"][here] - start, table["dt"][here]])
            # Named by what it holds, so that the same command finds the pilots that it made.
            file = self.runs.folder / f"steps_{hashlib.sha256(times.tobytes()).hexdigest()[:10]}.txt"
            np.savetxt(file, times, fmt="%.17e")
            start += float(stage["duration"])
            words = {"steps": "given", "step_ends": quoted(str(file.resolve())), "dt": times[0, 1], "dt_growth": 1.0,
                     "tolerance": stage.get("tolerance", PILOT_NEWTON)}
            keys += [f"stage[{i}].{key}={value}" for key, value in words.items()]
        return out, tuple(keys), self.pilot(out, keys, MOST_TIMES * first.seconds + 1)

    def _quote(self, pilot):
        """Processor time that the run takes at least, from a pilot's: no fewer steps, each in proportion to the nodes;
        Silent where that is short."""
        self._check(["gravity"])
        stage_of, steps = HostRun(self.runs.folder / pilot.key.folder).ledger["stage"], 0.0
        default = "controlled" if "step_tolerance" in self.scene.list_of("scene")[0] else "given"
        for i, stage in enumerate(self.scene.list_of("stage"), 1):
            taken = np.sum(stage_of == i)
            if "dt" in stage and stage.get("steps", default).lower() == "given":
                grown = stage.get("dt_growth", 1.0) - 1
                taken = stage["duration"] / stage["dt"]
                taken = max(np.log1p(taken * grown) / np.log1p(grown) if grown > 0 else taken,
                            stage["duration"] / stage.get("dt_max", math.inf))
            steps += taken
        self.quote = (pilot.seconds - self.start) * self.nodes * steps / len(stage_of)
        if self.quote < self.least_run:
            raise Silent(f"the run is quoted at {self.quote:.2g} s of processor time, less than {self.least_run:g} s")

    # Search -------------------------------------------------------------------------------------------------------

    def search(self) -> list[Effect]:
        """The table: what is on in the run. Silent where pilots may not be run; Failed where the scene's own fails."""
        if self.share * self.nodes < LEAST_PILOTS:
            raise Silent(f"pilots would take more than {100 * self.share:g} % of the run, as few cells can be spared")
        inertia = [r for r in self.rows if r.setting]
        open_ones = [r for r in self.rows if not (r.by_hand or r.on or r.why)]
        if self.share != math.inf:
            self._quote(self.pilot(open_ones))
        failed = {}
        # What the cheapest reading lacks goes again where the pilot with it fails or is too dear.
        for out in ([], [r for r in open_ones if r in inertia], open_ones):
            if tuple(r.name for r in out) in failed:
                continue
            try:
                base = self.base_of(out)
                break
            except Failed as failure:
                failed[tuple(r.name for r in out)] = failure
        else:
            if any(f.cut for f in failed.values()):
                raise Silent(f"a pilot takes more than {100 * self.share:g} % of the run")
            last = list(failed.values())[-1]  # of the cheapest reading
            raise Failed(f"the pilot of the scene fails, so that nothing can be said of any effect: {last.said}", last.code)
        for row in base[0]:
            row.why = f"cannot be put in: {next(iter(failed.values())).said}"
        self._list_others()
        rows = [r for r in self.rows if not r.why]
        going = self._try([r for r in rows if r in inertia], base)
        if going and len(going) == len(inertia):  # without inertia pilots are cheap, and what is left is compared so
            try:
                base = self.base_of([*base[0], *going])
            except Failed:
                pass
        going += self._try([r for r in rows if r not in inertia], base)
        self._together([r for r in going if r not in base[0]], base)
        return self.rows

    def _try(self, rows, base) -> list[Effect]:
        """A pilot without each effect; those that are to go."""
        out, steps, pilot = base
        # One is kept for all that are to go.
        room = max(0, int(min(len(rows), self.left() / max(pilot.seconds, 1e-9) - 1)))
        rows = sorted(rows, key=lambda r: r.by_hand and room < len(rows))
        for row in rows[room:]:
            row.why = OVER_SHARE
        rows = rows[:room]
        for row in rows:
            try:
                found = self.pilot([*out, row], steps, MOST_TIMES * pilot.seconds + 1)
                row.influence, row.answer = self.difference(pilot, found)
            except Failed as failure:
                row.why = str(failure) if failure.cut else f"cannot be left out: {failure.said}"
                row.on = row.on or not failure.cut
                self.scene.say(f"   pilot {self.pilots}, without {row.name}: {row.why}")
                continue
            row.processor = found.seconds / max(pilot.seconds, 1e-9)
            row.on = row.by_hand or PILOT_FACTOR * row.influence > self.tolerance
            row.why = "by hand" if row.by_hand else ""
            self.scene.say(f"   pilot {self.pilots}, without {row.name}: {100 * row.influence:.2g} % of {row.answer}")
        return [r for r in rows if not r.on]

    def _together(self, going, base):
        """What is to go together is tried together; the strongest stays where that is too much."""
        out, steps, pilot = base
        while len(going) > 1:
            back, why = [max(going, key=lambda r: r.influence or 0.0)], "weak alone, but not together with the others"
            try:
                found = self.pilot([*out, *going], steps, MOST_TIMES * pilot.seconds + 1)
                apart, answer = self.difference(pilot, found)
                self.scene.say(f"   pilot {self.pilots}, without all that is to go: {100 * apart:.2g} % of {answer}")
                if apart <= self.tolerance:
                    return
            except Failed as failure:
                why = f"weak alone; the pilot without all that are to go: {failure.said}"
                back = going if failure.cut else back
            for row in back:
                row.on, row.why = True, why
            going = [r for r in going if not r.on]

    def difference(self, a: Run, b: Run) -> tuple[float, str]:
        """How far the answers of two pilots lie apart, over the range of each in the first, and the answer that differs
        most. A pressure that is no unknown of one of them is measured against the largest change of the stresses."""
        p, q = (HostRun(self.runs.folder / run.key.folder).histories for run in (a, b))
        stresses = [float(np.ptp(v)) for x in (p, q) for n, v in x.items() if n.rsplit(".", 1)[-1].startswith("s_")]
        stress = max(stresses, default=0.0)
        kinds = ("u_", "p_", "force")
        answers = {n: (kind, (p["time"], v), (q["time"], q[n])) for n, v in p.items() for kind in kinds[:2]
                   if n.rsplit(".", 1)[-1].startswith(kind) and n[-1] in "rzwc" and n in q}
        forces = a.histories.forces, b.histories.forces
        answers |= {n: (kinds[2], forces[0][n], forces[1][n]) for n in self.moving if n in forces[0] and n in forces[1]}
        ranges = {n: (np.ptp(x[1]), np.ptp(y[1])) for n, (_, x, y) in answers.items()}
        largest = {k: max((ranges[n][0] for n in answers if answers[n][0] == k), default=0.0) for k in kinds}
        largest["p_"] = max(largest["p_"], NO_PRESSURE / NO_ANSWER * stress)
        found = []
        for n, (kind, (t, y), (s, z)) in answers.items():
            if kind == "p_" and 0 in ranges[n]:
                value = (y, z)[int(ranges[n][0] == 0)]
                apart = np.ptp(value if n.endswith(".p_w") else np.maximum(0.0, value)) / max(stress, 1e-300)
            elif ranges[n][0] > NO_ANSWER * largest[kind] or ranges[n][1] > 10 * NO_ANSWER * largest[kind]:
                span = ranges[n][0] if ranges[n][0] > NO_ANSWER * largest[kind] else ranges[n][1]
                seen = (t >= s[min(1, len(s) - 1)]) & (t <= s[-1])
                apart = np.max(np.abs(y[seen] - between(s, z, t[seen])), initial=abs(y[-1] - z[-1])) / span
            else:
                continue
            found.append((float(apart), n))
        if not found:
            raise Failed("no point and no force of a moving support changes: nothing to judge by")
        return max(found)

    # Results ------------------------------------------------------------------------------------------------------

    def reduced(self):
        """The scene with the effects as the table says."""
        scene = copy.deepcopy(self.full)
        out = [r for r in self.rows if not r.on]
        for row in out:
            if row.setting:
                name, key = row.setting.split(".")
                group, i = name.rstrip("]").split("[")
                list_of(scene, group)[int(i) - 1].update([key.split("=")])
        words = [*np.ravel(scene["scene"].get("without", [])).tolist(), *(r.word for r in out if r.word)]
        if words:
            scene["scene"]["without"] = words
        return scene

    def write(self, path):
        """effects.csv."""
        write_csv(path, ("effect", "on", "by", "influence", "answer", "cost", "remark"),
                  [(r.name, "on" if r.on else "off", "hand" if r.by_hand else "pilot", r.influence, r.answer,
                    r.processor, r.why) for r in self.rows])
