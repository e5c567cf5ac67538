"""Everything in the open file that an operator could change, for comparison bit for bit."""

import functools
import hashlib
from operator import attrgetter

import bpy
import numpy as np

# Collections of bpy.data that hold no part of the scene: windows, brushes and their like.
NOT_THE_SCENE = {"window_managers", "workspaces", "brushes", "palettes", "paint_curves", "libraries", "all_ids"}
# What Blender computes, or counts, by itself.
COMPUTED = {"rna_type", "original", "is_evaluated", "session_uid", "tag", "preview", "is_runtime_data", "bl_rna"}
COMPUTED |= {"id_data", "is_updated", "is_updated_data", "depsgraph", "pixels", "is_dirty", "has_data", "bindcode"}
COMPUTED |= {"rendered_preview", "render_slots", "keying_sets_all", "total_vert_sel", "total_edge_sel"}
COMPUTED |= {"total_face_sel", "is_modified", "is_in_memory", "bound_box", "depth", "type_info", "packed_file"}
COMPUTED |= {"loop_triangle_polygons", "cycles", "wireframe_color_type", "dimensions"}
LARGE = 1_000_000  # values of an image
STRUCT, BLOCK = bpy.types.bpy_struct, bpy.types.ID
# Elements of meshes, which are read as arrays.
ELEMENTS = {"vertices", "edges", "loops", "polygons", "loop_triangles", "vertex_normals", "polygon_normals"}
ELEMENTS |= {"corner_normals", "uv_layers", "attributes", "color_attributes", "vertex_colors", "vertex_layers_float"}
ELEMENTS |= {"vertex_layers_int", "vertex_layers_string", "polygon_layers_float", "polygon_layers_int"}
ELEMENTS |= {"polygon_layers_string", "sculpt_vertex_colors", "vertex_creases", "edge_creases", "vertex_paint_masks"}
ELEMENTS |= {"face_maps", "skin_vertices", "uv_layer_clone", "uv_layer_stencil"}


def file_state():
    """{path: value}; of meshes and images hashes of their arrays."""
    if bpy.context.mode == "EDIT_MESH":  # where Blender gives nothing of meshes
        edited = [obj.name for obj in bpy.context.view_layer.objects if obj.mode == "EDIT"]
        bpy.ops.object.mode_set(mode="OBJECT")
        state = file_state() | {"edited": edited}
        bpy.ops.object.mode_set(mode="EDIT")
        return state
    bpy.context.view_layer.update()  # what Blender computes of it
    state = {}
    for name in _collections():
        for block in getattr(bpy.data, name):
            _add(state, block, f"{name}[{block.name_full}]", set())
    for scene in bpy.data.scenes:
        for layer in scene.view_layers:
            _add_view(state, layer, f"scenes[{scene.name}].view_layers[{layer.name}]")
    state["mode"] = bpy.context.mode
    for screen in bpy.data.screens:
        state[f"screens[{screen.name}]"] = {key: _custom(screen[key]) for key in list(screen.keys())}
        for index, area in enumerate(screen.areas):
            if area.type == "VIEW_3D":
                shading = area.spaces.active.shading
                state[f"screens[{screen.name}].areas[{index}]"] = shading.type, shading.color_type
    return state


def differences(before, after):
    """Lines that tell what is another."""
    if before == after:
        return []
    paths = sorted(path for path in before.keys() | after.keys() if before.get(path) != after.get(path))
    return [f"{path}: {before.get(path)!r:.200} -> {after.get(path)!r:.200}" for path in paths]


@functools.lru_cache(maxsize=1)
def _collections():
    names = [p.identifier for p in bpy.data.bl_rna.properties if p.type == "COLLECTION"]
    return [name for name in names if name not in NOT_THE_SCENE and name != "screens"]


@functools.cache
def _properties(kind):
    """(endings of paths, what reads all their values at once, names of arrays, [(name, whether a collection)] of the
    rest, whether data-blocks, what is added besides) of a kind of struct."""
    own = [p for p in kind.bl_rna.properties if p.identifier not in COMPUTED]
    if kind is bpy.types.Mesh:
        own = [p for p in own if p.identifier not in ELEMENTS]
    if kind is bpy.types.Image and bpy.app.version < (3, 5, 0):  # which counts those of a copied material twice
        own = [p for p in own if p.identifier != "users"]
    if kind is bpy.types.ParticleEdit:  # notes the object at any step of undo while it is sculpted
        own = [p for p in own if p.identifier != "object"]
    if kind is getattr(bpy.types, "UvSculpt", None) and kind.bl_rna.base:  # 4.2 says that it is a Paint, wrongly:
        own = [p for p in own if p.identifier not in kind.bl_rna.base.properties]  # such values lie outside its memory
    structs = [(p.identifier, p.type == "COLLECTION") for p in own if p.type in ("POINTER", "COLLECTION")]
    values = [p for p in own if p.type not in ("POINTER", "COLLECTION")]
    arrays = [p.identifier for p in values if getattr(p, "is_array", False)]
    names = [p.identifier for p in values if p.identifier not in arrays]
    besides = {bpy.types.Mesh: _add_mesh, bpy.types.Image: _add_image, bpy.types.Object: _add_slots}
    added = [add for base, add in besides.items() if issubclass(kind, base)]
    read = attrgetter(*names, "__class__", "__class__")  # asked for two at least, it returns a tuple
    return [f".{name}" for name in names], read, arrays, structs, issubclass(kind, bpy.types.ID), added


