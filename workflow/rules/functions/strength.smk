def machine_loads(wildcards):
    """Table of the machine's loads in the bins of a duty cycle, where the rating takes them from there."""
    if not loads_from_machine(CASES[wildcards.case]):
        return []
    return [shared("duty_loads", "duty_loads")(wildcards)]
