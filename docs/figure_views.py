# SPDX-License-Identifier: GPL-3.0-or-later
"""How surfaces and maps are drawn in the figures, and how figures are written."""

import itertools
import sys
from pathlib import Path
from types import SimpleNamespace

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.collections import LineCollection

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


def save(figure, name, kind="webp"):
    FOLDER.mkdir(exist_ok=True)
    path = FOLDER / f"{name}.{kind}"
    options = (
        {"metadata": {"Date": None}} if kind == "svg" else {"dpi": DPI, "pil_kwargs": {"quality": 90, "method": 6}}
    )
    figure.savefig(path, bbox_inches="tight", pad_inches=0.04, **options)
    plt.close(figure)
    sys.stdout.write(f"{path.relative_to(FOLDER.parent)}  {path.stat().st_size // 1024} KB\n")


class PlaneView(View):
    """Triangles (#T, 3, 2) of a UV map in the plane."""

    def __init__(self, triangles, width):
        corners = triangles.reshape(-1, 2)
        plane = SimpleNamespace(
            vertices=np.column_stack([corners, np.zeros(len(corners))]),
            triangles=np.arange(len(corners)).reshape(-1, 3),
        )
        super().__init__(plane, tilt=0.0, width=width)
