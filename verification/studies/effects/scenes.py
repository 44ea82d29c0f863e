# SPDX-License-Identifier: MIT
"""Scenes that a careless choice of effects spoils, and scenes that need few of them, for `mud_study effects`. Every scene
leaves open what it can (`effects = 'auto'`): fields, gravity, inertia and the switches of the material."""
from dataclasses import dataclass

AUTO = "effects = 'auto'"

ELASTIC = "&elastic name = 'soil' young = 1.0e4 poisson = 0.25 /"
WATER = "&permeability name = 'k' intrinsic = {k} law = 'constant' /"
CURVE = "&retention name = 'c' P_a = 5 omega = 0 n = 2 m = 1 /"
SAND = "&mud name = 'soil' file = '{materials}/toyoura.nml' tangent = 3 /"
DRAINED = "&fix group = 'top' field = 'p_w' /"
STRESS = "&initial stress = 'uniform' sigma = -{0}, -{0}, -{0} /"


def column(keys="", stage="duration = 10", times="0, 10", values="0, 1", load=10, height=1, cells=8, soil=ELASTIC, laws="",
           region="void_ratio = 0.8", more="", points=(("top", 1.0), ("middle", 0.5)), z=None, z_cells=None):
    """A column under a pressure, smooth walls, base held; z as a share of the height."""
    breaks = z or f"0, {height}"
    named = "\n".join(f"&point name = '{name}' r = 0 z = {share * height} /" for name, share in points)
    pressed = (f"&history name = 'h' times = {times} values = {values} /\n"
               f"&load group = 'top' kind = 'pressure' value = {load} history = 'h' /") if load else ""
    regions = region if "&region" in region else f"&region material = 'soil' {region} /"
    return f"""&scene name = 'column' geometry = 'plane_strain' {AUTO} {keys} /
&mesh r = 0, {height / 10} r_cells = 1 z = {breaks} z_cells = {z_cells or cells} /
{soil}
{laws}
{regions}
&stage name = 'load' {stage} /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
{pressed}
{more}
{named}
"""


def strip(cells):
    """Unsaturated ground under a slow strip load, so many cells along every axis: inertia, fields and weight are open."""
    return f"""&scene name = 'strip' geometry = 'plane_strain' effects = 'auto' gravity = 0 step_tolerance = 1e-2 /
&mesh r = 0, 4 r_cells = {cells} z = -4, 0 z_cells = {cells} /
&elastic name = 'soil' young = 1e4 poisson = 0.25 /
&retention name = 'c' P_a = 5 omega = 0 n = 2 m = 1 /
&permeability name = 'k' intrinsic = 1e-12 law = 'constant' /
&region material = 'soil' void_ratio = 0.6 permeability = 'k' retention = 'c' /
&history name = 'h' times = 0, 100 values = 0, 1 /
&stage name = 'load' duration = 2000 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_w' /
&fix group = 'top' field = 'p_a' /
&load group = 'top' kind = 'pressure' value = 10 history = 'h' /
&point name = 'centre' r = 0 z = 0 /
&point name = 'deep' r = 0 z = -1 /
"""


CANTILEVER = f"""&scene name = 'cantilever' geometry = 'plane_strain' {AUTO} /
&mesh r = 0, 10 r_cells = 40 z = -0.1, 0.1 z_cells = 2 /
&elastic name = 'soil' young = 3.0e7 poisson = 0.2 /
&region material = 'soil' void_ratio = 0.01 rho_s = 2.4 /
&stage name = 'load' analysis = 'quasi_static' duration = 10 dt = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'left' field = 'u_z' /
&history name = 'h' times = 0, 10 values = 0, 1 /
&load group = 'right' kind = 'pressure' value = 600 history = 'h' /
&point name = 'tip' r = 10 z = 0 /
"""

SLAB = f"""&scene name = 'slab' geometry = 'plane_strain' {AUTO} gravity = 0 /
&mesh r = 0, 2 r_cells = 12 z = 0, 0.2 z_cells = 3 /
&elastic name = 'soil' young = 2.0e5 poisson = 0.25 /
&retention name = 'c' P_a = 5 omega = 0 n = 2 m = 1 /
&permeability name = 'k' intrinsic = 1.0e-14 /
&region material = 'soil' void_ratio = 0.8 retention = 'c' permeability = 'k' /
&initial p_w = -1 p_c = 1 /
&fix group = 'top' field = 'p_a' /
&stage name = 'load' analysis = 'quasi_static' duration = 1 dt = 0.02 tolerance = 1e-4 /
&fix group = 'left' field = 'u_r' /
&fix group = 'left' field = 'u_z' /
&fix group = 'right' field = 'u_r' /
&history name = 'h' times = 0, 1 values = 0, 1 /
&load group = 'top' kind = 'pressure' value = 20 history = 'h' /
&point name = 'middle_top' r = 2 z = 0.2 /
&point name = 'clamp_top' r = 0.1667 z = 0.2 /
"""

