include: "functions/search.smk"


rule search_island:
    "Evolution of designs from one seed"
    input:
        harmonics=shared("stiffness", "harmonics"),
        flanks=flanks("search_island"),
    output:
        designs="results/{case}/search/islands/{seed}.parquet",
        manifest="results/{case}/search/islands/{seed}.provenance.json",
    wildcard_constraints:
        seed=r"\d+",
    resources:
        runtime=240,
    script:
        "../scripts/search_island.py"


rule search:
    "Front of all islands, and its winners at full accuracy"
    input:
        harmonics=shared("stiffness", "harmonics"),
        flanks=flanks("search"),
        islands=search_islands,
    output:
        designs="results/{case}/search/designs.parquet",
        front="results/{case}/search/front.csv",
        hypervolume="results/{case}/search/hypervolume.csv",
        winners="results/{case}/search/winners.csv",
        manifest="results/{case}/search/search.provenance.json",
    resources:
        runtime=60,
    script:
        "../scripts/search.py"


rule search_figures:
    "Front and hypervolume"
    input:
        designs=rules.search.output.designs,
        front=rules.search.output.front,
        hypervolume=rules.search.output.hypervolume,
        winners=rules.search.output.winners,
    output:
        **pictures("search", "search_front", "search_hypervolume"),
        manifest="results/{case}/figures/search_figures.provenance.json",
    params:
        **values_of(objectives="search.objectives"),
    script:
        "../scripts/search_figures.py"
