"""A study over numbers is known by the key that its points set, not by what they are called."""

import pytest

from facegear.build.cases import find_numeric_axis, study_points
from facegear.schema.base import parse
from facegear.schema.studies import Study

WEB = "transmission.face_gear.body.web"
BEARING = "transmission.pinion.bearing_stiffness_n_per_m"


def study(*axes):
    return parse(Study, {"name": "one", "title": "One", "axes": list(axes)})


def points(*changes):
    return {"label": "some", "points": [{"label": f"p{n}", "set": one} for n, one in enumerate(changes)]}


@pytest.mark.parametrize(
    ("axis", "key", "numbers"),
    [
        ({"label": "web", "key": WEB, "values": [8, 10.5, 12]}, WEB, [8.0, 10.5, 12.0]),
        (
            points(
                {f"{WEB}.a": 3, f"{WEB}.b": 1}, {f"{WEB}.b": 1, f"{WEB}.a": 2}, {f"{WEB}.a": 1, f"{WEB}.b": 1}
            ),
            f"{WEB}.a",
            [3, 2, 1],
        ),
        (
            points(*({BEARING: {"x": x, "y": x, "z": 0}} for x in (1e7, 1e8, 1e9))),
            f"{BEARING}.x",
            [1e7, 1e8, 1e9],
        ),
    ],
)
def test_points_stand_over_the_number_that_all_of_them_change(axis, key, numbers):
    one = find_numeric_axis(study(axis))
    assert one.key == key
    assert [value for value, _ in one.points.values()] == numbers
    assert list(one.points) == list(study_points(study(axis)))


def test_the_points_of_the_other_axis_have_curves_of_their_own():
    law = {
        "label": "mesh law",
        "key": "mesh_stiffness.mesh_law",
        "values": ["constant_load", "load_dependent"],
    }
    both = study(law, {"label": "web", "key": WEB, "values": [8, 10, 12]})
    one = find_numeric_axis(both)
    assert {beside for _, beside in one.points.values()} == {
        "mesh law = constant_load",
        "mesh law = load_dependent",
    }
    assert [value for value, beside in one.points.values() if "constant" in beside] == [8.0, 10.0, 12.0]
    assert list(one.points) == list(study_points(both))


@pytest.mark.parametrize(
    "axis",
    [
        {"label": "two numbers", "key": WEB, "values": [8, 10]},
        {"label": "words", "key": "mesh_stiffness.mesh_law", "values": ["a", "b", "c"]},
        {"label": "switch", "key": "contact.edge_contact", "values": [True, False, 0.5]},
        points({WEB: 1}, {WEB: 2}, {BEARING: 3}),
    ],
)
def test_words_switches_and_two_points_make_no_curve(axis):
    assert find_numeric_axis(study(axis)) is None
