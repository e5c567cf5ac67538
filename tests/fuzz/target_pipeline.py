"""Mutated meshes through the whole library, with options drawn at random, a few of them wrong.

A case is plain data, which JSON keeps: vertices, faces, options of `conformal_structure`, names of `actions`,
options of their tilings, and the exact modulus of a surface that is flat.
"""

import actions
import exact_meshes
import mesh_mutations
import numpy as np
import oracle
import plain_cases
from holomorph import (
    Surface,
    automatic_structure,
    conformal_structure,
    cut_along,
    disk_map,
    log_map,
    rectangle_map,
)
from starts import STARTS

PARTS = 3  # components of a mesh that are computed


def make(random):
    if random.random() < 0.25:
        return _exact(random)
    start = random.choice(STARTS)
    vertices, faces = mesh_mutations.mutated(start.vertices, [face.tolist() for face in start.faces], random)
    return _case(vertices, faces, options_for(faces, len(vertices), random), random)


def _exact(random):
    if random.random() < 0.5:
        vertices, faces, corners, modulus = exact_meshes.rectangle(random)
    else:
        (vertices, faces, modulus), corners = exact_meshes.tube(random), []
    vertices, faces, corners = exact_meshes.disguised(vertices, faces, corners, random)
    options = {"corners": corners} if corners else {}
    return _case(vertices, faces, options | solver_options(random), random, modulus)


def _case(vertices, faces, options, random, modulus=None):
    mesh = {"vertices": vertices.tolist(), "faces": faces, "strict": random.random() < 0.5}
    return mesh | {"options": options, "modulus": modulus, **actions.chosen(random, len(vertices))}


def solver_options(random):
    """Mostly none."""
    choices = {
        "solver": ("direct", "multigrid", "paper", "auto", "fastest", None),
        "threads": (1, 1, 2, 3, 0, 2**40, float("nan"), "two"),
        "memory_limit": (10**9, 10**5, 10**4, 1, 0, float("nan")),
    }
    drawn = {name: random.choice(values[:4] if random.random() < 0.9 else values) for name, values in choices.items()}
    return {"threads": 1} | {name: value for name, value in drawn.items() if random.random() < 0.25}


def options_for(faces, count, random):
    """Choices of vertices, on the faces more often than not, and of all else."""
    options = solver_options(random)
    some = [v for face in random.sample(faces, min(len(faces), 3)) for v in face]

    def vertices(length):
        return [
            random.choice(some) if random.random() < 0.7 else random.randrange(-1, count + 1) for _ in range(length)
        ]

    if random.random() < 0.25:
        options["poles"] = vertices(random.randrange(4))
    if random.random() < 0.1:
        numbers = (1.0, -1.0, 1.0, -1.0, 2.5, 0.0, 1e300, float("nan"))
        options["residues"] = [
            [random.choice(numbers), random.choice((0.0, 0.0, 1.0))] for _ in range(random.randrange(4))
        ]
    if random.random() < 0.1:
        options["corners"] = vertices(random.choice((4, 4, 4, 3, 5)))
    if random.random() < 0.1:
        options["cuts"] = [vertices(2) for _ in range(random.randrange(4))]
    if random.random() < 0.1:
        options["boundary"] = random.choice(("double_cover", "double_cover", "natural", "none"))
    return options


def execute(case):
    surface = Surface(np.array(case["vertices"], float).reshape(-1, 3), case["faces"], strict=case["strict"])
    oracle.check_surface(surface)
    options = dict(case["options"])
    if "residues" in options:
        options["residues"] = [complex(*pair) for pair in options["residues"]]
    parts = surface.components
    if len(parts) == 1:
        execute_part(surface, options, case)
    else:
        for part in parts[:PARTS]:
            oracle.answer(execute_part, part, options, case)


def structure_of(surface, *, poles=None, residues=None, corners=None, cuts=(), boundary=None, **options):
    """By the function that the options are for."""
    if corners is not None or poles is not None or residues is not None:
        options.pop("memory_limit", None)
    if corners is not None:
        made = rectangle_map(surface, corners, **options)
    elif poles is not None and len(poles) == 1 and residues is None and surface.boundary_count == 1:
        made = disk_map(surface, poles[0], **options)
    elif poles is not None or residues is not None:
        made = log_map(surface, poles, residues, **options)
    elif boundary is not None:
        made = conformal_structure(surface, boundary=boundary, **options)
    else:
        made = automatic_structure(surface, **options)
    return cut_along(made, cuts)


def execute_part(surface, options, case):
    structure = structure_of(surface, **options)
    oracle.check_invariants(structure)
    if case["modulus"] is not None and structure.modulus_bounds is not None:
        oracle.check_contains("modulus_bounds", *structure.modulus_bounds, case["modulus"])
    for name in case["actions"]:
        oracle.answer(actions.ACTIONS[name], structure, case["tiling"])


save, load = plain_cases.save, plain_cases.load


def smaller(case):
    """Options and actions left out, then faces."""
    yield from plain_cases.with_fewer_options(case)
    yield from plain_cases.with_fewer_actions(case)
    if case["modulus"] is None and not {"poles", "corners", "cuts"} & set(case["options"]):
        yield from plain_cases.with_fewer_faces(case)
