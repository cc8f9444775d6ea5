"""Content of figures: whole pitches, no arbitrary vectors, lines at their orders, text that can be read."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from contact_patterns import line_arrays
from matplotlib.text import Text

from facegear.contact.pattern import LTCA_COLUMNS, SHARES
from facegear.machine.modes import ModeClass
from facegear.report.figures.campbell import campbell
from facegear.report.figures.comparison import curves_compared
from facegear.report.figures.contact import close_pitch, contact_pattern, pose_pattern
from facegear.report.figures.draw_matplotlib import draw, save
from facegear.report.figures.machine import amplitudes, mode_shapes, typical_modes
from facegear.report.figures.marks import Bars
from facegear.report.figures.motion import deflections, drawn_machine
from facegear.report.figures.sharing import bearing_figure, sharing_figure
from facegear.report.figures.teeth import separation


@pytest.fixture
def modes():
    """Six pinion modes of one frequency, turned at random, then a simple one of the same kind."""
    rng = np.random.default_rng(3)
    vectors = np.linalg.qr(rng.normal(size=(8, 8)))[0].T
    frequencies = pd.DataFrame(
        {
            "order": range(1, 8),
            "frequency_hz": [900.0] * 6 + [1200.0],
            "multiplicity": [6] * 6 + [1],
            "symbols": ["idler T"] * 6 + ["input T"],
            "class": ["pinion"] * 7,
        }
    )
    names = [("p", letter) for letter in ("x", "y", "z", "theta")] + [
        ("q", d) for d in ("x", "y", "z", "theta")
    ]
    rows = [
        (order, body, dof, value)
        for order, vector in enumerate(vectors[:7], start=1)
        for (body, dof), value in zip(names, vector, strict=True)
    ]
    return frequencies, pd.DataFrame(rows, columns=["order", "body", "dof", "amplitude_m_or_rad"])


def test_modes_of_one_frequency_are_shown_together_and_do_not_depend_on_their_vectors(modes):
    frequencies, shapes = modes
    (equal, simple) = typical_modes(frequencies)
    assert (equal, simple) == ((1, 2, 3, 4, 5, 6), (7,))
    turned = shapes.copy()
    angle = np.linalg.qr(np.random.default_rng(5).normal(size=(6, 6)))[0]
    stacked = shapes["amplitude_m_or_rad"].to_numpy()[:48].reshape(6, 8)
    turned.loc[:47, "amplitude_m_or_rad"] = (angle @ stacked).ravel()
    assert np.allclose(amplitudes(shapes, equal), amplitudes(turned, equal))
    assert "(x 6)" in mode_shapes(frequencies, shapes).panels[0].title


def test_tilts_are_drawn_beside_the_other_motions_of_their_body():
    """They stood behind all bodies, without a name."""
    names = [(body, dof) for body in ("pinion", "gear") for dof in ("x", "y", "z", "theta")]
    names += [("pinion", "tilt_x"), ("pinion", "tilt_y")]
    rows = [(1, body, dof, 0.1 * number) for number, (body, dof) in enumerate(names, start=1)]
    shapes = pd.DataFrame(rows, columns=["order", "body", "dof", "amplitude_m_or_rad"])
    columns = {
        "order": [1],
        "frequency_hz": [9.0],
        "class": ["pinion"],
        "symbols": ["T"],
        "multiplicity": [1],
    }
    (panel,) = mode_shapes(pd.DataFrame(columns).assign(**{"class": "pinion"}), shapes).panels
    assert panel.x.ticks == [(2.5, "pinion"), (7.5, "gear")]
    (bars,) = (mark for mark in panel.marks if isinstance(mark, Bars))
    assert np.allclose(10.0 * bars.lengths, [1, 2, 3, 4, 9, 10, 5, 6, 7, 8])
    assert "further motions" in panel.x.name


def test_one_bar_stands_for_the_many_motions_of_a_casing():
    """Sixty bars of a casing left no room for the names of the bodies on a phone."""
    rows = [(1, "pinion", "x", 0.5), *((1, "casing", f"mode {i}", -0.05 * i) for i in range(1, 21))]
    shapes = pd.DataFrame(rows, columns=["order", "body", "dof", "amplitude_m_or_rad"])
    columns = {"order": [1], "frequency_hz": [9.0], "symbols": ["T"], "multiplicity": [1]}
    (panel,) = mode_shapes(pd.DataFrame(columns).assign(**{"class": "casing"}), shapes).panels
    (bars,) = (mark for mark in panel.marks if isinstance(mark, Bars))
    assert np.allclose(bars.lengths, [-0.5, 1.0]) and panel.x.ticks == [(0.0, "pinion"), (1.0, "casing")]


def test_only_the_lowest_kinds_of_many_modes_are_drawn():
    """A machine on a casing got 60 panels, 6000 pixels of a page."""
    frequencies = pd.DataFrame(
        {
            "order": range(1, 61),
            "class": "casing",
            "symbols": [f"kind {i}" for i in range(60)],
            "multiplicity": 1,
        }
    )
    modes = typical_modes(frequencies.assign(**{"class": "casing"}))
    assert modes == [(order,) for order in range(1, 13)]


def test_a_contact_curve_ends_where_the_next_pitch_begins():
    rows = pd.DataFrame(1.0, index=range(4), columns=list(LTCA_COLUMNS)).assign(
        position=[0.0, 0.25, 0.5, 0.75], ste_um=[5.0, 6.0, 7.0, 6.0]
    )
    rows[list(SHARES)] = 0.0
    rows.loc[0, ["load_share_pair_0", "load_share_pair_p1"]] = [0.4, 0.6]
    end = close_pitch(rows).iloc[-1]
    assert end["position"] == 1.0
    assert end["ste_um"] == 5.0
    assert end[["load_share_pair_m1", "load_share_pair_0"]].to_list() == [0.4, 0.6]


def test_spectra_are_lines_at_their_orders_without_the_mean():
    response = pd.DataFrame({"mesh_cycle": [0.0, 0.5], "mesh": "p/upper", "deflection_um": [40.0, 42.0]})
    spectrum = pd.DataFrame(
        {"mesh": "p/upper", "order": [0.0, 0.5, 1.0, 2.0], "amplitude_um": [40.0, 0.0, 3.0, 1.0]}
    )
    (lines,) = deflections(response, spectrum, ["p"]).panels[1].marks
    assert lines.x[1::3] == pytest.approx([1.0, 2.0], abs=0.1)
    assert lines.y[1::3].tolist() == [3.0, 1.0]


def test_text_is_at_least_12_px_high_on_a_page_500_px_wide(modes):
    response = pd.DataFrame({"mesh_cycle": [0.0, 0.5], "mesh": "p/upper", "deflection_um": [40.0, 42.0]})
    spectrum = pd.DataFrame({"mesh": ["p/upper"], "order": [1.0], "amplitude_um": [3.0]})
    margins = 40
    for described in (mode_shapes(*modes), deflections(response, spectrum, ["p"])):
        figure = draw(described)
        scale = min(1.0, (500 - margins) / (96 * figure.get_figwidth()))
        shown = [text for text in figure.findobj(Text) if text.get_text()]
        assert min(text.get_fontsize() for text in shown) * 96 / 72 * scale >= 12.0 - 1e-9


def test_a_load_sharing_figure_holds_no_inputs_and_its_legend_leaves_the_axis_readable():
    cycle = np.arange(8) / 8
    curves = pd.DataFrame(
        {
            "study": "s",
            "point": "a",
            "label": "80 um",
            "group": "idlers",
            "kind": "idlers",
            "cycle_fraction": cycle,
            "time_s": 3.5e-4 * cycle,
            "coefficient": 1.5,
            "envelope_low": 1.5,
            "envelope_high": 1.5,
        }
    )
    summary = pd.DataFrame(
        {
            "study": ["s"],
            "point": ["a"],
            "group": ["idlers"],
            "mean": [1.5],
            "motion": ["period-1"],
            "half_width": [0.0],
            "undefined_fraction": [0.5],
        }
    )
    figure = draw(sharing_figure(curves, summary, "idlers", "Effect of backlash"))
    figure.canvas.draw()
    box = figure.get_tightbbox()
    assert box.x0 >= 0.0 and box.x1 <= figure.get_figwidth()
    assert not any("N/m" in text.get_text() for text in figure.findobj(Text))
    (axis,) = figure.axes
    assert figure.legends[0].get_window_extent().y1 <= axis.xaxis.label.get_window_extent().y0
    plt.close(figure)


def test_the_legend_of_curves_compared_leaves_the_offset_of_their_numbers_free():
    x = np.linspace(0.0, 1.0, 9)
    old, new = (pd.DataFrame({"x": x, "k": 4.1e8 + 1e3 * np.sin(factor * x)}) for factor in (7.0, 8.0))
    figure = draw(curves_compared(old, new, "x", "k", ("position", "stiffness (N/m)"), "tvms.csv"))
    figure.canvas.draw()
    top = figure.axes[0]
    offset = top.yaxis.get_offset_text()
    assert offset.get_text()
    assert not offset.get_window_extent().overlaps(top.get_legend().get_window_extent())
    plt.close(figure)


def test_names_of_the_edges_of_a_flank_stand_off_their_curves():
    radius = np.linspace(0.25, 0.275, 21)
    end = -0.0445 - 0.003 * np.sqrt((radius - 0.25) / 0.025)
    edges = [np.column_stack([radius, np.zeros(21), z]) for z in (np.full(21, -0.0395), end)]
    across, height = np.meshgrid(radius, np.linspace(-0.044, -0.04, 5), indexing="ij")
    contact = {
        "contour_facing": np.ones_like(across),
        "contour_gap": 1e-3 * np.abs(across - 0.265),
        "contour_radius": across,
        "contour_y": across,
        "contour_height": height,
        "contour_roll": np.linspace(0.2, 0.4, 21)[:, None],
        "path_roll": np.linspace(0.25, 0.35, 3),
        "path_y": np.full(3, 0.265),
    }
    gap = {"gap_um": 7.8, "gear_radius_mm": 259.6, "gear_part": "tip edge", "pinion_part": "fillet"}
    spur = {"helix_angle": 0.0, "taper_angle": 0.0, "offset": 0.0, "shaft_angle": np.pi / 2}
    spur |= {"pressure_angle": 0.4, "coast_pressure_angle": None}
    figure = draw(
        separation({"smallest_gap": gap, "design_si": spur}, {"gear_flank": np.stack(edges)}, contact)
    )
    figure.canvas.draw()
    axes = figure.axes[0]
    names = {"tip edge", "end of the flank"}
    boxes = [text.get_window_extent() for text in axes.texts if text.get_text() in names]
    assert len(boxes) == len(names)
    for line in axes.lines[:2]:
        for x, y in axes.transData.transform(line.get_xydata()):
            assert not any(box.contains(x, y) for box in boxes)
    plt.close(figure)


def test_the_drawing_of_a_fine_contact_pattern_stays_small(tmp_path):
    """Every cell as a triangle of its own made 61 MB of config/paper.yaml's."""
    along, across = np.meshgrid(np.linspace(0.25, 0.275, 60), np.linspace(0.04, 0.046, 60))
    points = np.stack([across, along, np.zeros_like(along)], axis=-1)
    pressure = 1e9 * np.sin(0.01 * np.arange(along.size)) ** 2
    arrays = {"point_m": points.reshape(-1, 3)} | line_arrays(points, [100.0], pressure)
    save(contact_pattern(arrays), tmp_path / "pattern.svg")
    assert (tmp_path / "pattern.svg").stat().st_size < 300_000


