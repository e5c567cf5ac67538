"""Run in a Blender, after an installation: the operator on a torus of quads, with the installed native package.

Prints where that package was loaded from, as "holomorph: PATH".
"""

import bpy
import numpy as np


def read(obj, name):
    """(#faces, 4, 2) of the UV map."""
    uv = np.empty(2 * len(obj.data.loops), np.float32)
    obj.data.uv_layers[name].data.foreach_get("uv", uv)
    return uv.reshape(-1, 4, 2)


def use():
    bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=12)
    torus = bpy.context.object
    assert bpy.ops.uv.holomorphic_maps() == {"FINISHED"}
    main, first = read(torus, "Holomorphic"), read(torus, "Holomorphic 1")
    assert np.isfinite(main).all() and np.ptp(main, axis=(0, 1)).min() > 0.9, "the tiling has a tile each way at least"
    assert abs(np.ptp(first, axis=(0, 1)).max() - 1) < 1e-5, "the map of a form fills the UV square"

    import holomorph

    print("holomorph:", holomorph.__file__)
