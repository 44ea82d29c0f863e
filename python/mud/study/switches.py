# SPDX-License-Identifier: MIT
"""Effects of a scene, each by the keys that say it: what is present, what no key says, and the scene without it.

A scene is a dictionary of lists of groups, as ``{"stage": [{"name": "load", ...}, ...]}``, keys in lower case.
"""

from __future__ import annotations

import copy
import pathlib
from dataclasses import dataclass

from ..errors import InputError
from ..namelist import read_material
from ..registry import parameters

EARTH = 9.81  # [m/s2]
FIELDS = ("u", "u-p_w", "u-p_w-p_c")
MUD = {
    "hysteresis": "hysteresis",
    "bonding": "bonding",
    "fabric": "fabric",
    "isotropic": "isotropic",
    "lode": "lode",
    "memory_rule": "memory_rule",
    "elastic_domain": "rho_e",
}
KINDS = (
    "inertia",
    "relative_acceleration",
    "p_w",
    "p_c",
    "gravity",
    "contact",
    "damping",
    "absorbing",
    "contact_drainage",
    "seepage_face",
    "friction",
    "strength",
    "void_ratio_in_retention",
    *MUD,
)
OF_STUDY = ("effects", "effects_tolerance", "effects_pilot_share", "effects_on_warning", "without", "step_tolerance", "goals")


@dataclass
class Effect:
    """A row of the table."""

    kind: str
    name: str
    at: int = 0  # stage of the inertia, region of the flow, from 0
    present: bool = False  # in the scene as it stands
    by_hand: bool = True  # a key says it, so that nothing else decides
    on: bool = False  # in the run
    tried_in: bool = False  # in the pilots that it is compared with
    influence: float | None = None  # largest change of an answer without it (or with it), over the answer's range
    answer: str = ""
    processor: float | None = None  # of its pilot over that of the whole scene's
    why: str = ""
    folder: str = "."  # where files of materials are looked for


def plain(groups) -> dict[str, list[dict]]:
    """A scene of f90nml as dictionaries."""
    names = dict.fromkeys(str(name) for name in groups.keys())
    return {
        name: [dict(one) for one in (groups[name] if isinstance(groups[name], list) else [groups[name]])]
        for name in names
    }


def write_scene(scene, path, folder):
    """A scene as a file; files that it names are seen from `folder`."""
    lines = []
    for name, groups in scene.items():
        for group in groups:
            words = []
            for key, value in group.items():
                if key in ("file", "library") and (pathlib.Path(folder) / str(value)).exists():
                    value = str((pathlib.Path(folder) / str(value)).resolve())
                words.append(
                    f"   {key} = " + ", ".join(_word(x) for x in (value if isinstance(value, list) else [value]))
                )
            lines += [f"&{name}", *words, "/"]
    pathlib.Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def _word(value):
    if isinstance(value, bool):
        return "'yes'" if value else "'no'"
    return repr(value) if not isinstance(value, str) else "'" + value + "'"


def one(scene):
    return scene["scene"][0]


def fields(scene) -> int:
    return FIELDS.index(one(scene).get("fields", "u").lower())


def many(scene, name):
    return scene.get(name, [])


def derives(scene):
    return str(one(scene).get("effects", "given")).lower() == "auto"


def holds_water(scene):
    return any(r.get("permeability") or r.get("drainage") in ("drained", "undrained") for r in many(scene, "region"))


def settled(scene):
    """What no key says, in its cheapest reading, unless something in the scene asks for more."""
    scene = copy.deepcopy(scene)
    auto = derives(scene)
    if auto and "fields" not in one(scene):
        level = int(holds_water(scene))
        if any(r.get("retention") for r in many(scene, "region")):
            level = 2
        one(scene)["fields"] = FIELDS[level]
    if auto and "gravity" not in one(scene) and weight_is_asked(scene):
        one(scene)["gravity"] = EARTH
    for i, stage in enumerate(many(scene, "stage")):
        if "analysis" not in stage:
            stage["analysis"] = "dynamic" if needs_inertia(scene, i) else "quasi_static"
    for word in _list(one(scene).get("without", [])):
        if word not in KINDS:
            raise InputError(f"without = '{word}': there is no such effect; there are {', '.join(KINDS)}")
        for stage in range(len(many(scene, "stage")) if word == "inertia" else 1):
            why = switch(scene, Effect(word, word, stage), False)
            if why:
                raise InputError(f"without = '{word}': {why}")
    for key in OF_STUDY:
        one(scene).pop(key, None)
    return scene


def weight_is_asked(scene):
    return any(i.get("stress") == "geostatic" for i in many(scene, "initial")) or any(
        p.get("weight") == "yes" for p in many(scene, "plate")
    )


