"""Pictures of maps and forms, by matplotlib: `from holomorph import plot`. Each function returns a figure, which a
notebook shows and `savefig` writes. Surfaces are drawn triangle by triangle: up to some 100,000 of them. PyVista draws
larger ones (docs/python/packages.md)."""

import io

import numpy as np
from numpy.typing import ArrayLike

from ._native import InvalidMesh
from .core.array_types import Reals
from .core.value import quoted
from .forms.form_structure import FormStructure
from .mesh.checks import checked_uv
from .mesh.surface import Surface

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

SQUARES = ((0.96, 0.94, 0.91), (0.84, 0.43, 0.20))  # the two colours of a checker
PLAIN = (0.75, 0.75, 0.78)
ZERO = (0.85, 0.05, 0.10)
DECADES = 1.0  # powers of 10 of the density, to each side of the median
DENSITY = "density over its median, powers of 10"
SEEN_THROUGH = 0.35  # opacity of a surface that shows what is on its other side
MOST_FORMS = 8  # that are drawn side by side
PIECES = 150_000  # triangles are cut into, for a checker, about
MOST_CUTS = 16  # into which a triangle's side is cut
LIGHT = np.array([0.4, -0.7, 0.6])
AMBIENT = 0.45  # the darkest shade
SIDE, SMALL_SIDE = 6.0, 4.0  # inches of a picture, and of one of several


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
    picture, (axes,) = _empty(1)
    _draw_checker(axes, surface, _checked_uv(surface, uv), squares, up)
    return picture


def density(surface: Surface, uv: ArrayLike, *, up: str = "Z") -> Picture:
    """The texture's density: UV area over area of each triangle, over the median, on a logarithmic scale. Arguments as
    of `checker`."""
    decades = _density_decades(surface, _checked_uv(surface, uv))
    scale = ScalarMappable(Normalize(-DECADES, DECADES), colormaps["coolwarm"])
    picture, (axes,) = _empty(1)
    _draw(axes, surface, surface.vertices[surface.triangles], scale.to_rgba(decades)[:, :3], up)
    picture.colorbar(scale, ax=axes, shrink=0.6, label=DENSITY)
    return picture


def forms(structure: FormStructure, *, squares: float = 10.0, up: str = "Z") -> Picture:
    """A checker of each form alone, side by side, of eight at most. Each has the UV area 1. Arguments as of
    `checker`."""
    _require_positions(structure.surface)
    maps = _form_maps(structure)
    picture, all_axes = _empty(len(maps))
    for number, (axes, uv) in enumerate(zip(all_axes, maps)):
        _draw_checker(axes, structure.surface, uv, squares, up)
        axes.set_title(f"form {number + 1}")
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


def _empty(count):
    """A picture, and the axes of `count` drawings in it."""
    picture = Picture(figsize=(SIDE, SIDE) if count == 1 else (count * SMALL_SIDE, SMALL_SIDE))
    return picture, [picture.add_subplot(1, count, n + 1, projection="3d", computed_zorder=False) for n in range(count)]


def _draw_checker(axes, surface, uv, squares, up):
    values = uv[surface.triangle_corners]
    weights = _cuts(int(np.clip(np.ceil(np.sqrt(PIECES / len(values))), 1, MOST_CUTS)))
    pieces = np.einsum("sij,tjk->tsik", weights, surface.vertices[surface.triangles]).reshape(-1, 3, 3)
    middles = np.einsum("sj,tjk->tsk", weights.mean(axis=1), values).reshape(-1, 2)
    colours = np.array(SQUARES)[np.floor(squares * middles).astype(int).sum(axis=1) % 2]
    _draw(axes, surface, pieces, colours, up)


def _cuts(count):
    """(count^2, 3, 3): barycentric coordinates of the corners of the pieces of a triangle."""
    i, j = (index.ravel() for index in np.indices((count, count)))
    here, above = i + j < count, i + j < count - 1
    upward = [(i[here] + a, j[here] + b) for a, b in ((0, 0), (1, 0), (0, 1))]
    downward = [(i[above] + a, j[above] + b) for a, b in ((1, 0), (1, 1), (0, 1))]
    x, y = np.concatenate([np.moveaxis(np.array(part), 0, 1) for part in (upward, downward)], axis=2)
    return np.stack([count - x - y, x, y], axis=-1).swapaxes(0, 1) / count


def _draw(axes, surface, polygons, colours, up, opacity=1.0):
    polygons = _upright(polygons, up)
    normals = np.cross(polygons[:, 1] - polygons[:, 0], polygons[:, 2] - polygons[:, 0])
    sizes = np.linalg.norm(normals, axis=1)
    lit = np.abs(normals @ LIGHT) / np.linalg.norm(LIGHT) / np.where(sizes > 0, sizes, 1.0)
    shaded = np.column_stack([colours * (AMBIENT + (1 - AMBIENT) * lit)[:, None], np.full(len(colours), opacity)])
    edges = shaded if opacity == 1 else "none"
    axes.add_collection3d(Poly3DCollection(polygons, facecolors=shaded, edgecolors=edges, linewidths=0.5, zorder=1))
    points = _upright(surface.vertices, up)
    low, high = points.min(axis=0), points.max(axis=0)
    pad = 1e-3 * (high - low).max()
    axes.set(**{f"{axis}lim": (a - pad, b + pad) for axis, a, b in zip("xyz", low, high)})
    axes.set_box_aspect(high - low + 2 * pad)
    axes.set_axis_off()


def _seen_through(structure, up):
    surface = structure.surface
    _require_positions(surface)
    picture, (axes,) = _empty(1)
    colours = np.tile(PLAIN, (len(surface.triangles), 1))
    _draw(axes, surface, surface.vertices[surface.triangles], colours, up, SEEN_THROUGH)
    return picture


def _checked_uv(surface: Surface, uv: ArrayLike) -> Reals:
    """The UVs as reals. @throws ValueError if they are not those of the surface, @throws InvalidMesh"""
    _require_positions(surface)
    return checked_uv(uv, surface, is_finite=True)


def _require_positions(surface: Surface) -> None:
    """@throws InvalidMesh"""
    if surface.vertices is None:
        raise InvalidMesh("an intrinsic surface, without positions, cannot be drawn")


def _upright(points: Reals, up: str) -> Reals:
    """(..., 3) points with the axis `up`, "Y" or "Z", as third one."""
    if up not in ("Y", "Z"):
        raise ValueError(f'up is {quoted(up)}; "Y" or "Z" is needed')
    return points if up == "Z" else points[..., [0, 2, 1]] * np.array([1, -1, 1])


def _density_decades(surface: Surface, uv: Reals) -> Reals:
    """(#T,) log10 of UV area over area of each triangle, over the median."""
    corners, values = surface.vertices[surface.triangles], uv[surface.triangle_corners]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    found = _doubled_areas(values) / np.where(area > 0, area, 1.0)
    tiny = np.finfo(float).tiny
    return np.log10(np.maximum(found, tiny)) - np.log10(max(np.median(found[area > 0]), tiny))


def _form_maps(structure: FormStructure) -> list[Reals]:
    """(#C, 2) of each form alone, of `MOST_FORMS` at most, scaled to the UV area 1."""
    units = np.eye(structure.form_count)[:MOST_FORMS]
    maps = [structure.uv(unit) for unit in units]
    corners = structure.surface.triangle_corners
    return [uv / np.sqrt(_doubled_areas(uv[corners]).sum() / 2) for uv in maps]


def _doubled_areas(triangles):
    a, b = np.moveaxis(triangles[:, 1:] - triangles[:, :1], 1, 0)
    return np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
