# SPDX-License-Identifier: GPL-3.0-or-later
"""python docs/make_figures.py [NAME ...]: draws the figures of docs/method.md into docs/figures, all by default.

They need the package and matplotlib. The command for a fresh checkout is `scripts/figures [NAME ...]`: it builds the
package, makes build/venv/figures (make_venv of scripts/environment) and runs this script in it.

All surfaces are made here: grids, and isosurfaces of smooth unions of tori and balls. The same versions of NumPy and
matplotlib draw the same files again.
"""

import itertools
import sys
from pathlib import Path
from types import SimpleNamespace

import holomorph
import matplotlib
import numpy as np
from PIL import Image

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.collections import LineCollection, PolyCollection

FOLDER = Path(__file__).parent / "figures"
BLUE, ORANGE, GREEN, RED, INK = "#2b5f8f", "#d98324", "#4a8f5c", "#b5403c", "#2a2f36"
LIGHT_BLUE, LIGHT_ORANGE, PAPER, GREY = "#c3d9ec", "#f6dcbb", "#ffffff", "#a9b0b8"
SAMPLES = 3  # per pixel and direction
DPI = 200
plt.rcParams.update(
    {
        "font.family": "DejaVu Sans",
        "font.size": 8,
        "axes.edgecolor": INK,
        "axes.labelcolor": INK,
        "axes.linewidth": 0.7,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "xtick.color": INK,
        "ytick.color": INK,
        "mathtext.fontset": "dejavusans",
        "svg.hashsalt": "holomorph",
    }
)

# ---- surfaces --------------------------------------------------------------------------------------------------------


def surface_net(field, low, high, step):
    """Quads around {field < 0}: a vertex in each cell that the surface meets, a quad around each edge that it cuts."""
    axes = [np.arange(a, b + step, step) for a, b in zip(low, high, strict=True)]
    inside = field(np.stack(np.meshgrid(*axes, indexing="ij"), -1)) < 0
    number = -np.ones(np.array(inside.shape) - 1, np.int64)
    corners = [inside[tuple(slice(i, n - 1 + i) for i, n in zip(o, inside.shape))] for o in np.ndindex(2, 2, 2)]
    cells = np.argwhere(np.any(corners, axis=0) & ~np.all(corners, axis=0))
    number[tuple(cells.T)] = np.arange(len(cells))
    vertices = np.array(low) + step * (cells + 0.5)
    quads = []
    for axis in range(3):
        b, c = (axis + 1) % 3, (axis + 2) % 3
        first, second = (
            np.take(inside, range(inside.shape[axis] - 1), axis),
            np.take(inside, range(1, inside.shape[axis]), axis),
        )
        cut = np.argwhere(first != second)
        around = []
        for i, j in ((0, 0), (-1, 0), (-1, -1), (0, -1)):
            cell = cut.copy()
            cell[:, b] += i
            cell[:, c] += j
            around.append(number[tuple(cell.T)])
        quad = np.stack(around, -1)
        quads.append(np.where(first[tuple(cut.T)][:, None], quad, quad[:, ::-1]))
    quads = np.concatenate(quads)
    for _ in range(12):  # evenly along the surface, then onto it
        total, count = np.zeros_like(vertices), np.zeros(len(vertices))
        for side in range(4):
            a, b = quads[:, side], quads[:, (side + 1) % 4]
            np.add.at(total, a, vertices[b])
            np.add.at(count, a, 1)
            np.add.at(total, b, vertices[a])
            np.add.at(count, b, 1)
        vertices = (vertices + total / count[:, None]) / 2
        for _ in range(3):
            value, e = field(vertices), 1e-4
            slope = np.stack([(field(vertices + e * d) - field(vertices - e * d)) / (2 * e) for d in np.eye(3)], -1)
            vertices = vertices - (value / (slope**2).sum(-1))[:, None] * slope
    return holomorph.Surface(vertices, quads)


def union(parts, sharpness):
    """Smooth union of solids given by their distances."""
    return lambda p: -np.log(sum(np.exp(-sharpness * part(p)) for part in parts)) / sharpness


def ring(x, y, major, minor):
    return lambda p: np.hypot(np.hypot(p[..., 0] - x, p[..., 1] - y) - major, p[..., 2]) - minor


def ball(x, y, z, radius):
    return lambda p: np.linalg.norm(p - np.array([x, y, z]), axis=-1) - radius


def double_torus(step=0.075):
    field = union([ring(-0.95, 0, 0.75, 0.27), ring(0.8, 0, 0.6, 0.27)], 9)
    return surface_net(field, (-2.2, -1.3, -0.6), (1.9, 1.3, 0.6), step)


