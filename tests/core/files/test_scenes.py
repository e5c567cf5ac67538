"""glTF and 3MF as one mesh: what other readers find there, at its place; and whatever is wrong, one sentence."""

import base64
import json
import struct
import zipfile
from io import BytesIO

import door_files
import families
import numpy as np
import pytest
from holomorph import InvalidMesh, Surface
from holomorph.files import printing, scenes
from holomorph.tiles.relief import plain
from solved import surface_of

trimesh = pytest.importorskip("trimesh")
pytest.importorskip("networkx")
pytest.importorskip("lxml")
TETRAHEDRON = families.single(families.tetrahedron())
MODEL = "3D/3dmodel.model"


def written(path, content):
    path.write_bytes(content)
    return path


def chunks(content):
    """(JSON, binary) of a GLB file."""
    size = struct.unpack_from("<I", content, 12)[0]
    return json.loads(content[20 : 20 + size]), content[28 + size :]


def text_file(path, about, binary):
    about["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    return written(path, json.dumps(about).encode())


def seen_by_trimesh(path):
    mesh = trimesh.load(path, force="mesh", process=False)
    return np.asarray(mesh.triangles)


def corners(surface):
    return surface.vertices[surface.triangles]


def are_same(one, other):
    """Whether two arrays of triangles, (n, 3, 3), are the same in any order."""
    keys = [sorted(sorted(map(tuple, each)) for each in (np.round(rows, 4) + 0.0).tolist()) for rows in (one, other)]
    return keys[0] == keys[1]


@pytest.mark.parametrize("name", ["torus.glb", "in_charts.glb", "of_faces.glb", "primitives.glb", "nodes.glb"])
def test_glb_has_the_surface_that_files_of_polygons_have(name, tmp_path):
    """Vertices that the file has apart are joined; strict, they are welded."""
    path = written(tmp_path / name, door_files.own_files()[name])
    surface = Surface.read(path)
    parts = 2 if name in ("primitives.glb", "nodes.glb") else 1
    assert len(surface.components) == parts and surface.components[0].genus == 1 and surface.up == "Y"
    assert are_same(corners(surface), seen_by_trimesh(path))
    assert len(Surface.read(path, strict=True).components) == parts
    assert Surface.read(path, up="Z").up == "Z"


def test_nodes_move_turn_and_mirror_what_they_hold(tmp_path):
    about, binary = chunks(door_files.gltf([TETRAHEDRON]))
    turn = np.array([0.1, -0.5, 0.3, 0.8])
    about["nodes"] = [
        {"children": [1, 2], "translation": [1, 2, 3], "rotation": (turn / np.linalg.norm(turn)).tolist()},
        {"mesh": 0, "scale": [1, 2, -3], "rotation": [0, 0, np.sqrt(0.5), np.sqrt(0.5)]},
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 5, 0, 0, 1]},
        {"mesh": 0, "translation": [50, 0, 0]},
    ]
    about["scenes"] = [{"nodes": [0]}]
    path = text_file(tmp_path / "nodes.gltf", about, binary)
    surface = Surface.read(path)
    assert are_same(corners(surface), seen_by_trimesh(path)) and len(surface.components) == 2
    volumes = [np.linalg.det(corners(part)).sum() for part in surface.components]
    outward = np.linalg.det(corners(surface_of(TETRAHEDRON))).sum()
    assert np.sign(volumes).tolist() == [np.sign(outward)] * 2
    del about["scenes"], about["scene"]  # all nodes that no other one holds
    assert len(Surface.read(text_file(path, about, binary)).components) == 3
    about["nodes"][2]["skin"] = 0  # its bones would put it elsewhere
    found = Surface.read(text_file(path, about, binary))
    assert any((part.vertices.min(axis=0) == TETRAHEDRON.vertices.min(axis=0)).all() for part in found.components)


