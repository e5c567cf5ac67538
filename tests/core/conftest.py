"""The package, and fixtures for the shared data."""

import pytest
from repository import find_package
from shared_data import shared_folder

find_package()


@pytest.fixture(scope="session")
def meshes():
    """The folder of real meshes, which is not part of the project."""
    return shared_folder("meshes")


@pytest.fixture(scope="session")
def reference():
    """The folder of exact values, which is not part of the project."""
    return shared_folder("reference")
