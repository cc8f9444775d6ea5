include: "functions/scorecard.smk"


rule scorecard_set:
    "Claims of the paper with another set of undisclosed inputs"
    input:
        ltca=shared("contact", "ltca"),
        claims=REPRODUCTION.claims if REPRODUCTION else [],
    output:
        outcomes="results/{case}/scorecard/sets/{set}.csv",
        manifest="results/{case}/scorecard/sets/{set}.provenance.json",
    wildcard_constraints:
        set="[A-Za-z0-9_]+",
    resources:
        mem_mb=1300,
        runtime=30,
    params:
        cases=set_cases,
        points=STUDY_POINTS,
    script:
        "../scripts/scorecard_set.py"


rule scorecard:
    "Scorecard"
    input:
        claims=REPRODUCTION.claims if REPRODUCTION else [],
        sets=REPRODUCTION.sets if REPRODUCTION and REPRODUCTION.sets else [],
        outcomes=expand(rules.scorecard_set.output.outcomes, set=list(SETS), allow_missing=True),
        frequencies=rules.modal.output.frequencies,
        tvms=rules.stiffness.output.tvms,
        load_dependence=rules.load_dependence.output.table,
        response=rules.dynamics_response.output.response,
        spectrum=rules.dynamics_response.output.spectrum,
        sweep=rules.dynamics_sweep.output.sweep,
        jumps=rules.dynamics_sweep.output.jumps,
        reference=rules.load_sharing_reference.output.reference,
        sharing=rules.load_sharing_summary.output.summary,
        nominal=rules.load_sharing.output.curve,
        studies=rules.load_sharing_summary.output.studies,
    output:
        csv="results/{case}/scorecard.csv",
        html="results/{case}/scorecard.html",
        manifest="results/{case}/scorecard.provenance.json",
    resources:
        mem_mb=1300,
    params:
        values=sections("tooth_pair", "transmission", "mesh_stiffness"),
    script:
        "../scripts/scorecard.py"
