"""The dynamic model as an FMU (FMI 3.0, co-simulation) of C++ sources, which needs no Python to run."""

import hashlib
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from itertools import count
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as Xml
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np

from facegear.arrays import AnyArray
from facegear.errors import InvalidInput
from facegear.io.atomic import atomic_path
from facegear.machine.flanks import mesh_contacts
from facegear.machine.machine import Machine
from facegear.motion.integrator.kernel_system import system_numbers
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import Model, build_model, static_start

TOLERANCE = 1e-12
"""Error of a step over the length scale of the machine."""
SLOWEST_RPM = 1.0
"""Smallest speed of the pinions, as in a config: time is counted as mesh phase, which must go forward."""
KERNELS = "facegear._kernels", "src"
"""Package and folder of the sources of the motion."""
INCLUDES = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
"""Header that a C++ source includes by its path below the kernels' sources."""
IDENTIFIER = "facegear_machine"
"""Name of the FMU's library, as FMI asks for one."""
UNITS = {"m": {"m": "1"}, "N": {"kg": "1", "m": "1", "s": "-2"}, "N.m": {"kg": "1", "m": "2", "s": "-2"}}
"""Units by their exponents of base units; rpm has a factor."""
LETTERS = "xyz"
"""Directions of the forces on bearings."""
COUPLING = ("dampers", "gyroscopic", "circulatory", "centrifugal")
"""Matrices that couple coordinates, in the order of the integrator's argument."""
SERIES = ("error", "load", "rubbing_ratios", "fourier", "factor")
"""Names of Fourier series among the numbers of a system and of its law."""
SHOWN_PERIODS, STEPS_PER_PERIOD = 64, 64
"""Mesh periods and communication steps in each that an importing program is offered as its experiment.

The motion does not depend on them: the FMU integrates with steps of its own.
"""


@dataclass(frozen=True)
class Variable:
    """One variable of the FMU; `start`, and where there is one the `minimum`, for an input."""

    name: str
    description: str
    unit: str
    start: float | None = None
    minimum: float | None = None

    @property
    def causality(self) -> str:
        """Causality of the variable in FMI: "input" if it has a start value, else "output"."""
        return "output" if self.start is None else "input"


def write_fmu(path: str | Path, machine: Machine, speed_rpm: float) -> Path:
    """Write the machine as an FMU for co-simulation (FMI 3.0, C++ sources), at rest under its torques at
    the start.

    Inputs, constant through a step: speed of the pinions, rpm, and torque on each body, N m. The rigid
    rotation of all bodies together is left out, so that only the balance of the torques acts. Outputs:
    deflection, m, and elastic force, N, of every contact, and force of every body on its bearing along x,
    y, z, N.

    Parameters
    ----------
    path : str or Path
        File to write (.fmu, a zip archive).
    machine : Machine
        The machine; its numbers are written into the header model.hpp.
    speed_rpm : float
        Start value of the input speed of the pinions, rpm.

    Returns
    -------
    Path
        The path.

    Raises
    ------
    InvalidInput
        Where the meshes of the machine move in their cycle.
    """
    if machine.has_phase_shifts:
        raise InvalidInput("transmission.mesh_place", "moving", "even, where an FMU is written")
    path, model = Path(path), build_model(machine)
    header = _header(model, speed_rpm)
    token = hashlib.sha256(header.encode()).hexdigest()[:32]
    sources = {**motion_sources(), "model.hpp": header.replace("TOKEN", token)}
    contents = {
        "modelDescription.xml": _description(
            _variables(machine, speed_rpm), _mesh_period(machine, speed_rpm), token
        ),
        "sources/buildDescription.xml": _build_description(),
        **{f"sources/{name}": sources[name] for name in sorted(sources)},
    }
    with atomic_path(path) as temporary, ZipFile(temporary, "w") as archive:
        for name, text in contents.items():
            archive.writestr(ZipInfo(name), text, ZIP_DEFLATED)
    return path


