"""A machine with its tolerances: bad input, failed samples, equal bits, closed form where it is linear."""

import json
from statistics import NormalDist

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from references import against, agrees

import facegear
from facegear.build.machine import MachineInputs
from facegear.errors import ConfigErrors, FacegearError
from facegear.io import tables
from facegear.pipeline.stages.studies import chunk_of, tolerances
from facegear.schema.tolerances import Tolerances, chunks
from facegear.sharing import quantities
from facegear.sharing.hunting import hunting_cycle
from facegear.studies.sampled_machine import SampledMachine

MEAN = "transmission.single_meshes"
LINEAR = {
    "mesh_stiffness.table": [{"order": 1, "sin_n_per_m": 0.0, "cos_n_per_m": 0.0}],
    "transmission.mesh_kinematics": "geometric",
    "transmission.face_gear.mesh_radius_mm": None,
    "transmission.transmission_error": {"amplitude_um": 0},
    "load_sharing.samples_per_cycle": 32,
}


def cause(name, key, spread=4.0, **others):
    return {"name": name, "spread": spread, "moves": {key: 1.0}, "source": "drawing", **others}


RIGHT, LEFT = (cause(f"{side}_teeth", f"{MEAN}.{side} input/lower.error_um") for side in ("right", "left"))
Y = cause("right_y", "transmission.single_pinions.right input.position_um.y", 3.0)


def machine(causes=(RIGHT, LEFT, Y), **section):
    """The paper's layout with geometric meshes of constant stiffness: linear as long as no mesh opens."""
    given = {"causes": list(causes), "samples": 64, "chunk_samples": 64, **section}
    start = facegear.load("config/harmonics_only.yaml", results=None)
    return start.with_values({**LINEAR, "tolerances": given})


@pytest.fixture(scope="module")
def gearbox():
    return machine()


def wired(gearbox):
    return MachineInputs.of_config(gearbox.values, gearbox.stiffness().content["harmonics"]).build()


def chunk(gearbox, first, last, design="samples", **others):
    sampled = SampledMachine.of_stage(**gearbox._chain.arguments("tolerances_chunk"))
    return chunk_of(sampled, design, first, last, **others).content["chunk"]


@pytest.mark.parametrize(
    ("section", "line"),
    [
        ({"causes": []}, "at least one"),
        ({"causes": [RIGHT, RIGHT]}, "a name of its own"),
        ({"causes": [{**RIGHT, "spread": -1.0}]}, r"spread = -1\.0"),
        ({"causes": [{**RIGHT, "spread": None}]}, "required by shape normal"),
        ({"causes": [{**RIGHT, "shape": "uniform"}]}, "required by shape uniform"),
        ({"causes": [{**RIGHT, "limits": [3, -3]}]}, "the lower one first"),
        ({"causes": [{**RIGHT, "moves": {"transmission.pinion.mas_kg": 1.0}}]}, "pinion.mas_kg"),
        ({"causes": [{**RIGHT, "moves": {"tooth_pair.module_mm": 1.0}}]}, "a number of transmission"),
        ({"causes": [{**RIGHT, "moves": {f"{MEAN}.nobody/lower.error_um": 1.0}}]}, "nobody/lower"),
        ({"causes": [{**RIGHT, "name": "sample"}]}, "a column of its own"),
        ({"causes": [{**RIGHT, "name": "peak_mesh_force_n"}]}, "a column of its own"),
        ({"load_map": {"torque_factors": [1, 0.5]}}, "rising, each once"),
        ({"load_map": {"speeds_rpm": [1000]}}, "none where model is quasi_static"),
        ({"load_map": {"samples": 90_000}}, "at most 50000: there are 4 loads"),
        ({"samples": 100}, "a multiple of chunk_samples"),
        ({"index_blocks": 3}, "a power of two"),
        ({"samples": 1024, "chunk_samples": 1}, "at least 3"),
        (
            {"correlations": [{"between": ["right_teeth", "nobody"], "coefficient": 0.5}]},
            "two of right_teeth",
        ),
        (
            {
                "correlations": [
                    {"between": ["right_teeth", "left_teeth"], "coefficient": 0.9},
                    {"between": ["right_teeth", "right_y"], "coefficient": 0.9},
                    {"between": ["left_teeth", "right_y"], "coefficient": -0.9},
                ]
            },
            "the matrix is not positive",
        ),
        (
            {
                "index_blocks": 4,
                "correlations": [{"between": ["right_teeth", "left_teeth"], "coefficient": 0.9}],
            },
            "indices are undefined",
        ),
    ],
)
def test_a_mistake_in_the_section_is_one_clear_line(section, line):
    with pytest.raises(ConfigErrors, match=line) as caught:
        machine(**section)
    assert len(str(caught.value).splitlines()) == 1


