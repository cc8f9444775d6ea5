"""The quick case, computed once for all workflow tests."""

import pytest
from projects import ROOT, Project


@pytest.fixture(scope="session")
def quick(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """The quick case, computed once: every stage from teeth to load sharing, at coarse resolution."""
    project = Project(tmp_path_factory.mktemp("quick"))
    project.run("--configfile", str(ROOT / "config" / "quick.yaml"))
    return project


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Tests of the quick case go to one process, which computes it once."""
    for item in items:
        if "quick" in getattr(item, "fixturenames", ()) and item.get_closest_marker("xdist_group") is None:
            item.add_marker(pytest.mark.xdist_group("workflow"))
