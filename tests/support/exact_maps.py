"""Errors of maps of the sphere and the hemisphere, whose exact maps are Moebius transformations."""

import families
import numpy as np
from holomorph import disk_map, log_map
from solved import surface_of

TAU = 2 * np.pi


def plane_of(points, origin, infinity):
    """Stereographic coordinate of the sphere with 0 at `origin` and infinity at `infinity`, as seen from outside."""
    axis = np.cross(infinity, np.eye(3)[np.argmin(np.abs(infinity))])
    frame = np.stack([np.cross(infinity, axis), axis]) / np.linalg.norm(axis)
    z = [(p @ frame.T) @ [1, 1j] / np.maximum(1 - p @ infinity, 1e-300) for p in (points, origin)]
    return z[0] - z[1]


def log_map_errors(n, seed=1):
    """Largest errors of u and v of the log map on a jittered sphere, away from the poles by the two-ring of the
    coarsest mesh: near them the error depends on the edges there relative to the distance, at any resolution."""
    mesh = families.geodesic_sphere(n, jitter=0.25, seed=seed)
    points = mesh.vertices
    p, q = (int(np.argmax(points @ direction)) for direction in ([0.3, 0.2, 0.9], [-0.8, 0.3, -0.4]))
    structure = log_map(surface_of(mesh), poles=[p, q])
    theta = structure.sphere_map()
    away = np.linalg.norm(points[:, None] - points[[p, q]], axis=2).min(axis=1) > 0.35
    theta = theta[away]  # the second pole, at infinity, is not among them
    computed = (theta @ [1, 1j, 0]) / (1 + theta[:, 2])  # stereographic, the first pole at 0
    ratio = np.log(computed / plane_of(points[away], points[p], points[q]))
    turn = np.angle(np.exp(1j * (ratio.imag - ratio.imag[0])))
    spread = [(x.max() - x.min()) / 2 / TAU for x in (turn, ratio.real)]  # a constant is free
    return np.array(spread)


def riemann_map_error(n, seed):
    """Largest distance from the stereographic projection, which takes the hemisphere to the unit disk, followed by the
    disk's automorphism that takes the centre to 0; a rotation is free. Off the centre: nearer to it than 0.3 the
    error depends on the edges there relative to the distance, and z is the distance: it falls like the step."""
    mesh = families.hemisphere(n, jitter=0.25, seed=seed)
    exact = (mesh.vertices @ [1, 1j, 0]) / (1 + mesh.vertices[:, 2])
    centre = int(np.argmin(np.abs(exact - (0.3 + 0.2j))))
    z = disk_map(surface_of(mesh), centre).disk_map()
    a = exact[centre]
    exact = (exact - a) / (1 - np.conj(a) * exact)
    rotation = np.vdot(z, exact)
    return np.abs(z * rotation / abs(rotation) - exact)[np.abs(exact) > 0.3].max()
