"""Islands in the UV square: a solid with seams, and the test that none lies on another."""

import bmesh
import bpy
import numpy as np
from scenes import mesh_io, select, uv

FLOAT32 = 1e-5  # part of the UV square


def capped_cylinder(segments=24, fans=False):
    """Radius 1, height 2, its caps n-gons or fans, seams around n-gons and up the side."""
    bm = bmesh.new()
    bmesh.ops.create_cone(bm, cap_ends=True, cap_tris=fans, segments=segments, radius1=1, radius2=1, depth=2)
    for edge in bm.edges:
        edge.seam = any(len(face.verts) > 4 for face in edge.link_faces)
    next(edge for edge in bm.edges if not edge.seam).seam = True
    mesh = bpy.data.meshes.new("Can")
    bm.to_mesh(mesh)
    bm.free()
    obj = bpy.data.objects.new("Can", mesh)
    bpy.context.scene.collection.objects.link(obj)
    select(obj)
    return obj


def whole_surface(obj):
    polygons = mesh_io.read_polygons(obj.data, np.eye(3))
    return polygons.surface()


def overlapping_pairs(triangles):
    """How many pairs of (#T, 3, 2) triangles share more than `FLOAT32`: no line along a side of either separates
    them."""
    first, second = np.triu_indices(len(triangles), 1)
    separated = np.zeros(len(first), bool)
    for sided, one, other in ((triangles, first, second), (triangles, second, first)):
        along = np.roll(sided, -1, axis=1) - sided
        normal = np.stack([along[..., 1], -along[..., 0]], -1) / np.linalg.norm(along, axis=-1, keepdims=True)
        for side in range(3):
            outwards = np.einsum("nj,nkj->nk", normal[one, side], triangles[other] - sided[one, side][:, None])
            inwards = np.einsum("nj,nkj->nk", normal[one, side], triangles[one] - sided[one, side][:, None])
            separated |= outwards.min(axis=1) >= inwards.max(axis=1) - FLOAT32
            separated |= outwards.max(axis=1) <= inwards.min(axis=1) + FLOAT32
    return np.count_nonzero(~separated)


def assert_packed(obj):
    """Every triangle lies in the UV square and apart from every other."""
    values = uv(obj)
    triangles = values[whole_surface(obj).triangle_corners]
    assert overlapping_pairs(triangles) == 0
    assert values.min() > -FLOAT32
    assert values.max() < 1 + FLOAT32
