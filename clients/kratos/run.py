# SPDX-License-Identifier: MIT
"""Runs a project of Kratos in the present folder and writes the stress of its first point at every step.

usage: run.py [STRAINS.csv | --top]
STRAINS.csv: six strains a step (11, 22, 33, 12, 13, 23, shear as engineering strain), imposed on every node; without it
the project's own constraints move the nodes. --top: vertical displacement of the highest node instead of stress.
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


strains = None
if len(sys.argv) > 1 and sys.argv[1] != "--top":
    with open(sys.argv[1]) as file:
        strains = [[float(x) for x in row] for row in csv.reader(file)]
with open("ProjectParameters.json") as file:
    analysis = Recorded(Kratos.Parameters(file.read()), strains)
analysis.Run()
with open("stress.csv", "w") as file:
    csv.writer(file).writerows(analysis.rows)
