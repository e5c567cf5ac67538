"""A recipe, a library of small meshes, and its results."""

import pytest
from batch_runs import BALANCED, library, outputs, run


@pytest.fixture
def recipe(tmp_path):
    path = tmp_path / "recipe.toml"
    path.write_text(BALANCED)
    return path


@pytest.fixture(scope="session")
def meshes(tmp_path_factory):
    return library(tmp_path_factory.mktemp("library"))


@pytest.fixture(scope="session")
def undisturbed(meshes, tmp_path_factory):
    """The results of `meshes` where nothing happens."""
    folder = tmp_path_factory.mktemp("undisturbed")
    (folder / "recipe.toml").write_text(BALANCED)
    result = run(meshes, "--out", folder / "out", "--recipe", folder / "recipe.toml", "--workers", 1)
    assert result.returncode == 0, result.stderr
    return outputs(folder / "out")
