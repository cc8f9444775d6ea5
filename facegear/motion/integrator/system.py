"""Equations of motion for the integrator (`facegear/_kernels/src/motion`): unit masses coupled by meshes.

    y'' + damping y' + omega_squared y + coupling + G^T F = load(t),   F = law(s, x) + c d',   d = G y - e(t),

x = d - upper above `upper`, d - lower below `lower`, zero between (Kahraman and Singh 1990). e and load are
Fourier series in the mesh phase s = 2 pi t / T, the law is any of facegear.meshing. Bearings with clearance
are rings (rings.hpp). Friction adds forces in directions of its own, which are Fourier series times the law's
forces (friction.hpp). One degree of freedom is a case like any other.
"""

from dataclasses import dataclass, field

import numpy as np

from facegear.arrays import Array, Integers
from facegear.by_content import kept_by_content
from facegear.harmonics import Harmonics
from facegear.machine.disturbances import MeshFriction, friction_rows
from facegear.machine.flank_errors import flank_lags
from facegear.machine.flanks import mesh_contacts
from facegear.machine.machine import Machine, OpenFlanks
from facegear.meshing.law import MeshLaw
from facegear.meshing.linear import different
from facegear.meshing.moving_law import MovingLaw, moving_law
from facegear.motion.integrator.reduction import Coupling, Reduction

RING_ROWS = 3
"""Rows of a bearing with clearance: x and y of the body, and one of zeros."""
NO_ERROR = Harmonics(np.zeros(1), np.zeros(1))
"""Fourier series of an error that is zero."""


@dataclass(frozen=True, eq=False)
class System:
    """n coordinates and m meshes; Fourier series are (rows, 2, harmonics + 1), sine part first.

    The last 3 R of the m rows belong to the rings: x, y of the body, and a row of zeros.

    Attributes
    ----------
    mesh_jacobian : (m, n)
        Matrix G: deflections d = G y - e; d above `upper` presses a contact in, d below `lower` on its
        back side.
    omega_squared, damping : (n,)
        Stiffness (squared bearing frequency, 1/s2) and damping (1/s) of each coordinate, for unit mass.
    mesh_damping, lower, upper : (m,)
        Damping c, N s/m, and deflections at which contact begins below and above, m. A mesh with lower >=
        upper never opens.
    law
        Force law of the contacts, without the rings: force in N from phase in mesh periods and
        compression in m.
    error
        Fourier series (kinds, 2, harmonics + 1) of the different errors e(s) among the rows, m.
    error_kind : (m,)
        Index in `error` of the series of each row.
    load : (n, 2, harmonics + 1)
        Fourier series of the generalised load on each coordinate.
    damping_when_open
        Whether mesh dampers act on open meshes too.
    scale
        Length, m, of which tolerances, residuals and distances of states are fractions: the length scale.
    two_flanks
        The m are one-sided flanks, all drive flanks, then the back flanks of the same meshes.
    push_only
        Spring and damper of a contact together never pull, F >= 0, damping acts in contact only.
    ring_stiffness, ring_clearance : (R,)
        Stiffness beyond the clearance, N/m, and radial clearance, m, of the R bearings with clearance.
    ring_lag
        Damping over stiffness of the rings, s.
    rubbing
        Friction of the flanks, or none.
    coupling
        Forces that couple coordinates beside the meshes, for a mesh frequency of 1 rad/s, or None; the
        diagonal of its dampers is in `damping` and not in them.
    phase_shifts : (contacts, n) array or None
        Matrix that turns coordinates into the places of the contacts in the mesh cycle beside the even
        rotation, rad, where `law` is a `MovingLaw`; else None.
    """

    mesh_jacobian: Array
    omega_squared: Array
    damping: Array
    mesh_damping: Array
    lower: Array
    upper: Array
    law: MeshLaw
    error: Array
    error_kind: Integers
    load: Array
    damping_when_open: bool
    scale: float
    two_flanks: bool = False
    push_only: bool = False
    ring_stiffness: Array = field(default_factory=lambda: np.zeros(0))
    ring_clearance: Array = field(default_factory=lambda: np.zeros(0))
    ring_lag: float = 0.0
    rubbing: "FlankRubbing | None" = None
    coupling: Coupling | None = None
    phase_shifts: Array | None = None

    @property
    def size(self) -> int:
        """Number of coordinates n."""
        return self.omega_squared.size

    @property
    def contacts(self) -> int:
        """Number of the m rows that are contacts: meshes or flanks, without the three rows of each
        bearing with clearance.
        """
        return len(self.mesh_jacobian) - 3 * self.ring_stiffness.size

    def contact_forces(self, cycles: Array, beyond: Array, phase_shifts: Array | None = None) -> Array:
        """Return the elastic forces of the contacts.

        Parameters
        ----------
        cycles : (K,) array
            Mesh periods since the start.
        beyond : (..., K, contacts) array
            Compression of the contacts, m.
        phase_shifts : (..., K, contacts) array or None
            Their places in the mesh cycle beside the even rotation, rad, where the system has `phase_shifts`.

        Returns
        -------
        (..., K, contacts) array
            N.
        """
        if isinstance(self.law, MovingLaw) and phase_shifts is not None:
            return self.law.energy(cycles, beyond, phase_shifts, (1, 0))
        return self.law.force(cycles, beyond)

    @property
    def pairs(self) -> int:
        """Number of meshes if each has two flanks, a pair of contacts; 0 if a mesh is one contact."""
        return self.contacts // 2 if self.two_flanks else 0


