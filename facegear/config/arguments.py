"""Plain values of a config as the arguments that a function asks for by its annotations."""

from collections.abc import Callable, Mapping
from typing import Any, get_args, get_type_hints


def typed_arguments(function: Callable[..., Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """`given` with plain values as sections, where the function's annotation is a class with `of_config`.

    The values are those of a config that was validated. This is where plain values, as Snakemake hands them
    from process to process, become objects again.
    """
    hints = get_type_hints(function)
    return {name: _typed(hints.get(name), value) for name, value in given.items()}


def _typed(kind: Any, value: Any) -> Any:
    if isinstance(value, Mapping):
        for candidate in (kind, *get_args(kind)):
            if hasattr(candidate, "of_config"):
                return candidate.of_config(value)
    return value
