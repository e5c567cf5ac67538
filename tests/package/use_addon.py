"""Run in a Blender, after an installation: the operator on a torus of quads, with the installed native package.

Prints where that package was loaded from, as "holomorph: PATH".
"""

import bpy
import numpy as np


def use():
    bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=12)
    torus = bpy.context.object
    assert bpy.ops.uv.holomorphic_maps() == {"FINISHED"}
    assert "Holomorphic" in torus.data.uv_layers and "Holomorphic 1" in torus.data.uv_layers
    uv = np.empty(2 * len(torus.data.loops), np.float32)
    torus.data.uv_layers["Holomorphic"].data.foreach_get("uv", uv)
    uv = uv.reshape(-1, 4, 2)
    assert np.isfinite(uv).all()
    assert abs((uv.max(axis=(0, 1)) - uv.min(axis=(0, 1))).max() - 1) < 1e-5, "each map fills the UV square"

    import holomorph

    print("holomorph:", holomorph.__file__)
