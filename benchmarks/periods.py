# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/periods.py [--json FILE]

Certified period matrices of polyhedral surfaces with exact values: modular curves, polygons, tiled surfaces, rings and
quadrilaterals. Each row says the bounds asked for and reached, the triangles given and solved on, the order of the
elements, seconds of processor time on one thread, and how far the result is from the exact value. Then the width
against unknowns for orders 1 to 8, with and without layers; `scripts/figures digits` draws that.
"""

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "build" / "lib" / f"cp{sys.version_info.major}{sys.version_info.minor}"
sys.path[:0] = [str(PACKAGE), str(ROOT / "tests" / "support")]

import dessins  # noqa: E402
import families  # noqa: E402
import flat_cones  # noqa: E402
import holomorph  # noqa: E402
import known_matrices  # noqa: E402
import regular_maps  # noqa: E402
from curve_periods import curve_period_matrix  # noqa: E402
from holomorph import _native  # noqa: E402
from holomorph.forms.certificate import relative_width  # noqa: E402
from holomorph.forms.narrow_bounds import surface_of_triangles, triangles_of_level, vertex_exponents  # noqa: E402
from holomorph.forms.refined_triangles import halved, with_layers  # noqa: E402

WIDTHS = 1e-4, 1e-8
ORDERS = range(1, 9)
MOST_UNKNOWNS = 60_000
RING = 10.234092569368052  # capacity of a square without a square of half its side, by elliptic integrals


def polygon_curve(n):
    """Coefficients of y^2 = f(x) of the regular n-gon with opposite sides glued."""
    return [1, *[0] * (n // 2 - 1), -1] if n % 4 == 2 else [1, *[0] * (n // 2 - 1), -1, 0]


def closed_cases():
    """(name, surface, its exact period matrix or None)."""
    for N in (*dessins.ELLIPTIC, *dessins.HYPERELLIPTIC, 34, 43, 64):
        known = N in dessins.ELLIPTIC or N in dessins.HYPERELLIPTIC
        yield f"X_0({N})", dessins.modular_curve(N), curve_period_matrix(dessins.curve(N)) if known else None
    for n in (8, 10, 12, 14, 18, 22):
        yield f"regular {n}-gon", flat_cones.regular_polygon(n), curve_period_matrix(polygon_curve(n))
    for n in (5, 7, 9):
        curve = curve_period_matrix([1, *[0] * (n - 1), -1])
        yield f"double {n}-gon", flat_cones.double_polygon(n), curve
    for name, mesh in (("Klein", regular_maps.klein_quartic()), ("Macbeath", regular_maps.macbeath_curve())):
        yield f"{name}, Hurwitz", mesh, None
    yield "L of three squares", families.square_tiled([1, 0, 2], [2, 1, 0], 1), known_matrices.SQUARES


def surface_of(mesh):
    return holomorph.Surface.from_edge_lengths(mesh.faces, mesh.edge_lengths, mesh.face_edges)


def timed(given, width):
    start = time.process_time()
    structure = holomorph.conformal_structure(given, bounds=width, threads=1)
    return structure, time.process_time() - start


def row(name, given, exact, width):
    """One line of the table; the distance of the exact value in the metric of `conformally_equivalent`."""
    structure, seconds = timed(given, width)
    refinement = structure.refinement
    found = {"name": name, "genus": given.genus, "asked": width, "seconds": seconds, "order": refinement.orders[-1]}
    found |= {"given": len(given.triangles), "triangles": refinement.levels[-1][0], "width": refinement.levels[-1][1]}
    if exact is not None:
        found["distance"] = holomorph.conformally_equivalent(structure, exact).residual
    return found


def ring_row(width):
    mesh = families.square_minus_square(1)
    given = holomorph.Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)
    structure, seconds = timed(given, width)
    (count, reached), order = structure.refinement.levels[-1], structure.refinement.orders[-1]
    low, high = (float(bound[0, 0]) for bound in structure.capacity_bounds)
    assert low <= RING <= high
    found = {"name": "square minus square", "genus": 0, "asked": width, "seconds": seconds, "order": order}
    found |= {"given": len(given.triangles), "triangles": count, "width": reached}
    return found | {"distance": abs(np.log(structure.capacity_matrix[0, 0] / RING))}


def printed(rows):
    print(f"{'surface':20}genus  asked    width   triangles  order  seconds  exact value at")
    for r in rows:
        distance = "" if "distance" not in r else f"{r['distance']:.0e}"
        counts = f"{r['given']:4} ->{r['triangles']:6}"
        print(
            f"{r['name']:20}{r['genus']:5}{r['asked']:7.0e}{r['width']:9.1e}{counts:>14}{r['order']:5}"
            f"{r['seconds']:9.2f}    {distance}"
        )


def convergence(mesh):
    """{"p": [(unknowns, width)], "p, layers": ...} of one surface, refined evenly, or in 2 p layers and then evenly."""
    structure = holomorph.conformal_structure(surface_of(mesh), threads=1)
    native, given = structure._native, (structure._native.surface(), structure._native.side_classes())
    natural = native.families().natural
    base = triangles_of_level(_native.solve_level(*given, natural, 1, 1, None))
    rough = np.abs(vertex_exponents(base) % 1 - 0.5) < 0.5 - 1e-6
    found = {}
    for p in ORDERS:
        for layers in (0, 2 * p):
            triangles, series = with_layers(base, rough.astype(int) * layers), []
            while True:
                unknowns = int(triangles.corners.max()) + 1 + (p - 1) * len(triangles.lengths)
                if unknowns > MOST_UNKNOWNS:
                    break
                solved = _native.solve_level(*surface_of_triangles(triangles), natural, p, 1, None)
                native.narrow(solved.energies.gram, solved.energies.certain, metric_error=0.0)
                series.append((unknowns, relative_width(*native.period_bounds(), native.period_matrix().imag)))
                triangles = halved(triangles, np.ones(len(triangles.corners), bool))
            found[f"{p}{', layers' if layers else ''}"] = series
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[2])
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    cases = list(closed_cases())
    rows = [row(name, surface_of(mesh), exact, width) for name, mesh, exact in cases for width in WIDTHS]
    rows += [ring_row(width) for width in WIDTHS]
    printed(rows)
    series = convergence(dessins.modular_curve(11))
    print(
        "\nX_0(11): relative width at the most unknowns\n" + "\n".join(f"p = {k}: {v[-1]}" for k, v in series.items())
    )
    if arguments.json:
        arguments.json.write_text(json.dumps({"rows": rows, "convergence": series}, indent=1))


if __name__ == "__main__":
    main()
