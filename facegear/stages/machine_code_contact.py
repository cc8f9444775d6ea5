"""Machine code of a contact, compiled while the compliances that it needs are computed."""

from facegear.contact.prepare import prepare
from facegear.stages.outcome import Outcome


def machine_code_contact() -> Outcome:
    """Nothing but the compiled code in the user's cache."""
    prepare()
    return Outcome({}, "contact ready")
