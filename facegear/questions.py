"""Questions of `facegear new`."""

import sys
from argparse import ArgumentTypeError
from collections.abc import Callable, Mapping
from typing import Any

from facegear.errors import ConfigError, FacegearError

QUESTIONS: dict[str, tuple[type[int] | type[float], float | None, str]] = {
    "pinion_teeth": (int, None, "Teeth of a pinion"),
    "face_gear_teeth": (int, None, "Teeth of the face gear"),
    "module_mm": (float, None, "Module in mm"),
    "torque_n_m": (float, None, "Torque on each driving pinion in N m"),
    "speed_rpm": (float, None, "Speed of the pinions in rpm"),
    "pinions": (int, 1, "Pinions that drive the gear"),
    "pressure_angle_deg": (float, 25.0, "Pressure angle in degrees"),
    "idlers": (int, 0, "Idlers between a lower and an upper face gear; 0 for a single gear"),
}
"""Questions of `new`: kind of number, default if there is one, and the text."""

OPTIONS: dict[str, tuple[type[int] | type[float], str]] = {
    "coast_pressure_angle_deg": (float, "pressure angle of the coast flank, if not that of the drive flank"),
    "helix_angle_deg": (float, "helix angle of the rack, positive for right-hand pinions (0)"),
    "taper_angle_deg": (float, "taper angle of the rack, positive for pinions that grow outwards (0)"),
    "shaft_angle_deg": (float, "angle between the axes (90)"),
    "offset_mm": (float, "offset of the axes (0)"),
    "profile_shift_modules": (float, "profile shift of the pinions"),
    "pinion_addendum_modules": (float, "addendum of the pinions"),
    "pinion_dedendum_modules": (float, "dedendum of the pinions' rack"),
    "rack_tip_radius_modules": (float, "tip radius of the pinions' rack"),
    "gear_addendum_modules": (float, "addendum of the face gears"),
    "shaper_teeth": (int, "teeth of the shaper"),
    "shaper_addendum_modules": (float, "addendum of the shaper"),
    "shaper_tip_rounding_modules": (float, "tip rounding of the shaper"),
    "thinning_um": (float, "normal backlash of a pair"),
    "inner_radius_mm": (float, "inner radius of the face"),
    "outer_radius_mm": (float, "outer radius of the face"),
    "rim_thickness_mm": (float, "thickness of the face gears' rim"),
    "pinion_width_mm": (float, "face width of the pinions"),
    "pinion_bore_radius_mm": (float, "radius of the pinions' bore"),
    "pinion_mass_kg": (float, "mass of a pinion"),
    "gear_mass_kg": (float, "mass of a face gear"),
    "input_bearing_n_per_m": (float, "radial stiffness of an input's bearing"),
    "idler_bearing_n_per_m": (float, "radial stiffness of an idler's bearing"),
    "gear_bearing_n_per_m": (float, "stiffness of a face gear's bearing"),
    "axial_bearing_n_per_m": (float, "axial stiffness of a pinion's bearing"),
    "mesh_damping_n_s_per_m": (float, "damping of a mesh"),
}
"""Values that `new` chooses unless they are given: kind of number, and what it is."""


KINDS = {int: "a whole number", float: "a number"}
"""Kind of number that an answer must be, in words."""


def reader(kind: type[int] | type[float]) -> Callable[[str], float]:
    """Return a function that reads a number from a word of the command line.

    Parameters
    ----------
    kind : type
        `int` or `float`; the number has the unit of its argument.

    Returns
    -------
    callable
        From a word to a number in the unit of its argument. Raises ArgumentTypeError, with the word and what
        it must be, for a word that is no such number.
    """

    def read(word: str) -> float:
        """Return a word as a number of this kind, or raise ArgumentTypeError."""
        try:
            return kind(word)
        except ValueError:
            raise ArgumentTypeError(f"{word!r}: must be {KINDS[kind]}") from None

    return read


def flag(name: str) -> str:
    """Return the option of the command line for an argument.

    Parameters
    ----------
    name : str
        Name of the argument, such as `pinion_teeth`.

    Returns
    -------
    str
        The option, such as `--pinion-teeth`.
    """
    return f"--{name.replace('_', '-')}"


def complete_answers(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return values of all QUESTIONS: as given, else as answered at the terminal, else by default.

    Questions are asked only if one without a default is not given; then all that are not given are asked.

    Parameters
    ----------
    options : Mapping[str, Any]
        Values of the command line by name, None where not given.

    Returns
    -------
    dict[str, Any]
        Value by name, in the unit of its question.

    Raises
    ------
    FacegearError
        If a value without a default is not given and there is no terminal, or an answer is no number.
    """
    missing_names = [name for name in QUESTIONS if options.get(name) is None]
    needed_flags = [flag(name) for name in missing_names if QUESTIONS[name][1] is None]
    if needed_flags and not sys.stdin.isatty():
        raise FacegearError(
            f"new: {', '.join(needed_flags)} must be given, as there is no terminal to ask at"
        )
    return {
        name: ask_question(name) if name in missing_names and needed_flags else _or_default(name, options)
        for name in QUESTIONS
    }


def ask_question(name: str) -> float:
    """Ask a question at the terminal; an empty answer takes the default.

    Parameters
    ----------
    name : str
        Name of the question, a key of QUESTIONS.

    Returns
    -------
    float
        The answer, in the unit of the question.

    Raises
    ------
    FacegearError
        If Ctrl-D ends the input.
    ConfigError
        For an answer that is no number, or an empty one to a question without default.
    """
    kind, default, text = QUESTIONS[name]
    try:
        answer = input(f"{text}{'' if default is None else f' [{default}]'}: ").strip()
    except EOFError:
        # Ctrl-D leaves the cursor behind the question.
        print(file=sys.stderr)
        raise FacegearError(f"new: {flag(name)} was not answered; no file was written") from None
    if not answer and default is not None:
        return default
    try:
        return kind(answer)
    except ValueError:
        raise ConfigError(name, answer, KINDS[kind]) from None


def _or_default(name: str, answers: Mapping[str, Any]) -> Any:
    """Return the value of a question by its name in `answers`; its default, which may be None, if that
    is None.
    """
    return QUESTIONS[name][1] if answers.get(name) is None else answers[name]
