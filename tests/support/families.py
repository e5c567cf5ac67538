"""Meshes whose topology, and sometimes whose conformal structure, is known before anything is computed.

Each is a `Mesh`: polygons as arrays, with the genus and the number of boundary loops of every component.
"""

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Mesh:
    """Mixed polygons. `topology` has (genus, boundary loops) of each component, in the order of their first faces."""

    vertices: np.ndarray
    corners: np.ndarray
    offsets: np.ndarray
    topology: tuple = ()

    @property
    def genus(self):
        ((genus, _),) = self.topology
        return genus

    @property
    def boundary_count(self):
        ((_, boundaries),) = self.topology
        return boundaries

    @property
    def face_count(self):
        return len(self.offsets) - 1

    @property
    def faces(self):
        """One array per polygon: for the tests that need lists, not for large meshes."""
        return np.split(self.corners, self.offsets[1:-1])


@dataclass(frozen=True)
class FlatSurface:
    """Triangles and edge lengths: an intrinsic surface. Entry i of a row belongs to the side opposite corner i."""

    faces: np.ndarray
    edge_lengths: np.ndarray
    face_edges: np.ndarray
    genus: int


def uniform(vertices, faces, topology=()):
    """A mesh whose polygons all have the same number of corners: `faces` (#F, n)."""
    faces = np.asarray(faces, dtype=np.int64)
    return Mesh(np.asarray(vertices, dtype=float), faces.ravel(), np.arange(len(faces) + 1) * faces.shape[1], topology)


def polygons(vertices, faces, topology=()):
    """A mesh from a list of lists: for small ones."""
    sizes = [len(face) for face in faces]
    corners = np.array([vertex for face in faces for vertex in face], dtype=np.int64)
    return Mesh(np.asarray(vertices, dtype=float), corners, np.cumsum([0, *sizes]), topology)


# ---- tori ----------------------------------------------------------------------------------------


def grid_quads(n, m):
    """Quads (n m, 4) of the n x m grid closed up in both directions; vertex (i, j) has index i m + j."""
    i, j = np.divmod(np.arange(n * m), m)
    right, up = (i + 1) % n, (j + 1) % m
    return np.stack([i * m + j, right * m + j, right * m + up, i * m + up], axis=1)


def cut_quads(quads, alternate=False):
    """Two triangles per quad; `alternate` flips the diagonal of every other quad."""
    a, b, c, d = quads.T
    flipped = (np.arange(len(quads)) % 2 == 1) & alternate
    first = np.where(flipped[:, None], np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    second = np.where(flipped[:, None], np.stack([b, c, d], 1), np.stack([a, c, d], 1))
    return np.stack([first, second], axis=1).reshape(-1, 3)


def angles(n, m):
    """Parameters (2, n m) in [0, 2 pi) of the vertices of `grid_quads(n, m)`."""
    i, j = np.divmod(np.arange(n * m), m)
    return 2 * np.pi * i / n, 2 * np.pi * j / m


def torus_points(theta, phi, R=2.0, r=1.0):
    rho = R + r * np.cos(phi)
    return np.stack([rho * np.cos(theta), rho * np.sin(theta), r * np.sin(phi)], axis=-1)


def torus(n, m, R=2.0, r=1.0, shape="quads", jitter=0.0, seed=0):
    """A torus of revolution, tau = i r / sqrt(R^2 - r^2); `jitter` moves vertices on it, in units of a grid step."""
    noise = jitter * np.random.default_rng(seed).uniform(-1, 1, (2, n * m))
    theta, phi = angles(n, m)
    points = torus_points(theta + noise[0] * 2 * np.pi / n, phi + noise[1] * 2 * np.pi / m, R, r)
    quads = grid_quads(n, m)
    faces = {"quads": quads, "triangles": cut_quads(quads), "alternating": cut_quads(quads, alternate=True)}[shape]
    return uniform(points, faces, ((1, 0),))


def torus_knot(n, m, p=2, q=3, thickness=0.3):
    """A tube around the (p, q) torus knot; the frame is made of the tangent and the normal of the torus it winds on."""
    t = 2 * np.pi * np.arange(n) / n
    centre = torus_points(p * t, q * t, 2.0, 0.8)
    rate = 2 * np.pi / n
    tangent = (np.roll(centre, -1, axis=0) - np.roll(centre, 1, axis=0)) / (2 * rate)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    axis = np.stack([np.cos(p * t) * np.cos(q * t), np.sin(p * t) * np.cos(q * t), np.sin(q * t)], axis=1)
    side = np.cross(tangent, axis)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, tangent)
    phi = 2 * np.pi * np.arange(m) / m
    around = np.cos(phi)[None, :, None] * side[:, None] + np.sin(phi)[None, :, None] * up[:, None]
    return uniform((centre[:, None] + thickness * around).reshape(-1, 3), grid_quads(n, m), ((1, 0),))


