include: "functions/dynamics.smk"


rule dynamics_response:
    input:
        harmonics=upstream("stiffness", "stiffness/harmonics.csv"),
    output:
        response="results/{case}/dynamics/response.csv",
        spectrum="results/{case}/dynamics/spectrum.csv",
        summary="results/{case}/dynamics/summary.csv",
        multipliers="results/{case}/dynamics/multipliers.csv",
        manifest="results/{case}/dynamics/response.provenance.json",
    log:
        "results/{case}/logs/dynamics_response.log",
    benchmark:
        "results/{case}/benchmarks/rules/dynamics_response.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=10,
    params:
        section=config_slice("transmission"),
        teeth=teeth_slice,
        speed_rpm=config_slice("dynamics.speed_rpm"),
        accuracy=config_slice("dynamics.accuracy"),
        code=fingerprint("dynamics_response.py"),
    message:
        "response of {wildcards.case} at the nominal speed"
    script:
        "../scripts/dynamics_response.py"


rule dynamics_sweep_chunk:
    input:
        harmonics=upstream("stiffness", "stiffness/harmonics.csv"),
    output:
        chunk="results/{case}/dynamics/chunks/{direction}_{number}.npz",
        manifest="results/{case}/dynamics/chunks/{direction}_{number}.provenance.json",
    log:
        "results/{case}/logs/dynamics_sweep_{direction}_{number}.log",
    benchmark:
        "results/{case}/benchmarks/rules/dynamics_sweep_{direction}_{number}.tsv"
    wildcard_constraints:
        direction="up|down",
        number=r"\d+",
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
        code=fingerprint("dynamics_sweep_chunk.py"),
    message:
        "speed sweep of {wildcards.case} {wildcards.direction}, chunk {wildcards.number}"
    script:
        "../scripts/dynamics_sweep_chunk.py"


rule dynamics_sweep:
    input:
        harmonics=upstream("stiffness", "stiffness/harmonics.csv"),
        chunks=sweep_chunks,
    output:
        sweep="results/{case}/dynamics/sweep.csv",
        jumps="results/{case}/dynamics/jumps.csv",
        resonances="results/{case}/dynamics/resonances.csv",
        seams="results/{case}/dynamics/seams.csv",
        waterfall="results/{case}/dynamics/waterfall.npz",
        manifest="results/{case}/dynamics/sweep.provenance.json",
    log:
        "results/{case}/logs/dynamics_sweep.log",
    benchmark:
        "results/{case}/benchmarks/rules/dynamics_sweep.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 2
    resources:
        mem_mb=900,
        runtime=60,
    params:
        section=config_slice("transmission"),
        teeth=teeth_slice,
        sweep=config_slice("dynamics.sweep"),
        code=fingerprint("dynamics_sweep.py"),
    message:
        "jumps and resonances of {wildcards.case}"
    script:
        "../scripts/dynamics_sweep.py"


rule dynamics_figures:
    input:
        response="results/{case}/dynamics/response.csv",
        spectrum="results/{case}/dynamics/spectrum.csv",
        sweep="results/{case}/dynamics/sweep.csv",
        jumps="results/{case}/dynamics/jumps.csv",
        resonances="results/{case}/dynamics/resonances.csv",
        waterfall="results/{case}/dynamics/waterfall.npz",
        frequencies="results/{case}/modal/frequencies.csv",
    output:
        svg=report(
            expand(
                "results/{{case}}/figures/{name}.svg",
                name=["fig09", "fig10", "fig11", "fig12", "campbell", "waterfall"],
            ),
            caption="../report/dynamics.rst",
            category="Dynamics",
        ),
        png=expand(
            "results/{{case}}/figures/{name}.png",
            name=["fig09", "fig10", "fig11", "fig12", "campbell", "waterfall"],
        ),
        manifest="results/{case}/figures/dynamics_figures.provenance.json",
    log:
        "results/{case}/logs/dynamics_figures.log",
    benchmark:
        "results/{case}/benchmarks/rules/dynamics_figures.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=900,
        runtime=10,
    params:
        pinion_teeth=config_slice("tooth_pair.pinion_teeth"),
        pinions=config_slice("transmission.pinions"),
        gears=config_slice("transmission.face_gears"),
        speed_rpm=config_slice("dynamics.speed_rpm"),
        code=fingerprint("dynamics_figures.py"),
    message:
        "figures 9 to 12, Campbell diagram and waterfall of {wildcards.case}"
    script:
        "../scripts/dynamics_figures.py"
