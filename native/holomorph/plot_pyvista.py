"""The pictures of `holomorph.plot` by PyVista, to turn by hand, also of millions of triangles: `from holomorph import
plot_pyvista as plot`. Each function returns a `pyvista.Plotter`: its `show()` opens a window, or in a notebook shows
the picture there; `show(screenshot="picture.png")` writes it."""

import numpy as np
from numpy.typing import ArrayLike

from .core.array_types import Reals
from .drawing import (
    DECADES,
    DENSITY,
    PLAIN,
    SEEN_THROUGH,
    SQUARES,
    ZERO,
    checked_uv,
    density_decades,
    form_maps,
    require_positions,
    upright,
)
from .forms.form_structure import FormStructure
from .mesh.surface import Surface

try:
    import pyvista
except ModuleNotFoundError as error:
    if error.name != "pyvista":
        raise
    raise ModuleNotFoundError('these plots need the library PyVista: pip install "holomorph[pyvista]"') from error

SQUARE = 64  # pixels of a checker's square
DOT, TUBE = 0.015, 0.006  # radii of a zero and a loop, in diagonals of the surface's box
LOOPS = ("#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22", "#17becf")


def checker(surface: Surface, uv: ArrayLike, *, squares: float = 10.0, up: str = "Z") -> pyvista.Plotter:
    """A checker on the surface, with `squares` squares to the UV unit.

    uv : (#C, 2) of the surface's polygon corners; up : "Y" or "Z", the axis that is drawn upwards
    """
    plotter = pyvista.Plotter()
    _add_checker(plotter, surface, checked_uv(surface, uv), squares, up)
    return plotter


def density(surface: Surface, uv: ArrayLike, *, up: str = "Z") -> pyvista.Plotter:
    """The texture's density: UV area over area of each triangle, over the median, on a logarithmic scale. Arguments as
    of `checker`."""
    decades = density_decades(surface, checked_uv(surface, uv))
    plotter, mesh = pyvista.Plotter(), _mesh(surface, up)
    mesh.cell_data[DENSITY] = decades
    plotter.add_mesh(mesh, scalars=DENSITY, cmap="coolwarm", clim=(-DECADES, DECADES))
    return plotter


def forms(structure: FormStructure, *, squares: float = 10.0, up: str = "Z") -> pyvista.Plotter:
    """A checker of each form alone, side by side, of eight at most; they turn together. Each has the UV area 1.
    Arguments as of `checker`."""
    require_positions(structure.surface)
    maps = form_maps(structure)
    plotter = pyvista.Plotter(shape=(1, len(maps)), window_size=(400 * len(maps), 400))
    for number, uv in enumerate(maps):
        plotter.subplot(0, number)
        _add_checker(plotter, structure.surface, uv, squares, up)
        plotter.add_text(f"form {number + 1}", font_size=9)
    plotter.link_views()
    return plotter


def zeros(structure: FormStructure, coefficients: ArrayLike | None = None, *, up: str = "Z") -> pyvista.Plotter:
    """The zeros of a combination of forms, by default of the balanced one, with their orders, on the surface, which is
    seen through."""
    found = structure.zeros(structure.balanced_coefficients() if coefficients is None else coefficients)
    plotter, size = _seen_through(structure, up)
    points = upright(structure.surface.vertices[found.vertices], up)
    if len(points):
        dots = pyvista.PolyData(points).glyph(geom=pyvista.Sphere(radius=DOT * size), scale=False, orient=False)
        plotter.add_mesh(dots, color=ZERO)
        orders = [str(order) for order in found.orders.tolist()]
        plotter.add_point_labels(points, orders, text_color=ZERO, shape=None, show_points=False, always_visible=True)
    return plotter


def loops(structure: FormStructure, *, up: str = "Z") -> pyvista.Plotter:
    """The loops of the homology basis, each in a colour of its own, on the surface, which is seen through."""
    plotter, size = _seen_through(structure, up)
    for number, loop in enumerate(structure.homology_basis):
        points = upright(structure.surface.vertices[np.append(loop, loop[:1])], up)
        tube = pyvista.lines_from_points(points).tube(radius=TUBE * size)
        plotter.add_mesh(tube, color=LOOPS[number % len(LOOPS)], label=f"{number + 1}")
    if structure.homology_basis:
        plotter.add_legend(bcolor=None, face="rectangle")
    return plotter


def _mesh(surface, up):
    return pyvista.PolyData.from_regular_faces(upright(surface.vertices, up), surface.triangles)


def _add_checker(plotter, surface, uv, squares, up):
    """Adds the surface with a point for each corner, since the UVs jump, and the normals of the vertices."""
    normals = _mesh(surface, up).compute_normals(cell_normals=False, split_vertices=False, consistent_normals=False)
    points = upright(surface.vertices, up)[surface.triangles].reshape(-1, 3)
    mesh = pyvista.PolyData.from_regular_faces(points, np.arange(len(points)).reshape(-1, 3))
    mesh.active_texture_coordinates = uv[surface.triangle_corners].reshape(-1, 2) * squares / 2
    mesh.point_data.active_normals = normals.point_data["Normals"][surface.triangles.reshape(-1)]
    plotter.add_mesh(mesh, texture=_texture()).prop.interpolation = "Phong"


def _texture() -> pyvista.Texture:
    """Two by two squares, the first row on top."""
    place = np.arange(2 * SQUARE) // SQUARE
    colours: Reals = np.array(SQUARES)[(place[::-1, None] + place) % 2]
    texture = pyvista.Texture(np.round(255 * colours).astype(np.uint8))
    texture.repeat = texture.mipmap = texture.interpolate = True
    return texture


def _seen_through(structure, up):
    """A plotter with the surface, and the diagonal of its box."""
    surface = structure.surface
    require_positions(surface)
    plotter = pyvista.Plotter()
    plotter.add_mesh(_mesh(surface, up), color=PLAIN, opacity=SEEN_THROUGH)
    return plotter, float(np.linalg.norm(np.ptp(surface.vertices, axis=0)))