def needs_inertia(scene, stage):
    """Whether a stage has keys that act with inertia alone."""
    name = many(scene, "stage")[stage]["name"]
    acts = lambda group: not group.get("stages") or name in _list(group["stages"])  # noqa: E731
    moving = stage == 0 and any(i.get("v_z") or i.get("wave") for i in many(scene, "initial"))
    return bool(
        moving
        or any(r.get("damping") or r.get("stiffness_damping") for r in many(scene, "region"))
        or any(acts(a) for a in many(scene, "absorbing"))
        or any(f.get("motion") == "acceleration" and acts(f) for f in many(scene, "fix"))
    )


def list_effects(scene, folder) -> list[Effect]:
    """The effects of a scene: present or not, said by a key or left open. What has no meaning has no row."""
    read = settled(scene)
    rows = []
    for kind in KINDS:
        for i, stage in enumerate(many(scene, "stage") if kind == "inertia" else [None]):
            may_move = any(s.get("analysis", "dynamic") == "dynamic" for s in many(scene, "stage")) or any(
                s["analysis"] == "dynamic" for s in many(read, "stage")
            )
            if not has_meaning(read, kind, may_move, folder):
                continue
            if kind == "inertia" and many(read, "stage")[i]["analysis"] == "static":
                continue
            name = f"inertia in {stage['name']}" if kind == "inertia" else kind
            there = is_present(read, kind, i, folder)
            rows.append(Effect(kind, name, i, there, not is_open(scene, kind, i), there, folder=folder))
    if derives(scene) and fields(read) > 0 and len(many(scene, "region")) > 1:
        rows += [
            Effect("flow", f"flow in {r.get('group', '')}", i, True, False, True)
            for i, r in enumerate(many(scene, "region"))
            if "drainage" not in r
        ]
    return rows


def has_meaning(scene, kind, may_move, folder):
    if kind == "relative_acceleration":
        return fields(scene) > 0 and may_move
    if kind == "p_w":
        return holds_water(scene)
    if kind == "p_c":
        return any(r.get("retention") for r in many(scene, "region"))
    if kind == "contact":
        return bool(many(scene, "contact"))
    if kind == "contact_drainage":
        return bool(many(scene, "contact")) and fields(scene) > 0
    if kind == "absorbing":
        return bool(many(scene, "absorbing"))
    if kind in ("damping", "seepage_face", "friction", "strength", "void_ratio_in_retention"):
        return is_present(scene, kind, 0, folder)
    if kind in ("hysteresis", "bonding"):
        return bool(many(scene, "mud")) and fields(scene) == 2
    if kind in MUD:
        return bool(many(scene, "mud"))
    return True


def is_present(scene, kind, stage, folder) -> bool:
    if kind == "inertia":
        return many(scene, "stage")[stage]["analysis"] == "dynamic"
    if kind == "relative_acceleration":
        return one(scene).get("seepage_inertia") == "yes"
    if kind in ("p_w", "p_c"):
        return fields(scene) >= (1 if kind == "p_w" else 2)
    if kind == "gravity":
        return one(scene).get("gravity", 0) > 0
    if kind in ("contact", "absorbing", "strength"):
        return bool(many(scene, kind))
    if kind == "damping":
        return any(r.get("damping") or r.get("stiffness_damping") for r in many(scene, "region"))
    if kind == "contact_drainage":
        return any(c.get("drainage") == "state" for c in many(scene, "contact"))
    if kind == "seepage_face":
        return fields(scene) > 0 and (
            any(f.get("kind") == "seepage" for f in many(scene, "fix"))
            or any(x.get("kind") == "rain" for x in many(scene, "load"))
        )
    if kind == "friction":
        return any(c.get("friction") or c.get("cohesion") for c in many(scene, "contact"))
    if kind == "void_ratio_in_retention":
        return fields(scene) == 2 and any(parameter_of(m, "Omega", folder) > 0 for m in many(scene, "mud"))
    return any(parameter_of(m, MUD[kind], folder) > 0 for m in many(scene, "mud"))


def is_open(scene, kind, stage) -> bool:
    """Whether no key says it."""
    if kind in _list(one(scene).get("without", [])):
        return False
    if kind == "inertia":
        return "analysis" not in many(scene, "stage")[stage]
    auto = derives(scene)
    if kind == "relative_acceleration":
        return auto and "seepage_inertia" not in one(scene)
    if kind in ("p_w", "p_c"):
        return auto and "fields" not in one(scene)
    if kind == "gravity":
        return auto and not (set(one(scene)) & {"gravity", "gravity_history"})
    if kind in MUD:
        return auto and not any(MUD[kind].lower() in m for m in many(scene, "mud"))
    return False


