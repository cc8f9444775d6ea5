"""Config section `body` of a face gear: hub, web and rim that bend, or any section, and its material."""

from math import pi
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from facegear.number_format import count_noun
from facegear.schema.base import Section, refuse, require_all
from facegear.schema.csv_file import CsvFault, read_numbers

SOFTEST_GPA = 1e-3
"""Smallest Young's modulus: the softest rubber has about as much."""


class MaterialSection(Section):
    """Elastic constants of a linear elastic, isotropic material."""

    young_modulus_gpa: float = Field(ge=SOFTEST_GPA, le=2000, description="Young's modulus")
    poisson_ratio: float = Field(ge=0, le=0.49, description="Poisson's ratio")


COLUMNS = ("r_mm", "height_mm")
"""Columns of a csv of corners: distance from the axis and height."""
MAX_CORNERS = 200
"""Largest number of corners of a section."""
Corner = Annotated[float, Field(ge=-1e5, le=1e5)]
DAMPING_RATIO = 0.002
"""Damping ratio of a body's modes without a value: that of solid steel without joints."""
LARGEST_DAMPING_RATIO = 0.5
"""Largest damping ratio of a mode."""


class HubSection(Section):
    """Rectangle round the bore; heights as those of the whole section."""

    bore_radius_mm: float = Field(ge=1e-3, le=1e4, description="of the bore, which the shaft holds")
    outer_radius_mm: float = Field(ge=1e-3, le=1e4, description="at which the web begins")
    back_mm: float = Field(ge=-1e4, le=1e4, description="height of its face away from the teeth")
    front_mm: float = Field(ge=-1e4, le=1e4, description="height of its face on the side of the teeth")


class WebSection(Section):
    """Straight web between hub and rim, flat or conical; thicknesses along the axis."""

    hub_thickness_mm: float = Field(ge=1e-3, le=1e4, description="where the web meets the hub")
    rim_thickness_mm: float = Field(ge=1e-3, le=1e4, description="where the web meets the rim")
    offset_mm: float = Field(0.0, ge=-1e4, le=1e4, description="height of its middle plane at the rim")
    cone_angle_deg: float = Field(
        0.0, ge=-80, le=80, description="by which its middle plane rises outwards; 0: a flat web"
    )


class RimSection(Section):
    """Rectangle below the teeth, up to their root land."""

    inner_radius_mm: float | None = Field(None, ge=1e-3, le=1e4, description="null: that of the teeth")
    outer_radius_mm: float | None = Field(None, ge=1e-3, le=1e4, description="null: that of the teeth")
    back_mm: float = Field(ge=-1e4, le=0, description="height of its face away from the teeth")


