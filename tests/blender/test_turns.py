"""Maps whose cut sides also turn by the symmetry of the texture: the dial, what is written, told, drawn and refused."""

import bpy
import numpy as np
import pytest
from drawn_images import checker, hexagons
from loaded_addon import module
from scenes import (
    edge_sides,
    everything,
    mesh_object,
    polygon_arrays,
    report,
    run,
    select,
    shown_scale,
    sphere_arrays,
    stored_report,
    torus,
    turned_jumps,
    uv,
)

material, patterns, marks = (
    module(f"{name}") for name in ("materials.material", "materials.patterns", "overlays.marks_view")
)
own, image_io = module("materials.user_texture"), module("scene.image_io")
WORDS = {2: "half turns", 4: "quarter turns", 6: "sixth turns"}
NAMES = {2: "HALF", 4: "QUARTER", 6: "SIXTH"}


def suzanne(levels=1):
    """Blender's monkey, subdivided: closed up, for its eyes are parts of their own."""
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    obj.modifiers.new("Smooth", "SUBSURF").levels = levels
    bpy.ops.object.modifier_apply(modifier="Smooth")
    return obj


def ball():
    return mesh_object("Ball", *sphere_arrays(3))


def tile(**options):
    return bpy.ops.uv.holomorphic_tile(**options)


def tilings(obj):
    return [part["tiling"] for part in stored_report(obj)["components"] if "tiling" in part]


@pytest.mark.parametrize("turns", [2, 4])
@pytest.mark.parametrize("make", [ball, torus, suzanne])
def test_every_edge_of_the_written_map_is_a_turn_and_a_whole_translation(make, turns):
    """Exactly, in single precision."""
    obj = make()
    assert tile(turns=NAMES[turns]) == {"FINISHED"}
    found = [one for one in tilings(obj) if one["turns"] == turns]
    assert found and sum(len(one["cones"]) for one in found) > 0
    which, shift, off = regular_jumps(obj, turns)
    assert off.max() == 0
    assert np.array_equal(shift, np.round(shift))
    assert len(np.unique(which)) > 1


def regular_jumps(obj, turns):
    """`turned_jumps` but at the poles, which small parts have where no map that turns has the size of the others."""
    poles = [pole for one in tilings(obj) for pole in one["poles"]]
    is_regular = ~np.isin(edge_sides(obj)[0], poles).any(axis=1)
    return tuple(values[is_regular] for values in turned_jumps(obj, turns))


def test_sixth_turns_of_the_hexagonal_lattice():
    obj = ball()
    tile(turns="SIXTH")
    which, shift, off = turned_jumps(obj, 6)
    along = np.stack([shift.real - shift.imag / np.sqrt(3), 2 * shift.imag / np.sqrt(3)])
    assert off.max() < 1e-5 and np.abs(along - np.round(along)).max() < 1e-5
    assert len(np.unique(which)) == 6


@pytest.mark.parametrize("turns", [2, 4, 6])
def test_cones_are_told_in_place_of_poles(turns):
    obj = ball()
    tile(turns=NAMES[turns])
    (found,) = tilings(obj)
    count, angles = len(found["cones"]), np.array(found["cone_angles"])
    assert turns * (1 - angles).sum() == pytest.approx(2 * turns)  # Gauss-Bonnet: k chi
    assert found["poles"] == []
    words = f"{WORDS[turns]}, {count} cones"
    assert words in stored_report(obj)["verdict"]["sentence"]
    lines = obj.holomorph_map.made.summary
    assert words in lines and "poles:" not in lines


def button(**options):
    return run(main="AUTOMATIC", **options)


@pytest.mark.parametrize("operator", [button, tile])
def test_a_first_click_turns_as_the_checker_does(operator):
    obj = ball()
    operator()
    before = uv(obj)
    operator(turns="QUARTER")
    assert np.array_equal(uv(obj), before)
    assert [one["turns"] for one in tilings(obj)] == [4]


