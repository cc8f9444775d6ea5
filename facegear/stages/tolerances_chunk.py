"""A chunk of samples of one machine with its tolerances."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd

from facegear.config.base import parse
from facegear.config.buildable import require_buildable
from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.lumped_model import TEETH, layout, machine, tooth_numbers
from facegear.config.tolerances import Design, Tolerances, population
from facegear.config.transmission import Transmission
from facegear.config.variants import movable, moved
from facegear.load_sharing.quantities import dynamic_quantities, quantity_names, quasi_static_quantities
from facegear.progress import Progress
from facegear.scenarios.chunks import Evaluate, identity, run_chunk
from facegear.scenarios.sampling import changes, index_samples, samples
from facegear.stages.outcome import Outcome
from facegear.stiffness.tables import series_of, unloaded_error

SOURCE = "this sample"
Quantities = Callable[[Any, float], dict[str, float]]


def tolerances_chunk(
    design: Design,
    first: int,
    last: int,
    harmonics: pd.DataFrame,
    transmission: Mapping[str, Any],
    teeth: Mapping[str, Any],
    accuracy: Mapping[str, Any],
    speed_rpm: float,
    options: Mapping[str, Any],
    tolerances: Mapping[str, Any],
    partial: str | Path | None = None,
    code: str = "",
) -> Outcome:
    """`chunk` (table): samples `first` to `last`, the values of their causes, what was found, the error.

    A sample that cannot be built or computed is a row with its error. `partial` is a file that keeps finished
    samples, so that a killed chunk goes on after its last one; it counts only for the same config and `code`.
    """
    section = parse(Tolerances, tolerances)
    causes = population(section)
    draw = samples if design == "samples" else index_samples
    values = draw(causes, first, last - first + 1)
    start = movable(transmission, [key for cause in causes.causes for key, _ in cause.gains])
    shape = layout(parse(Transmission, start), tooth_numbers(**{key: teeth[key] for key in TEETH}))
    names = quantity_names(shape, section.model == "dynamic")
    judge = _quantities(section, accuracy, options)
    build = _builder(harmonics, teeth)

    def evaluate(number: int) -> dict[str, float]:
        changed, speed = moved(start, speed_rpm, changes(causes, values[number - first]))
        return judge(build(changed), speed)

    same = identity(
        design, transmission, teeth, accuracy, speed_rpm, options, tolerances, harmonics.to_csv(), code
    )
    progress = Progress(f"{design} {first} to {last}", len(values))
    frame = _run(evaluate, range(first, last + 1), names, partial, same, progress)
    for place, name in enumerate(causes.names):
        frame.insert(1 + place, name, values[:, place])
    failed = int((frame["error"] != "").sum())
    return Outcome({"chunk": frame}, f"{len(frame)} samples, {failed} of them cannot be built or computed")


def _run(
    evaluate: Evaluate,
    numbers: range,
    names: tuple[str, ...],
    partial: str | Path | None,
    same: str,
    progress: Progress,
) -> pd.DataFrame:
    if partial is not None:
        return run_chunk(evaluate, numbers, names, partial, same, progress.step)
    with TemporaryDirectory() as folder:
        return run_chunk(evaluate, numbers, names, Path(folder) / "partial", same, progress.step)


def _quantities(section: Tolerances, accuracy: Mapping[str, Any], options: Mapping[str, Any]) -> Quantities:
    if section.model == "quasi_static":
        return lambda built, speed: quasi_static_quantities(built, section.hunting_cycles)
    precise = settings(parse(Accuracy, accuracy))
    one_start = replace(sharing_options(parse(LoadSharing, options)), starts=1)
    return lambda built, speed: dynamic_quantities(built, speed, precise, one_start)


def _builder(harmonics: pd.DataFrame, teeth: Mapping[str, Any]) -> Callable[[Mapping[str, Any]], Any]:
    """Function that puts a machine together from its section, or raises the error that a config gets."""
    numbers = tooth_numbers(**{key: teeth[key] for key in TEETH})
    stiffness, unloaded = series_of(harmonics), unloaded_error(harmonics)

    def build(transmission: Mapping[str, Any]) -> Any:
        section = parse(Transmission, transmission, SOURCE)
        require_buildable(section, numbers)
        return machine(section, numbers, stiffness, unloaded)

    return build
