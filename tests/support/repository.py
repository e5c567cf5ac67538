"""Where the repository is, the modules that its tests share, and the data beside it."""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SUPPORT = Path(__file__).resolve().parent
SHARED = ROOT.parent / "shared"  # not part of the project
VERSION = re.search(r'(?m)^version = "(.+)"$', (ROOT / "pyproject.toml").read_text(encoding="utf-8"))[1]


def find_package():
    """Where the package is not installed, what scripts/build leaves for this Python is taken."""
    try:
        import holomorph  # noqa: F401
    except ModuleNotFoundError:
        sys.path.insert(0, str(ROOT / "build" / "lib" / f"cp{sys.version_info.major}{sys.version_info.minor}"))
