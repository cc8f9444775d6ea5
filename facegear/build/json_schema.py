"""JSON schema of the config, for editors.

Made by `python -m facegear.build.json_schema > facegear/schema/config.schema.json`.
"""

import json
from pathlib import Path

from facegear.build.config import Config

SCHEMA = Path(__file__).parents[1] / "schema" / "config.schema.json"
"""The stored copy, which is installed with the package."""


def json_schema() -> str:
    """Return the JSON schema of a config file, made from the models that validate it.

    Returns
    -------
    str
        The schema as text.
    """
    return json.dumps(Config.model_json_schema(), indent=1, sort_keys=True) + "\n"


if __name__ == "__main__":
    print(json_schema(), end="")
