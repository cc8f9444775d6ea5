"""Loss, heat and film of the paper's pair under load, 32 positions of a pitch."""

from dataclasses import fields, replace
from math import pi

import numpy as np
import pytest
from contact_bodies import STEEL
from oils import oil
from references import against, agrees

from facegear.contact.analysis import pressure_arrays
from facegear.contact.hertz import contact_modulus
from facegear.contact.ltca import even_positions, loaded_contact
from facegear.contact.pressure import flank_pressure
from facegear.lubrication.assessment import friction_ratios
from facegear.lubrication.contact_points import contact_points, loaded_contacts, stored_lines
from facegear.lubrication.friction import BenedictKelley, Constant, Doleschel, Schlenk, Xu
from facegear.lubrication.heat import TooHot, running
from facegear.lubrication.kinematics import slip, spins
from facegear.lubrication.loss import hat_slip, loss_factors
from facegear.lubrication.machine_loss import MeshLoads, machine_loss
from facegear.lubrication.pairs import LoadedPair
from facegear.lubrication.reduction import Condition, ReducedPair, reduce_contacts
from facegear.lubrication.request import STEEL as HEATED
from facegear.lubrication.request import BorrowedBulk, Cooling, GivenBulk, Lubrication
from facegear.teeth.placement import mirror_design

SPEED = 7500 * pi / 30
MODULUS = contact_modulus((STEEL, STEEL))
TORQUES = [300.0, 1000.0]


def stored(model, positions, torques):
    results = loaded_contact(model, even_positions(positions), torques)
    pressed = flank_pressure(results, model.flanks, (STEEL, STEEL))
    unloaded = {one.position: one.unloaded_error for one in results}
    return pressure_arrays(results, model.flanks.pinion, pressed), unloaded


@pytest.fixture(scope="module")
def loaded(model_of):
    """Design, hats and contacts by torque of the stored contact."""
    model = model_of()
    arrays, unloaded = stored(model, 32, TORQUES)
    lines = stored_lines(model.design, arrays, unloaded)
    hats = hat_slip(model.design, arrays)
    contacts = loaded_contacts(contact_points(model.design, arrays, lines, MODULUS), hats)
    return model.design, hats, {contact.torque: contact for contact in contacts}


def lubrication(design, friction, bulk=None):
    return Lubrication(
        oil=oil(),
        oil_temperature=100.0,
        friction=friction,
        ra=(0.3e-6, 0.3e-6),
        rq=(0.375e-6, 0.375e-6),
        bulk=bulk or GivenBulk(100.0),
        flanks=(HEATED, HEATED),
        reduced_modulus=2 * MODULUS,
        pitch_radius=design.pinion_pitch_radius,
    )


@against(
    "second implementation",
    "another quadrature of the loads of the default mesh",
    capability="lubrication machine_loss",
    module="facegear.lubrication.loss",
)
def test_loss_factors_are_the_reference_s_within_a_percent(loaded):
    """The reference: another quadrature of the default mesh, 32 positions."""
    _, hats, _ = loaded
    found = loss_factors(hats)
    agrees("mean loss factor", found.mean, [0.112617, 0.124134], relative=0.01)
    agrees("smallest loss factor", found.at.min(axis=1), [0.0548, 0.0881], relative=0.04)
    agrees("largest loss factor", found.at.max(axis=1), [0.1388, 0.1395], relative=0.01)
    largest = [1e3 * hats.sliding[hats.torque == torque].max() for torque in TORQUES]
    agrees(
        "largest sliding, mm per rad", largest, [13.137, 16.453], relative=0.03
    )  # at the outermost loaded hat


