rule scenarios_benchmark:
    "Samples: costs, and error of the statistics"
    input:
        harmonics=shared("stiffness", "harmonics"),
        flanks=given("tolerances_chunk", "flanks"),
    output:
        costs="results/{case}/benchmarks/scenarios.csv",
        errors="results/{case}/benchmarks/scenarios_errors.csv",
        manifest="results/{case}/benchmarks/scenarios.provenance.json",
    log:
        "results/{case}/logs/scenarios_benchmark.log",
    benchmark:
        "results/{case}/benchmarks/rules/scenarios_benchmark.tsv"
    conda:
        ENVIRONMENT
    resources:
        runtime=30,
    params:
        chunk=needed(STAGES["tolerances_chunk"].needs),
        samples=500,
        code=code("validation/scripts/scenarios_benchmark.py"),
    script:
        "../scripts/scenarios_benchmark.py"
