rule mesh:
    "Meshes of both bodies"
    output:
        pinion_msh="results/{case}/mesh/pinion.msh",
        pinion_vtu="results/{case}/mesh/pinion.vtu",
        pinion_inp="results/{case}/mesh/pinion.inp",
        face_gear_msh="results/{case}/mesh/face_gear.msh",
        face_gear_vtu="results/{case}/mesh/face_gear.vtu",
        face_gear_inp="results/{case}/mesh/face_gear.inp",
        quality="results/{case}/mesh/quality.csv",
        manifest="results/{case}/mesh/mesh.provenance.json",
    resources:
        mem_mb=2000,
    script:
        "../scripts/mesh.py"
