# SPDX-License-Identifier: MIT
"""Cases of verification/references for Kratos: the mesh as mdpa, a project, and model.json, which
reference_run.py follows: supports, loads and limits at every step, histories of nodes and sums of reactions."""
import json
import pathlib

import cases
import clients
import project

here = pathlib.Path(__file__).parent
FINER = {"terzaghi": 8}  # backward Euler
CONDITIONS = {"stress": ("LineLoadDiffOrderCondition2D3N", "UPwFaceLoadCondition2D3N"),
              "absorbing": ("UPwLysmerAbsorbingCondition2D3N",)*2}


def refuse(case):
    """What Kratos has not, of what the case asks."""
    if "p_a" in case.unknowns:
        raise cases.Refused("no pressure of air as an unknown")
    if any("seepage" in given for given in case.model["conditions"]):
        raise cases.Refused("no seepage face below which water stands")
    law = case.model.get("retention", {}).get("s_w", "")
    if law and "^(-2/3)" not in law:
        raise cases.Refused("no retention law exponential in the suction, and none as a table")


def element(case):
    """Pressures are of the order of displacements, but where both are unknown."""
    around = "Axisymmetric" if case.model["geometry"] == "axisymmetric" else ""
    if set(case.unknowns) == {"u", "p_w"}:
        return f"SmallStrainUPwDiffOrder{around}Element2D6N"
    return f"UPwSmallStrain{around}Element2D{len(case.triangles[0])}N"


def mesh(case):
    """Text of the mdpa file: a part for the body and for every boundary; conditions where there are loads."""
    def block(kind, rows):
        return [f"Begin {kind}", *rows, f"End {kind.split()[0]}", ""]

    def part(name, **lists):
        return block(f"SubModelPart {name}", [row for kind, rows in lists.items() if rows
                                              for row in block(f"SubModelPart{kind}", map(str, rows))])

    lines = block("ModelPartData", []) + block("Properties 1", [])
    lines += block("Nodes", [f"{i} {x!r} {y!r} 0.0" for i, (x, y) in enumerate(case.places, 1)])
    lines += block(f"Elements {element(case)}", [
        f"{i} 1 {' '.join(str(n + 1) for n in nodes)}" for i, nodes in enumerate(case.triangles, 1)])
    parts, count = part("soil", Nodes=range(1, len(case.places) + 1), Elements=range(1, len(case.triangles) + 1)), 0
    for name, edges in case.edges.items():
        numbers = []
        for on, kind, _ in case.conditions("stress_x", "stress_y", "absorbing"):
            if on != name or numbers:
                continue
            names = CONDITIONS[kind.split("_")[0]]
            numbers = list(range(count + 1, count + len(edges) + 1))
            lines += block(f"Conditions {names[0 if 'DiffOrder' in element(case) else 1]}", [
                f"{i} 1 {' '.join(str(n + 1) for n in edge)}"
                for i, edge in zip(numbers, (turned(case, edge) for edge in edges))])
            count += len(edges)
        parts += part(name, Nodes=[n + 1 for n in case.on(name)], Conditions=numbers)
    return "\n".join(lines + parts)


def turned(case, edge):
    """An edge in the sense of its triangle: Kratos finds its element by it."""
    a, b, *middle = edge
    along = {pair for t in case.triangles for pair in (tuple(t[:2]), tuple(t[1:3]), (t[2], t[0]))}
    return edge if (a, b) in along else [b, a, *middle]