@against(
    "analytic",
    "balance of power",
    capability="lubrication",
    module="facegear.lubrication.loss",
)
def test_power_in_less_power_out_is_the_friction_and_the_closing_work(loaded):
    design, _, contacts = loaded
    pinion, gear = spins(design)
    mu = 0.05
    for torque in TORQUES:
        one = contacts[torque].hats
        factor = loss_factors(one)
        for number, position in enumerate(factor.positions):
            at = one.position == position
            way = one.velocity[at] / np.maximum(one.sliding[at], 1e-30)[:, None]
            force = one.force[at, None] * (one.normal[at] + mu * way)
            point = one.point[at]
            taken = pinion.torque(point, force) * pinion.speed
            given = gear.torque(point, force) * gear.speed
            closing = float((one.force * one.normal_velocity)[at].sum())
            lost = mu * factor.at[0, number] * torque
            agrees("power lost, W per rad/s", taken - given, lost + closing, absolute=1e-12 * torque)


@against(
    "analytic",
    "base radius of an involute",
    capability="lubrication",
    module="facegear.lubrication.kinematics",
)
def test_normal_forces_alone_carry_the_torque_of_the_pinion(loaded):
    """To the last digits on the involute; a hat at the fillet has an arm of its own within a tenth."""
    design, hats, _ = loaded
    pinion, _ = spins(design)
    arm = np.cross(hats.point - pinion.through, hats.normal) @ pinion.axis
    involute = np.abs(arm - design.pinion_base_radius) < 1e-9
    assert involute.mean() > 0.95
    agrees("lever arm of the normal force, m", arm[involute], design.pinion_base_radius, relative=1e-11)
    carried = hats.force * arm
    end = np.linalg.norm(hats.point[~involute][:, [0, 2]], axis=1).max(initial=0.0)
    near = np.linalg.norm(hats.point[:, [0, 2]], axis=1) < end + 2e-4
    for torque in TORQUES:
        for position in np.unique(hats.position):
            at = (hats.torque == torque) & (hats.position == position)
            allowed = 0.1 * carried[at & near].sum() + 1e-11 * torque
            assert carried[at].sum() == pytest.approx(torque, rel=0, abs=allowed)


@against(
    "second implementation",
    "another quadrature of the loads of the default mesh",
    capability="lubrication",
    module="facegear.lubrication.heat",
)
@pytest.mark.parametrize(
    ("torque", "largest", "place", "thinnest", "kept", "ratio"),
    [
        (300.0, 62.9, (0.9375, -1, 270.58), 0.195, (0.86, 0.96), 0.508),
        (1000.0, 128.9, (0.90625, -1, 272.88), None, (0.85, 0.96), 0.391),
    ],
)
def test_largest_flash_and_thinnest_film_are_the_reference_s(
    loaded, torque, largest, place, thinnest, kept, ratio
):
    """The reference is of the default mesh; here planes lie closer, so that the hottest place lies nearer to
    an edge.

    The thinnest film at 1000 N m lies in a plane whose fillet touches in this pair without backlash.
    """
    design, _, contacts = loaded
    one = contacts[torque].points
    state = running(contacts[torque], SPEED, lubrication(design, Constant(0.05)))
    hottest = np.flatnonzero(one.inside)[state.flash[one.inside].argmax()]
    agrees("largest flash temperature, K", state.flash[hottest], largest, relative=0.04)
    stage, y = one.position[hottest] + one.tooth[hottest], 1e3 * one.y[hottest]
    assert stage == pytest.approx(place[0] + place[1], abs=0.05) and y == pytest.approx(place[2], abs=1.5)
    unsheared = (state.film / state.sheared)[one.inside]
    if thinnest is not None:
        agrees("smallest film, um", 1e6 * unsheared.min(), thinnest, relative=0.02)
    sheared = state.sheared[one.inside]
    agrees("factor of shear heating", [sheared.min(), sheared.max()], kept, absolute=0.01)
    agrees("smallest specific film", state.micropitting[one.inside].min(), ratio, relative=0.02)


