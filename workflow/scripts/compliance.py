"""Flank compliance of one body."""

from facegear.config.base import parse
from facegear.config.contact import Contact, contact_plan
from facegear.config.mesh import Mesh, mesh_sizes
from facegear.config.tooth_pair import ToothPair, materials, pair_design
from facegear.contact.gear_flank import to_arrays
from facegear.contact.pair import gear_flank
from facegear.contact.resolution import check_resolution
from facegear.io import arrays, tables
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    tables.read(snakemake.input.quality)
    section = parse(ToothPair, snakemake.params.tooth_pair)
    design, body = pair_design(section), snakemake.wildcards.body
    plan = contact_plan(parse(Contact, snakemake.params.contact))
    sizes = mesh_sizes(parse(Mesh, snakemake.params.mesh), design.module)
    check_resolution(design, materials(section), sizes, plan)
    material = dict(zip(("pinion", "face_gear"), materials(section), strict=True))[body]
    flank = gear_flank(design, body, sizes, material, plan)
    arrays.write(snakemake.output.arrays, **to_arrays(flank))
    run.summary(f"{len(flank.compliance.own)} flank nodes, {len(flank.compliance.others)} teeth coupled")
