"""One answer at four doors: Python, the command, batches, and the button after Blender's own import: the same faces,
topology, kinds of map, sizes and joined vertices of each file, or the same sentence."""

import contextlib
import importlib
import io
import json
import re
from dataclasses import dataclass

import bpy
import door_files
import numpy as np
import pytest
from headless_runs import BLENDER
from loaded_addon import module
from scenes import mesh_io, native, uv_maps

gathering, compatibility = module("scene.gathering"), module("compatibility")
holomorph = native.load()
command, recipe, task = (
    importlib.import_module(f"{holomorph.__name__}.{name}") for name in ("__main__", "batch.recipe", "batch.task")
)
FILES = door_files.own_files() | door_files.shared_files()
READ = (".obj", ".off", ".ply", ".stl")  # by the package at every door
SCENES = (".glb",)  # by the package in Python and by its command, by Blender at the others
TURNS = {1: "NONE", 4: "QUARTER"}
TURNING = ["of_faces.glb", "in_charts.ply", "two_sided.off", "torus.stl"]  # those that are also mapped with turns
NEAR = 0.02  # relative: sizes in single and in double precision
TURNED = 0.2  # where Blender turns a file upright: poles look for places that are hidden from sampled directions


@dataclass
class Answer:
    """refused : a sentence; else parts : what is said of each; joined : number of vertices; sizes : quantiles of the
    root of the density over the faces, () of several objects"""

    refused: str = ""
    parts: tuple = ()
    joined: int = 0
    sizes: tuple = ()

    @classmethod
    def of(cls, reports, joined, sizes):
        parts = sorted(map(said, reports), key=repr)
        return cls(parts=tuple(parts), joined=joined, sizes=sizes)


def said(part):
    if not part["done"]:
        return "left out", part["faces"], part["reason"]
    tiles = round(part["tiling"]["tiles"], 1) if "tiling" in part else None
    return part["main_map"]["kind"], part["faces"], part["genus"], part["boundary_count"], tiles


def sizes_of(points, corners, offsets, uv):
    """Roots of the densities of the faces that are mapped: quantiles by area."""
    starts, counts = offsets[:-1], np.diff(offsets)
    face, following = np.repeat(np.arange(len(counts)), counts), np.arange(len(corners)) + 1
    following[offsets[1:] - 1] = starts
    own, others = points[corners] - points[corners][starts][face], points[corners][following]
    areas = 0.5 * np.cross(own, others - points[corners][starts][face])
    areas = np.linalg.norm(np.add.reduceat(areas, starts, axis=0), axis=1)
    plane = (uv - uv[starts][face]) @ [1, 1j]
    flat = np.abs(np.add.reduceat((plane.conj() * plane[following]).imag, starts)) / 2
    mapped = flat > 0
    found, areas = np.sqrt(flat[mapped] / areas[mapped]), areas[mapped]
    order = np.argsort(found)
    shares = np.cumsum(areas[order]) / areas.sum()
    return tuple(found[order][np.searchsorted(shares, (0.1, 0.5, 0.9)).clip(max=len(found) - 1)])


# ---- the doors -------------------------------------------------------------------------------------------------------


def in_python(path, _folder, turns):
    try:
        surface = holomorph.Surface.read(path)
        parts, maps = surface.components, holomorph.automatic_maps(surface, turns=turns)
    except holomorph.Error as error:
        return Answer(refused=str(error))
    report, made = holomorph.report, [found for found in maps if hasattr(found, "uv")]
    entries = [report.part_report(m) if m in made else report.skipped_report(p, m) for p, m in zip(parts, maps)]
    entries += map(report.refused_report, surface.refused)
    uv = holomorph.arrangement.arranged(made, int(surface.corner_index.max()) + 1)[surface.corner_index]
    arrays = surface.vertices, surface.corner_vertices, surface.face_offsets
    return Answer.of(entries, len(surface.repairs.joined_vertices), sizes_of(*arrays, uv))


def by_command(path, folder, turns):
    out, report, told = folder / "out.obj", folder / "report.json", io.StringIO()
    with contextlib.redirect_stderr(told):
        status = command.main([str(path), "--turns", str(turns), "--output", str(out), "--report", str(report)])
    if status:
        return Answer(refused=told.getvalue().splitlines()[-1].removeprefix("holomorph: "))
    content = json.loads(report.read_text())
    words = [line.split() for line in out.read_text().splitlines()]
    points, uvs = (np.array([w[1:] for w in words if w[0] == name], float) for name in ("v", "vt"))
    faces = [[corner.split("/") for corner in w[1:]] for w in words if w[0] == "f"]
    corners = np.array([corner for face in faces for corner in face], int) - 1
    sizes = sizes_of(points, corners[:, 0], np.cumsum([0, *map(len, faces)]), uvs[corners[:, 1]])
    return Answer.of(content["components"], content["repairs"]["joined_vertices"]["count"], sizes)