def pretzel(step=0.075):
    around = [(0.87 * np.cos(a), 0.87 * np.sin(a)) for a in np.pi / 2 + np.array([0, 2, 4]) * np.pi / 3]
    sizes = [(0.6, 0.27), (0.6, 0.22), (0.6, 0.22)]
    field = union([ring(x, y, *size) for (x, y), size in zip(around, sizes, strict=True)], 9)
    return surface_net(field, (-1.9, -1.6, -0.6), (1.9, 2.1, 0.6), step)


def chain(step=0.08):
    field = union([ring(-1.75, 0, 0.72, 0.26), ring(0, 0, 0.62, 0.26), ring(1.5, 0, 0.5, 0.24)], 9)
    return surface_net(field, (-3.02, -1.31, -0.617), (2.6, 1.3, 0.6), step)


def bean(step=0.07):
    balls = (-0.9, -0.2, 0, 0.55), (-0.25, 0.25, 0, 0.45), (0.5, 0.1, 0.1, 0.42), (1.05, -0.35, 0, 0.4)
    field = union([ball(*numbers) for numbers in balls], 5)
    return surface_net(field, (-2.03, -1.31, -1.017), (2, 1.3, 1), step)


def torus(m=56, n=28):
    """A torus whose section is an ellipse, which makes a turn on its way around: tau is not imaginary."""
    i, j = np.divmod(np.arange(m * n), n)
    a, b = 2 * np.pi * i / m, 2 * np.pi * j / n
    x, y = 0.5 * np.cos(b), 0.26 * np.sin(b)
    x, y = x * np.cos(a) - y * np.sin(a), x * np.sin(a) + y * np.cos(a)
    vertices = np.stack([(1.1 + x) * np.cos(a), (1.1 + x) * np.sin(a), y], -1)
    right, up = (i + 1) % m * n, (j + 1) % n
    return holomorph.Surface(vertices, np.stack([i * n + j, right + j, right + up, i * n + up], -1))


def square_ring(n):
    """[-1, 1]^2 without [-1/2, 1/2]^2, n even cells of each quarter side."""
    k = 4 * n
    number = -np.ones((k + 1, k + 1), np.int64)
    i, j = np.meshgrid(range(k + 1), range(k + 1), indexing="ij")
    used = (np.abs(i - 2 * n) >= n) | (np.abs(j - 2 * n) >= n)
    number[used] = np.arange(used.sum())
    points = np.stack([i[used], j[used], 0 * i[used]], -1) / (2 * n) - [1, 1, 0]
    cell = np.argwhere((np.abs(i[:-1, :-1] + 0.5 - 2 * n) > n) | (np.abs(j[:-1, :-1] + 0.5 - 2 * n) > n))
    a, b = cell.T
    quads = np.stack([number[a, b], number[a + 1, b], number[a + 1, b + 1], number[a, b + 1]], -1)
    return holomorph.Surface(points, quads)


def eccentric_ring(m=72, n=16):
    """Between the unit circle and a circle of radius 0.3 about 0.38, cells of about equal sides: the Moebius image of a
    round ring, moved along its circles so that the grid is not the answer."""
    i, j = np.divmod(np.arange(m * (n + 1)), n + 1)
    t = j / n
    angle = 2 * np.pi * (i + 0.8 * t) / m
    rim, hole = np.exp(1j * angle), 0.38 + 0.3 * np.exp(1j * angle)
    z = (1 - t) * rim + t * hole
    right = (i + 1) % m * (n + 1)
    keep = j < n
    quads = np.stack([i * (n + 1) + j, right + j, right + j + 1, i * (n + 1) + j + 1], -1)[keep]
    return holomorph.Surface(np.stack([z.real, z.imag, 0 * z.real], -1), quads)


HOLES = ((-0.42, 0.28, 0.24), (0.45, 0.3, 0.18), (0.08, -0.45, 0.27))