@pytest.mark.parametrize(
    ("mode", "drawn", "wanted"),
    [
        (5, [0, 1, 2, 3, 3, 5, 5, 1, 0], [[0, 1, 2], [2, 1, 3], [5, 1, 0]]),
        (6, [0, 1, 2, 4, 5, 1], [[0, 1, 2], [0, 2, 4], [0, 4, 5], [0, 5, 1]]),
    ],
)
def test_strips_and_fans(mode, drawn, wanted, tmp_path):
    """Faces of an octahedron: bands that triangles of two corners join, and those around a corner."""
    points = np.concatenate([np.eye(3), -np.eye(3)]).astype(np.float32)
    indices = np.array(drawn, np.uint32)
    about, _ = chunks(door_files.gltf([TETRAHEDRON]))
    about["accessors"] = [
        {"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"},
    ]
    about["bufferViews"] = [{"buffer": 0, "byteLength": 72}, {"buffer": 0, "byteOffset": 72, "byteLength": 40}]
    about["meshes"][0]["primitives"][0]["mode"] = mode
    path = text_file(tmp_path / "drawn.gltf", about, points.tobytes() + indices.tobytes().ljust(40, b"\0"))
    surface = Surface.read(path)
    assert are_same(corners(surface), points[wanted]) and not len(surface.repairs.reversed_faces)


def test_numbers_of_few_bits_beside_the_file(tmp_path):
    """Interleaved with others, as fractions of a byte."""
    rows = np.zeros((4, 8), np.int8)
    rows[:, :3] = np.round(TETRAHEDRON.vertices / np.abs(TETRAHEDRON.vertices).max() * 127)
    about, _ = chunks(door_files.gltf([TETRAHEDRON]))
    about["accessors"][0] |= {"componentType": 5120, "normalized": True}
    about["accessors"][1] |= {"componentType": 5121, "byteOffset": 1}
    about["bufferViews"] = [
        {"buffer": 0, "byteLength": 32, "byteStride": 8},
        {"buffer": 0, "byteOffset": 32, "byteLength": 13},
    ]
    binary = rows.tobytes() + b"\xff" + TETRAHEDRON.corners.astype(np.uint8).tobytes()
    about["buffers"] = [{"byteLength": len(binary), "uri": "the%20numbers.bin"}]
    about["extensionsRequired"] = ["KHR_mesh_quantization"]
    written(tmp_path / "the numbers.bin", binary)
    found = Surface.read(written(tmp_path / "few.gltf", json.dumps(about).encode()))
    assert np.allclose(np.sort(found.vertices, axis=0), np.sort(rows[:, :3] / 127, axis=0)) and found.genus == 0


def changed(change):
    about, binary = chunks(door_files.gltf([TETRAHEDRON]))
    change(about)
    return about, binary


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda a: a.update(extensionsRequired=["KHR_draco_mesh_compression"]), "compressed (KHR_draco"),
        (lambda a: a["asset"].update(version="1.0"), "glTF 1.0"),
        (lambda a: a["asset"].update(version="20.0"), "glTF 20.0"),
        (lambda a: a["nodes"][0].update(children=[0]), "no tree"),
        (lambda a: a["accessors"][0].pop("bufferView"), "accessor 0 has no numbers"),
        (lambda a: a["accessors"][0].update(count=10**9), "damaged"),
        (lambda a: a["bufferViews"][0].update(byteStride=0), "overlap"),
        (lambda a: a["accessors"][1].update(componentType=5121), "vertex"),
        (lambda a: a.pop("accessors"), "no 'accessors'"),
        (lambda a: a.update(nodes=7), "damaged: it cannot be read as glTF"),
        (lambda a: a["meshes"][0]["primitives"][0].update(mode=1), "no faces"),
        (lambda a: a["scenes"][0].update(nodes=[3]), "damaged"),
    ],
)
def test_what_cannot_be_read_is_said(change, told, tmp_path):
    path = text_file(tmp_path / "wrong.gltf", *changed(change))
    with pytest.raises(InvalidMesh) as caught:
        Surface.read(path)
    assert told in str(caught.value) and len(str(caught.value).splitlines()) == 1


def test_a_binary_file_of_an_earlier_version_is_told(tmp_path):
    content = bytearray(door_files.gltf([TETRAHEDRON]))
    content[4] = 1
    with pytest.raises(InvalidMesh, match="this is glTF 1; 2.0 is needed"):
        Surface.read(written(tmp_path / "old.glb", bytes(content)))


