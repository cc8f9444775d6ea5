"""A target runs only the stages it needs."""

import pytest
from projects import ROOT, dry_run, rules_in

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("dry_runs")]


def planned(*arguments):
    """Names of the rules that a first run would execute."""
    done = dry_run(*arguments)
    assert done.returncode == 0, done.stderr
    return rules_in(done.stdout + done.stderr) - {"all"}


def test_modes_need_no_mesh():
    assert planned("results/paper/modal/frequencies.csv") == {"modal"}


def test_contact_alone_needs_no_dynamics_and_no_files_of_meshes():
    assert planned("results/paper/contact/ltca.csv") == {"compliance", "contact"}


def test_given_harmonics_need_no_contact_at_all():
    rules = planned("--configfile", str(ROOT / "config" / "harmonics_only.yaml"))
    assert not {"geometry", "mesh", "compliance", "contact"} & rules
    assert {"modal", "dynamics_response", "load_sharing"} <= rules


@pytest.mark.parametrize(("config", "followed"), [("concentric", True), ("two_pinion", False)])
def test_the_running_machine_is_followed_where_runouts_turn(config, followed):
    rules = planned("--configfile", str(ROOT / "config" / f"{config}.yaml"))
    assert "hunting" in rules and ("following" in rules) is followed


@pytest.mark.parametrize("config", sorted(path.name for path in (ROOT / "config").glob("*.yaml")))
def test_dry_run_of_every_config_is_clean(config):
    done = dry_run("--configfile", str(ROOT / "config" / config))
    assert done.returncode == 0 and "Traceback" not in done.stderr, done.stderr
