"""Oils of the package in SI units."""

from facegear.build.lubrication import oil_of
from facegear.schema.base import parse
from facegear.schema.cards import OIL_CARDS, OilCard
from facegear.schema.yaml_file import read_yaml

NAMES = sorted(path.stem for path in OIL_CARDS.glob("*.yaml"))


def oil(name="polyol_ester_5_cst"):
    return oil_of(parse(OilCard, read_yaml(OIL_CARDS / f"{name}.yaml")))
