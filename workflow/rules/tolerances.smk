include: "functions/tolerances.smk"


rule tolerances_chunk:
    "Samples of the machine with its tolerances"
    input:
        harmonics=shared("stiffness", "harmonics"),
        flanks=flanks("tolerances_chunk"),
    output:
        chunk="results/{case}/tolerances/chunks/{design}_{first}_{last}.parquet",
        manifest="results/{case}/tolerances/chunks/{design}_{first}_{last}.provenance.json",
    wildcard_constraints:
        design="samples|indices",
        first=r"\d+",
        last=r"\d+",
    script:
        "../scripts/tolerances_chunk.py"


rule tolerances:
    "Percentiles, shares and Sobol indices"
    input:
        samples=tolerance_chunks("samples"),
        indices=tolerance_chunks("indices"),
    output:
        samples="results/{case}/tolerances/samples.parquet",
        percentiles="results/{case}/tolerances/percentiles.csv",
        shares="results/{case}/tolerances/shares.csv",
        importance="results/{case}/tolerances/importance.csv",
        indices="results/{case}/tolerances/indices.csv",
        manifest="results/{case}/tolerances/tolerances.provenance.json",
    script:
        "../scripts/tolerances.py"


rule tolerances_figures:
    "Distributions, what matters most, and how"
    input:
        samples=rules.tolerances.output.samples,
        percentiles=rules.tolerances.output.percentiles,
        importance=rules.tolerances.output.importance,
        indices=rules.tolerances.output.indices,
    output:
        **pictures("tolerances", "tolerance_distributions", "tolerance_importance", "tolerance_scatter"),
        manifest="results/{case}/figures/tolerances_figures.provenance.json",
    script:
        "../scripts/tolerances_figures.py"


rule tolerances_map:
    "Percentiles over torque and speed"
    input:
        harmonics=shared("stiffness", "harmonics"),
        flanks=flanks("tolerances_map"),
    output:
        load_map="results/{case}/tolerances/load_map.csv",
        load_shares="results/{case}/tolerances/load_shares.csv",
        manifest="results/{case}/tolerances/load_map.provenance.json",
    resources:
        runtime=240,
    script:
        "../scripts/tolerances_map.py"


rule tolerances_map_figure:
    "K_gamma over torque and speed"
    input:
        load_map=rules.tolerances_map.output.load_map,
    output:
        **pictures("tolerances", "tolerance_map"),
        manifest="results/{case}/figures/tolerances_map.provenance.json",
    script:
        "../scripts/tolerances_map_figure.py"
