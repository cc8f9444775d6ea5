include: "functions/scorecard.smk"


rule scorecard:
    "Scorecard"
    input:
        claims=REPRODUCTION.claims if REPRODUCTION else [],
        sets=stored("sets"),
        runs=stored("runs"),
        random=stored("random"),
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
    log:
        "results/{case}/logs/scorecard.log",
    benchmark:
        "results/{case}/benchmarks/rules/scorecard.tsv"
    priority: 10
    conda:
        ENVIRONMENT
    resources:
        mem_mb=1300,
    params:
        values=sections("tooth_pair", "transmission", "mesh_stiffness"),
        case=whole_case,
        code=code("paper/scripts/scorecard.py"),
    script:
        "../scripts/scorecard.py"