@pytest.mark.parametrize("operator", [button, tile])
def test_a_map_whose_texture_is_not_shown_is_only_shifted(operator):
    """So that it fits what the artist will put on."""
    obj = ball()
    operator(checker=False)
    assert [one["turns"] for one in tilings(obj)] == [1]


def test_the_best_map_of_an_even_ring_needs_no_cones():
    obj = torus(thickness=0.1, bulge=0)
    for turns in ("FROM_TEXTURE", "QUARTER"):
        button(turns=turns)
        assert [(one["turns"], one["poles"]) for one in tilings(obj)] == [(1, [])]
    tile()
    assert [one["turns"] for one in tilings(obj)] == [4]


def test_only_what_changed_is_made_again(monkeypatch):
    """Textures with the same turns share a map, and maps for others are kept beside it."""
    ball()
    search, made = module("native").load().maps.map, []
    make = search.map_objects

    def noting(*arguments, **options):
        made.append(arguments)
        return make(*arguments, **options)

    monkeypatch.setattr(search, "map_objects", noting)
    tile()
    assert made
    made.clear()
    for options in ({"seams": True}, {"texture": "WEAVE"}, {"quarters": 1}, {"texture": "CHECKER"}):
        assert tile(**options) == {"FINISHED"} and not made
    tile(tiles=150)
    assert made


def test_undo_and_restore_take_a_map_that_turns_back():
    obj = ball()
    obj.data.uv_layers.new(name="Artist")
    before = everything(obj)
    bpy.ops.ed.undo_push(message="before")
    tile()
    assert tilings(obj)[0]["turns"] == 4
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Ball"]
    assert everything(obj) == before
    select(obj)
    tile()
    bpy.ops.uv.holomorphic_restore_materials()
    assert everything(obj)["materials"] == before["materials"] and "Holomorphic" in obj.data.uv_layers
    bpy.ops.uv.holomorphic_remove_maps()
    assert [layer.name for layer in obj.data.uv_layers] == ["Artist"] and "holomorph_report" not in obj


@pytest.mark.parametrize("texture", patterns.TEXTURES)
def test_the_turns_of_a_texture_are_taken(texture):
    obj = torus()
    tile(texture=texture)
    assert [one["turns"] for one in tilings(obj)] == [patterns.TEXTURES[texture].turns]


@pytest.mark.parametrize("texture", patterns.TEXTURES)
def test_every_texture_looks_as_the_table_says(texture):
    """About the corner of its square, where maps turn."""
    drawn = patterns.TEXTURES[texture].draw(256)
    picture = drawn.colour if drawn.height is None else np.dstack([drawn.colour, drawn.height])
    turns = patterns.TEXTURES[texture].turns
    assert module("native").holomorph.image_turns(picture).turns == turns
    if turns != 1:
        assert np.abs(picture - picture[::-1, ::-1]).max() < 1e-9
    if turns == 4:
        picture = picture - picture.mean(axis=(0, 1))
        assert (np.rot90(picture) * picture).sum() > 0.9 * np.square(picture).sum()


def test_the_checker_turns_about_the_middle_of_a_square():
    """Its image on a turned map has that at the corner; the procedural one is shifted by half a square."""
    obj = torus()
    tile(turns="QUARTER")
    nodes = obj.material_slots[0].material.node_tree.nodes
    squares = nodes["Checker Scale"].outputs[0].default_value
    assert tuple(nodes["Checker Shift"].inputs[1].default_value) == (0.5 / squares, 0.5 / squares, 0)
    image = nodes["Checker Image"].image
    grey = image_io.read_pixels(image)[..., 0]
    assert np.array_equal(np.rot90(grey), grey) and grey.min() < grey.max()
    tile(turns="NONE")
    nodes = obj.material_slots[0].material.node_tree.nodes
    assert tuple(nodes["Checker Shift"].inputs[1].default_value) == (0, 0, 0)


def image(grey, name="Wall"):
    made = bpy.data.images.new(name, grey.shape[1], grey.shape[0])
    image_io.write_pixels(made, np.dstack([grey, grey, grey, np.ones_like(grey)]))
    made.pack()
    return made


