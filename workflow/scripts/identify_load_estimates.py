"""Whether the load of the paper's mean stiffness agrees with the one that the config names."""

from facegear.config.base import parse
from facegear.config.stiffness import MeshStiffness
from facegear.contact.columns import LTCA_FINITE
from facegear.io import tables
from facegear.paper.identify.load_estimates import estimate_table
from facegear.provenance.stage import stage
from facegear.stiffness.curve import load_table

with stage(snakemake) as run:
    files = snakemake.input
    stiffness = parse(MeshStiffness, snakemake.params.stiffness)
    paths = dict(zip(["config", *snakemake.params.designs], [files.ltca, *files.designs], strict=True))
    loads = {name: load_table(tables.read(path, LTCA_FINITE)) for name, path in paths.items()}
    estimates = estimate_table(loads, stiffness.mean_n_per_m, stiffness.definition, stiffness.torque_n_m)
    tables.write(snakemake.output.estimates, estimates)
    ratios = ", ".join(f"{row.design} {row.ratio_to_paper:.2f}" for row in estimates.itertuples())
    run.summary(f"mean stiffness at the config's load over the mean it names: {ratios}")
