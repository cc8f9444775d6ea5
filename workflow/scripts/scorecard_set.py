"""What the criteria find with another set of undisclosed inputs."""

from facegear.config.base import parse
from facegear.config.dynamics import Dynamics, settings, sweep_plan
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.machines import case_machine
from facegear.config.stiffness import MeshStiffness, stiffness_request
from facegear.contact.columns import LTCA_COLUMNS
from facegear.io import tables
from facegear.paper.scorecard.claims import read_claims
from facegear.paper.scorecard.rows import outcome_table
from facegear.paper.scorecard.simulated import RunSettings, simulated_tables
from facegear.provenance.stage import stage
from facegear.stiffness.source import stiffness_from_contact
from facegear.stiffness.tables import series_of

with stage(snakemake) as run:
    base, *others = snakemake.params.cases
    request = stiffness_request(parse(MeshStiffness, base["mesh_stiffness"]))
    stiffness = series_of(
        stiffness_from_contact(tables.read(snakemake.input.ltca, LTCA_COLUMNS), request).harmonics
    )
    dynamics = parse(Dynamics, base["dynamics"])
    points = [tuple(point) for point in snakemake.params.points]
    found = simulated_tables(
        case_machine(base, stiffness),
        {point: case_machine(values, stiffness) for point, values in zip(points, others, strict=True)},
        RunSettings(
            dynamics.speed_rpm,
            settings(dynamics.accuracy),
            sharing_options(parse(LoadSharing, base["load_sharing"])),
            sweep_plan(dynamics.sweep),
        ),
    )
    claims = [claim for claim in read_claims(snakemake.input.claims).claims if claim.dynamic]
    outcomes = outcome_table(claims, found)
    tables.write(snakemake.output.outcomes, outcomes)
    run.summary(
        f"{outcomes['holds'].sum()} of {len(outcomes)} claims hold with set {snakemake.wildcards.set}"
    )
