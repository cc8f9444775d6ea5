"""Checks that the nodes of the contact surface resolve the contact strip, and that the problem fits into
memory.
"""

from dataclasses import replace
from math import ceil, inf, pi, sin, sqrt

from facegear.contact.hertz import contact_ellipse, contact_modulus
from facegear.contact.options import ContactPlan
from facegear.errors import InvalidInput
from facegear.quantities import BODIES
from facegear.teeth.curvature import smallest_radius
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.modifications import mean_crowning

COARSEST = 1.5
"""Node distance over the strip's half-width that is still let through: one or two nodes in contact."""
PLANES = 4.0
"""Planes of nodes in the half-length of a contact ellipse, with which its pressure errs by some 3 %."""
MAX_CUTS = 16
"""Largest number of cuts along the face of the elements under the flank."""
ROUNDING = 1e-9
"""Part of an element by which a number of elements may be off by rounding, dimensionless."""
DEEPEST = 2.0
"""Depth of the first row below a fillet over its smallest radius, with which root stress errs by some 6 %."""
ROUNDINGS = {"pinion": "rounding of the rack's tip", "face_gear": "rounding of the shaper's tip"}
"""Dimension of the tool that rounds the fillets of each gear."""
MEMORY_ERROR = 1.2
"""Largest factor between the estimate of memory and what was measured."""


def half_width(design: PairDesign, materials: tuple[Material, Material], torque: float) -> float:
    """Compute the Hertz half-width of two pairs that share a torque evenly along the face, at the pitch
    point.

    Line contact of a cylinder with the pinion's radius of curvature on the nearly flat gear flank: b =
    sqrt(4 q R / (pi E*)), q the force along the normal of either pair per length of generator.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    materials : tuple[Material, Material]
        Pinion and face gear.
    torque : float
        On the pinion, N m.

    Returns
    -------
    float
        Half-width, m.
    """
    face = design.face_gear.outer_radius - design.face_gear.inner_radius
    generator = min(face, design.pinion.width) / design.family.pinion_flanks[0].cosine
    line_load = torque / design.normal_arm / (2 * generator)
    softness = sum((1 - m.poisson_ratio**2) / m.young_modulus for m in materials)
    return sqrt(4 * line_load * _pitch_line_radius(design) * softness / pi)


def _pitch_line_radius(design: PairDesign) -> float:
    """Return the pinion's radius of curvature (m) across generators on its pitch cylinder."""
    flank = design.family.pinion_flanks[0]
    return flank.pitch_radius * sin(flank.pressure_angle) / flank.cosine


def flank_nodes(design: PairDesign, sizes: MeshSizes, plan: ContactPlan) -> float:
    """Compute the number of surface nodes of a flank: two an element in both directions.

    The profile's height is taken as the sum of both addenda, the width as that of the face gear.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    sizes : MeshSizes
        Element sizes before refinement.
    plan : ContactPlan
        Refinement of the elements.

    Returns
    -------
    float
        Number of nodes, not rounded.
    """
    height = design.face_gear.addendum + design.pinion.addendum
    across = 2 * plan.refinement.profile * height / sizes.profile + 1
    along = 2 * plan.refinement.width * _elements_along(design, sizes) + 1
    return across * along


def estimated_memory(design: PairDesign, sizes: MeshSizes, plan: ContactPlan) -> float:
    """Estimate the memory of a process for mesh, elimination and compliance of the larger body, the face
    gear.

    It grows with the square of the dof on the gear's flank, its two cut faces and the largest cut through
    it. The numbers are fitted to measurements on six meshes, two of them of wide faces or medium size
    (docs/explanation/contact.md), and reproduce them within a fifth; finer meshes are extrapolated. The
    estimate never falls below the memory of the flanks' dense compliance, which is certain.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    sizes : MeshSizes
        Element sizes.
    plan : ContactPlan
        Refinement of the elements.

    Returns
    -------
    float
        Memory, bytes.
    """
    nodes, planes = flank_nodes(design, sizes, plan), 2.0 * _elements_along(design, sizes) + 1.0
    dof = 1.75 * nodes + 11.3 * planes * (design.face_gear.rim_thickness / sizes.thickness + 5.3)
    return max(1.6e8 + 19.0 * dof**2, 8.0 * nodes**2)


def check_memory(design: PairDesign, sizes: MeshSizes, plan: ContactPlan, available: float) -> None:
    """Refuse a mesh that cannot fit into the memory even if the estimate is a fifth too high.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    sizes : MeshSizes
        Element sizes.
    plan : ContactPlan
        Refinement of the elements.
    available : float
        Memory, bytes.

    Raises
    ------
    InvalidInput
        Where the mesh does not fit.
    """
    memory = estimated_memory(design, sizes, plan)
    if memory > MEMORY_ERROR * available:
        sizes_text = (
            f"{1e3 * sizes.profile:.3g} mm across the profile, {1e3 * sizes.width:.3g} mm along the face"
        )
        requirement = (
            f"coarser: an estimate of the memory for factorisation and compliance is {memory / 1e9:.3g} GB, "
            f"and this machine has {available / 1e9:.3g} GB"
        )
        raise InvalidInput("element size", sizes_text, requirement)


def _elements_along(design: PairDesign, sizes: MeshSizes) -> float:
    """Return the number of unrefined elements along the face gear's width, not rounded."""
    return (design.face_gear.outer_radius - design.face_gear.inner_radius) / sizes.width


def node_spacing(sizes: MeshSizes, plan: ContactPlan) -> float:
    """Compute the distance of the contact surface's nodes across the profile: half a refined element.

    Parameters
    ----------
    sizes : MeshSizes
        Element sizes before refinement.
    plan : ContactPlan
        Refinement of the elements.

    Returns
    -------
    float
        Distance, m.
    """
    return sizes.profile / plan.refinement.profile / 2


