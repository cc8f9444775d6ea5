"""Imports what jobs import, so that Python has compiled it when the first run of an environment needs it.

`make` does so beside the start of Snakemake, which keeps one core busy for some seconds.
"""

from contextlib import suppress
from importlib import import_module

from facegear.pipeline.table import STAGES
from workflow.process.job_server import COMMON


def modules() -> list[str]:
    """Those that most jobs import first, then those of each stage and of its figures."""
    stages = [module for stage in STAGES.values() for module in stage.modules]
    drawn = [stage.figures.draw.partition(":")[0] for stage in STAGES.values() if stage.figures]
    return [*dict.fromkeys([*COMMON, *stages, *drawn])]


def main() -> None:
    """Import them; a job that needs one that cannot be imported says what is wrong with it."""
    for module in modules():
        with suppress(Exception):
            import_module(module)


if __name__ == "__main__":
    main()
