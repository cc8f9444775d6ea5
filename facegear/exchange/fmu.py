"""The dynamic model as an FMU (FMI 3.0, co-simulation) of C sources, which needs no Python where it runs."""

import hashlib
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from itertools import count
from pathlib import Path
from xml.etree import ElementTree as Xml
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.steady_state.simulate import Model, build_model, static_start
from facegear.errors import FacegearError
from facegear.io.atomic import atomic_path
from facegear.mesh_law.linear import LinearLaw
from facegear.transmission.flanks import mesh_contacts
from facegear.transmission.machine import Machine

TOLERANCE = 1e-12
"""Error of a step over the length scale of the machine."""
IDENTIFIER = "facegear_machine"
UNITS = {"m": {"m": "1"}, "N": {"kg": "1", "m": "1", "s": "-2"}, "N.m": {"kg": "1", "m": "2", "s": "-2"}}
"""Units by their exponents of base units; rpm has a factor."""
LETTERS = "xyz"
SHOWN_PERIODS, STEPS_PER_PERIOD = 64, 64
"""Mesh periods and communication steps in each that an importing program is offered as its experiment.

The motion does not depend on them: the FMU integrates with steps of its own.
"""


@dataclass(frozen=True)
class Variable:
    """One variable of the FMU; `start` for an input."""

    name: str
    description: str
    unit: str
    start: float | None = None

    @property
    def causality(self) -> str:
        """As FMI calls it."""
        return "output" if self.start is None else "input"


def write_fmu(path: str | Path, machine: Machine, speed_rpm: float) -> Path:
    """Write the FMU; it starts at rest under the machine's torques. Returns the path.

    Inputs, held through a step: speed of the pinions, torque on each body; the rigid rotation of all bodies
    together is left out, so that only their balance acts. Outputs: deflection (m) and elastic force (N) of
    every contact, force of every body on its bearing (N). Raises FacegearError for what it cannot hold:
    forces that depend on the load, friction, bearing clearance and what turning bodies add.
    """
    path, model = Path(path), build_model(machine)
    _require_plain(model)
    header = _header(model, speed_rpm)
    token = hashlib.sha256(header.encode()).hexdigest()[:32]
    header += f'#define TOKEN "{token}"\n'
    contents = {
        "modelDescription.xml": _description(
            _variables(machine, speed_rpm), _mesh_period(machine, speed_rpm), token
        ),
        "sources/buildDescription.xml": _build_description(),
        "sources/fmu.c": (files("facegear.exchange") / "fmu.c").read_text(encoding="utf-8"),
        "sources/model.h": header,
    }
    with atomic_path(path) as temporary, ZipFile(temporary, "w") as archive:
        for name, text in contents.items():
            archive.writestr(ZipInfo(name), text, ZIP_DEFLATED)
    return path


def _require_plain(model: Model) -> None:
    system, law = model.system, model.system.law
    lost = {
        "forces that depend on the load (mesh_law)": not isinstance(law, LinearLaw) or bool(law.pieces),
        "friction as an excitation": system.rubbing is not None,
        "periodic torques (excitations)": system.load.shape[2] > 1,
        "bearing clearance": bool(system.ring_stiffness.size),
        "coupling of turning bodies or dampers of torsional springs": system.coupling is not None,
    }
    for what, there in lost.items():
        if there:
            raise FacegearError(f"an FMU cannot hold {what}: leave it out to export this machine")


