"""Config section `transmission.excitations`: periodic torques on bodies."""

from pydantic import Field

from facegear.config.base import Section


class ExcitationSection(Section):
    """A periodic torque beside the mean torque of a body, where that acts: a propeller or an engine."""

    body: str = Field(min_length=1, max_length=40, description="a pinion's name, or lower or upper")
    order: float = Field(
        gt=0, le=1e5, description="vibrations in one turn of the body; in motion a multiple of its teeth"
    )
    torque_n_m: float = Field(gt=0, le=1e7, description="amplitude; a duty cycle does not scale it")
    phase_deg: float = Field(0.0, ge=-360, le=360, description="of the cosine, at the start")
