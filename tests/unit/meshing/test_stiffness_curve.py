from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from references import against, agrees

from facegear.build.load import load_config
from facegear.build.plans import stiffness_request
from facegear.errors import ConfigErrors, InvalidInput
from facegear.meshing.stiffness_curve import load_table
from facegear.meshing.stiffness_source import (
    load_dependence,
    series_of,
    stiffness_from_contact,
    stiffness_given,
)
from facegear.pipeline.needs import stage_needs
from facegear.pipeline.run import call
from facegear.pipeline.table import STAGES
from facegear.schema.base import parse
from facegear.schema.contact import modes_need_contact
from facegear.schema.stiffness import MeshStiffness

ROOT = Path(__file__).parents[3]
TORQUES = np.array([100.0, 200.0, 400.0, 800.0])
POSITIONS = np.arange(16) / 16


def stiffness_at(torque, position):
    return 4e8 * (torque / 400) ** 0.25 * (1 + 0.1 * np.cos(2 * np.pi * position))


def contact_table():
    torque, position = (grid.ravel() for grid in np.meshgrid(TORQUES, POSITIONS, indexing="ij"))
    average = stiffness_at(torque, position)
    columns = {"torque_n_m": torque, "position": position, "k_average_n_per_m": average}
    unloaded = np.full(torque.size, -44.8)
    return pd.DataFrame(columns | {"k_local_n_per_m": 1.3 * average, "unloaded_ste_um": unloaded})


def request(**changes):
    values = {"source": "fem", "mean_n_per_m": 4.1e8, "torque_n_m": 300.0, "harmonics_kept": 4} | changes
    return stiffness_request(parse(MeshStiffness, values))


@against(
    "manufactured",
    "a stiffness that grows with the fourth root of the torque",
    capability="stiffness",
    module="facegear.meshing.stiffness_curve",
)
def test_curve_between_solved_loads_follows_the_load_dependence():
    curve = load_table(contact_table()).at(300.0, "average")
    agrees("k(t) between the loads solved, N/m", curve, stiffness_at(300.0, POSITIONS), relative=2e-3)


@pytest.mark.parametrize("torque", [50.0, 801.0])
def test_curve_is_never_extrapolated_in_load(torque):
    with pytest.raises(InvalidInput, match="100 to 800"):
        load_table(contact_table()).at(torque, "average")


@against(
    "manufactured",
    "a stiffness that grows with the fourth root of the torque",
    capability="stiffness",
    module="facegear.meshing.stiffness_curve",
)
def test_solved_load_is_taken_as_it_is():
    curve = load_table(contact_table()).at(400.0, "local")
    agrees("k(t) at a load solved, N/m", curve, 1.3 * stiffness_at(400.0, POSITIONS), relative=1e-14)


@against(
    "manufactured",
    "a mean that is asked for",
    capability="stiffness",
    module="facegear.meshing.stiffness_source",
)
def test_scaled_source_has_the_mean_asked_for_and_the_shape_computed():
    plain = series_of(stiffness_from_contact(contact_table(), request()).harmonics)
    scaled = series_of(stiffness_from_contact(contact_table(), request(source="fem_scaled")).harmonics)
    agrees("mean stiffness, N/m", scaled.mean, 4.1e8, relative=1e-12)
    agrees(
        "amplitudes over the mean",
        scaled.amplitudes / scaled.mean,
        plain.amplitudes / plain.mean,
        relative=1e-12,
        absolute=1e-15,
    )


@against(
    "manufactured",
    "a stiffness whose slope is 1.3 times its average",
    capability="stiffness",
    module="facegear.meshing.stiffness_source",
)
@pytest.mark.parametrize(("source", "scale"), [("fem", 1.0), ("fem_scaled", None)])
def test_both_means_stand_beside_the_harmonics_and_modes_take_the_local_one(source, scale):
    """The contact's slope is 1.3 times its average here, at every load and position."""
    section = {"source": source, "mean_n_per_m": 4.1e8, "torque_n_m": 400.0, "harmonics_kept": 4}
    table = stiffness_from_contact(contact_table(), request(**section)).harmonics
    average = 4e8 if scale else 4.1e8
    agrees(
        "mean average stiffness, N/m", table["mean_average_n_per_m"].to_list(), 5 * [average], relative=1e-9
    )
    agrees(
        "mean local stiffness, N/m", table["mean_local_n_per_m"].to_list(), 5 * [1.3 * average], relative=1e-9
    )
    values = load_config(ROOT / "config" / "paper.yaml").model_dump(mode="json")
    needs = stage_needs("modal", values) | {"mean_stiffness": None}
    taken = {}
    for definition in ("local", "average"):
        found = call(STAGES["modal"], {**needs, "definition": definition, "harmonics": table})
        taken[definition] = found.content["contacts"]["stiffness_n_per_m"].to_list()
        assert f"N/um ({definition})" in found.summary
    assert taken["local"] == pytest.approx(10 * [1.3 * average], rel=1e-9)
    assert taken["average"] == pytest.approx(10 * [average], rel=1e-9)


