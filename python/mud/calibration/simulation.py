# SPDX-License-Identifier: MIT
"""The response of the model to a laboratory test, at the rows of the laboratory."""

from __future__ import annotations

import dataclasses

import numpy as np

from ..element_test import Stage, TestResult, element_test
from ..errors import InputError, MudError, TestStopped
from ..material import Material
from ..registry import states
from .tables import FEWEST_ROWS, LaboratoryTest

# Numerical settings of a fit: errors of 1e-4 are far below the scatter of any laboratory (percents).
SETTINGS = {"scheme": 2, "tolerance": 1e-4, "tangent": "continuum", "max_substeps": 1000}
CONTROL_TOLERANCE = 1e-5
MAX_UPDATES = 3000  # a usual test needs 100 to 300; a hopeless set of parameters could take minutes
CYCLE_UPDATES = 1000  # of each cycle
# Shear: increments up to a natural strain. The model is interpolated between them, to less than 1 % of q.
STRAIN_INCREMENTS = ((0.01, 1e-3), (0.05, 2.5e-3), (1.0, 1e-2))
# Compression: a stage for each factor of stress, in equal increments; void ratio is interpolated over the logarithm of stress.
STRESS_FACTOR, STRESS_INCREMENTS = 2.0, 3
CYCLE_STEPS = 20  # of a strain amplitude
LOOP_STEPS = 40  # of an amplitude whose loop is measured
LIQUEFIED, MORE_CYCLES = 0.95, 4.0  # pore pressure ratio; cycles that are tried, times those of the laboratory
SETTLED = 10.0  # [kPa] compression counts from here on where a table begins below: before, a sample settles into its ring
_SATURATION = states["saturation"].index
ROUNDING = 1e-9  # of a strain, relative
FAR = 1e6  # output interval that leaves rows at reversals and ends of stages alone


@dataclasses.dataclass
class Answer:
    """The model at the used rows of a test: columns as in the laboratory, NaN behind the point where it stopped."""

    columns: dict[str, np.ndarray]
    stopped: str = ""  #: the driver's sentence, empty if the test came to its end


@dataclasses.dataclass
class Use:
    """Which rows of a test count, and what is compared with which scatter."""

    rows: np.ndarray  #: row numbers that are compared, in their order
    start: int  #: row at which the model starts
    scatter: dict[str, tuple[float, float]]  #: quantity -> (absolute, share of the value): standard deviation
    note: str = ""  #: what was left out without being asked for
    turning: bool = False  #: of retention: the suction turns among these rows, so that they tell the scanning curves


# Standard deviation of what a laboratory measures: (absolute, as a share of the value). Stresses in kPa. Void ratio in
# compression: its change since the start, which is given; a dial gauge tells 0.01 mm of a sample of 20 mm, 0.001 of void ratio.
SCATTER = {
    "drained": {"q": (3.0, 0.05), "eps_v": (0.0025, 0.0)},
    "undrained": {"q": (3.0, 0.05), "p": (3.0, 0.05)},
    "oedometer": {"e": (0.0015, 0.0), "sigma_r": (3.0, 0.1)},
    "isotropic": {"e": (0.0015, 0.0)},
    "cyclic": {"eps_v": (0.001, 0.1), "r_u": (0.05, 0.1)},
    "retention": {"S_w": (0.02, 0.0)},
    "stiffness": {"G_max": (0.0, 0.1)},
    "modulus": {"G_ratio": (0.05, 0.0), "damping": (0.03, 0.0)},
    "liquefaction": {"log_N": (0.15, 0.0)},  # a factor of 1.4 in the number of cycles
}


