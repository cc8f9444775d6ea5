"""Load sharing of the nominal case and of every study's points in one table, and each study's curves."""

from facegear.io import tables
from facegear.load_sharing.collect import NOMINAL, collected
from facegear.load_sharing.tables import SUMMARY_COLUMNS
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    points = [tuple(point) for point in snakemake.params.points]
    summaries = dict(zip([(NOMINAL, NOMINAL), *points], snakemake.input.summaries, strict=True))
    frames = {
        key: tables.read(path, SUMMARY_COLUMNS[:2], allow_empty=True) for key, path in summaries.items()
    }
    labels = dict(zip(points, snakemake.params.labels, strict=True))
    summary = collected(frames, labels)
    curves = dict(zip(points, snakemake.input.curves, strict=True))
    for study, output in zip(snakemake.params.studies, snakemake.output.studies, strict=True):
        paths = {key: path for key, path in curves.items() if key[0] == study}
        own = {key: tables.read(path, ["cycle_fraction"], allow_empty=True) for key, path in paths.items()}
        tables.write(output, collected(own, labels))
    tables.write(snakemake.output.summary, summary)
    irregular = summary.loc[~summary["periodic"].astype(bool), ["study", "point"]].drop_duplicates()
    run.summary(f"{len(frames)} cases, {len(irregular)} of them not periodic")
