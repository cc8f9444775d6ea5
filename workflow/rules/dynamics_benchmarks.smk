rule dynamics_work_precision:
    input:
        harmonics=upstream("stiffness", "stiffness/harmonics.csv"),
    output:
        table="results/{case}/benchmarks/dynamics.csv",
        svg="results/{case}/figures/dynamics_work_precision.svg",
        png="results/{case}/figures/dynamics_work_precision.png",
        manifest="results/{case}/benchmarks/dynamics.provenance.json",
    log:
        "results/{case}/logs/dynamics_work_precision.log",
    benchmark:
        "results/{case}/benchmarks/rules/dynamics_work_precision.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 2
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        section=config_slice("transmission"),
        teeth=teeth_slice,
        speed_rpm=config_slice("dynamics.speed_rpm"),
        code=fingerprint("dynamics_work_precision.py"),
    message:
        "integrators compared on {wildcards.case}"
    script:
        "../scripts/dynamics_work_precision.py"


rule dynamics_costs:
    input:
        harmonics=upstream("stiffness", "stiffness/harmonics.csv"),
    output:
        sweep="results/{case}/benchmarks/dynamics_sweep.csv",
        scaling="results/{case}/benchmarks/dynamics_scaling.csv",
        manifest="results/{case}/benchmarks/dynamics_costs.provenance.json",
    log:
        "results/{case}/logs/dynamics_costs.log",
    benchmark:
        "results/{case}/benchmarks/rules/dynamics_costs.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 2
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        section=config_slice("transmission"),
        teeth=teeth_slice,
        speed_rpm=config_slice("dynamics.speed_rpm"),
        sweep=config_slice("dynamics.sweep"),
        code=fingerprint("dynamics_costs.py"),
    message:
        "costs of a sweep of {wildcards.case}"
    script:
        "../scripts/dynamics_costs.py"


rule dynamics_convergence:
    input:
        harmonics=upstream("stiffness", "stiffness/harmonics.csv"),
        chunks=sweep_chunks,
    output:
        table="results/{case}/benchmarks/dynamics_convergence.csv",
        manifest="results/{case}/benchmarks/dynamics_convergence.provenance.json",
    log:
        "results/{case}/logs/dynamics_convergence.log",
    benchmark:
        "results/{case}/benchmarks/rules/dynamics_convergence.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=60,
    params:
        section=config_slice("transmission"),
        teeth=teeth_slice,
        sweep=config_slice("dynamics.sweep"),
        code=fingerprint("dynamics_convergence.py"),
    message:
        "convergence of the sweep of {wildcards.case}"
    script:
        "../scripts/dynamics_convergence.py"
