# SPDX-License-Identifier: MIT
"""Cases of verification/references as projects of OpenGeoSys: the unknowns choose the process, the mesh is that of the
case. Limits of pressure and seepage faces are a condition in Python, faces.py in the folder of a run."""
import json
import pathlib
import re
import xml.etree.ElementTree

import cases
import clients
import limits
import project

here = pathlib.Path(__file__).parent
EDGE, TRIANGLE = {2: 3, 3: 21}, {3: 5, 6: 22}  # of VTK by the number of nodes
PRESSURES = {"p_w": "pressure_interpolated", "p_a": "gas_pressure_interpolated",
             "p_c": "capillary_pressure_interpolated"}
HEAT = {"specific_heat_capacity": 1.0, "thermal_conductivity": 1.0, "thermal_expansivity": 0.0}
FINER = {"terzaghi": 8, "liakopoulos": 1}  # backward Euler; gas and water are of first order in the cells
LIMITS = '''"""Flow into faces."""
import sys

sys.path.insert(0, {here!r})
import limits
from ogs import callbacks


class Face(callbacks.BoundaryCondition):
    def __init__(self, inflow, outside):
        super().__init__()
        self.given = inflow, outside, {where!r}

    def getFlux(self, t, coords, primary_vars):
        return True, *limits.inflow(*self.given, t, coords[0], coords[1], primary_vars[0])


'''


def process_of(case):
    if case.model.get("inertia"):
        raise cases.Refused("no process has inertia")
    return {("p_w",): "RICHARDS_FLOW" if "retention" in case.model else "LIQUID_FLOW", ("u",): "SMALL_DEFORMATION",
            ("u", "p_w"): "HYDRO_MECHANICS", ("u", "p_w", "p_a"): "TH2M"}[case.unknowns]


def write_meshes(folder, case):
    """The body and the boundaries, as files of VTK."""
    points = [(*place, 0.0) for place in case.places]
    (folder / "soil.vtu").write_text(project.grid(
        points, case.triangles, [TRIANGLE[len(case.triangles[0])]]*len(case.triangles),
        cell_data=project.array("MaterialIDs", "Int32", [0]*len(case.triangles))))
    cell = {frozenset(pair): i for i, t in enumerate(case.triangles) for pair in (t[:2], t[1:3], (t[2], t[0]))}
    for name, edges in case.edges.items():
        nodes = case.on(name)
        number = {n: i for i, n in enumerate(nodes)}
        (folder / f"{name}.vtu").write_text(project.grid(
            [points[n] for n in nodes], [[number[n] for n in edge] for edge in edges], [EDGE[len(edges[0])]]*len(edges),
            project.array("bulk_node_ids", "UInt64", nodes),
            project.array("bulk_element_ids", "UInt64", [cell[frozenset(edge[:2])] for edge in edges])))


def material(case, process):
    """Text of the medium."""
    if process == "SMALL_DEFORMATION":
        return project.solid_alone()
    permeability, viscosity = case.permeability()
    water = {"density": case.property("density_of_water_Mg_m3", default=1.0), "viscosity": viscosity}
    solid = {"density": case.property("density_of_grains_Mg_m3", default=2.65)}
    whole = {"permeability": permeability, "porosity": case.porosity(), "reference_temperature": 293.15}
    phases = {"AqueousLiquid": water, "Solid": solid}
    if process in ("LIQUID_FLOW", "RICHARDS_FLOW"):
        whole["storage"] = 0.0
    if process == "HYDRO_MECHANICS":
        water["density"] = (f"<type>Linear</type><reference_value>{water['density']!r}</reference_value>"
                            "<independent_variable><variable_name>liquid_phase_pressure</variable_name>"
                            "<reference_condition>0</reference_condition>"
                            f"<slope>{1/case.properties['bulk_modulus_of_water_kPa']!r}</slope></independent_variable>")
        whole["biot_coefficient"] = 1.0
    if "retention" in case.model:
        law = case.model["retention"]

        def function(text, name, short, width):
            """An expression of one variable and its slope, as a difference to the side where every curve is defined."""
            of = re.compile(rf"\b{short}\b")
            slope = f"(({of.sub(name, text)}) - ({of.sub(f'({name} - {width})', text)}))/{width}"
            return (f"<type>Function</type><value><expression>{of.sub(name, text)}</expression></value>"
                    f"<dvalue><variable_name>{name}</variable_name><expression>{slope}</expression></dvalue>")

        whole |= {"saturation": function(law["s_w"], "capillary_pressure", "p_c", 1e-6),
                  "relative_permeability": function(law["k_w"], "liquid_saturation", "s_w", 1e-7)}
        if process == "TH2M":
            whole["relative_permeability_nonwetting_phase"] = function(law["k_a"], "liquid_saturation", "s_w", 1e-7)
    if process == "TH2M":
        # rho = p M/(R T): M that gives the density at the atmosphere.
        molar = 8.31446261815324*293.15*1.176e-3/case.properties["atmosphere_kPa"]
        phases["Gas"] = {"density": "<type>IdealGasLaw</type>", "molar_mass": molar,
                         "viscosity": case.properties["viscosity_of_air_kPa_s"], **HEAT}
        water |= {"molar_mass": 0.018, **HEAT}
        solid |= HEAT
        # With a constant porosity the weight of the mixture stays as it is and 0.15 % of the settlement is missing.
        whole["porosity"] = ("<type>PorosityFromMassBalance</type><initial_porosity>porosity</initial_porosity>"
                             "<minimal_porosity>0</minimal_porosity><maximal_porosity>1</maximal_porosity>")
        whole |= {"biot_coefficient": 1.0,
                  "bishops_effective_stress": "<type>BishopsPowerLaw</type><exponent>1</exponent>",
                  "thermal_conductivity": "<type>EffectiveThermalConductivityPorosityMixing</type>"}
    return ("<phases>" + "".join(f"<phase><type>{name}</type>{project.properties(**values)}</phase>"
                                 for name, values in phases.items()) + "</phases>" + project.properties(**whole))


