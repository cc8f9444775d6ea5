"""A target runs only the stages it needs."""

import pytest
from projects import ROOT, Project

pytestmark = pytest.mark.workflow


def test_modes_need_no_mesh(tmp_path):
    planned = Project(tmp_path).planned("results/paper/modal/frequencies.csv")
    assert planned == {"modal"}


def test_contact_alone_needs_no_dynamics_and_no_files_of_meshes(tmp_path):
    assert Project(tmp_path).planned("results/paper/contact/ltca.csv") == {"compliance", "contact"}


def test_given_harmonics_need_no_contact_at_all(tmp_path):
    config = str(ROOT / "config" / "harmonics_only.yaml")
    planned = Project(tmp_path).planned("--configfile", config)
    assert not {"geometry", "mesh", "compliance", "contact"} & planned
    assert {"modal", "dynamics_response", "load_sharing"} <= planned


@pytest.mark.parametrize(("config", "followed"), [("concentric", True), ("two_pinion", False)])
def test_the_running_machine_is_followed_where_runouts_turn(tmp_path, config, followed):
    planned = Project(tmp_path).planned("--configfile", str(ROOT / "config" / f"{config}.yaml"))
    assert "hunting" in planned and ("following" in planned) is followed


@pytest.mark.parametrize("config", sorted(path.name for path in (ROOT / "config").glob("*.yaml")))
def test_dry_run_of_every_config_is_clean(tmp_path, config):
    done = Project(tmp_path).run("-n", "--configfile", str(ROOT / "config" / config))
    assert "Traceback" not in done.stderr
    assert not list((tmp_path / "results").rglob("*.csv")) if (tmp_path / "results").exists() else True