def flat_torus(tau, n, jitter=0.0, seed=0):
    """The torus C / (Z + tau Z) as 2 n^2 triangles without positions. Its modulus is tau on every such mesh: linear
    functions are represented exactly. With n = 1 both triangles have the same vertex three times."""
    noise = jitter * np.random.default_rng(seed).uniform(-1, 1, (2, n, n)) / n
    i, j = np.indices((n, n))
    x, y = i / n + noise[0], j / n + noise[1]

    def vertex(di, dj):
        return ((i + di) % n) * n + (j + dj) % n

    def point(di, dj):
        wrapped = ((i + di) % n, (j + dj) % n)
        return x[wrapped] + (i + di) // n + tau * (y[wrapped] + (j + dj) // n)

    def edge(kind, di=0, dj=0):
        return kind * n * n + vertex(di, dj)

    along, across, diagonal = 0, 1, 2
    steps = [((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1))]
    edges = [(edge(across, 1, 0), edge(diagonal), edge(along)), (edge(along, 0, 1), edge(across), edge(diagonal))]
    faces, lengths = [], []
    for corners in steps:
        p = [point(*corner) for corner in corners]
        faces.append(np.stack([vertex(*corner) for corner in corners], axis=-1))
        lengths.append(np.stack([abs(p[2] - p[1]), abs(p[0] - p[2]), abs(p[1] - p[0])], axis=-1))
    sides = [np.stack(triple, axis=-1) for triple in edges]
    return FlatSurface(*(np.stack(part, axis=2).reshape(-1, 3) for part in (faces, lengths, sides)), genus=1)


def square_tiled(right, up, k):
    """Unit squares glued by two permutations, `right[s]` and `up[s]`, each cut into 2 k^2 triangles."""
    right, up = np.asarray(right), np.asarray(up)
    d = len(right)
    s, i, j = np.indices((d, k, k))

    def vertex_at(s, i, j):
        """Corners on the right and upper sides belong to the neighbours; the cone points remain to be identified."""
        s, i = np.where(i == k, right[s], s), np.where(i == k, 0, i)
        s, j = np.where(j == k, up[s], s), np.where(j == k, 0, j)
        return (s * k + i) * k + j

    # Around a cone point the ways right-up and up-right end in different squares: their corners are one vertex.
    glued = components(d * k * k, up[right] * k * k, right[up] * k * k)
    _, vertex_of = np.unique(glued, return_inverse=True)

    def vertex(di, dj):
        return vertex_of[vertex_at(s, i + di, j + dj)]

    def horizontal(dj):
        top = j + dj == k
        return (np.where(top, up[s], s) * k + i) * k + np.where(top, 0, j + dj)

    def vertical(di):
        end = i + di == k
        return d * k * k + (np.where(end, right[s], s) * k + np.where(end, 0, i + di)) * k + j

    diagonal = 2 * d * k * k + (s * k + i) * k + j
    faces = [[vertex(0, 0), vertex(1, 0), vertex(1, 1)], [vertex(0, 0), vertex(1, 1), vertex(0, 1)]]
    sides = [[vertical(1), diagonal, horizontal(0)], [horizontal(1), vertical(0), diagonal]]
    faces = np.stack([np.stack(triple, axis=-1) for triple in faces], axis=3).reshape(-1, 3)
    sides = np.stack([np.stack(triple, axis=-1) for triple in sides], axis=3).reshape(-1, 3)
    lengths = np.where(sides >= 2 * d * k * k, np.sqrt(2.0), 1.0) / k
    chi = len(np.unique(vertex_of)) - 3 * d * k * k + 2 * d * k * k
    return FlatSurface(faces, lengths, sides, genus=1 - chi // 2)


def without_triangle(flat, which):
    """One triangle taken out of a `FlatSurface`; its vertices must be three."""
    keep = np.arange(len(flat.faces)) != which
    return replace(flat, faces=flat.faces[keep], edge_lengths=flat.edge_lengths[keep], face_edges=flat.face_edges[keep])


# ---- any genus -----------------------------------------------------------------------------------


def voxel_surface(cells, topology=()):
    """The boundary of a set of unit cubes as quads, outwards: `cells` is a three-dimensional array of bool."""
    padded = np.pad(np.asarray(cells, dtype=bool), 1)
    shape = np.array(padded.shape) + 1
    quads = []
    for axis in range(3):
        across = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) @ across
        for side in (0, 1):
            neighbour = np.roll(padded, -1 if side else 1, axis=axis)
            first = np.argwhere(padded & ~neighbour) + side * np.eye(3, dtype=int)[axis]
            quad = first[:, None] + (square if side else square[::-1])
            quads.append(np.ravel_multi_index(tuple(np.moveaxis(quad, -1, 0)), shape))
    used, faces = np.unique(np.concatenate(quads), return_inverse=True)
    vertices = np.stack(np.unravel_index(used, shape), axis=1) - 1.0
    return uniform(vertices, faces.reshape(-1, 4), topology)


