"""Run by any platform's Python: map_meshes.py IN OUT maps the meshes of IN (.npz), and leaves every array in OUT."""

import sys

import holomorph
import numpy as np

POLES, TILES = 2, 60


def arrays_of(result):
    """The arrays among the fields of a result, by name."""
    fields = {name: getattr(result, name) for name in dir(result) if not name.startswith("_")}
    return {name: value for name, value in fields.items() if isinstance(value, np.ndarray) and value.dtype != object}


def mapped(points, faces):
    surface = holomorph.Surface(points, faces)
    structure = holomorph.automatic_structure(surface)
    found = {f"structure.{name}": value for name, value in arrays_of(structure).items()}
    uv = structure.uv(structure.balanced_coefficients())
    found["uv"] = uv
    found["angles"] = np.array([structure.quality(uv).mean_angle])
    for name, value in arrays_of(structure.tile(poles=POLES, tiles=TILES)).items():
        found[f"tiling.{name}"] = value
    return found


def main(source, target):
    meshes, found = np.load(source), {}
    for name in sorted({key.split(".")[0] for key in meshes}):
        for key, value in mapped(meshes[f"{name}.points"], meshes[f"{name}.faces"]).items():
            found[f"{name}.{key}"] = value
    np.savez(target, **found)


if __name__ == "__main__":
    main(*sys.argv[1:])
