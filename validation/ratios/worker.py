"""One job of the `facegear` on the path, timed: runs as a file, so that the code of any commit can be on it.

    python worker.py JOB ANSWERS INPUTS

JOB is a file of JSON: `config` (path of a config file), `changes` by dotted keys, and either `stage` and
`wildcards` of the workflow or `calls`: methods of a gearbox, `mesh_period` (one period of the motion from
given starts) or `oscillators` (classes of as many random ones as `count` says, made by the code in the folder
`sources`). Each line that is read from the standard input starts one call: `warm` for its own time, `whole`
for that since the process began. It is answered by a line of JSON: `seconds` of a processor, `wall` seconds
and `memory_mb`, the largest memory of the process. ANSWERS is the npz file that the numbers of the first call
are written to; INPUTS is a folder in which this code keeps what other stages give to the stage. Only the
standard library is imported before the clock is read.
"""

import json
import sys
import time
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

STEP_TOLERANCE = 1e-14
"""Local error of a step over the length scale, so small that the choice of the steps moves no digit."""
NEUTRAL = 1e-12
"""Part of the largest singular value of all springs up to which a direction is neutral: turns of all bodies
have some 1e-16, the softest spring of the cases more than 1e-2.
"""
SECOND_LOOKS = 12
"""Other starts that a class must come out from again: so many, where a sweep takes three, that a motion which
one start in four comes to is hardly ever overlooked.
"""
MODULES: dict[str, tuple[str, ...]] = {
    "Chain": ("facegear.pipeline.results.chain", "facegear.results.chain"),
    "PartialResults": ("facegear.pipeline.results.store", "facegear.results.partial"),
    "Store": ("facegear.pipeline.results.store", "facegear.results.store"),
    "mesh_frequency": ("facegear.machine.machine", "facegear.transmission.machine"),
    "Integrator": ("facegear.motion.integrator.integrator", "facegear.dynamics.integrator.integrator"),
    "build_model": ("facegear.motion.steady_state.simulate", "facegear.dynamics.steady_state.simulate"),
    "static_start": ("facegear.motion.steady_state.simulate", "facegear.dynamics.steady_state.simulate"),
    "steady_state": ("facegear.motion.steady_state.simulate", "facegear.dynamics.steady_state.simulate"),
    "Settings": ("facegear.motion.plan", "facegear.dynamics.motion"),
}
"""Modules that define a name: the module of the present code, then that of the baseline of the ratios."""


def from_facegear(*names: str) -> list[Any]:
    """Import names from the modules that the code on the path has.

    Parameters
    ----------
    *names : str
        Keys of MODULES.

    Returns
    -------
    list
        One object for each name.

    Raises
    ------
    ModuleNotFoundError
        If the code on the path has none of the modules of a name.
    """
    return [getattr(_module(name), name) for name in names]


def _module(name: str) -> Any:
    for module in MODULES[name][:-1]:
        try:
            return import_module(module)
        except ModuleNotFoundError as error:
            # A library that the module itself needs and does not find is another fault.
            if error.name is None or not f"{module}.".startswith(f"{error.name}."):
                raise
    return import_module(MODULES[name][-1])


def main(job: str, answers: str, inputs: str) -> None:
    """Answer each line of the standard input.

    Parameters
    ----------
    job, answers, inputs : str
        Paths, as the module says.
    """
    request = json.loads(Path(job).read_text(encoding="utf-8"))
    call: Callable[[], Any] | None = None
    for line in sys.stdin:
        whole = line.strip() == "whole"
        call = call or (_stage(request, inputs) if request["stage"] else _calls(request))
        begin, clock = 0.0 if whole else time.process_time(), time.perf_counter()
        content = call()
        seconds, wall = time.process_time() - begin, time.perf_counter() - clock
        print(json.dumps({"seconds": seconds, "wall": wall, "memory_mb": _largest_memory()}), flush=True)
        if not Path(answers).exists():
            _write(Path(answers), content)


def _stage(request: dict[str, Any], inputs: str) -> Callable[[], Any]:
    """Call of a stage whose inputs are computed now, or read where this code has kept them."""
    import facegear
    from facegear.pipeline.run import call
    from facegear.pipeline.table import STAGES

    chain, store, partial_results = from_facegear("Chain", "Store", "PartialResults")
    gearbox = facegear.load(request["config"], results=None).with_values(request["changes"])
    stage = STAGES[request["stage"]]
    arguments = chain(gearbox.values, store(partial=partial_results(Path(inputs)))).arguments(stage.name)
    names = ("typed_wildcards", "typed")  # the second in the baseline
    convert = next(getattr(stage, name) for name in names if hasattr(stage, name))
    return lambda: call(stage, arguments, **convert(request["wildcards"])).content


def _calls(request: dict[str, Any]) -> Callable[[], Any]:
    """Calls that a user makes through the Python door, its import among them."""

    def answer() -> Any:
        import facegear

        if not request["calls"]:
            return {"door": facegear.Gearbox.__name__}
        gearbox = facegear.load(request["config"], results=None).with_values(request["changes"])
        return {name: _answer(gearbox, name, request) for name in request["calls"]}

    return answer


def _answer(gearbox: Any, name: str, request: dict[str, Any]) -> Any:
    if name == "mesh_period":
        return _mesh_period(gearbox)
    if name == "oscillators":
        return _oscillators(request["count"], request["sources"])
    return getattr(gearbox, name)().content


