"""Root stress of both gears."""

from facegear.contact.columns import LOAD_ARRAYS
from facegear.contact.gear_flank import STORED, from_arrays
from facegear.io import arrays
from facegear.io.files import write_all
from facegear.provenance.stage import stage
from facegear.stages.root_stress import root_stress

with stage(snakemake) as run:
    bodies = [from_arrays(arrays.read(snakemake.input[name], STORED)) for name in ("pinion", "face_gear")]
    found = root_stress(*bodies, arrays.read(snakemake.input.loads, LOAD_ARRAYS))
    write_all(found.content, snakemake.output)
    run.summary(found.summary)
