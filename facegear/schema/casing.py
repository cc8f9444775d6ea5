"""Config section `transmission.casing`: a casing by finite elements, its seats, feet and sensors."""

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from facegear.schema.base import Section, refuse, require_all

Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]
Direction = tuple[Coordinate, Coordinate, Coordinate]
LARGEST_NODE = 999_999_999
"""Largest number of a node that finite-element programs write."""
Node = Annotated[int, Field(ge=1, le=LARGEST_NODE)]
SQUARE = 1e-6
"""Cosine between two axes up to which they count as perpendicular."""


class CasingAxes(Section):
    """Where the machine stands in the axes of the file."""

    x: Direction = Field((1.0, 0.0, 0.0), description="from the gears' axis to a pinion at angle 0")
    z: Direction = Field(
        (0.0, 0.0, 1.0), description="along the gears' axis, from the lower to the upper gear"
    )
    origin_mm: Direction = Field((0.0, 0.0, 0.0), description="where the pinions' axes meet the gears' axis")

    @model_validator(mode="after")
    def _perpendicular(self) -> "CasingAxes":
        """Refuse axes without length, or that are not perpendicular."""
        x, z = (sum(part * part for part in axis) ** 0.5 for axis in (self.x, self.z))
        for key, length in (("x", x), ("z", z)):
            if length == 0.0:
                refuse(key, list(getattr(self, key)), "a direction: not all zero")
        cosine = sum(a * b for a, b in zip(self.x, self.z, strict=True)) / (x * z)
        if abs(cosine) > SQUARE:
            refuse("z", list(self.z), f"perpendicular to x; their cosine is {cosine:.3g}")
        return self


class CasingPlace(Section):
    """Nodes that move as one: a node with rotations, or a patch of several that is rigid."""

    node: Node | None = Field(None, description="a node with six dofs")
    nodes: tuple[Node, ...] = Field((), max_length=100_000, description="a rigid patch of nodes")
    patch: str | None = Field(
        None, min_length=1, max_length=60, description="a rigid patch: its name in column patch of `nodes`"
    )
    at_mm: Direction | None = Field(
        None,
        description="the point whose motions count, in the file; null: that of the node, or the mean of the "
        "patch. Alone: the node within 1 mm of it",
    )

    @model_validator(mode="after")
    def _given_once(self) -> "CasingPlace":
        """Refuse a place that is given by more than one of its keys, or by none."""
        require_all(self._one_key)
        return self

    def _one_key(self) -> None:
        """Refuse nodes that are given twice or not at all."""
        keys = [key for key in ("node", "nodes", "patch") if getattr(self, key)]
        if len(keys) > 1:
            refuse(keys[1], getattr(self, keys[1]), f"left out beside {keys[0]}")
        if not keys and self.at_mm is None:
            refuse("node", None, "given, or else nodes, patch or at_mm")


class FootStiffness(Section):
    """Springs of a foot along or about the axes of the file."""

    x: float = Field(0.0, ge=0, le=1e14, description="along or about x")
    y: float = Field(0.0, ge=0, le=1e14, description="along or about y")
    z: float = Field(0.0, ge=0, le=1e14, description="along or about z")


class CasingFoot(CasingPlace):
    """A foot on the ground: held in all six motions, or on springs."""

    name: str | None = Field(None, min_length=1, max_length=40, description="null: foot 1, foot 2 and so on")
    held: bool = Field(False, description="whether the ground holds all six motions of the foot")
    stiffness_n_per_m: FootStiffness | None = Field(None, description="springs along the axes of the file")
    stiffness_n_m_per_rad: FootStiffness | None = Field(None, description="springs about these axes")

    @model_validator(mode="after")
    def _held_or_sprung(self) -> "CasingFoot":
        """Refuse a foot that is held and on springs, or neither."""
        require_all(self._one_support)
        return self

    def _one_support(self) -> None:
        """Refuse a support that is given twice or not at all."""
        is_sprung = self.stiffness_n_per_m is not None or self.stiffness_n_m_per_rad is not None
        if self.held == is_sprung:
            refuse("held", self.held, "true, or else stiffness_n_per_m given, but not both")


