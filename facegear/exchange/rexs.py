"""Pinions, shafts, bearings and material as REXS 2.0 (FVA's exchange of gear unit data).

REXS has no face gear: what is lost stands in LOST, and in a comment of every file.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite, nan
from pathlib import Path
from xml.etree import ElementTree as Xml

from facegear.build.config import Config
from facegear.build.machine_layout import layout
from facegear.build.tooth_numbers import ToothNumbers
from facegear.errors import ConfigError, FacegearError, plain_reason
from facegear.io.atomic import atomic_path
from facegear.machine.layout import Body
from facegear.schema.tooth_pair import flank_angles_deg

VERSION = "2.0"
"""Version of the REXS standard that files are written in."""


LOST_CONTENT = (
    "face gears: their teeth and shapes; each is a shaft with its mass and bearing alone",
    "distribution angles, torques with their excitations, backlash, errors and damping",
    "inertias; REXS takes them from the shapes of bodies",
    "bearing stiffness along x and y where they differ: the smaller one is written",
    "tooth thickness, addendum, dedendum, profile shift, taper, axial place and modifications of the pinion",
)
"""Content of a machine that a file cannot hold."""


READ_UNITS = {
    "mass_of_component": "kg",
    "radial_stiffness": "N / m",
    "axial_stiffness": "N / m",
    "elastic_modulus": "MPa",
    "poisson_ratio": "none",
    "number_of_teeth": "none",
    "normal_module": "mm",
    "face_width": "mm",
    "inner_diameter": "mm",
    "normal_pressure_angle": "deg",
    "helix_angle_reference_diameter": "deg",
}
"""Attributes that are read, and the unit that REXS 2.0 gives each."""
OLD_UNITS = {"°": "deg"}
"""Names of units in versions of REXS before 1.4, and those of today."""


@dataclass(frozen=True)
class CylindricalGear:
    """The teeth of a pinion; None where not given.

    teeth: their number. module: normal module (mm). width: of the face (mm). bore: its radius (mm).
    right_angle, left_angle: normal pressure angles (deg) of the right and the left flank, seen from the
    pinion's outer end: in the package's terms the drive and the coast flank. helix_angle: at the
    reference circle (deg), positive for a right-hand gear.
    """

    teeth: int
    module: float
    width: float | None
    right_angle: float | None
    left_angle: float | None
    bore: float | None
    helix_angle: float | None = None


@dataclass(frozen=True)
class Shaft:
    """A body on its bearing: mass (kg), stiffness (N/m) across and along its axis; a pinion has teeth."""

    name: str
    mass: float | None
    radial: float | None
    axial: float | None
    gear: CylindricalGear | None = None


@dataclass(frozen=True)
class Unit:
    """A gear unit: its shafts, Young's modulus (MPa) and Poisson's ratio of the pinions' material."""

    shafts: tuple[Shaft, ...]
    young: float | None
    poisson: float | None


class _Model:
    """A document that grows: components and relations are numbered from 1."""

    def __init__(self, date: str, version: str) -> None:
        attributes = {
            "version": VERSION,
            "applicationId": "facegear",
            "applicationVersion": version,
            "date": date,
        }
        self.root = Xml.Element("model", attributes)
        self.relations, self.components = (
            Xml.SubElement(self.root, name) for name in ("relations", "components")
        )

    def component(self, kind: str, name: str, *attributes: tuple[str, str, float | None]) -> int:
        """Add a component and return its id, numbered from 1.

        `kind` is its REXS type, and each attribute a triple of id, unit and value; None values are left
        out.
        """
        number = len(self.components) + 1
        element = Xml.SubElement(self.components, "component", id=str(number), type=kind, name=name)
        for key, unit, value in attributes:
            if value is not None:
                Xml.SubElement(element, "attribute", id=key, unit=unit).text = repr(value)
        return number

    def relation(self, kind: str, *members: tuple[str, int]) -> None:
        """Add a relation of a REXS type between components; each member is a pair of role and component
        id.
        """
        element = Xml.SubElement(self.relations, "relation", id=str(len(self.relations) + 1), type=kind)
        for role, number in members:
            hint = self.components[number - 1].attrib["type"]
            Xml.SubElement(element, "ref", id=str(number), role=role, hint=hint)


