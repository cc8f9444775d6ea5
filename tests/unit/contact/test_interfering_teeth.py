"""Contact of teeth whose tips run into the fillets of the other gear: what flanks and fillets carry."""

import numpy as np
import pytest
from contact_bodies import COARSE, STEEL, pair_design, sound

from facegear.contact.analysis import ltca_table
from facegear.contact.flanks import flank_pair
from facegear.contact.gear_flank import BUILDERS
from facegear.contact.ltca import loaded_contact
from facegear.contact.options import ContactOptions, Refinement
from facegear.contact.position import Spot
from facegear.contact.pressure import flank_pressure, line_rows, on_flank
from facegear.contact.search import find_candidates
from facegear.contact.summary import contact_summary
from facegear.contact.teeth import elastic_tooth
from facegear.errors import FacegearError
from facegear.meshing.stiffness_curve import load_table
from facegear.teeth.clearance import smallest_gaps
from facegear.teeth.closest import PAIRS
from facegear.teeth.unloaded_contact import unloaded_contact


def test_interfering_pair_is_stiffened_by_its_fillets_and_the_switch_shows_it(model_of):
    model = model_of(coarse=True, rack_tip_radius=0.25)
    positions = np.arange(8) / 8
    with_fillet = sound(loaded_contact(model, positions, [600.0]))
    without = sound(loaded_contact(model, positions, [600.0], ContactOptions(fillet=False)))
    given_way = [np.mean([r.ste - r.unloaded_error for r in found]) for found in (with_fillet, without)]
    assert given_way[0] < 0.995 * given_way[1]


@pytest.mark.parametrize("torque", [10.0, 600.0])
def test_teeth_that_interfere_have_no_average_stiffness_and_say_so(model_of, torque):
    """It was negative at some positions and told as a number."""
    model = model_of(coarse=True, rack_tip_radius=0.25)
    results = loaded_contact(model, np.arange(4) / 4, [torque])
    known = [np.isfinite(result.k_average) for result in results]
    apart = [result.overlap < 1e-9 for result in results]
    assert known == apart and 0 < sum(known) < 4
    assert all(result.k_average > 0 for result, one in zip(results, known, strict=True) if one)
    assert max(result.fillet_share for result in results) > 0.1
    table = ltca_table(results, flank_pressure(results, model.flanks, (STEEL, STEEL)))
    assert np.isnan(contact_summary(table)["k_average_mean_n_per_m"][0])
    with pytest.raises(
        FacegearError, match=r"the teeth interfere. Tips penetrate the fillets by up to .* um"
    ):
        load_table(table)


@pytest.mark.parametrize(("teeth", "radius"), [(23, 0.1), (24, 0.1), (26, 0.2), (26, 0.3), (26, 0.1)])
def test_contact_sees_the_interference_that_the_geometry_finds(teeth, radius):
    """Deepest along the line of action, at three positions, from hats and edges half a millimetre apart."""
    design, cuts = pair_design(teeth, radius), Refinement(4, 6, 2)
    sides = [elastic_tooth(design, build(design, COARSE[0]), STEEL)[1] for build in BUILDERS.values()]
    pair = flank_pair(design, (sides[0], sides[1]), (cuts, cuts))
    phi1 = np.array([-0.25, -0.125, -0.0625]) * 2 * np.pi / design.pinion.teeth
    seen, expected = [], []
    for first, second in zip(phi1, unloaded_contact(design, phi1).phi2, strict=True):
        found = find_candidates(pair, (first, second), PAIRS, 1e-9, ContactOptions())
        deepest = max((float(np.max(-one.gap / one.lever_arm)) for one in found), default=0.0)
        seen.append(design.pinion_base_radius * deepest)
        gaps = smallest_gaps(design, [first], [second])
        expected.append(max(-gap.approach for gap in gaps.values() if gap.side == "drive"))
    np.testing.assert_allclose(seen, np.maximum(expected, 0.0), rtol=0.1, atol=1e-6)


@pytest.fixture(scope="module")
def interfering(model_of):
    """Gear tips that press into the pinion's fillets, 23 um deep without load."""
    model = model_of(coarse=True, rack_tip_radius=0.25)
    results = loaded_contact(model, [0.25, 0.375, 0.5], [300.0])
    return model, results, flank_pressure(results, model.flanks, (STEEL, STEEL))


