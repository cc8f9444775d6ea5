include: "functions/scorecard.smk"


rule scorecard_set:
    input:
        ltca=upstream("contact", "contact/ltca.csv"),
        claims=REPRODUCTION.claims if REPRODUCTION else [],
    output:
        outcomes="results/{case}/scorecard/sets/{set}.csv",
        manifest="results/{case}/scorecard/sets/{set}.provenance.json",
    log:
        "results/{case}/logs/scorecard_set_{set}.log",
    benchmark:
        "results/{case}/benchmarks/rules/scorecard_set_{set}.tsv"
    wildcard_constraints:
        set="[A-Za-z0-9_]+",
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=1200,
        runtime=30,
    params:
        cases=set_cases,
        points=STUDY_POINTS,
        code=fingerprint("scorecard_set.py"),
    message:
        "claims of the paper with set {wildcards.set} of undisclosed inputs"
    script:
        "../scripts/scorecard_set.py"


rule scorecard:
    input:
        claims=REPRODUCTION.claims if REPRODUCTION else [],
        sets=REPRODUCTION.sets if REPRODUCTION and REPRODUCTION.sets else [],
        outcomes=lambda wildcards: [
            f"results/{wildcards.case}/scorecard/sets/{name}.csv" for name in stored_sets()
        ],
        frequencies="results/{case}/modal/frequencies.csv",
        tvms="results/{case}/stiffness/tvms.csv",
        load_dependence="results/{case}/stiffness/load_dependence.csv",
        response="results/{case}/dynamics/response.csv",
        spectrum="results/{case}/dynamics/spectrum.csv",
        sweep="results/{case}/dynamics/sweep.csv",
        jumps="results/{case}/dynamics/jumps.csv",
        reference="results/{case}/load_sharing/reference.csv",
        sharing="results/{case}/load_sharing/summary.csv",
        nominal="results/{case}/load_sharing/nominal.csv",
        studies=[f"results/{{case}}/load_sharing/{study.name}.csv" for study in STUDIES],
    output:
        csv="results/{case}/scorecard.csv",
        html="results/{case}/scorecard.html",
        manifest="results/{case}/scorecard.provenance.json",
    log:
        "results/{case}/logs/scorecard.log",
    benchmark:
        "results/{case}/benchmarks/rules/scorecard.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=800,
        runtime=5,
    params:
        values=lambda wildcards: CASES[wildcards.case],
        code=fingerprint("scorecard.py"),
    message:
        "scorecard of {wildcards.case}"
    script:
        "../scripts/scorecard.py"
