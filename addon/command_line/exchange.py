# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of other programs, read and written by Blender's own importers and exporters: with objects, materials, UV maps.
Meshes stay as they are read: vertices are joined by the package, for the maps alone."""

import functools

import bpy

from .. import compatibility, native
from ..materials import material, plain
from ..native import holomorph
from ..scene import gathering, stored_dials, uv_maps
from ..writing import states

USD = (".usd", ".usda", ".usdc", ".usdz")
GLTF = (".glb", ".gltf")
SCENES = (*GLTF, ".fbx", *USD)
SUFFIXES = (*SCENES, ".obj")
KINDS = {".obj": "OBJ", ".fbx": "FBX", **dict.fromkeys(GLTF, "glTF"), **dict.fromkeys(USD, "USD")}

# What exporters leave out, rename or add by default.
WITH_GLTF = {
    "export_cameras": True,
    "export_lights": True,
    "export_extras": True,
    "export_vertex_color": "ACTIVE",
    "export_attributes": True,
    "export_all_influences": True,
    "use_mesh_edges": True,
    "use_mesh_vertices": True,
}
WITH_USD = {"export_uvmaps": True, "rename_uvmaps": False, "export_animation": True, "use_instancing": True}
WITH_FBX = {
    "use_custom_props": True,
    "path_mode": "COPY",
    "embed_textures": True,
    "add_leaf_bones": False,
    "use_mesh_edges": True,
}


class ExchangeError(Exception):
    """A file cannot be read or written; the text is one sentence."""


def read(path, up):
    """The mesh objects of a file, all selected, the first one active. @throws ExchangeError

    up : "Y" or "Z", the axis of an OBJ file
    """
    before = set(bpy.data.objects)
    _import(path, up)
    layer = bpy.context.view_layer
    layer.update()
    made = [obj for obj in compatibility.objects_in(layer) if obj.type == "MESH" and obj not in before]
    meshes = sorted((obj for obj in made if not gathering.is_helper(obj)), key=lambda obj: obj.name)
    if not meshes:
        raise ExchangeError(f"{path}: it contains no mesh")
    for obj in compatibility.objects_in(layer):
        obj.select_set(obj in meshes)
    layer.objects.active = meshes[0]
    return meshes


def _import(path, up):
    kind = path.suffix.lower()
    if kind == ".obj":
        _call(path, "read", bpy.ops.wm.obj_import, up_axis=up, forward_axis=compatibility.forward_axis(up))
        return
    try:
        with compatibility.old_numpy_names():
            _call(path, "read", compatibility.operator(holomorph.files.formats.IMPORTERS[kind]))
    except ExchangeError as error:
        raise ExchangeError(holomorph.files.scenes.fault(path) or str(error)) from error


def write(path, forms=False, texture=False):
    """Writes the scene with the objects' own materials; it is left as it is in the file. @throws ExchangeError

    forms : whether the maps of single forms are written, too; texture : whether what ours show is, instead
    """
    _prepare(bpy.data.objects, forms, texture)  # those of instanced collections, too, which are in no view layer
    with native.load().files.whole_file.folder_beside(path) as folder:
        _export(path, folder / path.name)
        if not (folder / path.name).is_file():
            raise ExchangeError(f"{path}: Blender did not write it")


def _export(path, place):
    """Writes to a place what is to be a path's file, with images beside it."""
    kind, called = path.suffix.lower(), functools.partial(_call, path, "write", place=place)
    if kind in GLTF:
        form = "GLB" if kind == ".glb" else "GLTF_SEPARATE"
        called(bpy.ops.export_scene.gltf, export_format=form, **_with_gltf())
    elif kind in USD:
        called(bpy.ops.wm.usd_export, **WITH_USD)
    elif kind == ".obj":
        called(bpy.ops.wm.obj_export, path_mode="COPY")
    else:
        called(bpy.ops.export_scene.fbx, **_with_fbx())


def _with_gltf():
    """What modifiers make is written, as it is in other formats, where no object has shape keys: they would be lost."""
    modifiers = [modifier for obj in bpy.data.objects for modifier in obj.modifiers]
    is_changed = any(modifier.type != "ARMATURE" and modifier.show_viewport for modifier in modifiers)
    return WITH_GLTF | {"export_apply": is_changed and not any(mesh.shape_keys for mesh in bpy.data.meshes)}


def _with_fbx():
    """Every action of an object is a clip, in which shape keys move along. Where keys alone are animated, the scene is
    one clip, for no other would have them."""
    animated = [obj.animation_data for obj in bpy.context.scene.objects if obj.animation_data]
    has_clips = any(data.action or data.nla_tracks for data in animated)
    has_keys = any(key.animation_data for key in bpy.data.shape_keys)
    is_one_clip = has_keys and not has_clips
    return WITH_FBX | {"bake_anim_use_all_actions": not is_one_clip, "bake_anim_use_nla_strips": not is_one_clip}


def _prepare(objects, forms, texture):
    """Takes from these objects our materials, but for baked ones and for the texture where it is wanted, our custom
    properties and, unless wanted, the maps of forms; and what an importer made for its own use, which exporters of
    other formats do not know.
    """
    bpy.data.batch_remove([obj for obj in objects if gathering.is_helper(obj)])
    with_meshes = [obj for obj in objects if obj.type == "MESH"]
    owners = {*objects, *(obj.data for obj in with_meshes)}
    for obj in with_meshes:
        baked = [slot.material for slot in obj.material_slots if material.is_baked(slot.material)]
        if baked:
            owners |= {*baked}
            continue
        if texture:
            plain.show(obj)
        material.uncover(obj)
    for owner in owners:
        if owner.library is None:
            _clean(owner, forms)


def _clean(owner, forms):
    if not forms and isinstance(owner, bpy.types.Mesh):
        main, layers = uv_maps.main_map(owner), owner.uv_layers
        for name in [name for name in uv_maps.own_maps(owner) if name != main and name in layers]:
            layers.remove(layers[name])
    if isinstance(owner, bpy.types.Object):
        stored_dials.forget(owner)
    states.restore_properties(owner, {})


def _call(path, verb, operator, place=None, **options):
    """Calls an importer or exporter for a path, or for a place in its stead; what it raises may be a whole traceback,
    whose last line tells."""
    kind = KINDS[path.suffix.lower()]
    if not compatibility.is_there(operator):
        raise ExchangeError(f"{path}: this Blender cannot {verb} {kind}")
    known = operator.get_rna_type().properties.keys()
    options = {name: value for name, value in options.items() if name in known}  # some are new in later versions
    try:
        operator(filepath=str((place or path).absolute()), **options)
    except RuntimeError as error:
        lines = [line.strip() for line in str(error).splitlines() if line.strip()]
        told = [line for line in lines if not line.startswith(("Location:", "File "))]
        raise ExchangeError(f"{path}: Blender cannot {verb} this {kind} file: {told[-1] if told else kind}") from error