def test_what_fillets_carry_stands_beside_the_line_loads_of_the_flanks(interfering):
    model, results, pressure = interfering
    beyond = (model.flanks.pinion.side.flank_rows - 1) * model.flanks.pinion.lattice.refinement.profile
    for result, loads in zip(results, pressure.loads, strict=True):
        in_fillets = sum(spot.force[spot.fillet].sum() for spot in result.spots)
        whole = sum(spot.force.sum() for spot in result.spots)
        lines = {
            int(pressure.tooth[row]): row for row in np.flatnonzero(pressure.position == result.position)
        }
        rows = line_rows(pressure.lines, model.flanks.pinion)
        kept = [on_flank(spot, rows[lines[spot.tooth]], model.flanks.pinion) for spot in result.spots]
        on_flanks = sum(spot.force.sum() for spot in kept)
        assert in_fillets > 0.05 * whole
        assert 0.8 * (whole - in_fillets) < on_flanks < (1 + 1e-9) * (whole - in_fillets)
        carried = (loads.line_load * loads.length).sum()
        assert 0.9 * on_flanks < carried < 1.01 * on_flanks  # three planes a face: its ends lose some
        rows = [spot.hats[spot.fillet] // model.flanks.pinion.shape[1] for spot in result.spots]
        assert min(row.min() for row in rows if row.size) >= beyond


def test_a_tip_that_presses_into_a_fillet_takes_load_and_pressure_off_the_flanks(interfering):
    """Finer and finer cuts gave 664, 839, 1086 and 1204 MPa: the tip's load counted as the flank's."""
    model, results, pressure = interfering
    positions = [result.position for result in results]
    alone = loaded_contact(model, positions, [300.0], ContactOptions(fillet=False))
    flanks_alone = flank_pressure(alone, model.flanks, (STEEL, STEEL))
    for shared, whole in zip(pressure.loads, flanks_alone.loads, strict=True):
        assert shared.largest()[0] < whole.largest()[0]


def test_a_plane_s_load_beside_a_fillet_s_belongs_to_the_line_and_what_touches_the_fillet_does_not(
    interfering,
):
    surface = interfering[0].flanks.pinion
    columns, last = surface.shape[1], (surface.side.flank_rows - 1) * surface.lattice.refinement.profile
    line_at, row = 3, np.array([2, 3, 4, last - 1, last, last + 1])
    force = np.arange(1.0, 7.0)
    spot = Spot(
        tooth=0, hats=row * columns + 5, force=force, fillet=row > last, on_pinion=force, on_gear=force
    )
    kept = on_flank(spot, np.full(columns, float(line_at)), surface)
    np.testing.assert_array_equal(kept.hats // columns, [2, 3, 4])
    ran_off = on_flank(spot, np.full(columns, last - 1.0), surface)
    np.testing.assert_array_equal(ran_off.hats // columns, row[:-1])


def test_hats_of_a_contact_in_a_fillet_are_left_out_whatever_stands_beside_the_line(model_of):
    """Against every plane's contacts sorted by row and looked at one by one."""
    surface, draw = model_of(coarse=True).flanks.pinion, np.random.default_rng(2)
    rows, columns = surface.shape
    for _ in range(40):
        hats = np.sort(draw.choice(rows * columns, rows * columns // 3, replace=False))
        fillet, line = draw.random(hats.size) < 0.2, draw.uniform(0.0, rows, columns)
        kept = on_flank(spot_of(hats, fillet), line, surface).hats
        expected = []
        for plane in range(columns):
            here = np.flatnonzero(hats % columns == plane)
            row = hats[here] // columns
            for contact in np.split(here, np.flatnonzero(np.diff(row) > 2) + 1) if here.size else ():
                own = hats[contact] // columns
                apart = not own[0] - 2 <= line[plane] <= own[-1] + 2
                if not (fillet[contact].any() and apart):
                    expected += hats[contact][~fillet[contact]].tolist()
        assert sorted(kept.tolist()) == sorted(expected)


def spot_of(hats, fillet):
    """Forces of 1 N on hats."""
    none = np.zeros(0)
    return Spot(0, hats, np.ones(hats.size), fillet, none, none)
