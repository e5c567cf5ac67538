"""Results as values: short reprs, pickles with the same bits, copies."""

import copy
import hashlib
import json
import pickle
import subprocess
import sys
from dataclasses import fields, is_dataclass
from functools import cache

import families
import holomorph
import numpy as np
import pytest
from holomorph import (
    ProgressiveMesh,
    Surface,
    automatic_map,
    automatic_structure,
    conformal_structure,
    cut_along,
    disk_map,
    free_boundary_map,
    log_map,
    rectangle_map,
)
from solids import can
from solved import BOUNDED, CLOSED, FLAT, solved, surface_of

LONGEST_REPR = 240
OF_SURFACES = [
    *("vertices", "corner_vertices", "face_offsets", "triangles", "triangle_corners", "triangle_faces"),
    *("vertex_index", "face_index", "corner_index", "dual_vertex", "given_vertex_count"),
]
OF_NATIVE_SURFACES = ["edges", "edge_lengths", "triangle_edges", "reversed_faces", "isolated_vertices"]
OF_STRUCTURES = ["edges", "seams", "flip_count", "residuals", "holomorphic_forms", "description", "timings"]


def ball():
    return surface_of(families.block_with_holes(0, refine=4, jitter=0.2))


def disk():
    return surface_of(families.punched(families.block_with_holes(0, refine=4, jitter=0.2), 1))


def tiled():
    return holomorph.TiledSurface(surface_of(CLOSED["torus of quads"]), tiling().uv)


def two_parts():
    """Isolated vertices, faces in reverse, a vertex where fans touch, a part that is not a surface."""
    mesh = families.united(families.partly_reversed(families.block_with_holes(1, refine=2)), families.torus(9, 6))
    points = np.concatenate([[[9.0, 9, 9]], mesh.vertices, np.eye(3), -np.eye(3)])
    faces = [(polygon + 1).tolist() for polygon in np.split(mesh.corners, mesh.offsets[1:-1])]
    first = len(mesh.vertices) + 1
    return Surface(points, [*faces, [first, first + 1, first + 2], [first, first + 3, first + 4]], strict=False)


def both_loops():
    """Edges of the torus of quads whose complement is a disk."""
    i, j = np.arange(24), np.arange(18)
    return np.concatenate([np.stack([18 * i, 18 * (i + 1) % 432], 1), np.stack([j, (j + 1) % 18], 1)])


@cache
def example(name):
    return EXAMPLES[name]()


def tiling():
    return solved("torus of quads").tile(tiles=40, poles=2)


