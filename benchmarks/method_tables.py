# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/method_tables.py [NAME]...

Prints the tables of docs/method: known (periods.md), poles (poles.md), levels (progressive.md), tubes (disks.md)
and tilings (tilings.md). All but the first two need the folder ../shared/meshes.
"""

import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
MESHES = ROOT.parent / "shared" / "meshes"
PACKAGE = ROOT / "build" / "lib" / f"cp{sys.version_info.major}{sys.version_info.minor}"
sys.path[:0] = [str(PACKAGE), str(ROOT / "tests" / "support")]

import exact_maps  # noqa: E402
import families  # noqa: E402
import holomorph  # noqa: E402
from solved import surface_of  # noqa: E402

SQUARE_MINUS_SQUARE = 10.234092569368052
CONE = np.log(4) / np.pi  # of half angle 30 degrees, from radius 1/2 to 2
DISKS = {"face_34k_b1.obj": "a face", "hemisphere_b1.obj": "a hemisphere", "hand_lowres_b1.obj": "an open hand"}
DISKS["fertility_cutseam.obj"] = "a fertility statue, cut open"


CREATURES = [
    *("kitten_19k.obj", "armadillo_29k.obj", "elephant_g3_50k.obj", "skull_low_g2.obj", "hand_closed.obj"),
    *("spot_quads.obj", "makehuman_base_quads.obj", "rockerArm_ngon.obj", "bunny_60k.obj"),
]


def cone(n):
    radius = 0.5 * 4 ** np.linspace(0, 1, n // 4 + 1)
    return families.ring_of_revolution(radius, radius / np.tan(np.pi / 6), n)


def known():
    """Vertices, exact value, lower bound, projected value, upper bound."""
    rings = [
        (
            "square minus square",
            SQUARE_MINUS_SQUARE,
            [families.square_minus_square(k, jitter=0.25) for k in (8, 16, 32)],
        ),
        ("corner of a cube", 0.75 * SQUARE_MINUS_SQUARE, [families.cube_corner(k, jitter=0.2) for k in (8, 16, 32)]),
    ]
    for name, exact, meshes in rings:
        for mesh in meshes:
            structure = holomorph.conformal_structure(surface_of(mesh))
            low, high = (bound[0, 0] for bound in structure.capacity_bounds)
            value = structure.capacity_matrix[0, 0]
            print(f"{name} | {len(mesh.vertices)} | {exact:.5f} | {low:.5f} | {value:.5f} | {high:.5f}")
    for n in (16, 32, 64):
        structure = holomorph.conformal_structure(surface_of(cone(n)))
        low, high = structure.modulus_bounds
        count = len(structure.surface.vertices)
        print(f"cone | {count} | {CONE:.6f} | {low:.6f} | {structure.modulus:.6f} | {high:.6f}")


def poles():
    """Vertices, errors of u and v of the log map of a sphere; of the Riemann map of a hemisphere."""
    for n in (7, 14, 28, 56):
        u, v = exact_maps.log_map_errors(n, seed=0)
        print(f"log map | {10 * n * n + 2} | {u:.1e} | {v:.1e}")
    for n in (13, 26, 52, 103):
        print(f"Riemann map | {3 * n * (n + 1) + 1} | {exact_maps.riemann_map_error(n, seed=0):.1e}")


def levels():
    """Triangles, difference of period matrices, root mean square and largest move."""
    for name in ("kitten_19k.obj", "double-torus.obj", "fertility_ngon_g4.obj"):
        structure = holomorph.conformal_structure(holomorph.Surface.read(MESHES / name))
        mesh = holomorph.ProgressiveMesh(structure.surface)
        uv = structure.uv(structure.balanced_coefficients())
        count = len(structure.surface.triangles)
        for level in mesh.levels_of_detail(uv, [count // 4**k for k in (1, 2, 3)], harmonic=True):
            faces = len(level.surface.triangles)
            coarse, fine = mesh.conformal_structure(faces).period_matrix, mesh.conformal_structure(count).period_matrix
            difference = np.abs(coarse - fine).max() / np.abs(fine).max()
            mean, largest = np.sqrt(np.mean(level.drift**2)), level.drift.max()
            print(f"{name} | {faces} | {difference:.0e} | {mean:.4f} | {largest:.3f}")


def tubes():
    """Density ratios, 95 % over 5 % quantile, of the disk map, its log map and the rectangle at quarters."""
    for file, name in DISKS.items():
        surface = holomorph.Surface.read(MESHES / file, strict=True)  # what is cut open stays so
        disk = holomorph.disk_map(surface)
        maps = [disk, holomorph.log_map(surface, [disk.centre]), holomorph.rectangle_map(surface)]
        found = [made.quality(made.uv(made.balanced_coefficients())).density_ratio for made in maps]
        print(f"{name} | {' | '.join(f'{ratio:.2g}' for ratio in found)}")


def tilings():
    """Triangles, poles; 95:5, 99:1 and mean s1/s2 at evenness 0.5; 95:5 at 1; seconds, if nothing else runs."""
    for file in CREATURES:
        surface = holomorph.Surface.read(MESHES / file, strict=False)
        structure = holomorph.automatic_structure(max(surface.components, key=lambda part: part.area))
        begin = time.process_time()
        made = structure.tile(evenness=0.5, direction="upright")
        seconds = time.process_time() - begin
        quality = made.quality
        low, high = np.quantile(quality.area, (0.01, 0.99), weights=quality.weights, method="inverted_cdf")
        even = structure.tile(evenness=1, direction="upright").quality.density_ratio
        figures = f"{quality.density_ratio:.1f} | {high / low:.1f} | {quality.mean_angle:.2f} | {even:.1f}"
        print(f"{file} | {len(structure.surface.triangles)} | {len(made.poles)} | {figures} | {seconds:.1f}")


TABLES = dict(known=known, poles=poles, levels=levels, tubes=tubes, tilings=tilings)

if __name__ == "__main__":
    for name in sys.argv[1:] or TABLES:
        print(f"==> {name}: {TABLES[name].__doc__}")
        TABLES[name]()
