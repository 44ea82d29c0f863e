# SPDX-License-Identifier: MIT
"""Writes projects of OpenGeoSys with MUD: a cube whose nodes all move by given strains, saturated or unsaturated."""
POINTS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
CUBE = (0, 1, 3, 2, 4, 5, 7, 6)
GRAVITY = 9.81


def array(name, kind, values, components=1):
    width = f' NumberOfComponents="{components}"' if components > 1 else ""
    return f'<DataArray type="{kind}" Name="{name}"{width} format="ascii">{" ".join(map(str, values))}</DataArray>\n'


def grid(points, cells, kinds, point_data="", cell_data=""):
    """An unstructured grid of VTK as text."""
    ends = [sum(map(len, cells[:i + 1])) for i in range(len(cells))]
    return ('<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">\n'
            f'<UnstructuredGrid><Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">\n<Points>'
            + array("Points", "Float64", [x for p in points for x in p], 3) + "</Points>\n<Cells>"
            + array("connectivity", "Int64", [n for c in cells for n in c]) + array("offsets", "Int64", ends)
            + array("types", "UInt8", kinds) + f"</Cells>\n<PointData>{point_data}</PointData>\n"
            f"<CellData>{cell_data}</CellData>\n</Piece></UnstructuredGrid></VTKFile>\n")


def write_cube(folder):
    HEXAHEDRON = 12
    (folder / "cube.vtu").write_text(grid(POINTS, [CUBE], [HEXAHEDRON],
                                          cell_data=array("MaterialIDs", "Int32", [0])))
    (folder / "nodes.vtu").write_text(grid(POINTS, [CUBE], [HEXAHEDRON], array("bulk_node_ids", "UInt64", range(8)),
                                           array("bulk_element_ids", "UInt64", [0])))


def constant(name, *values):
    tag = "value" if len(values) == 1 else "values"
    return (f"<parameter><name>{name}</name><type>Constant</type><{tag}>{' '.join(repr(float(v)) for v in values)}"
            f"</{tag}></parameter>\n")


def function(name, expression):
    return f"<parameter><name>{name}</name><type>Function</type><expression>{expression}</expression></parameter>\n"


def curve(name, values):
    times = " ".join(repr(float(i)) for i in range(len(values)))
    return f"<curve><name>{name}</name><coords>{times}</coords><values>{' '.join(map(repr, values))}</values></curve>\n"


def condition(component, parameter, mesh="nodes", kind="Dirichlet", word="parameter"):
    return (f"<boundary_condition><mesh>{mesh}</mesh><type>{kind}</type><component>{component}</component>"
            f"<{word}>{parameter}</{word}></boundary_condition>\n")


def variable(name, components, start, conditions, order=1):
    return (f"<process_variable><name>{name}</name><components>{components}</components><order>{order}</order>"
            f"<initial_condition>{start}</initial_condition><boundary_conditions>\n{conditions}"
            "</boundary_conditions></process_variable>\n")


def properties(**values):
    return "<properties>" + "".join(
        f"<property><name>{name}</name>{value if isinstance(value, str) else ''}"
        + ("" if isinstance(value, str) else f"<type>Constant</type><value>{value!r}</value>") + "</property>\n"
        for name, value in values.items()) + "</properties>"


def relation(behaviour, library, names, presets):
    """The law: every parameter by its name, and the state variables that do not begin at zero."""
    material = "".join(f'<material_property name="{n}" parameter="mud_{n}"/>\n' for n in names)
    state = "".join(f'<state_variable name="mud_{n}" parameter="start_{n}"/>\n' for n in presets)
    return (f"<constitutive_relation><type>MFront</type><behaviour>{behaviour}</behaviour>"
            f"<library>{library}</library>\n<material_properties>{material}</material_properties>\n"
            f"<initial_values>{state}</initial_values></constitutive_relation>\n")