EXAMPLES = {
    "Surface": two_parts,
    "Repairs": lambda: two_parts().repairs,
    "ConformalStructure": lambda: conformal_structure(surface_of(CLOSED["genus 2 block"])),
    "narrow bounds": lambda: conformal_structure(surface_of(families.torus(9, 6)), bounds=0.1),
    "BoundedStructure": lambda: conformal_structure(surface_of(BOUNDED["tube"])),
    "double cover": lambda: conformal_structure(surface_of(BOUNDED["tube"]), boundary="double_cover"),
    "TiledSurface": tiled,
    "Places": lambda: tiled().places(),
    "Lines": lambda: tiled().lines(),
    "Cells": lambda: tiled().cells(),
    "Quads": lambda: two_parts().quads(200),
    "Relief": lambda: tiled().relief(np.eye(4), 0.01, most_triangles=2000),
    "PoleStructure": lambda: log_map(ball()),
    "truncated": lambda: log_map(surface_of(families.cube())),
    "residues": lambda: log_map(
        surface_of(CLOSED["torus of quads"]), poles=np.array([0, 200, 400]), residues=[1, 1j, -1 - 1j]
    ),
    "DiskMap": lambda: disk_map(disk(), int(np.abs(disk().vertices).sum(axis=1).argmin())),
    "automatic structure": lambda: automatic_structure(disk()),
    "cut": lambda: cut_along(conformal_structure(surface_of(CLOSED["torus of quads"])), both_loops()),
    "Map in islands": lambda: holomorph.island_map(surface_of(families.cube())),
    "Map": lambda: automatic_map(surface_of(CLOSED["torus of quads"])),
    "Map of pieces": lambda: automatic_map(can()),
    "RectangleMap": lambda: rectangle_map(Surface([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])),
    "FreeBoundaryMap": lambda: free_boundary_map(disk()),
    "level": lambda: ProgressiveMesh(surface_of(CLOSED["torus of quads"])).conformal_structure(200),
    "Certificate": lambda: example("ConformalStructure").certificate,
    "Refinement": lambda: example("narrow bounds").refinement,
    "Residuals": lambda: example("PoleStructure").residuals,
    "SolverReport": lambda: conformal_structure(surface_of(CLOSED["torus of quads"]), solver="paper").solver,
    "FundamentalDomain": lambda: example("ConformalStructure").fundamental_domain,
    "MemoryPlan": lambda: example("ConformalStructure").memory,
    "Quality": lambda: example("ConformalStructure").quality(example("ConformalStructure").uv([1, 0])),
    "Verdict": lambda: example("Quality").verdict,
    "Seen": lambda: example("Tiling").seen,
    "Tiling": tiling,
    "Rounding": lambda: example("Tiling").rounding,
    "PlacedPoles": lambda: holomorph.place_poles(ball(), 4),
    "Zeros": lambda: example("ConformalStructure").zeros([1, 0]),
    "Equivalence": lambda: holomorph.conformally_equivalent(example("level"), surface_of(CLOSED["torus of quads"])),
    "ConformalMap": lambda: holomorph.conformal_map(example("level"), example("level")),
    "Automorphisms": lambda: holomorph.automorphisms(solved("torus of quads")),
    "SiegelReduction": lambda: holomorph.siegel_reduction(example("ConformalStructure").period_matrix),
    "Frame": lambda: holomorph.frame(solved("torus of quads").surface, solved("torus of quads").uv([1])),
    "LevelOfDetail": lambda: ProgressiveMesh(surface_of(CLOSED["torus of quads"])).levels_of_detail(
        solved("torus of quads").uv([1]), [200]
    )[0],
    "ProgressiveMesh": lambda: ProgressiveMesh(surface_of(CLOSED["torus of quads"]), corner_data=np.arange(432 * 4)),
    "Cut": lambda: holomorph.Cut("touching", np.arange(3), np.empty((0, 2), int), np.empty(0, int)),
    "ImageLattice": lambda: holomorph.image_lattice(np.kron([[0, 1], [1, 0]], np.ones((8, 8)))),
    "ImageTurns": lambda: holomorph.image_turns(np.kron([[0, 1], [1, 0]], np.ones((8, 8)))),
    "CoarsePlace": lambda: holomorph.CoarsePlace(times=9.0, vertex=3),
    "Refused": lambda: holomorph.Refused(np.arange(3), "edge 1 has 3 faces"),
}
STRUCTURES = [
    *("ConformalStructure", "narrow bounds", "BoundedStructure", "double cover", "PoleStructure", "truncated"),
    *("residues", "DiskMap", "automatic structure", "cut", "RectangleMap", "FreeBoundaryMap", "level"),
]


def again(value):
    return pickle.loads(pickle.dumps(value))


def is_solved(structure):
    return "native" in vars(structure._solution)


def assert_same(one, two):
    """The same bits, and arrays that are read-only."""
    assert type(one) is type(two)
    if isinstance(one, np.ndarray):
        assert (one.dtype, one.shape, one.tobytes()) == (two.dtype, two.shape, two.tobytes())
        assert not two.flags.writeable or one.flags.writeable
    elif isinstance(one, (tuple, list)):
        assert len(one) == len(two)
        for entry, other in zip(one, two):
            assert_same(entry, other)
    elif isinstance(one, Surface):
        assert_same([getattr(one, name) for name in OF_SURFACES], [getattr(two, name) for name in OF_SURFACES])
        natives = [[np.array(getattr(each._native, name)) for name in OF_NATIVE_SURFACES] for each in (one, two)]
        assert_same(*natives)
        assert_same(one.refused, two.refused)
        assert_same(one.repairs, two.repairs)
    elif isinstance(one, ProgressiveMesh):
        assert_same(list(one.__getstate__().values()), list(two.__getstate__().values()))
    elif isinstance(one, holomorph.TiledSurface):
        for name in ("surface", "uv", "lattice", "poles"):
            assert_same(getattr(one, name), getattr(two, name))
    elif is_dataclass(one):
        for entry in fields(one):
            if not entry.name.startswith("_"):
                assert_same(getattr(one, entry.name), getattr(two, entry.name))
    else:
        assert one == two or one != one


