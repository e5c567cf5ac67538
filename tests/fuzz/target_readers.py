"""Mutated mesh files: `Surface.read` gives a surface or names what is wrong."""

import tempfile
from pathlib import Path

import byte_mutations
import door_files
import oracle
from holomorph import Surface
from mesh_files import POLYGON_FILES, TRIANGLE_FILES

SCENES = {"scene.glb": door_files.gltf([door_files.TORUS], [door_files.WALL])}
FILES = sorted((POLYGON_FILES | TRIANGLE_FILES | SCENES).items())
FORMATS = (".obj", ".off", ".ply", ".stl", ".glb", ".gltf", ".3mf")


def make(random):
    """(name, content), now and then with the ending of another format."""
    name, content = random.choice(FILES)
    suffix = random.choice(FORMATS) if random.random() < 0.02 else Path(name).suffix
    return f"mesh{suffix}", byte_mutations.mutated(content, random.choice(FILES)[1], random)


def execute(case):
    name, content = case
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, name)
        path.write_bytes(content)
        for options in ({"weld": True}, {"strict": True}):
            oracle.answer(read, path, options)
        read(path, {})


def read(path, options):
    surface = Surface.read(path, **options)
    oracle.check_surface(surface)
    for part in surface.components:
        assert part.euler_characteristic == 2 - 2 * part.genus - part.boundary_count


def save(case, stem):
    path = stem.with_suffix(Path(case[0]).suffix.lower())
    path.write_bytes(case[1])
    return path


def load(path):
    return f"mesh{path.suffix}", path.read_bytes()


def smaller(case):
    return ((case[0], content) for content in byte_mutations.smaller(case[1]))
