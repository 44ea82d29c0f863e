# SPDX-License-Identifier: MIT
"""Runs a case of the references in the present folder by model.json and writes answers.json."""
import json

import KratosMultiphysics as Kratos
import KratosMultiphysics.GeoMechanicsApplication as Geo
import KratosMultiphysics.LinearSolversApplication  # noqa: F401
import KratosMultiphysics.StructuralMechanicsApplication as Structural
from cases import value
from KratosMultiphysics.GeoMechanicsApplication.geomechanics_analysis import GeoMechanicsAnalysis

Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
# Pressure of water is positive in tension there.
FIELDS = {"u_x": (Kratos.DISPLACEMENT_X, 1.0), "u_y": (Kratos.DISPLACEMENT_Y, 1.0),
          "v_x": (Kratos.VELOCITY_X, 1.0), "p_w": (Kratos.WATER_PRESSURE, -1.0)}
LOADS = {"stress_x": Structural.LINE_LOAD_X, "stress_y": Structural.LINE_LOAD_Y}
SUMS = {"force_y": (Kratos.REACTION_Y, 1.0), "outflow_w": (Kratos.REACTION_WATER_PRESSURE, -1.0)}


class Run(GeoMechanicsAnalysis):
    def __init__(self, parameters, given):
        super().__init__(Kratos.Model(), parameters)
        self.given, self.histories = given, []

    def part(self, name="soil"):
        return self._GetSolver().main_model_part.GetSubModelPart(name)

    def ModifyInitialGeometry(self):
        super().ModifyInitialGeometry()
        first = self.given["start"].get("p_w", 0.0)
        for node in self.part().Nodes:
            node.SetSolutionStepValue(Kratos.VOLUME_ACCELERATION_Y, -self.given["gravity"])
            node.SetSolutionStepValue(Kratos.WATER_PRESSURE, -value(first, t=0.0, x=node.X0, y=node.Y0,
                                                                    **self.given["where"]))

    def ApplyBoundaryConditions(self):
        super().ApplyBoundaryConditions()
        t = self._GetSolver().main_model_part.ProcessInfo[Kratos.TIME]
        for node in self.part().Nodes:
            for unknown, names in (("u", ("u_x", "u_y")), ("p_w", ("p_w",))):
                if unknown not in self.given["unknowns"]:
                    for name in names:
                        node.Fix(FIELDS[name][0])
        for condition in self.given["conditions"]:
            for node in self.part(condition["on"]).Nodes:
                for name, (variable, sign) in FIELDS.items():
                    if name in condition:
                        node.Fix(variable)
                        node.SetSolutionStepValue(variable, sign*self.at(condition[name], t, node))
                for name, variable in LOADS.items():
                    if name in condition:
                        node.SetSolutionStepValue(variable, self.at(condition[name], t, node))

    def at(self, expression, t, node):
        return value(expression, t=t, x=node.X0, y=node.Y0, **self.given["where"])

    def RunSolutionLoop(self):
        solver, info = self._GetSolver(), self._GetSolver().main_model_part.ProcessInfo
        solver.solving_strategy.SetRebuildLevel(2)
        before = 0.0
        for end in self.given["ends"]:
            info[Kratos.STEP] += 1
            solver.main_model_part.CloneTimeStep(end)
            info[Kratos.TIME], info[Kratos.DELTA_TIME] = end, end - before
            self.InitializeSolutionStep()
            if not solver.SolveSolutionStep():
                raise SystemExit(f"no convergence in the step to {end} s")
            self.FinalizeSolutionStep()
            self.book()
            before = end

    def book(self):
        row = {}
        for read, rows in self.given["reads"].values():
            if "on" in read:
                variable, sign = SUMS[read["field"]]
                row[read["field"]] = sign*sum(node.GetSolutionStepValue(variable)
                                              for node in self.part(read["on"]).Nodes)
                continue
            for _, node in rows:
                variable, sign = FIELDS[read["field"]]
                row[f"{read['field']} {node}"] = sign*self.part().Nodes[node + 1].GetSolutionStepValue(variable)
        self.histories.append(row)


with open("ProjectParameters.json") as file:
    parameters = Kratos.Parameters(file.read())
with open("model.json") as file:
    given = json.load(file)
run = Run(parameters, given)
run.Run()
answers, ends = {}, given["ends"]
for quantity, (read, rows) in given["reads"].items():
    key = [read["field"] if "on" in read else f"{read['field']} {node}" for _, node in rows]
    answers[quantity] = [
        read.get("scale", 1.0)*(run.histories[min(range(len(ends)), key=lambda i: abs(ends[i] - t))][name] if t > 0
                                else 0.0) + read.get("offset", 0.0) for (t, _), name in zip(rows, key)]
with open("answers.json", "w") as file:
    json.dump(answers, file)