def test_a_machine_without_tolerances_says_so():
    with pytest.raises(FacegearError, match="tolerances = None"):
        facegear.load("config/harmonics_only.yaml", results=None).tolerances()


def test_samples_are_equal_to_the_bit_for_any_size_of_chunk(gearbox):
    whole = chunk(gearbox, 0, 13)
    for size in (1, 7):
        parts = [chunk(gearbox, first, first + size - 1) for first in range(0, 14, size)]
        pd.testing.assert_frame_equal(pd.concat(parts, ignore_index=True), whole, check_exact=True)


def test_a_sample_that_cannot_be_built_is_a_row_with_its_error_and_is_counted():
    jams = cause("shim", "transmission.single_pinions.right input.position_um.y", 80.0)
    found = machine([jams]).tolerances()
    message = found.samples()["error"]
    assert 0 < (message != "").sum() < len(message)
    assert all("jams" in text or "um between" in text for text in message[message != ""])
    shares = found.content["fractions"].set_index("what")
    assert shares.loc["cannot be built or computed", "fraction"] == (message != "").mean()
    assert (found.table()["samples"] == (message == "").sum()).all()


TURNING = {
    "transmission.pinion.runout": {"eccentricity_um": 9, "phase_deg": 20},
    "transmission.face_gear.runout": {"eccentricity_um": 15},
}


@against(
    "second implementation",
    "all 3289 mesh cycles",
    capability="tolerances_chunk",
    module="facegear.sharing.quantities",
)
def test_a_few_mesh_cycles_hold_the_largest_factor_of_the_whole_hunting_cycle():
    """Every 411th mesh cycle alone read K_gamma up to 5 % low."""
    gearbox = machine([RIGHT, Y], samples=3, chunk_samples=3, hunting_cycles=8).with_values(TURNING)
    found = gearbox.tolerances()
    whole = gearbox.with_values({"tolerances.hunting_cycles": 3289}).tolerances()
    factors = [name for name in found.samples() if name.startswith("k_gamma ")]
    agrees("largest mesh load factor", found.samples()[factors], whole.samples()[factors], relative=1e-9)
    spread = hunting_cycle(wired(gearbox), 8, 411)
    whole_means = hunting_cycle(wired(gearbox), 8).cycle_means
    assert (spread.cycle_means.max(axis=0) < 0.99 * whole_means.max(axis=0)).any()
    row = found.content["sampling"].iloc[0]
    assert row["quantity"] == "k_gamma" and row["samples"] == 3 and row["largest_missed"] < 1e-9
    assert "miss at most k_gamma" in found.summary and "open_fraction" in found.summary


def test_what_the_cycles_taken_miss_is_measured(monkeypatch):
    monkeypatch.setattr(quantities, "hardest_cycles", lambda run: run)
    gearbox = machine([RIGHT, Y], samples=2, chunk_samples=2, hunting_cycles=8).with_values(TURNING)
    row = gearbox.tolerances().content["sampling"].iloc[0]
    assert 0.005 < row["median_missed"] <= row["largest_missed"] < 0.2


