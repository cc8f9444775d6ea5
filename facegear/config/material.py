"""The elastic constants of a body."""

from pydantic import Field

from facegear.config.base import Section

SOFTEST_GPA = 1e-3
"""Smallest Young's modulus: the softest rubber has about as much."""


class MaterialSection(Section):
    """Elastic constants of a linear elastic, isotropic material."""

    young_modulus_gpa: float = Field(ge=SOFTEST_GPA, le=2000, description="Young's modulus")
    poisson_ratio: float = Field(ge=0, le=0.49, description="Poisson's ratio")
