"""Root stress of both gears."""

from facegear.contact.columns import LOAD_ARRAYS
from facegear.contact.gear_flank import STORED, from_arrays
from facegear.io import arrays
from facegear.io.files import write_all
from facegear.io.meshes import write_vtu
from facegear.provenance.stage import stage
from facegear.stages.root_stress import root_stress
from facegear.strength.fillet_surface import stress_surface

with stage(snakemake) as run:
    bodies = [from_arrays(arrays.read(snakemake.input[name], STORED)) for name in ("pinion", "face_gear")]
    found = root_stress(*bodies, arrays.read(snakemake.input.loads, LOAD_ARRAYS))
    write_all(found.content, snakemake.output)
    write_vtu(snakemake.output.vtu, *stress_surface(found.content["stress"]))
    run.summary(found.summary)