def test_the_pattern_of_a_pose_names_its_own_mesh_among_others_of_the_same_torque():
    """The nearest torque named the mesh, which two inputs shared but for rounding."""
    along, across = np.meshgrid(np.linspace(0.25, 0.275, 6), np.linspace(0.04, 0.046, 6))
    points = np.stack([across, along, np.zeros_like(along)], axis=-1)
    lines = {"point_m": points.reshape(-1, 3)} | line_arrays(points, [100.0], np.full(along.size, 1e9))
    meshes = pd.DataFrame({"mesh": ["first/upper", "second/upper"], "torque_n_m": [100.0, 100.0]})
    meshes = meshes.assign(path_mm=262.0, path_as_assembled_mm=263.0, stiffness_by_pose_percent=[0.1, -4.0])
    assert pose_pattern(meshes, lines, lines).title == "second/upper at 100 N m"


@pytest.mark.parametrize(
    ("singled", "torque", "shown"),
    [
        ({}, None, ("tail", "right")),
        ({"left": {"position_um": {"x": 5.0}}}, None, ("tail", "right", "left")),
        ({}, 500.0, ("tail", "right", "left")),
    ],
)
def test_every_pinion_has_a_panel_where_parts_or_torques_differ(singled, torque, shown):
    roles = (("tail", "tail", None), ("right", "input", None), ("left", "input", torque))
    pinions = [{"name": name, "role": role, "torque_n_m": own} for name, role, own in roles]
    singles = {"single_pinions": singled, "single_meshes": {}, "single_gears": {}}
    drawn = drawn_machine({"pinions": pinions, "face_gears": ["lower", "upper"], **singles}, 23)
    assert drawn.pinions_shown == shown