SMALL_DEFORMATION = """<process><name>P</name><type>SMALL_DEFORMATION</type><integration_order>2</integration_order>
{relation}<process_variables><process_variable>displacement</process_variable></process_variables>
<secondary_variables><secondary_variable internal_name="sigma" output_name="sigma"/></secondary_variables>
<specific_body_force>{zero}</specific_body_force><initial_stress>start_stress</initial_stress></process>"""
UNSATURATED = """<process><name>P</name><type>THERMO_RICHARDS_MECHANICS</type>
<subtype>StressSaturation_StrainPressureTemperature</subtype><integration_order>2</integration_order>
{relation}<process_variables><temperature>temperature</temperature><pressure>pressure</pressure>
<displacement>displacement</displacement></process_variables>
<secondary_variables><secondary_variable name="sigma_total"/><secondary_variable name="saturation"/>
</secondary_variables>
<specific_body_force>{zero}</specific_body_force><initial_stress type="total">start_stress</initial_stress></process>"""


def project(library, props, presets, strains, stress, suction=None, saturation=1.0):
    """Text of a .prj: step i ends at time i. strains: rows of 11, 22, 33, 12, 13, 23 that begin with zeros, tension
    positive, engineering shear; stress: at the start, effective, or total where there is a suction for every row,
    with the saturation of the start."""
    unsaturated = suction is not None
    law = relation("MUD_StressSaturation" if unsaturated else "MUD", library, props, presets)
    parameters = "".join(constant(f"mud_{n}", v) for n, v in props.items())
    parameters += "".join(constant(f"start_{n}", v) for n, v in presets.items())
    parameters += constant("start_stress", stress, stress, stress, 0, 0, 0) + constant("rest", 0, 0, 0)
    # u = H x with a triangular H: its symmetric part is the strain.
    parameters += function("u_x", "e11(t)*x + e12(t)*y + e13(t)*z") + function("u_y", "e22(t)*y + e23(t)*z")
    parameters += function("u_z", "e33(t)*z")
    names = ("e11", "e22", "e33", "e12", "e13", "e23")
    curves = "".join(curve(name, column) for name, column in zip(names, zip(*strains)))
    variables = variable("displacement", 3, "rest", "".join(condition(i, f"u_{a}") for i, a in enumerate("xyz")))
    media, tolerances, outputs = solid_alone(), "<abstols>1e-13 1e-13 1e-13</abstols>", ("sigma",)
    if unsaturated:
        curves += curve("liquid", [-s for s in suction])
        parameters += constant("start_pressure", -suction[0]) + constant("warm", 293.15) + function("p_L", "liquid(t)")
        variables += variable("pressure", 1, "start_pressure", condition(0, "p_L"))
        variables += variable("temperature", 1, "warm", condition(0, "warm"))
        media = soil_with_water(0.444, saturation)
        tolerances = "<abstols>1e-9 1e-9 1e-13 1e-13 1e-13</abstols>"
        outputs = ("sigma_total", "saturation")
    steps = len(strains) - 1
    process = (UNSATURATED if unsaturated else SMALL_DEFORMATION).format(relation=law, zero="0 0 0")
    return whole(["cube", "nodes"], process, media, tolerances, equal_steps(float(steps), steps), outputs, parameters, curves,
                 variables)


def solid_alone(density=2.65):
    return f"<phases><phase><type>Solid</type>{properties(density=density)}</phase></phases>"


def soil_with_water(porosity, saturation, permeability=1.0e-12):
    """Incompressible grains and water, no heat; units m, s, kPa, Mg. The saturation is that of the start alone."""
    heat = {"specific_heat_capacity": 1.0, "thermal_conductivity": 1.0, "thermal_expansivity": 0.0}
    mass_balance = ("<type>PorosityFromMassBalance</type><minimal_porosity>0</minimal_porosity>"
                    "<maximal_porosity>1</maximal_porosity><initial_porosity>start_porosity</initial_porosity>")
    return ("<phases><phase><type>AqueousLiquid</type>" + properties(density=1.0, viscosity=1.0e-6, **heat)
            + "</phase><phase><type>Solid</type>" + properties(density=2.65, **heat) + "</phase></phases>"
            + properties(saturation=saturation, relative_permeability=1.0, permeability=permeability,
                         porosity=mass_balance if porosity is None else porosity,
                         bishops_effective_stress="<type>BishopsPowerLaw</type><exponent>1.0</exponent>",
                         biot_coefficient=1.0,
                         thermal_conductivity="<type>EffectiveThermalConductivityPorosityMixing</type>"))


