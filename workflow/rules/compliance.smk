rule compliance:
    input:
        quality=upstream("mesh", "mesh/quality.csv"),
    output:
        arrays="results/{case}/compliance/{body}.npz",
        manifest="results/{case}/compliance/{body}.provenance.json",
    log:
        "results/{case}/logs/compliance_{body}.log",
    benchmark:
        "results/{case}/benchmarks/rules/compliance_{body}.tsv"
    wildcard_constraints:
        body="pinion|face_gear",
    conda:
        "../envs/facegear.yaml"
    threads: 1  # both bodies at once are quicker than one after the other with two threads
    resources:
        mem_mb=4000,
        runtime=30,
    params:
        tooth_pair=config_slice("tooth_pair"),
        mesh=config_slice("mesh"),
        contact=config_slice("contact"),
        code=fingerprint("compliance.py"),
    message:
        "flank compliance of the {wildcards.body} of {wildcards.case}"
    script:
        "../scripts/compliance.py"