def write_rexs(path: str | Path, unit: Unit, date: str, version: str) -> Path:
    """Write a gear unit as a REXS 2.0 file in XML.

    Parameters
    ----------
    path : str or Path
        File to write.
    unit : Unit
        The gear unit.
    date : str
        Date of the file by ISO 8601.
    version : str
        Version of this program.

    Returns
    -------
    Path
        The path.
    """
    model = _Model(date, version)
    whole, casing = model.component("gear_unit", "gear unit"), model.component("gear_casing", "casing")
    stuff = (("elastic_modulus", "MPa", unit.young), ("poisson_ratio", "none", unit.poisson))
    material = model.component("material", "material of the pinions", *stuff)
    model.relation("assembly", ("assembly", whole), ("part", casing))
    for shaft in unit.shafts:
        number = model.component("shaft", shaft.name, ("mass_of_component", "kg", shaft.mass))
        stiffness = (("radial_stiffness", "N / m", shaft.radial), ("axial_stiffness", "N / m", shaft.axial))
        bearing = model.component("concept_bearing", f"bearing of {shaft.name}", *stiffness)
        model.relation("assembly", ("assembly", whole), ("part", number))
        model.relation("side", ("assembly", bearing), ("inner_part", number), ("outer_part", casing))
        if shaft.gear is not None:
            _add_gear(model, shaft.name, shaft.gear, number, material)
    model.root.insert(0, Xml.Comment(" Lost, as REXS has no face gear: " + "; ".join(LOST_CONTENT) + " "))
    Xml.indent(model.root)
    with atomic_path(path) as temporary:
        Xml.ElementTree(model.root).write(temporary, encoding="UTF-8", xml_declaration=True)
    return Path(path)


def _add_gear(model: _Model, name: str, teeth: CylindricalGear, shaft: int, material: int) -> None:
    """Add the gear of a pinion, with both flanks, and relate it to its shaft and material (component ids)."""
    sizes = (
        ("number_of_teeth", "none", teeth.teeth),
        ("normal_module", "mm", teeth.module),
        ("helix_angle_reference_diameter", "deg", teeth.helix_angle),
        ("face_width", "mm", teeth.width),
        ("inner_diameter", "mm", None if teeth.bore is None else 2.0 * teeth.bore),
    )
    gear = model.component("cylindrical_gear", f"teeth of {name}", *sizes)
    model.relation("assembly", ("assembly", shaft), ("part", gear))
    model.relation("reference", ("origin", gear), ("referenced", material))
    flanks = [
        model.component(
            "cylindrical_gear_flank", f"{side} flank of {name}", ("normal_pressure_angle", "deg", angle)
        )
        for side, angle in (("left", teeth.left_angle), ("right", teeth.right_angle))
    ]
    members = zip(("left", "right"), flanks, strict=True)
    model.relation("flank", ("gear", gear), *members)


def read_rexs(path: str | Path) -> Unit:
    """Read the gear unit of a REXS file of any program: every shaft, with its first cylindrical gear and
    bearing.

    Parameters
    ----------
    path : str or Path
        REXS file in XML.

    Returns
    -------
    Unit
        The gear unit.

    Raises
    ------
    FacegearError
        For a file that is no REXS file in XML, an attribute that is no number or has another unit than REXS
        gives it, an id that occurs twice, a part that a relation names and the file lacks, and a gear without
        number of teeth or module.
    """
    _refuse_other_forms(Path(path))
    try:
        root = Xml.parse(path).getroot()
    except (OSError, ValueError, LookupError, Xml.ParseError) as error:
        raise FacegearError(f"{path}: not a readable REXS file ({plain_reason(error)})") from None
    if root.tag != "model":
        raise FacegearError(f"{path}: a REXS file begins with model, not {root.tag}")
    try:
        return _unit(root)
    except _Fault as fault:
        raise FacegearError(f"{path}: {fault}") from None


