"""Fixtures for the tests inside Blender: the add-on registered from the checkout, and an empty scene for each test.

Everything is unregistered at the end: the Python modules of Blender 4.2 and 4.5 crash or hang at exit otherwise.
"""

import importlib
import importlib.util
import sys
from pathlib import Path

import bpy
import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = "holomorph_addon"
sys.path.insert(0, str(Path(__file__).resolve().parent))


def load_addon():
    spec = importlib.util.spec_from_file_location(
        PACKAGE, ROOT / "addon" / "__init__.py", submodule_search_locations=[str(ROOT / "addon")]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = package
    spec.loader.exec_module(package)
    return package


ADDON = load_addon()  # the tests import its modules by name


@pytest.fixture(scope="session", autouse=True)
def addon():
    package = ADDON
    package.register()
    yield package
    package.unregister()


@pytest.fixture(autouse=True)
def empty_scene(addon):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    module("solving.cache").clear()


def module(name):
    """One of the add-on's modules."""
    return importlib.import_module(f"{PACKAGE}.{name}")


@pytest.fixture
def kept_solves():
    """Solves are kept when the file is opened again: their times are in the reports."""
    forget = module("operators.mapping")._forget_solves
    bpy.app.handlers.load_pre.remove(forget)
    yield
    bpy.app.handlers.load_pre.append(forget)
