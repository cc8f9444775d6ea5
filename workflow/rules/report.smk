include: "functions/report.smk"


rule report:
    input:
        tables=report_tables,
        pictures=report_pictures,
    output:
        html="results/{case}/report.html",
        manifest="results/{case}/report.provenance.json",
    log:
        "results/{case}/logs/report.log",
    benchmark:
        "results/{case}/benchmarks/rules/report.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=5,
    params:
        values=lambda wildcards: CASES[wildcards.case],
        code=fingerprint("report.py"),
    message:
        "report of {wildcards.case}"
    script:
        "../scripts/report.py"
