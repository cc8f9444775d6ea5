"""A study's points have the values that their labels state."""

import pytest

import facegear
from facegear.errors import ConfigErrors, FacegearError
from facegear.schema.base import parse
from facegear.schema.studies import Study

TORQUE = "transmission.torque.per_input_n_m"


def study(*axes):
    return parse(Study, {"name": "one", "title": "One", "axes": list(axes)})


def axis(label, key, *values):
    return {"label": label, "key": key, "values": list(values)}


def points(label, *changes):
    return {
        "label": label,
        "points": [{"label": f"{label} {n}", "set": one} for n, one in enumerate(changes)],
    }


WHOLE = {"transmission.torque": {"per_input_n_m": 5, "tail_share": 0}}


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (axis("torque", TORQUE, 1, 2), axis("load", TORQUE, 3, 4)),
        (axis("torque", TORQUE, 1, 2), points("load", {TORQUE: 3}, {"dynamics.speed_rpm": 4})),
        (axis("torque", TORQUE, 1, 2), points("load", WHOLE, {"dynamics.speed_rpm": 4})),
        (points("load", WHOLE, {"dynamics.speed_rpm": 4}), axis("torque", TORQUE, 1, 2)),
        (axis("k", "mesh_stiffness.table", [], None), axis("k1", "mesh_stiffness.table.0.cos_n_per_m", 1, 2)),
    ],
)
def test_two_axes_that_set_one_key_are_refused(first, second):
    """The second value was taken, and the label stated both."""
    with pytest.raises(ConfigErrors, match="keys that the other axis does not set"):
        study(first, second)


def test_axes_over_neighbouring_keys_are_allowed():
    given = axis("a", f"{TORQUE}", 1, 2), axis("b", "transmission.torque.tail_share", 0.1, 0.2)
    assert len(study(*given).axes) == 2
    alike = axis("a", "dynamics.speed", 1), axis("b", "dynamics.speed_rpm", 2)
    assert len(study(*alike).axes) == 2


def test_a_point_that_sets_a_section_and_a_key_inside_it_is_refused():
    with pytest.raises(ConfigErrors, match="keys none of which holds another"):
        study(points("load", {TORQUE: 3, **WHOLE}))


def test_a_study_in_python_refuses_a_key_beside_the_section_that_holds_it():
    with pytest.raises(FacegearError, match=f"{TORQUE}: must not be set beside transmission.torque"):
        facegear.example().study({"transmission.torque": [{}], TORQUE: [1]})


def test_a_change_that_a_later_one_would_undo_is_refused():
    with pytest.raises(ConfigErrors, match=f"{TORQUE}: must come after transmission.torque"):
        facegear.example().with_values({TORQUE: 3, **WHOLE})
