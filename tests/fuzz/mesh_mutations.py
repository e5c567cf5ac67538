"""Mutations of small meshes: `vertices`, (#V, 3) reals, and `faces`, a list of lists. Each returns both, changed.

They make what meshes of artists, scanners and broken exporters have, and worse: coincident and nearly coincident
vertices, needles, flat parts, enormous and tiny coordinates, faces that are missing, twice there, or turned over.
"""

import numpy as np

EXTREMES = (float("nan"), float("inf"), 1e308, -1e308, 1e200, 1e154, 1e60, 1e20, 1e-20, 1e-80, 1e-200, 1e-320, 0.0)
WRONG_INDICES = (-1, 10**6, 2**31 - 1, 2**31, 2**40)


def vertex_onto_another(vertices, faces, random):
    """Exactly, or as near as rounding can tell."""
    near = random.choice((0.0, 0.0, 1e-320, 1e-160, 1e-20, 1e-16, 1e-12, 1e-8))
    one, other = (random.randrange(len(vertices)) for _ in range(2))
    vertices[one] = vertices[other] + near * np.array([random.uniform(-1, 1) for _ in range(3)])
    return vertices, faces


def face_onto_one_point(vertices, faces, random):
    face = [v for v in random.choice(faces) if 0 <= v < len(vertices)]
    vertices[face] = vertices[face[:1]]
    return vertices, faces


def face_onto_a_line(vertices, faces, random):
    """Its vertices in order between the first and the last."""
    face = [v for v in random.choice(faces) if 0 <= v < len(vertices)]
    steps = np.linspace(0, 1, len(face))[:, None]
    vertices[face] = vertices[face[:1]] * (1 - steps) + vertices[face[-1:]] * steps
    return vertices, faces


def coordinate_replaced(vertices, faces, random):
    vertices[random.randrange(len(vertices)), random.randrange(3)] = random.choice(EXTREMES)
    return vertices, faces


def all_scaled(vertices, faces, random):
    with np.errstate(over="ignore"):
        return vertices * 10.0 ** random.choice((-320, -160, -80, -30, -12, 12, 30, 80, 154, 200, 307)), faces


def one_axis_scaled(vertices, faces, random):
    vertices[:, random.randrange(3)] *= 10.0 ** random.choice((-30, -12, -8, -4, -2, 2, 4, 8, 12))
    return vertices, faces


def part_scaled(vertices, faces, random):
    """A few vertices towards or away from one of them."""
    some = [random.randrange(len(vertices)) for _ in range(random.randrange(2, 6))]
    factor = 10.0 ** random.choice((-16, -8, -4, -2, 2, 4, 8))
    vertices[some] = vertices[some[0]] + factor * (vertices[some] - vertices[some[0]])
    return vertices, faces


def moved_away(vertices, faces, random):
    """Far from the origin, where coordinates keep few digits."""
    return vertices + 10.0 ** random.choice((3, 6, 9, 12, 16)), faces


def shaken(vertices, faces, random):
    noise = np.random.default_rng(random.randrange(2**32)).normal(size=vertices.shape)
    return vertices + 10.0 ** random.uniform(-6, 1) * noise, faces


def face_deleted(vertices, faces, random):
    place = random.randrange(len(faces))
    return vertices, faces[:place] + faces[place + 1 :] if len(faces) > 1 else faces


def face_repeated(vertices, faces, random):
    return vertices, [*faces, list(random.choice(faces))]


def face_turned_over(vertices, faces, random):
    place = random.randrange(len(faces))
    return vertices, [*faces[:place], faces[place][::-1], *faces[place + 1 :]]


def face_added(vertices, faces, random):
    """Between any vertices, three to seven of them."""
    count = min(random.randrange(3, 8), len(vertices))
    return vertices, [*faces, random.sample(range(len(vertices)), count)]


def corner_replaced(vertices, faces, random):
    face = list(random.choice(faces))
    wrong = random.choice(WRONG_INDICES) if random.random() < 0.1 else random.randrange(len(vertices))
    place = faces.index(face)
    face[random.randrange(len(face))] = wrong
    return vertices, [*faces[:place], face, *faces[place + 1 :]]


