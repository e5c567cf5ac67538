# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports packages from folders, in a checkout and in the zip for Blender before 4.2: extensions do without."""

import importlib.util
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
PACKAGE = "holomorph_headless"  # the name under which programs load the add-on that they lie in


def module(name):
    """One of the add-on's modules, whether or not the add-on is installed and enabled in this Blender."""
    if PACKAGE not in sys.modules:
        _imported(PACKAGE, HERE)
    return importlib.import_module(f"{PACKAGE}.{name}")


def find(name, tag):
    """The package of this name, built for a tag such as ``cp311``; None where there is none."""
    built = Path("lib", tag, name)
    entries = [Path(entry) for entry in sys.path if Path(entry).is_absolute()]  # not the current folder: of assets
    folders = [HERE / built, HERE.parent / "build" / built, *(entry / name for entry in entries)]
    found = (one for one in folders if (one / "__init__.py").is_file() and any(one.glob("_native*")))
    folder = next(found, None)
    return None if folder is None else _imported(name, folder)


def _imported(name, folder):
    """Under that name, wherever it lies; ``sys.path`` stays as it is."""
    spec = importlib.util.spec_from_file_location(
        name, folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    package = importlib.util.module_from_spec(spec)
    _drop(name)
    sys.modules[name] = package
    try:
        spec.loader.exec_module(package)
    except ImportError:
        _drop(name)
        raise
    return package


def _drop(name):
    for one in [n for n in sys.modules if n == name or n.startswith(name + ".")]:
        del sys.modules[one]
