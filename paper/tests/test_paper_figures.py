"""Each figure of the paper shows what its claims are about, with the numbers that they state."""

import re
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import facegear
from paper.figures.claims_of import NUMBERS, STUDIES, claims_of, figures_of
from paper.figures.draw import MODES, PINIONS, SWEEP_PINIONS, draw, shown_data, stated_speed
from paper.figures.page import render
from paper.reproduction import read_reproduction
from paper.scorecard.claims import read_claims

ROOT = Path(__file__).parents[2]
CLAIMS = read_claims(ROOT / "config" / "claims" / "paper.yaml")
INPUTS = read_reproduction(ROOT / "config" / "reproduction" / "paper.yaml").inputs
MESHES = [f"{pinion}/{side}" for side in ("lower", "upper") for pinion in PINIONS]
TIMES = np.linspace(0.0, 3.4e-4, 5)
POINTS = {
    "backlash": ("80_um", "100_um", "120_um"),
    "pinion_bearings": ("soft", "mid", "stiff"),
    "gear_bearings": ("6p7e9_n_m", "8p7e9_n_m", "10p7e9_n_m"),
    "angles": ("case_1", "case_2"),
}


def swept():
    """A sweep whose values tell where they are from."""
    items = [
        (f"{axis}_ac_rms_um", body)
        for axis in "xyz"
        for body in (*SWEEP_PINIONS, "lower face gear", "upper face gear")
    ]
    items += [("deflection_ac_rms_um", mesh) for mesh in MESHES]
    rows = [
        (direction, speed, quantity, item, number + 1e-4 * speed + (0.5 if direction == "up" else 0.0))
        for number, (quantity, item) in enumerate(items)
        for direction in ("up", "down")
        for speed in (200.0, 10000.0, 20000.0)
    ]
    return pd.DataFrame(rows, columns=["direction", "speed_rpm", "quantity", "body_or_mesh", "value"])


def sharing():
    """Curves and means of all studies; the idlers at 120 um carry no load for more than half the cycle."""
    curves, means = [], []
    for study, points in POINTS.items():
        for number, point in enumerate(points):
            for kind, group in (("inputs", "right input"), ("idlers", "idlers")):
                undefined = 0.6 if (point, kind) == ("120_um", "idlers") else 0.0
                means.append((study, point, point, group, kind, 1.3 + 0.1 * number, undefined))
                curves += [(study, point, point, group, kind, t, 1.3 + 0.1 * number) for t in TIMES]
    keys = ["study", "point", "label", "group", "kind"]
    return (
        pd.DataFrame(curves, columns=[*keys, "time_s", "coefficient"]),
        pd.DataFrame(means, columns=[*keys, "mean", "undefined_fraction"]),
    )


@cache
def tables():
    """Modes of the paper's machine, and made-up tables of all else."""
    modes = facegear.load(ROOT / "config" / "harmonics_only.yaml", None).modes()
    curves, means = sharing()
    return {
        "frequencies": modes.table(),
        "shapes": modes.shapes(),
        "tvms": pd.DataFrame(
            {"position": [0.0, 0.5], "k_n_per_m": [4e8, 4.2e8], "k_series_n_per_m": [4e8, 4.2e8]}
        ),
        "harmonics": pd.DataFrame({"order": [0, 1, 2], "amplitude_n_per_m": [4.1e8, 3e7, 1e7]}),
        "response": pd.DataFrame(
            [
                (cycle, 1e-4 * cycle, mesh, number)
                for number, mesh in enumerate(MESHES)
                for cycle in (0.0, 1.0)
            ],
            columns=["mesh_cycle", "time_s", "mesh", "deflection_um"],
        ),
        "spectrum": pd.DataFrame(
            [(mesh, order, order + 1.0) for mesh in MESHES for order in (0.0, 0.5, 1.0, 1.5, 2.0)],
            columns=["mesh", "order", "amplitude_um"],
        ),
        "sweep": swept(),
        "curves": curves,
        "sharing": means,
    }


@cache
def shown(number):
    """Data of a figure; drawn once."""
    return shown_data(draw(number, tables(), claims_of(number, CLAIMS.claims)))


def test_every_claim_stands_beside_a_figure_and_every_figure_has_claims():
    assert all(set(figures_of(claim)) <= set(NUMBERS) and figures_of(claim) for claim in CLAIMS.claims)
    assert all(claims_of(number, CLAIMS.claims) for number in NUMBERS)


def test_modes_are_those_of_table_2_at_its_frequencies():
    stated = {claim.args["order"]: claim.paper for claim in CLAIMS.claims if claim.criterion == "frequency"}
    found = {
        int(order): float(hertz)
        for order, hertz in (
            re.search(r"order (\d+): ([\d.]+) Hz", panel).groups()
            for panel in sorted(shown(6)["panel"].unique())
        )
    }
    assert tuple(found) == MODES
    for order, hertz in found.items():
        assert hertz == pytest.approx(
            stated[order], abs=0.1
        )  # 0.05 of the table's rounding, 0.05 of the title's
    assert (shown(6).groupby("series")["y"].agg(lambda y: y.abs().max()) == 1.0).all()