def motion_sources() -> dict[str, str]:
    """Collect the C++ sources of an FMU that are the same for every machine.

    Returns
    -------
    dict
        Texts by their paths below `sources`: fmu.cpp, and all headers of the motion that it includes,
        directly or not; model.hpp, which holds the numbers of a machine, is not among them.
    """
    package, folder = KERNELS
    kernels = files(package) / folder
    texts = {"fmu.cpp": (files("facegear.exchange") / "fmu.cpp").read_text(encoding="utf-8")}
    names = set(INCLUDES.findall(texts["fmu.cpp"]))
    while names := names - set(texts) - {"model.hpp"}:
        texts |= {name: kernels.joinpath(name).read_text(encoding="utf-8") for name in names}
        names = {name for text in texts.values() for name in INCLUDES.findall(text)}
    return texts


def _contacts(machine: Machine) -> list[tuple[str, str]]:
    """Return for each contact its name and where it touches, in words for a variable's description.

    With kinematics that have flanks apart: all drive flanks, then all back flanks; else one contact for
    each mesh.
    """
    layout, contacts = machine.layout, mesh_contacts(machine)
    if not layout.kinematics.flanks_apart:
        return [
            (name, f"of the mesh; flanks touch above {upper!r} m and below {lower!r} m")
            for name, lower, upper in zip(
                layout.mesh_names, contacts.lower.tolist(), contacts.upper.tolist(), strict=True
            )
        ]
    flanks = [(mesh, flank) for flank in ("drive", "back") for mesh in layout.mesh_names]
    return [
        (f"{mesh}_{flank}", f"of the {flank} flank, which touches above {edge!r} m")
        for (mesh, flank), edge in zip(flanks, contacts.upper.tolist(), strict=True)
    ]


def _variables(machine: Machine, speed_rpm: float) -> list[Variable]:
    """Return all variables but the time, in the order of their value references, which begin at 1.

    Speed, torques on bodies, deflections and forces of contacts, forces on bearings. `speed_rpm` is the
    start value.
    """
    bodies = machine.layout.body_names
    contacts = _contacts(machine)
    variables = [
        Variable("speed", "Speed of the pinions", "rpm", speed_rpm, SLOWEST_RPM),
        *(
            Variable(f"torque_{body}", f"Torque on {body}", "N.m", float(torque))
            for body, torque in zip(bodies, machine.torques, strict=True)
        ),
        *(Variable(f"deflection_{name}", f"Deflection {edges}", "m") for name, edges in contacts),
        *(Variable(f"force_{name}", "Elastic force along the line of action", "N") for name, _ in contacts),
        *(
            Variable(f"bearing_{body}_{letter}", f"Force of {body} on its bearing along {letter}", "N")
            for body in bodies
            for letter in LETTERS
        ),
    ]
    names = unique_words([variable.name for variable in variables])
    return [replace(variable, name=name) for variable, name in zip(variables, names, strict=True)]


def unique_words(names: Sequence[str]) -> list[str]:
    """Turn names into identifiers: `_` replaces all but letters and digits, and equal identifiers are
    numbered.

    FMI asks for unique names of variables. The first of equal words stays as it is; the others end in the
    smallest number from 2 on that no other variable has.

    Parameters
    ----------
    names : sequence of str
        Names of variables, such as `deflection_left input/upper`.

    Returns
    -------
    list of str
        One identifier for each name, in the same order.
    """
    words = [re.sub(r"\W+", "_", name) for name in names]
    used_words = set(words)
    numbered_words: list[str] = []
    for word in words:
        unique = word
        if word in numbered_words:
            unique = next(candidate for n in count(2) if (candidate := f"{word}_{n}") not in used_words)
            used_words.add(unique)
        numbered_words.append(unique)
    return numbered_words


