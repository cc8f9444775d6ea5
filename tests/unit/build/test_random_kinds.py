"""Configs of random teeth over the whole family are built, or refused by a key of their own."""

import re

import numpy as np
import pytest

from facegear.build.tooth_pair import ToothPair, pair_design
from facegear.errors import ConfigErrors
from facegear.schema.base import parse

SEED, DESIGNS, CHUNKS = 54, 300, 10
"""Seed of the random designs, their number, and tests among which they are divided."""
LINE = re.compile(r"([a-z_.0-9\[\]]+) = .*: must ")


def random_section(rng) -> dict:
    """Return the plain values of a pair of any kind, its face about the path of spur teeth; it need not be
    possible.
    """
    module, teeth = rng.uniform(1, 8), int(rng.integers(12, 60))
    gear_teeth = int(teeth * rng.uniform(1.5, 8))
    mild = rng.random() < 0.7
    helix = rng.uniform(-25, 25) if mild else rng.uniform(-45, 45)
    taper = rng.uniform(-6, 6) if mild else rng.uniform(-20, 20)
    shaft = rng.uniform(70, 115) if mild else rng.uniform(20, 160)
    radius = gear_teeth * module / np.cos(np.radians(helix)) / 2
    offset = rng.uniform(-0.15, 0.15) * radius if mild else rng.uniform(-1, 1) * radius
    path = float(np.hypot(radius, offset))
    angles = rng.uniform(15, 30, 2).round(2).tolist()
    return {
        "pinion_teeth": teeth,
        "face_gear_teeth": gear_teeth,
        "module_mm": module,
        "pressure_angle_deg": {"drive": angles[0], "coast": angles[1]} if rng.random() < 0.5 else angles[0],
        "helix_angle_deg": float(rng.choice([0.0, helix])),
        "taper_angle_deg": float(rng.choice([0.0, taper])),
        "shaft_angle_deg": float(rng.choice([90.0, shaft])),
        "offset_mm": float(rng.choice([0.0, offset])),
        "pinion": {
            "width_mm": rng.uniform(3, 10) * module,
            "bore_radius_mm": rng.uniform(0.1, 0.3) * teeth * module,
            "thinning_um": rng.uniform(0, 100) * module,
            "profile_shift_modules": rng.uniform(-0.2, 0.5),
            "rack_tip_radius_modules": float(rng.choice([0.0, 0.1, 0.2])),
            "middle_mm": None if rng.random() < 0.5 else path + rng.uniform(-2, 2) * module,
        },
        "face_gear": {
            "inner_radius_mm": path - rng.uniform(1, 4) * module,
            "outer_radius_mm": path + rng.uniform(1, 4) * module,
            "rim_thickness_mm": 3 * module,
            "addendum_modules": rng.uniform(0.7, 1.0),
        },
        "shaper": {
            "teeth": teeth + int(rng.integers(0, 4)),
            "tip_rounding_modules": float(rng.choice([0.0, 0.1, 0.2])),
        },
        "assembly": {"pinion_axial_um": float(rng.choice([0.0, 100.0]))},
    }


def has_key(section, key: str) -> bool:
    """Whether a dotted key stands in section `tooth_pair`, given or by default."""
    model = ToothPair
    for part in key.split("."):
        fields = getattr(model, "model_fields", None)
        if fields is None or part not in fields:
            return False
        options = [fields[part].annotation, *getattr(fields[part].annotation, "__args__", ())]
        model = next((option for option in options if hasattr(option, "model_fields")), None)
    return True


@pytest.mark.parametrize("chunk", range(CHUNKS))
def test_random_teeth_are_built_or_refused_by_a_key_of_their_own(chunk):
    """300 designs, 30 in each test."""
    rng = np.random.default_rng([SEED, chunk])
    built = 0
    for _ in range(DESIGNS // CHUNKS):
        section = random_section(rng)
        try:
            design = pair_design(parse(ToothPair, section))
        except ConfigErrors as error:
            for line in error.lines:
                match = LINE.match(line)
                assert match and has_key(section, match[1]), line
            continue
        built += 1
        assert design.helix_angle == pytest.approx(np.radians(section["helix_angle_deg"]))
    assert 0 < built < DESIGNS // CHUNKS