def block_with_holes(genus, refine=1, jitter=0.0, seed=0):
    """A slab with `genus` square holes through it, its cubes cut into refine^3; `jitter` in units of a cube's edge."""
    cells = np.ones((2 * genus + 1, 3, 1), dtype=bool)
    cells[1::2, 1] = False
    for axis in range(3):
        cells = np.repeat(cells, refine, axis=axis)
    mesh = voxel_surface(cells, ((genus, 0),))
    noise = jitter * np.random.default_rng(seed).uniform(-1, 1, mesh.vertices.shape)
    return replace(mesh, vertices=(mesh.vertices + noise) / refine)


def cage():
    """The edges of a cube as square beams: genus 5."""
    cells = np.zeros((5, 5, 5), dtype=bool)
    middle = (np.indices(cells.shape) % 4 != 0).sum(axis=0)
    cells[middle <= 1] = True
    return voxel_surface(cells, ((5, 0),))


def scaffold(n):
    """The edges of n^3 cubes as square beams: a graph of (n + 1)^3 nodes, so genus #beams - #nodes + 1."""
    cells = np.zeros((2 * n + 1,) * 3, dtype=bool)
    cells[(np.indices(cells.shape) % 2 != 0).sum(axis=0) <= 1] = True
    return voxel_surface(cells, ((3 * n * (n + 1) ** 2 - (n + 1) ** 3 + 1, 0),))


def square_ring(k):
    """A square frame of square beams, genus 1, of 16 polygons: four-sided, with each side cut into k edges, so that
    every polygon has 4 k corners, most of them on straight lines."""
    profile = np.array([[2.0, 0.0], [3.0, 0.0], [3.0, 1.0], [2.0, 1.0]])
    turns = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    coarse = np.array([[x * turn[0], x * turn[1], z] for turn in turns for x, z in profile])
    points, index, faces = [], {}, []
    for quad in grid_quads(4, 4):
        face = []
        for start, end in zip(quad, np.roll(quad, -1), strict=True):
            low, high = min(start, end), max(start, end)
            for step in range(k):
                along = step if start == low else k - step
                key = (low, high, along) if 0 < along < k else (start,)
                if key not in index:
                    index[key] = len(points)
                    points.append(coarse[low] + (coarse[high] - coarse[low]) * along / k)
                face.append(index[key])
        faces.append(face)
    return polygons(points, faces, ((1, 0),))


def washer(n):
    """A flat ring of square profile, genus 1, whose top and bottom are two C-shaped polygons of 2 n + 2 corners."""
    angle = np.pi * np.arange(2 * n) / n
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    layers = [np.column_stack([radius * circle, np.full(2 * n, z)]) for radius, z in ((1, 0), (2, 0), (2, 1), (1, 1))]
    inner0, outer0, outer1, inner1 = (np.arange(2 * n) + 2 * n * layer for layer in range(4))
    faces = []
    for half in (np.arange(n + 1), np.arange(n, 2 * n + 1) % (2 * n)):
        faces.append([*outer1[half], *inner1[half[::-1]]])
        faces.append([*inner0[half], *outer0[half[::-1]]])
    for low, high in ((outer0, outer1), (inner1, inner0)):
        faces += np.stack([low, np.roll(low, -1), np.roll(high, -1), high], axis=1).tolist()
    return polygons(np.concatenate(layers), faces, ((1, 0),))


