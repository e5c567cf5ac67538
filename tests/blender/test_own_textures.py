"""Images and materials of the user's as textures: their lattice and size; that nothing of them is changed."""

import math

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import edge_jumps, everything, face_densities, run, select, stored_poles, stored_report, torus

own, image_io, material = module("materials.user_texture"), module("scene.image_io"), module("materials.material")
WITHOUT_POLES = {"poles": "COUNT", "pole_count": 0}
FOUND = "Tiles; bricks, rows shifted by half, 16 cells in the image"


def bricks(height=64, width=128, rows=4, columns=4, shift=0.5):
    y, x = np.indices((height, width)) + 0.5
    y, x = y * rows / height, x * columns / width
    x = x + np.floor(y) * shift
    edge = np.minimum(2 * np.minimum(x % 1, 1 - x % 1), np.minimum(y % 1, 1 - y % 1))
    return 0.2 + 0.6 * np.clip((edge - 0.05) / 0.1, 0, 1)


def photo(size=64):
    """What no border continues."""
    y, x = np.indices((size, size)) / size
    return np.hypot(x, y - 0.3) / 1.3


def image(grey, name="Wall", **kind):
    made = bpy.data.images.new(name, grey.shape[1], grey.shape[0], **kind)
    image_io.write_pixels(made, np.dstack([grey, grey, grey, np.ones_like(grey)]))
    made.pack()
    return made


def mine(picture, name="Mine"):
    """A material with the image in a group, as well, and without a link; on its own object it is used by the object."""
    made = bpy.data.materials.new(name)
    tree = module("compatibility").enable_nodes(made)
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    first = tree.nodes.new("ShaderNodeTexImage")
    first.image = picture
    tree.links.new(first.outputs[0], shader.inputs["Base Color"])
    inner = bpy.data.node_groups.new("Inner", "ShaderNodeTree")
    second, place = inner.nodes.new("ShaderNodeTexImage"), inner.nodes.new("ShaderNodeTexCoord")
    second.image = picture
    inner.links.new(place.outputs["UV"], second.inputs["Vector"])
    tree.nodes.new("ShaderNodeGroup").node_tree = inner
    tree.nodes.new("ShaderNodeNormalMap").uv_map = "Artist"
    return made


def tile(**options):
    return bpy.ops.uv.holomorphic_tile(**WITHOUT_POLES | options)


def shown(obj):
    return obj.material_slots[0].material


def lattice(obj):
    return np.array(stored_report(obj)["asked"]["lattice"])


def are_whole(obj, translations):
    """Whether the map jumps by combinations of these columns, but for edges at poles."""
    edges, jumps = edge_jumps(obj)
    jumps = jumps[~np.isin(edges, stored_poles(obj)).any(axis=1)].reshape(-1, 2)
    jumps = np.linalg.solve(translations, jumps.T)
    return np.allclose(jumps, np.rint(jumps), atol=2e-4) and np.abs(jumps).max() > 0.5


def values(tree):
    return {node.name: node.outputs[0].default_value for node in tree.nodes if node.type == "VALUE"}


def trees(block):
    """What can be seen of a node tree and of its groups."""
    tree = block.node_tree
    links = [(link.from_node.name, link.from_socket.name, link.to_node.name) for link in tree.links]
    groups = [trees(node) for node in tree.nodes if node.type == "GROUP"]
    return [node.name for node in tree.nodes], links, groups


@pytest.mark.parametrize("kind", [{}, {"float_buffer": True}, {"alpha": True}])
def test_the_map_jumps_by_the_images_own_translations(kind):
    obj = torus()
    image(bricks(), **kind)
    assert tile(texture="IMAGE", source="Wall") == {"FINISHED"}
    assert np.allclose(lattice(obj), [[0.25, 0.125], [0, 0.125]]) and are_whole(obj, lattice(obj))
    assert bpy.context.active_operator is None or bpy.context.active_operator.found == FOUND
    assert values(shown(obj).node_tree) == {"Repeats": 1, "Image Height": 0.5, "Row Shift": 0}


def test_what_does_not_tile_is_told_and_shown_in_rows():
    obj = torus()
    image(photo())
    assert tile(texture="IMAGE", source="Wall") == {"FINISHED"}
    assert stored_report(obj)["dials"]["own"]["text"].startswith("Does not tile")
    assert are_whole(obj, np.eye(2))


@pytest.mark.parametrize(
    ("name", "expected", "numbers"),
    [
        ("square", [[1, 0], [0, 0.5]], (0.5, 0)),
        ("brick", [[1, 0.5], [0, 0.5]], (0.5, 0.5)),
        ("hex", [[1, 0.5], [0, math.sqrt(0.75)]], (math.sqrt(3), 0)),
    ],
)
def test_a_lattice_that_is_told(name, expected, numbers):
    obj = torus()
    image(np.hstack([photo(), photo()]))
    assert tile(texture="IMAGE", source="Wall", lattice=name) == {"FINISHED"}
    assert are_whole(obj, np.array(expected))
    found = values(shown(obj).node_tree)
    assert np.allclose([found["Image Height"], found["Row Shift"]], numbers)


