"""A scene with what files of exchange may lose, and what can be read off the scene that is open."""

import bpy
import numpy as np
from loaded_addon import module
from scenes import grid_arrays, mesh_object, sphere_arrays, torus_arrays, tube_arrays

FRAMES = (1, 10, 20)
IMAGE = 8  # pixels of a side
NEAR = 2e-3  # difference of lengths, angles and values, in their unit


def make():
    """Two skins, a face with keys, twins, instances of a collection, a painted and textured sheet, a camera, a lamp."""
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = FRAMES[0], FRAMES[-1]
    for number, name in enumerate(("Arm", "Leg")):
        skin(name, 4 * number, bend=0.6 + 0.5 * number)
    face()
    twin = mesh_object("Twin", *torus_arrays(12, 8))
    twin.location = (0, 5, 0)
    place("Other Twin", twin.data, (4, 5, 0))
    instances()
    sheet()
    camera = place("Eye", bpy.data.cameras.new("Eye"), (0, -9, 2))
    camera.data.lens = 35.0
    lamp = place("Lamp", bpy.data.lights.new("Lamp", "POINT"), (3, 3, 6))
    lamp.data.energy = 250.0
    for frame, height in zip(FRAMES, (0.0, 1.5, 3.0)):
        twin.location.z = height
        twin.keyframe_insert("location", frame=frame)
    twin["wheel"], twin.data["thickness"], camera["shot"] = 7, 2.5, "first"
    bpy.data.materials["Painted"]["gloss"], bpy.context.scene["take"] = 3, 4
    bpy.context.scene.frame_set(FRAMES[0])


def place(name, data, location=(0, 0, 0), collection=None):
    obj = bpy.data.objects.new(name, data)
    obj.location = location
    (collection or bpy.context.scene.collection).objects.link(obj)
    return obj


def skin(name, x, bend):
    """A tube on two bones, of which an action of its own turns the upper one."""
    vertices, faces = tube_arrays(12, 8)
    obj = mesh_object(name, vertices, faces)
    rig = place(f"{name} Rig", bpy.data.armatures.new(f"{name} Bones"))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for bone, low, high in (("Lower", 0.0, 1.2), ("Upper", 1.2, 2.4)):
        made = rig.data.edit_bones.new(f"{name} {bone}")
        made.head, made.tail = (0, 0, low), (0, 0, high)
    rig.data.edit_bones[f"{name} Upper"].parent = rig.data.edit_bones[f"{name} Lower"]
    bpy.ops.object.mode_set(mode="OBJECT")
    share = np.clip(vertices[:, 2] / 2.4, 0, 1)
    for bone, weights in (("Lower", 1 - share), ("Upper", share)):
        group = obj.vertex_groups.new(name=f"{name} {bone}")
        for vertex, weight in enumerate(weights.tolist()):
            group.add([vertex], weight, "REPLACE")
    obj.parent = rig
    obj.modifiers.new("Armature", "ARMATURE").object = rig
    rig.location.x = x
    upper = rig.pose.bones[f"{name} Upper"]
    upper.rotation_mode = "XYZ"
    for frame, angle in zip(FRAMES, (0.0, bend, -bend)):
        upper.rotation_euler.x = angle
        upper.keyframe_insert("rotation_euler", frame=frame)
    rig.animation_data.action.name = f"{name} Bends"


def face():
    """Two shape keys, one of them animated."""
    obj = mesh_object("Face", *sphere_arrays(2))
    obj.location = (-4, 0, 0)
    obj.shape_key_add(name="Basis")
    for name, axis in (("Smile", 0), ("Frown", 2)):
        key = obj.shape_key_add(name=name)
        places = np.array([tuple(point.co) for point in key.data])
        places[:, axis] *= 2
        for point, place_ in zip(key.data, places.tolist()):
            point.co = place_
    smile = obj.data.shape_keys.key_blocks["Smile"]
    for frame, value in zip(FRAMES, (0.0, 1.0, 0.5)):
        smile.value = value
        smile.keyframe_insert("value", frame=frame)


def instances():
    """A collection that is not part of the scene but in two instances."""
    props = bpy.data.collections.new("Props")
    prop = mesh_object("Prop", *torus_arrays(8, 6))
    bpy.context.scene.collection.objects.unlink(prop)
    props.objects.link(prop)
    for number in range(2):
        empty = place(f"Instance {number}", None, (-4, 5 + 4 * number, 0))
        empty.instance_type, empty.instance_collection = "COLLECTION", props


def sheet():
    """Painted, with a map of its own and a picture on it."""
    obj = mesh_object("Sheet", *grid_arrays(4))
    mesh = obj.data
    obj.location = (9, 0, 0)
    mesh.uv_layers.new(name="UVMap")
    mesh.color_attributes.new("Paint", "BYTE_COLOR", "CORNER")
    layer, paint = mesh.uv_layers["UVMap"], mesh.color_attributes["Paint"]  # a new layer moves those that there are
    for loop in mesh.loops:
        x, y, _ = mesh.vertices[loop.vertex_index].co
        layer.data[loop.index].uv = (x / 4, y / 4)
        paint.data[loop.index].color = (x / 4, y / 4, 0.5, 1.0)
    mesh.color_attributes.active_color = paint
    mesh.attributes.new("_Height", "FLOAT", "POINT").data[7].value = 7.5
    mesh.vertices.add(2)  # and a loose edge
    mesh.vertices[len(mesh.vertices) - 1].co = (0, 0, 6)
    mesh.edges.add(1)
    mesh.edges[len(mesh.edges) - 1].vertices = (len(mesh.vertices) - 2, len(mesh.vertices) - 1)
    mesh.update(calc_edges_loose=True)
    picture = bpy.data.images.new("Picture", IMAGE, IMAGE)
    picture.pixels = np.tile([0.8, 0.3, 0.1, 1.0], IMAGE * IMAGE).tolist()
    picture.pack()
    material = bpy.data.materials.new("Painted")
    module("compatibility").enable_nodes(material)
    texture = material.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = picture
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    material.node_tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    mesh.materials.append(material)


