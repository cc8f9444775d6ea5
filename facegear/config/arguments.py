"""Plain values of a config as the arguments that a function asks for by its annotations."""

from collections.abc import Callable, Mapping
from typing import Any, get_args, get_type_hints


def typed_arguments(function: Callable[..., Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Convert plain config values to the sections that a function's annotations ask for.

    The values are those of a config that was validated. This is where plain values, as Snakemake hands them
    from process to process, become objects again.

    Parameters
    ----------
    function : Callable[..., Any]
        Function whose annotations are read.
    values : Mapping[str, Any]
        Plain values by argument name.

    Returns
    -------
    dict[str, Any]
        The values; a mapping becomes a section where the annotation is a class with `of_config`.
    """
    hints = get_type_hints(function)
    return {name: _section_of(hints.get(name), value) for name, value in values.items()}


def _section_of(kind: Any, value: Any) -> Any:
    """Return a mapping as the section that an annotation names, any other value as it is."""
    if isinstance(value, Mapping):
        for candidate in (kind, *get_args(kind)):
            if hasattr(candidate, "of_config"):
                return candidate.of_config(value)
    return value