@pytest.mark.parametrize("size", [(1, 1), (2, 1), (1, 2)])
def test_an_image_of_a_pixel_or_two(size):
    obj = torus()
    image(np.arange(size[0] * size[1]).reshape(size) / 2.0)
    assert tile(texture="IMAGE", source="Wall") == {"FINISHED"}
    assert shown(obj).name == "Holomorphic Wall"


@pytest.mark.parametrize("texture", ["IMAGE", "BRICKS", "CHECKER"])
@pytest.mark.parametrize("repeats", [1, 2])
def test_the_size_is_that_of_an_image_on_the_surface(texture, repeats):
    obj = torus()
    image(bricks(64, 64))
    chosen = {"texture": texture, "source": "Wall", "poles": "AUTOMATIC", "repeats": repeats}
    if texture == "CHECKER":  # maps that turn by quarters have sizes in larger steps
        chosen["turns"] = "NONE"
    for size in (0.2, 0.35):
        assert tile(size=size, **chosen) == {"FINISHED"}
        density = (
            stored_report(obj)["components"][0]["tiling"]["tiles"]
            / module("scene.mesh_io").read_polygons(obj.data, np.eye(3)).surface().area
        )
        assert 1 / math.sqrt(density) / repeats == pytest.approx(size, rel=0.12)


def test_the_size_of_an_object_in_other_units_is_that_of_the_scene():
    """The objects' scale counts."""
    obj = torus()
    obj.scale = (3, 3, 3)
    bpy.context.view_layer.update()
    image(bricks(64, 64))
    tile(texture="IMAGE", source="Wall", size=0.9)
    large = np.median(face_densities(obj))
    obj.scale = (1, 1, 1)
    bpy.context.view_layer.update()
    tile(texture="IMAGE", source="Wall", size=0.3)
    assert np.median(face_densities(obj)) == pytest.approx(large, rel=0.2)


def test_objects_share_a_material_and_a_size():
    first, second = torus("First"), torus("Second")
    image(bricks())
    mine(bpy.data.images["Wall"])
    select(first, second)
    for options in ({"texture": "IMAGE", "source": "Wall"}, {"texture": "MATERIAL", "source": "Mine"}):
        tile(size=0.4, **options)
        assert shown(first) == shown(second)
    densities = [np.median(face_densities(obj)) for obj in (first, second)]
    assert densities[0] == pytest.approx(densities[1], rel=0.1)


@pytest.mark.parametrize("main", ["AUTOMATIC", "BALANCED", "SEAMLESS"])
def test_the_maps_operator_shows_them_too(main):
    obj = torus()
    image(bricks())
    assert run(main=main, texture="IMAGE", source="Wall", size=0.3) == {"FINISHED"}
    assert values(shown(obj).node_tree)["Image Height"] == 0.5
    if main == "SEAMLESS":
        assert are_whole(obj, np.array([[0.25, 0.125], [0, 0.125]]))


def test_a_material_is_copied_and_reads_the_map():
    obj = torus()
    picture = image(bricks())
    user = mine(picture)
    before = trees(user)
    assert tile(texture="MATERIAL", source="Mine") == {"FINISHED"}
    assert trees(user) == before and shown(obj) != user and "holomorph_checker" not in user
    assert np.allclose(lattice(obj), [[0.25, 0.125], [0, 0.125]])
    for tree in (shown(obj).node_tree, next(n.node_tree for n in shown(obj).node_tree.nodes if n.type == "GROUP")):
        (uv,) = [node for node in tree.nodes if node.type == "UVMAP"]
        (reader,) = [node for node in tree.nodes if node.type == "TEX_IMAGE"]
        assert uv.uv_map == "Holomorphic" and reader.inputs["Vector"].is_linked and reader.image == picture
        assert values(tree)["Image Height"] == 0.5
    assert [node.uv_map for node in shown(obj).node_tree.nodes if node.type == "NORMAL_MAP"] == ["Holomorphic"]
    assert [node.uv_map for node in user.node_tree.nodes if node.type == "NORMAL_MAP"] == ["Artist"]


def test_nodes_of_the_same_names_stay():
    obj = torus()
    user = mine(image(bricks()))
    number = user.node_tree.nodes.new("ShaderNodeValue")
    number.name, number.outputs[0].default_value = "Image Height", 7.0
    tile(texture="MATERIAL", source="Mine")
    assert values(shown(obj).node_tree) == {"Image Height": 7, "Repeats": 1, "Image Height.001": 0.5, "Row Shift": 0}


def test_copies_of_a_material_do_not_gather():
    obj = torus()
    mine(image(bricks()))
    for _ in range(3):
        tile(texture="MATERIAL", source="Mine")
        ours = [m for m in bpy.data.materials if m.name.startswith("Holomorph")]
        assert ours == [shown(obj)] and len(bpy.data.node_groups) == 2
    tile(texture="BRICKS")
    assert not [m for m in bpy.data.materials if m.name.startswith("Holomorphic Mine")]