def _header(model: Model, speed_rpm: float) -> str:
    """Return the C++ header model.hpp with the numbers of the machine's reduced model.

    The word TOKEN stands in it for the instantiation token, which is computed from the header.
    `speed_rpm` is the start value of the speed.
    """
    machine, linear, law = model.machine, model.machine.linear, model.system.law
    spins = model.reduction.basis[
        machine.torque_coordinates
    ].T  # load of each coordinate by each body's torque
    load = model.system.load.copy()
    load[:, 1, 0] -= spins @ machine.torques
    kernel_law = type(law.kernel_law).__name__
    translations = linear.translations.ravel()
    bearing = linear.stiffness[translations] @ model.reduction.basis
    dampers = linear.bearing_damping * bearing + linear.dampers[translations] @ model.reduction.basis
    in_rings = (3 * linear.rings.body[:, None] + [0, 1]).ravel()  # their forces are the motion's own
    bearing[in_rings] = dampers[in_rings] = 0.0
    constants = {
        "bodies": len(machine.layout.bodies),
        "pinion_teeth": machine.layout.pinion_teeth,
        "order": Settings(tolerance=TOLERANCE).taylor_order,
    }
    arrays = {
        "load_of_torque": spins,
        "bearing_stiffness": bearing,
        "bearing_damping": dampers,
        "body_in_ring": linear.rings.body.astype(np.int64),
        "start_coordinates": static_start(model).displacement,
        "start_input": np.append(speed_rpm, machine.torques),
    }
    numbers = {**system_numbers(model.system), "load": load}
    return "\n".join(
        [
            "// Numbers of the machine.",
            "#pragma once",
            "",
            '#include "motion/system.hpp"',
            "",
            "namespace model {",
            "",
            "using facegear::motion::Index;",
            "using facegear::motion::infinity;",
            f"using Law = facegear::motion::{kernel_law};",
            "",
            'constexpr char token[] = "TOKEN";',
            *(f"constexpr Index {name} = {value};" for name, value in constants.items()),
            f"constexpr double tolerance = {TOLERANCE!r}, slowest = {SLOWEST_RPM!r};",
            "",
            *(_function(name, values) for name, values in arrays.items()),
            "",
            "inline facegear::motion::System make_system() {",
            "    facegear::motion::System s;",
            *(f"    {line}" for line in _system_lines(numbers)),
            "    const auto law = std::make_shared<Law>();",
            *(f"    {line}" for line in _law_lines(law.numbers)),
            "    s.law = std::shared_ptr<const Law>(law);",
            "    s.prepare();",
            "    return s;",
            "}",
            "",
            "} // namespace model",
            "",
        ]
    )


def _function(name: str, values: AnyArray) -> str:
    """Return the C++ text of a function `name` that returns the array, in row-major order, as a
    std::vector.
    """
    kind = "Index" if values.dtype.kind == "i" else "double"
    return f"inline std::vector<{kind}> {name}() {{ return {_list(values)}; }}"


def _system_lines(numbers: dict[str, Any]) -> Iterator[str]:
    """Yield the C++ statements that fill a facegear::motion::System `s` from `system_numbers`, arrays by
    name.
    """
    rows, n = numbers["jacobian"].shape
    contacts = rows - 3 * numbers["ring_stiffness"].size
    yield f"s.n = {n}, s.m = {rows}, s.contacts = {contacts};"
    yield f"s.coupled = {_text_of(numbers['coupling'].size > 0)};"
    for name, values in numbers.items():
        if name == "coupling":
            for part, matrix in zip(COUPLING, values, strict=False):
                yield f"s.coupling.{part} = {_list(matrix)};"
        else:
            yield f"s.{name} = {_series(values) if name in SERIES else _value(values)};"


def _law_lines(numbers: dict[str, Any]) -> Iterator[str]:
    """Yield the C++ statements that fill the force law `law` of facegear::motion from its numbers by
    name.
    """
    for name, values in numbers.items():
        if name == "table":
            kinds, levels, harmonics = values.shape[:3]
            yield f"law->kinds = {kinds}, law->level_count = {levels}, law->harmonics = {harmonics};"
        if name == "pieces":
            yield f"law->degrees = {values.shape[1]};"
        member = "count" if name == "contacts" else name
        yield f"law->{member} = {_series(values) if name in SERIES else _value(values)};"


