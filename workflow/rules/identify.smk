include: "functions/identify.smk"


rule identify_load_estimates:
    "Load of the paper's mean stiffness for several gear designs"
    input:
        ltca=shared("contact", "ltca"),
        designs=[f"results/{{case}}/designs/{name}/contact/ltca.csv" for name in DESIGNS],
    output:
        estimates="results/{case}/identify/load_estimates.csv",
        manifest="results/{case}/identify/load_estimates.provenance.json",
    params:
        **values_of(stiffness="mesh_stiffness"),
        designs=DESIGNS,
    script:
        "../scripts/identify_load_estimates.py"


rule identify_random_chunk:
    "Claims that random inputs hold"
    input:
        ltca=shared("contact", "ltca"),
        claims=CLAIMS,
    output:
        samples="results/{case}/identify/chunks/{design}_{first}_{last}.csv",
        manifest="results/{case}/identify/chunks/{design}_{first}_{last}.provenance.json",
    wildcard_constraints:
        design="random|structures",
        first=r"\d+",
        last=r"\d+",
    resources:
        runtime=60,
    params:
        case=whole_case,
        identify=IDENTIFY_VALUES,
    script:
        "../scripts/identify_random_chunk.py"


rule identify_runs:
    "Runs of a set that differ by rounding"
    input:
        ltca=shared("contact", "ltca"),
        claims=CLAIMS,
        sets=STORED_SETS,
    output:
        runs="results/{case}/identify/runs/{set}.csv",
        manifest="results/{case}/identify/runs/{set}.provenance.json",
    wildcard_constraints:
        set="[A-Za-z0-9_]+",
    resources:
        runtime=60,
    params:
        case=whole_case,
        identify=IDENTIFY_VALUES,
    script:
        "../scripts/identify_runs.py"


rule identify_verdicts:
    "Base rates, patterns of e(t) and repeated runs"
    input:
        claims=CLAIMS,
        random=random_chunks("random"),
        structures=random_chunks("structures"),
        runs=expand(rules.identify_runs.output.runs, set=judged_sets(), allow_missing=True),
    output:
        random="results/{case}/identify/random.csv",
        structures="results/{case}/identify/structures.csv",
        runs="results/{case}/identify/runs.csv",
        manifest="results/{case}/identify/verdicts.provenance.json",
    script:
        "../scripts/identify_verdicts.py"
