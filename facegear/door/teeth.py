"""Answers about the tooth pair: geometry, flanks, loaded contact, stiffness."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from facegear.door.case import Case, drop_none
from facegear.errors import ConfigError, FacegearError, extras_named
from facegear.pipeline.outcome import Outcome
from facegear.pipeline.results.contact import ContactResult, MeshLawResult, StiffnessResult
from facegear.pipeline.results.teeth import GeometryResult, ToothErrorsResult, TopographyResult
from facegear.quantities import BODIES

if TYPE_CHECKING:
    from facegear.pipeline.displaced_contact import DisplacedContact


def geometry(self: Case) -> "GeometryResult":
    """Compute limits, contact path, backlash and smallest gaps of the unloaded pair.

    Returns
    -------
    GeometryResult
        The geometry. Raises ConfigError for a pair without bodies.

    Examples
    --------
    >>> import facegear
    >>> facegear.example().geometry().summary.split(",")[0]
    'contact ratio 1.548'
    """
    return self._chain.result(GeometryResult)


def topography(self: Case) -> "TopographyResult":
    """Return nominal points and normals of all flanks, with the mean deviation of all teeth.

    Returns
    -------
    TopographyResult
        The points of both flanks of both gears, mm, with deviations in um.

    Examples
    --------
    >>> import facegear
    >>> facegear.example().topography().table()["deviation_um"].abs().max().item()
    0.0
    """
    return self._chain.result(TopographyResult)


def contact(
    self: Case, torques: float | Iterable[float] | None = None, positions: int | None = None
) -> "ContactResult":
    """Solve the loaded tooth contact at every position of a pitch and every torque.

    Parameters
    ----------
    torques : float | Iterable[float] | None
        Torques on the pinion for one mesh, N m, one or several, rising; None for those of the config.
    positions : int or None
        Number of positions in a pitch; None for that of the config.

    Returns
    -------
    ContactResult
        Transmission error, stiffness, load shares and pressures. Raises ConfigErrors for values that
        the config would refuse, NotConverged naming position and torque.

    Examples
    --------
    >>> import facegear
    >>> table = facegear.example().contact(torques=[600]).table()
    >>> float(table["kkt_residual"].max()) < 1e-12
    True
    """
    changes = {**self._torques(torques), **drop_none({"contact.positions_per_pitch": positions})}
    return self._with_changes("contact", changes)._chain.result(ContactResult)


def displaced_contact(
    self: Case,
    pinion: Mapping[str, float] | None = None,
    face_gear: Mapping[str, float] | None = None,
    mesh: str | None = None,
    position: float = 0.5,
) -> "DisplacedContact":
    """Compute contact and closing of both flanks of a mesh whose two bodies are displaced by given
    amounts.

    Parameters
    ----------
    pinion : Mapping[str, float] | None
        Any of x_um, y_um, z_um, tilt_x_deg, tilt_y_deg and theta_deg; 0 unless given. x along the tangent
        as the upper gear's teeth move, z outwards along the pinion, y square to both, with axes at a right
        angle along the gears' axis towards the upper gear; tilts about the middle of its face, theta as it
        drives.
    face_gear : Mapping[str, float] | None
        The same keys (um, deg) for the gear: x towards azimuth 0, y a quarter turn further, z from the
        lower to the upper gear; tilts about the point of its axis that `tilt` or `hub_tilt` says, or in
        the pitch plane; theta as it is driven.
    mesh : str or None
        `pinion/gear`, as `right idler/upper`; the first one unless given, and none for a pair without a
        transmission, which counts as that of an upper gear at azimuth 0.
    position : float
        Place within a pitch, fraction from 0 to 1, for flanks whose contact changes with it.

    Returns
    -------
    DisplacedContact
        The contact. Raises ConfigError for a pair without bodies, a displacement beyond 5 mm or 2 degrees
        or that is no number, NotConverged where flanks do not face each other.

    Examples
    --------
    >>> import facegear
    >>> moved = {"x_um": 100, "y_um": -20}
    >>> found = facegear.example().displaced_contact(pinion=moved, mesh="right input/upper")
    >>> found.table().set_index("flank")["approach_um"].round(1).to_dict()
    {'drive': 82.9, 'back': -99.0}
    """
    with extras_named():
        from facegear.pipeline.displaced_contact import (  # finite elements, an extra
            DisplacedContact,
            displaced_contact,
            loaded_displaced_contact,
        )

    for body, displacement in {"pinion": pinion, "face_gear": face_gear}.items():
        if displacement is not None and not isinstance(displacement, Mapping):
            raise FacegearError(f"{body} = {displacement!r}: must be a mapping such as {{'x_um': 10}}")
    config, displacements = self.config, (dict(pinion or {}), dict(face_gear or {}))
    flanks = displaced_contact(config.tooth_pair, config.transmission, mesh, *displacements, position)

    def solve(torques: float | Iterable[float] | None) -> "Outcome":
        """Solve the contact of the displaced flanks at torques (N m on the pinion); None for those of
        the config.
        """
        gearbox = self._with_changes("displaced_contact", self._torques(torques))
        parts = [gearbox._chain.part("compliance", "arrays", {"body": body}) for body in BODIES]
        contact = gearbox.config.contact_used
        return loaded_displaced_contact(
            flanks, config.tooth_pair, contact, (parts[0], parts[1]), contact.torques_n_m
        )

    return DisplacedContact(flanks, solve)


def tooth_errors(self: Case) -> "ToothErrorsResult":
    """Compute what teeth that deviate from the others of their gear add to the transmission error.

    Returns
    -------
    ToothErrorsResult
        Amplitudes at orders of each gear's turn. Raises ConfigError where `tooth_pair` has no grids of
        single teeth.
    """
    pair = self.config.tooth_pair
    flanks = [body.flanks for body in (pair.pinion, pair.face_gear) if body is not None]
    if flanks and all(grid.tooth is None for flank in flanks for grid in flank.grids):
        requirement = "given for single teeth of pinion or face_gear: all are alike"
        raise ConfigError("tooth_pair.pinion.flanks.grids", [], requirement)
    return self._chain.result(ToothErrorsResult)


def stiffness(self: Case) -> "StiffnessResult":
    """Compute the mesh stiffness k(t) of one mesh at the config's load, or from harmonics that the
    config gives.

    Returns
    -------
    StiffnessResult
        Fourier series of k in N/m, and its curve. Raises ConfigError for a load outside those of the
        contact analysis.

    Examples
    --------
    >>> import facegear
    >>> facegear.example().stiffness().table()["cos_n_per_m"].round(-3).to_list()[0]
    410000000.0
    """
    return self._chain.result(StiffnessResult)


def mesh_law(self: Case) -> "MeshLawResult":
    """Compute the forces of the flanks over phase and deflection, which `mesh_law: load_dependent`
    uses.

    Returns
    -------
    MeshLawResult
        Fourier series of force and slope at levels of deflection. Raises ConfigError for a pair without
        bodies, and what `contact` raises.
    """
    return self._chain.result(MeshLawResult)