def test_every_public_kind_of_result_is_tried():
    """But for arrays that know their error, which are arrays otherwise."""
    kinds = {kind for kind in map(holomorph.__dict__.get, dir(holomorph)) if isinstance(kind, type)}
    errors = {kind for kind in kinds if issubclass(kind, Exception)}
    assert {type(example(name)) for name in EXAMPLES} >= kinds - errors - {holomorph.Tiler, holomorph.PeriodMatrix}


@pytest.mark.parametrize("name", EXAMPLES)
def test_reprs_are_one_short_line(name):
    text = repr(example(name))
    assert type(example(name)).__name__ in text
    assert "array" not in text and " object at " not in text and "\n" not in text
    assert len(text) <= LONGEST_REPR


@pytest.mark.parametrize("name", EXAMPLES)
def test_pickles_have_the_same_bits(name):
    given = example(name)
    assert_same(given, again(given))
    assert repr(again(given)) == repr(given)


@pytest.mark.parametrize("name", EXAMPLES)
def test_copies_have_the_same_bits(name):
    for made in (copy.copy(example(name)), copy.deepcopy([example(name)])[0]):
        assert_same(example(name), made)


@pytest.mark.parametrize("name", STRUCTURES)
def test_structures_of_a_pickle_go_on_with_the_same_bits(name):
    one = example(name)
    two = again(one)
    assert not is_solved(two)
    coefficients = one.balanced_coefficients()
    uv = one.uv(coefficients)
    assert_same(uv, two.uv(coefficients))
    assert_same(one.quality(uv), two.quality(uv))
    for attribute in OF_STRUCTURES:
        assert_same(getattr(one, attribute), getattr(two, attribute))
    assert one.invariants() == two.invariants()
    assert two.surface.dual_vertex is None


def test_what_was_computed_is_in_the_pickle():
    given = example("ConformalStructure")
    bits = given.period_matrix.tobytes()
    made = again(given)
    assert made.period_matrix.tobytes() == bits
    assert not is_solved(made)
    made.uv([1, 0])
    assert is_solved(made)


def test_quality_of_a_pickle_tells_all():
    given = again(example("Quality"))
    for name in ("mean_angle", "flipped_part", "lost_part", "verdict"):
        assert getattr(given, name) == getattr(example("Quality"), name)


@pytest.mark.parametrize("name", [*CLOSED, *FLAT, *BOUNDED])
def test_surfaces_of_pickles(name):
    surface = surface_of((CLOSED | FLAT | BOUNDED)[name])
    assert_same(surface, again(surface))


def test_parts_levels_and_doubles_of_pickles():
    mesh = ProgressiveMesh(surface_of(CLOSED["genus 2 block"]))
    for surface in (*two_parts().components, mesh.base, mesh.level(300), mesh.restore()):
        assert_same(surface, again(surface))
    double = holomorph.double_cover(surface_of(BOUNDED["punctured torus"]))
    assert_same(double, again(double))


def test_a_tiler_is_not_pickled():
    tiler = holomorph.Tiler(surface_of(CLOSED["torus of quads"]), 2)
    assert len(repr(tiler)) <= LONGEST_REPR
    for action in (pickle.dumps, copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match="take its tiling, or its surface and poles"):
            action(tiler)


@pytest.mark.parametrize("kind", ["Error", "InvalidMesh", "TopologyError", "SolverError", "Cancelled", "OutOfMemory"])
def test_errors_are_pickled(kind):
    error = getattr(holomorph, kind)("edge 812 has 3 faces")
    assert (type(again(error)), str(again(error))) == (type(error), str(error))


IN_ANOTHER_PROCESS = """
import hashlib, json, pickle, sys
sys.path[:0] = json.loads(sys.argv[1])
structure = pickle.load(sys.stdin.buffer)
print(hashlib.sha256(structure.uv([1, 0]).tobytes() + structure.period_matrix.tobytes()).hexdigest())
"""


def test_another_process_goes_on_with_the_same_bits():
    structure = conformal_structure(surface_of(CLOSED["genus 2 block"]))
    command = [sys.executable, "-c", IN_ANOTHER_PROCESS, json.dumps(sys.path)]
    run = subprocess.run(command, input=pickle.dumps(structure), capture_output=True, timeout=120)
    bits = structure.uv([1, 0]).tobytes() + structure.period_matrix.tobytes()
    assert run.stdout.decode().strip() == hashlib.sha256(bits).hexdigest(), run.stderr.decode()
