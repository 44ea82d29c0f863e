# SPDX-License-Identifier: MIT
"""Writes a folder that Kratos runs: ProjectParameters.json and MaterialParameters.json beside a mesh of this folder."""
import json


def constraint(part, component, table=0):
    axis = "XYZ".index(component)

    def only(value, other):
        return [value if i == axis else other for i in range(3)]

    return {"python_module": "apply_vector_constraint_table_process",
            "kratos_module": "KratosMultiphysics.GeoMechanicsApplication",
            "process_name": "ApplyVectorConstraintTableProcess",
            "Parameters": {"model_part_name": f"PorousDomain.{part}", "variable_name": "DISPLACEMENT",
                           "active": only(True, False), "is_fixed": only(True, False), "value": [0.0]*3,
                           "table": only(table, 0)}}


def material(law, library, props, state, dry):
    """A dry soil by UMAT or UDSM: water without weight, whose pressure `dry` fixes; void ratio 0.8."""
    variables = {
        "IGNORE_UNDRAINED": dry, "IS_FORTRAN_UDSM": True, "UDSM_NAME": str(library), "UDSM_NUMBER": 1,
        "UMAT_PARAMETERS": props, "STATE_VARIABLES": state,
        "DENSITY_SOLID": 2.65, "DENSITY_WATER": 1.0e-9, "POROSITY": 0.8/1.8, "BULK_MODULUS_SOLID": 1.0e9,
        "BULK_MODULUS_FLUID": 2.0e6, "PERMEABILITY_XX": 1.0e-11, "PERMEABILITY_YY": 1.0e-11, "PERMEABILITY_ZZ": 1.0e-11,
        "PERMEABILITY_XY": 0.0, "PERMEABILITY_YZ": 0.0, "PERMEABILITY_ZX": 0.0, "DYNAMIC_VISCOSITY": 1.0e-6,
        "BIOT_COEFFICIENT": 1.0, "RETENTION_LAW": "SaturatedLaw", "SATURATED_SATURATION": 1.0}
    return {"properties": [{"model_part_name": "PorousDomain.Soil", "properties_id": 1,
                            "Material": {"constitutive_law": {"name": law}, "Variables": variables, "Tables": {}}}]}


def project(dimension, mesh, steps, constraints, loads, processes_on):
    return {
        "problem_data": {"problem_name": "mud", "start_time": 0.0, "end_time": float(steps), "echo_level": 0,
                         "parallel_type": "OpenMP", "number_of_threads": 1},
        "solver_settings": {
            "solver_type": "U_Pw", "model_part_name": "PorousDomain", "domain_size": dimension, "echo_level": 0,
            "model_import_settings": {"input_type": "mdpa", "input_filename": mesh},
            "material_import_settings": {"materials_filename": "MaterialParameters.json"},
            # Steps stay as they are given: the answer depends on them, and so does the comparison.
            "time_stepping": {"time_step": 1.0, "max_delta_time_factor": 1.0}, "number_cycles": 1,
            "solution_type": "Quasi-Static", "scheme_type": "Backward_Euler", "strategy_type": "newton_raphson",
            "convergence_criterion": "displacement_criterion", "displacement_relative_tolerance": 1.0e-10,
            "displacement_absolute_tolerance": 1.0e-14, "min_iterations": 1, "max_iterations": 30,
            "compute_reactions": True, "block_builder": True, "reset_displacements": False,
            "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
            "problem_domain_sub_model_part_list": ["Soil"], "processes_sub_model_part_list": processes_on,
            "body_domain_sub_model_part_list": ["Soil"]},
        "processes": {"constraints_process_list": constraints, "loads_process_list": loads},
        "output_processes": {}}


def dry():
    """No excess pressure of the water."""
    return {"python_module": "apply_scalar_constraint_table_process",
            "kratos_module": "KratosMultiphysics.GeoMechanicsApplication",
            "process_name": "ApplyScalarConstraintTableProcess",
            "Parameters": {"model_part_name": "PorousDomain.Soil", "variable_name": "WATER_PRESSURE", "is_fixed": True,
                           "fluid_pressure_type": "Uniform", "value": 0.0, "table": 0}}


def start(stress):
    return {"python_module": "apply_initial_uniform_stress_field",
            "kratos_module": "KratosMultiphysics.GeoMechanicsApplication",
            "process_name": "ApplyInitialUniformStressField",
            "Parameters": {"model_part_name": "PorousDomain.Soil", "value": stress}}


def cell_pressure(dimension, value, table=0):
    return {"python_module": "apply_normal_load_table_process",
            "kratos_module": "KratosMultiphysics.GeoMechanicsApplication",
            "process_name": "apply_normal_load_table_process",
            "Parameters": {"model_part_name": "PorousDomain.Cell", "variable_name": "NORMAL_CONTACT_STRESS",
                           "active": [True, False], "value": [value, 0.0], "fluid_pressure_type": "Uniform",
                           "table": [table, 0]}}


def column_mesh(cells, load=((0.0, 100.0), (0.002, 150.0), (0.004, 100.0), (1.0, 100.0))):
    """A row of quadrilaterals, 1 m high, with a load on top at times, which rises by half and falls again."""
    nodes = [(x, i/cells) for i in range(cells + 1) for x in (0.0, 0.1)]
    everything, top = range(1, len(nodes) + 1), (2*cells + 1, 2*cells + 2)

    def block(kind, rows):
        return [f"Begin {kind}", *rows, f"End {kind.split()[0]}", ""]

    def part(name, numbers, elements=(), conditions=(), tables=()):
        lists = [("Tables", tables), ("Nodes", numbers), ("Elements", elements), ("Conditions", conditions)]
        return block(f"SubModelPart {name}", [row for kind, rows in lists if rows
                                              for row in block(f"SubModelPart{kind}", map(str, rows))])

    elements = [f"{i + 1} 0  {2*i + 1} {2*i + 2} {2*i + 4} {2*i + 3}" for i in range(cells)]
    return "\n".join(
        block("ModelPartData", []) + block("Properties 0", [])
        + block("Table 1 TIME NORMAL_CONTACT_STRESS", [f"{time} {value}" for time, value in load])
        + block("Nodes", [f"{i} {x} {y!r} 0.0" for i, (x, y) in enumerate(nodes, 1)])
        + block("Elements UPwSmallStrainElement2D4N", elements)
        + block("Conditions UPwNormalFaceLoadCondition2D2N", [f"1 0  {top[1]} {top[0]}"])
        + part("Soil", everything, elements=range(1, cells + 1)) + part("Bottom", (1, 2)) + part("Sides", everything)
        + part("Cell", top, conditions=(1,), tables=(1,)))


def dynamic(content, step, end):
    """The project with Newmark's average acceleration and steps of a length."""
    content["problem_data"]["end_time"] = end
    content["solver_settings"] |= {"solution_type": "Dynamic", "scheme_type": "Newmark", "newmark_beta": 0.25,
                                   "newmark_gamma": 0.5, "rayleigh_m": 0.0, "rayleigh_k": 0.0}
    content["solver_settings"]["time_stepping"]["time_step"] = step
    return content


def write(folder, name, content):
    (folder / name).write_text(json.dumps(content, indent=3) + "\n")