def resolves(spacing: float, design: PairDesign, materials: tuple[Material, Material], torque: float) -> bool:
    """Whether nodes resolve the contact strip at a torque.

    Parameters
    ----------
    spacing : float
        Distance of the nodes, m.
    design : PairDesign
        Pair of gears.
    materials : tuple[Material, Material]
        Pinion and face gear.
    torque : float
        On the pinion, N m.

    Returns
    -------
    bool
        True if the distance is at most COARSEST times the half-width.
    """
    return spacing <= COARSEST * half_width(design, materials, torque)


def ellipse_half_length(design: PairDesign, materials: tuple[Material, Material], torque: float) -> float:
    """Compute the half-length along the face of a crowned pair's contact ellipse.

    Two pairs share the torque evenly; each touches the nearly flat gear flank at the pitch point. Lead
    crowning may be a modification of either gear or part of its deviations.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    materials : tuple[Material, Material]
        Pinion and face gear.
    torque : float
        On the pinion, N m.

    Returns
    -------
    float
        Half-length, m; inf without lead crowning of either gear.
    """
    lead_crownings = (design.pinion.lead_crowning, design.face_gear.modifications.lead_crowning)
    crownings = [crowning for crowning in lead_crownings if crowning.amount > 0.0 and crowning.length > 0.0]
    plain = min((crowning.start for crowning in crownings), default=0.0)
    deviation_curvature = max(
        mean_crowning(pair.pinion.flanks.right) + mean_crowning(pair.face_gear.flanks.left)
        for pair in (design, design.with_swapped_flanks)
    )
    if not crownings and deviation_curvature == 0.0:
        return inf
    along = sum(2.0 * crowning.amount / crowning.length**2 for crowning in crownings) + deviation_curvature
    across = 1.0 / _pitch_line_radius(design)
    force = torque / design.normal_arm / 2.0
    return plain + contact_ellipse(force, across, along, contact_modulus(materials)).long


def along_the_ellipse(
    design: PairDesign, materials: tuple[Material, Material], sizes: MeshSizes, plan: ContactPlan
) -> ContactPlan:
    """Return the plan with as many cuts along the face as the contact ellipse of a crowned pair requires.

    At the smallest torque the ellipse's half-length holds PLANES planes of nodes.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    materials : tuple[Material, Material]
        Pinion and face gear.
    sizes : MeshSizes
        Element sizes.
    plan : ContactPlan
        Torques and refinement.

    Returns
    -------
    ContactPlan
        Plan with a refinement along the face that is never coarser.

    Raises
    ------
    InvalidInput
        Where more than MAX_CUTS cuts are needed.
    """
    torque = min(plan.torques)
    half = ellipse_half_length(design, materials, torque)
    cuts = max(plan.refinement.width, ceil(PLANES * sizes.width / 2.0 / half - ROUNDING))
    if cuts > MAX_CUTS:
        largest_size_mm = 2e3 * MAX_CUTS * half / PLANES
        raise InvalidInput(
            "element size",
            f"{1e3 * sizes.width:.3g} mm along the face",
            f"at most {largest_size_mm:.3g} mm: at {torque:g} N m the crowned pair's contact ellipse is "
            f"{2e3 * half:.3g} mm long",
        )
    return replace(plan, refinement=replace(plan.refinement, width=cuts))


def check_resolution(
    design: PairDesign, materials: tuple[Material, Material], sizes: MeshSizes, plan: ContactPlan
) -> None:
    """Refuse a mesh whose nodes are too far apart for the contact strip at the smallest torque of the plan.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    materials : tuple[Material, Material]
        Pinion and face gear.
    sizes : MeshSizes
        Element sizes.
    plan : ContactPlan
        Torques and refinement.

    Raises
    ------
    InvalidInput
        Where the nodes do not resolve the strip.
    """
    spacing, torque = node_spacing(sizes, plan), min(plan.torques)
    strip = half_width(design, materials, torque)
    if not resolves(spacing, design, materials, torque):
        largest = 2e3 * COARSEST * strip * plan.refinement.profile
        enough = torque * (spacing / (COARSEST * strip)) ** 2
        raise InvalidInput(
            "element size",
            f"{1e3 * sizes.profile:.3g} mm across the profile",
            f"at most {largest:.3g} mm with `profile refinement` = {plan.refinement.profile}, or "
            f"`torques of the contact analysis` at least {enough:.4g}: "
            f"it is too coarse for contact at {torque:g} N m",
        )


def check_fillet(design: PairDesign, sizes: MeshSizes, plan: ContactPlan) -> None:
    """Refuse a mesh whose elements are too large for the sharpest fillet, if its stress is computed.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    sizes : MeshSizes
        Element sizes.
    plan : ContactPlan
        Whether root stress is computed.

    Raises
    ------
    InvalidInput
        Where the elements are too large.
    """
    radii = {body: smallest_radius(design, body) for body in BODIES}
    sharpest = min(radii, key=lambda body: radii[body])
    radius = radii[sharpest]
    depth = sizes.fillet_depth or sizes.profile
    if plan.root_stress and depth > DEEPEST * radius:
        requirement = (
            f"at most {1e3 * DEEPEST * radius:.3g} mm (`element depth below the fillets`), {DEEPEST:g} times "
            "the smallest radius of the fillets: "
            f"it is too coarse to resolve their stress; a larger `{ROUNDINGS[sharpest]}` rounds them"
        )
        raise InvalidInput("element size", f"{1e3 * depth:.3g} mm below the fillets", requirement)
