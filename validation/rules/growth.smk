rule growth:
    "Time and memory against sizes"
    output:
        table="results/{case}/benchmarks/growth.csv",
        exponents="results/{case}/benchmarks/growth_exponents.csv",
        svg="results/{case}/figures/growth.svg",
        png="results/{case}/figures/growth.png",
        manifest="results/{case}/benchmarks/growth.provenance.json",
    log:
        "results/{case}/logs/growth.log",
    benchmark:
        "results/{case}/benchmarks/rules/growth.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    resources:
        mem_mb=3000,
        runtime=60,
    params:
        code=code("validation/scripts/growth.py"),
    script:
        "../scripts/growth.py"
