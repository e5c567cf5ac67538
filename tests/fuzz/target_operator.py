"""Mutated meshes as Blender objects, edited by bmesh, and the add-on's operators on them, with options of any kind.

It runs inside Blender. An operator ends in maps that are finite, or in one sentence, and then the object is as it was,
bit for bit.
"""

import functools
import importlib
import importlib.util
import json
import random as random_numbers

import bmesh
import bpy
import mesh_mutations
import numpy as np
import plain_cases
from loaded_addon import ADDON
from starts import STARTS

OPERATORS = ("uv.holomorphic_maps", "uv.holomorphic_maps", "uv.holomorphic_tile", "uv.holomorphic_heat",
             "object.holomorphic_levels")  # fmt: skip
TEXTS = ("", "1 -1", "1, 1, -2", "nan", "1+0.5j", "{}", "pole", "\u00e9" * 300)
SOLVERS = ("auto", "direct", "multigrid", "paper")  # the items of this property are made when they are shown
SENTENCE = 1500  # characters, for all the objects and their parts together


ADDON.register()
scenes = importlib.import_module("scenes")

EDITS = {
    "triangulate": lambda bm, some: bmesh.ops.triangulate(bm, faces=some(bm.faces)),
    "poke": lambda bm, some: bmesh.ops.poke(bm, faces=some(bm.faces)),
    "split": lambda bm, some: bmesh.ops.split_edges(bm, edges=some(bm.edges)),
    "collapse": lambda bm, some: bmesh.ops.collapse(bm, edges=some(bm.edges)),
    "dissolve": lambda bm, some: bmesh.ops.dissolve_edges(bm, edges=some(bm.edges)),
    "weld": lambda bm, some: bmesh.ops.remove_doubles(bm, verts=some(bm.verts), dist=0.3),
    "extrude": lambda bm, some: bmesh.ops.extrude_discrete_faces(bm, faces=some(bm.faces)),
    "duplicate": lambda bm, some: bmesh.ops.duplicate(bm, geom=some(bm.faces)),
    "delete": lambda bm, some: bmesh.ops.delete(bm, geom=some(bm.faces), context="FACES_ONLY"),
    "flip": lambda bm, some: bmesh.ops.reverse_faces(bm, faces=some(bm.faces)),
    "subdivide": lambda bm, some: bmesh.ops.subdivide_edges(bm, edges=some(bm.edges), cuts=1),
    "fill": lambda bm, some: bmesh.ops.holes_fill(bm, edges=bm.edges[:], sides=0),
    "connect": lambda bm, some: bmesh.ops.connect_verts(bm, verts=some(bm.verts)),
    "loose": lambda bm, some: bm.verts.new((0.5, 0.5, 0.5)),
}


def make(random):
    """Plain data, as JSON keeps it."""
    start = random.choice(STARTS)
    vertices, faces = mesh_mutations.mutated(start.vertices, [face.tolist() for face in start.faces], random)
    inside = [face for face in faces if all(0 <= v < len(vertices) for v in face) and len(set(face)) == len(face)]
    name = random.choice(OPERATORS)
    return {
        "vertices": vertices.tolist(),
        "faces": inside,
        "edits": [[random.choice(sorted(EDITS)), random.randrange(2**31)] for _ in range(random.choice((0, 0, 1, 2)))],
        "scale": random.choice(([1, 1, 1], [1, 1, 1], [-1, 1, 1], [1, 0, 1], [1e-20, 1, 1e20])),
        "seams": [random.randrange(200) for _ in range(random.choice((0, 0, 3, 9)))],
        "picked": [random.randrange(len(vertices)) for _ in range(random.choice((0, 0, 1, 2, 4)))],
        "editing": random.random() < 0.3,
        "mapped": random.random() < 0.5,
        "operator": name,
        "options": _options(name, random),
    }


def _operator(name):
    return functools.reduce(getattr, name.split("."), bpy.ops)


def _options(name, random):
    """Values of some of an operator's properties, whatever their kind."""
    properties = _operator(name).get_rna_type().properties
    return {p.identifier: _value(p, random) for p in properties if not p.is_readonly and random.random() < 0.15}


def _value(p, random):
    if p.type == "ENUM":
        return random.choice([item.identifier for item in p.enum_items] or SOLVERS)
    if p.type == "BOOLEAN":
        return random.random() < 0.5
    if p.type == "STRING":
        return random.choice(TEXTS)
    low, high = (p.hard_min, p.hard_max) if random.random() < 0.1 else (p.soft_min, min(p.soft_max, 100))
    drawn = [random.choice((low, high, random.uniform(-2, 20))) for _ in range(p.array_length or 1)]
    values = [(int if p.type == "INT" else float)(max(low, min(high, value))) for value in drawn]
    return values if p.is_array else values[0]


def execute(case):
    obj = _object(case)
    if case["editing"]:
        scenes.pick(obj, [v for v in case["picked"] if v < len(obj.data.vertices)])
        _leave_edit_mode()  # which may sort attributes anew
    before = scenes.everything(obj)
    if case["editing"]:
        bpy.ops.object.mode_set(mode="EDIT")
    try:
        _operator(case["operator"])(**case["options"])
    except RuntimeError as error:
        _check_refusal(str(error))
        _leave_edit_mode()
        assert scenes.everything(obj) == before, "a refusal changed the object"
        return
    _leave_edit_mode()
    for layer in obj.data.uv_layers:
        assert np.isfinite(scenes.uv_maps.read_map(obj.data, layer.name)).all(), "a map is not finite"
    if "holomorph_report" in obj:
        json.loads(obj["holomorph_report"], parse_constant=_no_number)


def _no_number(name):
    raise AssertionError(f"the report has {name}")


def _check_refusal(message):
    assert "Traceback" not in message, message
    assert 0 < len(message.strip()) < SENTENCE, message


def _leave_edit_mode():
    if bpy.context.mode == "EDIT_MESH":
        bpy.ops.object.mode_set(mode="OBJECT")


def _some(random, sequence):
    return random.sample(sequence[:], min(len(sequence), random.randrange(1, 6)))


def _object(case):
    """The only one of the scene."""
    _leave_edit_mode()
    for collection in (bpy.data.objects, bpy.data.meshes, bpy.data.materials, bpy.data.images):
        bpy.data.batch_remove(list(collection))
    obj = scenes.mesh_object("Mutated", case["vertices"], case["faces"])
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    for name, seed in case["edits"]:
        EDITS[name](bm, functools.partial(_some, random_numbers.Random(seed)))
    bm.to_mesh(obj.data)
    bm.free()
    for edge in {e for e in case["seams"] if e < len(obj.data.edges)}:
        obj.data.edges[edge].use_seam = True
    obj.scale = case["scale"]
    if case["mapped"]:
        obj.data.uv_layers.new(name="Artist")
    scenes.select(obj)
    return obj


save, load = plain_cases.save, plain_cases.load


def smaller(case):
    yield from plain_cases.with_fewer_options(case)
    for key, value in (("edits", []), ("scale", [1, 1, 1]), ("seams", []), ("picked", []), ("editing", False)):
        if case[key] != value:
            yield case | {key: value}
    yield from plain_cases.with_fewer_faces(case)
