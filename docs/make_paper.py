# SPDX-License-Identifier: GPL-3.0-or-later
"""python docs/make_paper.py BUNNY HAND [--figures] [--table] [--meshes FOLDER]: what docs/paper.md shows of both.

BUNNY is the Stanford bunny with its five holes, bun_zipper.ply of the Stanford 3D Scanning Repository; HAND the closed
hand of github.com/odedstein/meshes, objects/hand/hand_closed.obj. Draws docs/pictures/paper_*.jpg, prints the table of
section 10, or writes both surfaces with 60,000 faces, for benchmarks/paper_solver.py. Needs the package and matplotlib,
as in build/venv/figures (`scripts/figures`).
"""

import argparse
import sys
from pathlib import Path
from types import SimpleNamespace

import holomorph
import numpy as np
from figure_views import BLUE, View, checker, on_triangles
from PIL import Image

PICTURES = Path(__file__).parent / "pictures"
FACES = 60_000
LEVELS = (5_000, 10_000, 18_000, 40_000)  # of the paper's figure 4
FINGERTIPS = (79, 1093, 2114, 3000, 3420)  # vertices of HAND
BUNNY_FORM = (1, 0, 0, 0)
SQUARES = {"bunny": 30, "hand": 12}  # dark ones to a period
SIZE = 480  # pixels, width of each surface


def bunny(path):
    """The largest part of the scan: genus 0, five boundary loops, 69,451 triangles."""
    return max(holomorph.Surface.read(path).components, key=lambda part: part.area)


def hand(path):
    """Each triangle cut into four, without the bottom of the wrist, holes at the tips of the fingers: six loops."""
    closed = holomorph.Surface.read(path)
    native, corners = closed._native, closed.triangles
    middles = len(closed.vertices) + native.triangle_edges
    points = np.concatenate([closed.vertices, closed.vertices[native.edges].mean(axis=1)])
    (a, b, c), (ab, bc, ca) = corners.T, middles.T
    triangles = np.concatenate(np.stack([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]).transpose(0, 2, 1))
    p = points[triangles]
    normals = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    is_bottom = (normals[:, 1] < -0.75 * np.linalg.norm(normals, axis=1)) & (p[:, :, 1].mean(axis=1) < 0.05)
    (open_hand,) = holomorph.Surface(points, triangles[~is_bottom]).components
    tips = [int(np.flatnonzero(open_hand.vertex_index == tip)[0]) for tip in FINGERTIPS]
    return holomorph.punch_holes(open_hand, tips)


def drawn(surface, uv, squares):
    """The surface, +Y up, with a checker."""
    x, y, z = surface.vertices.T
    stood = SimpleNamespace(vertices=np.stack([x, -z, y], -1), triangles=surface.triangles)
    view = View(stood, tilt=-84, width=SIZE)
    return view.image(checker(view.at_pixels(on_triangles(surface, uv)), squares, BLUE))


def write_picture(name, images):
    """Side by side, as docs/pictures/paper_NAME.jpg."""
    height = max(len(image) for image in images)
    padded = [np.pad(image, ((height - len(image), 0), (0, 0), (0, 0)), constant_values=1) for image in images]
    path = PICTURES / f"paper_{name}.jpg"
    Image.fromarray((np.hstack(padded) * 255).round().astype(np.uint8)).save(path, quality=78, optimize=True)
    sys.stdout.write(f"docs/pictures/{path.name}  {path.stat().st_size // 1024} KB\n")


def draw(bunny_mesh, hand_surface):
    """Figure 4: one form at four levels, of the same loops. Figure 5: each form of the hand alone."""
    levels = [bunny_mesh.conformal_structure(faces, solver="paper") for faces in LEVELS]
    nearest = int(levels[0].surface.vertices[:, 2].argmax())  # the same vertex at all levels: there the squares agree
    maps = [(each.surface, each.uv(BUNNY_FORM)) for each in levels]
    pinned = [(level, uv - uv[np.argmax(level.corner_vertices == nearest)]) for level, uv in maps]
    write_picture("bunny", [drawn(*each, SQUARES["bunny"]) for each in pinned])
    found = holomorph.conformal_structure(hand_surface, solver="paper")
    forms = np.eye(found.form_count)
    write_picture("hand", [drawn(hand_surface, found.uv(form), SQUARES["hand"]) for form in forms])


def row(name, surface):
    """A row of the table: work by levels and from zero, in iterations on the surface, and how far forms are from the
    direct ones. Genus 0: they do not depend on the basis that is found."""
    paper = holomorph.conformal_structure(surface, solver="paper")
    zero = holomorph.conformal_structure(surface, solver="paper", thresholds=[])
    direct = holomorph.conformal_structure(surface, solver="direct")
    levels = paper.solver.levels
    work = sum(faces * iterations for faces, iterations, _ in levels) / levels[-1][0]
    forms, others = (np.concatenate([each.natural_forms, each.dirichlet_forms]) for each in (paper, direct))
    error = np.abs(forms - others).max() / np.abs(others).max()
    steps = ", ".join(f"{faces}: {iterations}" for faces, iterations, _ in levels)
    name = f"{name}, {surface.boundary_count} loops"
    return f"| {name} | {steps} | {work:.0f} | {zero.solver.iterations} | {error:.0e} |"


def print_table(surfaces):
    sys.stdout.write(
        "| surface | iterations on each level, by faces | work | from zero | forms |\n|---|---|---|---|---|\n"
    )
    for name, surface in surfaces.items():
        sys.stdout.write(row(name, surface) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("bunny", type=Path)
    parser.add_argument("hand", type=Path)
    parser.add_argument("--figures", action="store_true")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--meshes", type=Path, metavar="FOLDER")
    options = parser.parse_args()
    bunny_mesh, hand_surface = holomorph.ProgressiveMesh(bunny(options.bunny)), hand(options.hand)
    surfaces = {"bunny": bunny_mesh.level(FACES), "hand": hand_surface}
    if options.figures:
        draw(bunny_mesh, hand_surface)
    if options.table:
        print_table(surfaces)
    if options.meshes:
        for name, surface in surfaces.items():
            surface.write(options.meshes / f"{name}_60k.ply")


if __name__ == "__main__":
    main()
