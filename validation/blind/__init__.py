"""Predictions that are sealed before a measurement is opened, and their comparison with it.

A folder holds `machine.yaml` (a config), `protocol.yaml` (what is predicted, and which inputs nobody knows)
and what `python -m validation.blind predict FOLDER` makes of them: `prediction.csv` and `seal.txt`. Publish
all four. Then write `measurement.csv`; `python -m validation.blind compare FOLDER` checks the
seal and writes `verdict.csv`. docs/how_to/blind.md says it step by step.
"""

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from ruamel.yaml import YAML

import facegear
from facegear.arrays import Array
from facegear.errors import FacegearError
from facegear.gearbox import Gearbox

MACHINE, PROTOCOL, PREDICTION = "machine.yaml", "protocol.yaml", "prediction.csv"
SEALED = (MACHINE, PROTOCOL, PREDICTION)
"""Files that the seal covers, in this order."""
SEAL, MEASUREMENT, VERDICT = "seal.txt", "measurement.csv", "verdict.csv"
KEYS = ("question", "by", "commit", "unknown", "samples", "seed", "level", "model_percent", "quantities")
"""Keys of a protocol, all of them needed."""
QUANTITY_KEYS = ("name", "unit", "answer", "where", "column")
PREDICTION_COLUMNS = ("quantity", "unit", "low", "middle", "high")
MEASUREMENT_COLUMNS = ("quantity", "value", "standard_uncertainty")
VERDICT_COLUMNS = ("quantity", "unit", "low", "high", "value", "standard_uncertainty", "verdict")
COVERAGE = 2.0
"""Standard uncertainties of a measurement that count as its interval, about 95 % of a normal distribution."""


def read_protocol(folder: Path) -> dict[str, Any]:
    """Read what is predicted.

    Parameters
    ----------
    folder : Path
        Folder of the prediction.

    Returns
    -------
    dict
        The keys KEYS.

    Raises
    ------
    FacegearError
        For a key that is missing, unknown or not filled in.
    """
    protocol = YAML(typ="safe").load((folder / PROTOCOL).read_text(encoding="utf-8"))
    for key in KEYS:
        if protocol.get(key) is None:
            raise FacegearError(f"{folder / PROTOCOL}: {key} must be given")
    if unread_keys := [key for key in protocol if key not in KEYS]:
        raise FacegearError(
            f"{folder / PROTOCOL}: {', '.join(unread_keys)}: known keys are {', '.join(KEYS)}"
        )
    for quantity in protocol["quantities"]:
        if absent_keys := [key for key in QUANTITY_KEYS if key not in quantity]:
            raise FacegearError(f"{folder / PROTOCOL}: a quantity lacks {', '.join(absent_keys)}")
    return dict(protocol)


def predict(folder: Path) -> pd.DataFrame:
    """Compute intervals of all quantities over the inputs that nobody knows.

    Parameters
    ----------
    folder : Path
        Folder of the prediction.

    Returns
    -------
    pd.DataFrame
        PREDICTION_COLUMNS, in the units of the protocol: the middle `level` of the samples, widened by
        `model_percent` of the middle value for what the model leaves out.
    """
    protocol = read_protocol(folder)
    gearbox = facegear.load(folder / MACHINE, None)
    random = np.random.default_rng(protocol["seed"])
    values = []
    for _ in range(protocol["samples"]):
        draws = random.random(len(protocol["unknown"]))
        values.append(quantities_of(gearbox.with_values(inputs_at(protocol, draws)), protocol))
    return intervals(np.array(values), protocol)


def inputs_at(protocol: Mapping[str, Any], draws: Array) -> dict[str, float]:
    """Return values of the unknown inputs.

    Parameters
    ----------
    protocol : mapping
        As of read_protocol.
    draws : (unknown inputs,) array
        Where each lies in its range, from 0 to 1, dimensionless.

    Returns
    -------
    dict of str to float
        Values by dotted keys of the config, in the units of the keys.
    """
    changes: dict[str, float] = {}
    for entry, draw in zip(protocol["unknown"], draws.tolist(), strict=True):
        value = entry["from"] + draw * (entry["to"] - entry["from"])
        changes |= dict.fromkeys(entry["moves"], value)
    return changes


