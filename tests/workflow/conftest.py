"""The quick case, computed once for all workflow tests."""

import pytest
from projects import ROOT, Project


@pytest.fixture(scope="session")
def quick(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """The quick case, computed once: every stage from teeth to load sharing, at coarse resolution."""
    project = Project(tmp_path_factory.mktemp("quick"))
    project.run("--configfile", str(ROOT / "config" / "quick.yaml"))
    return project
