"""The double cover in Blender."""

import pytest
from scenes import (
    fills_the_square,
    mesh_object,
    run,
    stored_report,
    tube_arrays,
    uv,
)

FLOAT32 = 1e-6  # part of the UV size


def only_part(obj):
    (entry,) = stored_report(obj)["components"]
    return entry


def test_the_double_cover_gives_the_same_map():
    obj = mesh_object("Tube", *tube_arrays())
    run()
    natural, entry = uv(obj), only_part(obj)
    assert run(boundary="double_cover") == {"FINISHED"}
    assert only_part(obj)["modulus"] == pytest.approx(entry["modulus"], rel=1e-9)
    for values in (natural, uv(obj)):
        assert fills_the_square(values)
