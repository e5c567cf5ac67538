# SPDX-License-Identifier: GPL-3.0-or-later
"""What of a mesh is under the pointer in a 3D view: the pole nearest to it, and a vertex of the surface."""

import bmesh
import numpy as np
from bpy_extras import view3d_utils
from mathutils import Vector
from mathutils.bvhtree import BVHTree

REACH = 18  # pixels around a pole, in a user interface of normal size


class View:
    """The 3D view of an area; positions on the screen are those of the window."""

    def __init__(self, area):
        self.region = next(region for region in area.regions if region.type == "WINDOW")
        self.region_3d = area.spaces.active.region_3d

    def contains(self, x, y):
        region = self.region
        return 0 <= x - region.x < region.width and 0 <= y - region.y < region.height

    def on_screen(self, point):
        """Where a point in space is seen, or None."""
        seen = view3d_utils.location_3d_to_region_2d(self.region, self.region_3d, Vector(point))
        return None if seen is None else (seen.x + self.region.x, seen.y + self.region.y)

    def ray(self, x, y):
        """Origin and direction in space."""
        place = x - self.region.x, y - self.region.y
        origin = view3d_utils.region_2d_to_origin_3d(self.region, self.region_3d, place)
        return origin, view3d_utils.region_2d_to_vector_3d(self.region, self.region_3d, place)


def nearest(view, points, x, y, reach):
    """Index of the point that is seen nearest to (x, y) within `reach` pixels, or None."""
    seen = [view.on_screen(point) for point in points]
    distances = [np.inf if place is None else np.hypot(place[0] - x, place[1] - y) for place in seen]
    index = int(np.argmin(distances)) if distances else 0
    return index if distances and distances[index] <= reach else None


class Surface:
    """The faces of an object's own mesh, without modifiers."""

    def __init__(self, obj):
        faces = bmesh.new()
        faces.from_mesh(obj.data)
        self._tree = BVHTree.FromBMesh(faces)
        faces.free()
        self._mesh, self._matrix = obj.data, obj.matrix_world.copy()

    def vertices_at(self, origin, direction):
        """Vertices of the first face along a ray in space, the nearest to where it meets it first; none beside it."""
        inverse = self._matrix.inverted_safe()
        start = inverse @ origin
        place, _, face, _ = self._tree.ray_cast(start, inverse.to_3x3() @ direction)
        if place is None:
            return []
        vertices = list(self._mesh.polygons[face].vertices)
        return sorted(vertices, key=lambda v: (self._matrix @ self._mesh.vertices[v].co - self._matrix @ place).length)
