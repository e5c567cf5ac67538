# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of docs/method: the maps that are made of forms. Each function draws one."""

import holomorph
import matplotlib
import numpy as np
from figure_surfaces import bean, chain, disk_with_holes, double_torus, eccentric_ring, pretzel
from figure_views import (
    BLUE,
    GREY,
    INK,
    ORANGE,
    PlaneView,
    View,
    bands,
    checker,
    loop_edges,
    on_triangles,
    panels,
    polygon_edges,
    save,
)
from matplotlib import pyplot as plt


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
    structure = holomorph.log_map(surface)
    uv = on_triangles(surface, structure.uv([1]))
    star = np.isin(surface.corner_vertices, structure.poles)[surface.triangle_corners].any(1)
    view = View(surface, tilt=-30, turn=10, width=520)
    strip = PlaneView(uv[~star][..., ::-1] * [1, -1], 640)
    sphere = holomorph.Surface(structure.sphere_map()[:, [2, 0, 1]], surface.triangles)
    ball_view = View(sphere, tilt=-25, turn=50, width=420)
    number = 6
    figure, axes = panels([1.25, 1.5, 0.8], size=(7.6, 2.0), gap=0.06)
    view.show(axes[0], checker(view.at_pixels(uv), number))
    view.dots(axes[0], surface.vertices[structure.poles])
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
    save(figure, "levels")
