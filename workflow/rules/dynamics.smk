include: "functions/dynamics.smk"


rule machine_code:
    "Machine code of the time integration"
    output:
        manifest="results/{case}/dynamics/machine_code.provenance.json",
    script:
        "../scripts/machine_code.py"


rule dynamics_response:
    "Response at the nominal speed"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        response="results/{case}/dynamics/response.csv",
        spectrum="results/{case}/dynamics/spectrum.csv",
        summary="results/{case}/dynamics/summary.csv",
        multipliers="results/{case}/dynamics/multipliers.csv",
        bearings="results/{case}/dynamics/bearings.csv",
        manifest="results/{case}/dynamics/response.provenance.json",
    script:
        "../scripts/dynamics_response.py"


rule dynamics_sweep_chunk:
    "Speed sweep, one chunk"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        chunk="results/{case}/dynamics/chunks/{direction}_{number}.npz",
        manifest="results/{case}/dynamics/chunks/{direction}_{number}.provenance.json",
    wildcard_constraints:
        direction="up|down",
        number=r"\d+",
    resources:
        runtime=60,
    script:
        "../scripts/dynamics_sweep_chunk.py"


rule dynamics_sweep:
    "Jumps and resonances"
    input:
        harmonics=shared("stiffness", "harmonics"),
        chunks=sweep_chunks,
    output:
        sweep="results/{case}/dynamics/sweep.csv",
        jumps="results/{case}/dynamics/jumps.csv",
        resonances="results/{case}/dynamics/resonances.csv",
        seams="results/{case}/dynamics/seams.csv",
        waterfall="results/{case}/dynamics/waterfall.npz",
        manifest="results/{case}/dynamics/sweep.provenance.json",
    resources:
        mem_mb=1300,
        runtime=60,
    script:
        "../scripts/dynamics_sweep.py"


rule dynamics_figures:
    "Response, sweep, Campbell diagram and waterfall"
    input:
        response=rules.dynamics_response.output.response,
        spectrum=rules.dynamics_response.output.spectrum,
        sweep=rules.dynamics_sweep.output.sweep,
        jumps=rules.dynamics_sweep.output.jumps,
        resonances=rules.dynamics_sweep.output.resonances,
        waterfall=rules.dynamics_sweep.output.waterfall,
        frequencies=rules.modal.output.frequencies,
    output:
        **pictures(
            "dynamics",
            "mesh_deflections",
            "pinion_sweep",
            "gear_sweep",
            "mesh_sweep",
            "campbell",
            "waterfall",
        ),
        manifest="results/{case}/figures/dynamics_figures.provenance.json",
    resources:
        mem_mb=1300,
    params:
        **values_of(
            "transmission",
            pinion_teeth="tooth_pair.pinion_teeth",
            speed_rpm="dynamics.speed_rpm",
        ),
    script:
        "../scripts/dynamics_figures.py"
