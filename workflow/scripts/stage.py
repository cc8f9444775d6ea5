"""One stage: what it takes from files, its call, what it gives to files."""

from importlib import import_module

from facegear.provenance.stage import stage

with stage(snakemake) as run:
    # Not imported above, where it would count as code of every rule: a new row makes no other stage again.
    stages = import_module("facegear.pipeline.table").STAGES
