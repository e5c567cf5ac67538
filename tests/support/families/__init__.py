"""Meshes whose topology, and sometimes whose conformal structure, is known before anything is computed.

Each is a `Mesh`: polygons as arrays, with the genus and the number of boundary loops of every component.
"""

# ruff: noqa: F403
from families.changed import *
from families.handles import *
from families.holes import *
from families.mesh import *
from families.spheres import *
from families.tori import *
