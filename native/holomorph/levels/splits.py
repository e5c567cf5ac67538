"""The vertex splits of a progressive mesh as a structured array."""

import numpy as np

SPLIT = np.dtype(
    [
        ("v_s", np.int32),
        ("v_t", np.int32),
        ("v_l", np.int32),
        ("v_r", np.int32),
        ("position", np.float64, 3),
        ("vertex", np.int32),
        ("triangles", np.int32, 2),
        ("slots", np.uint8, 2),
        ("corners", np.int32, (2, 3)),
    ]
)


def structured_splits(native, corners):
    """The splits of a native progressive mesh, as `ProgressiveMesh.splits` describes them.

    corners : (#T, 3) polygon corners of the original at the triangles' corners
    """
    v_s, v_l, v_r = native.split_vertices.T
    splits = np.empty(len(v_s), SPLIT)
    first, count = native.base_vertex_count, len(v_s)
    splits["v_s"], splits["v_l"], splits["v_r"] = v_s, v_l, v_r
    splits["v_t"] = np.arange(first, first + count)
    splits["slots"] = native.split_slots
    splits["position"] = native.positions[first : first + count]
    splits["vertex"] = native.vertex_index[first : first + count]
    present = np.stack([v_l, v_r], axis=1) >= 0
    triangle = len(native.base_triangles) + np.cumsum(present.ravel()).reshape(present.shape) - 1
    triangle = np.where(present, triangle, 0)
    splits["triangles"] = np.where(present, native.triangle_index[triangle], -1)
    splits["corners"] = np.where(present[:, :, None], corners[triangle], -1)
    return splits
