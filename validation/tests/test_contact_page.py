"""The numbers of three programs on one pair, on the page about contact and as references."""

from pathlib import Path

import pandas as pd
import pytest
from references import against, agrees

from validation.contact.family_peer import CONFIGS, KRATOS_LEVELS, LEVELS, family_pair
from validation.contact.pair_peer import CLOSE
from validation.contact.refinement_levels import CUTS, DEFAULT, FINEST, LINEAR, SECTORS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "explanation" / "contact.md").read_text()
MEASURED = ROOT / "docs" / "measured"
PEERS = ("CalculiX", "Kratos")


def pair_table():
    return pd.read_csv(MEASURED / "pair_peer.csv")


def by_program(name):
    """Rows of a program, by mesh."""
    table = pair_table()
    return table[table["program"].str.startswith(name)].set_index("level")


def family_table():
    return pd.read_csv(MEASURED / "family_peer.csv")


def of_kind(kind, program):
    """Row of a kind of teeth and a program on its finest mesh, and that of ours on the same one.

    Kratos' mesh is compared with ours of the same elements.
    """
    rows = family_table().query("teeth == @kind")
    found = rows[rows["program"].str.startswith(program)].iloc[-1]
    same = "facegear, 8" if program == "Kratos" else "facegear, strip"
    ours = rows[rows["program"].str.startswith(same) & (rows["level"] == found["level"])]
    return found, ours.iloc[0]


def pair_rows(table):
    for one in table.itertuples():
        numbers = (
            (one.stiffness_n_per_um, one.stiffness_error_percent, ".1f"),
            (one.pressure_mpa, one.pressure_error_percent, ".0f"),
            (one.pinion_root_mpa, one.pinion_root_error_percent, ".1f"),
            (one.gear_root_mpa, one.gear_root_error_percent, ".1f"),
        )
        cells = [f"{value:{form}} ({error:+.1f} %)" for value, error, form in numbers]
        costs = f"{one.cpu_seconds:.0f} | {one.memory_gb:.2f}"
        kind = f"{one.teeth} | " if "teeth" in table else ""
        yield f"| {kind}{one.program} | {one.level} | {1e-3 * one.dof:.0f} | {' | '.join(cells)} | {costs} |"


def levels():
    """Rows of a level: its largest errors of all torques (percent), and what it costs."""
    table = pd.read_csv(MEASURED / "contact.csv")
    errors = table.set_index("level")[["mean_error_percent", "amplitude_1_error_percent"]]
    found = table.groupby("level").first()
    found[["mean", "first"]] = errors.abs().groupby("level").max()
    return found


def percent(value):
    """Two digits of an error in percent."""
    return f"{value:.{2 if value < 0.995 else 1 if value < 9.95 else 0}f} %"


def level_rows():
    for level, one in levels().loc[list(CUTS)].iterrows():
        resolution, cuts = level.split("_")
        name = f"{resolution} {cuts.replace('x', ' x ')}"
        name = {DEFAULT: f"**{name}** (default)", FINEST: f"{name}, the finest"}.get(level, name)
        errors = " | " if level == FINEST else f" {percent(one['mean'])} | {percent(one['first'])} "
        steps = " + ".join(f"{one[f'{step}_s']:.1f}" for step in ("assembly", "factorisation", "compliance"))
        yield (
            f"| {name} | {1e-6 * one['dof']:.2f} M |{errors}| {steps} + {one['contact_s']:.2f} | "
            f"{one['total_s']:.1f} | {one['memory_gb']:.1f} |"
        )


def simpler_rows():
    """Two levels a row: sectors, then elements with fewer nodes."""
    found = levels()
    for texts, pair in (("5-tooth sectors / 9", SECTORS), ("8-node hexahedra / tetrahedra", LINEAR)):
        both = found.loc[list(pair)]
        errors = (" / ".join(percent(value) for value in both[name]) for name in ("mean", "first"))
        seconds = " / ".join(f"{value:.1f}" for value in both["total_s"])
        dof, memory = 1e-6 * both["dof"].max(), both["memory_gb"].max()
        yield (
            f"| coarse 3 x 1 x 2, {texts} | {dof:.2f} M | {' | '.join(errors)} | | {seconds} | {memory:.1f} |"
        )


@pytest.mark.parametrize("message", [*level_rows(), *simpler_rows()])
def test_a_row_about_a_resolution_is_the_stored_measurement(message):
    assert message in PAGE


