# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports the package ``holomorph`` from a folder: of the zip for Blender before 4.2, of a checkout.

Extensions do not contain this file: Blender installs their wheels. The package is imported under its own name, wherever
it lies, and so written into ``sys.modules``; ``sys.path`` stays as it is.
"""

import importlib.util
import sys
from pathlib import Path


def find(name, tag):
    """The package of this name, built for a tag such as ``cp311``; None where there is none."""
    here, built = Path(__file__).resolve().parent, Path("lib", tag, name)
    entries = [Path(entry) for entry in sys.path if Path(entry).is_absolute()]  # not the current folder: of assets
    folders = [here / built, here.parent / "build" / built, *(entry / name for entry in entries)]
    found = (one for one in folders if (one / "__init__.py").is_file() and any(one.glob("_native*")))
    folder = next(found, None)
    return None if folder is None else _imported(name, folder)


def _imported(name, folder):
    spec = importlib.util.spec_from_file_location(
        name, folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    module = importlib.util.module_from_spec(spec)
    _drop(name)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except ImportError:
        _drop(name)
        raise
    return module


def _drop(name):
    for one in [n for n in sys.modules if n == name or n.startswith(name + ".")]:
        del sys.modules[one]
