"""The numbers on the page about root stress are those of the stored measurements."""

from pathlib import Path

import pandas as pd
import pytest
from references import against, agrees

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "explanation" / "strength.md").read_text()
MEASURED = ROOT / "docs" / "measured"
BODIES = {"pinion": "pinion", "face_gear": "face gear"}
HALVED = {"all": "all sizes", "width": "along the face", "thickness": "inside the tooth"}


def percent(value):
    return f"{value:+.1f} %" if abs(value) >= 0.05 else "0.0 %"


def row(*cells):
    return f"| {' | '.join(cells)} |"


def calculix_rows():
    table = pd.read_csv(MEASURED / "calculix_stress.csv")
    whole = table["face_mm"].max()
    return [
        row(
            "whole" if one.face_mm == whole else f"outer {one.face_mm:.1f} mm",
            one.level,
            BODIES[one.body],
            f"{1e-6 * one.dof:.3f} M",
            percent(one.difference_percent),
            f"{one.largest_difference_percent:.1f} %",
            percent(one.nodal_difference_percent),
        )
        for one in table.itertuples()
    ]


def halving_rows():
    table = pd.read_csv(MEASURED / "strength.csv")
    return [
        row(
            one.level,
            BODIES[one.body],
            HALVED.get(one.halved, one.halved),
            percent(one.error_percent),
            f"{one.largest_error_percent:.1f} %",
        )
        for one in table.itertuples()
    ]


def cost_rows():
    table = pd.read_csv(MEASURED / "strength_costs.csv")
    return [
        row(
            BODIES[one.body],
            f"{one.gauges:.0f}",
            f"{one.compliance_cpu_s:.1f} s",
            f"{one.gauges_percent:+.0f} %",
            f"{one.root_stress_cpu_s:.1f} s",
            f"{one.peak_memory_gb:.1f} GB",
        )
        for one in table.itertuples()
    ]


@pytest.mark.parametrize("message", [*calculix_rows(), *halving_rows(), *cost_rows()])
def test_a_row_about_root_stress_is_the_stored_measurement(message):
    assert message in PAGE


@against(
    "third-party program",
    "CalculiX on the same mesh (docs/measured/calculix_stress.csv, `make peers`)",
    capability="root_stress",
    module="facegear.contact.root_gauges",
)
def test_our_stress_is_within_one_per_cent_of_calculix_on_every_mesh():
    table = pd.read_csv(MEASURED / "calculix_stress.csv")
    assert set(table["body"]) == set(BODIES) and {"coarse", "medium"} <= set(table["level"])
    agrees(
        "largest difference of the stress, percent", table["largest_difference_percent"], 0.0, absolute=1.0
    )


@against(
    "own convergence",
    "sizes of the mesh halved (docs/measured/strength.csv, `make benchmarks`)",
    capability="root_stress",
    module="facegear.strength.root_stress",
)
def test_root_stress_of_medium_meshes_is_within_one_per_cent_whichever_size_is_halved():
    table = pd.read_csv(MEASURED / "strength.csv")
    errors = table.groupby("level")["largest_error_percent"].max()
    agrees("largest error of the medium mesh, percent", errors["medium"], 0.0, absolute=1.0)
    agrees("largest error of the coarse mesh, percent", errors["coarse"], 0.0, absolute=1.5)