@pytest.mark.parametrize(
    ("grey", "turns"),
    [(np.roll(checker(64, 4), 5, 1), 4), (checker(64, 4) * np.linspace(0, 1, 64), 1), (hexagons(222, 128, 2, 1), 6)],
)
def test_an_image_says_how_it_turns(grey, turns):
    obj = torus()
    image(grey)
    tile(texture="IMAGE", source="Wall")
    assert [one["turns"] for one in tilings(obj)] == [turns]
    chosen = stored_report(obj)["dials"]["own"]
    assert chosen["turns"] == turns and ("Looks the same after" in chosen["text"] or turns == 1)
    nodes = obj.material_slots[0].material.node_tree.nodes
    if turns == 4:
        centre = np.array(nodes["Image Centre"].inputs[1].default_value)[:2]
        assert np.allclose(centre, chosen["centre"]) and np.allclose((centre - [5 / 64, 0]) * 8 % 2, 1)
    tile(texture="IMAGE", source="Wall", turns="NONE")
    assert "Image Centre" not in obj.material_slots[0].material.node_tree.nodes


def test_a_texture_without_the_symmetry_is_told():
    obj = torus()
    said = everything_said(lambda: tile(texture="SCALES", turns="QUARTER"))
    assert "Scales looks different after a quarter turn: seams show where the map turns" in said
    assert [one["turns"] for one in tilings(obj)] == [4]


def everything_said(press):
    """What is told by the outcome of a run."""
    told, kind = [], module("operators.request").Run
    write = kind.write

    def noted(self, *arguments):
        outcome = write(self, *arguments)
        told.extend(outcome.notes + outcome.problems)
        return outcome

    kind.write = noted
    try:
        assert press() == {"FINISHED"}
    finally:
        kind.write = write
    return told


CHOICES = {
    "Points": {"poles": "COUNT", "pole_count": 2},
    "Pattern": {"lattice": "brick"},
    "Rotation": {"rotation": 0.5},
    "Borders": {"boundary": "straight"},
}


@pytest.mark.parametrize("dial", CHOICES)
def test_what_turned_maps_do_not_have_is_refused_or_kept(dial):
    """Refused where turns are asked for; where they only follow from the texture, the choice counts."""
    obj = torus()
    before = everything(obj)
    told = f"a map with half turns has no choice of {dial}: leave it automatic, or set Turns to None"
    with pytest.raises(RuntimeError, match=told):
        tile(turns="HALF", **CHOICES[dial])
    assert everything(obj) == before
    tile(texture="BRICKS", **CHOICES[dial])
    assert [one["turns"] for one in tilings(obj)] == [1]


@pytest.mark.parametrize("kind", ["cube", "plane", "icosahedron"])
@pytest.mark.parametrize("turns", ["HALF", "QUARTER", "SIXTH"])
def test_meshes_that_are_hard_to_turn(kind, turns):
    """They get some map, by either button, or are refused in a sentence."""
    {"cube": bpy.ops.mesh.primitive_cube_add, "plane": bpy.ops.mesh.primitive_plane_add}.get(
        kind, lambda: bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1)
    )()
    obj = bpy.context.object
    assert run(main="AUTOMATIC", turns=turns) == {"FINISHED"}
    assert np.isfinite(uv(obj)).all()
    try:
        assert tile(turns=turns) == {"FINISHED"}
        assert np.isfinite(uv(obj)).all()
    except RuntimeError as error:
        assert "fault" not in str(error)


def test_several_objects_have_one_size():
    """But for a tenth of lengths; where whole tiles that turn miss it by more, a map with poles has it."""
    one, other = ball(), torus()
    select(one, other)
    assert tile(turns="QUARTER") == {"FINISHED"}
    for obj in (one, other):
        _, shift, off = regular_jumps(obj, 4)
        assert off.max() == 0 and np.array_equal(shift, np.round(shift))
    made = [tiling for obj in (one, other) for tiling in tilings(obj)]
    sizes = [tiling["tiles"] / sum(f.area for f in obj.data.polygons) for tiling, obj in zip(made, (one, other))]
    assert 4 in {tiling["turns"] for tiling in made} <= {1, 4} and max(sizes) <= 1.2 * min(sizes)
    assert shown_scale(one) == shown_scale(other)