@against(
    "second implementation",
    "another quadrature of the loads of the default mesh",
    capability="lubrication",
    module="facegear.lubrication.friction",
)
def test_models_of_friction_differ_as_much_as_the_reference_says(loaded):
    """Means weighted with loss: Schlenk 0.029 and 0.035; Xu 0.009 and 0.012 with one flank's roughness."""
    design, hats, contacts = loaded
    factors = loss_factors(hats).mean
    for model, means, bound in ((Schlenk(), (0.029, 0.035), 0.02), (Xu(), (0.009, 0.012), 0.35)):
        for torque, factor, mean in zip(TORQUES, factors, means, strict=True):
            state = running(contacts[torque], SPEED, lubrication(design, model))
            agrees(
                f"mean friction, {type(model).__name__}",
                state.loss / (factor * torque * SPEED),
                mean,
                relative=bound,
            )


@against(
    "analytic",
    "Coulomb friction",
    capability="lubrication",
    module="facegear.lubrication.heat",
)
def test_loss_is_linear_in_a_constant_coefficient_and_none_without(loaded):
    design, _, contacts = loaded
    one = contacts[300.0]
    losses = [running(one, SPEED, lubrication(design, Constant(mu))).loss for mu in (0.0, 0.02, 0.06)]
    assert losses[0] == 0.0
    agrees("loss at three times the friction, W", losses[2], 3 * losses[1], relative=1e-13)
    slow = running(one, 0.1 * SPEED, lubrication(design, Constant(0.02))).loss
    agrees("loss at a tenth of the speed, W", slow, 0.1 * losses[1], relative=1e-13)


@against(
    "analytic",
    "balance of heat",
    capability="lubrication",
    module="facegear.lubrication.heat",
)
def test_heat_of_both_bodies_is_the_loss_and_warms_them_until_it_settles(loaded):
    design, _, contacts = loaded
    one = contacts[1000.0]
    state = running(one, SPEED, lubrication(design, Xu(), Cooling(60.0, 200.0)))
    agrees("heat of both bodies, W", sum(state.heat), state.loss, relative=1e-12)
    agrees(
        "bulk temperature, C",
        state.bulk,
        [100.0 + state.heat[0] / 60.0, 100.0 + state.heat[1] / 200.0],
        absolute=1e-4,
    )
    assert state.bulk[0] > 105.0
    with pytest.raises(TooHot, match=r"a body reaches 2\d+ C at 1000 N m and 7500 rpm, above .* 246 C"):
        running(one, SPEED, lubrication(design, Constant(0.05), Cooling(15.0, 20.0)))


def test_the_loads_that_friction_follows_carry_the_whole_force_of_every_line(loaded):
    """The smoothed ones carry 98 %, so that coefficients came out 0.4 % low."""
    _, _, contacts = loaded
    for one in contacts.values():
        spots, hats = one.points, one.hats
        for position, tooth in np.unique(np.stack([spots.position, spots.tooth], axis=1), axis=0):
            on = (spots.position == position) & (spots.tooth == tooth)
            force = hats.force[(hats.position == position) & (hats.tooth == tooth)].sum()
            assert (spots.scaled_load * spots.length)[on].sum() == pytest.approx(force, rel=1e-12)
        assert (spots.line_load * spots.length).sum() < 0.995 * hats.force.sum()


def varied(known, part):
    """The oil's temperature and viscosity, and both roughnesses, each at a part of its range."""
    oil = replace(known.oil, viscosities=tuple(one * (0.9 + 0.2 * part[0]) for one in known.oil.viscosities))
    rough = {name: tuple(one * (0.5 + part[1]) for one in getattr(known, name)) for name in ("ra", "rq")}
    return replace(known, oil=oil, oil_temperature=85.0 + 30.0 * part[2], **rough)


LOADS = MeshLoads(
    pinion=np.array([0, 0, 1]),
    gear=np.array([0, 1, 0]),
    torque=np.array([320.0, 500.0, 900.0]),
    peak=np.array([400.0, 600.0, 950.0]),
    pinions=2,
    bodies=4,
)