def use_of(
    test: LaboratoryTest,
    first: float | None = None,
    last: float | None = None,
    scatter: dict[str, tuple[float, float]] | None = None,
    branch: str = "all",
) -> Use:
    """Rows of a test that count: those whose leading quantity (eps_a, sigma_a, p, cycle, suction) lies in [first, last].

    A test that is led by stress starts at its first used row, one led by strain at its first row. Without ``first``
    compression counts from SETTLED on, where enough rows lie above it. branch : of a retention
    curve, "drying" (suction at its largest so far), "wetting" (behind the largest suction) or "all".
    """
    lead = test[
        {
            "drained": "eps_a",
            "undrained": "eps_a",
            "oedometer": "sigma_a",
            "isotropic": "p",
            "cyclic": "cycle",
            "retention": "suction",
            "stiffness": "p",
            "modulus": "gamma",
            "liquefaction": "csr",
        }[test.kind]
    ]
    if test.kind in ("drained", "undrained", "modulus") and max(first or 0.0, last or 0.0) > 1:
        raise InputError(f"first and last of a {test.kind} test are strains as fractions, not in per cent")
    size, note = np.abs(lead), ""
    by_stress = test.kind in ("oedometer", "isotropic")
    if by_stress and first is None and size[0] < SETTLED and np.sum(size >= SETTLED) >= FEWEST_ROWS[test.kind]:
        first = SETTLED
        note = f"rows below {SETTLED:g} kPa do not count: the sample settles there (first = ... says otherwise)"
    used = (size >= (0 if first is None else first)) & (size <= (np.inf if last is None else last))
    if by_stress:
        used &= size > 0
    start = int(np.argmax(used)) if by_stress else 0
    if test.kind in ("drained", "undrained", "oedometer", "isotropic"):
        used[start] = False  # where the model starts is given
    if test.kind == "retention" and branch != "all":
        grows = lead >= np.maximum.accumulate(lead)
        used &= grows if branch == "drying" else np.arange(len(lead)) > np.argmax(lead)
    if used.sum() < 1:
        raise InputError(f"{test.source}, test {test.name}: no row between {first} and {last}")
    quantities = {q: s for q, s in {**SCATTER[test.kind], **(scatter or {})}.items() if q in test}
    turning = test.kind == "retention" and {-1.0, 1.0} <= set(np.sign(np.diff(lead[used])).tolist())
    return Use(np.flatnonzero(used), start, quantities, note, turning)


def simulate(material: Material, test: LaboratoryTest, use: Use) -> Answer:
    """Runs a test on the model. A test that stops has NaN from there on, and says why."""
    if test.kind in _SINGLE:
        try:
            return _SINGLE[test.kind](material, test, use.rows)
        except MudError as problem:
            return Answer({q: np.full(len(use.rows), np.nan) for q in use.scatter}, str(problem))
    try:
        result, stopped = _run(material, test, *_course(material, test, use))
    except MudError as problem:
        return Answer({q: np.full(len(use.rows), np.nan) for q in use.scatter}, str(problem))
    return Answer(_at_rows(test, use, result), stopped)


def loops(material: Material, test: LaboratoryTest, use: Use) -> TestResult:
    """The whole path of a cyclic test, also of one that stops. Raises ``MudError`` where it cannot begin."""
    (stage,), start = _course(material, test, use)
    stage = Stage(stage.control, **{**stage.keys, "output_interval": stage.keys["increment"]})
    return _run(material, test, [stage], start)[0]


def _run(material: Material, test: LaboratoryTest, stages: list[Stage], start: dict) -> tuple[TestResult, str]:
    """The result of stages, as far as they come, and the driver's sentence where they stop."""
    most = int(CYCLE_UPDATES * test["cycle"].max()) if test.kind == "cyclic" else MAX_UPDATES
    try:
        return element_test(material, *stages, control_tolerance=CONTROL_TOLERANCE, max_updates=most, **start), ""
    except TestStopped as problem:
        return problem.result, str(problem)


def _retention(material: Material, test: LaboratoryTest, rows: np.ndarray) -> Answer:
    """S_w at the rows; with hysteresis along the whole path of suction from the first row on, at constant volume."""
    e = test["e"] if "e" in test else test["e_0"] if "e_0" in test else np.full(len(test.lines), material["e_0"])
    if material["hysteresis"] == 0:
        return Answer({"S_w": material.saturation(test["suction"][rows], e[rows])})
    stress = np.array([-1.0, -1.0, -1.0, 0.0, 0.0, 0.0]) * material["p_atm"]
    stress, state = material.initial_state(stress, float(test["suction"][0]), float(e[0]))
    found = []
    for row in range(int(rows.max()) + 1):
        if row:
            answer = material.update(stress, state, np.zeros(6), float(test["suction"][row]))
            stress, state = answer.stress, answer.statev
        found.append(float(state[_SATURATION]))
    return Answer({"S_w": np.array(found)[rows]})


def shear_modulus(material: Material, p: float, e: float) -> float:
    """Elastic shear modulus at a mean effective stress [kPa] and a void ratio, of the library's own stiffness."""
    stress, state = material.initial_state(-p * np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]), 0.0, e)
    return float(material.update(stress, state, np.zeros(6), tangent="elastic").dsig_deps[3, 3])


def _stiffness(material: Material, test: LaboratoryTest, rows: np.ndarray) -> Answer:
    """G_max of every row."""
    return Answer({"G_max": np.array([shear_modulus(material, test["p"][r], test["e"][r]) for r in rows])})


