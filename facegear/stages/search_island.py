"""One evolution of designs, from one seed."""

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd

from facegear.config.base import parse
from facegear.config.search import Search
from facegear.progress import Progress
from facegear.scenarios.chunks import identity
from facegear.scenarios.evolution import Effort, evolve
from facegear.stages.designs import SearchedMachine, assessor, task
from facegear.stages.outcome import Outcome
from facegear.stages.tooth_meshes import Flanks


def search_island(
    seed: int,
    harmonics: pd.DataFrame,
    tooth_pair: Mapping[str, Any],
    transmission: Mapping[str, Any],
    accuracy: Mapping[str, Any],
    speed_rpm: float,
    options: Mapping[str, Any],
    search: Mapping[str, Any],
    tolerances: Mapping[str, Any] | None,
    pair: Mapping[str, Any] | None = None,
    flanks: Flanks | None = None,
    partial: str | Path | None = None,
    code: str = "",
) -> Outcome:
    """`designs` (table): every design tried, its generation, its goals, the error where it has none.

    `partial` is a file that keeps finished designs, so that a killed island goes on after its last one; it
    counts only for the same config and `code`.
    """
    section = parse(Search, search)
    given = SearchedMachine(
        *(harmonics, tooth_pair, transmission, accuracy, speed_rpm, options, tolerances, pair, flanks or {})
    )
    assess = assessor(given, section, section.hunting_cycles, section.samples)
    effort = Effort(section.population, section.generations, seed)
    progress = Progress(f"search from seed {seed}", effort.population * effort.generations)
    same = identity(
        *(seed, harmonics.to_csv(), tooth_pair, transmission, accuracy, speed_rpm, options),
        *(search, tolerances, pair, code),
    )
    with TemporaryDirectory() as folder:
        kept = Path(folder) / "partial" if partial is None else partial
        designs = evolve(task(section), lambda design: assess(design)[0], effort, kept, same, progress.step)
    failed = int((designs["error"] != "").sum())
    return Outcome(
        {"designs": designs}, f"{len(designs)} designs, {failed} of them cannot be built or computed"
    )
