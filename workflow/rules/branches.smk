include: "functions/branches.smk"


rule branches_starts:
    "Where random starts end at one speed"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        found="results/{case}/branches/starts/{number}.npz",
        manifest="results/{case}/branches/starts/{number}.provenance.json",
    wildcard_constraints:
        number=r"\d+",
    resources:
        runtime=30,
    script:
        "../scripts/branches_starts.py"


rule branches:
    "Branches of periodic motions"
    input:
        harmonics=shared("stiffness", "harmonics"),
        jumps=rules.dynamics_sweep.output.jumps,
        chunks=sweep_chunks,
        starts=branch_starts,
    output:
        branches="results/{case}/branches/branches.csv",
        ends="results/{case}/branches/ends.csv",
        unfollowed="results/{case}/branches/unfollowed.csv",
        multipliers="results/{case}/branches/multipliers.csv",
        special="results/{case}/branches/special_points.csv",
        coexistence="results/{case}/branches/coexistence.csv",
        ranges="results/{case}/branches/ranges.csv",
        margins="results/{case}/branches/margins.csv",
        swept="results/{case}/branches/swept.csv",
        jumps="results/{case}/branches/jumps.csv",
        orbits="results/{case}/branches/special_points.npz",
        manifest="results/{case}/branches/branches.provenance.json",
    resources:
        mem_mb=1300,
        runtime=60,
    script:
        "../scripts/branches.py"


rule branches_loci:
    "Loci of folds and period doublings"
    input:
        harmonics=shared("stiffness", "harmonics"),
        orbits=rules.branches.output.orbits,
    output:
        loci="results/{case}/branches/loci.csv",
        manifest="results/{case}/branches/loci.provenance.json",
    resources:
        runtime=60,
    script:
        "../scripts/branches_loci.py"


rule branches_figures:
    "Figures of the branches"
    input:
        branches=rules.branches.output.branches,
        special=rules.branches.output.special,
        multipliers=rules.branches.output.multipliers,
        coexistence=rules.branches.output.coexistence,
        loci=rules.branches_loci.output.loci,
        sweep=rules.dynamics_sweep.output.sweep,
    output:
        **pictures("branches", "branches", "branch_loci", "branch_shares", "branch_multipliers"),
        manifest="results/{case}/figures/branches_figures.provenance.json",
    params:
        **values_of(speed_rpm="dynamics.speed_rpm", pinions="transmission.pinions"),
    script:
        "../scripts/branches_figures.py"
