"""Exact geometry of the tooth pair: limits, contact path, backlash, smallest gaps."""

from facegear.config.base import parse
from facegear.config.tooth_pair import ToothPair, pair_design
from facegear.geometry.analysis import analyse
from facegear.geometry.document import contact_arrays, flank_arrays, pair_record
from facegear.geometry.easeoff import ease_off
from facegear.io import arrays, documents
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    design = pair_design(parse(ToothPair, snakemake.params.section))
    analysis = analyse(design)
    contours = ease_off(design, float(analysis.drive.transmission_error.mean()), (37, 29))
    documents.write(snakemake.output.pair, pair_record(design, analysis))
    arrays.write(snakemake.output.flanks, **flank_arrays(design))
    arrays.write(snakemake.output.contact, **contact_arrays(design, analysis, contours))
    gap = analysis.interference or analysis.smallest
    verdict = "interference" if analysis.interference else "smallest gap"
    run.summary(
        f"contact ratio {analysis.contact_ratio:.3f}, backlash {1e6 * analysis.backlash.min():.1f} um, "
        f"{verdict} {1e6 * gap.gap:.1f} um (gear {gap.gear_part} against pinion {gap.pinion_part}, "
        f"gear radius {1e3 * gap.radius:.1f} mm)"
    )
