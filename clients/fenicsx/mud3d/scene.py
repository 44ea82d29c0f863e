# SPDX-License-Identifier: MIT
"""Scene files: the groups and keys of mud_host that mean the same here. Whatever is not carried is refused."""
import difflib
import pathlib
import re

import numpy as np

import mud
from mud import namelist

NEEDED = object()
#: Groups and their keys with defaults. A list is written as []; None: a number that may be left out.
KEYS = {
    "scene": {"name": "scene", "geometry": "axisymmetric", "fields": "u", "pressures": "linear", "quadrature": 6.0,
              "gravity": 0.0, "gravity_history": "", "initial_flow": "drain", "step_tolerance": None,
              "checkpoint_steps": 0.0},
    "mesh": {"file": "", "scale": 1.0, "r": [], "r_cells": [], "r_ratio": [], "y": [], "y_cells": [], "y_ratio": [],
             "z": [], "z_cells": [], "z_ratio": [], "cells": ""},
    "fluids": {"k_w": 2.2e6, "rho_w": 1.0, "eta_w": 1.0e-6, "rho_a": 0.0012},
    "retention": {"name": NEEDED, "law": "", "alpha": 0.0, "n": 2.0, "m": None, "s_max": 1.0, "s_min": 0.0, "a": 0.0,
                  "b": 1.0},
    "permeability": {"name": NEEDED, "intrinsic": None, "law": "corey", "s_min": 0.0, "s_max": 1.0, "a": 0.0, "b": 3.0,
                     "m": 0.5, "k_rw": 1.0, "floor": 1.0e-4},
    "region": {"group": "", "material": NEEDED, "retention": "", "permeability": "", "rho_s": 2.65, "void_ratio": None,
               "damping": 0.0, "stiffness_damping": 0.0},
    "initial": {"group": "all", "p_w": 0.0, "p_w_slope": 0.0, "p_c": 0.0, "p_c_slope": 0.0, "datum": 0.0,
                "stress": "none", "sigma": [], "surface": 0.0, "surcharge": 0.0, "k_0": 0.5, "k_0_of": "net"},
    "history": {"name": NEEDED, "times": [], "values": [], "file": ""},
    "stage": {"name": NEEDED, "analysis": "", "duration": NEEDED, "dt": None, "dt_growth": 1.0, "dt_max": None,
              "steps": "", "cuts": 10.0, "rho_inf": None, "tolerance": None, "measure": "auto", "max_iterations": 12.0,
              "start": "solve", "zero_displacements": "no", "every": 1.0, "fields": None},
    "fix": {"group": NEEDED, "field": NEEDED, "value": 0.0, "value_slope": 0.0, "datum": 0.0, "history": "",
            "hold": "no", "motion": "value", "stages": []},
    "load": {"group": NEEDED, "kind": NEEDED, "value": NEEDED, "value_slope": 0.0, "datum": 0.0, "history": "",
             "stages": []},
    "absorbing": {"group": NEEDED, "rho": None, "c_p": None, "c_s": None, "v_r": 0.0, "v_z": 0.0, "history": "",
                  "stages": []},
    "tie": {"first": NEEDED, "second": NEEDED, "pressures": "no"},
    "plate": {"name": NEEDED, "group": NEEDED, "mass": NEEDED, "weight": "no", "force": 0.0, "history": ""},
    "point": {"name": NEEDED, "r": 0.0, "y": 0.0, "z": 0.0},
    "elastic": {"name": NEEDED, "young": NEEDED, "poisson": NEEDED},
    "mud": None,  # every parameter of the library
}
WORDS = {
    ("scene", "geometry"): ("axisymmetric", "plane_strain", "box"),
    ("scene", "fields"): ("u", "u-p_w", "u-p_w-p_c"),
    ("scene", "pressures"): ("quadratic", "linear"),
    ("scene", "initial_flow"): ("drain", "subtract"),
    ("mesh", "cells"): ("", "triangles", "quadrilaterals", "tetrahedra", "hexahedra"),
    ("retention", "law"): ("van_genuchten", "power"),
    ("permeability", "law"): ("corey", "mualem", "power", "constant"),
    ("initial", "stress"): ("none", "uniform", "geostatic"),
    ("initial", "k_0_of"): ("net", "effective"),
    ("stage", "analysis"): ("static", "quasi_static", "dynamic"),
    ("stage", "steps"): ("", "given", "controlled"),
    ("stage", "measure"): ("auto", "change"),
    ("stage", "start"): ("solve", "zero"),
    ("fix", "field"): ("u_r", "u_y", "u_z", "p_w", "p_a"),
    ("fix", "motion"): ("value", "acceleration"),
    ("load", "kind"): ("pressure", "shear_r", "shear_y", "shear_z", "water", "force_r", "force_y", "force_z"),
    **{(group, key): ("no", "yes") for group, key in (("stage", "zero_displacements"), ("fix", "hold"),
                                                      ("tie", "pressures"), ("plate", "weight"))},
}
#: Keys of mud_host about its own way to compute, and of air, which rests here: they change no answer.
IGNORED = {("fluids", "k_a"), ("fluids", "eta_a"), ("fluids", "gas"), ("fluids", "p_ref"), ("permeability", "c"),
           ("permeability", "k_ra"), ("scene", "threads"), ("scene", "factors"),
           ("mud", "tangent"), ("stage", "predictor"), ("stage", "output_dt"), ("stage", "created_energy")}


