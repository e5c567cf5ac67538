"""Mutated files of progressive meshes, most with a checksum that fits: `ProgressiveMesh.load` and what it loads."""

import tempfile
import zlib
from functools import cache
from pathlib import Path

import byte_mutations
import families
import numpy as np
import oracle
from holomorph import ProgressiveMesh
from solved import surface_of

MESHES = {
    "torus": families.torus(6, 5),
    "tube": families.cylinder(6, 4),
    "cube": families.cube(),
    "two parts": families.united(families.torus(5, 4), families.tetrahedron()),
    "n-gons": families.washer(4),
}


@cache
def content(name):
    """The bytes of a file, without its checksum."""
    surface = surface_of(MESHES[name])
    data = np.arange(2 * len(surface.corner_vertices), dtype="<f4").reshape(-1, 2) if name != "cube" else None
    return ProgressiveMesh(surface, corner_data=data)._native.to_bytes()


def make(random):
    """The bytes of a file."""
    names = sorted(MESHES)
    body = byte_mutations.mutated(content(random.choice(names)), content(random.choice(names)), random)
    checksum = zlib.crc32(body) if random.random() < 0.97 else random.randrange(2**32)
    return body + checksum.to_bytes(4, "little")


def execute(case):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "mesh.pm")
        path.write_bytes(case)
        mesh = ProgressiveMesh.load(path)
        mesh.save(path)
        assert path.read_bytes() == case
    oracle.check_surface(mesh.restore())
    oracle.check_surface(mesh.base)
    assert np.isfinite(mesh.splits["position"]).all()
    for faces in (0, 12, 30):
        level = mesh.level(faces)
        oracle.check_surface(level)
        mesh.level_corner_data(faces)
        assert mesh.vertex_map(faces).max() < len(level.vertices)


def save(case, stem):
    path = stem.with_suffix(".pm")
    path.write_bytes(case)
    return path


def load(path):
    return path.read_bytes()


def smaller(case):
    for body in byte_mutations.smaller(case[:-4]):
        yield body + zlib.crc32(body).to_bytes(4, "little")
