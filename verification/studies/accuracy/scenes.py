# SPDX-License-Identifier: MIT
"""Scenes on which told errors are compared with true ones: files of this manual, and texts that are here alone. Where an
answer has a closed form its truth is that, else a finer run."""
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class Scene:
    name: str
    what: str
    file: str = ""             # from the root of the repository
    text: str = ""
    asked: float = 1e-2
    goals: tuple = ()
    duration: float | None = None                      # of its last stage, where that is to be shorter
    exact: dict[str, Callable] = field(default_factory=dict)      # answer: function of time [s]


WALLS = "&fix group = 'left' field = 'u_r' /\n&fix group = 'right' field = 'u_r' /\n&fix group = 'bottom' field = 'u_z' /"
HELD = WALLS + "\n&fix group = 'bottom' field = 'u_r' /"


def listed(values):
    """Numbers of a key, ten a line."""
    return ",\n   ".join(", ".join(f"{x:.8g}" for x in values[i:i + 10]) for i in range(0, len(values), 10))


# Bars: rho = 1.8 Mg/m3, a pulse sin**2 of n points, linear between them.
def bar(length, cells, speed, pulse, duration, points, width=0.4, n=61):
    t = np.linspace(0, pulse, n)
    named = "\n".join(f"&point name = '{name}' r = 0 z = {z} /" for name, z in points.items())
    return f"""&scene name = 'bar' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, {width} r_cells = 1 z = 0, {length} z_cells = {cells} /
&elastic name = 'soil' young = {1.8*speed**2} poisson = 0 /
&region material = 'soil' void_ratio = 0 rho_s = 1.8 /
&history name = 'p' times = {listed(t)} values = {listed(np.sin(np.pi*t/pulse)**2)} /
&stage name = 'wave' analysis = 'dynamic' duration = {duration} /
{WALLS}
&load group = 'top' kind = 'pressure' value = 12 history = 'p' /
{named}
"""


def wave(length, speed, times, values, z, load=12.0):
    """Displacement of a bar under a pressure at its top, by d'Alembert: waves down, back from the base with the other
    sign, and again from the free top."""
    fine = np.unique(np.concatenate([np.linspace(times[0], times[-1], 20001), times]))
    p = np.interp(fine, times, values)
    path = np.r_[0, np.cumsum(0.5*(p[1:] + p[:-1])*np.diff(fine))]

    def travelled(tau):
        return np.where(tau < 0, 0.0, np.interp(tau, fine, path) + np.maximum(tau - fine[-1], 0.0)*p[-1])

    def exact(t):
        u = np.zeros_like(t)
        for k in range(int(speed*t[-1]/length) + 2):
            u += (-1)**k*(travelled(t - ((2*k + 1)*length - z)/speed) - travelled(t - ((2*k + 1)*length + z)/speed))
        return -load/(1.8*speed)*u

    return exact


def pulse_of(length, speed, pulse, z, n=61):
    t = np.linspace(0, pulse, n)
    return wave(length, speed, t, np.sin(np.pi*t/pulse)**2, z)


SUDDEN = f"""&scene name = 'sudden' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 0.2 r_cells = 1 z = 0, 4 z_cells = 16 /
&elastic name = 'soil' young = {1.8*110**2} poisson = 0 /
&region material = 'soil' void_ratio = 0 rho_s = 1.8 /
&history name = 'p' times = 0, 0.01, 9 values = 0, 1, 1 /
&stage name = 'wave' analysis = 'dynamic' duration = 0.3 /
{WALLS}
&load group = 'top' kind = 'pressure' value = 12 history = 'p' /
&point name = 'top' r = 0 z = 4 /
&point name = 'middle' r = 0 z = 2 /
"""

LAYERED = f"""&scene name = 'layered' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 1.2, 9 r_cells = 4, 6 r_ratio = 1, 1.5 z = -7, -0.6, 0 z_cells = 6, 2 z_ratio = 0.8, 1 /
&elastic name = 'stiff' young = 8e5 poisson = 0.2 /
&elastic name = 'soft' young = 9e3 poisson = 0.33 /
&region group = 'block_1_2' material = 'stiff' void_ratio = 0 /
&region group = 'block_2_2' material = 'stiff' void_ratio = 0 /
&region material = 'soft' void_ratio = 0 /
&stage name = 'load' analysis = 'static' duration = 1 /
{HELD}
&load group = 'top_1' kind = 'pressure' value = 80 /
&point name = 'centre' r = 0 z = 0 /
&point name = 'aside' r = 2.4 z = 0 /
&point name = 'deep' r = 0 z = -2 /
"""

