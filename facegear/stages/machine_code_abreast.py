"""Machine code of machines side by side, compiled while a sweep still waits for its mesh stiffness."""

from facegear.dynamics.steady_state.prepare import prepare_abreast
from facegear.stages.outcome import Outcome


def machine_code_abreast() -> Outcome:
    """Nothing but the compiled code in the user's cache."""
    prepare_abreast()
    return Outcome({}, "machines side by side ready")
