"""What a config may ask for where meshes stand as the machine's own forces put them."""

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
ANOTHER = f"a key of transmission, dynamics or lubrication {STATIC}: a pair that differs is another surface"
REST = "the contact of samples and designs is that of the pair as assembled"


def check_poses(machine: Transmission, pair: ToothPair, stiffness: MeshStiffness) -> None:
    """Raise ConfigError for a pair or a stiffness that have no contact over pose, where it is asked for."""
    if machine.operating_pose == "none":
        return
    if stiffness.source == "harmonics":
        allowed = "none where mesh_stiffness.source is harmonics: no contact says what a pose changes"
        raise ConfigError("transmission.operating_pose", machine.operating_pose, allowed)
    shaper, teeth = pair.shaper, pair.pinion_teeth
    if shaper is not None and shaper.teeth <= teeth:
        raise ConfigError("tooth_pair.shaper.teeth", shaper.teeth, f"more than {teeth} {STATIC}: {LINES}")


def check_posed_variants(machine: Transmission, tolerances: Tolerances | None, search: Search | None) -> None:
    """Raise ConfigError for samples and designs whose tooth pairs one surface over pose does not describe."""
    if machine.operating_pose == "none":
        return
    for key in (key for cause in (tolerances.causes if tolerances else ()) for key in cause.moves):
        if moves_pair([key]):
            raise ConfigError("tolerances.causes.moves", key, ANOTHER)
    if tolerances is not None and tolerances.tooth_contact:
        raise ConfigError("tolerances.tooth_contact", True, f"false {STATIC}: {REST}")
    if search is None:
        return
    for key in (key for variable in search.variables for key in variable.sets):
        if moves_pair([key]):
            raise ConfigError("search.variables.sets", key, ANOTHER)
    for goal in (*search.objectives, *search.constraints):
        for text in filter(is_contact_quantity, goal.quantities):
            raise ConfigError(f"search: {goal.name}", text, f"a quantity of the machine {STATIC}: {REST}")