def test_a_load_map_measures_at_every_load_what_the_cycles_taken_miss():
    """At a tenth of the torque teeth open in a part of the mesh cycles."""
    turning = {"transmission.face_gear.runout": {"eccentricity_um": 15}}
    gearbox = machine([RIGHT, Y], samples=2, chunk_samples=2, hunting_cycles=8).with_values(turning)
    table = gearbox.load_map([0.1, 1.0], samples=2).content["load_sampling"]
    assert (table["samples"] == 2).all()
    missed = table.set_index(["torque_factor", "quantity"])["largest_missed"]
    assert missed[1.0, "k_gamma"] < 1e-9
    torque = gearbox.values["transmission"]["torque"]["per_input_n_m"]
    light = gearbox.with_values({"transmission.torque.per_input_n_m": 0.1 * torque})
    whole = light.with_values({"tolerances.hunting_cycles": 143}).tolerances().samples()
    taken = light.tolerances().samples()
    factors = [name for name in whole if name.startswith("k_gamma ")]
    ratios = whole[factors] / taken[factors]
    assert missed[0.1, "k_gamma"] == pytest.approx(ratios.to_numpy().max() - 1.0, abs=1e-12)
    for name in ("open_fraction", "reversed_fraction"):
        off = (whole[name] - taken[name]).abs().max()
        assert missed[0.1, name] == pytest.approx(off, abs=1e-12)
    assert missed[0.1].max() > 0.005


@against(
    "analytic",
    "a linear machine with normal errors, from its gradient",
    capability="tolerances",
    module="facegear.pipeline.stages.studies",
)
def test_percentiles_and_indices_of_a_linear_machine_follow_from_its_gradient():
    gearbox = machine(samples=512, chunk_samples=512, index_blocks=128)
    found = gearbox.tolerances()
    name = "k_gamma right input/lower"
    nominal = gearbox.with_values({"tolerances.causes": [{**RIGHT, "spread": 1e-9}]})
    start = chunk(nominal, 0, 0)[name].iloc[0]
    slopes = []
    for key in (RIGHT, LEFT, Y):
        step = {"shape": "choice", "spread": None, "values": [1.0]}
        moved = gearbox.with_values({"tolerances.causes": [{**key, **step}]})
        slopes.append((chunk(moved, 0, 0)[name].iloc[0] - start) * key["spread"])
    spread = float(np.linalg.norm(slopes))
    table = found.table().query("quantity == @name").set_index("percentile")
    for level in (50.0, 95.0, 99.0):
        expected = start + spread * NormalDist().inv_cdf(level / 100.0)
        assert table.loc[level, "low"] - 0.02 * spread <= expected <= table.loc[level, "high"] + 0.02 * spread
        agrees(
            "percentile of a mesh load factor", table.loc[level, "value"], expected, absolute=0.08 * spread
        )
    indices = found.indices().query("quantity == @name")
    exact = np.square(slopes) / spread**2
    for kind in ("first", "total"):
        assert (indices[f"{kind}_low"] <= exact).all() and (exact <= indices[f"{kind}_high"]).all()
    agrees("total Sobol index", indices["total"], exact, relative=1e-7, absolute=0.08)


@against(
    "analytic",
    "a linear machine: the scale is the ratio of the deviations",
    capability="loosest_tolerances",
    module="facegear.studies.statistics",
)
def test_the_loosest_tolerances_of_a_linear_machine_are_those_of_the_closed_form():
    gearbox = machine([RIGHT], samples=16, chunk_samples=16)
    name = "k_gamma right input/upper"
    start = chunk(machine([{**RIGHT, "spread": 1e-9}]), 0, 0)[name].iloc[0]
    usual = np.quantile(gearbox.tolerances().samples()[name], 0.95)
    limit = start + 1.5 * (usual - start)
    found = gearbox.loosest_tolerances(name, limit, percentile=95.0, samples=16)
    agrees("scale of the tolerances", found.scale, 1.5, relative=0.01)
    assert found.percentile.value <= limit
    with pytest.raises(FacegearError, match="without any deviation"):
        gearbox.loosest_tolerances(name, 1.0, samples=1)
    with pytest.raises(FacegearError, match="quantity = 'k': must be one of"):
        gearbox.loosest_tolerances("k", limit, samples=1)


