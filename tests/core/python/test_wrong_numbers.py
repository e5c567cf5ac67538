"""Any number, and what is none, for any parameter of any public function: a result, or one sentence of ours."""

import inspect
import re

import families
import holomorph
import numpy as np
import pytest
from holomorph import ProgressiveMesh, Surface, TiledSurface, Tiler, arrangement, conformal_structure
from solved import surface_of

HUGE = 10**400  # more than a float holds
WRONG = {
    "huge": HUGE,
    "huge below 0": -HUGE,
    "beyond all digits": 10**5000,  # Python does not print it
    "2^63": 2**63,
    "2^31": 2**31,
    "-1": -1,
    "0": 0,
    "nan": np.nan,
    "inf": np.inf,
    "-inf": -np.inf,
    "True": True,
    "text": "many",
    "nothing": None,
    "bytes": b"many",
    "huge ones": [HUGE, HUGE],
    "huge pairs": [[HUGE, 0], [0, HUGE]],
    "object": object(),
    "half": 0.5,
}
FOREIGN = (  # in sentences of Python and NumPy
    r"incompatible function|too large|too big|convert|Python int|out of bounds|ambiguous|'NoneType'|unsupported|"
    r"object is not"
)
NUMBERS = re.compile(r"\b(int|float|complex|Poles|Vertices|Sequence|Mapping|ArrayLike|FilePath|str)\b")


def torus():
    return surface_of(families.torus(8, 6, shape="triangles"))


def sheet():
    """A disk of quads."""
    x, y = (each.ravel() for each in np.meshgrid(np.arange(5.0), np.arange(4.0)))
    first = (np.arange(3)[:, None] * 5 + np.arange(4)).ravel()
    return Surface(np.stack([x, y, 0 * x], axis=1), np.stack([first, first + 1, first + 6, first + 5], axis=1))


