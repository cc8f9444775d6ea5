import numpy as np
import pytest
from free_machines import natural_modes, rigid_rotation
from lumped_machines import drive_rows
from references import against, agrees

from facegear.machine.linear_model import lumped_model
from facegear.machine.modes import ModeClass, name_modes

TABLE_2 = [0.0] * 6 + [756.7, 757.3, 757.9, 757.9, 833.5] + [1171.8] * 5
TABLE_2 += [2260.1, 4617.0, 4770.0, 5080.8, 5406.4, 5565.2, 5581.5, 5581.5, 5622.2, 6069.2, 6438.0, 6488.0]
PINION_ORDERS = {7, 8, 9, 10, 12, 13, 14, 15, 16, 23, 24}
GEAR_ORDERS = {17, 21, 22, 25}
COUPLED_ORDERS = {11, 18, 19, 20, 26, 27, 28}


@pytest.fixture
def paper(layout_of):
    layout = layout_of()
    return layout, natural_modes(layout, 4.1e8)


@against(
    "external source",
    "the paper, Table 2",
    capability="modal",
    module="facegear.machine.modes",
)
def test_all_frequencies_of_table_2_within_its_rounding(paper):
    _, modes = paper
    agrees("natural frequency, Hz", modes.frequencies, TABLE_2, absolute=0.0501)
    assert (modes.frequencies[:6] == 0.0).all()


def test_multiplicities_of_table_2(paper):
    _, modes = paper
    repeated = {start + 1: stop - start for start, stop in modes.groups if stop - start > 1}
    assert repeated == {1: 6, 9: 2, 12: 5, 23: 2}


def test_the_papers_three_classes_come_out_of_the_shapes(paper):
    names = name_modes(paper[0], lumped_model(paper[0]), paper[1])
    by_class = {kind: {k for k, name in enumerate(names, 1) if name.mode_class is kind} for kind in ModeClass}
    assert by_class[ModeClass.RIGID] == set(range(1, 7))
    assert by_class[ModeClass.PINION] == PINION_ORDERS
    assert by_class[ModeClass.GEAR] == GEAR_ORDERS
    assert by_class[ModeClass.PINION_AND_GEAR] == COUPLED_ORDERS


@pytest.mark.parametrize(
    ("order", "symbols"),
    [
        (7, "input, idler T-R"),
        (8, "input, idler, tail T-R"),
        (11, "input, idler, tail T-R; face gear R"),
        (14, "input, idler, tail T"),
        (17, "face gear T(x)-R-A"),
        (18, "input, idler T-R; face gear T(y)"),
        (25, "face gear T(y)"),
        (28, "input, idler, tail T-R; face gear T(x)-R-A"),
    ],
)
def test_symbols_of_table_2(paper, order, symbols):
    assert name_modes(paper[0], lumped_model(paper[0]), paper[1])[order - 1].symbols == symbols


def test_names_do_not_depend_on_the_basis_of_a_repeated_frequency(paper):
    layout, modes = paper
    rng = np.random.default_rng(1)
    turned = modes.shapes.copy()
    for start, stop in modes.groups:
        rotation, _ = np.linalg.qr(rng.normal(size=(stop - start, stop - start)))
        turned[:, start:stop] = turned[:, start:stop] @ rotation
    again = name_modes(layout, lumped_model(layout), type(modes)(modes.frequencies, turned, modes.groups))
    for name, other in zip(name_modes(layout, lumped_model(layout), modes), again, strict=True):
        assert (name.mode_class, name.symbols) == (other.mode_class, other.symbols)


def test_the_rigid_rotation_deflects_no_mesh(layout_of):
    layout = layout_of()
    assert np.abs(drive_rows(layout) @ rigid_rotation(layout)).max() < 1e-15


def test_a_single_face_gear_with_two_pinions_has_its_modes(layout_of):
    from facegear.machine.layout import Role, Side

    layout = layout_of((("one", Role.INPUT, 0.0), ("two", Role.INPUT, 45.0)), (Side.UPPER,))
    modes = natural_modes(layout, 4.1e8)
    assert modes.frequencies.size == 12
    assert (modes.frequencies == 0.0).sum() == 3
