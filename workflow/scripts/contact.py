"""Loaded tooth contact at every position and torque."""

from facegear.contact.gear_flank import STORED, from_arrays
from facegear.contact.pattern import pressure_surface
from facegear.io import arrays
from facegear.io.files import write_all
from facegear.io.meshes import write_vtu
from facegear.provenance.stage import stage
from facegear.stages.contact import contact

with stage(snakemake) as run:
    bodies = [from_arrays(arrays.read(snakemake.input[name], STORED)) for name in ("pinion", "face_gear")]
    found = contact(*bodies, **snakemake.params.needs)
    write_all(found.content, snakemake.output)
    write_vtu(snakemake.output.vtu, *pressure_surface(found.content["pressure"]))
    run.summary(found.summary)
