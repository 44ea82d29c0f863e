# SPDX-License-Identifier: MIT
"""Reference cases of verification/references as projects of OpenGeoSys: flow to a well, flow below a sheet pile."""
import math
import re

import project

LINE, TRIANGLE = 3, 5
FLOW = """<process><name>P</name><type>LIQUID_FLOW</type><integration_order>2</integration_order>
<process_variables><process_variable>pressure</process_variable></process_variables>
<secondary_variables/><specific_body_force>0 0</specific_body_force></process>"""


def sections(path):
    """Sections of a Gmsh file by name, each the words of its lines."""
    text = path.read_text(encoding="utf-8")
    return {name: [line.split() for line in body.strip().splitlines()]
            for name, body in re.findall(r"\$(\w+)\n(.*?)\$End\1", text, re.DOTALL)}


def linear(path, halved):
    """Linear triangles of a mesh of the reference cases, one or, halved, four for each of its quadratic ones: places,
    triangles, edges by the boundary's name."""
    part = sections(path)
    names = [word[2].strip('"') for word in part["PhysicalNames"][1:] if word[0] == "1"]
    count = int(part["Nodes"][0][1])
    places = [tuple(map(float, line)) for line in part["Nodes"][2 + count:2 + 2*count]]
    triangles, edges, lines = [], {}, iter(part["Elements"][1:])
    for dimension, entity, _, members in (map(int, line) for line in lines):
        found = [[int(n) - 1 for n in next(lines)[1:]] for _ in range(members)]
        if dimension == 1:
            edges[names[entity - 1]] = [pair for a, b, m in found
                                        for pair in (((a, m), (m, b)) if halved else ((a, b),))]
        else:
            triangles += [three for a, b, c, ab, bc, ca in found for three in (
                ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)) if halved else ((a, b, c),))]
    used = sorted({n for nodes in triangles for n in nodes})
    number = {n: i for i, n in enumerate(used)}
    return ([places[n] for n in used], [[number[n] for n in nodes] for nodes in triangles],
            {name: [[number[n] for n in nodes] for nodes in found] for name, found in edges.items()})


def write_meshes(folder, mesh, boundaries):
    """The body and the boundaries that conditions name, as files of VTK."""
    places, triangles, edges = mesh
    (folder / "soil.vtu").write_text(project.grid(places, triangles, [TRIANGLE]*len(triangles), cell_data=project.array(
        "MaterialIDs", "Int32", [0]*len(triangles))))
    for name in boundaries:
        nodes = sorted({n for nodes in edges[name] for n in nodes})
        number = {n: i for i, n in enumerate(nodes)}
        of = [next(k for k, cell in enumerate(triangles) if set(nodes) <= set(cell)) for nodes in edges[name]]
        (folder / f"{name}.vtu").write_text(project.grid(
            [places[n] for n in nodes], [[number[n] for n in nodes] for nodes in edges[name]], [LINE]*len(of),
            project.array("bulk_node_ids", "UInt64", nodes), project.array("bulk_element_ids", "UInt64", of)))


def flow(properties, pressures, axisymmetric):
    """Text of a project: steady flow between boundaries with given pressures [kPa]."""
    parameters = project.constant("rest", 0.0) + "".join(
        project.constant(f"p_{name}", value) for name, value in pressures.items())
    variables = project.variable("pressure", 1, "rest", "".join(
        project.condition(0, f"p_{name}", name) for name in pressures))
    media = ("<phases><phase><type>AqueousLiquid</type>"
             + project.properties(density=1.0, viscosity=properties["viscosity_kPa_s"]) + "</phase></phases>"
             + project.properties(permeability=properties["permeability_m2"], porosity=0.5, storage=0.0,
                                  reference_temperature=293.15))
    text = project.whole(["soil", *pressures], FLOW, media, "<abstols>1e-9</abstols>", 1.0, 1, ("pressure",),
                         parameters, "", variables)
    text = text.replace("<type>Newton</type>", "<type>Picard</type>")   # this process has no Jacobian
    if not axisymmetric:
        return text
    meshes, more = text.split("</meshes>", 1)
    return meshes.replace("<mesh>", '<mesh axially_symmetric="true">') + "</meshes>" + more


def discharge(mesh, pressure, boundary, conductivity, axisymmetric):
    """Flow out of a boundary: the reactions of its nodes."""
    places, triangles, edges = mesh
    total, held = 0.0, {n for nodes in edges[boundary] for n in nodes}
    for nodes in triangles:
        (x1, y1, _), (x2, y2, _), (x3, y3, _) = (places[n] for n in nodes)
        twice = (x2 - x1)*(y3 - y1) - (x3 - x1)*(y2 - y1)
        slopes = [((y2 - y3)/twice, (x3 - x2)/twice), ((y3 - y1)/twice, (x1 - x3)/twice),
                  ((y1 - y2)/twice, (x2 - x1)/twice)]
        gradient = [sum(pressure[n]*s[i] for n, s in zip(nodes, slopes)) for i in (0, 1)]
        volume = abs(twice)/2*(2*math.pi*(x1 + x2 + x3)/3 if axisymmetric else 1.0)
        total -= sum(conductivity*volume*(gradient[0]*s[0] + gradient[1]*s[1])
                     for n, s in zip(nodes, slopes) if n in held)
    return total
