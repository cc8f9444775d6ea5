"""Cost of a sample: time of a core, bytes on disk, memory of a job."""

import resource
import time
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import pandas as pd

from facegear.io import columnar
from facegear.pipeline.stages.studies import chunk_of
from facegear.studies.sampled_machine import SampledMachine

MODELS = ("quasi_static", "dynamic")
SAMPLES_EXTRAPOLATED, CORES = 10_000, 2
FEWER = 40


def costs(machine: SampledMachine, samples: int) -> pd.DataFrame:
    """Measure the cost of samples, one row a model.

    They are computed in this process, compiled before; a fortieth of them where each has a contact analysis
    of its own. `minutes_extrapolated` is the time of WANTED samples on CORES idle cores, start-up of the jobs
    left out.

    Parameters
    ----------
    machine : SampledMachine
        The machine and its tolerances.
    samples : int
        Number of samples.

    Returns
    -------
    DataFrame
        One row for each model.
    """
    rows, samples = [], samples if machine.pair is None else max(samples // FEWER, 1)
    for model in MODELS:
        arguments = replace(machine, tolerances={**machine.tolerances, "model": model})
        chunk_of(arguments, "samples", samples, samples)
        start = time.process_time()
        chunk = chunk_of(replace(arguments), "samples", 0, samples - 1).content["chunk"]
        seconds = (time.process_time() - start) / samples
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
        minutes = seconds * SAMPLES_EXTRAPOLATED / CORES / 60.0
        rows.append((model, samples, 1e3 * seconds, minutes, _bytes(chunk) / samples, memory))
    return pd.DataFrame(
        rows,
        columns=["model", "samples", "ms_a_sample", "minutes_extrapolated", "bytes_a_sample", "memory_mb"],
    )


def _bytes(chunk: pd.DataFrame) -> int:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "chunk.parquet"
        columnar.write(path, chunk)
        return path.stat().st_size