def write(folder, case, where, divided):
    """A project of the case with these numbers in its expressions; the ends of its steps."""
    process = process_of(case)
    write_meshes(folder, case)
    gravity = case.model.get("gravity_m_s2", 0.0)
    law, parameters, faces = "", project.constant("zero", 0.0) + project.constant("rest", 0.0, 0.0), []
    if "u" in case.unknowns:
        law = ("<constitutive_relation><type>LinearElasticIsotropic</type><youngs_modulus>young</youngs_modulus>"
               "<poissons_ratio>poisson</poissons_ratio></constitutive_relation>")
        for name in ("young", "poisson"):
            parameters += project.constant(name, case.property("young_kPa" if name == "young" else name))
    conditions = {"u": "", "p_w": "", "p_a": "", "p_c": ""}

    def given(kind, on, value):
        name = f"{kind}_{on}"
        nonlocal parameters
        parameters += project.function(name, value if isinstance(value, str) else repr(float(value)))
        return name

    for on, kind, what in case.conditions("u_x", "u_y", "p_w", "p_a", "stress_x", "stress_y", "inflow_w", "seepage"):
        if kind in ("inflow_w", "seepage"):
            faces.append((on, *((what, 0.0) if kind == "inflow_w" else (0.0, what))))
            conditions["p_w"] += project.condition(0, f"face_{on}", on, "Python", "bc_object")
        elif kind.startswith("stress"):
            conditions["u"] += project.condition("xy".index(kind[-1]), given(kind, on, what), on, "Neumann")
        elif kind.startswith("u"):
            conditions["u"] += project.condition("xy".index(kind[-1]), given(kind, on, what), on)
        elif process == "TH2M":  # its unknowns are the gas pressure, absolute, and the suction
            value = what + case.properties["atmosphere_kPa"] if kind == "p_a" else -what
            into = "p_a" if kind == "p_a" else "p_c"
            conditions[into] += project.condition(0, given(into, on, value), on)
        else:
            conditions[kind] += project.condition(0, given(kind, on, what), on)
    start = case.model.get("start", {})
    variables = ""
    if process == "TH2M":
        parameters += (project.constant("start_a", case.properties["atmosphere_kPa"]) + project.constant("warm", 293.15)
                       + project.constant("porosity", case.porosity())
                       + project.constant("start_c", -start["p_w"]))
        p = case.properties["atmosphere_kPa"]
        parameters += project.constant("start_stress", p, p, p, 0)
        variables += project.variable("gas_pressure", 1, "start_a", conditions["p_a"])
        variables += project.variable("capillary_pressure", 1, "start_c", conditions["p_c"])
        variables += project.variable("temperature", 1, "warm", "".join(
            project.condition(0, "warm", on) for on in case.edges))
    elif "p_w" in case.unknowns:
        first = start.get("p_w", 0.0)
        parameters += project.function("start_p", first if isinstance(first, str) else repr(first))
        variables += project.variable("pressure", 1, "start_p", conditions["p_w"],
                                      1 if "u" in case.unknowns or case.linear() else 2)
    if "u" in case.unknowns:
        variables += project.variable("displacement", 2, "rest", conditions["u"], 2)
    named = {"TH2M": {"gas_pressure": "gas_pressure", "capillary_pressure": "capillary_pressure",
                      "temperature": "temperature", "displacement": "displacement"},
             "HYDRO_MECHANICS": {"displacement": "displacement", "pressure": "pressure"},
             "SMALL_DEFORMATION": {"process_variable": "displacement"}}.get(process, {"process_variable": "pressure"})
    more = {"RICHARDS_FLOW": f"<mass_lumping>{str(case.linear()).lower()}</mass_lumping>"
                             "<jacobian_assembler><type>CentralDifferences</type>"
                             "<epsilons>1e-5</epsilons></jacobian_assembler>",
            "TH2M": "<initial_stress>start_stress</initial_stress>"
                    "<mass_lumping>false</mass_lumping>"}.get(process, "")
    text = (f"<process><name>P</name><type>{process}</type><integration_order>4</integration_order>{law}"
            "<process_variables>" + "".join(f"<{a}>{b}</{a}>" for a, b in named.items()) + "</process_variables>"
            f"<secondary_variables/><specific_body_force>0 {-gravity!r}</specific_body_force>{more}</process>")
    tolerances = {"TH2M": "<abstols>1e-7 1e-7 1e-5 1e-12 1e-12</abstols>",
                  "HYDRO_MECHANICS": "<abstols>1e-9 1e-14 1e-14</abstols>",
                  "SMALL_DEFORMATION": "<abstols>1e-14 1e-14</abstols>"}.get(process, "<abstols>1e-6</abstols>")
    outputs = {"TH2M": ("gas_pressure_interpolated", "capillary_pressure_interpolated", "displacement"),
               "HYDRO_MECHANICS": ("pressure_interpolated", "displacement"),
               "SMALL_DEFORMATION": ("displacement", "NodalForces"),
               "LIQUID_FLOW": ("pressure", "VolumetricFlowRate")}.get(process, ("pressure",))
    ends = case.steps(divided)
    if case.linear():
        stepping = project.steps_by_iterations(case.end, ends[0], case.model["steps"]["longest"])
    else:
        stepping = project.fixed_steps([(1, b - a) for a, b in zip([0.0, *ends], ends)])
    (folder / "case.prj").write_text(project.whole(
        ["soil", *case.edges], text, material(case, process), tolerances, stepping, outputs, parameters, "", variables,
        case.model["geometry"] == "axisymmetric", "Picard" if process == "LIQUID_FLOW" else "Newton", case.times(),
        "faces.py" if faces else ""))
    if faces:
        (folder / "faces.py").write_text(LIMITS.format(where=where, here=str(here)) + "".join(
            f"face_{on} = Face({inflow!r}, {outside!r})\n" for on, inflow, outside in faces))
    return process, ends


