rule mesh_growth:
    "Time to mesh against nodes"
    output:
        table="results/{case}/benchmarks/mesh.csv",
        manifest="results/{case}/benchmarks/mesh.provenance.json",
    log:
        "results/{case}/logs/mesh_growth.log",
    benchmark:
        "results/{case}/benchmarks/rules/mesh_growth.tsv"
    conda:
        ENVIRONMENT
    resources:
        mem_mb=2000,
    params:
        **values_of("tooth_pair"),
        code=code("validation/scripts/mesh_growth.py"),
    script:
        "../scripts/mesh_growth.py"
