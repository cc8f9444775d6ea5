"""A search of designs: a known optimum, the spread over seeds, resumption, bad input, winners."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from references import against, agrees

import facegear
from facegear.errors import ConfigErrors, FacegearError
from facegear.studies.evolution import ERROR, Effort, Task, Variable, evolve, front, hypervolumes

INPUTS, IDLERS = ("right input", "left input"), ("tail idler", "right idler", "left idler")
STIFF = "bearing_stiffness_n_per_m"
LINEAR = {
    "mesh_stiffness.table": [{"order": 1, "sin_n_per_m": 0.0, "cos_n_per_m": 0.0}],
    "transmission.mesh_kinematics": "geometric",
    "transmission.face_gear.mesh_radius_mm": None,
    "transmission.transmission_error": {"amplitude_um": 0},
}


def bearings(parts):
    return [f"transmission.single_pinions.{part}.{STIFF}.{axis}" for part in parts for axis in "xy"]


VARIABLES = [
    {"name": "inputs", "limits": [4e7, 2e8], "scale": "log", "steps": 9, "sets": bearings(INPUTS)},
    {"name": "idlers", "limits": [2e7, 1e9], "scale": "log", "steps": 9, "sets": bearings(IDLERS)},
    {
        "name": "clocking",
        "limits": [-0.05, 0.05],
        "steps": 11,
        "sets": [f"transmission.single_pinions.{part}.clocking_deg" for part in IDLERS],
    },
]
SHARING = {"name": "k_inputs", "largest_of": [f"k_gamma {part}" for part in INPUTS]}
SEARCH = {"variables": VARIABLES, "objectives": [SHARING], "population": 16, "generations": 10, "seeds": [1]}


def machine(tolerances=None, **section):
    start = facegear.load("config/harmonics_only.yaml", results=None)
    return start.with_values({**LINEAR, "search": {**SEARCH, **section}, "tolerances": tolerances})


TEETH = {
    "name": "teeth",
    "spread": 8.0,
    "moves": {"transmission.single_meshes.right input/lower.error_um": 1.0},
    "source": "drawing",
}
MARGIN = {"name": "margin", "smallest_of": ["jump_margin_rpm"]}
MASS = {"name": "mass", "limits": [1.1, 1.4], "steps": 3, "sets": ["transmission.pinion.mass_kg"]}


def near_a_jump(tolerances=None, **section):
    """The machine with its errors, above the jump of a resonance: 5930 rpm, 5690 with pinions of 1.4 kg."""
    sizes = {"population": 4, "generations": 2, "seeds": [1]}
    asked = {
        "variables": [MASS],
        "objectives": [MARGIN],
        "jumps": {"range_rpm": 350, "step_rpm": 70},
        **sizes,
    }
    start = facegear.load("config/harmonics_only.yaml", results=None)
    values = {"dynamics.speed_rpm": 6000, "search": {**asked, **section}, "tolerances": tolerances}
    return start.with_values(values)


def test_a_search_moves_the_operating_speed_away_from_the_jump():
    winners = near_a_jump().search().winners().set_index("design")
    best, nominal = winners.loc["most margin"], winners.loc["nominal"]
    assert best["mass"] == pytest.approx(1.4)
    assert nominal["margin"] == pytest.approx(6000.0 - 5929.3, abs=5.0)
    assert best["margin"] == pytest.approx(6000.0 - 5690.2, abs=5.0)
    assert best["margin"] == best["jump_margin_rpm"] == best["margin_searched"]


def test_jumps_are_looked_for_only_where_a_goal_asks_for_them(monkeypatch):
    asked = []
    monkeypatch.setattr("facegear.studies.machines.jump_margin", lambda *given: asked.append(given) or 7.0)
    sizes = {"generations": 1, "samples": 2, "winner_samples": 2}
    table = near_a_jump(objectives=[SHARING], **sizes).search().winners()
    assert not asked and "jump_margin_rpm" not in table
    least = {**MARGIN, "at_least": 7.0}
    found = near_a_jump(objectives=[SHARING], constraints=[least], **sizes).search()
    tried = found.designs()["mass"].nunique() + 2 * len(found.winners())
    assert len(asked) == tried and (found.winners()["margin"] == 7.0).all()
    above = {**least, "at_least": 7.1}
    assert near_a_jump(objectives=[SHARING], constraints=[above], **sizes).search().table().empty
    asked.clear()
    cause = {**TEETH, "spread": 1.0, "moves": {"transmission.backlash_um": 1.0}}
    tolerances = {"causes": [cause], "samples": 8, "chunk_samples": 8}
    found = near_a_jump(tolerances, objectives=[{**MARGIN, "percentile": 5.0}], **sizes).search()
    tried = found.designs()["mass"].nunique() + 2 * len(found.winners())
    assert len(asked) == 2 * tried  # the two samples of each, and not as designed


def difference(inputs, idlers, clocking):
    """F_u - F_l of an input after docs/explanation/theory.md, of which K_gamma of the inputs is a growing
    function.

    Clocking of the idlers (deg) takes its length at the base circle from the play of two flanks.
    """
    force, k, base, pressure = 6.4e3, 4.1e8, 0.0391, np.radians(25.0)
    clearance = 1e-4 + np.radians(clocking) * base
    return (2 * force + clearance * k + 4 * force * k * np.cos(pressure) ** 2 / idlers) / (1 + 2 * k / inputs)


@against(
    "analytic",
    "load sharing of a floating input in closed form, on the whole grid of designs",
    capability="search",
    module="facegear.pipeline.stages.search",
)
def test_the_optimum_of_the_closed_form_is_found():
    grid = [np.geomspace(4e7, 2e8, 9), np.geomspace(2e7, 1e9, 9), np.linspace(-0.05, 0.05, 11)]
    values = np.array(np.meshgrid(*grid, indexing="ij")).reshape(3, -1)
    found = machine().search()
    best = found.table()[["inputs", "idlers", "clocking"]].iloc[0]
    agrees("variables of the best design", best, values[:, difference(*values).argmin()], relative=1e-7)
    sharing = found.winners().set_index("design")["k_inputs"]
    assert sharing["least k_inputs"] < sharing["nominal"]
    nominal = found.winners().set_index("design").loc["nominal", ["inputs", "idlers", "clocking"]]
    np.testing.assert_allclose(nominal.astype(float), [6.5e7, 6.5e7, 0.0])


def spheres(design):
    """Squared distances from (0, 0) and (1, 0): the front is the line between them."""
    x, y = design
    return {"f": x**2 + y**2, "g": (x - 1.0) ** 2 + y**2}


SPHERES = Task((Variable("x", -1.0, 2.0), Variable("y", -1.0, 1.0)), ("f", "g"))


def islands(folder, seeds, generations=30):
    return {
        seed: evolve(SPHERES, spheres, Effort(24, generations, seed), folder / f"{seed}", "same")
        for seed in seeds
    }


@against(
    "analytic",
    "front and hypervolume of two spheres in closed form",
    capability="search_island search",
    module="facegear.studies.evolution",
)
def test_the_front_of_two_spheres_is_the_line_between_and_seeds_differ_by_little(tmp_path):
    found = islands(tmp_path, (1, 2, 3))
    best = front(pd.concat(found.values()), SPHERES)
    agrees(
        "sqrt(f) + sqrt(g) on the front",
        np.sqrt(best["f"]) + np.sqrt(best["g"]),
        1.0,
        relative=1e-7,
        absolute=0.02,
    )
    last = hypervolumes(found, SPHERES).groupby("seed")["hypervolume"].last()
    assert np.ptp(last) / last.mean() < 0.02
    exact = 1.0 - 1.0 / 6.0 / 1.1**2  # the area below sqrt(f) + sqrt(g) = 1 is a sixth
    agrees("hypervolume", last.mean(), exact, absolute=0.02)


def test_what_is_to_be_large_mirrors_what_is_to_be_small(tmp_path):
    plain = replace(SPHERES, limits=(("h", 0.5),))
    mirrored = replace(SPHERES, limits=(("h", -0.5),), large=frozenset("gh"))

    def run(task, sign):
        def ask(design):
            found = spheres(design)
            return {"f": found["f"], "g": sign * found["g"], "h": sign * found["g"]}

        return evolve(task, ask, Effort(16, 6, 1), tmp_path / f"{sign}", "same")

    one, other = run(plain, 1.0), run(mirrored, -1.0)
    pd.testing.assert_frame_equal(other.assign(g=-other["g"], h=-other["h"]), one)
    best = [front(found, task)[["x", "y"]] for found, task in ((one, plain), (other, mirrored))]
    pd.testing.assert_frame_equal(*best)
    shares = [hypervolumes({1: found}, task) for found, task in ((one, plain), (other, mirrored))]
    pd.testing.assert_frame_equal(*shares)


def test_a_search_of_few_designs_ends_when_all_are_tried(tmp_path):
    few = replace(SPHERES, variables=tuple(replace(one, steps=2) for one in SPHERES.variables))
    designs = evolve(few, spheres, Effort(4, 50, 1), tmp_path / "few", "same")
    assert len(designs.drop_duplicates(["x", "y"])) == 4 and designs["generation"].max() < 50


def test_a_killed_evolution_goes_on_from_what_it_had_and_ends_the_same(tmp_path):
    whole = islands(tmp_path, (7,), 6)[7]
    tried = []

    def counted(design):
        tried.append(design)
        if len(tried) == 50:
            raise KeyboardInterrupt
        return spheres(design)

    with pytest.raises(KeyboardInterrupt):
        evolve(SPHERES, counted, Effort(24, 6, 7), tmp_path / "killed", "same")
    again = evolve(SPHERES, counted, Effort(24, 6, 7), tmp_path / "killed", "same")
    pd.testing.assert_frame_equal(again, whole, check_exact=True)
    assert len(tried) - 1 == len(set(tried)) == len(whole.drop_duplicates(["x", "y"]))


def test_a_design_that_cannot_be_built_is_a_row_and_never_in_the_front(tmp_path):
    def half(design):
        if design[0] < 0.5:
            raise FacegearError("too small")
        return spheres(design)

    designs = evolve(SPHERES, half, Effort(16, 8, 1), tmp_path / "half", "same")
    assert (designs[ERROR] == "too small").sum() > 0
    assert (front(designs, SPHERES)["x"] >= 0.5).all()


def test_a_robust_search_asks_for_percentiles_over_the_tolerances():
    robust = {**SHARING, "percentile": 95.0}
    sizes = {"population": 4, "generations": 1, "samples": 8, "winner_samples": 8}
    tolerances = {"causes": [TEETH], "samples": 8, "chunk_samples": 8}
    found = machine(tolerances, objectives=[robust], variables=VARIABLES[:1], **sizes).search()
    table = found.winners()
    assert (
        table["k_inputs"] > table[["k_gamma right input/upper", "k_gamma left input/upper"]].max(axis=1)
    ).all()


@pytest.mark.parametrize(
    ("section", "line"),
    [
        ({"objectives": [{**SHARING, "largest_of": ["k_gama"]}]}, "k_inputs.largest_of = .k_gama"),
        ({"objectives": [{**SHARING, "percentile": 95.0}]}, "required by percentiles"),
        ({"objectives": [{**SHARING, "name": "inputs"}]}, "one of its own"),
        ({"variables": [{**VARIABLES[0], "limits": [1.0, 1.0]}]}, "the lower one first"),
        ({"variables": [{**VARIABLES[2], "scale": "log"}]}, "above 0 where scale is log"),
        ({"variables": [{**VARIABLES[0], "sets": ["transmission.pinion.mas_kg"]}]}, "pinion.mas_kg"),
        ({"variables": [{**VARIABLES[0], "sets": ["dynamics.speed_rpm"]}]}, "a number of transmission"),
        ({"variables": [{**VARIABLES[0], "name": "bearing_mass"}]}, "the winners have a column of that name"),
        ({"objectives": [{**SHARING, "name": "error"}]}, "columns of their own"),
        ({"objectives": [{**SHARING, "largest_of": ["pressure_mpa"]}]}, "the beginning of one of: k_gamma"),
        ({"seeds": [1, 1]}, "different numbers"),
        ({"objectives": [{"name": "none"}]}, "either this or smallest_of"),
        ({"objectives": [{**SHARING, **MARGIN}]}, "either this or smallest_of"),
        ({"objectives": [{"name": "m", "largest_of": ["jump_margin_rpm"]}]}, "a margin is to be large"),
        ({"objectives": [{"name": "m", "smallest_of": ["jump_margins"]}]}, "m.smallest_of = .jump_margins"),
        ({"constraints": [{**MARGIN, "at_most": 1.0}]}, "at_least = null: must be given with smallest_of"),
        ({"constraints": [{**SHARING, "name": "k"}]}, "at_most = null: must be given with largest_of"),
        ({"jumps": {"range": 100.0}}, "search.jumps.range"),
        ({"jumps": {"range_rpm": 0.0}}, "search.jumps.range_rpm"),
        ({"jumps": {"range_rpm": 20.0}}, "at most range_rpm = 20"),
        ({"jumps": {"range_rpm": 1e5}}, "a thousandth of range_rpm"),
    ],
)
def test_a_mistake_in_the_section_is_one_clear_line(section, line):
    with pytest.raises(ConfigErrors, match=line) as caught:
        machine(**section)
    assert "Traceback" not in str(caught.value) and len(str(caught.value).splitlines()) <= 2
