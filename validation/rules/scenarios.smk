rule scenarios_benchmark:
    "Samples: costs, and error of the statistics"
    input:
        harmonics=shared("stiffness", "harmonics"),
        flanks=flanks("tolerances_chunk"),
    output:
        costs="results/{case}/benchmarks/scenarios.csv",
        errors="results/{case}/benchmarks/scenarios_errors.csv",
        manifest="results/{case}/benchmarks/scenarios.provenance.json",
    resources:
        runtime=30,
    params:
        chunk=needs("tolerances_chunk"),
        samples=500,
    script:
        "../scripts/scenarios_benchmark.py"
