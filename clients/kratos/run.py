# SPDX-License-Identifier: MIT
"""Runs a project of Kratos in the present folder and writes the stress of its first point at every step.

usage: run.py [STRAINS.csv | --top | --ground UNIT_WEIGHT K_0 SURCHARGE]
STRAINS.csv: six strains a step (11, 22, 33, 12, 13, 23, shear as engineering strain), imposed on every node; without it
the project's own constraints move the nodes. --top: vertical displacement of the highest node instead of stress.
--ground: every point starts with the stress of its depth below y = 1 [kN/m3, -, kPa]; iterations of the step and the
largest displacement come behind the stress.
"""
import csv
import sys

import KratosMultiphysics as Kratos
import KratosMultiphysics.LinearSolversApplication  # noqa: F401
from KratosMultiphysics.GeoMechanicsApplication.geomechanics_analysis import GeoMechanicsAnalysis

Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)


class Recorded(GeoMechanicsAnalysis):
    def __init__(self, parameters, strains):
        super().__init__(Kratos.Model(), parameters)
        self.strains, self.rows = strains, []

    def ModifyInitialGeometry(self):
        """The stress must be there before the solver begins: the law takes it over once."""
        super().ModifyInitialGeometry()
        if sys.argv[1:2] != ["--ground"]:
            return
        weight, k_0, surcharge = map(float, sys.argv[2:])
        part = self._GetSolver().main_model_part
        for node in part.Nodes:
            node.SetSolutionStepValue(Kratos.VOLUME_ACCELERATION_Y, -9.81)
        for element in part.Elements:
            geometry = element.GetGeometry()
            shares, heights = geometry.ShapeFunctionsValues(), [node.Y0 for node in geometry]
            vertical = [-(surcharge + weight*(1.0 - sum(shares[i, k]*y for k, y in enumerate(heights))))
                        for i in range(shares.Size1())]
            element.SetValuesOnIntegrationPoints(
                Kratos.CAUCHY_STRESS_VECTOR, [Kratos.Vector([k_0*s, s, k_0*s, 0.0]) for s in vertical], 4,
                part.ProcessInfo)

    def ApplyBoundaryConditions(self):
        super().ApplyBoundaryConditions()
        if self.strains is None:
            return
        part = self._GetSolver().main_model_part
        e = self.strains[round(part.ProcessInfo[Kratos.TIME]) - 1]
        for node in part.Nodes:  # u = H x with a triangular H: its symmetric part is the strain
            x, y, z = node.X0, node.Y0, node.Z0
            moved = (e[0]*x + e[3]*y + e[4]*z, e[1]*y + e[5]*z, e[2]*z)
            for variable, value in zip((Kratos.DISPLACEMENT_X, Kratos.DISPLACEMENT_Y, Kratos.DISPLACEMENT_Z), moved):
                node.Fix(variable)
                node.SetSolutionStepValue(variable, value)

    def FinalizeSolutionStep(self):
        super().FinalizeSolutionStep()
        part = self._GetSolver().main_model_part
        element = next(iter(part.Elements))
        if sys.argv[1:] == ["--top"]:
            top = max(part.Nodes, key=lambda node: node.Y0)
            self.rows.append([repr(top.GetSolutionStepValue(Kratos.DISPLACEMENT_Y))])
            return
        stress = element.CalculateOnIntegrationPoints(Kratos.CAUCHY_STRESS_VECTOR, part.ProcessInfo)[0]
        self.rows.append([repr(float(s)) for s in stress])
        if sys.argv[1:2] == ["--ground"]:
            moved = max(abs(node.GetSolutionStepValue(Kratos.DISPLACEMENT_Y)) for node in part.Nodes)
            self.rows[-1] += [str(part.ProcessInfo[Kratos.NL_ITERATION_NUMBER]), repr(moved)]


strains = None
if len(sys.argv) > 1 and not sys.argv[1].startswith("--"):
    with open(sys.argv[1]) as file:
        strains = [[float(x) for x in row] for row in csv.reader(file)]
with open("ProjectParameters.json") as file:
    analysis = Recorded(Kratos.Parameters(file.read()), strains)
analysis.Run()
with open("stress.csv", "w") as file:
    csv.writer(file).writerows(analysis.rows)