def _refuse_other_forms(path: Path) -> None:
    """Look at the first bytes of a file and raise FacegearError for the zipped (.rexsz) and JSON (.rexsj)
    form of REXS.
    """
    try:
        with path.open("rb") as file:
            start = file.read(64).lstrip(b"\xef\xbb\xbf \t\r\n")
    except OSError as error:
        raise FacegearError(f"{path}: not a readable REXS file ({plain_reason(error)})") from None
    for first, form in ((b"PK", "zipped (.rexsz)"), (b"{", "JSON (.rexsj)")):
        if start.startswith(first):
            raise FacegearError(f"{path}: this is the {form} form of REXS; save it as XML (.rexs)")


class _Fault(Exception):
    """Reason why a REXS file cannot be used, in one line without its name."""


def _unit(root: Xml.Element) -> Unit:
    """Read the gear unit from the root element `model`; raise _Fault for ids that occur twice or are
    absent.
    """
    parts: Parts = {}
    for part in root.iter("component"):
        number = _attribute(part, "id")
        if number in parts:
            raise _Fault(f"component id {number[:40]!r} stands twice: must be unique")
        _attribute(part, "type")
        parts[number] = part
    relations = [
        (
            _attribute(relation, "type"),
            {_attribute(member, "role"): _attribute(member, "id") for member in relation.iter("ref")},
        )
        for relation in root.iter("relation")
    ]
    for kind, members in relations:
        for number in members.values():
            if number not in parts:
                raise _Fault(
                    f"a relation of type {kind[:40]!r} names component {number[:40]!r}, which is absent"
                )
    shafts = [_shaft(number, parts, relations) for number in _of_kind(parts, "shaft")]
    material = next((parts[number] for number in _of_kind(parts, "material")), None)
    young, poisson = (_value(material, key) for key in ("elastic_modulus", "poisson_ratio"))
    return Unit(tuple(shafts), young, poisson)


Parts = dict[str, Xml.Element]


Relations = list[tuple[str, dict[str, str]]]


def _of_kind(parts: Parts, *types: str) -> Iterable[str]:
    """Return the ids of the components whose REXS type is among `types`, in the order of the file."""
    return (number for number, part in parts.items() if part.attrib["type"] in types)


def _attribute(element: Xml.Element, name: str) -> str:
    """Return the text of an XML attribute that the element must have; raise _Fault without it."""
    if name not in element.attrib:
        attribute_text = (
            ", ".join(f"{key}={value[:40]!r}" for key, value in element.attrib.items()) or "no attribute"
        )
        raise _Fault(f"an element {element.tag} ({attribute_text}) has no attribute {name}")
    return element.attrib[name]


def _shaft(number: str, parts: Parts, relations: Relations) -> Shaft:
    """Read a shaft (component id `number`) with its first cylindrical gear and its first concept bearing.

    `parts` holds the components by id, `relations` pairs of type and of ids by role.
    """
    gears = [
        members["part"]
        for kind, members in relations
        if kind == "assembly" and members.get("assembly") == number and "part" in members
    ]
    teeth = next((gear for gear in gears if parts[gear].attrib["type"] == "cylindrical_gear"), None)
    components = [
        members["assembly"]
        for kind, members in relations
        if kind == "side" and number in members.values() and "assembly" in members
    ]
    bearing = next(
        (parts[member] for member in components if parts[member].attrib["type"] == "concept_bearing"), None
    )
    return Shaft(
        name=parts[number].attrib.get("name", number),
        mass=_value(parts[number], "mass_of_component"),
        radial=_value(bearing, "radial_stiffness"),
        axial=_value(bearing, "axial_stiffness"),
        gear=None if teeth is None else _cylindrical_gear(teeth, parts, relations),
    )


