# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the files of blend_examples/seamless: examples with a finished seamless tiling, to be looked at as they open.
Run it with Blender 3.4, after scripts/build (scripts/seamless-examples does):

blender -b --factory-startup --python-exit-code 1 --python blend_examples/make_seamless.py -- PICTURES [name...]

A picture of each goes to the folder PICTURES. The textures of the add-on lie beside the files, once for all of them, at
a size that is enough there.
"""

import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "docs"))
import preview_scene
from modeling import subdivide

import addon
from addon.scene import mesh_io

HERE = Path(__file__).resolve().parent
FOLDER = HERE / "seamless"
TEXTURES = FOLDER / "textures"
SIZE = 512  # pixels across an image
GREEN_BITS = 3  # kept of the lower channel of heights
VIEW = (0.87, 0.37, 0.12, 0.29)  # quaternion: three quarters, from above
DISTANCE = 1.6  # of the view from the object, in diagonals of its bounding box
RESOLUTION, SAMPLES = 420, 24  # of a picture


FILES = {  # texture and number of tiles
    "critter": ("SCALES", 96),
    "mug": ("BRICKS", 24),
    "suzanne": ("WEAVE", 40),
    "hand": ("WEAVE", 24),
    "pretzel": ("BRICKS", 48),
    "pipe": ("HEXAGONS", 24),
    "armadillo": ("SCALES", 96),
    "text": ("PLANKS", 60),
}


def suzanne():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_monkey_add()
    monkey = bpy.context.object
    monkey.data.uv_layers.remove(monkey.data.uv_layers[0])
    subdivide(monkey, 1)
    bpy.ops.object.shade_smooth()
    return monkey


def opened(name):
    if name == "suzanne":
        return suzanne()
    bpy.ops.wm.open_mainfile(filepath=str(HERE / f"{name}.blend"))
    return bpy.context.view_layer.objects.active


def keep_high_bits(heights):
    """Clears the low bits of green, the lower channel of heights: they are noise that makes files twice as large."""
    pixels = np.empty(4 * SIZE * SIZE, np.float32)
    heights.pixels.foreach_get(pixels)
    green = np.rint(pixels[1::4] * 255).astype(np.uint8)
    pixels[1::4] = (green & ~np.uint8(255 >> GREEN_BITS)) / 255
    heights.pixels.foreach_set(pixels)


def share_images():
    """Images that are packed become files of the folder with the textures, which all examples read."""
    for packed in [image for image in bpy.data.images if image.packed_file]:
        ending = "png" if packed.colorspace_settings.name == "Non-Color" else "jpg"  # heights are numbers
        path = TEXTURES / f"{packed.name.removeprefix('Holomorph ').lower().replace(' ', '_')}.{ending}"
        if not path.exists():
            packed.scale(SIZE, SIZE)
            if ending == "png":
                keep_high_bits(packed)
            packed.filepath_raw, packed.file_format = str(path), {"png": "PNG", "jpg": "JPEG"}[ending]
            packed.save()
        shared = bpy.data.images.load(str(path))
        shared.colorspace_settings.name = packed.colorspace_settings.name
        shared.filepath = f"//textures/{path.name}"
        packed.user_remap(shared)
        bpy.data.images.remove(packed)


def show(obj):
    """In every view of the file: with its texture, from a side on which there is something to see."""
    points = mesh_io.world_points(obj)
    low, high = points.min(axis=0), points.max(axis=0)
    for area in (area for screen in bpy.data.screens for area in screen.areas if area.type == "VIEW_3D"):
        space = area.spaces.active
        space.shading.type = "MATERIAL"
        view = space.region_3d
        view.view_location, view.view_rotation = (low + high) / 2, VIEW
        view.view_distance = DISTANCE * float(((high - low) ** 2).sum() ** 0.5)


def save(obj, path):
    """The file, opening at the object, without what it does not use."""
    show(obj)
    bpy.ops.outliner.orphans_purge(do_recursive=True)
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False, compress=True, relative_remap=False)


def make_all(files, folder, make):
    """Each of the files that the command names, or all, and a picture of the objects that `make` returns."""
    pictures, *wanted = sys.argv[sys.argv.index("--") + 1 :]
    folder.mkdir(parents=True, exist_ok=True)
    addon.register()
    for name in wanted or files:
        shown = make(name)
        preview_scene.render(shown, str(Path(pictures).resolve() / f"{name}.png"), RESOLUTION, SAMPLES)


def make(name):
    obj = opened(name)
    texture, tiles = FILES[name]
    bpy.ops.uv.holomorphic_tile(texture=texture, tiles=tiles, turns="NONE")
    share_images()
    save(obj, FOLDER / f"{name}.blend")
    return [obj]


if __name__ == "__main__":
    TEXTURES.mkdir(parents=True, exist_ok=True)
    make_all(FILES, FOLDER, make)