class BodySection(Section):
    """Cross-section of a face gear of distances from the axis and heights, counted along the axis towards the
    teeth from the plane on which the contact analysis clamps them: hub, web and rim; a rim alone (disc,
    ring); or any polygon.
    """

    hub: HubSection | None = None
    web: WebSection | None = None
    rim: RimSection | None = None
    corners_mm: tuple[tuple[Corner, Corner], ...] = Field(
        (),
        max_length=MAX_CORNERS,
        description="instead of hub, web and rim: distance and height of every corner",
    )
    corners_csv: str | None = Field(None, description="the corners as a csv file, columns r_mm and height_mm")
    step: str | None = Field(
        None,
        description="the corners as a STEP file: a solid of revolution about its z axis, or its half section "
        "in any half plane through that axis; z is the height",
    )
    held_edges: tuple[Annotated[int, Field(ge=1, le=MAX_CORNERS)], ...] = Field(
        (),
        description="edges of corners_mm that the shaft holds, 1 from the first corner on; []: the bore",
    )
    material: MaterialSection | None = Field(None, description="null: that of the face gear's teeth")
    density_kg_per_m3: float = Field(7850.0, ge=500, le=25000, description="density of the body")
    teeth: Literal[True, False, "fitted"] = Field(
        True,
        description="whether the teeth's mass and stiffness belong to the body, as a layer of common teeth; "
        "fitted: as one fitted to a sector of the own teeth",
    )
    max_frequency_hz: float = Field(
        10000.0, ge=1, le=1e6, description="modes up to it are kept; what the others give counts as static"
    )
    nodal_diameters: int = Field(12, ge=0, le=40, description="largest number of which modes are kept")
    damping_ratio: float | None = Field(
        None,
        ge=0,
        le=LARGEST_DAMPING_RATIO,
        description=f"of every mode, in the steel that turns; null: {DAMPING_RATIO}, or none beside "
        "stiffness_damping_s",
    )
    stiffness_damping_s: float | None = Field(
        None,
        ge=0,
        le=1,
        description="in place of damping_ratio: beta of a damping beta K in proportion to the stiffness of "
        "the steel that turns; a mode of f Hz then has the damping ratio pi f beta",
    )
    contact_width_pitches: float = Field(
        4.0, ge=0.01, le=40, description="width of the raised cosine by which a mesh loads the rim; 4 fits"
    )

    @model_validator(mode="before")
    @classmethod
    def _from_file(cls, values: Any) -> Any:
        """Replace the file `corners_csv` or `step` by the corners read from it, mm, and lists by tuples."""
        if not isinstance(values, dict):
            return values
        if isinstance(values.get("corners_mm"), list):
            corners = values["corners_mm"]
            corner_pairs = tuple(tuple(corner) if isinstance(corner, list) else corner for corner in corners)
            values = {**values, "corners_mm": corner_pairs}
        if isinstance(values.get("held_edges"), list):
            values = {**values, "held_edges": tuple(values["held_edges"])}
        corner_keys = [key for key in ("corners_mm", "corners_csv", "step") if values.get(key)]
        if len(corner_keys) > 1 and all(isinstance(values[key], str) for key in corner_keys[1:]):
            refuse(corner_keys[1], values[corner_keys[1]], f"left out beside {corner_keys[0]}")
        if isinstance(name := values.get("corners_csv"), str):
            return {**values, "corners_csv": None, "corners_mm": _csv_corners(name)}
        if isinstance(name := values.get("step"), str):
            return {**values, "step": None, "corners_mm": _step_corners(name)}
        return values

    @model_validator(mode="after")
    def _complete(self) -> "BodySection":
        """Check parts, edges and damping; all mistakes are reported together."""
        require_all(self._check_parts, self._check_edges, self._check_damping)
        return self

    @property
    def damping(self) -> tuple[float, float]:
        """Damping ratio of every mode, and factor beta (s) of the stiffness in the damping; one of both
        is 0.
        """
        if self.stiffness_damping_s is not None:
            return 0.0, self.stiffness_damping_s
        return DAMPING_RATIO if self.damping_ratio is None else self.damping_ratio, 0.0

    def _check_parts(self) -> None:
        """Refuse a section given both by parts and by corners, or by neither."""
        if self.corners_mm:
            for name in ("hub", "web", "rim"):
                if getattr(self, name) is not None:
                    refuse(name, "given", "left out beside corners_mm")
            return
        if self.rim is None:
            refuse("rim", None, "given, or corners_mm")
        if (self.hub is None) != (self.web is None):
            absent_part = "hub" if self.hub is None else "web"
            refuse(absent_part, None, "given: hub and web go together; a rim alone is a disc or ring")

    def _check_damping(self) -> None:
        """Refuse damping given twice or too large."""
        beta = self.stiffness_damping_s
        if beta is None:
            return
        if self.damping_ratio is not None:
            requirement = f"left out where damping_ratio = {self.damping_ratio:g} is given"
            refuse("stiffness_damping_s", beta, requirement)
        largest = LARGEST_DAMPING_RATIO / (pi * self.max_frequency_hz)
        if beta > largest:
            reason = f"a mode of max_frequency_hz then has {LARGEST_DAMPING_RATIO:g} of the critical damping"
            requirement = f"at most {largest:.3g}: {reason}"
            refuse("stiffness_damping_s", beta, requirement)

    def _check_edges(self) -> None:
        """Refuse held edges that the section does not have."""
        if self.held_edges and not self.corners_mm:
            refuse("held_edges", list(self.held_edges), "left out where hub, web and rim are given")
        wrong = [edge for edge in self.held_edges if not 1 <= edge <= len(self.corners_mm)]
        if wrong:
            refuse("held_edges", wrong[0], f"from 1 to {len(self.corners_mm)}, the number of corners")


def _csv_corners(name: str) -> tuple[tuple[float, ...], ...]:
    """Read the corners of a section from a csv file: distance from the axis and height, mm."""
    try:
        rows = read_numbers(name, COLUMNS)
    except CsvFault as fault:
        refuse("corners_csv", name, f"a csv of numbers; {fault}")
    return tuple(tuple(row.values[column] for column in COLUMNS) for row in rows)


def _step_corners(name: str) -> tuple[tuple[float, float], ...]:
    """Read the corners of a section from a STEP file: distance from the axis and height, mm."""
    from facegear.io.step_section import StepFault, read_section  # loads gmsh

    requirement = "a STEP file of one solid of revolution, or of its half section"
    try:
        corners = read_section(name)
    except StepFault as fault:
        refuse("step", name, f"{requirement}; {fault}")
    if len(corners) > MAX_CORNERS:
        refuse(
            "step",
            name,
            f"{requirement}; its outline takes {count_noun(len(corners), 'corner')}, more than {MAX_CORNERS}",
        )
    return tuple(corners)
