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
CONDENSATION = {
    "solver_type": "mixed_ulm_linear_solver",
    "tolerance": 1e-9,
    "max_iteration_number": 1000,
    "echo_level": 0,
    "check_dual_lm_condensation": False,
}
"""Where a flank's end cuts a face of the other body, multipliers of neighbouring nodes are coupled by some
percent, and the condensation leaves that out: a step of Newton's method is then less exact, and its residual
is not."""


class SupportAnalysis(StructuralMechanicsAnalysis):
    """Analysis with a part of the displacements of moved.csv on the boundary."""

    def __init__(self, model: Kratos.Model, parameters: Kratos.Parameters) -> None:
        super().__init__(model, parameters)
        self.support_displacement = np.loadtxt("moved.csv", delimiter=",")
        self.part = 0.0
        # By its settings Kratos cannot be asked for both: it refuses entries that it added to them itself.
        multigrid, condensation = (
            Kratos.Parameters(json.dumps(entry)) for entry in (MULTIGRID, CONDENSATION)
        )
        solver = Contact.MixedULMLinearSolver(Kratos.AMGCLSolver(multigrid), condensation)
        self._GetSolver()._linear_solver = solver

    def ApplyBoundaryConditions(self) -> None:
        """Hold the nodes that moved.csv moves."""
        super().ApplyBoundaryConditions()
        nodes = self.model["Structure"].Nodes
        for number, displacement in enumerate(self.support_displacement, 1):
            node = nodes[number]
            for axis, value in zip(AXES, displacement, strict=True):
                if not np.isnan(value):
                    node.Fix(axis)
                    node.SetSolutionStepValue(axis, self.part * value)

    def step(self, part: float) -> bool:
        """Solve under a part of the displacements.

        Parameters
        ----------
        part : float
            Part of the displacements, fraction.

        Returns
        -------
        bool
            Whether the step converged.
        """
        self.part = part
        self.time = self._AdvanceTime()
        self.InitializeSolutionStep()
        self._GetSolver().Predict()
        has_converged = bool(self._GetSolver().SolveSolutionStep())
        self.FinalizeSolutionStep()
        self.OutputSolutionStep()
        return has_converged

    def work(self) -> float:
        """Return the work of the reactions on the whole displacements.

        Returns
        -------
        float
            Work, N mm.
        """
        nodes = self.model["Structure"].Nodes
        reaction = np.array([node.GetSolutionStepValue(Kratos.REACTION) for node in sort_nodes(nodes)])
        return float(np.nansum(self.support_displacement * reaction))


def sort_nodes(nodes: Kratos.NodesArray) -> list[Kratos.Node]:
    """Sort nodes by their number.

    Parameters
    ----------
    nodes : Kratos.NodesArray
        Nodes of a model.

    Returns
    -------
    list[Kratos.Node]
        The sorted nodes.
    """
    return sorted(nodes, key=lambda node: node.Id)


def pressure(node: Kratos.Node) -> float:
    """Return the contact pressure of a node of the slave face, zero elsewhere.

    Parameters
    ----------
    node : Kratos.Node
        The node.

    Returns
    -------
    float
        Pressure, N/mm2.
    """
    return max(-node.GetValue(PRESSURE), 0.0) if node.Is(Kratos.SLAVE) and node.Has(PRESSURE) else 0.0


def follow(analysis: SupportAnalysis, parts: list[float], work: float | None) -> bool:
    """Solve in parts of the displacements, then until the work is met: work grows as a power of the part.

    Parameters
    ----------
    analysis : SupportAnalysis
        The analysis.
    parts : list[float]
        Parts of the displacements, fractions.
    work : float or None
        Work to be met, N mm, or None.

    Returns
    -------
    bool
        Whether all steps converged and the work is met.
    """
    solutions: list[tuple[float, float]] = []
    next_parts = list(parts)
    while next_parts:
        part = next_parts.pop(0)
        if not analysis.step(part):
            return False
        solutions.append((part, analysis.work()))
        print(f"part {part:.6f} of the displacements: work {solutions[-1][1]:.6e} N mm", flush=True)
        if work is None or next_parts:
            continue
        if abs(solutions[-1][1] / work - 1.0) < CLOSE:
            break
        if len(solutions) == len(parts) + FURTHER:
            return False
        (first, before), (last, after) = solutions[-2:]
        if not 0.0 < before < after:
            return False
        exponent = np.log(after / before) / np.log(last / first)
        next_parts.append(float(last * (work / after) ** (1.0 / exponent)))
    return True


def main() -> None:
    start = time.perf_counter()
    steps = json.loads(Path("steps.json").read_text(encoding="ascii"))
    model = Kratos.Model()
    analysis = SupportAnalysis(model, Kratos.Parameters(Path("parameters.json").read_text(encoding="ascii")))
    analysis.Initialize()
    has_converged = follow(analysis, steps["parts"], steps["work"])
    rows = [
        (
            *node.GetSolutionStepValue(Kratos.DISPLACEMENT),
            *node.GetSolutionStepValue(Kratos.REACTION),
            pressure(node),
        )
        for node in sort_nodes(model["Structure"].Nodes)
    ]
    np.savetxt("nodes.csv", rows, delimiter=",", fmt="%.12e")
    usage = resource.getrusage(resource.RUSAGE_SELF)
    result = {
        "converged": has_converged,
        "part": analysis.part,
        "seconds": time.perf_counter() - start,
        "cpu_seconds": usage.ru_utime + usage.ru_stime,
        "gigabytes": usage.ru_maxrss * 1024 / 1e9,
    }
    Path("result.json").write_text(json.dumps(result), encoding="ascii")


if __name__ == "__main__":
    main()
