"""Root stress of both gears on their way through the mesh."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays
from facegear.config.contact import Contact
from facegear.config.contact_setup import ContactSetup, contact_setup
from facegear.config.mesh import Mesh
from facegear.config.tooth_pair import ToothPair
from facegear.contact.gear_flank import GearFlank, from_arrays
from facegear.errors import FacegearError
from facegear.geometry.bodies import BODIES, Body
from facegear.stages.outcome import Outcome
from facegear.strength.face_error import coarser_roots, face_error
from facegear.strength.passage import passing
from facegear.strength.root_stress import RootStress
from facegear.strength.root_tables import root_arrays, root_by_flank, root_tables


def root_stress(
    pinion: Arrays,
    face_gear: Arrays,
    loads: Arrays,
    tooth_pair: ToothPair,
    mesh: Mesh,
    contact: Contact,
) -> Outcome:
    """Compute the root stress of both gears on their way through the mesh.

    Tables `summary`, `passage` and `along_face` belong to the drive flank of the upper gear. The error of the
    planes along the face is measured with twice their distance; it is not known where such a mesh cannot be
    made or its contact not be solved.

    Parameters
    ----------
    pinion : Arrays
        Compliance of the pinion's flank, arrays of stage compliance.
    face_gear : Arrays
        Compliance of the face gear's flank, arrays of stage compliance.
    loads : Arrays
        Arrays `loads` of stage contact.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    mesh : Mesh
        Section `mesh` of the config.
    contact : Contact
        Section `contact` of the config.

    Returns
    -------
    Outcome
        Tables `summary`, `passage`, `along_face` and `by_flank`, arrays `stress`.

    Raises
    ------
    ConfigError
        Where the fillets carry no gauges.
    """
    flanks: dict[Body, GearFlank] = {"pinion": from_arrays(pinion), "face_gear": from_arrays(face_gear)}
    roots = {body: passing(body, flank, loads) for body, flank in flanks.items()}
    errors = _face_errors(contact_setup(tooth_pair, mesh, contact), roots)
    content = root_contents(flanks, loads, errors)
    return Outcome(content, _summary(content["by_flank"]))


def root_contents(
    flanks: Mapping[Body, GearFlank], loads: Arrays, face_errors: Mapping[Body, float]
) -> dict[str, Any]:
    """Return the parts of the stage.

    Parameters
    ----------
    flanks : Mapping[Body, GearFlank]
        Compliance of both bodies.
    loads : Arrays
        Arrays `loads` of stage contact.
    face_errors : Mapping[Body, float]
        Error of each body by its planes along the face, relative.

    Returns
    -------
    dict[str, Any]
        Tables `summary`, `passage`, `along_face` and `by_flank`, arrays `stress`.
    """
    numbers = loads["flank_variant"]
    variants: list[dict[str, RootStress]] = [
        {body: _passing(body, flank, loads, variant, face_errors[body]) for body, flank in flanks.items()}
        for variant in range(int(numbers.max()) + 1)
    ]
    positions: dict[str, Array] = {
        body: flank.gauges.position for body, flank in flanks.items() if flank.gauges
    }
    return {
        **root_tables(variants[0]),
        "by_flank": root_by_flank(variants, numbers),
        "stress": root_arrays(variants, numbers, positions),
    }


def _passing(body: Body, flank: GearFlank, loads: Arrays, variant: int, face_error: float) -> RootStress:
    root = passing(body, flank, loads, variant)
    return replace(root, error=root.error + face_error)


def _face_errors(setup: ContactSetup, roots: Mapping[Body, RootStress]) -> dict[Body, float]:
    """Relative errors of the planes along the face; nan where they are not known."""
    pair = setup.pair
    materials = {body: pair.material(body) for body in BODIES}
    try:
        coarser = coarser_roots(pair.design, materials, setup.sizes, setup.plan, roots)
    except FacegearError:
        return dict.fromkeys(BODIES, np.nan)
    return {body: face_error(roots[body], coarser[body]) for body in BODIES}


def _summary(table: pd.DataFrame) -> str:
    worst = table[table["torque_n_m"] == table["torque_n_m"].max()]
    peaks = worst.groupby("body", sort=False)["largest_mpa"].max()
    text = ", ".join(f"{body.replace('_', ' ')} {peak:.0f} MPa" for body, peak in peaks.items())
    return f"largest root stress at {worst['torque_n_m'].iloc[0]:g} N m: {text}"