def disk_with_holes(step=0.05):
    """The unit disk without three disks: a triangular grid whose boundary vertices are moved onto the circles."""
    rows = int(1.3 / (step * 3**0.5 / 2))
    columns = int(1.3 / step)
    i, j = np.meshgrid(np.arange(-rows, rows + 1), np.arange(-columns, columns + 1), indexing="ij")
    points = np.stack([step * (j + 0.5 * (i % 2)), step * 3**0.5 / 2 * i], -1).reshape(-1, 2)

    def level(p):
        holes = [r - np.hypot(p[..., 0] - x, p[..., 1] - y) for x, y, r in HOLES]
        return np.max([np.hypot(p[..., 0], p[..., 1]) - 1, *holes], axis=0)

    width, triangles = 2 * columns + 1, []
    for a, b in itertools.product(range(2 * rows), range(2 * columns)):
        p = a * width + b
        odd = (a - rows) % 2
        if odd:
            triangles += [(p, p + 1, p + width + 1), (p, p + width + 1, p + width)]
        else:
            triangles += [(p, p + 1, p + width), (p + 1, p + width + 1, p + width)]
    triangles = np.array(triangles)
    triangles = triangles[(level(points)[triangles] < -0.3 * step).all(axis=1)]
    while True:  # no vertex with two runs of triangles
        edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        ends, count = np.unique(edges, axis=0, return_counts=True)
        on_rim = np.bincount(ends[count == 1].ravel(), minlength=len(points))
        lonely = (count[np.unique(edges, axis=0, return_inverse=True)[1].reshape(-1, 3)] == 1).sum(1) > 1
        bad = (on_rim[triangles] > 2).any(axis=1) | lonely
        if not bad.any():
            break
        triangles = triangles[~bad]
    rim = np.unique(ends[count == 1])
    for circle in ((0, 0, 1), *HOLES):  # each rim vertex onto its nearest circle
        middle = np.array(circle[:2])
        away = points[rim] - middle
        distance = np.abs(np.linalg.norm(away, axis=1) - circle[2])
        nearest = distance < 1.6 * step
        points[rim[nearest]] = middle + circle[2] * away[nearest] / np.linalg.norm(away[nearest], axis=1)[:, None]
    used, triangles = np.unique(triangles, return_inverse=True)
    points = points[used]
    free = ~np.isin(used, rim)
    triangles = triangles.reshape(-1, 3)
    for _ in range(20):  # even again
        total, count = np.zeros_like(points), np.zeros(len(points))
        for a, b in ((0, 1), (1, 2), (2, 0)):
            for s, t in ((a, b), (b, a)):
                np.add.at(total, triangles[:, s], points[triangles[:, t]])
                np.add.at(count, triangles[:, s], 1)
        points[free] = (total / count[:, None])[free]
    return holomorph.Surface(np.column_stack([points, np.zeros(len(points))]), triangles)


# ---- pictures of surfaces --------------------------------------------------------------------------------------------


def rgb(color):
    return np.array(matplotlib.colors.to_rgb(color))


