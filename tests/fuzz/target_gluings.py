"""Intrinsic surfaces: triangles of given edge lengths glued along named edges, without positions, exact and mutated.

The torus C / (Z + tau Z) keeps its modulus tau however its vertices move in the plane, as long as no triangle is turned
over; a surface of squares is closed, of a genus that its vertices tell.
"""

import actions
import equivalence
import families
import numpy as np
import oracle
import plain_cases
from holomorph import Surface, conformal_structure
from target_pipeline import solver_options

LENGTHS = (0.0, -1.0, float("nan"), float("inf"), 1e308, 1e154, 1e20, 1e-20, 1e-160, 1e-320)


def make(random):
    flat, tau = _flat(random)
    faces, lengths, names = (array.astype(kind) for array, kind in zip(
        (flat.faces, flat.edge_lengths, flat.face_edges), (int, float, int)))  # fmt: skip
    while random.random() < 0.7:
        tau = None
        _mutate(faces, lengths, names, random)
    case = {"faces": faces.tolist(), "lengths": lengths.tolist(), "names": names.tolist()}
    if random.random() < 0.1:
        case["names"] = None
    tau = None if case["names"] is None or tau is None else [tau.real, tau.imag]
    return case | {"options": solver_options(random), "tau": tau, **actions.chosen(random, len(faces))}


def _flat(random):
    """A flat surface, and its modulus where it is a torus."""
    seed, jitter = random.randrange(2**31), random.choice((0.0, 0.1, 0.3))
    if random.random() < 0.6:
        tau = complex(random.uniform(-0.5, 0.5), 10 ** random.uniform(-0.5, 1.5))
        return families.flat_torus(tau, random.randrange(1, 5), jitter=jitter / 2, seed=seed), tau
    count = random.randrange(1, 5)
    right, up = (random.sample(range(count), count) for _ in range(2))
    flat = families.square_tiled(right, up, random.randrange(1, 4))
    if random.random() < 0.3 and len(flat.faces) > 2:
        flat = families.without_triangle(flat, random.randrange(len(flat.faces)))
    return flat, None


def _mutate(faces, lengths, names, random):
    """Changes one entry, in place; a length on both sides of its edge, mostly."""
    place = random.randrange(len(faces)), random.randrange(3)
    kind = random.randrange(6)
    if kind == 0:
        faces[place] = random.choice((-1, 0, random.randrange(len(faces)), 2**31))
    elif kind == 1:
        names[place] = random.choice((-1, 0, random.randrange(2 * len(faces)), 2**31))
    elif kind == 2:
        lengths[place] *= random.choice((1 + 1e-15, 0.5, 2.0))
    else:
        new = random.choice(LENGTHS) if kind == 3 else lengths[place] * 10 ** random.uniform(-1, 1)
        lengths[names == names[place]] = new


def execute(case):
    surface = Surface.from_edge_lengths(case["faces"], case["lengths"], case["names"])
    oracle.check_surface(surface)
    for part in surface.components[:3]:
        structure = conformal_structure(part, **case["options"])
        oracle.check_invariants(structure)
        if case["tau"] is not None:
            check_modulus(structure, complex(*case["tau"]))
        for name in case["actions"]:
            oracle.answer(actions.ACTIONS[name], structure, case["tiling"])


def check_modulus(structure, tau):
    """The modulus is exact on flat tori: linear functions are represented exactly, and the bounds meet."""
    computed = structure.period_matrix
    distance = equivalence.distance(computed, np.array([[tau]]))
    assert distance < 1e-6 * max(1, abs(tau)), f"tau is {computed[0, 0]}, not {tau}"
    if structure.period_bounds is not None:
        oracle.check_contains("period_bounds", *(float(b[0, 0]) for b in structure.period_bounds), computed.imag[0, 0])


save, load = plain_cases.save, plain_cases.load


def smaller(case):
    """Options, actions and triangles left out."""
    yield from plain_cases.with_fewer_options(case)
    yield from plain_cases.with_fewer_actions(case)
    if case["tau"] is None:
        for k in range(len(case["faces"])):
            kept = {name: case[name] and case[name][:k] + case[name][k + 1 :] for name in ("faces", "lengths", "names")}
            yield case | kept
