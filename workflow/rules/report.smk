include: "functions/targets.smk"


rule report:
    "Report of a case: one page with all figures and tables."
    input:
        tables=report_tables,
        pictures=report_pictures,
        pair=where_made("geometry", "pair"),
        loads=where_made("contact", "pressure"),
        stress=where_made("root_stress", "stress"),
        friction=where_made("lubrication", "local"),
        bodies=where_made("gear_bodies", "modes"),
        shapes=where_made("gear_bodies", "shapes"),
    output:
        html="results/{case}/report.html",
        manifest="results/{case}/report.provenance.json",
    log:
        "results/{case}/logs/report.log",
    benchmark:
        "results/{case}/benchmarks/rules/report.tsv"
    localrule: True
    conda:
        ENVIRONMENT
    params:
        values=report_values,
        base=report_base,
        code=code("workflow/scripts/report.py"),
    script:
        "../scripts/report.py"