class View:
    """A surface seen from afar, light from the upper left. `at_pixels` interpolates values at the corners of triangles;
    `show` draws colours made of them, `lines`, `edges` and `dots` what lies on the surface."""

    def __init__(self, surface, tilt=-35.0, turn=0.0, width=600, margin=0.03):
        a, b = np.radians(tilt), np.radians(turn)
        about_z = np.array([[np.cos(b), -np.sin(b), 0], [np.sin(b), np.cos(b), 0], [0, 0, 1]])
        about_x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
        self.surface, self.triangles = surface, surface.triangles
        self.camera = about_x @ about_z
        points = surface.vertices @ self.camera.T
        low, high = points[:, :2].min(0), points[:, :2].max(0)
        pad = margin * (high - low).max()
        self.low, span = low - pad, high - low + 2 * pad
        self.scale = width * SAMPLES / span[0]
        self.shape = int(np.ceil(span[1] * self.scale / SAMPLES)) * SAMPLES, width * SAMPLES
        self.flat = np.ptp(points[:, 2]) < 1e-9 and tilt == 0
        self.points = self.project(surface.vertices)
        self._rasterise()

    def project(self, vertices):
        """Column, row and height of points, in samples."""
        p = vertices @ self.camera.T
        x, y = (p[:, :2] - self.low).T * self.scale
        return np.stack([x, self.shape[0] - y, p[:, 2] * self.scale], -1)

    def _rasterise(self):
        corners = self.points[self.triangles]
        (ax, ay), (bx, by), (cx, cy) = corners[:, :, :2].transpose(1, 2, 0)
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        front = np.flatnonzero(area < -1e-9)
        low = np.floor(corners[..., :2].min(1)).astype(int)
        size = np.ceil(corners[..., :2].max(1)).astype(int) - low + 1
        best = np.full(self.shape[0] * self.shape[1], -np.inf)
        owner = np.full(best.size, -1)
        weights = np.zeros((best.size, 3))
        for part in np.array_split(front, max(1, len(front) // 2000)):
            count = size[part].prod(1)
            t = np.repeat(part, count)
            k = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
            x, y = low[t, 0] + k % size[t, 0], low[t, 1] + k // size[t, 0]
            px, py = x + 0.5, y + 0.5
            w1 = ((px - ax[t]) * (cy[t] - ay[t]) - (py - ay[t]) * (cx[t] - ax[t])) / area[t]
            w2 = ((bx[t] - ax[t]) * (py - ay[t]) - (by[t] - ay[t]) * (px - ax[t])) / area[t]
            hit = (w1 >= -1e-9) & (w2 >= -1e-9) & (w1 + w2 <= 1 + 1e-9)
            hit &= (x >= 0) & (x < self.shape[1]) & (y >= 0) & (y < self.shape[0])
            t, w = t[hit], np.stack([1 - w1 - w2, w1, w2], -1)[hit]
            pixel = y[hit] * self.shape[1] + x[hit]
            depth = (w * corners[t, :, 2]).sum(1)
            order = np.argsort(depth, kind="stable")
            order = order[depth[order] > best[pixel[order]]]
            best[pixel[order]], owner[pixel[order]], weights[pixel[order]] = depth[order], t[order], w[order]
        self.depth = best.reshape(self.shape)
        self.pixels = np.flatnonzero(owner >= 0)
        self.owner, self.weights = owner[self.pixels], weights[self.pixels]

    def at_pixels(self, corner_values):
        """Values (#T, 3, ...) at triangle corners, interpolated."""
        return np.einsum("pk,pk...->p...", self.weights, corner_values[self.owner])

    def image(self, colors):
        """(#pixels, 3) or one colour; shaded."""
        colors = np.broadcast_to(colors, (len(self.pixels), 3))
        if not self.flat:
            p = self.surface.vertices[self.triangles]
            normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
            at_vertex = np.zeros_like(self.surface.vertices)
            for corner in range(3):
                np.add.at(at_vertex, self.triangles[:, corner], normal)
            n = self.at_pixels(at_vertex[self.triangles] @ self.camera.T)
            n /= np.linalg.norm(n, axis=1)[:, None]
            light = np.clip(n @ np.array([-0.35, 0.5, 0.79]), 0, 1)
            colors = colors * (0.5 + 0.53 * light)[:, None].clip(0, 1)
        picture = np.ones((self.shape[0] * self.shape[1], 3))
        picture[self.pixels] = colors
        h, w = np.array(self.shape) // SAMPLES
        return picture.reshape(h, SAMPLES, w, SAMPLES, 3).mean((1, 3)).clip(0, 1)

    def show(self, axes, colors):
        image = self.image(colors)
        axes.imshow(image, interpolation="antialiased", extent=(0, image.shape[1], image.shape[0], 0))
        axes.set_axis_off()

    def lines(self, axes, ends, color, width=1.0, hidden=0.0):
        """Segments on the surface (#S, 2, 3); `hidden` is the opacity of what lies behind."""
        pieces = 6
        t = np.linspace(0, 1, pieces + 1)
        points = ends[:, :1] + t[None, :, None] * (ends[:, 1:] - ends[:, :1])
        p = self.project(points.reshape(-1, 3)).reshape(len(ends), pieces + 1, 3)
        visible = self.visible((p[:, 1:] + p[:, :-1]) / 2)
        segments = np.stack([p[:, :-1, :2], p[:, 1:, :2]], 2) / SAMPLES
        style = dict(color=color, capstyle="round", joinstyle="round")
        if hidden:
            axes.add_collection(LineCollection(segments[~visible], lw=0.6 * width, alpha=hidden, **style))
        axes.add_collection(LineCollection(segments[visible], lw=width, **style))

    def visible(self, points):
        """Whether projected points of the surface (..., 3) are seen, with some tolerance."""
        row = np.clip(points[..., 1].astype(int), 0, self.shape[0] - 1)
        column = np.clip(points[..., 0].astype(int), 0, self.shape[1] - 1)
        return points[..., 2] > self.depth[row, column] - 0.03 * self.shape[1]

    def edges(self, axes, edges, color, width=1.0, **options):
        self.lines(axes, self.surface.vertices[edges], color, width, **options)

    def dots(self, axes, points, size=28):
        p = self.project(points)
        p = p[self.visible(p), :2].T / SAMPLES
        axes.scatter(*p, s=size, c=RED, edgecolors="white", linewidths=1, zorder=5)


def on_triangles(surface, uv):
    return uv[surface.triangle_corners]


def bands(values, number, dark, light=PAPER):
    """Two colours in turn, `number` pairs to a unit."""
    odd = (np.floor(2 * number * values + 0.5) % 2)[:, None]
    return odd * rgb(dark) + (1 - odd) * rgb(light)


def checker(uv, number, dark=BLUE, light="#eef3f8"):
    odd = (np.floor(2 * number * uv).sum(-1) % 2)[:, None]
    return odd * rgb(dark) + (1 - odd) * rgb(light)


def polygon_edges(surface):
    """The edges of the input polygons, (#, 2)."""
    ends = []
    for first, last in itertools.pairwise(surface.face_offsets):
        corners = surface.corner_vertices[first:last]
        ends.append(np.stack([corners, np.roll(corners, -1)], -1))
    return np.unique(np.sort(np.concatenate(ends), axis=1), axis=0)


def loop_edges(loop):
    return np.stack([loop, np.roll(loop, -1)], -1)


def panels(widths, size=(7.2, 2.6), gap=0.03):
    return plt.subplots(1, len(widths), figsize=size, gridspec_kw=dict(width_ratios=widths, wspace=gap))


def save(figure, name, kind="png", colors=160):
    FOLDER.mkdir(exist_ok=True)
    path = FOLDER / f"{name}.{kind}"
    options = dict(bbox_inches="tight", pad_inches=0.04)
    if kind == "svg":
        figure.savefig(path, metadata={"Date": None}, **options)
    else:
        figure.savefig(path, dpi=DPI, metadata={"Software": None}, **options)
        image = Image.open(path).convert("RGB")
        image = image.quantize(colors, method=Image.Quantize.MEDIANCUT, kmeans=3, dither=Image.Dither.NONE)
        image.save(path, optimize=True)
    plt.close(figure)
    sys.stdout.write(f"{path.relative_to(FOLDER.parent)}  {path.stat().st_size // 1024} KB\n")


# ---- the figures -----------------------------------------------------------------------------------------------------


def cut_graph():
    surface = double_torus(0.09)
    structure = holomorph.conformal_structure(surface)
    view = View(surface, tilt=-38, turn=8)
    figure, axes = panels([1, 1])
    for ax in axes:
        view.show(ax, rgb("#f3f1ec"))
        view.edges(ax, polygon_edges(surface), GREY, 0.25)
    view.edges(axes[0], structure.edges[structure.seams], BLUE, 2, hidden=0.35)
    for loop, color in zip(structure.homology_basis, (BLUE, ORANGE, GREEN, RED), strict=True):
        view.edges(axes[1], loop_edges(loop), color, 2, hidden=0.35)
    save(figure, "cut_graph")


def edges_crossed(triangles, seams, beside, u, v):
    """The edges that a loop of faces crosses, one of them of the cut graph: (u, v)."""
    seen = {beside[v, u]: None}
    queue = list(seen)
    for t in queue:
        a, b, c = triangles[t].tolist()
        for p, q in ((a, b), (b, c), (c, a)):
            other = beside[q, p]
            if (min(p, q), max(p, q)) not in seams and other not in seen:
                seen[other] = (t, p, q)
                queue.append(other)
    crossed, t = [(u, v)], beside[u, v]
    while seen[t] is not None:
        t, p, q = seen[t]
        crossed.append((p, q))
    return crossed


def dual_loop(surface, structure):
    """The class of the longest loop of faces that crosses one edge of the cut graph: eta of pairs of vertices."""
    triangles, seams = surface.triangles, {tuple(e) for e in structure.edges[structure.seams].tolist()}
    beside = {}
    for t, (a, b, c) in enumerate(triangles.tolist()):
        for u, v in ((a, b), (b, c), (c, a)):
            beside[u, v] = t
    best = max((edges_crossed(triangles, seams, beside, u, v) for u, v in sorted(seams)), key=len)
    eta = {}
    for p, q in best:
        eta[p, q], eta[q, p] = eta.get((p, q), 0) + 1, eta.get((q, p), 0) - 1
    return eta


def harmonic():
    surface = double_torus(0.09)
    structure = holomorph.conformal_structure(surface)
    eta = dual_loop(surface, structure)
    t = surface.triangles
    first, second = (np.array([eta.get((a, b), 0) for a, b in t[:, side].tolist()], float) for side in ([0, 1], [1, 2]))
    before = np.stack([0 * first, first, first + second], -1)
    periods = [sum(eta.get(tuple(e), 0) for e in loop_edges(loop).tolist()) for loop in structure.homology_basis]
    after = on_triangles(surface, structure.uv_of(periods, np.zeros(len(periods))))[..., 0]
    view = View(surface, tilt=-38, turn=8)
    figure, axes = panels([1, 1])
    for ax, values in zip(axes, (before, after), strict=True):
        view.show(ax, bands(view.at_pixels(values) + 0.01, 8, BLUE, "#eef3f8"))
    view.edges(axes[0], polygon_edges(surface), GREY, 0.25)
    save(figure, "harmonic")


def conjugate():
    surface = double_torus(0.06)
    structure = holomorph.conformal_structure(surface)
    uv = on_triangles(surface, structure.uv(structure.balanced_coefficients()))
    view = View(surface, tilt=-38, turn=8, width=700)
    at = view.at_pixels(uv)
    figure, axes = panels([1, 1, 1], size=(7.6, 1.6))
    view.show(axes[0], bands(at[:, 0], 12, BLUE, "#eef3f8"))
    view.show(axes[1], bands(at[:, 1], 12, ORANGE, "#fbf3e8"))
    view.show(axes[2], checker(at, 12, INK, "#f2f2f0"))
    for ax in axes:
        view.edges(ax, structure.edges[structure.seams], RED, 1.0)
    save(figure, "conjugate")


def lattice():
    surface = torus()
    structure = holomorph.conformal_structure(surface)
    tau = structure.period_matrix[0, 0]
    uv = on_triangles(surface, structure.uv([1]))
    view = View(surface, tilt=-48, turn=20, width=560)
    figure, axes = panels([1.1, 1], size=(7.2, 2.8), gap=0.08)
    view.show(axes[0], rgb("#f3f1ec"))
    view.edges(axes[0], polygon_edges(surface), GREY, 0.3)
    view.edges(axes[0], structure.edges[structure.seams], BLUE, 2.2, hidden=0.35)
    ax = axes[1]
    corners = surface.corner_vertices
    at = structure.uv([1])
    sides = []  # sides of polygons on the seams, in the plane
    seams = {tuple(e) for e in structure.edges[structure.seams].tolist()}
    for first, last in itertools.pairwise(surface.face_offsets):
        ring_of = list(range(first, last))
        for c, d in zip(ring_of, ring_of[1:] + ring_of[:1], strict=True):
            if tuple(sorted((int(corners[c]), int(corners[d])))) in seams:
                sides.append([at[c], at[d]])
    sides = np.array(sides)
    polygons = [at[[*range(first, last), first]] for first, last in itertools.pairwise(surface.face_offsets)]
    for i, j in itertools.product((-1, 0, 1), repeat=2):
        move = i + j * tau
        shift, face, line, width = np.array([move.real, move.imag]), "#f6f5f2", GREY, 0.8
        if (i, j) == (0, 0):
            face, line, width = LIGHT_BLUE, BLUE, 1.8
            ax.add_collection(LineCollection(polygons, colors="#8fb0cd", linewidths=0.3, zorder=1.5))
        ax.add_collection(PolyCollection(uv + shift, facecolors=face, edgecolors="none", antialiased=False))
        ax.add_collection(LineCollection(sides + shift, colors=line, linewidths=width, zorder=width + 2))
    middle = uv.reshape(-1, 2).mean(0)
    for end, name in ((1, "1"), (tau, r"$\tau$")):
        end = np.array([np.real(end), np.imag(end)])
        ax.annotate("", middle + end, middle, arrowprops=dict(arrowstyle="-|>", color=ORANGE, lw=1.4), zorder=5)
        ax.text(*(middle + end * 1.04 + [0.03, 0.03]), name, color=ORANGE, fontsize=10, zorder=5)
    span = np.ptp(uv.reshape(-1, 2), axis=0)
    ax.set_xlim(middle[0] - 1.15 * max(span[0], 1), middle[0] + 1.15 * max(span[0], 1))
    ax.set_ylim(middle[1] - 0.9 * span[1], middle[1] + 1.15 * span[1])
    ax.set_aspect("equal")
    ax.set_axis_off()
    save(figure, "lattice")


def bounds():
    exact = 10.234092569368052  # by elliptic integrals
    rows = []
    for n in (2, 4, 8, 16, 32):
        ring_structure = holomorph.conformal_structure(square_ring(n))
        low, high = (float(b[0, 0]) for b in ring_structure.capacity_bounds)
        rows.append((1 / (2 * n), low, float(ring_structure.capacity_matrix[0, 0]), high))
    h, low, middle, high = np.array(rows).T
    figure, axes = plt.subplots(1, 2, figsize=(7.2, 2.4), gridspec_kw=dict(width_ratios=[1.25, 1], wspace=0.28))
    ax, x = axes[0], np.arange(len(h))
    ax.axhline(exact, color=INK, lw=0.8, ls=(0, (4, 3)))
    ax.bar(x, high - low, 0.34, low, color=LIGHT_BLUE, edgecolor=BLUE, linewidth=0.8)
    ax.plot(x, middle, "o", color=ORANGE, ms=4.5, zorder=3)
    ax.set_xticks(x, [f"1/{round(1 / s)}" for s in h])
    ax.set_xlabel("edge length h")
    ax.set_ylabel("capacity")
    ax.set_ylim(low.min() - 0.08, high.max() + 0.08)
    ax.text(x[-1] + 0.42, exact + 0.02, "exact", ha="right", va="bottom", color=INK)
    ax = axes[1]
    ax.loglog(h, high - low, "s-", color=BLUE, ms=4, lw=1.2)
    ax.loglog(h, np.abs(middle - exact), "o-", color=ORANGE, ms=4, lw=1.2)
    ax.loglog(h, 1.7 * (high - low)[0] * (h / h[0]) ** (4 / 3), color=GREY, lw=0.9, ls=(0, (4, 3)))
    ax.text(h[2], 2.1 * (high - low)[0] * (h[2] / h[0]) ** (4 / 3), r"$h^{4/3}$", color=INK, ha="right", va="bottom")
    ax.text(h[1], 0.55 * (high - low)[1], "width", color=BLUE, ha="left", va="top")
    ax.text(h[1], 0.5 * np.abs(middle - exact)[1], "error of the\nprojected value", color=ORANGE, ha="left", va="top")
    ax.set_xticks(h, [f"1/{round(1 / s)}" for s in h])
    ax.minorticks_off()
    ax.set_xlabel("edge length h")
    save(figure, "bounds", "svg")


class PlaneView(View):
    """Triangles (#T, 3, 2) of a UV map in the plane."""

    def __init__(self, triangles, width):
        corners = triangles.reshape(-1, 2)
        plane = SimpleNamespace(
            vertices=np.column_stack([corners, np.zeros(len(corners))]),
            triangles=np.arange(len(corners)).reshape(-1, 3),
        )
        super().__init__(plane, tilt=0.0, width=width)


def annulus():
    surface = eccentric_ring()
    structure = holomorph.conformal_structure(surface)
    uv = on_triangles(surface, structure.uv([1]))
    uv = uv - uv.reshape(-1, 2).min(0)
    number = 10
    left = View(surface, tilt=0, width=560)
    right = PlaneView(uv, 900)
    figure, axes = panels([1, 2.4], size=(7.4, 2.4), gap=0.06)
    for ax, view in ((axes[0], left), (axes[1], right)):
        view.show(ax, checker(view.at_pixels(uv), number))
    seams = structure.edges[structure.seams]
    for loop in structure.boundary_loops:
        left.edges(axes[0], loop_edges(loop), INK, 0.8)
    left.edges(axes[0], seams, ORANGE, 1.8)
    sides = []
    marked = {tuple(e) for e in seams.tolist()}
    for t, triangle in enumerate(surface.triangles.tolist()):
        for i in range(3):
            if tuple(sorted((triangle[i], triangle[(i + 1) % 3]))) in marked:
                sides.append(np.column_stack([uv[t, [i, (i + 1) % 3]], [0, 0]]))
    right.lines(axes[1], np.array(sides), ORANGE, 1.8)
    save(figure, "annulus")


def holes():
    surface = disk_with_holes()
    structure = holomorph.conformal_structure(surface)
    theta = on_triangles(surface, structure.uv([1, 1, 1]))
    view = View(surface, tilt=0, width=480)
    at = view.at_pixels(theta)
    figure, axes = panels([1, 1, 1], size=(7.4, 2.5))
    view.show(axes[0], bands(at[:, 0], 8, BLUE, "#eef3f8"))
    view.show(axes[1], bands(at[:, 1], 8, ORANGE, "#fbf3e8"))
    view.show(axes[2], checker(at, 8, INK, "#f2f2f0"))
    for ax in axes:
        for loop in structure.boundary_loops:
            view.edges(ax, loop_edges(loop), INK, 0.8)
    save(figure, "holes")


def log_map():
    surface = bean()
    structure = holomorph.conformal_structure(surface)
    uv = on_triangles(surface, structure.uv([1]))
    star = np.isin(surface.corner_vertices, structure.punctures)[surface.triangle_corners].any(1)
    view = View(surface, tilt=-30, turn=10, width=520)
    strip = PlaneView(uv[~star][..., ::-1] * [1, -1], 640)
    sphere = holomorph.Surface(structure.sphere_map()[:, [2, 0, 1]], surface.triangles)
    ball_view = View(sphere, tilt=-25, turn=50, width=420)
    number = 6
    figure, axes = panels([1.25, 1.5, 0.8], size=(7.6, 2.0), gap=0.06)
    view.show(axes[0], checker(view.at_pixels(uv), number))
    view.dots(axes[0], surface.vertices[structure.punctures])
    strip.show(axes[1], checker(strip.at_pixels(uv[~star]), number))
    ball_view.show(axes[2], checker(ball_view.at_pixels(uv), number))
    save(figure, "log_map")


def zeros(surface, uv):
    """(#, 4) places and orders of the zeros: index (sum of the signed angles)/2 pi - 1 of each vertex, and 1 for each
    flipped triangle; what touches is one zero."""
    t = surface.triangles
    z = uv[..., 0] + 1j * uv[..., 1]
    angles = np.stack([np.angle((z[:, (i + 2) % 3] - z[:, i]) / (z[:, (i + 1) % 3] - z[:, i])) for i in range(3)], -1)
    index = np.rint(np.bincount(t.ravel(), angles.ravel(), len(surface.vertices)) / (2 * np.pi) - 1)
    flipped = np.flatnonzero(angles.sum(1) < 0)
    assert index.sum() + len(flipped) == 2 * surface.genus - 2
    group = np.arange(len(index))
    for triangle in t[flipped]:
        group[np.isin(group, group[triangle])] = group[triangle].min()
    order = np.bincount(group, index, len(index)) + np.bincount(group[t[flipped, 0]], minlength=len(index))
    return np.column_stack([surface.vertices[order != 0], order[order != 0]])


def zeros_and_seams():
    surface = pretzel(0.05)
    structure = holomorph.conformal_structure(surface)
    uv = on_triangles(surface, structure.uv(structure.balanced_coefficients()))
    view = View(surface, tilt=-30, turn=0, width=760)
    back = View(holomorph.Surface(surface.vertices * [-1, 1, -1], surface.triangles), tilt=-30, width=760)
    figure, axes = panels([1, 1], size=(7.4, 3.1))
    found = zeros(surface, uv)
    for ax, eye, sign in ((axes[0], view, [1, 1, 1]), (axes[1], back, [-1, 1, -1])):
        eye.show(ax, checker(eye.at_pixels(uv), 12))
        eye.edges(ax, structure.edges[structure.seams], ORANGE, 1.8)
        eye.dots(ax, found[:, :3] * sign)
    save(figure, "zeros")


def balance():
    surface = chain(0.07)
    structure = holomorph.conformal_structure(surface)
    view = View(surface, tilt=-38, width=640)
    limit = 2  # powers of ten
    stops = ["#b8651a", "#f0c38f", "#f7f5f0", "#9dbfdd", "#1d4a75"]
    colors = matplotlib.colors.LinearSegmentedColormap.from_list("density", stops)
    spaces = dict(width_ratios=[1, 1, 0.02], wspace=0.04, hspace=0.02)
    figure, grid = plt.subplots(2, 3, figsize=(7.6, 2.9), gridspec_kw=spaces)
    p = surface.vertices[surface.triangles]
    areas = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) / 2
    first = np.eye(3)[0] / np.sqrt(structure.period_matrix[0, 0].imag)  # of area 1 too
    for (top, bottom), c in zip(grid.T, (first, structure.balanced_coefficients()), strict=False):
        uv = structure.uv(c)
        quality = structure.quality(uv)
        view.show(top, checker(view.at_pixels(on_triangles(surface, uv)), 12))
        total, weight = np.zeros((2, len(surface.vertices)))
        for corner in range(3):
            np.add.at(total, surface.triangles[:, corner], areas * quality.area)
            np.add.at(weight, surface.triangles[:, corner], areas)
        mean = np.average(quality.area, weights=areas)
        level = np.log10(np.maximum(total / weight / mean, 0.1**limit))
        view.show(bottom, colors((view.at_pixels(level[surface.triangles]) / limit + 1) / 2)[:, :3])
    grid[0, 2].set_axis_off()
    scale = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(-limit, limit), colors)
    bar = figure.colorbar(scale, cax=grid[1, 2], ticks=[-limit, 0, limit])
    bar.ax.set_yticklabels(["1/100", "mean", "100"])
    bar.outline.set_linewidth(0.5)
    save(figure, "balance")


