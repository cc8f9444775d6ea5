"""The self-contained HTML report of a case."""

from pathlib import Path

from facegear.build.notes import notes
from facegear.build.tooth_pair import ToothPair
from facegear.build.tooth_pair import pair as tooth_pair
from facegear.contact.pattern import PRESSURE_ARRAYS
from facegear.io import arrays, documents, tables
from facegear.io.atomic import atomic_path
from facegear.lubrication.columns import LOCAL_ARRAYS
from facegear.pipeline.provenance.stage import stage
from facegear.pipeline.report_tables import table_name
from facegear.report.case import case_report
from facegear.report.machine import Base
from facegear.report.viewers import body_view, pair_view
from facegear.strength.columns import ROOT_STRESS_ARRAYS

with stage(snakemake) as run:
    frames = {table_name(path): tables.read(path, allow_empty=True) for path in snakemake.input.tables}
    pictures = {Path(path).stem: Path(path) for path in snakemake.input.pictures}
    case = Path(snakemake.output.html).parent
    manifests = [documents.read(path, ["rule"]) for path in sorted(case.glob("*/*.provenance.json"))]
    pair = documents.read(snakemake.input.pair[0], ["radii_mm"]) if snakemake.input.pair else None
    view, loads = None, None
    if snakemake.input.loads:
        loads = arrays.read(snakemake.input.loads[0], PRESSURE_ARRAYS)
        paths = snakemake.input.stress
        stress = arrays.read(paths[0], ROOT_STRESS_ARRAYS) if paths else None
        paths = snakemake.input.friction
        friction = arrays.read(paths[0], LOCAL_ARRAYS) if paths else None
        design = tooth_pair(ToothPair.of_config(snakemake.params.values["tooth_pair"])).design
        view = pair_view(design, loads, frames["ltca"], stress, friction)
    bodies = None
    if snakemake.input.shapes:
        modes = tables.read(snakemake.input.bodies[0], allow_empty=True)
        bodies = body_view(modes, arrays.read(snakemake.input.shapes[0], {}))
    values = snakemake.params.values
    base = Base(*snakemake.params.base) if snakemake.params.base else None
    statements = notes({**values, "reproduction": values["reproduction"] or None})
    page = case_report(values, frames, pictures, manifests, pair, view, bodies, base, statements, loads)
    with atomic_path(snakemake.output.html) as temporary:
        temporary.write_text(page, encoding="utf-8")
    run.summary(f"{len(pictures)} pictures, {len(frames)} tables, {len(page) / 1e6:.1f} MB")