@pytest.mark.filterwarnings("error")
def test_faces_with_an_infinite_corner_are_refused(tmp_path):
    about, binary = chunks(door_files.gltf([TETRAHEDRON]))
    binary = np.full(3, np.inf, np.float32).tobytes() + bytes(binary)[12:]
    surface = Surface.read(text_file(tmp_path / "infinite.gltf", about, binary))
    assert len(surface.triangles) == 1 and "3 faces" in str(surface.refused)


def test_a_file_that_repeats_its_mesh_stays_small(monkeypatch, tmp_path):
    monkeypatch.setattr(scenes, "MOST_TRIANGLES", 7)
    path = written(tmp_path / "nodes.glb", door_files.gltf([TETRAHEDRON]))
    assert len(Surface.read(path).triangles) == 4
    with pytest.raises(InvalidMesh, match="repeats its meshes"):
        Surface.read(written(path, door_files.gltf([TETRAHEDRON], [TETRAHEDRON])))


@pytest.mark.parametrize("name", ["absent.glb", "absent.gltf", "absent.3mf"])
def test_an_absent_file_is_named(name, tmp_path):
    with pytest.raises(InvalidMesh, match=rf"{name}: there is no such file"):
        Surface.read(tmp_path / name)


# ---- 3MF -----------------------------------------------------------------------------------------------------------


def package(*models, relations=""):
    """The bytes of a 3MF file of (name, text) parts."""
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in models:
            archive.writestr(name, text)
        if relations:
            archive.writestr("_rels/.rels", relations)
    return buffer.getvalue()


def listed(mesh):
    """Its element, attributes in another order than usual and with one more."""
    vertices = "".join(f'<vertex z=\'{z!r}\' x = "{x!r}" y="{y!r}"/>' for x, y, z in mesh.vertices.tolist())
    triangles = "".join(f'<triangle v2="{b}" v1="{a}" v3="{c}" pid="7" p1="0" />\n' for a, b, c in mesh.faces)
    return f"<mesh>\n<vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"


def model(objects, items, unit="millimeter"):
    core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    production = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
    return (
        f'<?xml version="1.0"?><model unit="{unit}" xmlns="{core}" xmlns:p="{production}"><resources>'
        f"{objects}</resources><build>{items}</build></model>"
    )


@pytest.mark.parametrize("with_another", [False, True])
def test_3mf_as_it_is_written(with_another, tmp_path):
    surface = surface_of(families.triangles_of(families.torus(12, 8)))
    path = written(tmp_path / "part.3mf", printing.content("part.3mf", plain(surface)))
    found = Surface.read(path, strict=with_another)
    assert (found.genus, found.boundary_count, found.up) == (1, 0, "Z")
    assert are_same(corners(found), seen_by_trimesh(path))


def test_items_and_components_have_places_and_units(tmp_path):
    objects = f'<object id="1">{listed(TETRAHEDRON)}</object><object id="2"><components>'
    objects += '<component objectid="1" transform="0 1 0 -1 0 0 0 0 1 4 0 0"/><component objectid="1"/>'
    items = "</components></object>"
    build = '<item objectid="2" transform="2 0 0 0 1 0 0 0 1 0 7 0"/>'
    build += '<item objectid="1" transform="1 0 0 0 1 0 0 0 1 9 9 9"/>'
    path = written(tmp_path / "parts.3mf", package((MODEL, model(objects + items, build, "inch"))))
    surface = Surface.read(path)
    assert len(surface.components) == 3
    wanted = [TETRAHEDRON.vertices @ turn.T + place for turn, place in (
        (np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]), [4, 0, 0]), (np.eye(3), [0, 0, 0]),
    )]  # fmt: skip
    wanted = [rows * [2, 1, 1] + [0, 7, 0] for rows in wanted] + [TETRAHEDRON.vertices + 9]
    for part, rows in zip(surface.components, wanted):
        assert np.allclose(np.sort(part.vertices, axis=0), np.sort(25.4 * rows, axis=0))