class CasingSensor(Section):
    """A point whose vibration is told."""

    name: str = Field(min_length=1, max_length=40, description="names it in tables and figures")
    node: Node = Field(description="a node with motions along x, y and z")
    direction: Direction = Field((0.0, 0.0, 1.0), description="in the axes of the file")

    @model_validator(mode="after")
    def _points_somewhere(self) -> "CasingSensor":
        """Refuse a direction without length."""
        if not any(self.direction):
            refuse("direction", list(self.direction), "not all zero")
        return self


def _single_node(value: object) -> object:
    """Return the place of a seat that is given by the number of its node alone, and lists as tuples."""
    if isinstance(value, dict):
        return {key: tuple(part) if isinstance(part, list) else part for key, part in value.items()}
    return {"node": value} if isinstance(value, int) else value


Seat = Annotated[CasingPlace, BeforeValidator(_single_node, json_schema_input_type=Node | CasingPlace)]


class CasingSection(Section):
    """A casing by finite elements: bearings stand on its seats, and it on its feet."""

    stiffness: str = Field(
        min_length=1,
        description="file of K: csv or npz, Nastran DMIG (.pch), Abaqus or CalculiX .mtx, CalculiX .sti, or "
        "Matrix Market .mtx",
    )
    mass: str | None = Field(
        None, min_length=1, description="file of M; null: that of K where it holds M, else no mass"
    )
    damping: str | None = Field(None, min_length=1, description="file of C; null: damping_ratio")
    nodes: str | None = Field(
        None,
        min_length=1,
        description="csv of the nodes: node, x_mm, y_mm, z_mm and, if wanted, patch; null: in the npz of K",
    )
    dofs: str | None = Field(
        None,
        min_length=1,
        description="csv of the rows: node, dof (1 to 6; modes: node 0); null: the file of K names them",
    )
    content: str | None = Field(None, description="digest of the files, filled in when they are read")
    units: Literal["mm_t_s", "si"] = Field(description="of the matrices: N, mm, t or N, m, kg")
    axes: CasingAxes = CasingAxes()
    mass_kg: float | None = Field(
        None,
        ge=1e-6,
        le=1e7,
        description="mass as it is known, to check the files; null: its size is checked",
    )
    damping_ratio: float = Field(0.01, ge=0, le=0.5, description="of every mode of the casing on its feet")
    modes: int = Field(
        30, ge=0, le=500, description="with seats and feet held, beside the static shapes; 0: Guyan"
    )
    seats: dict[str, Seat] = Field(
        description="by the bearing: a pinion's name for all of its bearings, name and letter for one (right "
        "input A), lower gear or upper gear; a bearing that is left out stands on the ground"
    )
    feet: tuple[CasingFoot, ...] = Field((), max_length=100, description="none where the file holds the feet")
    sensors: tuple[CasingSensor, ...] = Field(
        (), max_length=100, description="points whose vibration is told"
    )

    @model_validator(mode="after")
    def _distinct(self) -> "CasingSection":
        """Refuse names that stand twice, and a casing without seats."""
        require_all(self._check_seats, self._check_names)
        return self

    def _check_seats(self) -> None:
        """Refuse a casing that carries nothing."""
        if not self.seats:
            refuse("seats", {}, "one or more")

    def _check_names(self) -> None:
        """Refuse feet or sensors with equal names."""
        for key, names in (
            ("sensors", [sensor.name for sensor in self.sensors]),
            ("feet", [*self.seats, *self.foot_names]),
        ):
            if len(set(names)) < len(names):
                refuse(key, names, "names that differ")

    @property
    def foot_names(self) -> list[str]:
        """Names of the feet: their own, else their number."""
        return [foot.name or f"foot {number}" for number, foot in enumerate(self.feet, start=1)]

    @property
    def files(self) -> dict[str, str | None]:
        """Names of the files by what they hold."""
        return {key: getattr(self, key) for key in ("stiffness", "mass", "damping", "nodes", "dofs")}
