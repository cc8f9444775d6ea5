"""Loaded tooth contact at every position and torque."""

from facegear.config.base import parse
from facegear.config.contact import Contact, contact_plan
from facegear.config.tooth_pair import ToothPair, pair_design
from facegear.contact.gear_flank import STORED, from_arrays
from facegear.contact.ltca import even_positions, loaded_contact
from facegear.contact.pair import contact_model
from facegear.contact.tables import ltca_table, pressure_arrays, pressure_surface
from facegear.io import arrays, tables
from facegear.io.meshes import write_vtu
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    design = pair_design(parse(ToothPair, snakemake.params.tooth_pair))
    plan = contact_plan(parse(Contact, snakemake.params.contact))
    bodies = [from_arrays(arrays.read(snakemake.input[name], STORED)) for name in ("pinion", "face_gear")]
    model = contact_model(design, *bodies)
    results = loaded_contact(model, even_positions(plan.positions), plan.torques, plan.options)
    table, pressures = ltca_table(results), pressure_arrays(results, model.flanks.pinion)
    tables.write(snakemake.output.ltca, table)
    arrays.write(snakemake.output.pressure, **pressures)
    write_vtu(snakemake.output.vtu, *pressure_surface(pressures))
    worst, mean = table["kkt_residual"].max(), table["k_average_n_per_m"].mean()
    run.summary(f"{len(table)} contacts, mean stiffness {mean:.4g} N/m, worst KKT residual {worst:.0e}")