def test_parts_of_the_package_hold_objects(tmp_path):
    """As programs that slice write them."""
    other = model(f'<object id="5">{listed(TETRAHEDRON)}</object>', "")
    objects = '<object id="1"><components><component p:path="/3D/Objects/a.model" objectid="5"/></components></object>'
    kind = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
    relations = f'<Relationships xmlns="x"><Relationship Target="/3D/main.model" Id="a" Type="{kind}"/></Relationships>'
    parts = ("3D/main.model", model(objects, '<item objectid="1"/>')), ("3D/Objects/a.model", other)
    assert Surface.read(written(tmp_path / "part.3mf", package(*parts, relations=relations))).genus == 0


ONE = f'<object id="1">{listed(TETRAHEDRON)}</object>'
FROM = '<object id="2"><components><component objectid="1" p:path="%s"/></components></object>'
POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n"
LOOP = '<object id="1"><components><component objectid="1"/></components></object>'


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"PK\3\4", "damaged"),
        (package(("other", "")), "it has no part 3D/3dmodel.model"),
        (package((MODEL, "<model>")), "damaged"),
        (package((MODEL, model(LOOP, '<item objectid="1"/>'))), "part of itself"),
        (package((MODEL, model("", '<item objectid="1"/>'))), "it has no object 1 in 3D/3dmodel.model"),
        (package((MODEL, model("", ""))), "no faces"),
        (package((MODEL, " " * 2**25)), "packed"),
        (package((MODEL, model("", "", "mile"))), "its unit is 'mile'; one of micron"),
        (package((MODEL, model(ONE, '<item objectid="1" transform="1 0 0"/>'))), "cannot be read as 3MF"),
        (package((MODEL, model(ONE.replace('v1="0"', 'v1="0.5"'), '<item objectid="1"/>'))), "v1='0.5'"),
        (package((MODEL, model(ONE.replace('y="', 'y="1,'), '<item objectid="1"/>'))), "decimal points"),
        (package((MODEL, model(FROM % "/3D/absent.model", '<item objectid="2"/>'))), "no part /3D/absent.model"),
        (POINTER, "a pointer of Git LFS"),
        (package((MODEL, model(ONE.replace('v1="0"', ""), '<item objectid="1"/>'))), "a triangle of it has no v1"),
        (package((MODEL, model(ONE.replace('v1="0"', 'v1="-1"'), '<item objectid="1"/>'))), "vertex -1"),
    ],
)
def test_wrong_packages_are_refused(content, told, tmp_path):
    with pytest.raises(InvalidMesh) as caught:
        Surface.read(written(tmp_path / "wrong.3mf", content))
    assert told in str(caught.value) and len(str(caught.value).splitlines()) == 1


def of_package(path, objects=ONE, items='<item objectid="1"/>', name=MODEL, relations=""):
    written(path, package((name, model(objects, items)), relations=relations))
    surface = Surface.read(path)
    return len(surface.triangles), surface.repairs.notes


def test_comments_and_blanks_of_xml_are_no_elements(tmp_path):
    path = tmp_path / "part.3mf"
    for text in (
        ONE.replace("<vertices>", "<vertices><!-- was <vertex x='9' y='9' z='9'/> -->"),
        ONE.replace("<triangles>", "<triangles ><!-- <triangle v1='0' v2='0' v3='0'/> -->"),
        ONE.replace("<vertices>", "<vertices\n>").replace("</triangles>", "</triangles\t>"),
        ONE.replace("/>", "><metadata/></vertex>", 1),
    ):
        assert of_package(path, text) == (4, ())


@pytest.mark.parametrize("name", ["3D/3DModel.model", "3D\\3dmodel.model", "/3d/3dmodel.MODEL"])
@pytest.mark.parametrize("target", ["/3D/3dmodel.model", "3D/3dmodel.model", "", "/3D/3dmodel%2Emodel"])
def test_names_of_parts_in_any_case_with_either_slash(name, target, tmp_path):
    kind = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
    relations = f'<Relationships xmlns="x"><Relationship Target="{target}" Id="a" Type="{kind}"/></Relationships>'
    assert of_package(tmp_path / "part.3mf", name=name, relations=relations if target else "") == (4, ())


