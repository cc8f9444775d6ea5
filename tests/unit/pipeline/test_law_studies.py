"""Studies of the mesh law: its other laws are laid over the machine's own."""

from facegear.build.cases import expand_cases
from facegear.build.load import load_config
from facegear.pipeline.contact_studies import law_figures, law_labels, other_laws
from facegear.pipeline.stage import Case


def case_of(name):
    cases = expand_cases(load_config(f"config/{name}.yaml"))
    return Case(cases[name], cases)


def test_the_concentric_machine_is_set_beside_itself_with_a_constant_stiffness():
    case = case_of("concentric")
    assert other_laws(case) == [{"case": "concentric/studies/mesh_law/constant_stiffness"}]
    assert law_labels(case) == ["load-dependent", "constant stiffness"]
    assert law_figures(case) == ["law_loads", "law_sweeps"]


def test_studies_of_other_things_compare_no_laws():
    assert other_laws(case_of("paper_likely")) == []
    assert law_figures(case_of("tolerances")) == ["law_loads"]