def switch(scene, effect, on) -> str:
    """Takes an effect out of a settled scene, or puts it in; why it cannot be, or nothing."""
    kind, regions = effect.kind, many(scene, "region")
    if kind == "inertia":
        many(scene, "stage")[effect.at]["analysis"] = "dynamic" if on else "quasi_static"
        if not any(s["analysis"] == "dynamic" for s in many(scene, "stage")):
            one(scene).pop("seepage_inertia", None)
    elif kind == "relative_acceleration":
        one(scene)["seepage_inertia"] = "yes" if on else "no"
    elif kind == "p_w" and on:
        if any(not r.get("permeability") and r.get("drainage", "coupled") == "coupled" for r in regions):
            return "a region has no permeability"
        one(scene)["fields"] = FIELDS[max(1, fields(scene))]
    elif kind == "p_w":
        _drop(scene, ("p_w", "p_c", "p_a"), ("water", "rain", "air"))
        one(scene)["fields"] = "u"
        one(scene).pop("seepage_inertia", None)
        for contact in many(scene, "contact"):
            contact.pop("drainage", None)
        for tie in many(scene, "tie"):
            tie.pop("pressures", None)
    elif kind == "p_c" and on:
        if any(not r.get("retention") and r.get("drainage") != "dry" for r in regions):
            return "a region has no retention"
        if fields(scene) == 0:
            return "it needs p_w"
        one(scene)["fields"] = FIELDS[2]
    elif kind == "p_c":
        held = {(f["group"], f["field"]) for f in many(scene, "fix")}
        for group, field in sorted(held):
            if field == "p_a" and (group, "p_c") in held and (group, "p_w") not in held:
                return f"p_a and p_c of '{group}' prescribe p_w: give p_w and one of these"
        _drop(scene, ("p_c", "p_a"), ("air",))
        one(scene)["fields"] = FIELDS[min(1, fields(scene))]
    elif kind == "gravity":
        if not on and weight_is_asked(scene):
            return "the scene asks for weight: geostatic stress or a heavy plate"
        one(scene)["gravity"] = EARTH if on else 0.0
        if not on:
            one(scene).pop("gravity_history", None)
    elif kind in ("contact", "absorbing", "strength"):
        if not on:
            scene[kind] = []
    elif kind == "damping":
        for region in regions:
            region.pop("damping", None)
            region.pop("stiffness_damping", None)
    elif kind == "contact_drainage":
        for contact in many(scene, "contact"):
            contact["drainage"] = "state" if on else "fixed"
    elif kind == "seepage_face" and not on:
        for fix in many(scene, "fix"):
            if fix.get("kind") == "seepage":
                fix["kind"] = "value"
        for load in many(scene, "load"):
            if load["kind"] == "rain":
                load["kind"] = "water"
                load.pop("ponding", None)
    elif kind == "friction" and not on:
        for contact in many(scene, "contact"):
            contact.pop("friction", None)
            contact.pop("cohesion", None)
    elif kind == "void_ratio_in_retention":
        return _freeze_retention(scene, effect)
    elif kind == "flow":
        regions[effect.at]["drainage"] = "coupled" if on else "drained"
    elif kind in MUD:
        name = MUD[kind]
        value = (1.0 if kind == "hysteresis" else parameters[name].default) if on else 0.0
        for law in many(scene, "mud"):
            law[name.lower()] = value
    return ""


def _drop(scene, dropped_fields, kinds):
    scene["fix"] = [f for f in many(scene, "fix") if f["field"] not in dropped_fields]
    scene["load"] = [x for x in many(scene, "load") if x["kind"] not in kinds]


def _freeze_retention(scene, effect):
    """The retention curve that holds at the initial void ratio, whatever happens to it."""
    for law in many(scene, "mud"):
        omega = parameter_of(law, "Omega", effect.folder)
        if not omega > 0:
            continue
        ratios = {
            r.get("void_ratio", parameter_of(law, "e_0", effect.folder))
            for r in many(scene, "region")
            if r["material"] == law["name"]
        }
        if len(ratios) > 1:
            return f"material {law['name']} has regions of several void ratios"
        for e in ratios:
            law["p_a"] = parameter_of(law, "P_a", effect.folder) * e**-omega
            law["omega"] = 0.0
    return ""


def parameter_of(law, name, folder) -> float:
    """A parameter of a &mud, from the group, its file or the library."""
    value = law.get(name.lower())
    if value is None and "file" in law:
        path = pathlib.Path(folder) / law["file"]
        entries = {k.lower(): v for k, v in read_material(path).items()}
        value = entries.get(name.lower())
    if value is None:
        return parameters[name].default
    return parameters[name].options.get(value, 0.0) if isinstance(value, str) else float(value)


def _list(value):
    return [value] if isinstance(value, str) else list(value)
