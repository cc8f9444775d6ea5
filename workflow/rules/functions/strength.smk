def machine_loads(table):
    """Function of the wildcards giving a table of the machine's loads, where the rating takes them from there."""
    return lambda wildcards: (
        [shared("duty_loads", table)(wildcards)] if loads_from_machine(CASES[wildcards.case]) else []
    )


def stable_branches(wildcards):
    """Table of the branches of periodic motions, where a case has them."""
    return [rules.branches.output.branches] if CASES[wildcards.case]["branches"] else []