CONCENTRATED = f"""&scene name = 'concentrated' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 0.012, 6 r_cells = 1, 10 r_ratio = 1, 1.6 z = -6, 0 z_cells = 10 z_ratio = 0.6 /
&elastic name = 'soil' young = 1.2e4 poisson = 0.28 /
&region material = 'soil' void_ratio = 0 /
&stage name = 'load' analysis = 'static' duration = 1 /
{HELD}
&load group = 'top_1' kind = 'pressure' value = 900 /
&point name = 'spot' r = 0 z = 0 /
&point name = 'aside' r = 1.2 z = 0 /
"""

INCOMPRESSIBLE = f"""&scene name = 'incompressible' fields = 'u' /
&mesh r = 0, 1, 6 r_cells = 3, 5 r_ratio = 1, 1.4 z = -5, 0 z_cells = 6 z_ratio = 0.8 /
&elastic name = 'soil' young = 2e4 poisson = 0.4995 /
&region material = 'soil' void_ratio = 0 /
&stage name = 'load' analysis = 'static' duration = 1 /
{HELD}
&load group = 'top_1' kind = 'pressure' value = 60 /
&point name = 'centre' r = 0 z = 0 /
&point name = 'aside' r = 2 z = 0 /
"""

CIRCLE = f"""&scene name = 'circle' fields = 'u-p_w' pressures = '{{pressures}}' /
&mesh r = 0, 1.2, 7 r_cells = 4, 5 r_ratio = 1, 1.5 z = -6.5, 0 z_cells = 8 z_ratio = 0.76 /
&elastic name = 'soil' young = 1.2e4 poisson = 0.22 /
&permeability name = 'k' intrinsic = 1.5e-13 law = 'constant' /
&region material = 'soil' void_ratio = 0.7 permeability = 'k' /
&stage name = 'load' analysis = 'quasi_static' {{stage}} /
{HELD}
&fix group = 'top' field = 'p_w' /
&load group = 'top_1' kind = 'pressure' value = 90 /
&point name = 'centre' r = 0 z = 0 /
&point name = 'deep' r = 0 z = -1.2 /
&point name = 'aside' r = 2.4 z = 0 /
"""

COLUMN = f"""&scene name = 'column' geometry = 'plane_strain' fields = 'u-p_w' /
&mesh r = 0, 0.2 r_cells = 1 z = 0, 2 z_cells = 10 /
&elastic name = 'soil' young = 8e3 poisson = 0.3 /
&fluids k_w = 1e12 /
&permeability name = 'k' intrinsic = 2e-12 law = 'constant' /
&region material = 'soil' void_ratio = 0.7 permeability = 'k' /
&stage name = 'load' analysis = 'quasi_static' duration = 120 {{}} /
{WALLS}
&fix group = 'top' field = 'p_w' /
&load group = 'top' kind = 'pressure' value = 50 /
&point name = 'base' r = 0 z = 0 /
&point name = 'top' r = 0 z = 2 /
"""
OEDOMETER = 8e3*0.7/(1.3*0.4)       # kPa
COEFFICIENT = 2e-12/1e-6*OEDOMETER  # of consolidation [m2/s]


def consolidation(t):
    """Settlement of the column's top, by Terzaghi [m]."""
    m = np.pi/2*(2*np.arange(400)[:, None] + 1)
    return -50/OEDOMETER*2*(1 - np.sum(2/m**2*np.exp(-m**2*COEFFICIENT/4*np.asarray(t)), axis=0))


CONTRAST = f"""&scene name = 'contrast' geometry = 'plane_strain' fields = 'u-p_w' /
&mesh r = 0, 0.2 r_cells = 1 z = 0, 0.8, 1.2, 2 z_cells = 4, 2, 4 /
&elastic name = 'soil' young = 9e3 poisson = 0.28 /
&permeability name = 'k' intrinsic = 1e-11 law = 'constant' /
&permeability name = 'tight' intrinsic = 2e-14 law = 'constant' /
&region group = 'block_1_2' material = 'soil' void_ratio = 0.6 permeability = 'tight' /
&region material = 'soil' void_ratio = 0.7 permeability = 'k' /
&history name = 'h' times = {listed(np.arange(0, 101, 10))} values = 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0 /
&stage name = 'cycles' analysis = 'quasi_static' duration = 100 /
{WALLS}
&fix group = 'top' field = 'p_w' /
&load group = 'top' kind = 'pressure' value = 40 history = 'h' /
&point name = 'base' r = 0 z = 0 /
&point name = 'seam' r = 0 z = 1 /
&point name = 'top' r = 0 z = 2 /
"""

