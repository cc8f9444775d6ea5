import json

from facegear.config.cases import set_key

if REPRODUCTION and REPRODUCTION.sets:
    from facegear.paper.identify.sets import config_changes, stored_sets
SETS = stored_sets(REPRODUCTION.sets) if REPRODUCTION and REPRODUCTION.sets else {}
"""Sets of undisclosed inputs that fit about as well as the recommended one, the config's own, by name."""


def set_cases(wildcards):
    """Cases of the config with a set put in: the machine itself and every study's points."""
    row = SETS[wildcards.set]
    values = json.loads(json.dumps({**CONFIG, "reproduction": None}))
    size = values["transmission"]["transmission_error"]["amplitude_um"]
    for key, value in config_changes(row, size).items():
        set_key(values, key, value)
    return list(expand_cases(values).values())