def test_what_is_not_read_of_a_3mf_is_named(tmp_path):
    path, both = tmp_path / "part.3mf", '<item objectid="1"/><item objectid="2"/>'
    for kind in ("support", "solidsupport"):
        second = f'<object id="2" type="{kind}">{listed(TETRAHEDRON)}</object>'
        assert of_package(path, ONE + second, both) == (4, ("its objects for support are not read",))
    for empty in ("<mesh><vertices/><triangles/></mesh>", "", "<mesh/>"):
        assert of_package(path, f'{ONE}<object id="2">{empty}</object>', both) == (4, ("object 2 has no triangles",))
    lattice = "<beamlattice><beams><beam v1='0' v2='1'/></beams></beamlattice></mesh>"
    assert of_package(path, ONE.replace("</mesh>", lattice)) == (4, ("its beam lattices are not read",))


# ---- glTF as other programs write it ---------------------------------------------------------------------------------


def of_gltf(path, change):
    return Surface.read(text_file(path, *changed(change)))


def test_points_and_lines_beside_triangles_are_named(tmp_path):
    def add(about):
        about["meshes"][0]["primitives"][:0] = [
            {"mode": 0, "attributes": {"POSITION": 0}}, {"mode": 3, "attributes": {"POSITION": 0}}, {"attributes": {}}
        ]  # fmt: skip

    surface = of_gltf(tmp_path / "mixed.gltf", add)
    assert len(surface.triangles) == 4 and len(surface.repairs.notes) == 1 and "lines" in surface.repairs.notes[0]


@pytest.mark.parametrize("has_view", [True, False])
def test_sparse_accessors(has_view, tmp_path):
    about, binary = chunks(door_files.gltf([TETRAHEDRON]))
    given = Surface.read(text_file(tmp_path / "plain.gltf", *chunks(door_files.gltf([TETRAHEDRON])))).vertices
    places = np.arange(4) if not has_view else np.array([1, 3])
    values = given[places] * 2
    start = len(binary)
    binary = bytes(binary) + values.astype("<f4").tobytes() + places.astype("<u2").tobytes()
    about["buffers"] = [{"byteLength": len(binary)}]
    views = about["bufferViews"]
    views += [{"buffer": 0, "byteOffset": start, "byteLength": 12 * len(places)}]
    views += [{"buffer": 0, "byteOffset": start + 12 * len(places), "byteLength": 2 * len(places)}]
    sparse = {
        "count": len(places),
        "indices": {"bufferView": len(views) - 1, "componentType": 5123},
        "values": {"bufferView": len(views) - 2},
    }
    about["accessors"][0]["sparse"] = sparse
    if not has_view:
        del about["accessors"][0]["bufferView"]
    surface = Surface.read(text_file(tmp_path / "sparse.gltf", about, binary))
    wanted = given.copy()
    wanted[places] *= 2
    assert np.array_equal(surface.vertices, wanted) and surface.genus == 0


@pytest.mark.parametrize("tail", [b"\0", b"more", b"\0" * 12, b"\x05\0\0\0TAILstuff"])
def test_bytes_after_the_chunks(tail, tmp_path):
    content = door_files.gltf([TETRAHEDRON])
    assert Surface.read(written(tmp_path / "trailing.glb", content + tail)).genus == 0


@pytest.mark.parametrize("tail", [b"\0\0", b"\n\n", b" // end"])
def test_bytes_about_the_text(tail, tmp_path):
    path = text_file(tmp_path / "padded.gltf", *chunks(door_files.gltf([TETRAHEDRON])))
    assert Surface.read(written(path, b"\xef\xbb\xbf\r\n" + path.read_bytes() + tail)).genus == 0