# ---- spheres, boundaries, one-sided surfaces -----------------------------------------------------


def cube():
    return voxel_surface(np.ones((1, 1, 1)), ((0, 0),))


def tetrahedron():
    return uniform(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], ((0, 0),)
    )


def geodesic_sphere(n, jitter=0.0, seed=0):
    """The unit sphere as an icosahedron whose faces are cut into n^2: 10 n^2 + 2 vertices; `jitter` in edge lengths."""
    golden = (1 + 5**0.5) / 2
    corners = np.array(
        [np.roll([0, a, b * golden], shift) for shift in range(3) for a in (-1, 1) for b in (-1, 1)], dtype=float
    )
    distance = np.linalg.norm(corners[:, None] - corners, axis=2)
    near = np.isclose(distance, 2)
    a, b, c = (index for index in np.nonzero(near[:, :, None] & near[:, None] & near[None]))
    turn = np.einsum("ij,ij->i", np.cross(corners[b], corners[c]), corners[a])
    first = (a < b) & (a < c) & (turn > 0)
    i, j = (index[(np.add(*np.indices((n + 1, n + 1))) <= n)] for index in np.indices((n + 1, n + 1)))
    points, faces = [], []
    number = np.full((n + 2, n + 2), -1)
    number[i, j] = np.arange(len(i))
    up = np.stack([number[i, j], number[i + 1, j], number[i, j + 1]], axis=1)[i + j < n]
    down = np.stack([number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]], axis=1)[i + j < n - 1]
    for x, y, z in zip(corners[a[first]], corners[b[first]], corners[c[first]], strict=True):
        faces.append(np.concatenate([up, down]) + len(i) * len(points))
        points.append(x + np.outer(i, y - x) / n + np.outer(j, z - x) / n)
    points = np.concatenate(points)
    _, kept, index = np.unique(np.rint(points * 1e6).astype(int), axis=0, return_index=True, return_inverse=True)
    points = points[kept] / np.linalg.norm(points[kept], axis=1)[:, None]
    points += jitter * 1.1 / n * np.random.default_rng(seed).uniform(-1, 1, points.shape)
    points /= np.linalg.norm(points, axis=1)[:, None]
    return uniform(points, index.reshape(-1)[np.concatenate(faces)], ((0, 0),))


def spun(n, m, cap="n-gon"):
    """A sphere spun from a half circle, as by Blender's Spin: n coincident vertices at each pole, closed by an n-gon,
    or by a fan around one vertex more."""
    theta, phi = np.arange(m + 1) * np.pi / m, 2 * np.pi * np.arange(n) / n
    radius = np.where(np.arange(m + 1) % m > 0, np.sin(theta), 0.0)
    points = np.stack([np.outer(radius, np.cos(phi)), np.outer(radius, np.sin(phi)), np.outer(np.cos(theta), phi**0)])
    points = points.reshape(3, -1).T
    faces = [[i * n + j, (i + 1) * n + j, (i + 1) * n + k, i * n + k] for i in range(m) for j, k in _around(n)]
    if cap == "n-gon":
        return polygons(points, [*faces, list(range(n)), list(range(m * n, (m + 1) * n))[::-1]], ((0, 0),))
    top, bottom = len(points), len(points) + 1
    fans = [[j, k, top] for j, k in _around(n)] + [[m * n + k, m * n + j, bottom] for j, k in _around(n)]
    return polygons(np.concatenate([points, points[[0, -1]]]), faces + fans, ((0, 0),))


def _around(n):
    return [(j, (j + 1) % n) for j in range(n)]


def hexagonal_disk(n, jitter=0.0, seed=0):
    """The unit disk (#V, 2) in n rings around vertex 0: 3 n (n + 1) + 1 points and 6 n^2 triangles. Interior points are
    moved, `jitter` in units of a ring."""
    q, r = (index.ravel() - n for index in np.indices((2 * n + 1, 2 * n + 1)))
    ring = np.maximum(np.abs(q), np.maximum(np.abs(r), np.abs(q + r)))
    order = np.argsort(ring, kind="stable")[: 3 * n * (n + 1) + 1]
    number = np.full((2 * n + 2, 2 * n + 2), -1)
    number[q[order] + n, r[order] + n] = np.arange(len(order))
    q, r, ring = q[order] + n, r[order] + n, ring[order]
    up = np.stack([number[q, r], number[q + 1, r], number[q, r + 1]], axis=1)
    down = np.stack([number[q, r], number[q, r + 1], number[q - 1, r + 1]], axis=1)
    faces = np.concatenate([up, down])
    lattice = (q - n) + (r - n) * np.exp(1j * np.pi / 3)
    z = ring / n * np.exp(1j * np.angle(lattice))
    noise = np.random.default_rng(seed).uniform(-1, 1, (2, len(z)))
    z = np.where(ring < n, z + jitter / n * (noise[0] + 1j * noise[1]), z)
    return np.stack([z.real, z.imag], axis=1), faces[(faces >= 0).all(axis=1)]


