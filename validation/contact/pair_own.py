"""Our solution of the pair cut out, in a process of its own, so that its time and memory can be measured.

`python -m validation.contact.pair_own FOLDER` reads what `solve` was asked for there and writes its answer.
"""

import json
import os
import pickle
import sys
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from facegear.arrays import Array
from facegear.contact.bodies.compliance import FlankCompliance, flank_compliance
from facegear.contact.flanks import flank_pair
from facegear.contact.options import Element, Refinement
from facegear.contact.pressure import flank_pressure
from facegear.contact.root_gauges import RootGauges, root_gauges
from facegear.contact.teeth import ContactSide, elastic_tooth
from facegear.errors import FacegearError
from facegear.teeth.design import Material
from facegear.teeth.tooth_mesh import FeTooth
from validation.contact.pair_bodies import PairBodies, along, largest_inside
from validation.contact.process import ProcessResult, run_alone
from validation.contact.sector_model import SectorPair

REQUEST, ANSWER = "asked.pickle", "answer.json"
"""Names of the files of request and answer."""


@dataclass(frozen=True)
class PairRequest:
    """A pair under a torque (N m), its flank layers cut by `refinement`, its elements as `element`."""

    pair: PairBodies
    torque: float
    refinement: Refinement
    element: Element


@dataclass(frozen=True)
class Answer:
    """Result of a program for the pair under its torque (N m).

    Turn (rad) of the pinion; largest `pressure` (Pa) on its flank in the middle of the contact line, and
    largest tension (Pa) at both fillets; `path`, the middle of the contact forces along the pinion's axis
    (m); `exponent` of the torque as a power of the turn, nan where the program does not say.
    """

    torque: float
    turn: float
    pressure: float
    pinion_root: float
    gear_root: float
    path: float
    exponent: float = np.nan


@dataclass(frozen=True, eq=False)
class _OwnBody:
    """A tooth's contact surface, compliance and gauges."""

    side: ContactSide
    compliance: FlankCompliance
    gauges: RootGauges

    def root(self, body: str, force: Array) -> float:
        """Largest tension (Pa) by forces (n,) N on the nodes of the flank before refinement."""
        stress = -(self.compliance.readings[0] @ force).reshape(self.gauges.position.shape[:3])[0]
        return largest_inside(stress, along(body, self.gauges.position[0]))


def solve(folder: Path, request: PairRequest, threads: int) -> tuple[Answer, ProcessResult]:
    """Solve in a process of its own.

    Parameters
    ----------
    folder : Path
        Folder of the process's files.
    request : PairRequest
        The pair, its torque and mesh.
    threads : int
        Number of threads.

    Returns
    -------
    tuple[Answer, ProcessResult]
        Answer and costs.

    Raises
    ------
    FacegearError
        If the process fails.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / REQUEST).write_bytes(pickle.dumps(request))
    root = Path(__file__).parents[2]
    names = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    environment = os.environ | dict.fromkeys(names, str(threads)) | {"PYTHONPATH": str(root)}
    command = (sys.executable, "-m", "validation.contact.pair_own", str(folder.resolve()))
    process = run_alone(command, root, folder / "own.log", environment, 3600.0)
    if process.code != 0:
        raise FacegearError(f"our own solution failed: see {folder / 'own.log'}")
    return Answer(**json.loads((folder / ANSWER).read_text(encoding="ascii"))), process


def own_answer(request: PairRequest) -> Answer:
    """Solve the contact of the pair's flanks, and the stress at its fillets by the forces on them.

    Parameters
    ----------
    request : PairRequest
        The pair, its torque and mesh.

    Returns
    -------
    Answer
        The answer.
    """
    pair = request.pair
    pinion, gear = (
        _own_body(request, tooth, material)
        for tooth, material in zip(pair.teeth.values(), pair.materials, strict=True)
    )
    cuts = request.refinement
    flanks = flank_pair(pair.design, (pinion.side, gear.side), (cuts, cuts), request.element != "hex27")
    blocks = ({(0, 0): body.compliance.loaded_tooth} for body in (pinion, gear))
    result = SectorPair(flanks, *blocks).solve(pair.position, (request.torque,))[0]
    (spot,) = result.spots
    flank = flank_pressure([result], flanks, pair.materials)
    (load,) = flank.loads
    pressure = load.pressure[pair.is_in_middle(flank.lines.y[load.plane])].max()
    return Answer(
        torque=request.torque,
        turn=result.ste / pair.design.normal_arm,
        pressure=float(pressure),
        pinion_root=pinion.root("pinion", spot.on_pinion),
        gear_root=gear.root("face_gear", spot.on_gear),
        path=float(np.average(pair.contact_nodes()[..., 1].ravel(), weights=spot.on_pinion)),
        exponent=result.k_local / result.k_average,
    )


def _own_body(request: PairRequest, tooth: FeTooth, material: Material) -> _OwnBody:
    elastic, side = elastic_tooth(request.pair.design, tooth, material)
    gauges, rows = root_gauges(tooth, material)
    is_fixed = elastic.is_held.copy()
    nowhere = np.zeros(0, dtype=np.int64)
    is_fixed[np.union1d(elastic.left, elastic.right)] = True
    cut_out = replace(elastic, is_held=is_fixed, left=nowhere, right=nowhere)
    compliance = flank_compliance(cut_out, request.refinement, element=request.element, gauges=rows)
    return _OwnBody(side, compliance, gauges)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    answer = own_answer(pickle.loads((folder / REQUEST).read_bytes()))
    (folder / ANSWER).write_text(json.dumps(asdict(answer)), encoding="ascii")