def test_the_button_and_what_it_does_not_apply_to():
    """Islands and balanced maps are the same with any turns."""
    obj = torus()
    obj.data.edges[0].use_seam = True
    for main in ("BALANCED",):
        run(main=main, turns="NONE")
        before = uv(obj)
        run(main=main, turns="QUARTER")
        assert np.array_equal(uv(obj), before)


def test_quarters_after_the_map_is_made():
    obj = ball()
    tile(turns="QUARTER", quarters=1)
    _, shift, off = turned_jumps(obj, 4)
    assert off.max() == 0 and np.array_equal(shift, np.round(shift))


def test_cones_are_dots_of_their_own():
    obj = ball()
    tile(turns="QUARTER")
    points, kinds, hovered = marks._points(obj, None)
    assert len(points) == len(tilings(obj)[0]["cones"]) and (kinds == marks.CONE).all() and not hovered.any()
    assert [words for words, _ in marks.legend(kinds)] == [f"{len(points)} points"]
    assert np.allclose(points, np.array([obj.data.vertices[v].co for v in tilings(obj)[0]["cones"]]))


def test_a_turned_map_has_no_poles_to_add_to():
    obj = ball()
    tile(turns="QUARTER")
    assert tile(poles="COARSE", turns="FROM_TEXTURE") == {"FINISHED"} and [one["turns"] for one in tilings(obj)] == [1]


@pytest.mark.parametrize("turns", [2, 4])
@pytest.mark.parametrize("shape", [ball, torus])
def test_all_is_cut_into_quads(shape, turns):
    """By the centres of turns, which are corners of half tiles: the cones, and no others, have another number."""
    obj = shape()
    tile(turns=NAMES[turns], tiles=100)
    bpy.ops.object.holomorphic_cells(columns=2, rows=2, simple=True)
    (made,) = [one for one in bpy.data.objects if one.get("holomorph_cells_of") == obj.name]
    mesh, cones = made.data, [cone for one in tilings(obj) for cone in one["cones"]]
    assert {len(face.vertices) for face in mesh.polygons} == {4}
    assert len(mesh.vertices) - len(mesh.edges) + len(mesh.polygons) == (2 if shape is ball else 0)
    edges = np.bincount(np.array([edge.vertices[:] for edge in mesh.edges]).ravel())
    angles = [angle for one in tilings(obj) for angle in one["cone_angles"]]
    assert sorted(edges[edges != 4]) == sorted(np.rint(4 * np.array(angles)).astype(int))
    points = np.array([vertex.co for vertex in mesh.vertices])[edges != 4]
    places = np.array([obj.data.vertices[cone].co for cone in cones])
    assert np.linalg.norm(points[:, None] - places, axis=2).min(axis=1).max() < 1e-6
    cut = module("things.cut")
    corners, offsets = polygon_arrays(mesh)
    told = cut.CutMesh(np.zeros((len(mesh.vertices), 3)), corners, offsets, None, {}, np.ones(len(corners), bool))
    assert told.irregular == len(cones)


@pytest.mark.parametrize(("turns", "texture"), [(2, "BRICKS"), (4, "WEAVE")])
def test_a_relief_closes_up(turns, texture):
    obj = ball()
    tile(turns=NAMES[turns], tiles=50, texture=texture)
    assert bpy.ops.object.holomorphic_relief(most_triangles=20000) == {"FINISHED"}
    (made,) = [one for one in bpy.data.objects if one.get("holomorph_relief_of") == obj.name]
    edges = np.bincount([loop.edge_index for loop in made.data.loops])
    assert (edges == 2).all() and len(made.data.polygons) > len(obj.data.polygons)