def test_every_instance_is_there(tmp_path):
    about, binary = chunks(door_files.gltf([TETRAHEDRON]))
    moves, turns = np.array([[0, 0, 0], [9, 0, 0], [0, 9, 0]]), np.array([[0, 0, 0, 1], [0, 1, 0, 0], [1, 0, 0, 0]])
    scales = np.array([[1, 1, 1], [2, 2, 2], [1, 1, -1]])
    start, attributes = len(binary), {"_ID": 0}
    for name, rows in (("TRANSLATION", moves), ("ROTATION", turns), ("SCALE", scales)):
        attributes[name] = len(about["accessors"])
        kind = f"VEC{rows.shape[1]}"
        view = {"buffer": 0, "byteOffset": start, "byteLength": rows.size * 4}
        about["accessors"].append(
            {"bufferView": len(about["bufferViews"]), "componentType": 5126, "count": 3, "type": kind}
        )
        about["bufferViews"].append(view)
        binary, start = bytes(binary) + rows.astype("<f4").tobytes(), start + rows.size * 4
    about["buffers"] = [{"byteLength": len(binary)}]
    about["nodes"][0] |= {
        "translation": [100, 0, 0],
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}},
    }
    surface = Surface.read(text_file(tmp_path / "instances.gltf", about, binary))
    parts = surface.components
    assert len(parts) == 3
    own = TETRAHEDRON.vertices
    wanted = [own, 2 * own * [-1, 1, -1] + [9, 0, 0], own * [1, -1, 1] + [0, 9, 0]]
    for part, rows in zip(parts, wanted):
        assert np.allclose(np.sort(part.vertices, axis=0), np.sort(rows + [100, 0, 0], axis=0))
    assert len({np.sign(np.linalg.det(corners(part) - part.vertices.mean(axis=0)).sum()) for part in parts}) == 1


@pytest.mark.parametrize("name", ["KHR_draco_mesh_compression", "EXT_meshopt_compression"])
@pytest.mark.parametrize("is_declared", [True, False])
def test_compressed_files_are_told_to_be_so(name, is_declared, tmp_path):
    about, _ = chunks(door_files.gltf([TETRAHEDRON]))
    primitive = about["meshes"][0]["primitives"][0]
    if "draco" in name:
        primitive["extensions"] = {name: {"bufferView": 0, "attributes": {"POSITION": 0}}}
        for accessor in about["accessors"]:
            accessor.pop("bufferView")
    else:
        for view in about["bufferViews"]:
            view["extensions"] = {name: {"buffer": 1}}
    about |= {"extensionsUsed": [name]} | ({"extensionsRequired": [name]} if is_declared else {})
    path = written(tmp_path / "packed.gltf", json.dumps(about).encode())
    with pytest.raises(InvalidMesh, match=rf"packed.gltf: it is compressed \({name}\)"):
        Surface.read(path)


@pytest.mark.parametrize("ending", ["glb", "gltf", "3mf", "obj", "off", "ply", "stl", "GLB", "OBJ"])
def test_pointers_of_git_are_told_to_be_so(ending, tmp_path):
    with pytest.raises(InvalidMesh, match="this is a pointer of Git LFS, not the model"):
        Surface.read(written(tmp_path / f"model.{ending}", POINTER))


@pytest.mark.parametrize("ending", ["glb", "gltf", "3mf"])
def test_any_damage_is_refused_in_one_sentence_or_read(ending, tmp_path):
    about, binary = chunks(door_files.gltf([TETRAHEDRON]))
    path = text_file(tmp_path / "whole.gltf", about, binary)
    whole = {
        "glb": lambda: door_files.gltf([TETRAHEDRON]),
        "gltf": path.read_bytes,
        "3mf": lambda: package(
            (MODEL, model(f'<object id="1">{listed(TETRAHEDRON)}</object>', '<item objectid="1"/>'))
        ),
    }[ending]()
    random, refused = np.random.default_rng(7), 0
    for trial in range(400):
        content = np.frombuffer(whole, np.uint8).copy()
        content[random.integers(0, len(content), 1 + trial % 3)] = random.integers(0, 256)
        content = content[: random.integers(1, len(content))] if trial % 4 == 0 else content
        try:
            Surface.read(written(tmp_path / f"damaged.{ending}", content.tobytes()))
        except InvalidMesh as error:
            refused += len(str(error).splitlines()) == 1
    assert refused > 100
