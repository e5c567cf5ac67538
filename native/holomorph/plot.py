"""Pictures of maps and forms, by matplotlib: `from holomorph import plot`. Each function returns a figure, which a
notebook shows and `savefig` writes. Surfaces are drawn triangle by triangle: up to some 100,000 of them."""

import io

import numpy as np
from numpy.typing import ArrayLike

from . import arrays
from ._native import InvalidMesh
from .array_types import Reals
from .form_structure import FormStructure
from .surface import Surface

try:
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
except ModuleNotFoundError as error:
    if error.name != "matplotlib":
        raise
    raise ModuleNotFoundError('plots need the library matplotlib: pip install "holomorph[plot]"') from error

PIECES = 60_000  # triangles are cut into, for a checker
MOST_CUTS = 16  # of a triangle's side
SQUARES = ((0.96, 0.94, 0.91), (0.84, 0.43, 0.20))  # the two colours of a checker
PLAIN = (0.75, 0.75, 0.78)
ZERO = (0.85, 0.05, 0.10)
LIGHT = np.array([0.4, -0.7, 0.6])
AMBIENT = 0.45  # the darkest shade
DECADES = 1.0  # of the density, to each side of the median
SEEN_THROUGH = 0.35  # opacity of a surface that shows what is on its other side


class Picture(Figure):
    """A figure that notebooks show, whatever their backend is."""

    def _repr_png_(self) -> bytes:
        stream = io.BytesIO()
        self.savefig(stream, format="png")
        return stream.getvalue()


def checker(surface: Surface, uv: ArrayLike, *, squares: float = 10.0, up: str = "Z") -> Picture:
    """A checker on the surface, with `squares` squares to the UV unit.

    uv : (#C, 2) of the surface's polygon corners; up : "Y" or "Z", the axis that is drawn upwards. Cost: seconds
    """
    values = _checked(surface, uv)[surface.triangle_corners]
    weights = _cuts(int(np.clip(np.sqrt(PIECES / len(values)), 1, MOST_CUTS)))
    pieces = np.einsum("sij,tjk->tsik", weights, surface.vertices[surface.triangles]).reshape(-1, 3, 3)
    middles = np.einsum("sj,tjk->tsk", weights.mean(axis=1), values).reshape(-1, 2)
    colours = np.array(SQUARES)[np.floor(squares * middles).astype(int).sum(axis=1) % 2]
    return _drawn(surface, pieces, colours, up)


def density(surface: Surface, uv: ArrayLike, *, up: str = "Z") -> Picture:
    """The texture's density: UV area over area of each triangle, over the median, on a logarithmic scale. Arguments as
    of `checker`."""
    corners = surface.vertices[surface.triangles]
    values = _checked(surface, uv)[surface.triangle_corners]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    a, b = np.moveaxis(values[:, 1:] - values[:, :1], 1, 0)
    found = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / np.where(area > 0, area, 1.0)
    tiny = np.finfo(float).tiny
    decades = np.log10(np.maximum(found, tiny)) - np.log10(max(np.median(found[area > 0]), tiny))
    scale = ScalarMappable(Normalize(-DECADES, DECADES), colormaps["coolwarm"])
    picture = _drawn(surface, corners, scale.to_rgba(decades)[:, :3], up)
    picture.colorbar(scale, ax=picture.axes[0], shrink=0.6, label="density over its median, powers of 10")
    return picture


def zeros(structure: FormStructure, coefficients: ArrayLike | None = None, *, up: str = "Z") -> Picture:
    """The zeros of a combination of forms, by default of the balanced one, on the surface, which is seen through."""
    found = structure.zeros(structure.balanced_coefficients() if coefficients is None else coefficients)
    picture = _seen_through(structure, up)
    points = _upright(structure.surface.vertices[found.vertices], up)
    picture.axes[0].scatter(*points.T, color=ZERO, s=60, depthshade=False, zorder=3)
    for point, order in zip(points.tolist(), found.orders.tolist()):
        picture.axes[0].text(*point, f"  {order}", color=ZERO, zorder=4)
    return picture


def loops(structure: FormStructure, *, up: str = "Z") -> Picture:
    """The loops of the homology basis, each in a colour of its own, on the surface, which is seen through."""
    picture = _seen_through(structure, up)
    for number, loop in enumerate(structure.homology_basis):
        points = _upright(structure.surface.vertices[np.append(loop, loop[:1])], up)
        picture.axes[0].plot(*points.T, color=f"C{number % 10}", linewidth=2.5, zorder=3, label=f"{number + 1}")
    if structure.homology_basis:
        picture.axes[0].legend(loc="upper right")
    return picture


def _checked(surface: Surface, uv: ArrayLike) -> Reals:
    _require_positions(surface)
    uv = arrays.numbers(uv, "uv")
    if uv.shape != (len(surface.corner_vertices), 2) or not np.isfinite(uv).all():
        raise ValueError(f"uv has the shape {uv.shape}; ({len(surface.corner_vertices)}, 2) finite numbers are needed")
    return uv


def _require_positions(surface):
    if surface.vertices is None:
        raise InvalidMesh("an intrinsic surface, without positions, cannot be drawn")


def _cuts(count):
    """(count^2, 3, 3): barycentric coordinates of the corners of the pieces of a triangle."""
    i, j = (index.ravel() for index in np.indices((count, count)))
    here, above = i + j < count, i + j < count - 1
    upward = [(i[here] + a, j[here] + b) for a, b in ((0, 0), (1, 0), (0, 1))]
    downward = [(i[above] + a, j[above] + b) for a, b in ((1, 0), (1, 1), (0, 1))]
    x, y = np.concatenate([np.moveaxis(np.array(part), 0, 1) for part in (upward, downward)], axis=2)
    return np.stack([count - x - y, x, y], axis=-1).swapaxes(0, 1) / count


def _upright(points, up):
    if up not in ("Y", "Z"):
        raise ValueError(f'up is {up!r}; "Y" or "Z" is needed')
    return points if up == "Z" else points[..., [0, 2, 1]] * np.array([1, -1, 1])


def _drawn(surface, polygons, colours, up, opacity=1.0):
    polygons = _upright(polygons, up)
    normals = np.cross(polygons[:, 1] - polygons[:, 0], polygons[:, 2] - polygons[:, 0])
    sizes = np.linalg.norm(normals, axis=1)
    lit = np.abs(normals @ LIGHT) / np.linalg.norm(LIGHT) / np.where(sizes > 0, sizes, 1.0)
    shaded = np.column_stack([colours * (AMBIENT + (1 - AMBIENT) * lit)[:, None], np.full(len(colours), opacity)])
    picture = Picture(figsize=(6, 6))
    axes = picture.add_subplot(projection="3d", computed_zorder=False)
    edges = shaded if opacity == 1 else "none"
    axes.add_collection3d(Poly3DCollection(polygons, facecolors=shaded, edgecolors=edges, linewidths=0.5, zorder=1))
    points = _upright(surface.vertices, up)
    low, high = points.min(axis=0), points.max(axis=0)
    pad = 1e-3 * (high - low).max()
    axes.set(**{f"{axis}lim": (a - pad, b + pad) for axis, a, b in zip("xyz", low, high)})
    axes.set_box_aspect(high - low + 2 * pad)
    axes.set_axis_off()
    return picture


def _seen_through(structure, up):
    surface = structure.surface
    _require_positions(surface)
    colours = np.tile(PLAIN, (len(surface.triangles), 1))
    return _drawn(surface, surface.vertices[surface.triangles], colours, up, SEEN_THROUGH)