@dataclass(frozen=True, eq=False)
class FlankRubbing:
    """Forces of friction: each of K adds `ratio` times the law's force of a flank along a direction.

    `flank` (K,) is the index of the flank whose force counts. `ratios` (K, 2, harmonics + 1) are Fourier
    series in the mesh phase, sine part first. `directions` (K, n) are generalised forces on y for a unit
    friction force.
    """

    flank: Integers
    ratios: Array
    directions: Array


def machine_system(machine: Machine, reduction: Reduction) -> System:
    """Make the equations of motion of a machine in its reduced coordinates, without runouts and pitch
    deviations.

    Parameters
    ----------
    machine : Machine
        The machine.
    reduction : Reduction
        Its reduced coordinates.

    Returns
    -------
    System
        Equations of motion.
    """
    contacts, rings = mesh_contacts(machine), machine.linear.rings
    law, phase_shifts = contacts.law, None
    if machine.has_phase_shifts:
        law = moving_law(law, len(reduction.mesh_jacobian))
        phase_shifts = machine.phase_rows @ reduction.basis
    zeros = 3 * rings.body.size * [0.0]
    error, error_kind = _kinds((*contacts.error, *len(zeros) * [NO_ERROR]))
    load = np.zeros((reduction.omega_squared.size, 2, 1))
    load[:, 1, 0] = reduction.load
    return System(
        mesh_jacobian=reduction.mesh_jacobian,
        omega_squared=reduction.omega_squared,
        damping=reduction.damping,
        mesh_damping=np.append(contacts.damping, zeros),
        lower=np.append(contacts.lower, np.tile([0.0, 0.0, -np.inf], rings.body.size)),
        upper=np.append(contacts.upper, zeros),
        law=law,
        error=error,
        error_kind=error_kind,
        load=load,
        damping_when_open=machine.damping.open_flanks.is_damped_when_open,
        scale=length_scale(machine),
        two_flanks=machine.layout.kinematics.flanks_apart,
        push_only=machine.damping.open_flanks is OpenFlanks.PUSH_ONLY,
        ring_stiffness=rings.stiffness,
        ring_clearance=rings.clearance,
        ring_lag=machine.linear.bearing_damping,
        coupling=reduction.coupling and reduction.coupling.per_speed(machine.layout.pinion_teeth),
        rubbing=None if machine.friction is None else _rubbing(machine, machine.friction, reduction),
        phase_shifts=phase_shifts,
    )


@kept_by_content(8)
def _kinds(series: tuple[Harmonics, ...]) -> tuple[Array, Integers]:
    """Return the different series of e(t) among contacts and rings, stacked, and the index of the series
    of each, (m,).

    The result is shared and must not be changed.
    """
    return different(series)


def _rubbing(machine: Machine, friction: MeshFriction, reduction: Reduction) -> FlankRubbing:
    """Return the friction of all flanks, drive flanks first, in reduced coordinates, without directions
    of zeros.
    """
    rows = np.tile(friction_rows(machine.layout, machine.linear, machine.drive_line), (2, 1, 1))
    flank, part = np.nonzero(rows.any(axis=2))
    ratios = friction.flank_ratios(flank_lags(machine, machine.phases))
    return FlankRubbing(flank, ratios[flank, part], rows[flank, part] @ reduction.basis)


def length_scale(machine: Machine) -> float:
    """Return the largest of three lengths, to which tolerances and residuals refer.

    They are the mean mesh deflection under the largest pinion torque, the largest half backlash, and the
    sum of the amplitudes of the error's harmonics.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    float
        Length that tolerances refer to, m.
    """
    layout = machine.layout
    forces = np.abs(machine.torques[: len(layout.pinions)]) / layout.pinion_arm
    mean_deflection = float(forces.max()) / machine.stiffness.mean
    return max(
        mean_deflection, float(machine.half_backlash.max()), float(machine.error.amplitudes[1:].sum()), 1e-12
    )
