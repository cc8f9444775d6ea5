"""Cards of materials and oils as a section names them: by name, by file, or written out."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from facegear.config.base import Section, parse, refuse
from facegear.config.yaml_file import read_yaml
from facegear.errors import ConfigErrors


def read_card(model: type[Section], value: Any, folder: Path) -> Any:
    """Read the card that a config value names, for a validator that runs before that of the type.

    A text without an ending is the name of a card in `folder`, whatever path the config's loader put before
    it. Any other text is a yaml file, and a mapping is the card itself. Anything else is handed back. A
    mistake in the card is refused here, so that it is reported with all other mistakes before any work.

    Parameters
    ----------
    model : type[Section]
        Class of the card.
    value : Any
        Value of the config.
    folder : Path
        Folder of the cards that come with the package.

    Returns
    -------
    Any
        The validated card, or the value itself if it is neither text nor a mapping.
    """
    if not isinstance(value, str | Mapping):
        return value
    try:
        return parse(model, read_yaml(_file(value, folder)) if isinstance(value, str) else value, "the card")
    except ConfigErrors as error:
        name = value if isinstance(value, str) else value.get("name")
        refuse("", name, f"a card without mistakes: {' '.join(str(error).split())}")


def _file(name: str, folder: Path) -> Path:
    path = Path(name)
    if path.suffix:
        return path
    card_path = folder / f"{path.name}.yaml"
    if not card_path.is_file():
        refuse("", path.name, f"one of {', '.join(sorted(card.stem for card in folder.glob('*.yaml')))}")
    return card_path
