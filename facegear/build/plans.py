"""Settings of computations from sections of a config: runs, sweeps, branches, contact, sharing."""

from dataclasses import replace

from facegear.contact.options import ContactOptions, ContactPlan, Refinement, Sector
from facegear.meshing.stiffness_request import StiffnessRequest
from facegear.motion.plan import BranchPlan, JumpRange, Settings, SweepPlan
from facegear.schema.contact import Contact, Mesh, SizesSection
from facegear.schema.motion import (
    CARRIED_STATE_OFFSET,
    SECOND_LOOKS,
    Accuracy,
    Branches,
    LoadSharing,
    SharingMap,
    Sweep,
)
from facegear.schema.stiffness import MeshStiffness, given_series
from facegear.schema.studies import Jumps
from facegear.sharing.groups import MapOptions, SharingOptions, SpeedRange
from facegear.teeth.mesh_sizes import MeshSizes, named_sizes, thin_fillet


def mesh_sizes(section: Mesh, module: float) -> MeshSizes:
    """Return the sizes of the finite elements in SI units.

    Parameters
    ----------
    section : Mesh
        Section `mesh` of the config.
    module : float
        Module of the pair, m.

    Returns
    -------
    MeshSizes
        Sizes, m.
    """
    resolution = section.resolution
    name = resolution if isinstance(resolution, str) else ""
    sizes = own_sizes(resolution) if isinstance(resolution, SizesSection) else named_sizes(resolution, module)
    return thin_fillet(sizes, name) if section.thin_fillet else replace(sizes, fillet_depth=None)


def own_sizes(sizes: SizesSection) -> MeshSizes:
    """Convert the sizes that a config gives itself to SI units.

    Parameters
    ----------
    sizes : SizesSection
        Sizes of the config.

    Returns
    -------
    MeshSizes
        Sizes, m.
    """
    return MeshSizes(
        profile=1e-3 * sizes.profile_mm,
        width=1e-3 * sizes.width_mm,
        thickness=1e-3 * sizes.thickness_mm,
        fillet=None if sizes.fillet_mm is None else 1e-3 * sizes.fillet_mm,
        fillet_depth=None if sizes.fillet_depth_mm is None else 1e-3 * sizes.fillet_depth_mm,
    )


def contact_plan(section: Contact) -> ContactPlan:
    """Return the plan of the contact analysis in SI units.

    Parameters
    ----------
    section : Contact
        Section `contact` of the config.

    Returns
    -------
    ContactPlan
        Torques (N m), positions, refinement, sector and options.
    """
    layer, sector = section.refinement, section.sector
    return ContactPlan(
        torques=section.torques_n_m,
        positions=section.positions_per_pitch,
        refinement=Refinement(layer.profile, layer.width, layer.depth, layer.depth_grading),
        sector=Sector(_number(sector.pinion_teeth), _number(sector.face_gear_teeth), sector.cut_faces),
        options=ContactOptions(section.fillet_contact, section.neighbour_coupling, section.edge_contact),
        element=section.element,
        root_stress=section.root_stress,
    )


def _number(teeth: int | str) -> int | None:
    """Return the number of a tooth; None for `all`."""
    return teeth if isinstance(teeth, int) else None


def settings(section: Accuracy) -> Settings:
    """Return the settings of the steady-state search.

    Parameters
    ----------
    section : Accuracy
        Section `accuracy` of the config.

    Returns
    -------
    Settings
        The settings; lengths in mesh periods.
    """
    return Settings(
        tolerance=section.tolerance,
        dwell=section.dwell_periods,
        settle=max(section.settle_periods, section.dwell_periods),
        longest_period=section.longest_period,
        periodic_residual=section.periodic_residual,
        window=section.window_periods,
        samples=section.samples_per_period,
        refine=section.refine,
        extensions=section.extensions,
    )


