"""The drawing of the machine shows all that it says."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

import facegear
from facegear.build.machine_layout import wired_layout
from facegear.report.figures.draw_matplotlib import draw
from facegear.report.figures.machine import HALF_FACE, layout_figure
from facegear.schema.changes import TEETH


def drawn(gears, names):
    """The figure of a machine whose pinions stand evenly around its gears, with forces made up."""
    values = facegear.example().values
    pinions = [
        {"name": name, "role": "input", "angle_deg": 360.0 * i / len(names)} for i, name in enumerate(names)
    ]
    torque = {"per_input_n_m": 1000.0, "tail_share": 0.0}
    section = {**values["transmission"], "pinions": pinions, "face_gears": gears, "torque": torque}
    layout = wired_layout(section, {key: values["tooth_pair"][key] for key in TEETH})
    meshes = {"mesh": layout.mesh_names, "mean_n": 9e3, "drive_fraction": 1.0, "back_fraction": 0.0}
    forces = {"body": layout.body_names, "mean_x_n": 8e3, "mean_y_n": -3e3, "mean_z_n": 1e3}
    return draw(layout_figure(layout, pd.DataFrame(meshes), pd.DataFrame(forces))), layout.mesh_radius


@pytest.mark.parametrize("gears", [["upper"], ["lower"], ["lower", "upper"]])
@pytest.mark.parametrize("names", [["a", "b"], [letter * 40 for letter in "abcdef"], ["left idler"] * 8])
def test_no_text_of_the_layout_is_cut_off_or_hides_a_gear(gears, names):
    """With one gear the title left the page, and long names covered the rim."""
    figure, radius = drawn(gears, [f"{name[:-1]}{i}" for i, name in enumerate(names)])
    figure.draw_without_rendering()
    whole = figure.bbox
    for axis in figure.axes:
        for text in axis.texts:
            box = text.get_window_extent()
            assert whole.x0 <= box.x0 and box.x1 <= whole.x1, text.get_text()
            assert whole.y0 <= box.y0 and box.y1 <= whole.y1, text.get_text()
            corners = axis.transData.inverted().transform(box.corners())
            nearest = np.clip(0.0, corners.min(axis=0), corners.max(axis=0))
            inside = np.abs(corners).max() < radius
            assert inside or np.hypot(*nearest) > (1.0 + HALF_FACE) * radius, text.get_text()
    plt.close(figure)
