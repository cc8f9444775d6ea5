def report_tables(wildcards):
    """Tables that the report of a case reads."""
    case = wildcards.case
    names = ["modal/frequencies", "stiffness/harmonics", "dynamics/jumps", "load_sharing/summary"]
    names += ["contact/ltca"] if has_contact(case) else []
    names += ["scorecard"] if scorecard_targets(case) else []
    return [f"results/{case}/{name}.csv" for name in names]


def report_pictures(wildcards):
    """Figures that the report of a case shows."""
    return [file for file in targets(wildcards.case) if file.endswith(".svg")]


rule report:
    input:
        tables=report_tables,
        pictures=report_pictures,
        template=str(ROOT / "facegear" / "report" / "page.html.j2"),
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
