include: "functions/targets.smk"


rule report:
    "Report"
    input:
        tables=report_tables,
        pictures=report_pictures,
        pair=report_pair,
        loads=report_loads,
        stress=report_stress,
    output:
        html="results/{case}/report.html",
        manifest="results/{case}/report.provenance.json",
    localrule: True
    params:
        values=report_values,
    script:
        "../scripts/report.py"
