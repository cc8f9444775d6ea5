from facegear.config.base import parse as parse_section
from facegear.config.dynamics import Dynamics as DynamicsSection


def dynamics_targets(case):
    """Final outputs of this stage for a case: response, sweep, figures."""
    figures = ["fig09", "fig10", "fig11", "fig12", "campbell", "waterfall"]
    return [
        f"results/{case}/dynamics/response.csv",
        f"results/{case}/dynamics/sweep.csv",
        *(f"results/{case}/figures/{name}.svg" for name in figures),
    ]


def sweep_chunks(wildcards):
    """Chunk files of a case, direction by direction."""
    sweep = parse_section(DynamicsSection, CASES[wildcards.case]["dynamics"]).sweep
    return [
        f"results/{wildcards.case}/dynamics/chunks/{direction}_{number}.npz"
        for direction in sweep.directions
        for number in range(sweep.chunks)
    ]


def dynamics_benchmark_targets(case):
    """Speed against error of the dynamics, for the target `benchmarks`."""
    names = ["dynamics.csv", "dynamics_sweep.csv", "dynamics_convergence.csv"]
    return [f"results/{case}/benchmarks/{name}" for name in names]
