"""Slivers, polygons without area: each is in the piece of the face at its longest side, whatever cuts the surface."""

import itertools
from dataclasses import replace

import families
import numpy as np
import pytest
from command_runs import run
from holomorph import InvalidMesh, Surface, TopologyError, _native, automatic_map, automatic_maps, island_map
from holomorph.mesh.surgery import cut_open
from island_checks import cut_along
from small_families import MESHES
from solved import BOUNDED, CLOSED

# A mere renumbering of its vertices changes the kind of map of the one; on edges where faces of the other are reversed,
# slivers would be third faces.
TIES = {"punctured torus", "partly reversed"}
FAMILIES = {name: mesh for name, mesh in (MESHES | CLOSED | BOUNDED).items() if name not in TIES}
KINDS = "edge", "end", "chain", "border"


def surface_of(mesh, strict=True):
    return Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets, strict)


def kinds(mesh):
    """The kinds of the maps of the parts, none of which is refused.

    Of any direction: of rows around a tube, level or at a slant, of which whole tiles have one size, rounding chooses.
    """
    surface = surface_of(mesh, strict=False)
    assert not surface.refused
    return [made.kind for made in automatic_maps(surface, direction=None)]


@pytest.mark.parametrize("name", FAMILIES)
def test_they_change_no_kind_of_map(name):
    """One of each kind, in double precision, and ten in single."""
    mesh = FAMILIES[name]
    index = list(FAMILIES).index(name)
    one, many = KINDS[index % 4], KINDS[(index + index // 4) % 2]
    assert kinds(families.with_slivers(mesh, 1, one)) == kinds(mesh)
    assert kinds(families.single(families.with_slivers(mesh, 10, many))) == kinds(families.single(mesh))


@pytest.mark.long
@pytest.mark.parametrize(("kind", "name"), [*itertools.product(KINDS, sorted(FAMILIES.keys() - {"several"}))])
def test_they_change_no_kind_of_map_however_many(kind, name):
    """Not of several shapes of few quads, which one more corner may cut into other triangles."""
    mesh = FAMILIES[name]
    for count in range(1, 11 if kind != "chain" else 4):  # three are in each chain
        assert kinds(families.with_slivers(mesh, count, kind, seed=count)) == kinds(mesh), count


def owners(mesh, count):
    """The faces in whose pieces the last of a mesh, which are slivers, are to be: those at the longest inner sides."""
    faces = [f.tolist() for f in np.split(mesh.corners, mesh.offsets[1:-1])]
    result = []
    for sliver in faces[-count:]:
        found = []
        for a, b in zip(sliver, sliver[1:] + sliver[:1]):
            others = [k for k, f in enumerate(faces) if f != sliver and {a, b} in map(set, zip(f, f[1:] + f[:1]))]
            found += [(np.linalg.norm(mesh.vertices[a] - mesh.vertices[b]), other) for other in others]
        result.append(max(found)[1])
    return result


@pytest.mark.parametrize("name", ["cube", "genus 2 block", "cylinder", "cage"])
def test_each_is_in_the_piece_at_its_longest_side(name):
    """Where every edge is a seam, and where those are that are hard."""
    count = 5
    mesh = families.with_slivers((MESHES | CLOSED)[name], count, seed=3)
    surface, wanted = surface_of(mesh), owners(mesh, count)
    faces = len(mesh.offsets) - 1
    everywhere = np.unique(np.sort(np.stack([mesh.corners, _following(mesh)], axis=1), axis=1), axis=0)
    bent = surface._native.edges[_native.bends(surface._native) > np.radians(40)]
    for pieces in (cut_along(surface, everywhere), cut_along(surface, bent)):
        piece = np.empty(faces, int)
        for number, part in enumerate(pieces):
            assert part.area > 0
            piece[part.face_index] = number
        assert piece[-count:].tolist() == piece[wanted].tolist()
    assert len(cut_along(surface, everywhere)) == faces - count


@pytest.mark.parametrize("far", [0.0, 10.0, 100.0])
@pytest.mark.parametrize("name", ["cube", "genus 2 block"])
def test_rounding_to_single_precision_gives_no_area(name, far):
    """Far from the origin a point between two others is rounded off their line."""
    count, random = 5, np.random.default_rng(4)
    mesh = families.with_slivers((MESHES | CLOSED)[name], count, seed=3)
    turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
    rounded = np.float32(mesh.vertices @ turn + far * random.uniform(0.5, 1, 3)).astype(float)
    found = surface_of(replace(mesh, vertices=rounded))._native.sliver_owners()
    is_own = found == np.arange(len(mesh.offsets) - 1)
    assert is_own[:-count].all() and not is_own[-count:].any()


def _following(mesh):
    following = np.arange(1, len(mesh.corners) + 1)
    following[mesh.offsets[1:] - 1] = mesh.offsets[:-1]
    return mesh.corners[following]


@pytest.mark.parametrize("kind", KINDS)
def test_they_bend_no_edge(kind):
    """The hard edges of a cube are twelve right angles still."""
    length = 12.0
    surface = surface_of(families.with_slivers(families.cube(), 6, kind, seed=2))
    lengths, bent = surface._native.edge_lengths, _native.bends(surface._native)
    assert np.all((bent < 1e-6) | (np.abs(bent - np.pi / 2) < 1e-6))
    size = np.linalg.norm(np.diff(families.cube().vertices[:2], axis=0))
    assert abs(lengths[bent > 1].sum() - length * size) < 1e-9 * length * size


def test_fins_without_area_leave_the_edges_that_they_stand_on_joined():
    cube, random = families.cube(), np.random.default_rng(0)
    points, faces = [*cube.vertices], [f.tolist() for f in np.split(cube.corners, cube.offsets[1:-1])]
    for a, b, *_ in faces[:6]:
        points.append(0.4 * points[a] + 0.6 * points[b] + 1e-9 * random.normal(size=3))
        faces.append([a, b, len(points) - 1])
    surface = Surface(np.array(points), faces, strict=False)
    (part,) = surface.components
    assert part.boundary_count == 0 and len(part.face_index) == 6
    assert [len(refused.faces) for refused in surface.refused] == [6]


def test_one_among_many_has_a_map_everywhere(tmp_path):
    """As an island, along hard edges, flattened, and by the command."""
    surface = surface_of(families.with_slivers(families.torus(40, 20, shape="triangles"), 1))
    assert len(surface.repairs.zero_area_faces) == 1
    with pytest.raises(TopologyError, match="no edge is that sharp"):  # a ring without hard edges
        automatic_map(surface, main="islands", hard_edges=40)
    surface.write(tmp_path / "torus.obj")
    done = run(tmp_path / "torus.obj", "--output", tmp_path / "out.obj")
    assert done.returncode == 0, done.stderr


def test_a_part_without_area_is_named_by_its_own_face():
    """Not all faces of the mesh are: one has an area."""
    surface = Surface([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 0, 0], [6, 0, 0], [7, 0, 0]], [[0, 1, 2], [3, 4, 5]])
    with pytest.raises(InvalidMesh, match=r"all faces of a part have zero area \(face 1 is the first\)"):
        surface.components  # noqa: B018  made when asked for
    with pytest.raises(InvalidMesh, match=r"^all faces have zero area \(face 0 is the first\)"):
        Surface([[5, 0, 0], [6, 0, 0], [7, 0, 0]], [[0, 1, 2]])


def test_the_islands_of_a_cube_are_those_without_slivers():
    made = island_map(surface_of(families.with_slivers(families.cube(), 6, seed=1)))
    assert (made.islands, made.quality.flipped_part) == (island_map(surface_of(families.cube())).islands, 0)


# ---- two vertices at one place: edges without length -----------------------------------------------------------------


def curvature(mesh):
    return _native.curvature(surface_of(mesh)._native, (), np.inf)


def with_doubled_vertices(mesh, seed=0):
    return families.with_slivers(mesh, 10, "end", seed)


@pytest.mark.parametrize("name", ["genus 2 block", "cage", "cube", "tube"])
def test_the_curvature_is_that_of_the_place(name):
    """Faces are planar, or triangles: another corner changes nothing."""
    mesh = (MESHES | CLOSED | BOUNDED)[name]
    mesh = mesh if name != "tube" else families.triangles_of(mesh)
    expected = curvature(mesh)
    assert abs(curvature(with_doubled_vertices(mesh)) - expected) < 1e-9 * (1 + expected)


@pytest.mark.parametrize("seed", range(3))
def test_paths_go_on_between_two_vertices_at_one_place(seed):
    """From every vertex inside a tube the cut reaches its ends."""
    surface = surface_of(with_doubled_vertices(BOUNDED["tube"], seed))
    no_seam = np.zeros(len(surface._native.edges), bool)
    is_border = _native.on_border(surface._native, no_seam)
    for vertex in np.flatnonzero(~is_border):
        path = _native.paths_to_border(surface._native, is_border, np.arange(len(is_border)) == vertex)
        assert cut_open(surface, path).boundary_count == surface.boundary_count
        assert _native.on_border(surface._native, path)[vertex]


def test_a_flat_ring_stays_one_island_without_a_seam():
    for seed in range(49, 52):
        made = island_map(surface_of(with_doubled_vertices(BOUNDED["square minus square"], seed)))
        assert (made.islands, len(made.seams)) == (1, 0)
