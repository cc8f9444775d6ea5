"""One evolution of designs, from one seed."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from facegear.number_format import count_noun
from facegear.progress import Progress
from facegear.scenarios.evolution import Effort, evolve
from facegear.stages.outcome import Outcome
from facegear.variants.designs import SearchedMachine, assessor, task


def search_island(seed: int, partial: str | Path | None = None, code: str = "", **given: Any) -> Outcome:
    """`designs` (table): every design tried, its generation, its goals, the error where it has none.

    `partial` is a file that keeps finished designs, so that a killed island goes on after its last one; it
    counts only for the same config and `code`. `given`: fields of SearchedMachine.
    """
    machine = SearchedMachine.of_stage(**given)
    section = machine.section
    assess = assessor(machine, section.hunting_cycles, section.samples)
    effort = Effort(section.population, section.generations, seed)
    progress = Progress(f"search from seed {seed}", effort.population * effort.generations)
    same = machine.identity(seed, code)
    with TemporaryDirectory() as folder:
        kept = Path(folder) / "partial" if partial is None else partial
        designs = evolve(task(section), lambda design: assess(design)[0], effort, kept, same, progress.step)
    failed = int((designs["error"] != "").sum())
    return Outcome(
        {"designs": designs},
        f"{count_noun(len(designs), 'design')}, {failed} of them cannot be built or computed",
    )
