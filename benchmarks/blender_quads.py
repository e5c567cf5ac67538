# SPDX-License-Identifier: GPL-3.0-or-later
"""`Surface.quads` beside Blender's remesher QuadriFlow, of mesh files.

    blender -b --factory-startup --python-exit-code 1 --python benchmarks/blender_quads.py -- FILE... [--faces N]

Of the largest part of each file, first ours, then QuadriFlow's, asked for as many faces: the number of faces, and of
those that are no quads; the mean of how far corners are from 90 degrees, and what 95 % are below; the vertices inside
without four edges; seconds.
"""

import argparse
import sys
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from addon.native import holomorph


def quads(surface, faces):
    found = surface.quads(faces)
    return found.positions, found.corner_vertices, found.face_offsets


def remeshed(surface, faces):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = bpy.data.meshes.new("Mesh")
    mesh.from_pydata(surface.vertices.tolist(), [], surface.triangles.tolist())
    obj = bpy.data.objects.new("Mesh", mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    start = time.perf_counter()
    bpy.ops.object.quadriflow_remesh(mode="FACES", target_faces=faces, use_mesh_symmetry=False)
    seconds = time.perf_counter() - start
    vertices = np.array([vertex.co for vertex in obj.data.vertices])
    corners = np.array([loop.vertex_index for loop in obj.data.loops])
    return (vertices, corners, np.array([*(face.loop_start for face in obj.data.polygons), len(corners)])), seconds


def measured(vertices, corners, offsets):
    following = np.arange(1, len(corners) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    before = np.empty_like(following)
    before[following] = np.arange(len(following))
    at = vertices[corners]
    a, b = at[following] - at, at[before] - at
    lengths = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    cosine = np.divide(np.einsum("ni,ni->n", a, b), lengths, out=np.zeros(len(a)), where=lengths > 0)
    off = np.abs(np.degrees(np.arccos(np.clip(cosine, -1, 1))) - 90)
    sides = np.sort(corners[np.stack([np.arange(len(corners)), following], axis=1)], axis=1)
    ends, count = np.unique(sides, axis=0, return_counts=True)
    edges = np.bincount(ends.ravel(), minlength=len(vertices))
    edges[ends[count == 1].ravel()] = 4  # on the border
    faces, irregular = np.diff(offsets), np.count_nonzero((edges != 4) & (edges > 0))
    return (
        f"{len(faces):,} faces, {np.count_nonzero(faces != 4)} no quads, {off.mean():.1f} degrees off, 95 % below "
        f"{np.quantile(off, 0.95):.0f}, {irregular} irregular vertices"
    )


def main():
    parser = argparse.ArgumentParser(prog="blender_quads.py")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--faces", type=int, default=2000)
    asked = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    for path in asked.files:
        surface = max(holomorph.Surface.read(path).components, key=lambda part: len(part.triangles))
        start = time.perf_counter()
        own = quads(surface, asked.faces)
        seconds = time.perf_counter() - start
        other, of_other = remeshed(surface, asked.faces)
        print(f"{Path(path).name}, {len(surface.triangles):,} triangles")
        print(f"    quads       {measured(*own)}, {seconds:.1f} s")
        print(f"    QuadriFlow  {measured(*other)}, {of_other:.1f} s", flush=True)


main()
