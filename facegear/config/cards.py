"""Cards of materials and oils as a section names them: by name, by file, or written out."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from facegear.config.base import Section, parse, refuse
from facegear.config.yaml_file import read_yaml
from facegear.errors import ConfigErrors


def read_card(model: type[Section], given: Any, folder: Path) -> Any:
    """The card behind a value of the config, for a validator that runs before that of the type.

    A text without an ending is the name of a card in `folder`, whatever path the config's loader put before
    it. Any other text is a yaml file, and a mapping is the card itself. Anything else is handed back. A
    mistake in the card is refused here, so that it is reported with all other mistakes before any work.
    """
    if not isinstance(given, str | Mapping):
        return given
    try:
        return parse(model, read_yaml(_file(given, folder)) if isinstance(given, str) else given, "the card")
    except ConfigErrors as error:
        name = given if isinstance(given, str) else given.get("name")
        refuse("", name, f"a card without mistakes: {' '.join(str(error).split())}")


def _file(name: str, folder: Path) -> Path:
    path = Path(name)
    if path.suffix:
        return path
    named = folder / f"{path.name}.yaml"
    if not named.is_file():
        refuse("", path.name, f"one of {', '.join(sorted(card.stem for card in folder.glob('*.yaml')))}")
    return named
