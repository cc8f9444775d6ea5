from validation.contact.stress_levels import OF_LEVEL


rule strength_level:
    "Root stress beside that of finer meshes"
    output:
        table="results/{case}/benchmarks/strength/{level}.csv",
        manifest="results/{case}/benchmarks/strength/{level}.provenance.json",
    log:
        "results/{case}/logs/strength_level_{level}.log",
    benchmark:
        "results/{case}/benchmarks/rules/strength_level_{level}.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    resources:
        mem_mb=12000,
        runtime=60,
    params:
        **values_of("tooth_pair"),
        code=code("validation/scripts/strength_level.py"),
    script:
        "../scripts/strength_level.py"


rule strength_benchmark:
    "Error and cost of root stress"
    input:
        expand("results/{{case}}/benchmarks/strength/{level}.csv", level=OF_LEVEL),
    output:
        table="results/{case}/benchmarks/strength.csv",
        costs="results/{case}/benchmarks/strength_costs.csv",
        manifest="results/{case}/benchmarks/strength.provenance.json",
    log:
        "results/{case}/logs/strength_benchmark.log",
    benchmark:
        "results/{case}/benchmarks/rules/strength_benchmark.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    resources:
        mem_mb=4000,
    params:
        **values_of("tooth_pair", "mesh", "contact"),
        code=code("validation/scripts/strength_benchmark.py"),
    script:
        "../scripts/strength_benchmark.py"