def _series(values: AnyArray) -> str:
    """Return Fourier series (kinds, 2, harmonics + 1) as C++ text that initialises
    facegear::motion::FourierRows.
    """
    return f"{{{values.shape[0]}, {values.shape[2]}, {_list(values)}}}"


def _value(value: Any) -> str:
    """Return a number as a C++ literal, or an array as an initialiser list."""
    return _list(value) if isinstance(value, np.ndarray) else _text_of(value)


def _list(values: AnyArray) -> str:
    """Return an array as a C++ initialiser list, in row-major order."""
    return "{" + ", ".join(_text_of(value) for value in values.ravel().tolist()) + "}"


def _text_of(value: float | bool) -> str:
    """Return a number or a boolean as a C++ literal; infinite values become `infinity`."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value).replace("inf", "infinity")


def _mesh_period(machine: Machine, speed_rpm: float) -> float:
    """Return the time (s) in which a pinion turns by one pitch at `speed_rpm`."""
    return 60.0 / (machine.layout.pinion_teeth * speed_rpm)


def _description(variables: Sequence[Variable], mesh_period: float, token: str) -> str:
    """Return the text of `modelDescription.xml`: variables, units, default experiment and structure.

    `mesh_period` (s) sets stop time and step of the experiment; `token` is the instantiation token.
    """
    root = Xml.Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName="facegear machine",
        instantiationToken=token,
        generationTool="facegear",
        variableNamingConvention="flat",
    )
    Xml.SubElement(
        root, "CoSimulation", modelIdentifier=IDENTIFIER, canHandleVariableCommunicationStepSize="true"
    )
    units = Xml.SubElement(root, "UnitDefinitions")
    for name, exponents in UNITS.items():
        Xml.SubElement(Xml.SubElement(units, "Unit", name=name), "BaseUnit", exponents)
    rpm = {"s": "-1", "rad": "1", "factor": repr(np.pi / 30)}
    Xml.SubElement(Xml.SubElement(units, "Unit", name="rpm"), "BaseUnit", rpm)
    experiment = {
        "startTime": 0.0,
        "stopTime": SHOWN_PERIODS * mesh_period,
        "tolerance": TOLERANCE,
        "stepSize": mesh_period / STEPS_PER_PERIOD,
    }
    Xml.SubElement(root, "DefaultExperiment", {key: repr(value) for key, value in experiment.items()})
    variables_element = Xml.SubElement(root, "ModelVariables")
    Xml.SubElement(
        variables_element,
        "Float64",
        name="time",
        valueReference="0",
        causality="independent",
        variability="continuous",
    )
    for reference, variable in enumerate(variables, start=1):
        keys = {"name": variable.name, "valueReference": str(reference), "causality": variable.causality}
        keys |= {"variability": "continuous", "description": variable.description, "unit": variable.unit}
        for key, value in (("min", variable.minimum), ("start", variable.start)):
            keys |= {} if value is None else {key: repr(value)}
        Xml.SubElement(variables_element, "Float64", keys)
    structure = Xml.SubElement(root, "ModelStructure")
    for kind in ("Output", "InitialUnknown"):
        for reference, variable in enumerate(variables, start=1):
            if variable.causality == "output":
                Xml.SubElement(structure, kind, valueReference=str(reference))
    return _text(root)


def _build_description() -> str:
    """Return `buildDescription.xml`: how the sources of the FMU are compiled."""
    root = Xml.Element("fmiBuildDescription", fmiVersion="3.0")
    build = Xml.SubElement(root, "BuildConfiguration", modelIdentifier=IDENTIFIER)
    sources = Xml.SubElement(build, "SourceFileSet", language="C++17")
    Xml.SubElement(sources, "SourceFile", name="fmu.cpp")
    Xml.SubElement(sources, "IncludeDirectory", name=".")
    return _text(root)


def _text(root: Xml.Element) -> str:
    """Return an XML tree as indented text with its declaration."""
    Xml.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + Xml.tostring(root, encoding="unicode") + "\n"
