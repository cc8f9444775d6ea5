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
from facegear.schema.stiffness import MeshStiffness, coast_series, given_series
from facegear.schema.studies import Jumps
from facegear.sharing.groups import MapOptions, SharingOptions, SpeedRange
from facegear.teeth.mesh_sizes import MeshSizes, named_sizes, thin_fillet


def mesh_sizes(section: Mesh, module: float) -> MeshSizes:
    """Return the sizes of the finite elements of the contact analysis in SI units.

    They are those of the named resolution for this module, or those that the config gives itself.
    Elements at the fillet are thin where `thin_fillet` is set.

    Parameters
    ----------
    section : Mesh
        Section `mesh` of the config.
    module : float
        Module of the pair, m.

    Returns
    -------
    MeshSizes
        Element sizes, m.
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
        Element sizes in mm, given in place of a named resolution.

    Returns
    -------
    MeshSizes
        Element sizes, m; None where the config leaves the fillet open.
    """
    return MeshSizes(
        profile=1e-3 * sizes.profile_mm,
        width=1e-3 * sizes.width_mm,
        thickness=1e-3 * sizes.thickness_mm,
        fillet=None if sizes.fillet_mm is None else 1e-3 * sizes.fillet_mm,
        fillet_depth=None if sizes.fillet_depth_mm is None else 1e-3 * sizes.fillet_depth_mm,
    )


def contact_plan(section: Contact) -> ContactPlan:
    """Return the settings of the contact analysis, as its code takes them.

    Parameters
    ----------
    section : Contact
        Section `contact` of the config.

    Returns
    -------
    ContactPlan
        Torques on the pinion (N m), positions a pitch, refinement of the contact lattice, teeth in the
        model, options, element type, and whether root stress is read.
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
    """Return a number of teeth in the model as it is given; None for `all`, the whole gear."""
    return teeth if isinstance(teeth, int) else None


def settings(section: Accuracy) -> Settings:
    """Return the settings of the steady-state search, without second looks at doubtful motions.

    Parameters
    ----------
    section : Accuracy
        Section `accuracy` of dynamics, or of the jumps of a search.

    Returns
    -------
    Settings
        The settings; lengths of time in mesh periods, tolerances relative. `settle` is at least `dwell`.
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
        The plan; pinion speeds in rpm. Its settings check doubtful motions from SECOND_LOOKS other
        starts.
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
        Section `branches` of the config; all its defaults are used if None.
    nominal_rpm : float
        Nominal pinion speed, rpm; starts are explored here where the section names no speeds.

    Returns
    -------
    BranchPlan
        The plan; spread of starts in m, speeds in rpm.
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
        The options; spread of starts in m, speeds in rpm.
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
    """Return the settings of the load-sharing map in SI units.

    Parameters
    ----------
    section : SharingMap
        Section `sharing_map` of the config.

    Returns
    -------
    MapOptions
        Deviations of meshes and pinion positions in m, numbers of samples and points, seed, and factors
        on the stiffness of the inputs' bearings.
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
    """Return the range around an operating speed in which a search looks for jumps of the sweep.

    Parameters
    ----------
    section : Jumps
        Section `search.jumps` of the config.

    Returns
    -------
    JumpRange
        Range, step and resolution in rpm, with the settings of the steady-state search.
    """
    return JumpRange(
        range_rpm=section.range_rpm,
        step_rpm=section.step_rpm,
        resolution_rpm=section.resolution_rpm,
        settings=settings(section.accuracy),
    )


def stiffness_request(section: MeshStiffness) -> StiffnessRequest:
    """Return what the stiffness stage is to compute, with the series written in the config.

    Parameters
    ----------
    section : MeshStiffness
        Section `mesh_stiffness` of the config.

    Returns
    -------
    StiffnessRequest
        Source, mean (N/m), torque (N m), definition of k, harmonics to keep, and the given series (N/m).
    """
    return StiffnessRequest(
        source=section.source,
        mean=section.mean,
        torque=section.torque_n_m,
        definition=section.definition,
        order=section.harmonics_kept,
        variation=section.variation,
        given_series=given_series(section),
        coast_series=coast_series(section),
    )
