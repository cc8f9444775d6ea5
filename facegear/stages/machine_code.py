"""Machine code of the time integration, compiled before the jobs that need it start side by side."""

from facegear.dynamics.steady_state.prepare import prepare
from facegear.stages.outcome import Outcome


def machine_code(mesh_law: str) -> Outcome:
    """Nothing but the compiled code in the user's cache, for a mesh law of the config."""
    prepare(load_dependent=mesh_law == "load_dependent")
    return Outcome({}, "time integration ready")
