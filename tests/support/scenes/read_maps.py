"""What can be read off meshes and their maps."""

import importlib
import json

import numpy as np

uv_maps = importlib.import_module("holomorph_addon.scene.uv_maps")
mesh_io = importlib.import_module("holomorph_addon.scene.mesh_io")
report = importlib.import_module("holomorph_addon.results.report")
native = importlib.import_module("holomorph_addon.native")


def uv(obj, name="Holomorphic"):
    return uv_maps.read_map(obj.data, name).astype(np.float64)


def stored_poles(obj):
    """Vertices."""
    vertices, kinds = report.points(obj)
    return vertices[kinds == report.POLE].tolist()


def stored_report(obj):
    return json.loads(obj["holomorph_report"])


def polygon_arrays(mesh):
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    starts = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    return corners, np.append(starts, len(corners))


def next_corner(offsets):
    following = np.arange(1, offsets[-1] + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    return following


def shown_scale(obj):
    """The checker's squares per UV unit."""
    return obj.material_slots[0].material.node_tree.nodes["Checker Scale"].outputs[0].default_value


def edge_sides(obj):
    """((n, 2) vertices of inner edges, (n, 2, 2) UVs of their first face at these, and of their second one)."""
    corners, offsets = polygon_arrays(obj.data)
    following, values = next_corner(offsets), uv(obj)
    start, end = np.arange(len(corners)), following
    is_down = corners[start] > corners[end]
    ends = np.where(is_down[:, None], np.stack([end, start], 1), np.stack([start, end], 1))  # lower vertex first
    pairs = corners[ends].astype(np.int64)
    order = np.lexsort(pairs.T)
    same = np.flatnonzero((pairs[order][1:] == pairs[order][:-1]).all(axis=1))
    return pairs[order[same]], values[ends[order[same]]], values[ends[order[same + 1]]]


def edge_jumps(obj):
    """((n, 2) vertices of inner edges, (n, 2, 2) differences of the UVs of their two faces at each of these)."""
    vertices, first, second = edge_sides(obj)
    return vertices, second - first


def turned_jumps(obj, turns):
    """(n,) turns in whole k-th parts, the translations that are left over, and by how much these differ between both
    ends, of each edge of `edge_sides`: x' = R x + t."""
    _, *sides = edge_sides(obj)
    near, far = (side.astype(float) @ [1, 1j] for side in sides)
    turn = np.exp(2j * np.pi / turns) ** np.arange(turns)
    turn = np.array([1, 1j, -1, -1j])[:: 4 // turns] if turns in (2, 4) else turn
    left = far[:, :, None] - turn * near[:, :, None]
    off = np.abs(left[:, 0] - left[:, 1])
    which = np.argmin(off, axis=1)
    rows = np.arange(len(which))
    return which, left[rows, 0, which], off[rows, which]


def face_densities(obj):
    """(#F,) UV area per surface area, signed."""
    _, offsets = polygon_arrays(obj.data)
    values, following = uv(obj), next_corner(offsets)
    cross = values[:, 0] * values[following, 1] - values[following, 0] * values[:, 1]
    areas = np.empty(len(obj.data.polygons), np.float32)
    obj.data.polygons.foreach_get("area", areas)
    return np.add.reduceat(cross, offsets[:-1]) / 2 / areas


def signed_area(mesh, values):
    """Integral of du dv over the polygons, by the shoelace formula."""
    _, offsets = polygon_arrays(mesh)
    following = next_corner(offsets)
    return 0.5 * np.sum(values[:, 0] * values[following, 1] - values[following, 0] * values[:, 1])


def fills_the_square(values, density=1.0):
    """Whether the box of the UVs has its middle at that of the UV square and the square's size times `density`."""
    low, high = values.min(axis=0), values.max(axis=0)
    return np.allclose((low + high) / 2, 0.5, atol=1e-6) and abs((high - low).max() - density) < 1e-5 * density


def edge_mismatch(mesh, values):
    """Largest difference of the two UV vectors of an edge, over the median UV edge; and what float32 forgives."""
    corners, offsets = polygon_arrays(mesh)
    following = next_corner(offsets)
    start, end = corners, corners[following]
    vector = values[following] - values
    vector[start > end] *= -1
    key = np.minimum(start, end).astype(np.int64) * len(mesh.vertices) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    assert np.array_equal(key[order][::2], key[order][1::2]), "a closed surface"
    difference = np.abs(vector[order][::2] - vector[order][1::2]).max()
    median = np.median(np.linalg.norm(vector, axis=1))
    forgiven = max(1e-4 * median, 4e-7 * np.ptp(values, axis=0).max())
    return difference, forgiven


def parts_of(obj):
    """The connected parts of an object as the library numbers them, with `corner_index` into its corners."""
    polygons = mesh_io.read_polygons(obj.data, np.eye(3))
    return polygons.surface(strict=False).components


def boundary_corners(part):
    """(#, 2) polygon corners at the two ends of each boundary edge of a part."""
    following = next_corner(part.face_offsets)
    start, end = part.corner_vertices.astype(np.int64), part.corner_vertices[following].astype(np.int64)
    count = len(part.vertex_index)
    key = np.minimum(start, end) * count + np.maximum(start, end)
    _, place, uses = np.unique(key, return_inverse=True, return_counts=True)
    once = np.flatnonzero(uses[place] == 1)
    return np.stack([once, following[once]], 1)


def straightness(part, values):
    """The largest difference of v along a boundary edge; `values` are at the corners of the part."""
    v = values[boundary_corners(part), 1]
    return np.abs(v[:, 0] - v[:, 1]).max()


def everything(obj):
    """All that belongs to an artist's mesh object, for comparison bit for bit."""
    mesh = obj.data
    corners, offsets = polygon_arrays(mesh)
    positions = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", positions)
    edges = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", edges)
    return {
        "positions": positions.tobytes(),
        "corners": corners.tobytes(),
        "offsets": offsets.tobytes(),
        "edges": edges.tobytes(),
        "seams": mesh_io.read_seams(mesh).tobytes(),
        "maps": {layer.name: uv_maps.read_map(mesh, layer.name).tobytes() for layer in mesh.uv_layers},
        "attributes": sorted((a.name, a.domain, a.data_type) for a in mesh.attributes),
        "materials": [(s.link, s.material) for s in obj.material_slots],
        "properties": sorted(obj.keys()) + sorted(mesh.keys()),
    }
