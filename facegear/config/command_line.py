"""Config files named to Snakemake, checked before it opens them itself."""

import sys
from collections.abc import Iterator, Sequence

from facegear.config.load import read_layers
from facegear.errors import ConfigErrors

OPTIONS = ("--configfile", "--configfiles")
"""Options of Snakemake that name config files."""
ENDINGS = (".yaml", ".yml", ".json")
"""Endings of the names of config files."""


def check_configfiles(arguments: Sequence[str]) -> None:
    """End the program with one line a mistake if a config file cannot be read.

    The profiles call it with the command line: Snakemake opens these files before any code of a workflow
    runs, and what it cannot read ends in a traceback.

    Parameters
    ----------
    arguments : Sequence[str]
        Arguments of the command line.
    """
    for name in _config_files(arguments):
        try:
            read_layers(name)
        except ConfigErrors as error:
            message = str(error)
            if not name.endswith(ENDINGS):
                message += f"\nIs {name} a target? Write -- before the targets that follow --configfile."
            sys.exit(message)


def _config_files(arguments: Sequence[str]) -> Iterator[str]:
    """Yield the arguments that stand after an option for config files, up to the next option."""
    is_file = False
    for argument in arguments:
        option, equals, value = argument.partition("=")
        if argument.startswith("-"):
            is_file = option in OPTIONS
            if is_file and equals:
                yield value
        elif is_file:
            yield argument