RESONANCE = f"""&scene name = 'resonance' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 0.5 r_cells = 1 z = 0, 5 z_cells = 8 /
&elastic name = 'soil' young = {1.8*100**2} poisson = 0 /
&region material = 'soil' void_ratio = 0 rho_s = 1.8 damping = 0.8 /
&history name = 'sine' times = {listed(np.linspace(0, 2, 401))} values = {listed(np.sin(2*np.pi*5*np.linspace(0, 2, 401)))} /
&stage name = 'shake' analysis = 'dynamic' duration = 2 /
{WALLS}
&load group = 'top' kind = 'pressure' value = 10 history = 'sine' /
&point name = 'top' r = 0 z = 5 /
"""

CYCLES = """&scene name = 'cycles' geometry = 'plane_strain' fields = 'u-p_w' gravity = 9.81 /
&mesh r = 0, 0.5 r_cells = 1 z = -3.5, 0 z_cells = 4 /
&mud name = 'sand' e_0 = 0.78 tangent = 3 /
&permeability name = 'k' intrinsic = 1.5e-12 law = 'constant' /
&region material = 'sand' permeability = 'k' /
&initial p_w_slope = -9.81 stress = 'geostatic' surcharge = 35 k_0 = 0.5 /
&history name = 's' times = 0, 1, 3, 5, 7, 9, 11, 13, 15, 16 values = 0, 1, -1, 1, -1, 1, -1, 1, -1, 0 /
&stage name = 'shear' analysis = 'quasi_static' duration = 16 /
&tie first = 'left' second = 'right' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'top' field = 'p_w' /
&load group = 'top' kind = 'pressure' value = 35 /
&load group = 'top' kind = 'shear_r' value = 5.5 history = 's' /
&point name = 'top' r = 0 z = 0 /
&point name = 'middle' r = 0 z = -1.75 /
&point name = 'base' r = 0 z = -3.5 /
"""

DRAINAGE = f"""&scene name = 'drainage' geometry = 'plane_strain' fields = 'u-p_w-p_c' gravity = 9.81 /
&mesh r = 0, 0.1 r_cells = 1 z = 0, 1.2 z_cells = 12 /
&elastic name = 'soil' young = 6e3 poisson = 0.3 /
&retention name = 'c' law = 'van_genuchten' alpha = 0.22 n = 2.4 /
&permeability name = 'k' intrinsic = 4e-12 law = 'mualem' m = 0.58 floor = 1e-4 /
&region material = 'soil' void_ratio = 0.7 permeability = 'k' retention = 'c' /
&initial p_w = 11.772 p_w_slope = -9.81 {{suction}} stress = 'geostatic' surface = 1.2 k_0 = 0.5 /
&fix group = 'all' field = 'p_a' /
&history name = 'h' times = 0, 50 values = 1, 0 /
&stage name = 'drain' analysis = 'quasi_static' duration = 1.5e4 /
{WALLS}
&fix group = 'bottom' field = 'p_w' value = 11.772 history = 'h' /
&point name = 'top' r = 0 z = 1.2 /
&point name = 'middle' r = 0 z = 0.6 /
"""

LANDING = f"""&scene name = 'landing' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 0.6, 3 r_cells = 3, 4 z = -2.5, 0 z_cells = 5 /
&elastic name = 'soil' young = 1.8e4 poisson = 0.25 /
&region material = 'soil' void_ratio = 0.6 damping = 10 /
&plate name = 'plate' r = 0, 0.6 z = 3e-3 mass = 0.6 /
&initial group = 'plate' v_z = -0.3 /
&contact name = 'face' slave = 'top' master = 'plate' penalty = 1e7 search_radius = 0.5 /
&stage name = 'land' analysis = 'dynamic' duration = 0.05 /
{HELD}
&point name = 'centre' r = 0 z = 0 /
"""