def hemisphere(n, jitter=0.0, seed=0):
    """The upper half of the unit sphere, its boundary on the equator, its pole at vertex 0."""
    disk, faces = hexagonal_disk(n, jitter, seed)
    radius = np.linalg.norm(disk, axis=1)
    factor = np.where(radius > 0, np.sin(np.pi / 2 * radius) / np.maximum(radius, 1e-300), np.pi / 2)
    points = np.column_stack([disk * factor[:, None], np.cos(np.pi / 2 * radius)])
    return uniform(points, faces, ((0, 1),))


def saw_blade(n=24, rings=2, tip=1.5):
    """A flat disk of rings with a tooth at each edge of its boundary: all corners of a tooth lie on the boundary."""
    turn, following = 2 * np.pi * np.arange(n) / n, (np.arange(n) + 1) % n
    circle = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    teeth = tip / 2 * (circle + circle[following])
    points = [np.zeros((1, 3)), *(radius * circle for radius in np.arange(1, rings + 1) / rings), teeth]
    here = 1 + n * np.arange(rings + 1)[:, None] + np.arange(n)
    after = here[:, following]
    faces = [[0, a, b] for a, b in zip(here[0], after[0])]
    for k in range(rings - 1):
        faces += np.stack([here[k], here[k + 1], after[k + 1], after[k]], axis=1).tolist()
    faces += np.stack([here[-2], here[-1], after[-2]], axis=1).tolist()
    return polygons(np.concatenate(points), faces, ((0, 1),))


def cylinder(n, m):
    """A tube without ends: genus 0, two boundary loops."""
    theta, height = angles(n, m)
    points = np.stack([np.cos(theta), np.sin(theta), height], axis=1)
    quads = grid_quads(n, m).reshape(n, m, 4)[:, :-1].reshape(-1, 4)
    return uniform(points, quads, ((0, 2),))


def punctured_torus(n=12, m=9):
    """A torus with one face missing: genus 1, one boundary loop."""
    mesh = torus(n, m)
    return replace(mesh, corners=mesh.corners[4:], offsets=mesh.offsets[:-1], topology=((1, 1),))


def without_faces(mesh, faces, topology):
    """Some polygons taken out; vertices that no polygon is left at go too."""
    kept = np.setdiff1d(np.arange(mesh.face_count), faces)
    take, offsets = selected_corners(mesh, kept)
    used, corners = np.unique(mesh.corners[take], return_inverse=True)
    return Mesh(mesh.vertices[used], corners, offsets, topology)


def punched(mesh, count, seed=0):
    """`count` holes, each of one polygon and no two with a common vertex, in a closed mesh."""
    taken, holes = np.zeros(len(mesh.vertices), dtype=bool), []
    for face in np.random.default_rng(seed).permutation(mesh.face_count):
        corners = mesh.corners[mesh.offsets[face] : mesh.offsets[face + 1]]
        if len(holes) < count and not taken[corners].any():
            holes.append(face)
            taken[corners] = True
    assert len(holes) == count
    return without_faces(mesh, holes, ((mesh.genus, count),))


def chord_torus(n=12, m=10):
    """A torus with a hole in the shape of a U, so that a chord cuts off the quad inside the U: all its corners lie on
    one loop, and so do both ends of the chord. A second hole is one edge away, which is a chord between loops."""
    quads = [(3, 3), (4, 3), (5, 3), (3, 4), (5, 4), (7, 3)]
    return without_faces(torus(n, m, jitter=0.1), [i * m + j for i, j in quads], ((1, 2),))


