# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of docs/method: loops, one-forms, periods and their bounds. Each function draws one."""

import itertools

import holomorph
import numpy as np
import periods
from figure_surfaces import double_torus, square_ring, torus
from figure_views import (
    BLUE,
    GREEN,
    GREY,
    INK,
    LIGHT_BLUE,
    ORANGE,
    RED,
    View,
    bands,
    checker,
    loop_edges,
    on_triangles,
    panels,
    polygon_edges,
    rgb,
    save,
)
from matplotlib import pyplot as plt
from matplotlib.collections import LineCollection, PolyCollection


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


def digits():
    """Width of the bounds of X_0(11), 24 flat triangles, against unknowns."""
    series = periods.convergence(periods.dessins.modular_curve(11))
    figure, axes = plt.subplots(1, 2, figsize=(7.2, 2.9), sharey=True, gridspec_kw=dict(wspace=0.06))
    orders = (1, 2, 3, 4, 6, 8)
    colours = plt.get_cmap("viridis")(np.linspace(0, 0.85, len(orders)))
    for ax, ending, title in zip(axes, ("", ", layers"), ("refined evenly", "2 p layers at cone points"), strict=True):
        for p, colour in zip(orders, colours, strict=True):
            ax.loglog(*np.transpose(series[f"{p}{ending}"]), "o-", ms=3, lw=1.2, color=colour, label=f"p = {p}")
        ax.set_title(title, fontsize=9)
        ax.set_xlabel("unknowns")
    axes[0].set_ylabel("relative width of the bounds")
    axes[0].legend(fontsize=7, ncols=2, frameon=False, loc="lower left")
    save(figure, "digits", "svg")