def facts():
    """{what: value} of the scene that is open: (rows of) numbers to be found again, or whether something is there."""
    play()
    found = {}
    for frame in FRAMES:
        bpy.context.scene.frame_set(frame)
        found[f"boxes of frame {frame}"] = boxes()
    bpy.context.scene.frame_set(FRAMES[0])
    meshes = [obj for obj in bpy.context.scene.objects if obj.type == "MESH"]
    owners = [*bpy.data.objects, *bpy.data.meshes, *bpy.data.cameras, *bpy.data.materials, *bpy.data.scenes]
    named = [(name, owner[name]) for owner in owners for name in owner.keys()]  # noqa: SIM118  no dictionary
    for wanted in ("wheel", "thickness", "shot", "gloss", "take"):
        found[f"property {wanted}"] = sorted({str(value) for name, value in named if name.endswith(wanted)})
    cameras = [obj for obj in bpy.context.scene.objects if obj.type == "CAMERA"]
    lamps = [obj for obj in bpy.context.scene.objects if obj.type == "LIGHT"]
    found["cameras"] = np.array([obj.matrix_world.translation for obj in cameras])
    found["lenses"] = np.array([[obj.data.lens] for obj in cameras])
    found["lamps"] = np.array([obj.matrix_world.translation for obj in lamps])
    found["energies"] = np.array([[obj.data.energy / 100] for obj in lamps])
    found["actions"] = sorted({a for a in ("Arm Bends", "Leg Bends") if any(a in x.name for x in bpy.data.actions)})
    found["bones"] = sorted({plain(bone.name) for rig in bpy.data.armatures for bone in rig.bones})
    blocks = [block for keys in bpy.data.shape_keys for block in keys.key_blocks]
    found["keys"] = sorted({block.name for block in blocks} & {"Smile", "Frown"})
    found["objects"] = sorted({plain(obj.name) for obj in bpy.context.scene.objects})
    found["meshes"] = copies()
    found["colours"] = np.concatenate([np.empty((0, 4)), *(colours(obj.data) for obj in meshes)])
    uvs = [layer for obj in meshes for layer in obj.data.uv_layers]
    found["maps"] = np.concatenate([np.empty((0, 2)), *(uv_rows(layer) for layer in uvs)])
    found["materials"] = sorted({plain(s.material.name) for o in meshes for s in o.material_slots if s.material})
    heights = [
        layer for obj in meshes for layer in obj.data.attributes if plain(layer.name).strip().lower() == "height"
    ]
    found["attributes"] = sorted({str(max(entry.value for entry in layer.data)) for layer in heights})
    found["loose edges"] = [str(sum(loose(obj.data) for obj in meshes))]
    images = [image for image in bpy.data.images if tuple(image.size) == (IMAGE, IMAGE)]
    found["pictures"] = np.array([image.pixels[:4] for image in images])
    return found


def plain(name):
    return name.split(".")[0].replace("_", " ")


def play():
    """Lets everything move: importers of files with several actions play one of them, and keep the others in strips."""
    for owner in [*bpy.data.objects, *bpy.data.shape_keys]:
        data = owner.animation_data
        strips = [strip for track in data.nla_tracks for strip in track.strips] if data else []
        if strips and data.action is None:
            data.action = strips[0].action
            if hasattr(data, "action_slot"):
                data.action_slot = strips[0].action_slot


def boxes():
    """(#meshes that are seen, 6): the boxes in which they lie, as they are posed."""
    rows = []
    for instance in bpy.context.evaluated_depsgraph_get().object_instances:
        if instance.object.type == "MESH" and len(instance.object.data.vertices):
            points = np.empty(3 * len(instance.object.data.vertices), np.float32)
            instance.object.data.vertices.foreach_get("co", points)
            matrix = np.array(instance.matrix_world)
            points = points.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
            rows.append([*points.min(axis=0), *points.max(axis=0)])
    return np.array(rows)


def copies():
    """How many meshes there are of each name: one, where it is shared."""
    names = [plain(mesh.name) for mesh in bpy.data.meshes if mesh.users]
    return sorted(f"{names.count(name)} {name}" for name in set(names))


def loose(mesh):
    """How many edges have no face."""
    return len(mesh.edges) - len({loop.edge_index for loop in mesh.loops})


def colours(mesh):
    rows = [tuple(entry.color) for layer in mesh.color_attributes for entry in layer.data]
    return np.array(sorted(set(rows))).reshape(-1, 4)


def uv_rows(layer):
    values = np.empty(2 * len(layer.data), np.float32)
    layer.data.foreach_get("uv", values)
    return np.unique(values.reshape(-1, 2).round(4), axis=0)


def lost(source, found):
    """What of the facts `source` is not among the facts `found`."""
    missing = set()
    for name, values in source.items():
        if isinstance(values, list):
            missing |= {f"{name}: {value}" for value in set(values) - set(found[name])}
            continue
        for number, row in enumerate(values):
            is_there = len(found[name]) and (np.abs(found[name] - row).max(axis=1) < NEAR).any()
            missing |= set() if is_there else {f"{name}: {number}" if name.startswith("boxes") else name}
    return missing