def flat_cells(mask, scale, jitter=0.0, seed=0, topology=()):
    """The unit squares of a plane that `mask` selects, centred and scaled; inner vertices may move."""
    nx, ny = np.array(mask.shape) + 1
    i, j = np.nonzero(mask)
    faces = np.stack([i * ny + j, (i + 1) * ny + j, (i + 1) * ny + j + 1, i * ny + j + 1], axis=1)
    inner = np.bincount(faces.ravel(), minlength=nx * ny) == 4
    noise = jitter * np.random.default_rng(seed).uniform(-1, 1, (nx * ny, 2)) * inner[:, None]
    points = np.stack(np.divmod(np.arange(nx * ny), ny), axis=1) - np.array(mask.shape) / 2 + noise
    used, corners = np.unique(faces, return_inverse=True)
    vertices = np.column_stack([scale * points[used], np.zeros(len(used))])
    return uniform(vertices, corners.reshape(-1, 4), topology)


def square_minus_square(k, jitter=0.0):
    """{max |x| < 1} without {max |x| <= 1/2}, cut into squares of side 1 / (2 k)."""
    mask = np.ones((4 * k, 4 * k), dtype=bool)
    mask[k:-k, k:-k] = False
    return flat_cells(mask, 1 / (2 * k), jitter, topology=((0, 2),))


def ring_of_revolution(radius, height, n):
    """The profile (radius, height) revolved around the z axis in n steps: genus 0, two loops, normals outwards for a
    profile that rises."""
    m = len(radius)
    theta = 2 * np.pi * np.arange(n) / n
    points = np.stack(
        [np.outer(np.cos(theta), radius), np.outer(np.sin(theta), radius), np.outer(np.ones(n), height)], axis=-1
    )
    quads = grid_quads(n, m).reshape(n, m, 4)[:, :-1].reshape(-1, 4)
    return uniform(points.reshape(-1, 3), quads, ((0, 2),))


def cube_corner(k, jitter=0.0, seed=0):
    """The part k <= x + y + z <= 2 k of the three faces of a cube at a corner: a ring of three trapezoids, four of
    which make `square_minus_square`. Inner vertices of a face may move in it."""
    random, points, index, faces = np.random.default_rng(seed), [], {}, []

    def vertex(x, y, z):
        key = (x, y, z)
        if key not in index:
            index[key] = len(points)
            inner = sum(c > 0 for c in key) == 2 and k < sum(key) < 2 * k
            points.append(np.array(key) + inner * (np.array(key) > 0) * jitter * random.uniform(-1, 1, 3))
        return index[key]

    for axis in range(3):
        for i, j in np.argwhere(np.add.outer(np.arange(2 * k), np.arange(2 * k)) < 2 * k):
            low, right, up, high = (
                np.roll((a, b, 0), axis) for a, b in ((i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1))
            )
            if i + j >= k:
                faces.append([vertex(*low), vertex(*right), vertex(*up)])
            if k <= i + j + 1 and i + j + 2 <= 2 * k:
                faces.append([vertex(*right), vertex(*high), vertex(*up)])
    return uniform(np.array(points) / k, faces, ((0, 2),))


def moebius(n=16, m=3):
    """A strip closed with a half turn: one-sided."""
    i, j = np.divmod(np.arange(n * m), m)
    theta, width = 2 * np.pi * i / n, (j / (m - 1) - 0.5)
    rho = 2 + width * np.cos(theta / 2)
    points = np.stack([rho * np.cos(theta), rho * np.sin(theta), width * np.sin(theta / 2)], axis=1)
    row, col = np.divmod(np.arange(n * (m - 1)), m - 1)
    turned = row + 1 == n

    def vertex(d):
        return np.where(turned, m - 1 - (col + d), (row + 1) * m + col + d)

    return uniform(points, np.stack([row * m + col, vertex(0), vertex(1), row * m + col + 1], axis=1))


def klein_bottle(n=12, m=8):
    """A grid closed up with a reflection in one direction: closed and one-sided; the figure-8 form."""
    i, j = np.divmod(np.arange(n * m), m)
    turned = i + 1 == n
    right = np.where(turned, 0, i + 1)
    low, high = np.where(turned, (m - j) % m, j), np.where(turned, (m - j - 1) % m, (j + 1) % m)
    theta, phi = angles(n, m)
    rho = 2 + np.cos(theta / 2) * np.sin(phi) - np.sin(theta / 2) * np.sin(2 * phi)
    z = np.sin(theta / 2) * np.sin(phi) + np.cos(theta / 2) * np.sin(2 * phi)
    points = np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)
    return uniform(points, np.stack([i * m + j, right * m + low, right * m + high, i * m + (j + 1) % m], axis=1))