def vertices_merged(vertices, faces, random):
    """Two vertices of a face become one, and faces lose what is left over: an edge collapse, mostly."""
    face = random.choice(faces)
    kept, lost = random.sample(face, 2)
    merged = [[kept if v == lost else v for v in face] for face in faces]
    shorter = [list(dict.fromkeys(face)) for face in merged]
    return vertices, [face for face in shorter if len(face) > 2] or faces


def vertex_split(vertices, faces, random):
    """One corner of a face gets a vertex of its own, at the same place: unwelded."""
    place = random.randrange(len(faces))
    face = list(faces[place])
    corner = random.randrange(len(face))
    if not 0 <= face[corner] < len(vertices):
        return vertices, faces
    vertices = np.concatenate([vertices, vertices[face[corner] : face[corner] + 1]])
    face[corner] = len(vertices) - 1
    return vertices, [*faces[:place], face, *faces[place + 1 :]]


def face_cut_to_a_fan(vertices, faces, random):
    """Around a new vertex, in its middle or on one of its corners."""
    place = random.randrange(len(faces))
    face = faces[place]
    corners = [v for v in face if 0 <= v < len(vertices)] or [0]
    apex = vertices[corners].mean(axis=0) if random.random() < 0.6 else vertices[random.choice(corners)]
    fan = [[a, b, len(vertices)] for a, b in zip(face, face[1:] + face[:1])]
    return np.concatenate([vertices, apex[None]]), [*faces[:place], *fan, *faces[place + 1 :]]


def face_cut_in_two(vertices, faces, random):
    place = random.randrange(len(faces))
    face = faces[place]
    if len(face) < 4:
        return vertices, faces
    middle = random.randrange(2, len(face) - 1)
    return vertices, [*faces[:place], face[: middle + 1], [face[0], *face[middle:]], *faces[place + 1 :]]


def vertex_isolated(vertices, faces, random):
    return np.concatenate([vertices, vertices[:1] + random.random()]), faces


def renumbered(vertices, faces, random):
    order = list(range(len(vertices)))
    random.shuffle(order)
    new = {old: place for place, old in enumerate(order)}
    faces = [[new.get(v, v) for v in face] for face in faces]
    random.shuffle(faces)
    return vertices[order], faces


SHAPES = (
    vertex_onto_another,
    vertex_onto_another,
    face_onto_one_point,
    face_onto_a_line,
    face_onto_a_line,
    coordinate_replaced,
    all_scaled,
    one_axis_scaled,
    part_scaled,
    moved_away,
    shaken,
    shaken,
)
FACES = (
    face_deleted,
    face_deleted,
    face_turned_over,
    vertices_merged,
    vertices_merged,
    face_cut_to_a_fan,
    face_cut_to_a_fan,
    face_cut_in_two,
    vertex_isolated,
    renumbered,
    face_repeated,
    face_added,
    corner_replaced,
    vertex_split,
)


def mutated(vertices, faces, random):
    """After a few mutations, mostly one or two of either kind."""
    vertices = np.array(vertices, dtype=float)
    while True:
        mutation = random.choice(SHAPES if random.random() < 0.55 else FACES)
        with np.errstate(all="ignore"):
            vertices, faces = mutation(vertices, faces, random)
        if random.random() < 0.45:
            return vertices, faces


def smaller(vertices, faces):
    """Candidates for a smaller mesh with the same defect: fewer faces, unused vertices dropped, rounder coordinates."""
    for count in sorted({len(faces) // 2, len(faces) // 4, 1} - {0}, reverse=True):
        for start in range(0, len(faces), count):
            if len(faces) > count:
                yield vertices, faces[:start] + faces[start + count :]
    used = sorted({v for face in faces for v in face if 0 <= v < len(vertices)})
    if len(used) < len(vertices):
        new = {old: place for place, old in enumerate(used)}
        yield vertices[used], [[new.get(v, v) for v in face] for face in faces]
    for digits in (0, 1, 3):
        if not np.array_equal(np.round(vertices, digits), vertices, equal_nan=True):
            yield np.round(vertices, digits), faces
