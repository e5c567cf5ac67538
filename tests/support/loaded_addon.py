"""The add-on, loaded from the checkout; it is not registered yet."""

import importlib
import importlib.util
import sys

from repository import ROOT

PACKAGE = "holomorph_addon"


def load_addon():
    spec = importlib.util.spec_from_file_location(
        PACKAGE, ROOT / "addon" / "__init__.py", submodule_search_locations=[str(ROOT / "addon")]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = package
    spec.loader.exec_module(package)
    return package


ADDON = load_addon()  # the tests import its modules by name


def module(name):
    """One of the add-on's modules."""
    return importlib.import_module(f"{PACKAGE}.{name}")
