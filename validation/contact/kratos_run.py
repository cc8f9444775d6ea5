"""Runs in an environment with Kratos, in the folder that holds its input (`kratos.py`).

Reads pair.mdpa, materials.json, parameters.json, steps.json and moved.csv: displacements of the nodes in
order, nan where they are free. Writes result.json and nodes.csv: displacement, reaction and contact pressure
of the nodes.
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
CLOSE = 2e-3
"""Relative distance from the work that ends the steps, and how many of them may follow those asked for."""
FURTHER = 4
MULTIGRID = {
    "solver_type": "amgcl",
    "smoother_type": "ilu0",
    "krylov_type": "lgmres",
    "coarsening_type": "aggregation",
    "max_iteration": 1000,
    "tolerance": 1e-9,
    "scaling": False,
    "block_size": 3,
    "use_block_matrices_if_possible": True,
    "coarse_enough": 1000,
    "provide_coordinates": False,
    "verbosity": 1,
}
CONDENSED = {
    "solver_type": "mixed_ulm_linear_solver",
    "tolerance": 1e-9,
    "max_iteration_number": 1000,
    "echo_level": 0,
    "check_dual_lm_condensation": False,
}
"""Where a flank's end cuts a face of the other body, multipliers of neighbouring nodes are coupled by some
percent, and the condensation leaves that out: a step of Newton's method is then less exact, and its residual
is not."""


class Moved(StructuralMechanicsAnalysis):
    """A part of the displacements of moved.csv on the boundary."""

    def __init__(self, model: Kratos.Model, parameters: Kratos.Parameters) -> None:
        super().__init__(model, parameters)
        self.moved = np.loadtxt("moved.csv", delimiter=",")
        self.part = 0.0
        # By its settings Kratos cannot be asked for both: it refuses entries that it added to them itself.
        multigrid, condensed = (Kratos.Parameters(json.dumps(entry)) for entry in (MULTIGRID, CONDENSED))
        solver = Contact.MixedULMLinearSolver(Kratos.AMGCLSolver(multigrid), condensed)
        self._GetSolver()._linear_solver = solver

    def ApplyBoundaryConditions(self) -> None:
        """Hold the nodes that moved.csv moves."""
        super().ApplyBoundaryConditions()
        nodes = self.model["Structure"].Nodes
        for number, displacement in enumerate(self.moved, 1):
            node = nodes[number]
            for axis, value in zip(AXES, displacement, strict=True):
                if not np.isnan(value):
                    node.Fix(axis)
                    node.SetSolutionStepValue(axis, self.part * value)

    def step(self, part: float) -> bool:
        """Solve under a part of the displacements; whether it converged."""
        self.part = part
        self.time = self._AdvanceTime()
        self.InitializeSolutionStep()
        self._GetSolver().Predict()
        converged = bool(self._GetSolver().SolveSolutionStep())
        self.FinalizeSolutionStep()
        self.OutputSolutionStep()
        return converged

    def work(self) -> float:
        """Of the reactions on the whole displacements, N mm."""
        nodes = self.model["Structure"].Nodes
        reaction = np.array([node.GetSolutionStepValue(Kratos.REACTION) for node in ordered(nodes)])
        return float(np.nansum(self.moved * reaction))


def ordered(nodes: Kratos.NodesArray) -> list[Kratos.Node]:
    return sorted(nodes, key=lambda node: node.Id)


def pressure(node: Kratos.Node) -> float:
    """Contact pressure of a node of the slave face, zero elsewhere, N/mm2."""
    return max(-node.GetValue(PRESSURE), 0.0) if node.Is(Kratos.SLAVE) and node.Has(PRESSURE) else 0.0


def follow(analysis: Moved, parts: list[float], work: float | None) -> bool:
    """Solve in parts of the displacements, then until `work` is met: work grows as a power of the part."""
    seen: list[tuple[float, float]] = []
    wanted = list(parts)
    while wanted:
        part = wanted.pop(0)
        if not analysis.step(part):
            return False
        seen.append((part, analysis.work()))
        print(f"part {part:.6f} of the displacements: work {seen[-1][1]:.6e} N mm", flush=True)
        if work is None or wanted:
            continue
        if abs(seen[-1][1] / work - 1.0) < CLOSE:
            break
        if len(seen) == len(parts) + FURTHER:
            return False
        (first, before), (last, after) = seen[-2:]
        if not 0.0 < before < after:
            return False
        exponent = np.log(after / before) / np.log(last / first)
        wanted.append(float(last * (work / after) ** (1.0 / exponent)))
    return True


def main() -> None:
    start = time.perf_counter()
    asked = json.loads(Path("steps.json").read_text(encoding="ascii"))
    model = Kratos.Model()
    analysis = Moved(model, Kratos.Parameters(Path("parameters.json").read_text(encoding="ascii")))
    analysis.Initialize()
    converged = follow(analysis, asked["parts"], asked["work"])
    rows = [
        (
            *node.GetSolutionStepValue(Kratos.DISPLACEMENT),
            *node.GetSolutionStepValue(Kratos.REACTION),
            pressure(node),
        )
        for node in ordered(model["Structure"].Nodes)
    ]
    np.savetxt("nodes.csv", rows, delimiter=",", fmt="%.12e")
    usage = resource.getrusage(resource.RUSAGE_SELF)
    result = {
        "converged": converged,
        "part": analysis.part,
        "seconds": time.perf_counter() - start,
        "cpu_seconds": usage.ru_utime + usage.ru_stime,
        "gigabytes": usage.ru_maxrss * 1024 / 1e9,
    }
    Path("result.json").write_text(json.dumps(result), encoding="ascii")


if __name__ == "__main__":
    main()
