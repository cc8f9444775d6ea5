rule compliance:
    "Flank compliance"
    input:
        quality=shared("mesh", "quality"),
    output:
        arrays="results/{case}/compliance/{body}.npz",
        manifest="results/{case}/compliance/{body}.provenance.json",
    wildcard_constraints:
        body="pinion|face_gear",
    script:
        "../scripts/compliance.py"