def _contacts(machine: Machine) -> list[tuple[str, str]]:
    """Name of each contact, and where its flank or flanks touch, in the words of a variable's description."""
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
    """All variables but the time, in the order of their references, which begin at 1."""
    bodies = machine.layout.body_names
    contacts = _contacts(machine)
    variables = [
        Variable("speed", "Speed of the pinions", "rpm", speed_rpm),
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
    """Return each name with `_` for all but letters and digits; words that become equal are numbered.

    FMI asks for unique names of variables. The first of equal words stays as it is; the others end in the
    smallest number from 2 on that no other variable has.
    """
    words = [re.sub(r"\W+", "_", name) for name in names]
    taken = set(words)
    numbered_words: list[str] = []
    for word in words:
        unique = word
        if word in numbered_words:
            unique = next(candidate for n in count(2) if (candidate := f"{word}_{n}") not in taken)
            taken.add(unique)
        numbered_words.append(unique)
    return numbered_words


def _header(model: Model, speed_rpm: float) -> str:
    """The numbers of the machine as C."""
    machine, system, reduced = model.machine, model.system, model.reduced
    linear, layout = machine.linear, machine.layout
    spins = reduced.basis[machine.torque_coordinates].T  # load of each coordinate by each body's torque
    law = system.law
    assert isinstance(law, LinearLaw)
    held = linear.translations.ravel()
    bearing = linear.stiffness[held] @ reduced.basis
    damping = linear.bearing_damping * bearing + linear.dampers[held] @ reduced.basis
    stiffness, error = law.fourier[law.kind], system.error[system.error_kind]
    sizes = {
        "COORDINATES": system.size,
        "CONTACTS": system.contacts,
        "BODIES": len(layout.bodies),
        "STIFFNESS_TERMS": stiffness.shape[2],
        "ERROR_TERMS": error.shape[2],
        "PINION_TEETH": layout.pinion_teeth,
        "DAMPING_WHEN_OPEN": int(system.damping_when_open),
        "PUSH_ONLY": int(system.push_only),
    }
    scale = system.scale / float(np.abs(system.mesh_jacobian).max())
    rate = float(np.sqrt(max(system.omega_squared.max(), 1.0)))
    scales = {"TOLERANCE": TOLERANCE, "COORDINATE_SCALE": scale, "RATE_SCALE": rate}
    arrays = {
        "jacobian": system.mesh_jacobian,
        "omega_squared": system.omega_squared,
        "damping": system.damping,
        "mesh_damping": system.mesh_damping,
        "lower": system.lower,
        "upper": system.upper,
        "stiffness_sine": stiffness[:, 0],
        "stiffness_cosine": stiffness[:, 1],
        "error_sine": error[:, 0],
        "error_cosine": error[:, 1],
        "load": system.load[:, 1, 0] - spins @ machine.torques,
        "load_of_torque": spins,
        "bearing_stiffness": bearing,
        "bearing_damping": damping,
        "start_coordinates": static_start(model).displacement,
        "start_input": np.append(speed_rpm, machine.torques),
    }
    lines = [f"#define {name} {value}" for name, value in sizes.items()]
    lines += [f"#define {name} {value!r}" for name, value in scales.items()]
    lines += [_c_array(name, np.asarray(values, dtype=float)) for name, values in arrays.items()]
    return "\n".join(lines) + "\n"


def _c_array(name: str, values: Array) -> str:
    sizes = "".join(f"[{size}]" for size in values.shape)
    return f"static const double {name}{sizes} = {_c_values(values)};"


def _c_values(values: Array) -> str:
    if values.ndim == 0:
        return repr(float(values)).replace("inf", "INFINITY")
    return "{" + ", ".join(_c_values(part) for part in values) + "}"


def _mesh_period(machine: Machine, speed_rpm: float) -> float:
    """Time (s) in which a pinion turns by one pitch."""
    return 60.0 / (machine.layout.pinion_teeth * speed_rpm)


def _description(variables: Sequence[Variable], mesh_period: float, token: str) -> str:
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
    listed = Xml.SubElement(root, "ModelVariables")
    Xml.SubElement(
        listed, "Float64", name="time", valueReference="0", causality="independent", variability="continuous"
    )
    for reference, variable in enumerate(variables, start=1):
        keys = {"name": variable.name, "valueReference": str(reference), "causality": variable.causality}
        keys |= {"variability": "continuous", "description": variable.description, "unit": variable.unit}
        start = {} if variable.start is None else {"start": repr(variable.start)}
        Xml.SubElement(listed, "Float64", {**keys, **start})
    structure = Xml.SubElement(root, "ModelStructure")
    for kind in ("Output", "InitialUnknown"):
        for reference, variable in enumerate(variables, start=1):
            if variable.causality == "output":
                Xml.SubElement(structure, kind, valueReference=str(reference))
    return _text(root)


def _build_description() -> str:
    root = Xml.Element("fmiBuildDescription", fmiVersion="3.0")
    build = Xml.SubElement(root, "BuildConfiguration", modelIdentifier=IDENTIFIER)
    sources = Xml.SubElement(build, "SourceFileSet", language="C99")
    Xml.SubElement(sources, "SourceFile", name="fmu.c")
    return _text(root)


def _text(root: Xml.Element) -> str:
    Xml.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + Xml.tostring(root, encoding="unicode") + "\n"
