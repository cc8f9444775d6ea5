def branch_starts(wildcards):
    """Files of the random starts of a case, one for each speed."""
    explore = asked_values("branches", wildcards)["branches"]["explore"]
    return expand(
        rules.branches_starts.output.found,
        case=wildcards.case,
        number=range(max(len(explore["speeds_rpm"]), 1)),
    )