DILATANCY = f"""&scene name = 'dilatancy' geometry = 'plane_strain' {AUTO} gravity = 0 step_tolerance = 1e-2 /
&mesh r = 0, 0.5 r_cells = 1 z = 0, 1 z_cells = 1 /
{SAND}
{WATER.format(k="1e-12")}
&region material = 'soil' void_ratio = 0.65 retention = 'material' permeability = 'k' /
{STRESS.format(50)}
&stage name = 'push' analysis = 'quasi_static' duration = 100 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'all' field = 'p_a' /
&load group = 'right' kind = 'pressure' value = 50 /
&history name = 'h' times = 0, 100 values = 0, 1 /
&fix group = 'top' field = 'u_z' value = -0.04 history = 'h' /
&point name = 'side' r = 0.5 z = 0.5 /
"""

# To be filled: keys of &scene, of the region farthest away, of the stage, more groups.
PLOTS = """&scene name = 'plots' geometry = 'plane_strain' {0} fields = 'u-p_w' pressures = 'quadratic' gravity = 0 /
&mesh r = 0, 1, 3, 6 r_cells = 4, 4, 3 z = -1, 0 z_cells = 4 /
&elastic name = 'soil' young = 1e4 poisson = 0.25 /
&permeability name = 'k' intrinsic = 1e-11 law = 'constant' /
&region group = 'block_1_1' material = 'soil' void_ratio = 0.8 permeability = 'k' /
&region group = 'block_2_1' material = 'soil' void_ratio = 0.8 permeability = 'k' drainage = 'coupled' /
&region group = 'block_3_1' material = 'soil' void_ratio = 0.8 {1} /
&stage name = 'load' {2} /
&history name = 'h' times = 0, 0.5 values = 0, 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top_1' field = 'p_w' /
&load group = 'top_1' kind = 'pressure' value = 100 history = 'h' /
&point name = 'top' r = 0 z = 0 /
&point name = 'base' r = 0 z = -1 /
{3}
"""


@dataclass(frozen=True)
class Scene:
    name: str
    what: str               # what misleads
    text: str
    keeps: tuple = ()       # effects that matter
    careless: tuple = ()    # a choice that a hurried user may make
    drops: tuple = ()       # effects that auto should let go


