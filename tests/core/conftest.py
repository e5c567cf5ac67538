"""Where the package and the shared data are."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared"

try:
    import holomorph  # noqa: F401
except ModuleNotFoundError:  # not installed: what scripts/build leaves for this Python
    sys.path.insert(0, str(ROOT / "build" / "lib" / f"cp{sys.version_info.major}{sys.version_info.minor}"))


def shared_folder(name):
    folder = SHARED / name
    if not folder.is_dir():
        pytest.skip(f"no folder ../shared/{name}")
    return folder


@pytest.fixture(scope="session")
def meshes():
    """The folder of real meshes, which is not part of the project."""
    return shared_folder("meshes")


@pytest.fixture(scope="session")
def reference():
    """The folder of exact values, which is not part of the project."""
    return shared_folder("reference")