def calls():
    """name -> (function, arguments that are right): everything public that takes a number."""
    surface, disk = torus(), sheet()
    structure = conformal_structure(surface)
    uv, mesh = structure.uv(structure.balanced_coefficients()), ProgressiveMesh(surface)
    tiler = Tiler(surface, 0)
    tiling = tiler.tile()
    tiled = TiledSurface(surface, tiling.uv)
    made = holomorph.automatic_map(surface)
    quality = structure.quality(uv)
    heights = np.eye(4)
    raised = tiled.relief(heights, 0.1, most_triangles=100)
    polygons = {"vertices": surface.vertices, "corner_vertices": surface.corner_vertices}
    triangles = surface.triangles
    lengths = np.linalg.norm(
        surface.vertices[np.roll(triangles, -1, 1)] - surface.vertices[np.roll(triangles, 1, 1)], axis=2
    )
    form = {"parts": [(surface, structure)], "form": 0, "corners": len(made.uv)}

    def arranged_so(density: float = 1.0, rotation: float = 0.0, margin: float = 0.02, quarters: int = 0):
        chosen = arrangement.Arrangement(density=density, rotation=rotation, margin=margin, quarters=quarters)
        return arrangement.arranged([made], len(made.uv), chosen)

    return {
        "Surface": (Surface, {"vertices": surface.vertices, "faces": triangles}),
        "Surface.from_polygons": (Surface.from_polygons, polygons | {"face_offsets": surface.face_offsets}),
        "Surface.from_edge_lengths": (Surface.from_edge_lengths, {"faces": triangles, "edge_lengths": lengths}),
        "Surface.read": (Surface.read, {"path": "none.obj"}),
        "Surface.write": (surface.write, {"path": "none.xyz"}),
        "ProgressiveMesh": (ProgressiveMesh, {"surface": surface}),
        "ProgressiveMesh.load": (ProgressiveMesh.load, {"path": "none"}),
        "ProgressiveMesh.save": (mesh.save, {"path": "none/none"}),
        "ProgressiveMesh.level": (mesh.level, {"n_faces": 50}),
        "ProgressiveMesh.level_corner_data": (mesh.level_corner_data, {"n_faces": 50}),
        "ProgressiveMesh.levels_of_detail": (mesh.levels_of_detail, {"uv": uv, "n_faces": [50]}),
        "ProgressiveMesh.conformal_structure": (mesh.conformal_structure, {"n_faces": 50}),
        "ProgressiveMesh.vertex_map": (mesh.vertex_map, {"n_faces": 50}),
        "ProgressiveMesh.lift_loops": (mesh.lift_loops, {"loops": []}),
        "ProgressiveMesh.pull_back_forms": (mesh.pull_back_forms, {"forms": structure.holomorphic_forms}),
        "Relief.at_depth": (raised.at_depth, {"depth": 0.1}),
        "TiledSurface": (TiledSurface, {"surface": surface, "uv": tiling.uv}),
        "TiledSurface.places": (tiled.places, {}),
        "TiledSurface.lines": (tiled.lines, {}),
        "TiledSurface.cells": (tiled.cells, {}),
        "TiledSurface.relief": (tiled.relief, {"heights": heights, "depth": 0.1, "most_triangles": 100}),
        "Tiler": (Tiler, {"surface": surface, "poles": 0}),
        "Tiler.tile": (tiler.tile, {}),
        "Tiler.even": (tiler.even, {"tiling": tiling, "evenness": 0.5}),
        "Tiler.move_poles": (tiler.move_poles, {"tiling": tiling, "moves": {}}),
        "Structure.uv": (structure.uv, {"coefficients": [1]}),
        "Structure.uv_of": (structure.uv_of, {"n": [1, 0], "m": [0, 1]}),
        "Structure.quality": (structure.quality, {"uv": uv}),
        "Structure.tile": (structure.tile, {}),
        "automatic_map": (holomorph.automatic_map, {"surface": surface}),
        "automatic_maps": (holomorph.automatic_maps, {"surfaces": [surface]}),
        "automatic_structure": (holomorph.automatic_structure, {"surface": surface}),
        "automorphisms": (holomorph.automorphisms, {"structure": structure}),
        "coarse_places": (holomorph.coarse_places, {"mesh": surface, "density": np.ones(len(triangles))}),
        "conformal_map": (holomorph.conformal_map, {"a": structure, "b": structure}),
        "conformal_structure": (conformal_structure, {"surface": surface}),
        "conformally_equivalent": (holomorph.conformally_equivalent, {"a": structure, "b": structure}),
        "cut_along": (holomorph.cut_along, {"structure": structure, "edges": structure.seams}),
        "disk_map": (holomorph.disk_map, {"surface": disk}),
        "form_map": (holomorph.form_map, {"surface": surface, "structure": structure}),
        "frame": (holomorph.frame, {"surface": surface, "uv": uv}),
        "free_boundary_map": (holomorph.free_boundary_map, {"surface": disk}),
        "height_image": (holomorph.height_image, {"path": "none.png"}),
        "image_lattice": (holomorph.image_lattice, {"pixels": np.random.default_rng(1).random((32, 32))}),
        "image_turns": (holomorph.image_turns, {"pixels": np.random.default_rng(1).random((32, 32))}),
        "island_map": (holomorph.island_map, {"surface": disk}),
        "log_map": (holomorph.log_map, {"surface": surface, "poles": [0, 20]}),
        "place_poles": (holomorph.place_poles, {"surface": surface}),
        "punch_holes": (holomorph.punch_holes, {"surface": surface, "vertices": [0]}),
        "rectangle_map": (holomorph.rectangle_map, {"surface": disk}),
        "siegel_reduction": (holomorph.siegel_reduction, {"period_matrix": [[1j]]}),
        "symmetrised": (holomorph.symmetrised, {"double": holomorph.double_cover(disk), "forms": np.zeros(1)}),
        "verdict": (holomorph.verdict, {"quality": quality}),
        "arrangement.Arrangement": (arranged_so, {}),
        "arrangement.arranged_form": (arrangement.arranged_form, form),
        "arrangement.arranged": (arrangement.arranged, {"maps": [made], "corners": len(made.uv)}),
    }


CALLS = calls()
OF_RESULTS = {
    "parts",
    "surface",
    "structure",
    "mesh",
    "disk",
    "surfaces",
    "structures",
    "quality",
    "maps",
    "tiling",
}


def parameters(function):
    """Names of what is a number, a list of them, a name or a path."""
    for name, each in inspect.signature(function).parameters.items():
        if name not in OF_RESULTS and name != "progress" and NUMBERS.search(str(each.annotation)):
            yield name


CASES = [(name, each) for name, (function, _) in CALLS.items() for each in parameters(function)]


@pytest.mark.parametrize(("name", "parameter"), CASES)
def test_it_gives_a_result_or_says_what_is_wrong(name, parameter, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # some values are paths of files that are written
    function, right = CALLS[name]
    for kind, value in WRONG.items():
        try:
            function(**right | {parameter: value})
        except (holomorph.Error, ValueError, TypeError, OSError) as error:
            said = str(error)
            assert said and "\n" not in said and not re.search(FOREIGN, said), f"{kind}: {said[:300]}"
            assert len(said) < 400, f"{kind}: {said[:300]} ..."


def test_all_that_is_public_and_takes_a_number_is_here():
    for name in dir(holomorph):
        value = getattr(holomorph, name)
        if inspect.isfunction(value) and list(parameters(value)):
            assert name in CALLS, name
