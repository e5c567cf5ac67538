"""The C++ library as others use it: installed, found by CMake, linked by the example, equal to the Python package."""

import re

import families
import holomorph
import numpy as np
import pytest
from programs import run

# Part of a unit: with it positions are the same in single and in double precision, and in text.
GRAIN = 1024.0
# Rounding of the texture coordinates of OpenMesh's default traits and of its writers, relative to the largest.
SINGLE_PRECISION = 2.0**-23


def mixed():
    """Quads, triangles and a hexagon on a tube, its vertices in no order."""
    tube = families.cylinder(12, 5)
    faces = [face.tolist() for face in tube.faces]
    a = faces.pop(14)
    k, b = next((k, b) for b in faces for k in range(4) if (b[k], b[k - 1]) == (a[1], a[2]))
    faces.remove(b)
    hexagon = [a[0], a[1], b[k - 3], b[k - 2], a[2], a[3]]
    p, q, r, s = faces.pop()
    faces += [hexagon, [p, q, r], [p, r, s]]
    mesh = families.polygons(tube.vertices, faces, ((0, 2),))
    return families.relabelled(mesh)[0]


MESHES = {
    "torus": families.torus(12, 8),
    "genus 2": families.block_with_holes(2, refine=2, jitter=0.1),
    "triangles": families.triangles_of(families.torus(10, 7)),
    "tube": mixed(),
    "sphere": families.geodesic_sphere(4),
    "two parts": families.united(families.torus(9, 6), families.cylinder(8, 4)),
}


@pytest.fixture(params=MESHES)
def mesh_file(request, tmp_path):
    mesh = MESHES[request.param]
    path = tmp_path / "in.obj"
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (np.round(mesh.vertices * GRAIN) / GRAIN).tolist()]
    lines += ["f " + " ".join(str(vertex + 1) for vertex in face) for face in mesh.faces]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def read_uv(path):
    """Vertices, and UVs in single precision, of each corner of an OBJ file."""
    text = path.read_text(encoding="utf-8")
    vt = np.array([line.split()[1:3] for line in re.findall(r"^vt .*", text, re.MULTILINE)], dtype=np.float32)
    corners = np.array(re.findall(r"(\d+)/(\d+)", text), dtype=int) - 1
    return corners[:, 0], vt[corners[:, 1]]


def sides(surface):
    """For each corner, the vertex and the corner that follow in its polygon."""
    following = np.arange(1, len(surface.corner_vertices) + 1)
    following[surface.face_offsets[1:] - 1] = surface.face_offsets[:-1]
    return surface.corner_vertices[following], following


def edges_with_jumps(surface, uv):
    """Pairs of vertices of the edges at which the UVs of the two faces differ."""
    other, following = sides(surface)
    met, jumps = {}, set()
    for c, (v, w) in enumerate(zip(surface.corner_vertices.tolist(), other.tolist())):
        ends = (uv[c], uv[following[c]]) if v < w else (uv[following[c]], uv[c])
        before = met.setdefault((min(v, w), max(v, w)), ends)
        if not all(np.array_equal(x, y) for x, y in zip(before, ends)):
            jumps.add((min(v, w), max(v, w)))
    return jumps


def test_example_equals_the_python_package(examples, mesh_file):
    target = mesh_file.with_name("out.obj")
    done = run(examples / "openmesh_uv", mesh_file, target)
    assert done.returncode == 0, done.stderr
    surface = holomorph.Surface.read(mesh_file)
    expected = np.full((len(surface.corner_vertices), 2), np.nan)
    seams, counts = set(), []
    for part in surface.components:
        structure = holomorph.automatic_structure(part)
        expected[part.corner_index] = structure.uv(structure.balanced_coefficients())
        ends = part.vertex_index[structure.edges[structure.seams]]
        seams |= {(int(v), int(w)) for v, w in ends}
        counts.append(f"{len(structure.seams)} seam edges")
    vertices, uv = read_uv(target)
    assert np.array_equal(vertices, surface.corner_vertices)
    assert np.abs(uv - expected).max() <= SINGLE_PRECISION * np.abs(expected).max()
    assert edges_with_jumps(surface, uv) <= seams
    assert [line.split(", ")[1] for line in done.stdout.splitlines() if "seam edges" in line] == counts


def test_example_says_what_is_wrong(examples, tmp_path):
    example = examples / "openmesh_uv"
    missing = run(example, tmp_path / "missing.obj", tmp_path / "out.obj")
    assert missing.returncode == 1 and "missing.obj" in missing.stderr
    pinched = tmp_path / "pinched.obj"
    pinched.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n", encoding="utf-8")
    refused = run(example, pinched, tmp_path / "out.obj")
    assert refused.returncode == 1 and "vertex 0" in refused.stderr
    assert not (tmp_path / "out.obj").exists()


def test_headers_name_installed_headers_alone(installed):
    include = installed("cpp") / "include"
    headers = sorted(include.rglob("*.h"))
    assert include / "holomorph" / "holomorph.h" in headers
    wrong = []
    for header in headers:
        for name in re.findall(r'^#include "([^"]+)"', header.read_text(encoding="utf-8"), re.MULTILINE):
            found = (include / name).exists() if "/" in name else (header.parent / name).exists()
            wrong += [] if found else [f"{header.relative_to(include)} includes {name}"]
    assert not wrong


def test_no_other_headers_are_installed_than_the_public_ones_reach(installed):
    include = installed("cpp") / "include"
    reached, waiting = set(), [include / "holomorph" / name for name in ("holomorph.h", "openmesh.h")]
    while waiting:
        header = waiting.pop()
        if header not in reached:
            reached.add(header)
            names = re.findall(r'^#include "([^"]+)"', header.read_text(encoding="utf-8"), re.MULTILINE)
            waiting += [include / name if "/" in name else header.parent / name for name in names]
    assert reached == set(include.rglob("*.h"))


@pytest.mark.parametrize(
    ("component", "suffixes"), [("native", {".so"}), ("python", {".py", ".pyi", ".typed", ".html"})]
)
def test_python_components_have_no_headers(installed, component, suffixes):
    files = {path for path in installed(component).rglob("*") if path.is_file()}
    assert files
    assert not {path for path in files if path.suffix not in suffixes}