def jumps(surface, uv):
    """Edges of a triangle mesh across which its UVs (#T, 3, 2) jump."""
    seen, found = {}, []
    for t, triangle in enumerate(surface.triangles.tolist()):
        for i in range(3):
            j = (i + 1) % 3
            a, b = triangle[i], triangle[j]
            if (b, a) in seen and np.abs(seen[b, a] - uv[t, [j, i]]).max() > 1e-6:
                found.append((a, b))
            seen[a, b] = uv[t, [i, j]]
    return np.array(found)


def levels():
    surface = double_torus(0.05)
    structure = holomorph.conformal_structure(surface)
    uv = structure.uv(structure.balanced_coefficients())
    mesh = holomorph.ProgressiveMesh(surface)
    shown = [(surface, uv)] + [(m.surface, m.uv) for m in mesh.levels_of_detail(uv, [2400, 600, 150], harmonic=True)]
    figure, grid = plt.subplots(2, 2, figsize=(7.2, 3.7), gridspec_kw=dict(wspace=0.03, hspace=0.03))
    for ax, (level, at) in zip(grid.flat, shown, strict=True):
        view = View(level, tilt=-38, turn=8, width=600)
        at = on_triangles(level, at)
        view.show(ax, checker(view.at_pixels(at), 10))
        if level is not surface:
            view.edges(ax, polygon_edges(level), GREY, 0.4)
        view.edges(ax, jumps(level, at), ORANGE, 1.3)
    save(figure, "levels", colors=64)


FIGURES = dict(
    cut_graph=cut_graph, harmonic=harmonic, conjugate=conjugate, bounds=bounds, annulus=annulus, holes=holes,
    log_map=log_map, lattice=lattice, zeros=zeros_and_seams, balance=balance, levels=levels,
)  # fmt: skip

if __name__ == "__main__":
    for name in sys.argv[1:] or FIGURES:
        FIGURES[name]()
