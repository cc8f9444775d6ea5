"""One evolution of designs, from one seed."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from facegear.number_format import count_noun
from facegear.progress import Progress
from facegear.scenarios.evolution import Effort, evolve
from facegear.stages.outcome import Outcome
from facegear.variants.designs import SearchedMachine, assessor, task


def search_island(
    seed: int, partial: str | Path | None = None, code: str = "", **machine_fields: Any
) -> Outcome:
    """Evolve designs from one seed.

    Parameters
    ----------
    seed : int
        Seed of the random numbers.
    partial : str or Path or None
        File that keeps finished rows, so that a killed run resumes after its last one; None keeps none.
    code : str
        Identity of the code; rows in `partial` count only for the same config and code.
    **machine_fields : Any
        Fields of SearchedMachine.

    Returns
    -------
    Outcome
        Table `designs`: every design tried, its generation, its goals, the error where it has none.
    """
    machine = SearchedMachine.of_stage(**machine_fields)
    section = machine.section
    assess = assessor(machine, section.hunting_cycles, section.samples)
    effort = Effort(section.population, section.generations, seed)
    progress = Progress(f"search from seed {seed}", effort.population * effort.generations)
    identity = machine.identity(seed, code)
    with TemporaryDirectory() as folder:
        partial_file = Path(folder) / "partial" if partial is None else partial
        designs = evolve(
            task(section), lambda design: assess(design)[0], effort, partial_file, identity, progress.step
        )
    failure_count = int((designs["error"] != "").sum())
    return Outcome(
        {"designs": designs},
        f"{count_noun(len(designs), 'design')}, {failure_count} of them cannot be built or computed",
    )