def sweep_plan(section: Sweep) -> SweepPlan:
    """Return speeds, directions, chunks and settings of the speed sweep.

    Parameters
    ----------
    section : Sweep
        Section `dynamics.sweep` of the config.

    Returns
    -------
    SweepPlan
        The plan; speeds in rpm.
    """
    return SweepPlan(
        first_rpm=section.from_rpm,
        last_rpm=section.to_rpm,
        points=section.points,
        directions=section.directions,
        chunks=section.chunks,
        overlap=section.overlap_points,
        jump_resolution_rpm=section.jump_resolution_rpm,
        settings=replace(settings(section.accuracy), second_looks=SECOND_LOOKS, aside=CARRIED_STATE_OFFSET),
    )


def branch_plan(section: Branches | None, nominal_rpm: float) -> BranchPlan:
    """Return the plan of the continuation of periodic motions.

    Parameters
    ----------
    section : Branches or None
        Section `branches` of the config; its defaults are used if None.
    nominal_rpm : float
        Nominal pinion speed, rpm.

    Returns
    -------
    BranchPlan
        The plan in SI units, but for speeds in rpm.
    """
    section = section or Branches()
    return BranchPlan(
        from_rpm=section.from_rpm,
        to_rpm=section.to_rpm,
        nominal_rpm=nominal_rpm,
        tolerance=section.tolerance,
        longest_period=section.longest_period,
        longest_start_period=section.longest_start_period,
        max_branches=section.max_branches,
        speeds_rpm=section.explore.speeds_rpm or (nominal_rpm,),
        starts=section.explore.starts,
        spread=1e-6 * section.explore.spread_um,
        seed=section.explore.seed,
        parameters=section.loci.parameters,
        factors=(section.loci.from_factor, section.loci.to_factor),
        nearest=section.loci.nearest,
    )


def sharing_options(section: LoadSharing) -> SharingOptions:
    """Return the options of the load-sharing stage in SI units.

    Parameters
    ----------
    section : LoadSharing
        Section `load_sharing` of the config.

    Returns
    -------
    SharingOptions
        The options; speeds in rpm.
    """
    speeds = section.speed_range
    return SharingOptions(
        samples=section.samples_per_cycle,
        cycles=section.cycles,
        starts=section.starts,
        spread=1e-6 * section.start_spread_um,
        seed=section.seed,
        confidence=section.confidence,
        slow_rpm=section.quasi_static_rpm,
        speeds=SpeedRange(speeds.from_rpm, speeds.to_rpm, speeds.points),
    )


def map_options(section: SharingMap) -> MapOptions:
    """Return the section's values in SI units.

    Parameters
    ----------
    section : SharingMap
        As given.

    Returns
    -------
    MapOptions
        Lengths in m.
    """
    return MapOptions(
        mesh_error=1e-6 * section.mesh_deviation_um,
        position=1e-6 * section.position_deviation_um,
        samples=section.samples,
        points=section.points,
        seed=section.seed,
        bearing_factors=section.input_bearing_factors,
    )


def jump_range(section: Jumps) -> JumpRange:
    """Return the range of speeds in which jumps are looked for.

    Parameters
    ----------
    section : Jumps
        Section `search.jumps` of the config.

    Returns
    -------
    JumpRange
        Speeds in rpm, with the settings of the sweeps.
    """
    return JumpRange(
        range_rpm=section.range_rpm,
        step_rpm=section.step_rpm,
        resolution_rpm=section.resolution_rpm,
        settings=settings(section.accuracy),
    )


def stiffness_request(section: MeshStiffness) -> StiffnessRequest:
    """Return the request of the stiffness stage, with the series written in the config if there is one.

    Parameters
    ----------
    section : MeshStiffness
        Section `mesh_stiffness` of the config.

    Returns
    -------
    StiffnessRequest
        The request in SI units.
    """
    return StiffnessRequest(
        source=section.source,
        mean=section.mean,
        torque=section.torque_n_m,
        definition=section.definition,
        order=section.harmonics_kept,
        variation=section.variation,
        given_series=given_series(section),
    )