def test_the_time_of_a_contact_on_the_page_is_the_stored_one():
    seconds = levels().loc[DEFAULT, "contact_s_per_position_and_load"]
    assert f"{1e3 * seconds:.1f} ms a position and torque" in PAGE


@pytest.mark.parametrize("message", [*pair_rows(pair_table()), *pair_rows(family_table())])
def test_a_row_about_the_pair_is_the_stored_measurement(message):
    assert message in PAGE


def test_all_programs_carry_the_torque_that_the_page_names():
    table = pair_table()
    assert (table["torque_n_m"] / 189.0 - 1.0).abs().max() < CLOSE
    assert set(table["level"]) == {"medium", "fine"} and len(table) == 9


@against(
    "third-party program",
    "CalculiX, and Kratos with 8-node elements (docs/measured/pair_peer.csv, `make peers`)",
    capability="contact compliance",
    module="facegear.contact.position",
)
def test_two_other_programs_find_our_stiffness_and_pressure_where_the_mesh_sees_the_strip():
    ours = by_program("facegear, strip").loc["fine"]
    for peer, same in (("CalculiX", ours), ("Kratos", by_program("facegear, 8").loc["fine"])):
        found = by_program(peer).loc["fine"]
        stiffness, pressure = (
            f"{name} by {peer}" for name in ("stiffness, N/um,", "largest pressure, N/mm2,")
        )
        agrees(stiffness, same["stiffness_n_per_um"], found["stiffness_n_per_um"], relative=5e-3)
        agrees(pressure, ours["pressure_mpa"], found["pressure_mpa"], relative=2e-2)


@against(
    "third-party program",
    "CalculiX, and Kratos with 8-node elements (docs/measured/pair_peer.csv, `make peers`)",
    capability="root_stress",
    module="facegear.contact.root_gauges",
)
def test_two_other_programs_find_our_root_stress_under_the_same_contact():
    for peer, same in (("CalculiX", "facegear, strip"), ("Kratos", "facegear, 8")):
        found, ours = by_program(peer).loc["fine"], by_program(same).loc["fine"]
        for column in ("pinion_root_mpa", "gear_root_mpa"):
            agrees(f"{column} by {peer}", ours[column], found[column], relative=5e-3)


def test_the_distance_of_both_peers_falls_with_the_mesh():
    for peer in PEERS:
        rows = by_program(peer)
        for name in ("stiffness", "pressure", "pinion_root", "gear_root"):
            assert abs(rows.loc["fine", f"{name}_error_percent"]) < abs(
                rows.loc["medium", f"{name}_error_percent"]
            )


@pytest.mark.parametrize("kind", CONFIGS)
def test_all_programs_carry_the_torque_of_the_pair_of_other_teeth(kind):
    torque = family_pair(kind).torque
    rows = family_table().query("teeth == @kind")
    assert (rows["torque_n_m"] / torque - 1.0).abs().max() < CLOSE
    assert len(rows) == 1 + 3 * len(LEVELS) + len(KRATOS_LEVELS)


@against(
    "third-party program",
    "CalculiX, and Kratos with 8-node elements (docs/measured/family_peer.csv, `make peers`)",
    capability="contact compliance",
    module="facegear.contact.position",
)
@pytest.mark.parametrize("peer", PEERS)
@pytest.mark.parametrize("kind", CONFIGS)
def test_two_other_programs_find_stiffness_and_pressure_of_helical_and_tapered_teeth(kind, peer):
    found, ours = of_kind(kind, peer)
    for column, name, unit, relative in (
        ("stiffness_n_per_um", "stiffness", "N/um", 1e-2),
        ("pressure_mpa", "pressure", "N/mm2", 2e-2),
    ):
        agrees(f"{name} of {kind} teeth by {peer}, {unit}", ours[column], found[column], relative=relative)


@against(
    "third-party program",
    "CalculiX, and Kratos with 8-node elements (docs/measured/family_peer.csv, `make peers`)",
    capability="root_stress",
    module="facegear.contact.root_gauges",
)
@pytest.mark.parametrize("peer", PEERS)
@pytest.mark.parametrize("kind", CONFIGS)
def test_two_other_programs_find_the_root_stress_of_helical_and_tapered_teeth(kind, peer):
    found, ours = of_kind(kind, peer)
    for column in ("pinion_root_mpa", "gear_root_mpa"):
        agrees(f"{column} of {kind} teeth by {peer}", ours[column], found[column], relative=2e-2)