def _add(state, struct, path, seen):
    """Adds all properties of a struct, those of the structs that belong to it, and its custom properties."""
    if struct.as_pointer() in seen:
        return
    seen.add(struct.as_pointer())
    ends, read, arrays, structs, is_block, added = _properties(type(struct))
    state.update(zip(map(path.__add__, ends), read(struct)))
    for name in arrays:
        state[f"{path}.{name}"] = _plain(getattr(struct, name))
    for name, is_collection in structs:
        value = getattr(struct, name, None)
        for index, element in enumerate(value) if is_collection else [(None, value)]:
            _add_value(state, element, f"{path}.{name}[{index}]" if is_collection else f"{path}.{name}", seen)
    for add in added:
        add(state, struct, path)
    if is_block:
        for key in list(struct.keys()):
            state[f"{path}[{key!r}]"] = _custom(struct[key])


def _add_value(state, value, path, seen):
    if value is None or not isinstance(value, STRUCT):
        state[path] = value
    elif isinstance(value, BLOCK) and not value.is_embedded_data:
        state[path] = f"{type(value).__name__} {value.name_full}"
    else:
        _add(state, value, path, seen)


def _add_view(state, layer, path):
    """What is active, selected and hidden in a view layer, which asking for the active object brings up to date."""
    active = layer.objects.active, layer.active_layer_collection
    state[f"{path}.active"] = [getattr(each, "name", "") for each in active]
    state[f"{path}.selected"] = sorted(o.name_full for o in layer.objects if o.select_get(view_layer=layer))
    state[f"{path}.hidden"] = sorted(o.name_full for o in layer.objects if o.hide_get(view_layer=layer))


def _plain(value):
    values = tuple(value)
    return tuple(map(_plain, values)) if values and hasattr(values[0], "__len__") else values


def _custom(value):
    if hasattr(value, "to_dict"):
        return {key: _custom(value[key]) for key in sorted(value.keys())}
    if isinstance(value, bpy.types.ID):
        return value.name_full
    return value.to_list() if hasattr(value, "to_list") else value


def _digest(array):
    return hashlib.sha1(np.ascontiguousarray(array)).hexdigest()


def _array(elements, name):
    """A property of all elements; also where Blender gives no arrays of it."""
    if not len(elements):
        return np.empty(0)
    kind = type(elements[0]).bl_rna.properties[name]
    dtype = {"FLOAT": np.float32, "INT": np.int32, "BOOLEAN": bool}.get(kind.type)
    if dtype is None:
        return np.array([getattr(e, name) for e in elements])
    array = np.empty(len(elements) * max(1, kind.array_length), dtype)
    elements.foreach_get(name, array)
    return array


def _add_mesh(state, mesh, path):
    """Flags that Blender drops where none is set, as it does in edit mode, count as if they were there."""
    marks = {
        "vertices": ("co", "select", "hide"),
        "edges": ("vertices", "select", "hide", "use_seam", "use_edge_sharp"),
        "loops": ("vertex_index",),
        "polygons": ("loop_start", "loop_total", "material_index", "use_smooth", "select", "hide"),
    }
    for collection, names in marks.items():
        for name in names:
            state[f"{path}.{collection}.{name}"] = _digest(_array(getattr(mesh, collection), name))
    state[f"{path}.attributes"] = []
    for attribute in sorted(mesh.attributes, key=lambda a: a.name != "position"):  # edit mode of 4.2 to 5.0 moves it
        if attribute.name.startswith("."):
            continue
        state[f"{path}.attributes"].append((attribute.name, attribute.domain, attribute.data_type))
        (name,) = {"value", "vector", "color"} & set(type(attribute.data[0]).bl_rna.properties.keys())
        state[f"{path}.attributes[{attribute.name}]"] = _digest(_array(attribute.data, name))
    for name in ("active", "active_color"):
        state[f"{path}.{name}"] = getattr(getattr(mesh.attributes, name), "name", "")
    for index, layer in enumerate(mesh.uv_layers):
        where = f"{path}.uv_layers[{index}]"
        state[where] = layer.name, layer.active, layer.active_render, layer.active_clone
        for name in list(type(layer.data[0]).bl_rna.properties.keys()):
            if name != "rna_type":
                state[f"{where}.{name}"] = _digest(_array(layer.data, name))


def _add_image(state, image, path):
    """Notes a large image that is packed by its file alone: reading the pixels takes long."""
    state[f"{path}.packed"] = hashlib.sha1(image.packed_file.data).hexdigest() if image.packed_file else ""
    if len(image.pixels) < LARGE or not image.packed_file:
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        state[f"{path}.pixels"] = _digest(pixels)


def _add_slots(state, obj, path):
    """The materials that slots linked to the mesh have on the object: Blender shows those of the mesh."""
    for index, slot in enumerate(obj.material_slots if obj.library is None else ()):
        link = slot.link
        slot.link = "OBJECT"
        state[f"{path}.own_material[{index}]"] = getattr(slot.material, "name_full", "")
        slot.link = link