def by_batch(path, folder, turns):
    tasks = [(path, None)]
    if path.suffix not in READ:
        record, files = task.Task(path.name, "key", path, 1, folder, folder, blender=BLENDER).run()
        assert record["status"] == "done", record["message"]
        for name, content in files.items():
            (folder / name).write_bytes(content)
        tasks = [(arrays, (str(path), name)) for name, arrays, _ in task.objects(folder)]
    wanted = recipe.of({"output": {"formats": ["npz"]}, "tiling": {"turns": turns}})
    entries, joined, sizes = [], 0, []
    for source, scene in tasks:
        one = task.Task(path.name, "key", source, 1, folder, folder, wanted, scene, BLENDER)
        record, files = one.run()
        if record["status"] != "done":
            return Answer(refused=record["message"])
        report, made = json.loads(files["report.json"]), np.load(io.BytesIO(files["mesh.npz"]))
        entries += report["components"]
        joined += report["repairs"]["joined_vertices"]["count"]
        sizes.append(sizes_of(*(made[name] for name in ("vertices", "corner_vertices", "face_offsets", "uv"))))
    return Answer.of(entries, joined, sizes[0] if len(sizes) == 1 else ())


def by_button(path, _folder, turns):
    """None where Blender does not import the polygons of the file."""
    try:
        import_file(path)
    except RuntimeError:
        return None
    found = [obj for obj in bpy.context.scene.objects if obj.type == "MESH" and not gathering.is_helper(obj)]
    if not found or not sum(len(obj.data.polygons) for obj in found):
        return None
    for obj in bpy.context.scene.objects:
        obj.select_set(obj in found)
    bpy.context.view_layer.objects.active = found[0]
    try:
        bpy.ops.uv.holomorphic_maps(turns=TURNS[turns])
    except RuntimeError as error:
        return Answer(refused=str(error).strip().removeprefix(f"Error: {found[0].name}: "))
    return of_scene([json.loads(obj["holomorph_report"]) for obj in sorted(found, key=lambda obj: obj.name)])


def import_file(path):
    with compatibility.old_numpy_names():
        compatibility.openers()[path.suffix](filepath=str(path))
    bpy.context.view_layer.update()


def of_scene(entries):
    reports, joined, meshes = [], 0, []
    for entry in entries:
        reports += entry["components"]
        joined += entry["repairs"]["joined_vertices"]["count"]
        obj = bpy.data.objects[entry["object"]]
        polygons = mesh_io.read(obj)
        uv = uv_maps.read_corners(obj.data, polygons, entry["maps"][0]["name"]).astype(float)
        points = np.nan_to_num(polygons.vertices)
        meshes.append(sizes_of(points, polygons.corner_vertices, polygons.face_offsets, uv))
    return Answer.of(reports, joined, meshes[0] if len(meshes) == 1 else ())


# ---- their answers ---------------------------------------------------------------------------------------------------


def same(one, other, near=NEAR, numbered=True):
    """near : relative, of sizes, and if it is `NEAR`, of numbers of tiles, where both are of one object
    numbered : whether the doors count elements alike: OBJ files count from 1, Blender from 0"""
    words = [str((a.refused, sorted(str(part[:4]) for part in a.parts), a.joined)) for a in (one, other)]
    if not numbered:
        words = [re.sub(r"(vertex|face) \d+", r"\1", text) for text in words]
    if words[0] != words[1] or not (one.sizes and other.sizes):
        return words[0] == words[1]
    tiles = [sorted(part[4] for part in a.parts if part[4:] and part[4]) for a in (one, other)]
    return (near > NEAR or np.allclose(*tiles, rtol=near)) and np.allclose(one.sizes, other.sizes, rtol=near)


def without(left_out):
    return tuple(part for part in left_out if part[0] != "left out")


def as_imported(answer, found):
    """The answer without the faces that Blender's importer has dropped."""
    faces = [sum(part[1] for part in one.parts) for one in (answer, found)]
    return Answer(answer.refused, without(answer.parts), answer.joined, answer.sizes) if faces[0] > faces[1] else answer


@pytest.mark.parametrize(("name", "turns"), [*((name, 1) for name in FILES), *((name, 4) for name in TURNING)])
def test_doors_agree(name, turns, tmp_path):
    path = tmp_path / name
    path.write_bytes(FILES[name])
    answers = {}
    for door in (in_python, by_command, by_batch, by_button):
        if door in (in_python, by_command) and name in CHANGED_BY_IMPORTERS and path.suffix in SCENES:
            continue
        if door is by_batch and not may_batch(path):
            continue
        if door is by_button and path.suffix == ".off":
            continue
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        (tmp_path / door.__name__).mkdir()
        answers[door.__name__] = door(path, tmp_path / door.__name__, turns)
    button, turned = answers.pop("by_button", None), TURNED if path.suffix in (".obj", *SCENES) else NEAR
    if not answers:
        pytest.skip("no door but Blender's own importer reads it here")
    first = next(iter(answers.values()))
    near = TURNED if path.suffix in SCENES else NEAR  # Blender reads these for batches
    assert all(same(first, answer, near) for answer in answers.values()), answers
    if button is not None and name not in CHANGED_BY_IMPORTERS:
        own = Answer(first.refused.removeprefix(f"{path}: "))  # the button knows of no file
        wanted = own if first.refused else as_imported(first, button)
        assert same(wanted, button, turned, numbered=False), (wanted, button)


def may_batch(path):
    return path.suffix in READ or BLENDER


# Files of which Blender's importers make other faces: they repair polygons with bridges, and drop copies of faces;
# newer ones do so in OBJ files, too, and read 0 for what is no number.
CHANGED_BY_IMPORTERS = ["hard_bracket.obj", "two_sided.stl", "two_sided_shared.glb"]
if bpy.app.version >= (4, 0):
    CHANGED_BY_IMPORTERS += ["hard_double_sided.obj", "not_finite.obj", "twice.obj", "two_sided_shared.obj"]


def test_there_are_eighty():
    assert len(FILES) >= (80 if door_files.shared_files() else 50)