def test_the_legend_of_a_campbell_diagram_with_all_marks_lies_inside_it():
    """The longest label was cut off at the right, the first column at the left; casings had no colour."""
    frequencies = pd.DataFrame(
        {
            "frequency_hz": [700.0, 2200.0, 5600.0, 6100.0],
            "class": [str(kind) for kind in ModeClass if kind is not ModeClass.RIGID],
        }
    )
    marks = pd.DataFrame({"order": [1.0, 0.3], "resonance": [1, 2], "speed_rpm": [2000.0, 9000.0]})
    jumps = pd.concat([marks, marks]).assign(kind=["jump", "jump", "irregular", "irregular"])
    jumps = jumps.rename(columns={"speed_rpm": "speed_after_rpm"})
    figure = draw(campbell(frequencies, marks, jumps, 23, 20000.0))
    figure.canvas.draw()
    (legend,) = figure.legends
    box = legend.get_window_extent()
    assert len(legend.texts) == 10
    assert box.x0 >= 0 and box.x1 <= figure.bbox.x1
    plt.close(figure)


def test_load_sharing_over_bearings_has_no_curve_of_kinematics_that_were_not_solved():
    """Machines with other than spur teeth know no printed kinematics; the legend named their curves."""
    rows = [
        (kinematics, role, stiffness, kind, 1.2)
        for kinematics in ("geometric", "printed")
        for role in ("inputs", "idlers")
        for kind in ("inputs", "idlers")
        for stiffness in (1e7, 1e8)
    ]
    scan = pd.DataFrame(rows, columns=["kinematics", "varied", "stiffness_n_per_m", "kind", "k_gamma"])
    geometric = scan[scan["kinematics"] == "geometric"]
    for table, count in ((scan, 4), (geometric, 2)):
        assert [len(panel.marks) for panel in bearing_figure(table).panels] == [count, count]