WETTING = """&scene name = 'wetting' geometry = 'plane_strain' fields = 'u-p_w-p_c' gravity = 9.81 /
&mesh r = 0, 0.1 r_cells = 1 z = 0, 0.8 z_cells = 8 /
&mud name = 'sand' e_0 = 0.85 tangent = 3 /
&permeability name = 'k' intrinsic = 2e-12 /
&region material = 'sand' permeability = 'k' retention = 'material' /
&initial p_w = -40 p_c = 40 stress = 'geostatic' surface = 0.8 surcharge = 60 k_0 = 0.5 /
&fix group = 'all' field = 'p_a' /
&history name = 'h' times = 0, 3000 values = 1, 0 /
&stage name = 'wet' analysis = 'quasi_static' duration = 6000 /
""" + WALLS + """
&fix group = 'bottom' field = 'p_w' value = -40 history = 'h' /
&load group = 'top' kind = 'pressure' value = 60 /
&point name = 'top' r = 0 z = 0.8 /
&point name = 'middle' r = 0 z = 0.4 /
"""

FRONT = f"""&scene name = 'front' geometry = 'plane_strain' fields = 'u-p_w-p_c' gravity = 9.81 /
&mesh r = 0, 0.1 r_cells = 1 z = 0, 1 z_cells = 16 /
&elastic name = 'soil' young = 1e4 poisson = 0.3 /
&retention name = 'c' law = 'van_genuchten' alpha = 0.3 n = 2.6 /
&permeability name = 'k' intrinsic = 1e-12 law = 'mualem' m = 0.6 /
&region material = 'soil' void_ratio = 0.7 permeability = 'k' retention = 'c' /
&initial p_w = -30 p_c = 30 stress = 'geostatic' surface = 1 k_0 = 0.5 /
&fix group = 'all' field = 'p_a' /
&stage name = 'rain' analysis = 'quasi_static' duration = 2e4 /
{WALLS}
&load group = 'top' kind = 'water' value = 4e-6 /
&point name = 'upper' r = 0 z = 0.8 /
&point name = 'middle' r = 0 z = 0.5 /
"""

SHAKEN = """&scene name = 'fast' geometry = 'plane_strain' fields = 'u-p_w' gravity = 9.81 /
&mesh r = 0, 0.5 r_cells = 1 z = -4, 0 z_cells = 6 /
&mud name = 'sand' e_0 = 0.75 tangent = 3 /
&permeability name = 'k' intrinsic = 1e-11 law = 'constant' /
&region material = 'sand' permeability = 'k' stiffness_damping = 1e-3 /
&initial p_w_slope = -9.81 stress = 'geostatic' surcharge = 20 k_0 = 0.5 /
&history name = 's' times = 0, 0.05, 0.1, 0.3 values = 0, 1, 0, 0 /
&stage name = 'blow' analysis = 'dynamic' duration = 0.3 /
&tie first = 'left' second = 'right' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'top' field = 'p_w' /
&load group = 'top' kind = 'pressure' value = 20 /
&load group = 'top' kind = 'shear_r' value = 6 history = 's' /
&point name = 'top' r = 0 z = 0 /
&point name = 'middle' r = 0 z = -2 /
"""