class SceneError(Exception):
    pass


def _value(match):
    """A number, a word, or a text as it is meant between its quotes, which is never a number."""
    return namelist.word_of(match) if match["text"] else namelist.value_of(match)


def _groups(path):
    """(group, {key: list of values}) in the order of the file."""
    try:
        tokens = [match for _, match in namelist.tokens_of(pathlib.Path(path).read_text(), path)]
    except OSError as problem:
        raise SceneError(f"{path} cannot be read: {problem.strerror}") from problem
    except mud.InputError as problem:
        raise SceneError(str(problem)) from problem
    found, i = [], 0
    while i < len(tokens):
        if tokens[i]["mark"] != "&" or i + 1 == len(tokens):
            raise SceneError(f"{path}: & and the name of a group are expected where {tokens[i].group().strip()} stands")
        name, entries, i = tokens[i + 1]["word"].lower(), {}, i + 2
        while i < len(tokens) and tokens[i]["mark"] != "/":
            if tokens[i]["word"] is None or i + 1 >= len(tokens) or tokens[i + 1]["mark"] != "=":
                raise SceneError(f"{path}: &{name}: not key = value: {tokens[i].group().strip()}")
            key, values, i = tokens[i]["word"].lower(), [], i + 2
            while i < len(tokens) and tokens[i]["mark"] is None and not (
                    i + 1 < len(tokens) and tokens[i + 1]["mark"] == "=" and tokens[i]["word"]):
                values.append(_value(tokens[i]))
                i += 1
            entries[key] = values
        if i == len(tokens):
            raise SceneError(f"{path}: &{name} does not end with /")
        found.append((name, entries))
        i += 1
    return found


class Entry(dict):
    """Keys of one group as attributes."""

    def __getattr__(self, key):
        if key in self:
            return self[key]
        raise AttributeError(key)


def _checked(group, given):
    if group not in KEYS:
        raise SceneError(f"&{group} is not carried by this program: see the README; mud_host may have it")
    if KEYS[group] is None:  # &mud
        return Entry({key: values[0] for key, values in given.items() if (group, key) not in IGNORED})
    known, entry = KEYS[group], Entry()
    for key, values in given.items():
        if (group, key) in IGNORED:
            continue
        if key not in known:
            near = difflib.get_close_matches(key, known, 1)
            raise SceneError(f"&{group} {key}: this program does not carry this key" +
                             (f"; the nearest that it has is {near[0]}" if near else "; mud_host may have it"))
        allowed, default = WORDS.get((group, key)), known[key]
        if isinstance(default, list):
            entry[key] = values
            continue
        if len(values) != 1:
            raise SceneError(f"&{group} {key}: one value is needed, {len(values)} are given")
        if allowed and values[0] not in allowed:
            raise SceneError(f"&{group} {key} = '{values[0]}': this program has {', '.join(w for w in allowed if w)}")
        if (default is None or isinstance(default, float)) and not isinstance(values[0], float):
            raise SceneError(f"&{group} {key} = {values[0]}: a number is needed")
        entry[key] = values[0]
    for key, default in known.items():
        if key not in entry:
            if default is NEEDED:
                raise SceneError(f"&{group}: the key {key} is missing")
            entry[key] = list(default) if isinstance(default, list) else default
    return entry