def test_stiffness_is_shown_about_the_mean_that_the_paper_states():
    (stated,) = {claim.paper for claim in CLAIMS.claims if claim.id == "mean_stiffness"}
    line = shown(7).query("series == 'stated mean'")
    np.testing.assert_allclose(line["y"], 1e-8 * stated)
    np.testing.assert_allclose(shown(8)["y"], 1e-8 * np.array([3e7, 1e7]))


def test_all_ten_meshes_are_shown_with_their_lines_and_without_their_means():
    lines = shown(9)[shown(9)["panel"].str.endswith("spectrum")]
    assert len(lines) == 10 * 4 and lines["x"].min() > 0.4
    histories = shown(9)[~shown(9)["panel"].str.endswith("spectrum")]
    assert set(histories["y"]) == set(range(10))


@pytest.mark.parametrize("number", [10, 11, 12])
def test_every_speed_that_a_claim_states_is_drawn_in_each_panel_it_is_about(number):
    claims = [
        claim for claim in claims_of(number, CLAIMS.claims) if claim.criterion in ("peak_speed", "jump_speed")
    ]
    assert claims
    frame = shown(number)
    for claim in claims:
        lines = frame[frame["series"] == f"stated {stated_speed(claim):g} rpm"]
        assert set(lines["x"]) == {claim.paper}
        assert set(lines["panel"]) == set(frame["panel"])
    curves = frame[~frame["series"].str.startswith("stated")]
    assert (curves["x"].min(), curves["x"].max()) == (200.0, 20000.0)


def test_a_jump_of_one_pinion_is_drawn_in_its_panels_alone():
    panels = shown(12).query("series == 'stated 14330 rpm'")["panel"].unique()
    assert sorted(panel[4:] for panel in panels) == sorted(
        f"{pinion}/{side}" for pinion in ("right idler", "right input") for side in ("upper", "lower")
    )


@pytest.mark.parametrize("number", range(13, 21))
def test_every_mean_and_minimum_that_a_claim_states_is_drawn_beside_our_curve(number):
    study = next(name for name, first in STUDIES.items() if number in (first, first + 1))
    frame = shown(number)
    for claim in claims_of(number, CLAIMS.claims):
        if claim.paper is not None and "point" in claim.args:
            what = "minimum" if "column" in claim.args else "mean"
            lines = frame[frame["series"] == f"{claim.args['point']}, stated {what}"]
            assert set(lines["y"]) == {claim.paper}, claim.id
    for place, point in enumerate(POINTS[study]):
        np.testing.assert_allclose(frame[frame["series"] == point]["y"], 1.3 + 0.1 * place)
        own = frame[frame["series"] == f"{point}, our mean"]
        undefined = (number, point) == (14, "120_um")
        assert own.empty if undefined else set(own["y"]) == {1.3 + 0.1 * place}


def test_the_page_holds_every_claim_with_its_verdict_and_leads_to_the_other_inputs():
    names = [claim.id for claim in CLAIMS.claims]
    card = pd.DataFrame(
        {
            "id": names,
            "claim": [f"claim {name}" for name in names],
            "paper": [claim.paper for claim in CLAIMS.claims],
            "unit": [claim.unit or np.nan for claim in CLAIMS.claims],
            "shown": "ours",
            "verdict": "differs",
            "fitted": [claim.is_fitted for claim in CLAIMS.claims],
            "counted": [claim.counts for claim in CLAIMS.claims],
            "random_share": 0.25,
        }
    )
    page = render("paper", ["torque"], CLAIMS, card, INPUTS)
    for number in NUMBERS:
        part = page.split(f'id="fig{number}"')[1].split("</section>")[0]
        assert all(f"fig{number:02d}.{ending}" in part for ending in ("svg", "png", "csv"))
        expected = [f"claim {claim.id}" for claim in claims_of(number, CLAIMS.claims)]
        assert re.findall(r"<td>(claim \w+)", part) == expected
        assert part.count("25 %") == part.count("differs</td>") == len(expected)
    for case in ("paper_likely", "paper_features"):
        assert f'href="../../{case}/paper_figures/index.html"' in page
    assert f"{sum(claim.counts for claim in CLAIMS.claims)} differs" in page
    fitted = render("paper_features", ["torque"], CLAIMS, card, INPUTS)
    assert "is no evidence for them" in fitted and "is no evidence for them" not in page


def test_the_inputs_that_one_may_switch_between_are_configs_of_those_cases():
    from facegear.schema.yaml_file import read_yaml

    for one in INPUTS:
        values = read_yaml(ROOT / one.config)
        assert values["case"] == one.case
        assert one.case == "paper" or values["extends"] == "paper.yaml"
