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
        values=sections(
            *("case", "tooth_pair", "transmission", "mesh", "contact"),
            *("mesh_stiffness", "dynamics", "studies", "reproduction"),
        ),
    script:
        "../scripts/report.py"