class Scene:
    """All groups of a file, checked: one-off groups as attributes, the others as lists."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        lists = {name: [] for name in KEYS}
        for name, given in _groups(path):
            lists[name if name in KEYS else _checked(name, given)].append(_checked(name, given))
        for name in ("scene", "mesh", "fluids"):
            if len(lists[name]) > 1 or (name == "mesh" and not lists[name]):
                raise SceneError(f"{path}: one group &{name} is needed")
            setattr(self, name, lists[name][0] if lists[name] else _checked(name, {}))
        for name in KEYS:
            if name not in ("scene", "mesh", "fluids"):
                setattr(self, {"history": "histories", "elastic": "elastics", "mud": "muds"}.get(name, name + "s"),
                        lists[name])
        self.names = {h.name: self._history(h) for h in self.histories}
        self.air_at_rest = False
        self._refuse()

    def _history(self, entry):
        if entry.file:
            rows = [[float(x.replace("d", "e")) for x in line.replace(",", " ").split()]
                    for line in (self.path.parent/entry.file).read_text().splitlines()
                    if line.strip() and line.strip()[0] not in "!#"]
            return np.array(rows).T
        return np.array([entry.times, entry["values"]], float)

    def factor(self, name, time):
        """Value of a history."""
        if not name:
            return 1.0
        if name not in self.names:
            raise SceneError(f"the history '{name}' is not defined")
        return float(np.interp(time, *self.names[name]))

    def breaks(self):
        """Times at which a load history turns."""
        return np.unique(np.concatenate([h[0] for h in self.names.values()])) if self.names else np.zeros(0)

    def acts(self, entry, stage):
        return not entry.stages or stage.name in entry.stages

    def _refuse(self):
        fields = self.scene.fields
        if not self.stages or not self.regions:
            raise SceneError("a &region and a &stage are needed")
        for stage in self.stages:
            if not stage.analysis:
                raise SceneError(f"&stage '{stage.name}': the key analysis is missing")
        air = [fix for fix in self.fixs if fix.field == "p_a"]
        for fix in air:
            if fix.group != "all" or fix.value != 0.0 or fix.value_slope != 0.0 or fix.stages:
                raise SceneError("&fix field = 'p_a': here air is at rest, group = 'all' with the value 0")
        if fields == "u-p_w-p_c" and not air:
            raise SceneError("fields = 'u-p_w-p_c': air that flows is not carried by this program; with &fix group = "
                             "'all' field = 'p_a' it is at rest at the pressure of the atmosphere; mud_host has both")
        if air and fields != "u-p_w-p_c":
            raise SceneError(f"&fix field = 'p_a' in a scene with the fields '{fields}'")
        self.air_at_rest = bool(air)
        self.has_water = fields != "u"
        for initial in self.initials:
            if fields == "u-p_w-p_c" and (initial.p_c != -initial.p_w or initial.p_c_slope != -initial.p_w_slope):
                raise SceneError("&initial: with air at rest the suction is -p_w")
        for fix in self.fixs:
            if fix.field == "p_w" and not self.has_water:
                raise SceneError("&fix field = 'p_w' in a scene without it")
        for region in self.regions:
            if self.has_water and not region.permeability:
                raise SceneError(f"&region of '{region.material}': the key permeability is missing")
        if self.scene.geometry != "box" and any(fix.field == "u_y" for fix in self.fixs):
            raise SceneError("&fix field = 'u_y' needs geometry = 'box'")

    def one(self, what, name):
        for entry in getattr(self, what):
            if entry.name == name:
                return entry
        raise SceneError(f"'{name}' is not defined in the {what} of the scene")

    def material(self, name):
        """mud.Material, or the &elastic group."""
        for entry in self.elastics:
            if entry.name == name:
                return entry
        values = dict(self.one("muds", name))
        values.pop("name")
        file = values.pop("file", None)
        tolerance = {} if self.scene.step_tolerance is None else {"tolerance": min(1e-3, 0.1*self.scene.step_tolerance)}
        try:
            return mud.Material(str(self.path.parent/file) if file else None, **{**tolerance, **values})
        except mud.MudError as problem:
            raise SceneError(f"&mud '{name}': {problem}") from problem


def named(text):
    """A name that may stand in a file name and a column."""
    return re.sub(r"[^\w.-]", "_", text)
