"""Oils of the package in SI units."""

from facegear.config.base import parse
from facegear.config.oil_card import OIL_CARDS, OilCard, oil_of
from facegear.config.yaml_file import read_yaml

NAMES = sorted(path.stem for path in OIL_CARDS.glob("*.yaml"))


def oil(name="polyol_ester_5_cst"):
    return oil_of(parse(OilCard, read_yaml(OIL_CARDS / f"{name}.yaml")))
