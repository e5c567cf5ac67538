"""Cases that are plain data, kept as JSON, and what can be left out of them."""

import json

import mesh_mutations
import numpy as np


def save(case, stem):
    path = stem.with_suffix(".json")
    path.write_text(json.dumps(case) + "\n")
    return path


def load(path):
    return json.loads(path.read_text())


def with_fewer_options(case):
    for name in case["options"]:
        yield case | {"options": {key: value for key, value in case["options"].items() if key != name}}


def with_fewer_actions(case):
    for name in case["actions"]:
        yield case | {"actions": [other for other in case["actions"] if other != name]}


def with_fewer_faces(case):
    for vertices, faces in mesh_mutations.smaller(np.array(case["vertices"], float).reshape(-1, 3), case["faces"]):
        yield case | {"vertices": vertices.tolist(), "faces": faces}
