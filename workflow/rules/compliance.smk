include: "functions/compliance.smk"


rule compliance:
    "Flank compliance"
    output:
        arrays="results/{case}/compliance/{body}.npz",
        manifest="results/{case}/compliance/{body}.provenance.json",
    wildcard_constraints:
        body="pinion|face_gear",
    resources:
        mem_mb=4000,
        runtime=30,
    script:
        "../scripts/compliance.py"
