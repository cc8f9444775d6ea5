rule mesh:
    input:
        pair=upstream("geometry", "geometry/pair.json"),
    output:
        pinion_msh="results/{case}/mesh/pinion.msh",
        pinion_vtu="results/{case}/mesh/pinion.vtu",
        pinion_inp="results/{case}/mesh/pinion.inp",
        face_gear_msh="results/{case}/mesh/face_gear.msh",
        face_gear_vtu="results/{case}/mesh/face_gear.vtu",
        face_gear_inp="results/{case}/mesh/face_gear.inp",
        quality="results/{case}/mesh/quality.csv",
        manifest="results/{case}/mesh/mesh.provenance.json",
    log:
        "results/{case}/logs/mesh.log",
    benchmark:
        "results/{case}/benchmarks/rules/mesh.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        tooth_pair=config_slice("tooth_pair"),
        mesh=config_slice("mesh"),
        code=fingerprint("mesh.py"),
    message:
        "meshes of {wildcards.case}"
    script:
        "../scripts/mesh.py"


rule mesh_growth:
    output:
        table="results/{case}/benchmarks/mesh.csv",
        manifest="results/{case}/benchmarks/mesh.provenance.json",
    log:
        "results/{case}/logs/mesh_growth.log",
    benchmark:
        "results/{case}/benchmarks/rules/mesh_growth.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        section=config_slice("tooth_pair"),
        code=fingerprint("mesh_growth.py"),
    message:
        "time to mesh against nodes, {wildcards.case}"
    script:
        "../scripts/mesh_growth.py"
