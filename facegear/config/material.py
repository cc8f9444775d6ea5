"""The elastic constants of a body."""

from pydantic import Field

from facegear.config.base import Section


class MaterialSection(Section):
    """Linear elastic, isotropic."""

    young_modulus_gpa: float = Field(gt=0, le=2000, description="Young's modulus")
    poisson_ratio: float = Field(ge=0, le=0.49)