def equal_steps(end, number):
    return fixed_steps([(number, end/number)])


def fixed_steps(pairs):
    """(number, length) of equal steps in turn."""
    return "FixedTimeStepping", sum(number*length for number, length in pairs), "<timesteps>" + "".join(
        f"<pair><repeat>{number}</repeat><delta_t>{length!r}</delta_t></pair>\n" for number, length in pairs
    ) + "</timesteps>"


def steps_by_iterations(end, first, longest):
    """Steps that grow while few iterations are needed, and are cut where Newton's method fails."""
    return "IterationNumberBasedTimeStepping", end, (
        f"<initial_dt>{first!r}</initial_dt><minimum_dt>{first*1e-6!r}</minimum_dt><maximum_dt>{longest!r}</maximum_dt>"
        "<number_iterations>1 8 16 30</number_iterations><multiplier>1.5 1.1 0.8 0.3</multiplier>")


def whole(meshes, process, media, tolerances, stepping, outputs, parameters, curves, variables, axisymmetric=False,
          solver="Newton", kept=None, script=""):
    """Text of a project. kept: times of output, every step without; script: of conditions in Python."""
    around = ' axially_symmetric="true"' if axisymmetric else ""
    mesh = "".join(f"<mesh{around}>{name}.vtu</mesh>" for name in meshes)
    kind, end, steps = stepping
    each = 1 if kept is None else 10**9
    times = "" if kept is None else f"<fixed_output_times>{' '.join(map(repr, kept))}</fixed_output_times>"
    script = script and f"<python_script>{script}</python_script>"
    wanted = "".join(f"<variable>{name}</variable>" for name in outputs)
    return f"""<?xml version="1.0"?>
<OpenGeoSysProject>{script}
<meshes>{mesh}</meshes>
<processes>{process}</processes>
<media><medium>{media}</medium></media>
<time_loop><processes><process ref="P"><nonlinear_solver>newton</nonlinear_solver>
<convergence_criterion><type>PerComponentDeltaX</type><norm_type>INFINITY_N</norm_type>{tolerances}
</convergence_criterion>
<time_discretization><type>BackwardEuler</type></time_discretization>
<time_stepping><type>{kind}</type><t_initial>0</t_initial><t_end>{end!r}</t_end>
{steps}</time_stepping>
</process></processes>
<output><type>VTK</type><prefix>r</prefix><suffix>_{{:timestep}}</suffix><data_mode>Ascii</data_mode>
<timesteps><pair><repeat>1</repeat><each_steps>{each}</each_steps></pair></timesteps>{times}
<variables>{wanted}</variables></output>
</time_loop>
<parameters>{parameters}</parameters>
<curves>{curves}</curves>
<process_variables>{variables}</process_variables>
<nonlinear_solvers><nonlinear_solver><name>newton</name><type>{solver}</type><max_iter>30</max_iter>
<linear_solver>direct</linear_solver></nonlinear_solver></nonlinear_solvers>
<linear_solvers><linear_solver><name>direct</name><eigen><solver_type>SparseLU</solver_type></eigen></linear_solver>
</linear_solvers>
</OpenGeoSysProject>
"""


