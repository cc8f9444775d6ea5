"""Flank compliance of one body."""

from facegear.config.contact import Contact
from facegear.config.contact_setup import contact_setup
from facegear.config.mesh import Mesh
from facegear.config.tooth_pair import ToothPair
from facegear.contact.gear_flank import to_arrays
from facegear.contact.pair import gear_flank
from facegear.number_format import count_noun
from facegear.stages.outcome import Outcome


def compliance(body: str, tooth_pair: ToothPair, mesh: Mesh, contact: Contact) -> Outcome:
    """Compute the compliance of the flank of one body, whatever loads it.

    Parameters
    ----------
    body : str
        `pinion` or `face_gear`.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    mesh : Mesh
        Section `mesh` of the config.
    contact : Contact
        Section `contact` of the config.

    Returns
    -------
    Outcome
        `arrays` of the flank.

    Raises
    ------
    ConfigError
        For a sector with more teeth than the gear, and for a mesh turned inside out.
    """
    setup = contact_setup(tooth_pair, mesh, contact)
    flank = gear_flank(setup.pair.design, body, setup.sizes, setup.pair.material(body), setup.plan)
    teeth = count_noun(len(flank.compliance.neighbour_blocks), "tooth", "teeth")
    summary = f"{count_noun(len(flank.compliance.loaded_tooth), 'flank node')}, {teeth} coupled"
    return Outcome({"arrays": to_arrays(flank)}, summary)
