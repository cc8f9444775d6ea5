rule mesh_growth:
    "Time to mesh against nodes"
    output:
        table="results/{case}/benchmarks/mesh.csv",
        manifest="results/{case}/benchmarks/mesh.provenance.json",
    resources:
        mem_mb=2000,
    params:
        **values_of("tooth_pair"),
    script:
        "../scripts/mesh_growth.py"
