"""Contact of the cases of the studies side by side, as a table and as figures."""

from facegear.contact.columns import LTCA_COLUMNS, PRESSURE_ARRAYS
from facegear.contact.studies import StudiedContact, study_table
from facegear.io import arrays, documents, tables
from facegear.plots.contact_study import contact_study, pattern_study
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    given, files = snakemake.params, snakemake.input
    cases = [
        StudiedContact(
            *names,
            pair=documents.read(pair, ["unloaded", "backlash_um"]),
            ltca=tables.read(ltca, LTCA_COLUMNS),
            by_torque=tables.read(by_torque, ["torque_n_m", "path_radius_mm"]),
            pressure=arrays.read(pressure, PRESSURE_ARRAYS),
        )
        for names, pair, ltca, by_torque, pressure in zip(
            given.points, files.pair, files.ltca, files.by_torque, files.pressure, strict=True
        )
    ]
    table = study_table(cases)
    tables.write(snakemake.output.table, table)
    drawn = iter(zip(snakemake.output.svg, snakemake.output.png, strict=True))
    for study, title in given.titles.items():
        shown = [cases[0], *(case for case in cases if case.study == study)]
        save(contact_study(shown, given.torque, title), *next(drawn))
        save(pattern_study(shown, given.torque), *next(drawn))
    shift = table.loc[table["path_shift_mm"].abs().idxmax()]
    largest = f"{shift['path_shift_mm']:.2f} mm ({shift['label']})"
    run.summary(f"{len(cases) - 1} cases; largest shift of the contact path {largest}")
