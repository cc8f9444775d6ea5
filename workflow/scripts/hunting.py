"""Quasi-static load sharing over the hunting cycle, against bearing stiffness, and error by error."""

from facegear.config.machines import wired_machine
from facegear.io import tables
from facegear.load_sharing.hunting import hunting_cycle
from facegear.load_sharing.hunting_tables import bearing_table, cycle_table, group_table, mesh_table
from facegear.load_sharing.sensitivity import bearing_scan, sensitivities
from facegear.provenance.stage import stage
from facegear.stiffness.tables import HARMONICS_COLUMNS

with stage(snakemake) as run:
    params, output = snakemake.params, snakemake.output
    harmonics = tables.read(snakemake.input.harmonics, HARMONICS_COLUMNS)
    built = wired_machine(**params.machine, stiffness=harmonics)
    found = hunting_cycle(built, params.positions)
    groups = group_table(found)
    tables.write(output.meshes, mesh_table(found))
    tables.write(output.groups, groups)
    tables.write(output.bearings, bearing_table(found))
    tables.write(output.cycles, cycle_table(found))
    tables.write(output.scan, bearing_scan(built))
    tables.write(output.sensitivity, sensitivities(built))
    worst = groups.loc[groups["k_gamma"].idxmax()]
    length = f"{worst['mesh_cycles']:.0f} mesh cycles"
    run.summary(f"K_gamma {worst['k_gamma']:.3f} ({worst['group']}) over {length}")
