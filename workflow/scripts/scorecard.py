"""The scorecard: every number and statement of the paper beside ours."""

import pandas as pd

from facegear.io import tables
from facegear.io.atomic import atomic_path
from facegear.load_sharing.collect import NOMINAL, collected
from facegear.paper.scorecard.claims import read_claims
from facegear.paper.scorecard.page import counts, render
from facegear.paper.scorecard.rows import OUTCOME_COLUMNS, outcome_table, scorecard
from facegear.provenance.stage import stage
from facegear.report.inputs import inputs_in_words

STORED = (
    *("frequencies", "tvms", "load_dependence", "response", "spectrum"),
    *("sweep", "jumps", "reference", "sharing"),
)

with stage(snakemake) as run:
    files = snakemake.input
    found = {name: tables.read(files[name], allow_empty=name == "jumps") for name in STORED}
    nominal = collected({(NOMINAL, NOMINAL): tables.read(files.nominal)})
    found["curves"] = pd.concat([nominal, *(tables.read(path) for path in files.studies)], ignore_index=True)
    for name in ("sharing", "curves"):
        found[name]["point"] = found[name]["point"].astype(str)
    load = snakemake.params.values["mesh_stiffness"]["torque_n_m"]
    found["inputs"] = pd.DataFrame({"stiffness_torque_n_m": [load]})
    claims = read_claims(files.claims)
    own = outcome_table(claims.claims, found)
    others = [tables.read(path, OUTCOME_COLUMNS[:1]) for path in files.outcomes]
    frame = scorecard(claims.claims, own, others)
    tables.write(snakemake.output.csv, frame)
    sets = pd.read_csv(files.sets) if files.sets else pd.DataFrame()
    page = render(frame, claims.source, inputs_in_words(snakemake.params.values), sets)
    with atomic_path(snakemake.output.html) as temporary:
        temporary.write_text(page, encoding="utf-8")
    run.summary(", ".join(f"{number} rows {name}" for name, number in counts(frame).items()))
