from facegear.paper.config.reproduction import design_points
from facegear.paper.config.sections import branches

IDENTIFY = REPRODUCTION.identify if REPRODUCTION else None
DESIGNS = list(design_points(IDENTIFY))
BRANCHES = [branch.name for branch in branches(IDENTIFY)] if IDENTIFY else []


rule identify_branch:
    input:
        ltca=upstream("contact", "contact/ltca.csv"),
    output:
        evaluations="results/{case}/identify/branches/{branch}.csv",
        manifest="results/{case}/identify/branches/{branch}.provenance.json",
    log:
        "results/{case}/logs/identify_{branch}.log",
    benchmark:
        "results/{case}/benchmarks/rules/identify_{branch}.tsv"
    wildcard_constraints:
        branch="[a-z_-]+",
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=120,
    params:
        values=lambda wildcards: CASES[wildcards.case],
        identify=IDENTIFY.model_dump(mode="json") if IDENTIFY else None,
        code=fingerprint("identify_branch.py"),
    message:
        "search of undisclosed inputs, branch {wildcards.branch}"
    script:
        "../scripts/identify_branch.py"


rule identify_sets:
    input:
        ltca=upstream("contact", "contact/ltca.csv"),
        branches=[f"results/{{case}}/identify/branches/{name}.csv" for name in BRANCHES],
    output:
        sets="results/{case}/identify/sets.csv",
        coefficients="results/{case}/identify/coefficients.csv",
        sensitivity="results/{case}/identify/sensitivity.csv",
        svg="results/{case}/figures/identify_landscape.svg",
        png="results/{case}/figures/identify_landscape.png",
        manifest="results/{case}/identify/identify.provenance.json",
    log:
        "results/{case}/logs/identify_sets.log",
    benchmark:
        "results/{case}/benchmarks/rules/identify_sets.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=30,
    params:
        values=lambda wildcards: CASES[wildcards.case],
        identify=IDENTIFY.model_dump(mode="json") if IDENTIFY else None,
        code=fingerprint("identify_sets.py"),
    message:
        "separate optima of the search for undisclosed inputs"
    script:
        "../scripts/identify_sets.py"


rule identify_roads:
    input:
        ltca=upstream("contact", "contact/ltca.csv"),
        designs=[f"results/{{case}}/designs/{name}/contact/ltca.csv" for name in DESIGNS],
    output:
        roads="results/{case}/identify/roads.csv",
        manifest="results/{case}/identify/roads.provenance.json",
    log:
        "results/{case}/logs/identify_roads.log",
    benchmark:
        "results/{case}/benchmarks/rules/identify_roads.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=500,
        runtime=5,
    params:
        designs=DESIGNS,
        stiffness=config_slice("mesh_stiffness"),
        code=fingerprint("identify_roads.py"),
    message:
        "load of the paper's mean stiffness for several gear designs"
    script:
        "../scripts/identify_roads.py"


rule identify:
    input:
        [f"results/{CASE}/identify/{name}.csv" for name in ("sets", "roads")] if IDENTIFY else [],
