"""Meshes of quads over surfaces: their topology, their number, and where they lie."""

import families
import numpy as np
import pytest
from cell_checks import assert_same_topology
from holomorph import InvalidMesh, Surface, TopologyError, _native
from holomorph.__main__ import main
from mesh_files import obj
from shared_data import shared_folder
from solved import surface_of

CLOSED = {
    "sphere": lambda: families.geodesic_sphere(8),
    "torus": lambda: families.torus(24, 16, jitter=0.1),
    "handles": lambda: families.block_with_holes(3, refine=3, jitter=0.2),
    "knot": lambda: families.torus_knot(100, 8),
}
OPEN = {"bowl": lambda: families.hemisphere(8), "washer": lambda: families.washer(20)}
SIDE = 1e-9  # rounding of UVs


def sizes(quads):
    return np.diff(quads.face_offsets)


@pytest.mark.parametrize(("name", "off"), [("sphere", 0.05), ("torus", 0.05), ("handles", 0.2), ("knot", 0.2)])
@pytest.mark.parametrize("faces", [500, 2000])
def test_closed_surfaces_have_quads_alone(name, off, faces):
    """Their irregular vertices have the sum of Euler and Poincare: 4 less the edges at each is 4 chi in all. Whole rows
    around thin tubes come in steps."""
    surface = surface_of(CLOSED[name]())
    quads = surface.quads(faces, lines="none")
    assert (sizes(quads) == 4).all()
    assert abs(len(quads) / faces - 1) < off
    assert_same_topology(quads, surface)
    edges = np.bincount(quads.corner_vertices, minlength=len(quads.positions))
    assert (4 - edges).sum() == 4 * surface.euler_characteristic
    assert (np.flatnonzero(edges != 4) == quads.irregular).all()


@pytest.mark.parametrize("name", [*CLOSED, *OPEN])
def test_each_lies_on_the_surface_and_is_a_unit_square_of_its_map(name):
    surface = surface_of((CLOSED | OPEN)[name]())
    quads = surface.quads(800)
    assert_same_topology(quads, surface)
    assert np.array_equal(quads.of(surface.vertices), quads.positions)
    assert (quads.weights >= 0).all() and np.abs(quads.weights.sum(axis=1) - 1).max() < SIDE
    corners = quads.uv[quads.face_offsets[:-1][sizes(quads) == 4, None] + np.arange(4)]
    along = np.roll(corners, -1, axis=1) - corners
    assert (corners == np.rint(corners)).all()
    assert (np.abs(along).sum(axis=2) == 1).all()


@pytest.mark.parametrize("name", OPEN)
def test_borders_are_whole_rows(name):
    surface = surface_of(OPEN[name]())
    quads = surface.quads(800)
    assert quads.lines == ("whole",) and (sizes(quads) == 4).all()


def test_folds_of_triangles_without_area_lose_no_topology():
    surface = surface_of(families.spun(24, 12))
    assert_same_topology(surface.quads(500), surface)


def test_another_number_is_quick():
    """The cones are kept: of the operations there is a part left."""
    surface, works = surface_of(CLOSED["sphere"]()), []
    for faces in (500, 520):
        before = _native.work()
        surface.quads(faces)
        works.append(_native.work() - before)
    assert works[1] < 0.5 * works[0]


def test_parts_share_the_number_by_their_areas_and_small_ones_stay():
    ball, crumb = families.geodesic_sphere(8), families.geodesic_sphere(2)
    near = families.united(ball, ball.__class__(crumb.vertices * 0.5 + 3, crumb.corners, crumb.offsets, crumb.topology))
    surface = surface_of(near)
    quads = surface.quads(1000)
    halves = [part.quads(1000 * part.area / surface.area) for part in surface.components]
    assert not quads.kept and len(quads) == sum(map(len, halves))
    few = surface.quads(20)
    assert list(few.kept) == [1]
    assert few.notes == ("1 part keeps its own faces: fewer than six quads would lie there: take more faces",)
    assert (few.positions[-len(crumb.vertices) :] == surface.components[1].vertices).all()


def test_two_halves_are_alike():
    surface = Surface.read(shared_folder("meshes") / "spot_quads.obj")
    quads = surface.quads(1000, mirror=True)
    mirrored = quads.positions * [-1, 1, 1]
    nearest = [np.linalg.norm(quads.positions - place, axis=1).min() for place in mirrored]
    assert max(nearest) < 1e-6 * np.ptp(quads.positions)
    assert quads.lines == ("mirror",) and (sizes(quads) == 4).mean() > 0.99


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"faces": 3}, ValueError, "faces is 3; at least 6"),
        ({"faces": -1}, ValueError, "faces is -1"),
        ({"faces": "many"}, (ValueError, TypeError), "faces"),
        ({"lines": "straight"}, ValueError, "lines is 'straight'"),
        ({"evenness": 2}, ValueError, "evenness"),
        ({"faces": 8}, TopologyError, "take more faces"),
        ({"mirror": True}, TopologyError, "does not mirror itself"),
        ({"marked": [[0.5, 1]]}, InvalidMesh, "marked"),
    ],
)
def test_wrong_options_are_refused_in_a_sentence(options, error, message):
    with pytest.raises(error, match=message):
        surface_of(families.torus(24, 16, jitter=0.1)).quads(**{"faces": 500} | options)


def test_hundreds_of_loops_are_refused_at_once():
    with pytest.raises(TopologyError, match="it has 119 loops around handles and holes, which take long"):
        surface_of(families.punched(families.geodesic_sphere(16), 120)).quads()


def test_surfaces_without_positions_are_refused():
    with pytest.raises(TopologyError, match="positions"):
        Surface.from_edge_lengths([(0, 1, 2), (0, 2, 1)], [(1, 1, 1)] * 2).quads()


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".glb"])
def test_the_command_writes_them(tmp_path, capsys, suffix):
    mesh, output = tmp_path / "torus.obj", tmp_path / f"quads{suffix}"
    mesh.write_bytes(obj(CLOSED["torus"]()))
    assert main(["quads", str(mesh), "--faces", "500", "--output", str(output)]) == 0
    expected = Surface.read(mesh).quads(500)
    assert expected.sentence in capsys.readouterr().out
    found = Surface.read(output, weld=suffix == ".glb")
    assert found.euler_characteristic == 0
    assert len(found.vertices) == len(expected.positions)


def test_the_command_refuses_in_a_sentence(tmp_path, capsys):
    mesh = tmp_path / "torus.obj"
    mesh.write_bytes(obj(CLOSED["torus"]()))
    for arguments, status, message in (
        ([mesh, "--output", mesh], 2, "overwrite"),
        ([mesh, "--output", tmp_path / "quads.xyz"], 2, "xyz"),
        ([tmp_path / "none.obj", "--output", tmp_path / "quads.obj"], 2, "none.obj"),
        ([mesh, "--output", tmp_path / "quads.obj", "--faces", "3"], 1, "at least 6"),
    ):
        assert main(["quads", *map(str, arguments)]) == status
        assert message in capsys.readouterr().err
    assert not (tmp_path / "quads.obj").exists()
