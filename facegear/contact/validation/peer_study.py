"""CalculiX beside the chain: the same sector on the same mesh, the pinion turned by the same angle."""

import time
from math import pi
from pathlib import Path

import numpy as np
import pandas as pd

from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.candidates import PinionSurface
from facegear.contact.ltca import ContactModel, Place
from facegear.contact.options import ContactOptions, ContactPlan, Refinement, Sector
from facegear.contact.pair import BUILDERS, body_compliance
from facegear.contact.teeth import GearLattice, contact_side
from facegear.contact.validation.calculix import run_deck, write_deck
from facegear.contact.validation.sector_model import analyse_sector, sector_blocks
from facegear.geometry.design import Material, PairDesign
from facegear.geometry.unloaded import unloaded_contact
from facegear.mesh.sizes import MeshSizes

TEETH = 5
LOADED = (-1, 0, 1, 2)
POSITIONS = (0.0, 0.34, 0.67)
AMORTISED = 128
"""Solutions over which one compliance is shared: 32 positions at 4 loads."""
LOADS = (0.25, 0.5, 0.75, 1.0)
"""Torques solved at a position, parts of the one compared: `seconds` is the time for one of them."""


def peer_study(
    design: PairDesign,
    rungs: dict[str, MeshSizes],
    materials: tuple[Material, Material],
    torque: float,
    folder: Path,
    threads: int,
) -> pd.DataFrame:
    """Torque (N m) that both need for the turn our sector takes under `torque`, with times (s) and memory
    (GB).

    At a given turn torques differ by some 1.3 times what turns do at a given torque (local over average
    stiffness). `seconds` is ours for one solution with its part of the sectors' compliances, which are made
    whole here, as CalculiX is given them; `chain_seconds` with that of the compliances which the chain makes
    of one tooth of the same mesh. `calculix_seconds` is for one run.
    Raises FacegearError if ccx is not installed or fails.
    """
    rows = []
    for name, sizes in rungs.items():
        model, blocks, seconds = _sector(design, sizes, materials)
        chain_seconds = _chain_seconds(design, sizes, materials)
        for position in POSITIONS:
            phi1 = (position - 0.5) * 2 * pi / design.pinion.teeth
            angles = phi1, float(unloaded_contact(design, [phi1]).phi2[0])
            start = time.perf_counter()
            place = Place(position, 0.0, design.pinion_base_radius)
            ours = analyse_sector(model, *blocks, place, angles, [part * torque for part in LOADS])[-1]
            contact_seconds = (time.perf_counter() - start) / len(LOADS)
            own_seconds, usual_seconds = (
                made / AMORTISED + contact_seconds for made in (seconds, chain_seconds)
            )
            turn = ours.ste / design.pinion_base_radius
            deck = folder / f"{name}_{round(100 * position):03d}.inp"
            dof = write_deck(deck, design, sizes, materials, TEETH, angles, turn)
            peer = run_deck(deck, threads, dof)
            rows.append(
                {
                    "rung": name,
                    "position": position,
                    "dof": dof,
                    "torque_n_m": torque,
                    "calculix_torque_n_m": peer.torque,
                    "difference_percent": 100 * (torque / peer.torque - 1),
                    "seconds": own_seconds,
                    "chain_seconds": usual_seconds,
                    "calculix_seconds": peer.seconds,
                    "time_ratio": peer.seconds / own_seconds,
                    "chain_time_ratio": peer.seconds / usual_seconds,
                    "calculix_memory_gb": peer.gigabytes,
                    "calculix_version": peer.version,
                }
            )
    return pd.DataFrame(rows)


def unrefined_model(design: PairDesign, sizes: MeshSizes) -> ContactModel:
    """Surfaces of both gears for sector compliances; its own compliances are empty."""
    sides = [contact_side(design, build(design, sizes)) for build in BUILDERS.values()]
    plain, none = Refinement(), np.zeros((0, 0))
    empty = FlankCompliance(none, none[None], (0, 0), (0, 0), plain)
    return ContactModel(
        design, PinionSurface(design, sides[0], plain), GearLattice(design, sides[1], plain), empty, empty
    )


def _chain_seconds(design, sizes, materials):  # type: ignore[no-untyped-def]
    """Seconds of both compliances of 5-tooth sectors as the chain makes them."""
    plan = ContactPlan((1.0,), 1, Refinement(), Sector(TEETH, TEETH), ContactOptions())
    start = time.perf_counter()
    for body, material in zip(BUILDERS, materials, strict=True):
        body_compliance(design, body, sizes, material, plan)
    return time.perf_counter() - start


def _sector(design, sizes, materials):  # type: ignore[no-untyped-def]
    """Unrefined model of both sectors, their compliance blocks, and the seconds these took."""
    start = time.perf_counter()
    teeth = [build(design, sizes) for build in BUILDERS.values()]
    blocks = [
        sector_blocks(design, tooth, material, TEETH, LOADED)
        for tooth, material in zip(teeth, materials, strict=True)
    ]
    model = unrefined_model(design, sizes)
    # everything that positions share, made now and counted with the compliances
    analyse_sector(model, *blocks, Place(0.5, 0.0, design.pinion_base_radius), (0.0, 0.0), [1.0])
    return model, blocks, time.perf_counter() - start
