"""Fixtures for the tests inside Blender: the add-on registered from the checkout, and an empty scene for each test.

Everything is unregistered at the end: the Python modules of Blender 4.2 and 4.5 crash or hang at exit otherwise.
"""

import tempfile

import bpy
import pytest
from loaded_addon import ADDON, module


@pytest.fixture(scope="session", autouse=True)
def addon():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    ADDON.register()
    yield ADDON
    ADDON.unregister()


@pytest.fixture(scope="session", autouse=True)
def reports(tmp_path_factory):
    """Where reports on errors are written that tests raise."""
    before, tempfile.tempdir = tempfile.tempdir, str(tmp_path_factory.mktemp("reports"))
    yield
    tempfile.tempdir = before


@pytest.fixture(autouse=True)
def empty_scene(addon):
    """With the preferences as they are: to read those anew takes five times as long as the scene."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    module("solving.jobs").KEPT.clear()


@pytest.fixture
def kept_solves():
    """Solves are kept when the file is opened again: their times are in the reports."""
    forget = module("operators.mapping")._forget_solves
    bpy.app.handlers.load_pre.remove(forget)
    yield
    bpy.app.handlers.load_pre.append(forget)