def quantities_of(gearbox: Gearbox, protocol: Mapping[str, Any]) -> list[float]:
    """Compute all quantities of one machine.

    Parameters
    ----------
    gearbox : Gearbox
        The machine.
    protocol : mapping
        As of read_protocol.

    Returns
    -------
    list of float
        One a quantity, in its unit; magnitudes.
    """
    values = []
    for quantity in protocol["quantities"]:
        table = getattr(gearbox, quantity["answer"])().table()
        for column, value in quantity["where"].items():
            table = table[table[column] == value]
        if len(table) != 1:
            raise FacegearError(f"{quantity['name']}: {len(table)} rows of {quantity['answer']}, not one")
        values.append(abs(float(table[quantity["column"]].iloc[0])))
    return values


def intervals(values: Array, protocol: Mapping[str, Any]) -> pd.DataFrame:
    """Return the interval of each quantity.

    Parameters
    ----------
    values : (samples, quantities) array
        In the units of the protocol.
    protocol : mapping
        As of read_protocol.

    Returns
    -------
    pd.DataFrame
        PREDICTION_COLUMNS.
    """
    tail = 0.5 * (1.0 - protocol["level"])
    low, middle, high = np.quantile(values, [tail, 0.5, 1.0 - tail], axis=0)
    margin = 0.01 * protocol["model_percent"] * middle
    names = [(quantity["name"], quantity["unit"]) for quantity in protocol["quantities"]]
    rows = [
        (*name, below, half, above)
        for name, below, half, above in zip(names, low - margin, middle, high + margin, strict=True)
    ]
    return pd.DataFrame(rows, columns=list(PREDICTION_COLUMNS))


def seal_of(folder: Path) -> str:
    """Hash machine, protocol and prediction together.

    Parameters
    ----------
    folder : Path
        Folder of the prediction.

    Returns
    -------
    str
        SHA-256 of the files SEALED, each behind its name and length.
    """
    digest = hashlib.sha256()
    for name in SEALED:
        content = (folder / name).read_bytes()
        digest.update(f"{name} {len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


def compare(folder: Path) -> pd.DataFrame:
    """Hold a measurement against a sealed prediction.

    Parameters
    ----------
    folder : Path
        Folder of the prediction, with its seal and measurement.

    Returns
    -------
    pd.DataFrame
        VERDICT_COLUMNS in the units of the protocol. inside: the measurement and COVERAGE of its uncertainty
        lie in the interval; outside: none of it does; undecided: it crosses an end.

    Raises
    ------
    FacegearError
        Where the seal is broken, or a measured quantity was not predicted.
    """
    sealed = (folder / SEAL).read_text(encoding="utf-8").split()[0]
    if sealed != seal_of(folder):
        raise FacegearError(f"{folder}: {', '.join(SEALED)} are not those that {SEAL} was made of")
    prediction = pd.read_csv(folder / PREDICTION).set_index("quantity")
    measurement = pd.read_csv(folder / MEASUREMENT)
    rows = []
    for row in measurement.itertuples():
        if row.quantity not in prediction.index:
            raise FacegearError(f"{folder / MEASUREMENT}: {row.quantity!r} was not predicted")
        limits_row = prediction.loc[row.quantity]
        verdict = judge(limits_row["low"], limits_row["high"], row.value, COVERAGE * row.standard_uncertainty)
        limits = (limits_row["unit"], limits_row["low"], limits_row["high"])
        rows.append((row.quantity, *limits, row.value, row.standard_uncertainty, verdict))
    return pd.DataFrame(rows, columns=list(VERDICT_COLUMNS))


def judge(low: float, high: float, value: float, reach: float) -> str:
    """Say where a measurement lies.

    Parameters
    ----------
    low, high : float
        Predicted interval, any unit.
    value, reach : float
        Measurement and half its own interval, in the same unit.

    Returns
    -------
    str
        inside, outside or undecided.
    """
    if low <= value - reach and value + reach <= high:
        return "inside"
    if value + reach < low or value - reach > high:
        return "outside"
    return "undecided"
