"""Root stress beside that of finer meshes at every resolution, and what reading it costs."""

import pandas as pd

from facegear.build.tooth_pair import ToothPair, contact_setup
from facegear.io import tables
from facegear.pipeline.provenance.stage import stage
from facegear.schema.contact import Contact, Mesh
from validation.contact.stress_benchmark import stress_costs

with stage(snakemake) as run:
    params = snakemake.params
    parts = [tables.read(path, ["level", "body", "error_percent"]) for path in snakemake.input]
    tables.write(snakemake.output.table, pd.concat(parts, ignore_index=True))
    mesh = {**params.mesh, "thin_fillet": True}  # as where root stress is asked for
    setup = contact_setup(
        ToothPair.of_config(params.tooth_pair), Mesh.of_config(mesh), Contact.of_config(params.contact)
    )
    rows = [
        stress_costs(setup.pair.design, body, setup.sizes, setup.pair.material(body), setup.plan)
        for body in ("pinion", "face_gear")
    ]
    costs = pd.DataFrame(rows)
    tables.write(snakemake.output.costs, costs)
    overhead = 100.0 * (costs["with_gauges_cpu_s"].sum() / costs["compliance_cpu_s"].sum() - 1.0)
    run.summary(f"gauges add {overhead:.0f} % to the compliance of both bodies")
