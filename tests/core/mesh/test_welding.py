"""Vertices that are apart where faces lie side by side are joined, and no others."""

from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import Surface

BODIES = {
    "torus": families.torus(16, 10),
    "cube": families.cube(),
    "cylinder": families.cylinder(12, 5),
    "sphere": families.geodesic_sphere(3),
    "pair": families.united(families.torus(12, 8), families.geodesic_sphere(2)),
}


def split(mesh, name_of_face):
    """Vertices apart between faces of different names, as files have it along the seams of a UV map."""
    keys = np.column_stack([mesh.corners, np.repeat(name_of_face, np.diff(mesh.offsets))])
    kept, corners = np.unique(keys, axis=0, return_inverse=True)
    return replace(mesh, vertices=mesh.vertices[kept[:, 0]], corners=corners.ravel())


def charts(mesh):
    """(#F,) the chart of each face: bands across the mesh."""
    centres = np.array([mesh.vertices[face].mean(axis=0) for face in mesh.faces])
    return np.floor(centres @ [0.9, 0.7, 1.1]).astype(int)


def read(mesh):
    return Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets, strict=False)


def topology(surface):
    return sorted((part.genus, part.boundary_count, len(part.face_index)) for part in surface.components)


@pytest.mark.parametrize("far", [0.0, 300.0, -7000.0])
@pytest.mark.parametrize("name", BODIES)
def test_charts_are_joined(name, far):
    mesh = families.single(replace(BODIES[name], vertices=BODIES[name].vertices + far))
    loose = split(mesh, charts(BODIES[name]))
    assert len(loose.vertices) > len(mesh.vertices)
    surface = read(loose)
    assert topology(surface) == topology(read(mesh)) and not surface.repairs.cuts
    assert len(surface.repairs.joined_vertices) == len(loose.vertices) - len(mesh.vertices)
    assert (surface.corner_index == np.arange(len(mesh.corners))).all()
    joined = loose.vertices[loose.corners] == surface.vertices[surface.corner_vertices]
    assert joined.all()


def test_strict_joins_nothing():
    mesh = split(BODIES["torus"], np.arange(160) // 80)
    assert len(Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets).vertices) == len(mesh.vertices)


@pytest.mark.parametrize("name", ["torus", "cylinder"])
def test_faces_back_to_back_stay_two(name):
    """Each face has another one on its back, and both sheets are in charts: their rims lie on each other."""
    mesh = BODIES[name]
    loose = split(mesh, charts(mesh))
    back = families.mirrored(loose)
    both = replace(
        loose,
        vertices=np.concatenate([loose.vertices, back.vertices]),
        corners=np.concatenate([loose.corners, back.corners + len(loose.vertices)]),
        offsets=np.concatenate([loose.offsets, loose.offsets[-1] + back.offsets[1:]]),
    )
    assert topology(read(both)) == 2 * topology(read(mesh))


def test_sides_that_run_alike_stay_apart():
    """Two sheets of one side each that lie on each other, cut along different diagonals."""
    grid = families.cylinder(8, 4)
    one, other = (
        families.triangles_of(grid),
        families.uniform(grid.vertices, families.cut_quads(np.roll(grid.corners.reshape(-1, 4), -1, axis=1))),
    )
    both = families.polygons(
        np.concatenate([one.vertices, other.vertices]),
        [*(f.tolist() for f in one.faces), *((f + len(one.vertices)).tolist() for f in other.faces)],
    )
    assert topology(read(both)) == [(0, 2, len(one.faces))] * 2


def test_parts_that_touch_in_a_point_stay_apart():
    mesh = families.united(families.cylinder(6, 3), families.cylinder(6, 3))
    points = mesh.vertices.copy()
    points[18:] += points[0] - points[18]
    assert topology(read(replace(mesh, vertices=points))) == topology(read(mesh))


def test_no_edge_gets_three_faces():
    """Three sheets that end in one line are left as they are, and so is a body that a sheet ends at."""
    ends = [[0, 0, 0], [0, 0, 1]]
    pages = [[*ends, [np.cos(a), np.sin(a), 1], [np.cos(a), np.sin(a), 0]] for a in (0, 2, 4)]
    fans = families.united(*[families.cylinder(8, 4)] * 3)
    mesh = families.polygons(
        np.concatenate([fans.vertices, *pages]),
        [*(f.tolist() for f in fans.faces), *(len(fans.vertices) + np.arange(12).reshape(3, 4)).tolist()],
    )
    assert len(read(mesh).components) == 6
    body = BODIES["torus"]
    start, count = body.vertices[body.faces[0][:2]], len(body.vertices)
    fin = families.polygons(
        np.concatenate([body.vertices, start, start + 9]),
        [*(f.tolist() for f in body.faces), [count, count + 1, count + 3, count + 2]],
    )
    surface = read(fin)
    assert not surface.repairs.cuts and not len(surface.repairs.joined_vertices)
    assert topology(surface) == [(0, 1, 1), (1, 0, body.face_count)]


def test_no_part_gets_only_one_side():
    """A Moebius strip that is cut across stays a strip."""
    mesh = families.moebius()
    surface = read(mesh)
    assert [cut.reason for cut in surface.repairs.cuts] == ["one_sided"]
    again = read(families.polygons(surface.vertices, np.split(surface.corner_vertices, surface.face_offsets[1:-1])))
    assert again.is_whole and topology(again) == topology(surface)


@pytest.mark.parametrize("far", [[0, 0, 0], [1e6, 0, 0], [5e5, 4.6e6, 100], [-3e8, 1e8, 0]])
def test_sheets_stay_apart_wherever_they_lie(far):
    """At 300,000 km a double has 6e-8 m."""
    sheet = families.cylinder(10, 4)
    points = np.concatenate([sheet.vertices, sheet.vertices * [1.1, 1.1, 1]]) + far
    other = families.mirrored(sheet)
    corners = np.concatenate([sheet.corners, other.corners + len(sheet.vertices)])
    both = replace(
        sheet,
        vertices=points,
        corners=corners,
        offsets=np.concatenate([sheet.offsets, sheet.offsets[-1] + other.offsets[1:]]),
    )
    assert len(read(both).components) == 2 and not len(read(both).repairs.joined_vertices)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("far", [0.0, 1e3, 1e6])
def test_charts_are_joined_wherever_they_lie(far, scale):
    """Up to the rounding of the place."""
    body = BODIES["torus"]
    loose = split(body, charts(body))
    noise = np.random.default_rng(1).normal(size=loose.vertices.shape)
    points = scale * (loose.vertices + far) * (1 + 2.0**-53 * noise)
    assert topology(read(replace(loose, vertices=points))) == topology(read(body))
