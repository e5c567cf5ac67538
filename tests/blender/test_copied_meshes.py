"""What is written on a mesh leaves its copies alone, with which Blender shares arrays from 4.0 on."""

import numpy as np
import pytest
from loaded_addon import module
from scenes import grid_arrays, mesh_io, mesh_object

compatibility = module("compatibility")
MARKS = {
    "vertices": ("select", "hide"),
    "edges": ("select", "hide", "use_seam", "use_edge_sharp"),
    "polygons": ("select", "hide", "use_smooth"),
}
WRITTEN = {
    "UVs": lambda mesh: compatibility.uv_values(mesh.uv_layers["Own"]),
    "positions": compatibility.position_values,
    "materials": lambda mesh: compatibility.Values(mesh.polygons, "material_index", np.int32),
    "attribute": lambda mesh: compatibility.Values(mesh.attributes["Weight"].data, "value", np.float32),
} | {
    f"{elements} {mark}": lambda mesh, elements=elements, mark=mark: compatibility.Values(
        getattr(mesh, elements), mark, bool
    )
    for elements, marks in MARKS.items()
    for mark in marks
}


def other(values):
    """Different values of the same kind."""
    return ~values if values.dtype == bool else values + values.dtype.type(1)


@pytest.mark.parametrize("name", WRITTEN)
def test_copies_keep_their_values(name):
    mesh = mesh_object("Grid", *grid_arrays()).data
    compatibility.make_edges_selectable(mesh)
    mesh.uv_layers.new(name="Own")
    mesh.attributes.new("Weight", "FLOAT", "FACE")
    # What is stored in part only is stored whole, so that there is an array to be shared.
    first = mesh_io.read_values(WRITTEN[name](mesh))
    first[0] = other(first)[0]
    mesh_io.write_values(WRITTEN[name](mesh), first)
    copy = mesh.copy()
    mesh_io.write_values(WRITTEN[name](mesh), other(first))
    assert np.array_equal(mesh_io.read_values(WRITTEN[name](mesh)), other(first))
    assert np.array_equal(mesh_io.read_values(WRITTEN[name](copy)), first)
