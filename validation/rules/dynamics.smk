rule dynamics_work_precision:
    "Integrators compared"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        table="results/{case}/benchmarks/dynamics.csv",
        svg="results/{case}/figures/dynamics_work_precision.svg",
        png="results/{case}/figures/dynamics_work_precision.png",
        svg_of_laws="results/{case}/figures/dynamics_work_precision_laws.svg",
        png_of_laws="results/{case}/figures/dynamics_work_precision_laws.png",
        manifest="results/{case}/benchmarks/dynamics.provenance.json",
    log:
        "results/{case}/logs/dynamics_work_precision.log",
    benchmark:
        "results/{case}/benchmarks/rules/dynamics_work_precision.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    resources:
        mem_mb=1300,
        runtime=60,
    params:
        **values_of(speed_rpm="dynamics.speed_rpm"),
        machine=needed(MACHINE),
        code=code("validation/scripts/dynamics_work_precision.py"),
    script:
        "../scripts/dynamics_work_precision.py"


rule dynamics_costs:
    "Costs of a sweep"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        sweep="results/{case}/benchmarks/dynamics_sweep.csv",
        manifest="results/{case}/benchmarks/dynamics_costs.provenance.json",
    log:
        "results/{case}/logs/dynamics_costs.log",
    benchmark:
        "results/{case}/benchmarks/rules/dynamics_costs.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    resources:
        mem_mb=1300,
        runtime=30,
    params:
        **values_of(sweep="dynamics.sweep"),
        machine=needed(MACHINE),
        code=code("validation/scripts/dynamics_costs.py"),
    script:
        "../scripts/dynamics_costs.py"


rule load_sharing_costs:
    "Load sharing of random machines: time and error"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        table="results/{case}/benchmarks/load_sharing_costs.csv",
        manifest="results/{case}/benchmarks/load_sharing_costs.provenance.json",
    log:
        "results/{case}/logs/load_sharing_costs.log",
    benchmark:
        "results/{case}/benchmarks/rules/load_sharing_costs.tsv"
    conda:
        ENVIRONMENT
    params:
        **values_of(accuracy="dynamics.accuracy", options="load_sharing"),
        machine=needed(MACHINE),
        code=code("validation/scripts/load_sharing_costs.py"),
    script:
        "../scripts/load_sharing_costs.py"


rule branches_benchmark:
    "Branches: error against tolerance, cost against settling"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        table="results/{case}/benchmarks/branches.csv",
        costs="results/{case}/benchmarks/branches_costs.csv",
        manifest="results/{case}/benchmarks/branches.provenance.json",
    log:
        "results/{case}/logs/branches_benchmark.log",
    benchmark:
        "results/{case}/benchmarks/rules/branches_benchmark.tsv"
    conda:
        ENVIRONMENT
    params:
        **values_of(speed_rpm="dynamics.speed_rpm"),
        machine=needed(MACHINE),
        code=code("validation/scripts/branches_benchmark.py"),
    script:
        "../scripts/branches_benchmark.py"


rule dynamics_convergence:
    "Convergence of the sweep"
    input:
        harmonics=shared("stiffness", "harmonics"),
        chunks=given("dynamics_sweep", "chunks"),
    output:
        table="results/{case}/benchmarks/dynamics_convergence.csv",
        manifest="results/{case}/benchmarks/dynamics_convergence.provenance.json",
    log:
        "results/{case}/logs/dynamics_convergence.log",
    benchmark:
        "results/{case}/benchmarks/rules/dynamics_convergence.tsv"
    conda:
        ENVIRONMENT
    resources:
        runtime=60,
    params:
        **values_of(sweep="dynamics.sweep"),
        machine=needed(MACHINE),
        code=code("validation/scripts/dynamics_convergence.py"),
    script:
        "../scripts/dynamics_convergence.py"


rule dynamics_labels:
    "Classes of 500 random oscillators held against plain running"
    output:
        table="results/{case}/benchmarks/dynamics_labels.csv",
        manifest="results/{case}/benchmarks/dynamics_labels.provenance.json",
    log:
        "results/{case}/logs/dynamics_labels.log",
    benchmark:
        "results/{case}/benchmarks/rules/dynamics_labels.tsv"
    conda:
        ENVIRONMENT
    params:
        code=code("validation/scripts/dynamics_labels.py"),
    script:
        "../scripts/dynamics_labels.py"


rule shaft_peer:
    "Shafts by ROSS, torsional springs by openTorsion"
    output:
        table="results/{case}/benchmarks/shaft_peer.csv",
        manifest="results/{case}/benchmarks/shaft_peer.provenance.json",
    log:
        "results/{case}/logs/shaft_peer.log",
    benchmark:
        "results/{case}/benchmarks/rules/shaft_peer.tsv"
    conda:
        ENVIRONMENT
    params:
        code=code("validation/scripts/shaft_peer.py"),
    script:
        "../scripts/shaft_peer.py"
