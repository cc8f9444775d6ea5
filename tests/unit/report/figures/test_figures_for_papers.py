"""Figures of answers fit into a paper as they come: size, words, no inputs, legends in words."""

import inspect

import matplotlib.pyplot as plt
import pytest
from matplotlib.text import Text

import facegear
from facegear.errors import FacegearError
from facegear.pipeline.results.sharing import LoadSharingResult
from facegear.report.table import value_in_words


def texts(figure):
    """Return the texts that a figure shows."""
    return {text.get_text() for text in figure.findobj(Text) if text.get_text()}


def test_plot_takes_a_size_and_other_words_and_refuses_words_that_are_not_there():
    answer = facegear.example().geometry()
    before = texts(answer.plot("sections"))
    word = next(text for text in sorted(before) if text[0].isalpha())
    figure = answer.plot("sections", size=(3.5, 2.5), labels={word: "other words"})
    assert tuple(figure.get_size_inches()) == (3.5, 2.5)
    assert "other words" in texts(figure) and word not in texts(figure)
    with pytest.raises(FacegearError, match="labels: 'no such' is no text of this figure"):
        answer.plot(labels={"no such": ""})
    plt.close("all")


def test_every_plot_of_an_answer_has_size_and_labels():
    assert {"kind", "beside", "size", "labels"} <= set(inspect.signature(LoadSharingResult.plot).parameters)
    assert "inches" in LoadSharingResult.plot.__doc__


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("transmission.backlash_um", 80, "backlash 80 µm"),
        ("mesh_stiffness.mean_n_per_m", 4.1e8, "mesh stiffness mean 410 N/µm"),
        ("tooth_pair.face_gear.outer_radius_mm", 275.0, "face gear outer radius 275 mm"),
        ("dynamics.speed_rpm", 7500, "speed 7,500 rpm"),
        ("transmission.mesh_kinematics", "geometric", "mesh kinematics geometric"),
        ("transmission.pinions.0.torque_n_m", 300.0, "pinions torque 300 N m"),
    ],
)
def test_a_changed_key_is_written_in_words_with_its_unit(key, value, words):
    assert value_in_words(key, value) == words


def test_the_legend_of_a_study_names_no_config_key():
    study = facegear.example().study({"transmission.backlash_um": [80, 100]})
    assert [study._words(label) for label in study.machines] == ["backlash 80 µm", "backlash 100 µm"]
