"""Machine code of the time integration, compiled before the jobs that need it start side by side."""

from facegear.dynamics.steady_state.prepare import prepare
from facegear.stages.outcome import Outcome


def machine_code() -> Outcome:
    """Nothing but the compiled code in the user's cache."""
    prepare()
    return Outcome({}, "time integration ready")