def _modulus(material: Material, test: LaboratoryTest, rows: np.ndarray) -> Answer:
    """Secant modulus over G_max and damping of the second cycle of drained simple shear, from an isotropic stress."""
    ratio, damping = np.empty(len(rows)), np.empty(len(rows))
    for k, r in enumerate(rows):
        gamma, p, e = float(test["gamma"][r]), float(test["p_0"][r]), float(test["e_0"][r])
        increment = gamma / LOOP_STEPS
        stage = Stage(
            "simple_shear_drained", cycle_by="gamma", amplitude=gamma, cycles=2, increment=increment, output_interval=increment
        )
        run = element_test(
            material, stage, p_eff=p, void_ratio=e, control_tolerance=CONTROL_TOLERANCE, max_updates=MAX_UPDATES
        )
        strain, stress = run["gamma_13"], run["sig_13"]
        ends = np.flatnonzero(strain < -gamma * (1 - 1e-6))  # twice at -gamma: a loop lies between them
        loop = slice(int(ends[0]), int(ends[-1]) + 1)
        x, y = strain[loop], stress[loop]
        secant = (y[np.argmax(x)] - y[0]) / (2 * gamma)
        # Area by trapezia, closed from the last to the first point; of the elastic triangle W = G gamma^2/2.
        area = float(np.sum(0.5 * (x[1:] - x[:-1]) * (y[1:] + y[:-1])) + 0.5 * (x[0] - x[-1]) * (y[0] + y[-1]))
        ratio[k], damping[k] = secant / shear_modulus(material, p, e), abs(area) / (2 * np.pi * secant * gamma**2)
    return Answer({"G_ratio": ratio, "damping": damping})


def _liquefaction(material: Material, test: LaboratoryTest, rows: np.ndarray) -> Answer:
    """log10 of the cycles to r_u = LIQUEFIED in undrained triaxial cycles of q = 2 csr p_0; a sample that stands more than
    MORE_CYCLES times as many as that of the laboratory counts as standing so many."""
    found = np.empty(len(rows))
    for k, r in enumerate(rows):
        cycles = int(np.ceil(MORE_CYCLES * test["N"][r])) + 1
        stage = Stage(
            "undrained",
            cycle_by="q",
            amplitude=2 * float(test["csr"][r] * test["p_0"][r]),
            cycles=cycles,
            stop_r_u=LIQUEFIED,
            increment=1e-4,
            output_interval=FAR,
        )
        try:
            run = element_test(
                material,
                stage,
                p_eff=float(test["p_0"][r]),
                void_ratio=float(test["e_0"][r]),
                control_tolerance=CONTROL_TOLERANCE,
                max_updates=CYCLE_UPDATES * cycles,
            )
            number = run["cycle"][-1]
        except TestStopped as problem:  # the stress is not reached any more: it has failed in the cycle after the last row
            number = 1 + (len(problem.result["cycle"]) - 1) // 2  # behind the start the rows are reversals, two a cycle
        found[k] = np.log10(max(1.0, float(number)))
    return Answer({"log_N": found})


# Kinds whose rows are points or tests of their own.
_SINGLE = {"retention": _retention, "stiffness": _stiffness, "modulus": _modulus, "liquefaction": _liquefaction}


def natural(strain: np.ndarray) -> np.ndarray:
    """Natural axial strain of a linear one, -ln(1 - eps): heights of the sample at that moment."""
    return -np.log1p(-strain)


def earth_pressure(material: Material) -> float:
    """Jaky's K0 = 1 - sin(phi_c) with sin(phi_c) = 3 M_c/(6 + M_c): lateral stress of a sample that was poured."""
    return 1 - 3 * material["M_c"] / (6 + material["M_c"])


