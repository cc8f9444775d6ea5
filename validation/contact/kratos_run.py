"""Runs in an environment with Kratos, in the folder that holds its input (`kratos.py`).

Reads pair.mdpa, materials.json, parameters.json and moved.csv: displacements of the nodes in order, nan where
they are free. Writes result.json and nodes.csv: number, vertical reaction and contact pressure of the nodes.
"""

import json
import resource
import time
from pathlib import Path

import KratosMultiphysics as Kratos
import KratosMultiphysics.ContactStructuralMechanicsApplication as Contact
import KratosMultiphysics.LinearSolversApplication
import numpy as np
from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import (
    StructuralMechanicsAnalysis,
)

AXES = Kratos.DISPLACEMENT_X, Kratos.DISPLACEMENT_Y, Kratos.DISPLACEMENT_Z
PRESSURE = Contact.AUGMENTED_NORMAL_CONTACT_PRESSURE


class Moved(StructuralMechanicsAnalysis):
    """Displacements of moved.csv on the boundary."""

    def ApplyBoundaryConditions(self) -> None:
        """Hold the nodes that moved.csv moves."""
        super().ApplyBoundaryConditions()
        part = self.model["Structure"]
        for number, displacement in enumerate(np.loadtxt("moved.csv", delimiter=","), 1):
            node = part.Nodes[number]
            for axis, value in zip(AXES, displacement, strict=True):
                if not np.isnan(value):
                    node.Fix(axis)
                    node.SetSolutionStepValue(axis, value)


def pressure(node: Kratos.Node) -> float:
    """Contact pressure of a node of the slave face, zero elsewhere, N/mm2."""
    return max(-node.GetValue(PRESSURE), 0.0) if node.Is(Kratos.SLAVE) and node.Has(PRESSURE) else 0.0


def main() -> None:
    start = time.perf_counter()
    model = Kratos.Model()
    analysis = Moved(model, Kratos.Parameters(Path("parameters.json").read_text(encoding="ascii")))
    analysis.Initialize()
    converged = True
    while analysis.KeepAdvancingSolutionLoop():
        analysis.time = analysis._AdvanceTime()
        analysis.InitializeSolutionStep()
        analysis._GetSolver().Predict()
        converged = bool(analysis._GetSolver().SolveSolutionStep()) and converged
        analysis.FinalizeSolutionStep()
        analysis.OutputSolutionStep()
    seconds = time.perf_counter() - start
    nodes = sorted(model["Structure"].Nodes, key=lambda node: node.Id)
    rows = [(node.Id, node.GetSolutionStepValue(Kratos.REACTION)[1], pressure(node)) for node in nodes]
    np.savetxt("nodes.csv", rows, delimiter=",", fmt="%.12e")
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9
    result = {"converged": converged, "seconds": seconds, "gigabytes": memory}
    Path("result.json").write_text(json.dumps(result), encoding="ascii")


if __name__ == "__main__":
    main()