@pytest.mark.parametrize(
    ("section", "choice", "asks"),
    [
        ({"source": "harmonics", "mean_n_per_m": 4e8}, "local", False),
        ({"source": "fem", "mean_n_per_m": 4e8}, "local", False),
        ({"source": "fem", "mean_n_per_m": None}, "average", True),
        ({"source": "fem_scaled", "mean_n_per_m": 4e8}, "average", False),
        ({"source": "fem_scaled", "mean_n_per_m": 4e8}, "local", True),
    ],
)
def test_modes_ask_for_the_contact_where_the_config_does_not_give_their_stiffness(section, choice, asks):
    assert modes_need_contact({"mesh_stiffness": section, "modal": {"stiffness": choice}}) is asks


@against(
    "external source",
    "the paper, Table 2",
    capability="modal",
    module="facegear.machine.modes",
)
def test_the_papers_modes_are_those_of_the_mean_that_its_config_gives():
    values = load_config(ROOT / "config" / "paper.yaml").model_dump(mode="json")
    assert not modes_need_contact(values)
    found = call(STAGES["modal"], stage_needs("modal", values))
    elastic = found.content["frequencies"]["frequency_hz"].to_numpy()[6:]
    agrees(
        "natural frequency, Hz",
        elastic[[0, 4, 10, 21]],
        [756.7, 833.5, 2260.1, 6488.0],
        relative=1e-7,
        absolute=0.0501,
    )
    assert "410 N/um (average, given)" in found.summary


@pytest.mark.parametrize("source", ["fem", "fem_scaled"])
def test_variation_stretches_the_curve_about_its_mean_and_must_leave_it_positive(source):
    plain, more = (
        stiffness_from_contact(contact_table(), request(source=source, variation=factor)).curve
        for factor in (1.0, 2.5)
    )
    for column in ("k_n_per_m", "k_series_n_per_m"):
        assert more[column].mean() == pytest.approx(plain[column].mean(), rel=1e-12)
        assert np.ptp(more[column]) == pytest.approx(2.5 * np.ptp(plain[column]), rel=1e-12)
    with pytest.raises(InvalidInput, match=r"variation of the mesh stiffness.*at most 10"):
        stiffness_from_contact(contact_table(), request(source=source, variation=11.0))


def test_written_harmonics_are_those_kept():
    result = stiffness_from_contact(contact_table(), request(harmonics_kept=2))
    assert list(result.harmonics["order"]) == [0, 1, 2]
    assert len(result.spectrum) == 8


def test_harmonics_given_in_the_config_need_no_contact():
    table = [{"order": 1, "sin_n_per_m": 2e7, "cos_n_per_m": 1e7}, {"order": 3, "cos_n_per_m": -5e6}]
    asked = request(source="harmonics", table=table, torque_n_m=None)
    series = series_of(stiffness_given(asked).harmonics)
    np.testing.assert_allclose(series.sine, [0, 2e7, 0, 0])
    np.testing.assert_allclose(series.cosine, [4.1e8, 1e7, 0, -5e6])


@against(
    "manufactured",
    "a stiffness with a first harmonic of a tenth at every load",
    capability="load_dependence",
    module="facegear.meshing.stiffness_source",
)
def test_load_dependence_lists_both_stiffnesses_at_every_load():
    table = load_dependence(load_table(contact_table()))
    assert len(table) == 8
    average = table[table["definition"] == "average"]
    assert average["mean_n_per_m"].is_monotonic_increasing
    agrees(
        "first harmonic over the mean",
        average["amplitude_1_n_per_m"] / average["mean_n_per_m"],
        0.1,
        relative=1e-10,
    )


@pytest.mark.parametrize(
    "changes",
    [
        {"source": "harmonics"},
        {"source": "fem_scaled", "mean_n_per_m": None},
        {"table": [{"order": 1}]},
        {"source": "harmonics", "table": [{"order": 2}, {"order": 1}]},
        {"mean_n_per_m": -1.0},
        {"source": "measured"},
    ],
)
def test_incomplete_or_contradictory_sources_are_refused(changes):
    with pytest.raises(ConfigErrors):
        request(**changes)


@pytest.mark.parametrize("orders", [[0, 1, 1], [0, -1], [0, 0.5]])
def test_orders_of_a_users_file_must_be_whole_and_single(orders):
    frame = pd.DataFrame({"order": orders, "sin_n_per_m": 0.0, "cos_n_per_m": 1.0})
    with pytest.raises(ValueError, match="orders"):
        series_of(frame)