def field(path, name):
    """Rows of a field."""
    for array in xml.etree.ElementTree.parse(path).iter("DataArray"):
        if array.get("Name") == name:
            numbers, width = [float(x) for x in array.text.split()], int(array.get("NumberOfComponents", 1))
            return [numbers[i:i + width] for i in range(0, len(numbers), width)]
    raise KeyError(f"{path}: no {name}")


def answer(folder, case, quantity, process, ends):
    """Values of the rows of a quantity."""
    read, rows = case.of(quantity)

    files = sorted(folder.glob("r_*.vtu"), key=lambda file: int(file.stem[2:]))[1:]
    times = case.times() or ends

    def of(i, node):
        if read["field"] == "outflow_w" and process == "LIQUID_FLOW":
            return -sum(row[0] for n, row in enumerate(field(files[i], "VolumetricFlowRate")) if n in held)
        if read["field"] == "outflow_w":
            return limits.outflow(case, read, times[i], [row[0] for row in field(files[i], "pressure")])
        if read["field"] == "force_y":
            return sum(row[1] for n, row in enumerate(field(files[i], "NodalForces")) if n in held)
        if read["field"].startswith("u_"):
            return field(files[i], "displacement")[node]["xy".index(read["field"][-1])]
        name = PRESSURES[read["field"]] if "u" in case.unknowns else "pressure"
        above = case.properties["atmosphere_kPa"] if read["field"] == "p_a" else 0.0
        return field(files[i], name)[node][0] - above

    held = set(case.on(read["on"])) if "on" in read else ()
    if "first_above" in read:
        return [next((t for i, t in enumerate(times) if of(i, rows[0][1]) > read["first_above"]), float("nan"))]
    return [read.get("scale", 1.0)*of(min(range(len(times)), key=lambda i: abs(times[i] - t)), node)
            + read.get("offset", 0.0) for t, node in rows]


def run(python, case, divided=1):
    """Values of every quantity: {quantity: values of its rows}."""
    found = {}
    done = {}
    for quantity in case.quantities:
        where = case.quantities[quantity]["read"].get("where", {})
        key = json.dumps(where)
        if key not in done:
            folder = clients.work_folder(f"opengeosys/{case.name}" + "".join(f"_{v}" for v in where.values()))
            for old in folder.glob("r_*.vtu"):
                old.unlink()
            process, ends = write(folder, case, where, divided)
            if clients.run([python.parent / "ogs", "case.prj"], folder / "log.txt", cwd=folder, timeout=1500) != 0:
                raise RuntimeError(f"{case.name}: the run did not come to its end: {folder}/log.txt")
            done[key] = folder, process, ends
        found[quantity] = answer(done[key][0], case, quantity, *done[key][1:])
    return found
