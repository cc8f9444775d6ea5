"""The table of stages: what each takes, what it writes, when it is made. All else that names them follows.

Its rows stand in `facegear.pipeline.rows`. Columns that a reader asks for are given there by name, so that
reading this table loads nothing that computes.
"""

from pathlib import PurePosixPath

from facegear.pipeline.rows import dynamics, machine, sharing, strength, teeth, variants
from facegear.pipeline.stage import ComputedValue, Need, Stage

ROWS = (
    *teeth.ROWS,
    *machine.ROWS,
    *dynamics.ROWS,
    *sharing.ROWS,
    *strength.LOAD_ROWS,
    *strength.ROWS,
    *variants.ROWS,
)
"""All stages, chapter by chapter; none takes from a later one."""

STAGES = {stage.name: stage for stage in ROWS}
"""By name, in the order in which a case goes through them."""


HEAD = (
    "| stage | what it does | made where | takes from | of the config | writes |",
    "|---|---|---|---|---|---|",
)
"""Head of the table of stages, in Markdown."""
EMPTY_CELL = "-"
"""Text of a cell without content."""


def listing() -> str:
    """Return the table of stages in Markdown, a row for each stage.

    Returns
    -------
    str
        The table.
    """
    source_stages = {source.stage for stage in STAGES.values() for source in stage.upstream.values()}
    return "\n".join((*HEAD, *(_row(stage, stage.name in source_stages) for stage in STAGES.values())))


def _row(stage: Stage, is_source: bool) -> str:
    """Return the row of a stage in the table of stages in Markdown; `is_source` says whether another
    stage takes from it.
    """
    before = dict.fromkeys(source.stage for source in stage.upstream.values())
    sections = dict.fromkeys(name for need in stage.needs.values() for name in _sections(need))
    cells = (
        stage.title,
        _made_where(stage, is_source),
        ", ".join(before),
        ", ".join(sections),
        _files(stage),
    )
    return " | ".join((f"| {stage.name}", *(cell or EMPTY_CELL for cell in cells))) + " |"


def _made_where(stage: Stage, is_source: bool) -> str:
    """Return when a plain run makes the stage, in the words of its condition."""
    if stage.condition:
        text = (stage.condition.__doc__ or "").splitlines()[0]
        return text.removeprefix("Whether ").rstrip(".").replace("Always", "always")
    return "another stage takes from it" if is_source else "its file is asked for by name"


def _sections(need: Need) -> list[str]:
    """Return the top sections of the config from which a need takes its value."""
    keys = need.sections if isinstance(need, ComputedValue) else (need,) if isinstance(need, str) else need
    return [key.partition(".")[0] for key in keys]


def _files(stage: Stage) -> str:
    """Return the paths of a stage's files, joined by commas; only the first has its folder."""
    paths = [PurePosixPath(file.path.replace("{", "<").replace("}", ">")) for file in stage.files.values()]
    return ", ".join(f"`{path.name if number else path}`" for number, path in enumerate(paths))


if __name__ == "__main__":
    print(listing())
