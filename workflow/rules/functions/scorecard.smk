import json

import pandas as pd

from facegear.config.cases import set_key
from facegear.paper.identify.sets import config_changes, named_set


def stored_sets():
    """Names of the sets of undisclosed inputs that fit about as well as the recommended one, the config's own."""
    file = REPRODUCTION and REPRODUCTION.sets
    if not file:
        return []
    sets = pd.read_csv(file)
    return [str(name) for name in sets.loc[~sets["recommended"], "set"]]


def set_cases(wildcards):
    """Cases of the config with a set put in: the machine itself and every study's points."""
    row = named_set(pd.read_csv(REPRODUCTION.sets), wildcards.set)
    values = json.loads(json.dumps({**CONFIG, "reproduction": None}))
    size = values["transmission"]["transmission_error"]["amplitude_um"]
    for key, value in config_changes(row, size).items():
        set_key(values, key, value)
    return list(expand_cases(values).values())