@pytest.mark.parametrize(
    ("model", "bulk"),
    [
        (Schlenk(), Cooling(60.0, 200.0)),
        (Xu(), Cooling(60.0, 200.0)),
        (Doleschel(0.08, 0.2, -0.1, 0.03, 0.3, -0.1, 0.1), Cooling(60.0, 200.0)),
        (BenedictKelley(), BorrowedBulk(1.2)),
        (Constant(0.05), GivenBulk(120.0)),
    ],
)
def test_few_places_lose_heat_and_thin_out_as_all_places_of_the_contact_do(loaded, model, bulk):
    design, _, contacts = loaded
    pair = tuple(contacts[torque] for torque in TORQUES)
    start, draw = lubrication(design, model, bulk), np.random.default_rng(31).random
    conditions = []
    for number in range(12):
        known = varied(start, draw(3))
        rise = (0.618 * number) % 1.0 * (known.oil.flash_point - known.oil_temperature)
        warm = bulk.temperature if isinstance(bulk, GivenBulk) else known.oil_temperature + rise
        conditions.append(Condition(SPEED * (0.9 + 0.2 * draw()), known, warm))
    few = reduce_contacts(pair, conditions)
    assert few.weights.size < 0.05 * sum(one.points.plane.size for one in pair)
    assert (few.weights > 0.0).all()
    for _ in range(2):
        known, speed = varied(start, draw(3)), SPEED * (0.9 + 0.2 * draw())
        whole = machine_loss(LoadedPair(pair, known), LOADS, speed)
        found = machine_loss(ReducedPair(few, known), LOADS, speed)
        for name in ("loss", "pinion_heat", "heat", "flash", "film_ratio", "micropitting"):
            np.testing.assert_allclose(getattr(found, name), getattr(whole, name), rtol=1e-6, err_msg=name)
        np.testing.assert_allclose(found.bulk, whole.bulk, atol=1e-4)


def test_a_hat_takes_the_value_of_its_own_plane_or_the_nearest_of_its_line(loaded):
    _, _, contacts = loaded
    one = contacts[1000.0]
    near = one.nearest >= 0
    assert near.mean() > 0.99
    stages = one.at_hats(one.points.position + 10.0 * one.points.tooth)[near]
    assert stages == pytest.approx((one.hats.position + 10.0 * one.hats.tooth)[near], abs=1e-12)
    planes = one.at_hats(one.points.plane.astype(float))[near]
    keys = set(zip(one.points.position, one.points.tooth, one.points.plane, strict=True))
    own = zip(one.hats.position[near], one.hats.tooth[near], one.hats.plane[near], strict=True)
    known = np.array([key in keys for key in own])
    assert known.mean() > 0.9
    assert (planes == one.hats.plane[near])[known].all()


def test_the_back_flank_is_the_mirror_image_in_loss_and_in_friction_s_force(loaded):
    """A pair out of place: the drive flank, seen in a mirror and turning the same way."""
    design, hats, _ = loaded
    moved = replace(design, assembly=replace(design.assembly, offset=3e-4))
    hats = at(hats, hats.torque == 1000.0)
    flanks = []
    for pair, mirror in ((moved, np.ones(3)), (mirror_design(moved), np.array([-1.0, 1.0, 1.0]))):
        point, normal = hats.point * mirror, hats.normal * mirror
        velocity, closing = slip(*spins(pair), point, normal)
        seen = replace(hats, point=point, normal=normal, velocity=velocity, normal_velocity=closing)
        flanks.append(
            (loss_factors(seen).mean[0], friction_ratios(pair, seen, np.full(point.shape[0], 0.05)))
        )
    (drive, ratios), (back, opposite) = flanks
    assert back == pytest.approx(drive, rel=1e-12)
    assert drive != pytest.approx(loss_factors(hats).mean[0], rel=1e-6)
    np.testing.assert_allclose(opposite, ratios * [1.0, -1.0, -1.0, 1.0, 1.0], atol=1e-12)


def at(hats, on):
    return replace(hats, **{field.name: getattr(hats, field.name)[on] for field in fields(hats)})