def _course(material: Material, test: LaboratoryTest, use: Use) -> tuple[list[Stage], dict]:
    """Stages and start of a test."""
    if test.kind == "cyclic":
        by, amplitude = test.cycle_by, float(test["amplitude"][0])
        step = amplitude / CYCLE_STEPS if by in ("eps_a", "gamma") else 1e-4
        stage = Stage(
            test.control,
            cycle_by=by,
            amplitude=amplitude,
            cycles=int(test["cycle"].max()),
            increment=abs(step),
            output_interval=FAR,
        )
        return [stage], {"p_eff": float(test["p_0"][0]), "void_ratio": test.e_0, "suction": test.suction}
    if test.kind in ("oedometer", "isotropic"):
        name = "sigma_a" if test.kind == "oedometer" else "p"
        stresses = test[name][np.concatenate([[use.start], use.rows])]
        stages = [
            Stage(
                test.kind,
                **{f"{name}_end": float(b)},
                stress="effective",
                increment=abs(b - a) / STRESS_INCREMENTS,
                output_interval=abs(b - a) / STRESS_INCREMENTS,
            )
            for turn, end in zip(*turns(stresses))
            for a, b in _pieces(float(stresses[turn]), float(stresses[end]))
        ]
        first = float(stresses[0])
        lateral = float(test["sigma_r"][use.start]) if "sigma_r" in test else earth_pressure(material) * first
        start = (
            {"sigma_a": first, "sigma_r": lateral}
            if test.kind == "oedometer"
            else {"p_eff": first}
        )
        return stages, {**start, "void_ratio": float(test["e"][use.start]), "suction": test.suction}
    last = float(natural(test["eps_a"][use.rows[-1]]))
    ends = [end for end, _ in STRAIN_INCREMENTS if end < abs(last)] + [abs(last)]
    stages = [
        Stage(test.kind, eps_a_end=float(np.copysign(end, last)), increment=step, output_interval=step)
        for end, (_, step) in zip(ends, STRAIN_INCREMENTS)
    ]
    radial, q = test.start_of_shear()
    start = {"sigma_a": radial + q, "sigma_r": radial} if q else {"p_eff": radial}
    return stages, {**start, "void_ratio": test.e_0, "suction": test.suction}


def turns(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rows at which the branches of a path begin and end."""
    way = np.sign(np.diff(values))
    for i in range(1, len(way)):  # a value that is there twice goes on as before
        way[i] = way[i] or way[i - 1]
    inside = np.flatnonzero(way[1:] * way[:-1] < 0) + 1
    return np.concatenate([[0], inside]), np.concatenate([inside, [len(values) - 1]])


def _pieces(a: float, b: float) -> list[tuple[float, float]]:
    """A way from stress a to b in pieces of at most STRESS_FACTOR."""
    count = max(1, int(np.ceil(abs(np.log(b / a)) / np.log(STRESS_FACTOR))))
    ends = np.geomspace(a, b, count + 1)
    return list(zip(ends[:-1].tolist(), ends[1:].tolist()))


def _at_rows(test: LaboratoryTest, use: Use, result: TestResult) -> dict[str, np.ndarray]:
    """Columns of the model at the used rows, NaN where it did not come."""
    values = {
        "q": result["q"],
        "eps_v": result.volumetric_strain,
        "p": result["p_eff"],
        "e": result["e"],
        "r_u": result["r_u"],
        "sigma_r": result["sigma_r"],
    }
    names = list(dict.fromkeys([*use.scatter, "e", "p", "q"]))
    if test.kind == "cyclic":  # rows: the start, two reversals a cycle, the end; wanted: the last reversal of each cycle
        rows = (2 * test["cycle"][use.rows]).astype(int)
        return {n: np.array([values[n][r] if r < len(values[n]) - 1 else np.nan for r in rows]) for n in names}
    if test.kind in ("drained", "undrained"):
        way = np.sign(test["eps_a"][use.rows[-1]])
        at, path = way * natural(test["eps_a"][use.rows]), way * result["eps_a"]
        at = np.where(at < path[-1] * (1 + ROUNDING), np.minimum(at, path[-1]), at)  # the end is met but for a rounding
        return {n: np.interp(at, path, values[n], right=np.nan) for n in names}
    stress = np.log(np.maximum(result["sigma_a" if test.kind == "oedometer" else "p_eff"], 1e-9))
    at = np.log(test["sigma_a" if test.kind == "oedometer" else "p"][np.concatenate([[use.start], use.rows])])
    answer = {n: np.full(len(at), np.nan) for n in names}
    for mine, theirs in zip(zip(*turns(at)), zip(*turns(stress))):  # branch by branch
        rows, path = slice(mine[0], mine[1] + 1), slice(theirs[0], theirs[1] + 1)
        way = np.sign(at[mine[1]] - at[mine[0]])
        for n in names:
            # An end is met to the tolerance of the control, not exactly.
            x = np.minimum(
                way * at[rows],
                way * stress[theirs[1]] if theirs[1] < len(stress) - 1 or _met(at, mine, stress) else np.inf,
            )
            answer[n][rows] = np.interp(x, way * stress[path], values[n][path], right=np.nan)
    return {n: v[1:] for n, v in answer.items()}


def _met(at: np.ndarray, branch: tuple[int, int], stress: np.ndarray) -> bool:
    """Whether the model came to the end of its last branch."""
    return bool(abs(stress[-1] - at[branch[1]]) < 1e-3)
