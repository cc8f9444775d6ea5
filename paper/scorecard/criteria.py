"""All criteria by the name a claim calls them."""

from collections.abc import Mapping
from types import MappingProxyType

from paper.scorecard import (
    criteria_modal,
    criteria_response,
    criteria_sharing,
    criteria_stiffness,
    criteria_sweep,
)
from paper.scorecard.outcome import Criterion

MODULES = (criteria_modal, criteria_response, criteria_sharing, criteria_stiffness, criteria_sweep)

CRITERIA: Mapping[str, Criterion] = MappingProxyType(
    {
        name: function
        for module in MODULES
        for name, function in vars(module).items()
        if callable(function) and not name.startswith("_") and function.__module__ == module.__name__
    }
)
"""Every public function of the criteria modules."""
