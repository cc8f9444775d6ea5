"""Material cards name their source, and mistakes in them are reported by key."""

import pytest

from facegear.build.strength import material_card
from facegear.errors import ConfigErrors
from facegear.schema.base import parse
from facegear.schema.cards import CARDS
from facegear.schema.strength import BodyStrength


@pytest.mark.parametrize("path", sorted(CARDS.glob("*.yaml")), ids=lambda path: path.stem)
def test_every_card_of_the_package_is_readable_and_names_its_source(path):
    card = material_card(path)
    assert card.source
    assert card.pitting is not None
    assert card.bending is not None
    assert card.bending.life.factor(3e6) == pytest.approx(1.0)


def test_life_factors_that_do_not_fall_are_refused_with_their_key(tmp_path):
    text = (CARDS / "case_carburised_din3990_11.yaml").read_text().replace("[3.0e+6, 1.0]", "[3.0e+6, 2.6]")
    (tmp_path / "card.yaml").write_text(text)
    with pytest.raises(ConfigErrors, match=r"bending\.life"):
        material_card(tmp_path / "card.yaml")


def test_an_unknown_material_is_refused_with_the_names_of_those_there_are():
    """The file that there is none of was named, by the path of the installed package."""
    names = ", ".join(sorted(path.stem for path in CARDS.glob("*.yaml")))
    with pytest.raises(ConfigErrors, match=rf'card = "cheese": must be one of {names}$'):
        parse(BodyStrength, {"card": "../config/cheese", "root_roughness_um": 16}, source="strength.pinion")