@pytest.mark.parametrize("turns", [2, 4])
def test_levels_keep_turns_and_cones(turns):
    """Every edge of a level fits exactly, up to a turn."""
    obj = torus(around=48, across=24)
    tile(turns=NAMES[turns])
    cones = {tuple(obj.data.vertices[v].co) for one in tilings(obj) for v in one["cones"]}
    assert bpy.ops.object.holomorphic_levels(levels=2) == {"FINISHED"}
    levels = [one for one in bpy.data.objects if one.get("holomorph_levels_of") == obj.name and "LOD0" not in one.name]
    assert len(levels) == 2
    for level in levels:
        assert cones <= {tuple(vertex.co) for vertex in level.data.vertices}
        _, shift, off = turned_jumps(level, turns)
        assert off.max() == 0 and np.array_equal(shift, np.round(shift))


def things_of(obj, kind):
    (made,) = [one for one in bpy.data.objects if one.get(f"holomorph_{kind}_of") == obj.name and one.modifiers]
    return made


@pytest.mark.parametrize("turns", [2, 4])
@pytest.mark.parametrize("place", ["CENTRES", "CORNERS"])
def test_pieces_lie_in_every_cell(place, turns):
    """As many as the area in cells, and at cones what is missing there: on a ball all of them together are two."""
    obj = ball()
    tile(turns=NAMES[turns], tiles=100)
    bpy.ops.object.holomorphic_geometry(piece="STUD", columns=2, place=place)
    points = things_of(obj, "geometry").data.vertices
    cells = 4 * tilings_area(obj)
    assert abs(len(points) - cells) <= 2 and len(points) > 100
    at = np.array([point.co for point in points])
    assert np.linalg.norm(at[:, None] - at[None], axis=2)[~np.eye(len(at), dtype=bool)].min() > 0.01


def tilings_area(obj):
    layer, faces = uv(obj), [polygon.loop_indices for polygon in obj.data.polygons]
    corners = np.array([layer[list(face)] for face in faces])
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2


@pytest.mark.parametrize("turns", [2, 4])
def test_shifted_pieces_need_half_turns(turns):
    obj = ball()
    tile(turns=NAMES[turns])
    if turns == 2:
        assert bpy.ops.object.holomorphic_geometry(piece="BRICK", columns=2) == {"FINISHED"}
        assert len(things_of(obj, "geometry").data.vertices) > 50
        return
    before = everything(obj)
    with pytest.raises(RuntimeError, match="a map with quarter turns has as many rows as columns, with"):
        bpy.ops.object.holomorphic_geometry(piece="BRICK", columns=2, rows=3)
    assert everything(obj) == before
    assert bpy.ops.object.holomorphic_geometry(piece="BRICK", columns=2) == {"FINISHED"}


@pytest.mark.parametrize("turns", [2, 4, 6])
def test_wires_run_along_the_lines(turns):
    obj = ball()
    tile(turns=NAMES[turns])
    assert bpy.ops.object.holomorphic_lines(per_tile=2) == {"FINISHED"}
    mesh = things_of(obj, "lines").data
    ends = np.array([edge.vertices[:] for edge in mesh.edges])
    points = np.array([vertex.co for vertex in mesh.vertices])
    loose = points[np.bincount(ends.ravel(), minlength=len(points)) == 1]
    cones = np.array([obj.data.vertices[v].co for one in tilings(obj) for v in one["cones"]])
    assert np.linalg.norm(loose[:, None] - cones[None], axis=2).min(axis=1).max() < (1e-4 if turns == 6 else 1e-6)
    steps = np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    assert steps.max() <= max((obj.data.vertices[a].co - obj.data.vertices[b].co).length for a, b in obj.data.edge_keys)


def test_again_and_undone():
    """Another run takes the place of the first, and Remove takes all away."""
    obj = ball()
    tile(turns="QUARTER", tiles=100)
    first = uv(obj)
    tile(turns="NONE")
    assert report.CONE not in report.points(obj)[1]
    tile(turns="QUARTER", tiles=100)
    assert np.array_equal(uv(obj), first)
    bpy.ops.uv.holomorphic_remove_maps()
    assert "holomorph_report" not in obj and not len(obj.data.uv_layers)
