"""Stored numbers of ROSS and openTorsion against those that the code gives today."""

from pathlib import Path

import numpy as np
import pandas as pd
from references import against, agrees

from validation.dynamics.shaft_peer import (
    CHAINS,
    NAMES,
    SHAFTS,
    SPEEDS_RPM,
    condensed_shaft,
    torsional_frequencies,
    whirling_frequencies,
)

STORED = pd.read_csv(Path(__file__).parents[2] / "docs" / "measured" / "shaft_peer.csv")


def theirs(case, start):
    rows = STORED[(STORED["case"] == case) & STORED["quantity"].str.startswith(start)]
    return rows["theirs"].to_numpy()


@against(
    "third-party program",
    "ROSS 2.3.0 (docs/measured/shaft_peer.csv, `make peers`)",
    capability="shafts",
    module="facegear.parts.shafts",
)
def test_a_pinion_gives_way_on_its_shaft_as_in_ross():
    for name, given in SHAFTS.items():
        compliance = condensed_shaft(given).compliance
        size = np.sqrt(np.outer(compliance.diagonal(), compliance.diagonal()))
        for i, motion in enumerate(NAMES):
            for j in range(i, 5):
                if (stored := theirs(name, f"{motion} by load {NAMES[j]},")).size:
                    allowed = 1e-12 * size[i, j]
                    agrees("motion by load, SI", compliance[i, j], stored, absolute=allowed)


@against(
    "third-party program",
    "ROSS 2.3.0 (docs/measured/shaft_peer.csv, `make peers`)",
    capability="modal",
    module="facegear.machine.drive_line",
)
def test_a_spinning_pinion_whirls_on_its_shaft_as_in_ross():
    for name, given in SHAFTS.items():
        for speed in SPEEDS_RPM:
            stored = [theirs(name, f"frequency {i + 1} at {speed:g} rpm")[0] for i in range(4)]
            agrees(
                "whirling frequency, Hz",
                whirling_frequencies(condensed_shaft(given), speed),
                stored,
                relative=1e-9,
            )


@against(
    "third-party program",
    "openTorsion 0.3.2 (docs/measured/shaft_peer.csv, `make peers`)",
    capability="shafts",
    module="facegear.machine.drive_line",
)
def test_masses_on_torsional_springs_swing_as_in_opentorsion():
    for name, (inertias, springs) in CHAINS.items():
        agrees(
            "swinging frequency, Hz",
            torsional_frequencies(inertias, springs),
            theirs(name, "frequency"),
            relative=1e-9,
        )