def write_column(folder, cells, height):
    """One row of quadrilaterals in plane strain; node 2 i is on the left."""
    QUADRILATERAL, LINE = 9, 3
    points = [(x, height*i/cells, 0.0) for i in range(cells + 1) for x in (0.0, height/cells)]
    quads = [(2*i, 2*i + 1, 2*i + 3, 2*i + 2) for i in range(cells)]
    every = array("bulk_node_ids", "UInt64", range(len(points))), array("bulk_element_ids", "UInt64", range(cells))
    kinds = [QUADRILATERAL]*cells
    (folder / "column.vtu").write_text(grid(points, quads, kinds, cell_data=array("MaterialIDs", "Int32", [0]*cells)))
    (folder / "nodes.vtu").write_text(grid(points, quads, kinds, *every))
    for name, first, element in (("bottom", 0, 0), ("top", 2*cells, cells - 1)):
        (folder / f"{name}.vtu").write_text(grid(points[first:first + 2], [(0, 1)], [LINE],
                                                 array("bulk_node_ids", "UInt64", [first, first + 1]),
                                                 array("bulk_element_ids", "UInt64", [element])))


def ground(library, props, height, density, k_0, surcharge, added, steps):
    """Ground with weight [m, Mg/m3, kPa]: a step in which nothing is added, then the surcharge grows. The stress is
    that of the depth, the state variables are zeros, so that every point begins with a memory of its own."""
    vertical = f"-({surcharge!r}+{density*GRAVITY!r}*({height!r}-y))"
    horizontal = f"{k_0!r}*({vertical})"
    parameters = "".join(constant(f"mud_{n}", v) for n, v in props.items())
    parameters += constant("rest", 0, 0) + constant("held", 0)
    parameters += ("<parameter><name>start_stress</name><type>Function</type>"
                   + "".join(f"<expression>{e}</expression>" for e in (horizontal, vertical, horizontal, "0"))
                   + "</parameter>\n")
    parameters += function("load", "-surcharge(t)")
    curves = curve("surcharge", [surcharge] + [surcharge + added*i/steps for i in range(steps + 1)])
    variables = variable("displacement", 2, "rest", condition(0, "held") + condition(1, "held", "bottom")
                         + condition(1, "load", "top", "Neumann"))
    law = relation("MUD", library, props, [])
    process = SMALL_DEFORMATION.format(relation=law, zero=f"0 {-GRAVITY!r}")
    return whole(["column", "nodes", "bottom", "top"], process, solid_alone(density), "<abstols>1e-10 1e-10</abstols>",
                 equal_steps(float(steps + 1), steps + 1), ("displacement", "sigma"), parameters, curves, variables)


def column(library, props, void_ratio, stress, pull, suction, permeability, end, steps):
    """A column that is wetted from below: suction at the bottom goes from `suction` to 0, the load on top stays.
    stress: effective at the start; pull: S_w p_c at the start."""
    total = stress + pull
    parameters = "".join(constant(f"mud_{n}", v) for n, v in props.items()) + constant("start_void_ratio", void_ratio)
    parameters += constant("start_stress", total, total, total, 0) + constant("rest", 0, 0) + constant("held", 0)
    parameters += constant("start_pressure", -suction) + constant("warm", 293.15) + constant("load", total)
    parameters += constant("start_porosity", void_ratio/(1.0 + void_ratio))
    parameters += function("p_L", f"{-suction!r}*(1-t/{end!r})")
    variables = variable("displacement", 2, "rest", condition(0, "held") + condition(1, "held", "bottom")
                         + condition(1, "load", "top", "Neumann"))
    variables += variable("pressure", 1, "start_pressure", condition(0, "p_L", "bottom"))
    variables += variable("temperature", 1, "warm", condition(0, "warm"))
    law = relation("MUD_StressSaturation", library, props, ["void_ratio"])
    return whole(["column", "nodes", "bottom", "top"], UNSATURATED.format(relation=law, zero="0 0"),
                 soil_with_water(None, pull/suction, permeability), "<abstols>1e-9 1e-6 1e-10 1e-10</abstols>",
                 equal_steps(end, steps), ("displacement", "pressure"), parameters, "", variables)
