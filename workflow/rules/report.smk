include: "functions/targets.smk"


rule report:
    "Report"
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
    localrule: True
    params:
        values=report_values,
        base=report_base,
    script:
        "../scripts/report.py"
