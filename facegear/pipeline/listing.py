"""The table of stages as a page of the documentation shows it: `python -m facegear.pipeline.listing`."""

from pathlib import PurePosixPath

from facegear.pipeline.stage import Computed, Need, Stage
from facegear.pipeline.table import STAGES

HEAD = (
    "| stage | what it does | made where | takes from | of the config | writes |",
    "|---|---|---|---|---|---|",
)
NOTHING = "-"


def listing() -> str:
    """A row a stage, in Markdown."""
    taken = {source.stage for stage in STAGES.values() for source in stage.upstream.values()}
    return "\n".join((*HEAD, *(_row(stage, stage.name in taken) for stage in STAGES.values())))


def _row(stage: Stage, taken: bool) -> str:
    before = dict.fromkeys(source.stage for source in stage.upstream.values())
    sections = dict.fromkeys(name for need in stage.needs.values() for name in _sections(need))
    cells = (stage.title, _where(stage, taken), ", ".join(before), ", ".join(sections), _files(stage))
    return " | ".join((f"| {stage.name}", *(cell or NOTHING for cell in cells))) + " |"


def _where(stage: Stage, taken: bool) -> str:
    """When a plain run makes the stage, as its function says it."""
    if stage.asked:
        text = (stage.asked.__doc__ or "").splitlines()[0]
        return text.removeprefix("Whether ").rstrip(".").replace("Always", "always")
    return "another stage takes from it" if taken else "its file is asked for by name"


def _sections(need: Need) -> list[str]:
    """Sections of the config that a value is taken from."""
    if isinstance(need, Computed):
        return list(need.sections)
    return [key.partition(".")[0] for key in ((need,) if isinstance(need, str) else need)]


def _files(stage: Stage) -> str:
    """Paths of a stage's files; the folder stands before the first alone."""
    paths = [PurePosixPath(file.path.replace("{", "<").replace("}", ">")) for file in stage.files.values()]
    return ", ".join(f"`{path.name if number else path}`" for number, path in enumerate(paths))


if __name__ == "__main__":
    print(listing())
