"""Meshes for the tests in Blender, and what can be read off them."""

# ruff: noqa: F403
from scenes.objects import *
from scenes.read_maps import *