def material(case):
    n = 0.0 if "density_Mg_m3" in case.properties else case.porosity()
    permeability, viscosity = case.permeability() if "p_w" in case.unknowns else (1e-12, 1e-6)
    soft = {"IGNORE_UNDRAINED": "p_w" not in case.unknowns, "BIOT_COEFFICIENT": 1.0, "POROSITY": n,
            "YOUNG_MODULUS": case.property("young_kPa", default=1e4), "POISSON_RATIO": case.property("poisson", default=0.3),
            "DENSITY_SOLID": case.property("density_of_grains_Mg_m3", "density_Mg_m3", default=2.65),
            "DENSITY_WATER": case.property("density_of_water_Mg_m3", default=1.0), "BULK_MODULUS_SOLID": 1e15,
            "BULK_MODULUS_FLUID": case.property("bulk_modulus_of_water_kPa", default=1e12),
            "PERMEABILITY_XX": permeability, "PERMEABILITY_YY": permeability, "PERMEABILITY_XY": 0.0,
            "DYNAMIC_VISCOSITY": viscosity, "SATURATED_SATURATION": 1.0}
    if "retention" in case.model:  # (1 + p_c**3)**(-2/3) and s_w**3, at least 1e-4
        soft |= {"RETENTION_LAW": "VanGenuchtenLaw", "RESIDUAL_SATURATION": 1e-9, "VAN_GENUCHTEN_AIR_ENTRY_PRESSURE": 1.0,
                 "VAN_GENUCHTEN_GN": 3.0, "VAN_GENUCHTEN_GL": 3.0, "MINIMUM_RELATIVE_PERMEABILITY": 1e-4}
    else:
        soft["RETENTION_LAW"] = "SaturatedLaw"
    return {"properties": [{"model_part_name": "PorousDomain.soil", "properties_id": 1, "Material": {
        "constitutive_law": {"name": "GeoLinearElasticPlaneStrain2DLaw"}, "Variables": soft, "Tables": {}}}]}


def content(case):
    """ProjectParameters: the supports and loads are those of reference_run.py. Kratos takes the conditions of the parts
    that a process names, so that every boundary has one, which does nothing where the side does not absorb."""
    absorbing = [on for on, _, _ in case.conditions("absorbing")]
    named = [project.constraint(on, "X") for on in case.edges if on not in absorbing]
    for process in named:
        process["Parameters"] |= {"active": [False]*3, "is_fixed": [False]*3}
    named += [{"python_module": "set_absorbing_boundary_parameters_process",
               "kratos_module": "KratosMultiphysics.GeoMechanicsApplication", "Parameters": {
                   "model_part_name": f"PorousDomain.{on}", "absorbing_factors": [1.0, 1.0], "virtual_thickness": 1e12}}
              for on in absorbing]
    told = project.project(2, "case", 1, named, [], ["soil", *case.edges])
    told["solver_settings"] |= {"problem_domain_sub_model_part_list": ["soil"],
                                "body_domain_sub_model_part_list": ["soil"]}
    told["problem_data"]["end_time"] = case.end
    if "p_w" in case.unknowns:
        told["solver_settings"] |= {
            "convergence_criterion": "water_pressure_criterion", "water_pressure_relative_tolerance": 1e-9,
            "water_pressure_absolute_tolerance": 1e-9}
    if case.model.get("inertia"):
        project.dynamic(told, case.steps()[0], case.end)
    return told


def run(python, case, divided=1):
    """Values of every quantity: {quantity: values of its rows}."""
    refuse(case)
    found = {}
    for quantity, told in case.quantities.items():
        where = told["read"].get("where", {})
        folder = clients.work_folder(f"kratos/{case.name}" + "".join(f"_{v}" for v in where.values()))
        read, rows = case.of(quantity)
        if not (folder / "answers.json").exists() or where or quantity == next(iter(case.quantities)):
            reads = {q: case.of(q) for q, told in case.quantities.items() if told["read"].get("where", {}) == where}
            (folder / "answers.json").unlink(missing_ok=True)
            (folder / "case.mdpa").write_text(mesh(case))
            project.write(folder, "MaterialParameters.json", material(case))
            project.write(folder, "ProjectParameters.json", content(case))
            project.write(folder, "model.json", {
                "where": where, "unknowns": case.unknowns, "ends": case.steps(divided), "start": case.model.get("start", {}),
                "gravity": case.model.get("gravity_m_s2", 0.0), "reads": reads,
                "conditions": [given for given in case.model["conditions"] if "same_as" not in given]})
            if clients.run([python, here / "reference_run.py"], folder / "log.txt", cwd=folder, timeout=1500) != 0:
                raise RuntimeError(f"{case.name}: the run did not come to its end: {folder}/log.txt")
        found[quantity] = json.loads((folder / "answers.json").read_text())[quantity]
    return found
