# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs by methods of other packages: xatlas's own islands; LSCM and SLIM of libigl on islands that are given, as
Blender's unwraps are. Where a package cannot be imported its methods are left out, with a sentence."""

import importlib

import numpy as np

STEPS = 10  # of SLIM, as Blender's Minimum Stretch takes
KEEPS_PLACES = 1e-6  # of the UVs: corners that are nearer are one


def known():
    """The methods that are there: uv(points, triangles, islands), of (#V, 3), (#T, 3) and UVs (#T, 3, 2) whose jumps
    are the seams; (#T, 3, 2)."""
    found = {}
    for package, methods in {"xatlas": {"xatlas": _xatlas}, "igl": {"igl LSCM": _lscm, "igl SLIM": _slim}}.items():
        try:
            importlib.import_module(package)
        except ImportError as error:
            print(f"without {', '.join(methods)}: the package {package} cannot be imported ({error})")
            continue
        found |= methods
    return found


def _xatlas(points, triangles, _islands):
    import xatlas

    atlas = xatlas.Atlas()
    atlas.add_mesh(points.astype(np.float32), triangles.astype(np.uint32))
    atlas.generate()
    _vertices, corners, uv = atlas.get_mesh(0)
    return (uv * [atlas.width, atlas.height])[corners]


def _lscm(points, triangles, islands):
    import igl

    def conformal(vertices, faces, _start):
        along = vertices[:, np.ptp(vertices, axis=0).argmax()]
        fixed = np.array([along.argmin(), along.argmax()]), np.array([[0.0, 0.0], [1.0, 0.0]])
        return igl.lscm(vertices, faces.astype(np.int64), *fixed)[0]

    return _by_islands(conformal, points, triangles, islands)


def _slim(points, triangles, islands):
    import igl

    none = np.zeros(0, np.int32), np.zeros((0, 2), order="F")

    def even(vertices, faces, start):
        mesh = np.asfortranarray(vertices), np.asfortranarray(faces, np.int32)
        energy = igl.MappingEnergyType.SYMMETRIC_DIRICHLET
        return igl.slim_solve(igl.slim_precompute(*mesh, np.asfortranarray(start), energy, *none, 0.0), STEPS)

    return _by_islands(even, points, triangles, islands)


def _by_islands(method, points, triangles, islands):
    """Each island flattened by itself, from its own UVs, all with the area that they have in space."""
    import igl

    corners = np.column_stack([triangles.ravel(), np.rint(islands.reshape(-1, 2) / KEEPS_PLACES)]).astype(np.int64)
    _, first, faces = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    vertices, start, faces = points[triangles.ravel()[first]], islands.reshape(-1, 2)[first], faces.reshape(-1, 3)
    has_area = _areas(vertices[faces]) > 0
    uv = np.zeros((*triangles.shape, 2))
    parts = np.full(len(faces), -1)
    parts[has_area] = igl.facet_components(faces[has_area])[1]
    for part in np.split(np.argsort(parts, kind="stable"), np.flatnonzero(np.diff(np.sort(parts))) + 1):
        if parts[part[0]] < 0:
            continue
        used, own = np.unique(faces[part], return_inverse=True)
        own = own.reshape(-1, 3)
        before = start[used] * (_areas(vertices[faces[part]]).sum() / _areas(start[faces[part]]).sum()) ** 0.5
        flat = method(vertices[used], own, before)[own]
        if np.isfinite(flat).all():  # else it stays without a map
            uv[part] = flat * (_areas(vertices[faces[part]]).sum() / _areas(flat).sum()) ** 0.5
    return uv


def _areas(corners):
    """(#T,) of triangles in the plane or in space."""
    (a, b) = np.moveaxis(corners[:, 1:] - corners[:, :1], 1, 0)
    return np.sqrt(np.maximum((a * a).sum(1) * (b * b).sum(1) - (a * b).sum(1) ** 2, 0)) / 2
