"""The scorecard: every number and statement of the paper beside ours."""

import pandas as pd

from facegear.io import tables
from facegear.io.atomic import atomic_path
from facegear.pipeline.provenance.stage import stage
from facegear.report.machine import inputs_in_words
from facegear.sharing.tables import NOMINAL, collect_tables
from paper.scorecard.claims import read_claims
from paper.scorecard.page import counts, render
from paper.scorecard.rows import outcome_table, scorecard
from paper.stored.evidence import stored_evidence

TABLES = (
    *("frequencies", "tvms", "load_dependence", "response", "spectrum"),
    *("sweep", "jumps", "reference", "sharing"),
)

with stage(snakemake) as run:
    files, values = snakemake.input, snakemake.params.values
    inputs = {name: tables.read(files[name], allow_empty=name == "jumps") for name in TABLES}
    nominal = collect_tables({(NOMINAL, NOMINAL): tables.read(files.nominal)})
    inputs["curves"] = pd.concat([nominal, *(tables.read(path) for path in files.studies)], ignore_index=True)
    for name in ("sharing", "curves"):
        inputs[name]["point"] = inputs[name]["point"].astype(str)
    load = values["mesh_stiffness"]["torque_n_m"]
    inputs["inputs"] = pd.DataFrame({"stiffness_torque_n_m": [load]})
    claims = read_claims(files.claims)
    outcomes = outcome_table(claims.claims, inputs)
    evidence = stored_evidence(claims.claims, snakemake.params.case, files.sets, files.runs, files.random)
    frame = scorecard(claims.claims, outcomes, evidence.runs, evidence.rates)
    tables.write(snakemake.output.csv, frame)
    words = inputs_in_words(values)
    page = render(frame, claims.source, words, evidence.sets, evidence.starts, evidence.chance)
    with atomic_path(snakemake.output.html) as temporary:
        temporary.write_text(page, encoding="utf-8")
    run.summary(", ".join(f"{number} rows {name}" for name, number in counts(frame).items()))
