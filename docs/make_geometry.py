# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of geometry on a tiling: scripts/geometry-picture puts several together.

blender -b EXAMPLE.blend --factory-startup --python-exit-code 1 --python docs/make_geometry.py -- \
    PICTURE PIECE TILES COLUMNS [scatter]

With "scatter" as many of the same pieces are distributed on the faces by Blender's own nodes instead, along normals.
"""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import preview_scene

import addon
from addon import compatibility
from addon.results import tags
from addon.things import geometry, tree

RESOLUTION, SAMPLES = 560, 32
LOOKS = {  # linear RGB of the pieces and the surface, how metallic pieces are
    "RING": ((0.32, 0.33, 0.36), (0.02, 0.02, 0.025), 1.0),
    "STITCH": ((0.45, 0.07, 0.05), (0.25, 0.03, 0.02), 0.0),
    "SCALE": ((0.09, 0.26, 0.13), (0.05, 0.12, 0.07), 0.0),
}


def material(name, color, metallic):
    made = bpy.data.materials.new(name)
    compatibility.enable_nodes(made)
    shader = next(node for node in made.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Metallic"].default_value = metallic
    shader.inputs["Roughness"].default_value = 0.35
    return made


def paint(obj, made):
    obj.data.materials.clear()
    obj.data.materials.append(made)


def scatter(obj, made, piece):
    """The points of `made` anew: as far apart as they can be, the pieces turned to the normals alone."""
    nodes = tree.Tree("Scatter", {})
    surface = nodes.node("GeometryNodeObjectInfo", obj, transform_space="RELATIVE").node.outputs["Geometry"]
    area = sum(face.area for face in obj.data.polygons) * abs(obj.matrix_world.determinant()) ** (2 / 3)
    cell = (area / len(made.data.vertices)) ** 0.5
    found = nodes.node(
        "GeometryNodeDistributePointsOnFaces",
        surface,
        named={"Distance Min": 0.75 * cell, "Density Max": 20 / cell**2},
        distribute_method="POISSON",
    ).node
    source = nodes.node("GeometryNodeObjectInfo", piece, True).node.outputs["Geometry"]
    size = 2**0.5 * cell
    named = {"Points": found.outputs["Points"], "Instance": source, "Rotation": found.outputs["Rotation"]}
    nodes.finish(nodes.node("GeometryNodeInstanceOnPoints", named=named | {"Scale": (size, size, size)}))
    made.modifiers[0].node_group = nodes.group


def main():
    path, piece, tiles, columns, *kind = sys.argv[sys.argv.index("--") + 1 :]
    addon.register()
    obj = bpy.context.view_layer.objects.active
    bpy.ops.uv.holomorphic_tile(tiles=int(tiles), checker=False)
    bpy.ops.object.holomorphic_geometry(piece=piece, columns=int(columns))
    found = tags.find(geometry.PIECES_OF, obj)
    made, source = sorted(found, key=lambda block: len(block.data.polygons))
    color, below, metallic = LOOKS[piece]
    paint(source, material("Pieces", color, metallic))
    paint(obj, material("Surface", below, 0.0))
    if kind == ["scatter"]:
        scatter(obj, made, source)
    preview_scene.render([obj, made], path, RESOLUTION, SAMPLES)


main()
