"""Pictures of the tooth pair."""

from facegear.io import arrays, documents
from facegear.plots.style import save
from facegear.plots.tooth_pair import separation, tooth_pair, tooth_sections
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    record = documents.read(snakemake.input.pair, ["design_si", "radii_mm", "limits_mm", "smallest_gap"])
    flanks = arrays.read(snakemake.input.flanks, {"pinion_section": (None, 2), "gear_flank": (None, None, 3)})
    contact = arrays.read(snakemake.input.contact, {"contour_gap": (None, None), "path_roll": (None,)})
    drawn = (tooth_pair(record, flanks), tooth_sections(record, flanks), separation(record, flanks, contact))
    for figure, svg, png in zip(drawn, snakemake.output.svg, snakemake.output.png, strict=True):
        save(figure, svg, png)
