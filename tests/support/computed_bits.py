"""The bits of what the library computes, by one name each: they are the same after any fault."""

from pathlib import Path

import families
import numpy as np
from holomorph import ProgressiveMesh, Surface, Tiler, automatic_structure
from mesh_files import off
from solved import RESULTS, surface_of

TORUS = families.torus(97, 85, shape="triangles", jitter=0.2)  # just large enough for its loops to be shared out


def bits_of_structure(mesh, options, progress=None):
    structure = automatic_structure(surface_of(mesh), **options, progress=progress)
    uv = structure.uv(structure.balanced_coefficients())
    return uv.tobytes() + np.array(structure.quality(uv).density_ratio).tobytes()


def bits_of_tiling(mesh, options, progress=None):
    return Tiler(surface_of(mesh), 2, **options, progress=progress).tile(60, progress=progress).uv.tobytes()


def bits_of_levels(mesh, options, progress=None):
    progressive = ProgressiveMesh(surface_of(mesh), progress=progress)
    return progressive.splits.tobytes() + progressive.level(30).vertices.tobytes()


def bits_of_file(mesh, options, progress=None):
    path = Path(options["folder"], "mesh.off")
    path.write_bytes(off(mesh))
    return Surface.read(path).vertices.tobytes()


TINY = {
    "closed, direct": (bits_of_structure, families.torus(6, 5), {"solver": "direct", "threads": 1}),
    "closed, multigrid": (bits_of_structure, families.torus(6, 5), {"solver": "multigrid", "threads": 2}),
    "closed, paper": (bits_of_structure, families.torus(6, 5), {"solver": "paper", "threads": 2}),
    "bounded": (bits_of_structure, families.punched(families.block_with_holes(0, refine=2), 3), {"threads": 2}),
    "sphere": (bits_of_structure, families.geodesic_sphere(2), {"threads": 2}),
    "disk": (bits_of_structure, families.hemisphere(3), {"threads": 2}),
    "tiling": (bits_of_tiling, families.torus(6, 5), {"threads": 2}),
    "levels": (bits_of_levels, families.torus(6, 5), {}),
    "file": (bits_of_file, families.torus(6, 5), {}),
}


def all_arrays(structure):
    c = structure.balanced_coefficients()
    uv = structure.uv(c)
    quality = structure.quality(uv)
    single = [getattr(structure, name) for name in RESULTS]
    numbers = np.array([quality.mean_angle, quality.density_ratio, *vars(structure.residuals).values()])
    return [*single, *structure.homology_basis, *structure.period_bounds, c, uv, quality.angle, quality.area, numbers]


def assert_same_bits(one, other):
    for a, b in zip(all_arrays(one), all_arrays(other), strict=True):
        assert a.dtype == b.dtype
        assert a.tobytes() == b.tobytes()
