rule compliance:
    "Flank compliance"
    output:
        arrays="results/{case}/compliance/{body}.npz",
        manifest="results/{case}/compliance/{body}.provenance.json",
    wildcard_constraints:
        body="pinion|face_gear",
    script:
        "../scripts/compliance.py"
