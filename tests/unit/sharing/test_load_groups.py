from dataclasses import replace

from facegear.machine.layout import Role
from facegear.sharing.groups import GroupKind, load_groups, split_groups


def test_paper_layout_has_two_inputs_and_the_lower_meshes_of_three_idlers(paper_machine):
    layout = paper_machine.layout
    groups = {group.name: [layout.mesh_names[m] for m in group.meshes] for group in load_groups(layout)}
    assert groups == {
        "right input": ["right input/lower", "right input/upper"],
        "left input": ["left input/lower", "left input/upper"],
        "idlers": ["tail idler/lower", "right idler/lower", "left idler/lower"],
    }


def test_pinions_on_a_single_gear_split_no_load(paper_machine):
    layout = paper_machine.layout
    single = replace(layout, gears=layout.gears[1:])
    groups = load_groups(single)
    assert [(group.kind, len(group.meshes)) for group in groups] == [
        (GroupKind.INDEPENDENT, 2),
        (GroupKind.INDEPENDENT, 3),
    ]
    assert split_groups(single) == ()


def test_a_single_pinion_shares_with_nobody(paper_machine):
    layout = paper_machine.layout
    alone = replace(layout, pinions=layout.pinions[2:3], gears=layout.gears[1:])
    assert alone.pinions[0].role is Role.INPUT
    assert load_groups(alone) == ()