SCENES = (
    # In which closed forms are known.
    Scene("short bar", "a pulse of 25 ms in a bar of 8 m", text=bar(8, 16, 90, 0.025, 0.3, {"top": 8, "middle": 4}),
          exact={"top.u_z": pulse_of(8, 90, 0.025, 8.0), "middle.u_z": pulse_of(8, 90, 0.025, 4.0)}),
    Scene("long bar", "a pulse of 60 ms after 45 m", text=bar(50, 100, 120, 0.06, 0.6, {"deep": 5}), asked=0.1,
          exact={"deep.u_z": pulse_of(50, 120, 0.06, 5.0)}),
    Scene("sudden bar", "a bar under a load within 10 ms, two periods", text=SUDDEN, asked=0.1,
          exact={f"{n}.u_z": wave(4, 110, np.array([0, 0.01, 9]), np.array([0, 1.0, 1.0]), z)
                 for n, z in (("top", 4.0), ("middle", 2.0))}),
    Scene("column", "consolidation under a sudden load", text=COLUMN.format(""), goals=("top.u_z",),
          exact={"top.u_z": consolidation}),
    Scene("column, given steps", "the same with given steps", text=COLUMN.format("dt = 2 steps = 'given'"),
          goals=("top.u_z",), exact={"top.u_z": consolidation}),
    # Like those on which estimates inside a run had failed.
    Scene("layered strip", "a stiff layer on soft ground", text=LAYERED),
    Scene("point load", "a load on 12 mm", text=CONCENTRATED),
    Scene("incompressible", "a circular load, Poisson's ratio 0.4995", text=INCOMPRESSIBLE),
    Scene("circle", "a sudden circular load on saturated ground",
          text=CIRCLE.format(pressures="linear", stage="duration = 1.5e3")),
    Scene("circle, quadratic", "the same with quadratic pressures, which alternate at first",
          text=CIRCLE.format(pressures="quadratic", stage="duration = 1.5e3")),
    Scene("circle, given steps", "its first moments in given steps, quadratic pressures",
          text=CIRCLE.format(pressures="quadratic", stage="duration = 0.01 dt = 0.002 steps = 'given'")),
    Scene("contrast", "five load cycles on layers whose permeabilities differ by 500", text=CONTRAST, asked=0.1),
    Scene("resonance", "ten cycles at the first frequency", text=RESONANCE),
    Scene("cycles", "four cycles of shear on saturated sand", text=CYCLES, asked=0.1),
    Scene("drainage, capped", "drainage of a column, air held where suction starts at 0",
          text=DRAINAGE.format(suction="p_c = 0")),
    Scene("drainage", "the same where suction starts at equilibrium",
          text=DRAINAGE.format(suction="p_c = -11.772 p_c_slope = 9.81")),
    Scene("landing", "a plate without weight flies on to the ground", text=LANDING, asked=0.1),
    Scene("wetting", "sand that water rises into, three fields", text=WETTING),
    Scene("front", "rain on dry sand, linear pressures", text=FRONT, asked=0.1),
    Scene("blow", "a blow of 0.1 s on saturated sand, dynamic", text=SHAKEN, asked=0.1),
    # Of the pages price and cost.
    *(Scene(name, what, file=f"verification/{file}.nml", asked=asked) for name, file, what, asked in (
        ("terzaghi", "host/terzaghi/scene", "Terzaghi's column", 1e-2),
        ("dynamic consolidation", "host/dynamic_consolidation/scene", "a load on saturated soil, with inertia", 1e-2),
        ("layered site", "host/layered_site/scene", "layers, shaken", 1e-2),
        ("liakopoulos", "host/liakopoulos/scene", "Liakopoulos' column", 1e-2),
        ("rain", "host/seepage_face/rain", "rain that ponds", 1e-2),
        ("waves", "host/waves/column", "shear waves in a column", 1e-2),
        ("waves, layers", "host/waves/layers", "shear waves in layers", 1e-2),
        ("bar, contact", "host/contact/bar", "a bar against a wall", 1e-1),
        ("drain, contact", "host/contact/drain", "a contact that drains", 1e-2),
        ("slope", "studies/price/slope", "drawdown of a slope, mesh of a file", 1e-2),
        ("rain, layers", "studies/price/rain_layers", "rain on two layers", 1e-1),
        ("ring", "studies/price/ring", "water pressed into a hole, mesh of a file", 3e-2),
        ("shaken sand", "studies/price/shaken", "sand shaken at its base", 1e-1),
        ("strip", "studies/price/strip", "a strip on elastic ground", 1e-2),
        ("dropped plate", "studies/cost/scenes/drop", "a plate that falls and bounces", 1e-1),
        ("footing", "studies/cost/scenes/footing", "a flexible footing on sand", 3e-2),
        ("harmonic", "studies/cost/scenes/harmonic", "twenty cycles on a damped layer", 1e-1),
        ("mandel", "studies/cost/scenes/mandel", "Mandel's sample", 1e-2),
        ("push", "studies/cost/scenes/push", "a plate pushed into sand", 1e-1),
        ("five days of rain", "studies/cost/scenes/rain", "rain with a break", 1e-2),
        ("footing, dense", "studies/cost/scenes/sand", "a flexible footing on dense sand", 1e-2),
    )),
    Scene("indentation", "the first 18 ms of the benchmark", file="verification/studies/indentation/indent_s030.nml",
          asked=1e-1, duration=0.018),
)
