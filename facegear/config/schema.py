"""The config's JSON schema, for editors.

Made by `python -m facegear.config.schema > workflow/schemas/config.schema.json`.
"""

import json

from facegear.config.model import Config


def json_schema() -> str:
    """The schema of a config file as text, made from the models that validate it."""
    return json.dumps(Config.model_json_schema(), indent=1, sort_keys=True) + "\n"


if __name__ == "__main__":
    print(json_schema(), end="")
