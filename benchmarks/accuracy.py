# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/accuracy.py [--json FILE] [--plot FILE]

Period matrices against exact values: published errors (Bobenko, Mercat, Schmies 2011,
doi:10.1007/978-3-642-17413-1_7) beside ours on as many vertices, where there is the folder ../shared/reference with
them and their meshes; then errors and certified widths against vertices, of curved tori and under graded refinement.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
REFERENCE = ROOT.parent / "shared" / "reference"
PACKAGE = ROOT / "build" / "lib" / f"cp{sys.version_info.major}{sys.version_info.minor}"
sys.path[:0] = [str(PACKAGE), str(ROOT / "tests" / "support")]

import equivalence  # noqa: E402
import families  # noqa: E402
import flat_cones  # noqa: E402
import holomorph  # noqa: E402
import lawson  # noqa: E402
from curve_periods import curve_period_matrix  # noqa: E402

FINEST = 1e-12  # relative width that no refinement reaches
LAWSON = (14, 24)  # intervals on an arc
TORI = (16, 32, 64, 128, 256)  # quads along
POLYGONS = {"octagon": (8, [1, 0, 0, 0, -1, 0]), "decagon": (10, [1, 0, 0, 0, 0, -1])}  # sides, and y^2 = f(x)
GRADES = (250, 500, 1000, 2000, 4000, 8000, 16000, 32000, 64000)


def matrix(entry):
    if "Re" in entry:
        return np.array(entry["Re"]) + 1j * np.array(entry["Im"])
    factor = {"i/3": 1j / 3, "i/sqrt(3)": 1j / np.sqrt(3)}[entry["times"]]
    return factor * np.array(entry["matrix"])


def surface(name):
    path = REFERENCE / "meshes" / name
    if path.suffix == ".obj":
        return holomorph.Surface.read(path)
    with np.load(path) as arrays:
        return holomorph.Surface.from_edge_lengths(arrays["faces"], arrays["edge_lengths"])


def measured(given, exact, norm=equivalence.max_norm, **options):
    """(vertices, error, certified relative width); error: up to Sp(2g, Z) and the mirror image."""
    structure = holomorph.conformal_structure(given, **options)
    faces = structure.refinement.levels[-1][0] if structure.refinement else len(given.triangles)
    vertices = faces // 2 + 2 - 2 * given.genus
    error = equivalence.distance_or_mirrored(structure.period_matrix, exact, norm)
    return vertices, error, structure.certificate.relative_width


def published(values):
    """Rows (case, published vertices, published error, our vertices, our error, our certified width): the tiled
    surfaces as given, whose symmetry alone makes them exact, and graded, where it is lost."""
    rows = []
    for name in ("omega2_squares4", "omega3_squares6"):
        exact = matrix(values["genus2"][name])
        coarsest = surface(f"{name}_level0.npz")
        given = {len(mesh.triangles) // 2 - 2: mesh for mesh in (surface(f"{name}_level{k}.npz") for k in range(4))}
        for vertices, error in values["published_errors"][name].items():
            if int(vertices) in given:
                rows.append((f"{name} as given", int(vertices), error, *measured(given[int(vertices)], exact)))
            ours = measured(coarsest, exact, bounds=FINEST, most_faces=2 * (int(vertices) + 2))
            rows.append((f"{name} graded", int(vertices), error, *ours))
    return rows + lawson_rows(values)


def lawson_rows(values):
    """Frobenius norms: the meshes given, and one of our own with the surface's symmetries, by its chords in S^3 (whose
    symmetry alone makes it exact) and in space (where it is lost)."""
    meshes = {f"lawson_xi21_{level}": surface(f"lawson_xi21_{level}.obj") for level in (32, 64)}
    for n in LAWSON:
        points, triangles = lawson.lawson(n)
        chords = lawson.chords(points, triangles)
        meshes[f"lawson in space, {n}"] = holomorph.Surface(lawson.in_space(points), triangles)
        meshes[f"lawson in S^3, {n}"] = holomorph.Surface.from_edge_lengths(triangles, chords)
    exact = matrix(values["genus2"]["omega3_squares6"])
    frobenius = values["published_errors"]["lawson_frobenius"].items()
    rows = []
    for name, mesh in meshes.items():
        ours = measured(mesh, exact, np.linalg.norm)
        nearest = min(frobenius, key=lambda item: abs(int(item[0]) - ours[0]))
        rows.append((name, int(nearest[0]), nearest[1], *ours))
    return rows


def curves():
    """{name: [(vertices, error, width)]}: tori of revolution, finer and finer, and graded refinement of one coarse mesh
    of a regular polygon with opposite sides glued, of which no symmetry is left."""
    torus = [families.torus(n, n // 2, R=1.5, shape="triangles", jitter=0.2) for n in TORI]
    exact = np.array([[1j / np.sqrt(1.5**2 - 1)]])
    found = {
        "torus": [measured(holomorph.Surface.from_polygons(m.vertices, m.corners, m.offsets), exact) for m in torus]
    }
    for name, (sides, curve) in POLYGONS.items():
        flat = flat_cones.jittered(flat_cones.regular_polygon(sides), 1)
        mesh = holomorph.Surface.from_edge_lengths(flat.faces, flat.edge_lengths, flat.face_edges)
        exact = curve_period_matrix(curve)
        found[name] = [measured(mesh, exact, bounds=FINEST, most_faces=faces) for faces in GRADES]
    return found


def plot(found, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7, 5))
    for name, rows in found.items():
        vertices, errors, widths = np.array(rows, float).T
        (line,) = axes.loglog(vertices, np.maximum(errors, 1e-16), "o-", label=f"{name}: error")
        axes.loglog(vertices, widths, "s--", color=line.get_color(), label=f"{name}: certified width")
    axes.set(xlabel="vertices", ylabel="largest entry, relative width")
    axes.legend()
    figure.tight_layout()
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--plot", type=Path)
    options = parser.parse_args()
    rows = published(json.loads((REFERENCE / "values.json").read_text())) if REFERENCE.is_dir() else []
    if rows:
        print(f"{'case':24} {'vertices':>9} {'published':>10} {'ours, on':>9} {'error':>10} {'certified':>10}")
    for name, count, error, vertices, ours, width in rows:
        print(f"{name:24} {count:9} {error:10.2e} {vertices:9} {ours:10.2e} {width:10.2e}")
    found = curves()
    for name, points in found.items():
        for vertices, error, width in points:
            print(f"{name:20} {vertices:9} error {error:.2e} certified {width:.2e}")
    if options.json:
        options.json.write_text(json.dumps({"published": rows, "graded": found}, indent=1))
    if options.plot:
        plot(found, options.plot)


if __name__ == "__main__":
    main()