def _mesh_period(gearbox: Any) -> dict[str, Any]:
    """State, disturbances, samples and contact after one mesh period, from rest and from two starts aside.

    All are displacements of the bodies, as reduced coordinates may come in another order. The static
    equilibrium that the motions start from is taken without its neutral part.
    """
    import numpy as np

    mesh_frequency, make_integrator = from_facegear("mesh_frequency", "Integrator")
    build_model, static_start = from_facegear("build_model", "static_start")
    model = build_model(_machine(gearbox))
    speed = gearbox.values["dynamics"]["speed_rpm"]
    frequency = 2.0 * np.pi * mesh_frequency(model.machine.layout, speed)
    integrator = make_integrator(model.system, frequency, STEP_TOLERANCE)
    reduction = model.reduction if hasattr(model, "reduction") else model.reduced
    random, basis, linear = np.random.default_rng(1), reduction.basis, model.machine.linear

    def aside(size: float) -> Any:
        """A random state (2, n) by phase whose largest mesh deflection is `size` length scales."""
        bodies = random.normal(size=(2, len(basis)))
        state = np.array([basis.T @ linear.momentum(row) for row in bodies])
        return state * (size * model.system.scale / np.abs(state @ model.system.mesh_jacobian.T).max())

    start, ends = integrator.by_phase(static_start(model)), {}
    start[0] -= _neutral_part(model.system, start[0])
    for size in (0.0, 0.3, 1.0):
        tangents = np.array([aside(1.0) for _ in range(2)])
        run = integrator.run(start + aside(size), 1, tangents, samples=16)
        ends[f"{size:g}"] = {
            "state": run.ends[0] @ basis.T,
            "tangents": run.tangents @ basis.T,
            "samples": run.samples @ basis.T,
            "fractions": run.fractions[:, : integrator.contacts],
        }
    return ends


def _machine(gearbox: Any) -> Any:
    """Lumped machine of a gearbox; the baseline makes it of the inputs of its stage."""
    try:
        outputs = import_module("facegear.door.outputs")
    except ModuleNotFoundError:
        chain, store = from_facegear("Chain", "Store")
        inputs = chain(gearbox.values, store()).arguments("dynamics_response")
        wired_machine = import_module("facegear.config.machines").wired_machine
        names = {"section": "transmission", "teeth": "teeth", "stiffness": "harmonics"}
        names |= {name: name for name in ("friction", "law", "poses", "bodies") if name in inputs}
        values = {argument: inputs[name] for argument, name in names.items()}
        convert = import_module("facegear.config.arguments").typed_arguments
        return wired_machine(**convert(wired_machine, values))
    return outputs.machine_of(gearbox)


def _neutral_part(system: Any, displacement: Any) -> Any:
    """Part of a displacement (n,) that no spring feels, such as a turn of all bodies together.

    Statics leaves it where the search happens to end: any is an equilibrium, and rounding over the softest
    tie of the search decides it to 1e-11 m.
    """
    import numpy as np

    springs = np.concatenate([system.mesh_jacobian, np.diag((system.omega_squared > 0.0).astype(float))])
    # rows of one length: else rounding of the stiffest turns the neutral direction by 1e-11
    springs = springs / np.maximum(np.linalg.norm(springs, axis=1, keepdims=True), NEUTRAL)
    _, stretch, directions = np.linalg.svd(springs)
    neutral = directions[np.pad(stretch, (0, len(directions) - len(stretch))) <= NEUTRAL * stretch[0]]
    return neutral.T @ (neutral @ displacement)


def _oscillators(count: int, sources: str) -> dict[str, Any]:
    """Classes of random oscillators from their starts alone, and where they hold under second looks."""
    from dataclasses import replace

    sys.path.append(sources)
    from validation.dynamics.oscillators import random_oscillators

    settings, steady_state = from_facegear("Settings", "steady_state")
    looks = {"label": settings(), "second_look": replace(settings(), second_looks=SECOND_LOOKS)}
    oscillators = list(random_oscillators(count))
    return {
        name: [steady_state(body.system, body.speed, look, body.start).label for body in oscillators]
        for name, look in looks.items()
    }


def _largest_memory() -> float:
    """Largest memory of this process, MB; `resource` would count that of the process it was started by."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(float(line.split()[1]) / 1024.0 for line in lines if line.startswith("VmHWM:"))


def _write(path: Path, content: Any) -> None:
    """Write all columns and arrays into an npz file without Python objects."""
    import numpy as np

    with path.open("wb") as file:
        np.savez(file, **flat(content))


def flat(content: Any, name: str = "") -> dict[str, Any]:
    """Return all columns and arrays of what a stage gave, by the name under which they stand in it.

    Parameters
    ----------
    content : Any
        Tables, arrays, numbers and texts in mappings and lists.
    name : str
        Beginning of all names.

    Returns
    -------
    dict
        Arrays of numbers or texts, of any shape and unit.
    """
    if hasattr(content, "columns"):
        return {f"{name}{column}": _plain(content[column].to_numpy()) for column in content.columns}
    if isinstance(content, dict):
        parts = [flat(value, f"{name}{key}/") for key, value in content.items()]
        return {key: value for part in parts for key, value in part.items()}
    if isinstance(content, list | tuple) and not all(isinstance(item, str) for item in content):
        return flat(dict(enumerate(content)), name)
    return {name.rstrip("/"): _plain(content)}


def _plain(values: Any) -> Any:
    """Array of numbers, or of texts where one of them is none."""
    import numpy as np

    array = np.asarray(values)
    if array.dtype.kind != "O":
        return array
    try:
        return array.astype(float)
    except (TypeError, ValueError):
        return array.astype(str)


if __name__ == "__main__":
    main(*sys.argv[1:])
