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
        design="random|structures|geometric",
        first=r"\d+",
        last=r"\d+",
    resources:
        runtime=60,
    params:
        case=whole_case,
        identify=identify_values(**DRAWN),
    script:
        "../scripts/identify_random_chunk.py"


rule identify_search:
    "Search for the most likely inputs under one pattern of e(t), if one goes on at this place"
    input:
        ltca=shared("contact", "ltca"),
        claims=CLAIMS,
        random=random_chunks("random"),
        structures=random_chunks("structures"),
        before=searched_before,
    output:
        evaluations="results/{case}/identify/search/{repeat}/{round}/{place}.csv",
        manifest="results/{case}/identify/search/{repeat}/{round}/{place}.provenance.json",
    wildcard_constraints:
        repeat=r"\d+",
        round="first|again",
        place=r"\d+",
    resources:
        runtime=120,
    params:
        case=whole_case,
        identify=identify_values(**DRAWN, search=SEARCH_KEYS),
    script:
        "../scripts/identify_search.py"


rule identify_likely_part:
    "Likely inputs judged with a speed sweep"
    input:
        ltca=shared("contact", "ltca"),
        claims=CLAIMS,
        random=random_chunks("random"),
        structures=random_chunks("structures"),
        searched=SEARCHES,
    output:
        judged="results/{case}/identify/likely/{part}.csv",
        manifest="results/{case}/identify/likely/{part}.provenance.json",
    wildcard_constraints:
        part=r"\d+",
    resources:
        runtime=60,
    params:
        case=whole_case,
        identify=identify_values(search={"starts", "judged", "parts"}),
    script:
        "../scripts/identify_likely_part.py"


rule identify_samples:
    "Base rates, patterns of e(t), null and kinematics from random inputs"
    input:
        claims=CLAIMS,
        random=random_chunks("random"),
        structures=random_chunks("structures"),
        geometric=random_chunks("geometric"),
    output:
        random="results/{case}/identify/random.csv",
        structures="results/{case}/identify/structures.csv",
        choices="results/{case}/identify/choices.csv",
        null="results/{case}/identify/null.csv",
        kinematics="results/{case}/identify/kinematics.csv",
        manifest="results/{case}/identify/samples.provenance.json",
    params:
        identify=identify_values(search={"papers", "seed"}),
    script:
        "../scripts/identify_samples.py"


rule identify_region:
    "Region of likely inputs"
    input:
        claims=CLAIMS,
        random=random_chunks("random"),
        structures=random_chunks("structures"),
        searched=SEARCHES,
        judged=LIKELY,
    output:
        likely="results/{case}/identify/likely.csv",
        region="results/{case}/identify/region.csv",
        searches="results/{case}/identify/searches.csv",
        shares="results/{case}/identify/claim_shares.csv",
        counts="results/{case}/identify/held_counts.csv",
        never_together="results/{case}/identify/never_together.csv",
        correlations="results/{case}/identify/correlations.csv",
        svg="results/{case}/figures/identify_region.svg",
        png="results/{case}/figures/identify_region.png",
        manifest="results/{case}/identify/region.provenance.json",
    params:
        identify=identify_values(ranges=True),
    script:
        "../scripts/identify_region.py"


rule identify_accurate:
    "Region at full accuracy, without a speed sweep"
    input:
        ltca=shared("contact", "ltca"),
        claims=CLAIMS,
        random=random_chunks("random"),
        structures=random_chunks("structures"),
        region=rules.identify_region.output.region,
    output:
        judged="results/{case}/identify/accurate.csv",
        manifest="results/{case}/identify/accurate.provenance.json",
    resources:
        runtime=60,
    params:
        case=whole_case,
        identify=identify_values(search={"starts"}),
    script:
        "../scripts/identify_accurate.py"


rule identify_sets:
    "The most likely inputs at full accuracy, from several starts, and those that are kept"
    input:
        ltca=shared("contact", "ltca"),
        claims=CLAIMS,
        random=random_chunks("random"),
        structures=random_chunks("structures"),
        region=rules.identify_region.output.region,
    output:
        confirmed="results/{case}/identify/confirmed.csv",
        sets="results/{case}/identify/sets.csv",
        manifest="results/{case}/identify/sets.provenance.json",
    resources:
        runtime=60,
    params:
        case=whole_case,
        identify=identify_values(search={"confirmed", "runs", "sets"}),
    script:
        "../scripts/identify_sets.py"


rule identify_runs:
    "Runs of a set that differ by rounding and start"
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
        identify=identify_values(runs=True, swept_runs=True),
    script:
        "../scripts/identify_runs.py"


rule identify_all_runs:
    "Runs of all sets"
    input:
        runs=expand(rules.identify_runs.output.runs, set=judged_sets(), allow_missing=True),
    output:
        runs="results/{case}/identify/runs.csv",
        manifest="results/{case}/identify/runs.provenance.json",
    script:
        "../scripts/identify_all_runs.py"