# ---- the same mesh in another guise --------------------------------------------------------------


def united(*meshes):
    """All meshes side by side as one, in order."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    corner_starts = np.cumsum([0, *(len(mesh.corners) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices + 10.0 * k for k, mesh in enumerate(meshes)]),
        np.concatenate([mesh.corners + start for mesh, start in zip(meshes, starts[:-1], strict=True)]),
        np.concatenate(
            [[0], *(mesh.offsets[1:] + start for mesh, start in zip(meshes, corner_starts[:-1], strict=True))]
        ),
        sum((mesh.topology for mesh in meshes), ()),
    )


def selected_corners(mesh, order):
    """Indices of the corners of the polygons in the given order, and the new offsets."""
    sizes = np.diff(mesh.offsets)[order]
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    return np.repeat(mesh.offsets[:-1][order] - offsets[:-1], sizes) + np.arange(offsets[-1]), offsets


def relabelled(mesh, seed=1):
    """Vertices and faces in random order, each face beginning at a random corner; of one component.
    Returns the mesh and the old index of each new vertex."""
    random = np.random.default_rng(seed)
    vertex_order, face_order = random.permutation(len(mesh.vertices)), random.permutation(mesh.face_count)
    new_index = np.empty_like(vertex_order)
    new_index[vertex_order] = np.arange(len(vertex_order))
    take, offsets = selected_corners(mesh, face_order)
    sizes = np.diff(offsets)
    turn = np.repeat(random.integers(0, sizes), sizes)
    start, size = np.repeat(offsets[:-1], sizes), np.repeat(sizes, sizes)
    take = take[start + (np.arange(len(take)) - start + turn) % size]
    return Mesh(mesh.vertices[vertex_order], new_index[mesh.corners[take]], offsets, mesh.topology), vertex_order


def reversed_faces(mesh, which):
    """The polygons selected by the mask `which` in reverse; each keeps its first corner."""
    sizes = np.diff(mesh.offsets)
    start, size = np.repeat(mesh.offsets[:-1], sizes), np.repeat(sizes, sizes)
    place = np.arange(len(mesh.corners)) - start
    place = np.where(np.repeat(which, sizes), (size - place) % size, place)
    return replace(mesh, corners=mesh.corners[start + place])


def partly_reversed(mesh, fraction=0.2, seed=5):
    """A random part of the polygons in reverse."""
    return reversed_faces(mesh, np.random.default_rng(seed).random(mesh.face_count) < fraction)


def triangles_of(mesh):
    """A mesh of quads cut into triangles."""
    return uniform(mesh.vertices, cut_quads(mesh.corners.reshape(-1, 4)), mesh.topology)


def mirrored(mesh):
    """The other orientation: every face reversed, nothing moved."""
    return reversed_faces(mesh, np.ones(mesh.face_count, dtype=bool))


def moved(mesh, scale=1.0, seed=3):
    """Scaled, rotated and translated."""
    rotation, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    rotation *= np.sign(np.linalg.det(rotation))
    return replace(mesh, vertices=scale * (mesh.vertices @ rotation.T + [0.3, -1.7, 0.9]))


def subdivided(mesh):
    """Every triangle cut into four at the midpoints of its edges; of a mesh of triangles."""
    faces = mesh.corners.reshape(-1, 3)
    n = len(mesh.vertices)
    ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    key, side = np.unique(ends[:, 0] * n + ends[:, 1], return_inverse=True)
    middle = n + side.reshape(-1, 3)
    a, b, c = faces.T
    ab, bc, ca = middle.T
    cut = np.stack([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]])
    points = np.concatenate([mesh.vertices, (mesh.vertices[key // n] + mesh.vertices[key % n]) / 2])
    return uniform(points, cut.transpose(2, 0, 1).reshape(-1, 3), mesh.topology)


# ---- connected components, used by the generators and by the independent counts ------------------


def components(n, a, b):
    """The smallest node of each node's component, in the graph of n nodes with edges a[k] - b[k]."""
    label = np.arange(n)
    a, b = np.ravel(a), np.ravel(b)
    while True:
        low, high = np.minimum(label[a], label[b]), np.maximum(label[a], label[b])
        if (low == high).all():
            return label
        np.minimum.at(label, high, low)
        while (label[label] != label).any():
            label = label[label]
