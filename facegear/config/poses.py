"""Checks of a config whose meshes stand in the loaded position of their bodies."""

from facegear.config.changes import moves_pair
from facegear.config.search import Search
from facegear.config.stiffness import MeshStiffness
from facegear.config.tolerances import Tolerances
from facegear.config.tooth_pair import ToothPair
from facegear.config.transmission import Transmission
from facegear.errors import ConfigError
from facegear.load_sharing.quantity_names import is_contact_quantity

LINES = "flanks that touch along lines meet any pose with an edge"
STATIC = "where transmission.operating_pose is static"
OTHER_SURFACE = (
    f"a key of transmission, dynamics or lubrication {STATIC}: a pair that differs is another surface"
)
"""Requirement on keys that samples and designs may change beside an operating pose."""
REST = "the contact of samples and designs is that of the pair as assembled"


def check_poses(machine: Transmission, pair: ToothPair, stiffness: MeshStiffness) -> None:
    """Require a pair and a stiffness with a contact over pose, where the operating pose is asked for.

    Parameters
    ----------
    machine : Transmission
        Section `transmission` of the config.
    pair : ToothPair
        Section `tooth_pair` of the config.
    stiffness : MeshStiffness
        Section `mesh_stiffness` of the config.

    Raises
    ------
    ConfigError
        For given harmonics, or flanks that touch along lines.
    """
    if machine.operating_pose == "none":
        return
    if stiffness.source == "harmonics":
        requirement = "none where mesh_stiffness.source is harmonics: no contact says what a pose changes"
        raise ConfigError("transmission.operating_pose", machine.operating_pose, requirement)
    shaper, teeth = pair.shaper, pair.pinion_teeth
    if shaper is not None and shaper.teeth <= teeth:
        raise ConfigError("tooth_pair.shaper.teeth", shaper.teeth, f"more than {teeth} {STATIC}: {LINES}")


def check_posed_variants(machine: Transmission, tolerances: Tolerances | None, search: Search | None) -> None:
    """Require that one surface over pose describes the tooth pairs of all samples and designs.

    Parameters
    ----------
    machine : Transmission
        Section `transmission` of the config.
    tolerances : Tolerances or None
        Section `tolerances` of the config; None without it.
    search : Search or None
        Section `search` of the config; None without it.

    Raises
    ------
    ConfigError
        For keys of the tooth pair, or quantities of its contact, beside an operating pose.
    """
    if machine.operating_pose == "none":
        return
    for key in (key for cause in (tolerances.causes if tolerances else ()) for key in cause.moves):
        if moves_pair([key]):
            raise ConfigError("tolerances.causes.moves", key, OTHER_SURFACE)
    if tolerances is not None and tolerances.tooth_contact:
        raise ConfigError("tolerances.tooth_contact", True, f"false {STATIC}: {REST}")
    if search is None:
        return
    for key in (key for variable in search.variables for key in variable.sets):
        if moves_pair([key]):
            raise ConfigError("search.variables.sets", key, OTHER_SURFACE)
    for goal in (*search.objectives, *search.constraints):
        for text in filter(is_contact_quantity, goal.quantities):
            raise ConfigError(f"search: {goal.name}", text, f"a quantity of the machine {STATIC}: {REST}")
