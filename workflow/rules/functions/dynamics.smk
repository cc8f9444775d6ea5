from facegear.config.base import parse as parse_section  # `parse` is a name of Snakemake
from facegear.config.dynamics import Dynamics as DynamicsSection


def sweep_chunks(wildcards):
    """Chunk files of a case, direction by direction."""
    sweep = parse_section(DynamicsSection, CASES[wildcards.case]["dynamics"]).sweep
    return expand(
        rules.dynamics_sweep_chunk.output.chunk,
        case=wildcards.case,
        direction=sweep.directions,
        number=range(sweep.chunks),
    )
