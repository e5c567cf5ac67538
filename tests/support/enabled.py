"""The add-on that is enabled in this Blender, by whatever name."""

import functools
import importlib

import bpy


@functools.cache
def package():
    return bpy.types.HOLOMORPH_PT_view3d.__module__.removesuffix(".interface.panel")


def addon(name):
    """One of its modules."""
    return importlib.import_module(f"{package()}.{name}")
