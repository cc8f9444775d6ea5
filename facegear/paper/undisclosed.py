"""The inputs that the paper leaves out, told under a figure."""

from collections.abc import Mapping
from typing import Any

from facegear.report.inputs import inputs_in_words


def inputs_caption(values: Mapping[str, Any], of_paper: bool) -> str:
    """A figure's line of inputs; for a figure of the paper it says that the paper leaves them out."""
    lead = "Not disclosed by the paper, chosen here: " if of_paper else "Inputs of the base case: "
    return lead + "; ".join(inputs_in_words(values))
