# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the example files of this folder with Blender's own tools. Run it with Blender 3.4:

blender -b --factory-startup --python-exit-code 1 --python blend_examples/make_examples.py [-- folder [name]...]

3.4 because its files open in every later version. Each mesh is checked before it is saved: manifold, and of the genus
and number of boundary loops stated in EXAMPLES.
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from creatures import armadillo, critter, hand, lizard
from masks import mask
from modeling import select_only
from objects import chain, clay, gear, knot, lantern, mixed, mug, pipe, pretzel, text, torus
from part_topologies import part_topologies

# name of the file and maker: for each object (genus, boundary loops) of its parts, sorted
EXAMPLES = {
    torus: [[(1, 0)]],
    mug: [[(1, 0)]],
    pretzel: [[(3, 0)]],
    chain: [[(1, 0)] * 7],
    gear: [[(6, 0)]],
    knot: [[(1, 0)]],
    lantern: [[(13, 0)]],
    clay: [[(2, 0)]],
    mixed: [[(0, 0), (1, 0)], [(0, 1)]],
    hand: [[(0, 6)]],
    pipe: [[(0, 2)]],
    critter: [[(0, 0)]],
    lizard: [[(0, 0)]],
    armadillo: [[(0, 0)]],
    text: [[(0, 0)] * 5 + [(1, 0)] * 4],
    mask: [[(0, 1)], [(0, 1)]],
}
EDITED = {mask}  # saved in edit mode, for the sake of the selected vertices


def save(make, expected, folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.preferences.filepaths.save_version = 0
    objects = make()
    for obj, topologies in zip(objects, expected):
        while obj.data.uv_layers:
            obj.data.uv_layers.remove(obj.data.uv_layers[0])
        obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
        obj.data.use_auto_smooth, obj.data.auto_smooth_angle = True, math.radians(40)
        found = part_topologies(obj.data)
        print(f"{make.__name__}: {obj.name}, {len(obj.data.polygons)} faces, (genus, boundary loops) of parts {found}")
        if found != topologies:
            raise RuntimeError(f"{obj.name}: {found}, expected {topologies}")
    select_only(objects[0])
    for obj in objects:
        obj.select_set(True)
    bpy.ops.outliner.orphans_purge(do_recursive=True)
    if make in EDITED:
        bpy.ops.object.mode_set(mode="EDIT")
    path = folder / f"{make.__name__}.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False, compress=True)


def main():
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    folder = Path(arguments[0]) if arguments else Path(__file__).resolve().parent
    for make, expected in EXAMPLES.items():
        if make.__name__ in arguments[1:] or len(arguments) < 2:
            save(make, expected, folder.resolve())


if __name__ == "__main__":
    main()