@against(
    "analytic",
    "a linear machine: what lengths add falls with one over torque",
    capability="tolerances_map",
    module="facegear.pipeline.stages.studies",
)
def test_a_map_of_loads_holds_the_machine_of_each_torque_and_the_closed_form():
    gearbox = machine([RIGHT], hunting_cycles=1)
    found = gearbox.load_map([0.01, 0.5, 1.0, 2.0], samples=16)
    opened = found.fractions().query("what.str.contains('opens')").set_index("torque_factor")["fraction"]
    assert opened[0.01] == 1.0 and opened[2.0] == 0.0, "hardly loaded, the play opens a mesh"
    table = found.table()
    name = "k_gamma right input/upper"
    own = table[table["quantity"] == name].set_index(["torque_factor", "percentile"])["value"]
    torque = "transmission.torque.per_input_n_m"
    doubled = gearbox.with_values({torque: 2.0 * gearbox.values["transmission"]["torque"]["per_input_n_m"]})
    assert own[2.0, 99.0] == np.quantile(doubled.tolerances(16).samples()[name], 0.99)
    # misfit and play of a linear machine are lengths: what they add to the share falls with one over torque
    spread = [own[factor, 99.0] - own[factor, 50.0] for factor in (0.5, 1.0, 2.0)]
    agrees(
        "spread of a mesh load factor times the torque",
        np.array(spread) * (0.5, 1.0, 2.0),
        spread[1],
        relative=1e-6,
    )


def test_a_map_over_speed_moves_with_what_a_cause_adds_to_it():
    faster = cause("speed", "dynamics.speed_rpm", shape="choice", spread=None, values=[50.0])
    section = {"model": "dynamic", "load_map": {"torque_factors": [1.0], "speeds_rpm": [900.0], "samples": 2}}
    found = machine([faster], **section).load_map().table().set_index(["quantity", "percentile"])["value"]
    alone = machine([faster], model="dynamic").with_values({"dynamics.speed_rpm": 900.0}).tolerances(1)
    name = "k_v right input/upper"
    assert found[name, 50.0] == alone.samples()[name].iloc[0]


def test_adding_samples_keeps_the_chunks_that_exist():
    section = {"causes": [RIGHT], "chunk_samples": 64}
    few, many = (Tolerances.model_validate_json(json.dumps({**section, "samples": n})) for n in (128, 512))
    assert chunks(many, "samples")[:2] == chunks(few, "samples")


def test_the_last_chunk_of_the_design_for_indices_holds_no_sample_beyond_it():
    section = Tolerances.model_validate_json(
        json.dumps({"causes": [RIGHT], "samples": 64, "chunk_samples": 64, "index_blocks": 32})
    )
    assert chunks(section, "indices") == [(0, 63), (64, 95)]


def test_statistics_do_not_depend_on_how_the_samples_were_cut(gearbox):
    section = gearbox.config.tolerances
    one = tolerances([chunk(gearbox, 0, 15)], [], section)
    two = tolerances([chunk(gearbox, 0, 7), chunk(gearbox, 8, 15)], [], section)
    for name, table in one.content.items():
        pd.testing.assert_frame_equal(two.content[name], table, check_exact=True)


@pytest.mark.parametrize("model", ["quasi_static", "dynamic"])
def test_the_nominal_machine_among_the_samples_is_the_one_without_tolerances(model):
    still = machine([{**RIGHT, "shape": "choice", "spread": None, "values": [0.0]}], model=model)
    row = chunk(still, 0, 0).iloc[0]
    if model == "dynamic":
        table = still.load_sharing().table().set_index("group")
        for group, mean in table["mean"].items():
            assert row[f"coefficient {group}"] == pytest.approx(mean, rel=1e-6)
    else:
        paths = [row[f"k_gamma right input/{side}"] for side in ("lower", "upper")]
        assert sum(paths) == pytest.approx(2.0, rel=1e-9)  # constant loads: an even share of the mean


def test_a_machine_none_of_whose_samples_can_be_built_has_empty_tables_and_figures(tmp_path):
    """It ended in a TypeError of pandas."""
    far = cause("far", "transmission.backlash_um", None, shape="uniform", limits=[-900.0, -800.0])
    found = machine([far], samples=4, chunk_samples=4).tolerances()
    assert (found.samples()["error"] != "").all()
    assert found.table().empty and "4 failed; the first by: this sample: backlash_um" in found.summary
    assert len(found.summary.splitlines()) == 1
    shares = found.content["fractions"].set_index("what")["fraction"]
    assert shares.to_dict() == {"cannot be built or computed": 1.0}
    for kind in ("distributions", "importance", "scatter"):
        plt.close(found.plot(kind))
    found.save(tmp_path)
    stored = tables.read(tmp_path / "tolerances" / "percentiles.csv", ["value"], allow_empty=True)
    assert stored.empty
