def search_islands(wildcards):
    """Designs of every island of a search."""
    return [
        rules.search_island.output.designs.format(case=wildcards.case, seed=seed)
        for seed in asked_values("search", wildcards)["search"]["seeds"]
    ]