def _cylindrical_gear(gear: str, parts: Parts, relations: Relations) -> CylindricalGear:
    """Read a cylindrical gear (component id `gear`); raise _Fault for one without teeth or module.

    A flank without a pressure angle has that of the other; the bore is half the inner diameter, mm.
    """
    count, module = (_value(parts[gear], key) for key in ("number_of_teeth", "normal_module"))
    if count is None or module is None:
        raise _Fault(f"gear {gear} has no number of teeth or no normal module")
    if count != round(count):
        raise _Fault(f"gear {gear}: number_of_teeth = {count:g}: must be a whole number")
    flanks = next(
        (members for kind, members in relations if kind == "flank" and members.get("gear") == gear), {}
    )
    right, left = (
        _value(parts[flanks[side]], "normal_pressure_angle") if side in flanks else None
        for side in ("right", "left")
    )
    bore = _value(parts[gear], "inner_diameter")
    return CylindricalGear(
        teeth=round(count),
        module=module,
        width=_value(parts[gear], "face_width"),
        right_angle=left if right is None else right,
        left_angle=right if left is None else left,
        bore=None if bore is None else 0.5 * bore,
        helix_angle=_value(parts[gear], "helix_angle_reference_diameter"),
    )


def _value(part: Xml.Element | None, key: str) -> float | None:
    """Return the number of a component's attribute `key` in the unit READ_UNITS; None where it is not
    given.

    _Fault is raised if it is given twice, in another unit, or is not a finite number.
    """
    attributes = [] if part is None else part.findall(f"attribute[@id='{key}']")
    if part is not None and len(attributes) > 1:
        raise _Fault(f"component {part.attrib['id']}: attribute {key} stands twice: must be unique")
    text = attributes[0].text if attributes else None
    if part is not None and attributes:
        unit = attributes[0].attrib.get("unit", READ_UNITS[key])
        if OLD_UNITS.get(unit, unit) != READ_UNITS[key]:
            raise _Fault(
                f"component {part.attrib['id']}: unit of {key} = {unit[:40]!r}: must be {READ_UNITS[key]!r}"
            )
    if part is None or text is None or not text.strip():
        return None
    try:
        value = float(text)
    except ValueError:
        value = nan
    if not isfinite(value):
        name = part.attrib["id"]
        raise _Fault(f"component {name}: {key} = {text.strip()[:40]!r}: must be a finite number")
    return value


def gear_unit(config: Config) -> Unit:
    """Describe a configured machine as a REXS gear unit: pinions, then face gears, as shafts on their
    bearings.

    Parameters
    ----------
    config : Config
        The config, with a transmission.

    Returns
    -------
    Unit
        Stiffness in N/m (radially the smaller of x and y), Young's modulus in MPa, lengths in mm, mass in
        kg. Pinions alone have teeth.

    Raises
    ------
    ConfigError
        If the config has no transmission.
    """
    pair, machine = config.tooth_pair, config.transmission
    if machine is None:
        raise ConfigError("transmission", None, "given, as REXS describes shafts and bearings")
    body = pair.pinion
    drive, coast = flank_angles_deg(pair.pressure_angle_deg)
    teeth = CylindricalGear(
        teeth=pair.pinion_teeth,
        module=pair.module_mm,
        width=None if body is None else body.width_mm,
        right_angle=drive,
        left_angle=coast,
        bore=None if body is None else body.bore_radius_mm,
        helix_angle=pair.helix_angle_deg,
    )
    machine_layout = layout(machine, ToothNumbers.of_config(pair.model_dump()))
    shafts = [_pinion(pinion.name, pinion.body, teeth) for pinion in machine_layout.pinions]
    shafts += [_gear(gear.name, gear.body) for gear in machine_layout.gears]
    material = (body and body.material) or pair.material
    return Unit(tuple(shafts), 1e3 * material.young_modulus_gpa, material.poisson_ratio)


def _pinion(name: str, body: Body, teeth: CylindricalGear) -> Shaft:
    """Return a pinion as a shaft with its teeth; its radial stiffness is the smaller one of x and y, N/m."""
    x, y, z = body.bearing
    return Shaft(name, body.mass, min(x, y), z, teeth)


def _gear(name: str, body: Body) -> Shaft:
    """Return a face gear as a shaft without teeth; its radial stiffness is the smaller one of x and y,
    N/m.
    """
    x, y, z = body.bearing
    return Shaft(name, body.mass, min(x, y), z)