def test_restore_brings_everything_back():
    obj = torus()
    user = mine(image(bricks()))
    obj.data.materials.append(user)
    before = everything(obj)
    for options in ({"texture": "MATERIAL", "source": "Mine"}, {"texture": "IMAGE", "source": "Wall"}):
        tile(**options)
        assert shown(obj) != user
        bpy.ops.uv.holomorphic_remove_maps()
        assert everything(obj) == before


def test_a_material_with_a_mapping_or_without_images_is_taken_as_it_is():
    obj = torus()
    user = mine(image(bricks()))
    place, mapping = user.node_tree.nodes.new("ShaderNodeUVMap"), user.node_tree.nodes.new("ShaderNodeMapping")
    user.node_tree.links.new(place.outputs[0], mapping.inputs["Vector"])
    tile(texture="MATERIAL", source="Mine")
    assert np.allclose(lattice(obj), [[1, 0], [0, 0.5]]) and stored_report(obj)["dials"]["own"]["text"] == "Tiles"
    plain = bpy.data.materials.new("Plain")
    module("compatibility").enable_nodes(plain)
    tile(texture="MATERIAL", source="Plain")
    assert np.allclose(lattice(obj), np.eye(2))
    assert "no images" in stored_report(obj)["dials"]["own"]["text"]


def refusals():
    tiled = bpy.data.images.new("Tiled", 8, 8, tiled=True)
    lost = bpy.data.images.new("Lost", 8, 8)
    lost.source, lost.filepath = "FILE", "/nowhere/lost.png"
    ours = bpy.data.materials.new("Ours")
    ours["holomorph_checker"] = True
    return [
        ("IMAGE", "", "Choose an image"),
        ("MATERIAL", "", "Choose a material"),
        ("IMAGE", "None", "no image 'None'"),
        ("IMAGE", tiled.name, "more than a single picture"),
        ("IMAGE", lost.name, "no pixels"),
        ("MATERIAL", ours.name, "choose that"),
    ]


def test_what_cannot_be_shown_is_told_and_the_redo_panel_stays():
    """It must not vanish: that is where another one is chosen."""
    obj = torus()
    for texture, source, sentence in refusals():
        with pytest.raises(ValueError, match=sentence):
            own.chosen(type("", (), {"texture": texture, "source": source}))
        assert tile(texture=texture, source=source) == {"FINISHED"}
        assert shown(obj).name.startswith("Holomorphic Checker")


def test_numbers_that_are_not_finite():
    torus()
    values = bricks()
    values[3, 4] = math.nan
    image(values, float_buffer=True)
    with pytest.raises(ValueError, match="must be finite"):
        own.chosen(type("", (), {"texture": "IMAGE", "source": "Wall"}))


def test_an_image_is_read_once(monkeypatch):
    picture = image(bricks())
    first = own.symmetries(picture)
    monkeypatch.setattr(own, "holomorph", None)
    assert own.symmetries(picture) is first


def test_poles_are_dragged_under_an_image():
    obj = torus()
    image(bricks())
    tile(texture="IMAGE", source="Wall", pole_count=2)
    before, translations = shown(obj), lattice(obj)
    assert bpy.ops.uv.holomorphic_drag_poles(moves="0:5") == {"FINISHED"}
    assert shown(obj) == before and are_whole(obj, translations)


def test_a_texture_that_is_gone_when_poles_are_dragged():
    obj = torus()
    user = mine(image(bricks()))
    tile(texture="MATERIAL", source="Mine", pole_count=2)
    bpy.data.materials.remove(user)
    try:  # a checker may have its poles elsewhere: the last bits of a processor tell
        assert bpy.ops.uv.holomorphic_drag_poles(moves="0:5") == {"FINISHED"}
    except RuntimeError as error:
        assert "press Update Map" in str(error)
    module("operators.mapping").press(obj)
    assert shown(obj).name.startswith("Holomorphic Checker")


def test_an_image_that_was_loaded_anew():
    obj = torus()
    for _ in range(2):
        picture = image(bricks())
        tile(texture="IMAGE", source="Wall")
        assert [n.image for n in shown(obj).node_tree.nodes if n.type == "TEX_IMAGE"] == [picture]
        bpy.data.images.remove(picture)
    assert len([m for m in bpy.data.materials if m.name.startswith("Holomorphic Wall")]) == 1


def test_cells_follow_the_lattice():
    obj = torus()
    image(bricks())
    tile(texture="IMAGE", source="Wall")
    assert bpy.ops.object.holomorphic_cells(columns=1, rows=1) == {"FINISHED"}
    area = stored_report(obj)["components"][0]["tiling"]["tiles"]
    assert len(bpy.data.objects["Torus Cells"].data.polygons) > 8 * area