TRAPS = (
    Scene("cantilever", "600 kPa along a slender beam hide its weight of some kPa, which bends it", CANTILEVER,
          ("gravity",), ("gravity",)),
    Scene("clamped slab", "20 kPa of load look harmless for saturated soil; bending makes many times as much suction", SLAB,
          ("p_c",), ("p_c",)),
    Scene("pulse", "a pulse of 5 ms that is over before the end",
          column("gravity = 0 step_tolerance = 1e-2", "duration = 0.1", "0, 0.0025, 0.005", "0, 1, 0"), ("inertia in load",), ("inertia",)),
    Scene("jump in a slow load", "20 s of slow load with one step of 2 ms in it",
          column("gravity = 0 step_tolerance = 1e-2", "duration = 0.4", "0, 0.2, 0.202, 0.4", "0, 0.2, 0.8, 1"),
          ("inertia in load",), ("inertia",)),
    Scene("late load", "nothing happens for nine tenths of the time, then 0.1 s of load on soil that drains in some seconds",
          column("gravity = 0 step_tolerance = 1e-2", "analysis = 'quasi_static' duration = 10", "0, 9.5, 9.6", "0, 0, 1",
                 laws=WATER.format(k="1e-11"), region="void_ratio = 0.8 permeability = 'k'", more=DRAINED), ("p_w",), ("p_w",)),
    Scene("stiff layer that hides seepage", "a stiff cap settles at once and is watertight: what it rests on takes its time",
          column("gravity = 0 step_tolerance = 1e-2", "analysis = 'quasi_static' duration = 100", "0, 1", "0, 1", z="0, 0.8, 1",
                 z_cells="6, 2",
                 soil=ELASTIC + "\n&elastic name = 'cap' young = 1.0e6 poisson = 0.25 /",
                 laws=WATER.format(k="1e-11") + "\n&permeability name = 'tight' intrinsic = 1e-14 law = 'constant' /",
                 region="&region material = 'soil' void_ratio = 0.8 permeability = 'k' /\n"
                        "&region group = 'block_1_2' material = 'cap' void_ratio = 0.3 permeability = 'tight' /",
                 more=DRAINED), ("p_w",), ("p_w",)),
    Scene("wetting collapse", "no load changes; the suction of 100 kPa that holds loose sand goes within a day",
          column("gravity = 0 step_tolerance = 1e-2", "analysis = 'quasi_static' duration = 86400", load=282.08, times="0, 1",
                 values="1, 1", cells=1, soil=SAND, laws=WATER.format(k="1e-11"),
                 region="void_ratio = 0.9 retention = 'material' permeability = 'k'",
                 more=STRESS.format(300) + "\n&initial p_w = -100 p_c = 100 /\n&history name = 'w' times = 0, 86400 values = 1, 0 /\n"
                      "&fix group = 'all' field = 'p_a' /\n&fix group = 'all' field = 'p_w' value = -100 history = 'w' /"),
          ("p_c",), ("p_c",), ("fabric", "lode")),
    Scene("weight on weak sand", "a load of 5 kPa on sand whose stiffness comes from its own weight",
          column("step_tolerance = 1e-2", "analysis = 'quasi_static' duration = 10", load=5, height=4, soil=SAND, cells=4,
                 more="&initial stress = 'uniform' sigma = -5, -5, -5 /\n&load group = 'top' kind = 'pressure' value = 5 /"),
          ("gravity",), ("gravity",), ("fabric", "lode")),
    Scene("fast load on saturated soil", "a load within 0.5 s on soil that drains in 10 s",
          column("gravity = 0 step_tolerance = 1e-2", "duration = 1", "0, 0.5", "0, 1", laws=WATER.format(k="1e-11"),
                 region="void_ratio = 0.8 permeability = 'k'", more=DRAINED), ("p_w",), ("p_w",), ("inertia in load",)),
    Scene("suction from dilatancy", "sealed saturated sand that is pushed: at first its pressure rises, then dilatancy desaturates it; "
          "without p_c the water pulls with 240 kPa and the sand carries four times as much", DILATANCY,
          ("p_w", "p_c", "lode"), ("p_c",), ("fabric",)),
    Scene("two weak ones together", "weight and inertia change little, each alone; the tolerance is that of the scene, 4 %",
          column("step_tolerance = 1e-2", "duration = 2", "0, 1", "0, 1", load=200),
          (), ("gravity", "inertia")),
)

EASY = (
    Scene("slow ramp", "10 kPa within 10 s on a drained elastic column without weight",
          column("gravity = 0 step_tolerance = 1e-2"), drops=("inertia in load",)),
    Scene("slow ramp, wet", "10 kPa within 1000 s on saturated soil that drains in a second",
          column("gravity = 0 step_tolerance = 1e-2", "duration = 1000", "0, 1000", laws=WATER.format(k="1e-10") + "\n" + CURVE,
                 region="void_ratio = 0.8 permeability = 'k' retention = 'c'", more=DRAINED + "\n&fix group = 'top' field = 'p_a' /"),
          drops=("inertia in load", "p_w", "p_c")),
    Scene("slow ramp, saturated", "10 kPa within 1000 s on soil that drains in a second and has no suction",
          column("gravity = 0 step_tolerance = 1e-2", "duration = 1000", "0, 1000", laws=WATER.format(k="1e-10"),
                 region="void_ratio = 0.8 permeability = 'k'", more=DRAINED), drops=("inertia in load", "p_w")),
    Scene("thin sheet", "10 kPa on a millimetre of soil",
          column("step_tolerance = 1e-2", "analysis = 'quasi_static' duration = 10", height=0.001), drops=("gravity",)),
    Scene("consolidation", "a load within a second on soil that drains in 100 s",
          column("gravity = 0 step_tolerance = 1e-2", "duration = 200", "0, 1", "0, 1", laws=WATER.format(k="1e-12") + "\n" + CURVE,
                 region="void_ratio = 0.8 permeability = 'k' retention = 'c'", more=DRAINED + "\n&fix group = 'top' field = 'p_a' /"),
          drops=("inertia in load", "p_c")),
    Scene("far soil", "100 kPa within half a second on one metre of a layer whose farthest half hears nothing of it",
          PLOTS.format(AUTO, "permeability = 'k'", "analysis = 'quasi_static' duration = 2 dt = 0.02", ""),
          drops=("flow in block_3_1",)),
)
