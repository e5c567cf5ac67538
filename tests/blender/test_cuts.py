"""The artist's seams as the cut."""

import numpy as np
from scenes import (
    parts_of,
    run,
    stored_report,
    torus,
    uv,
)

FLOAT32 = 1e-6  # part of the UV size


def only_part(obj):
    (entry,) = stored_report(obj)["components"]
    return entry


def test_seams_that_make_a_disk_are_the_cut():
    around, across = 24, 12
    obj = torus(around=around, across=across)
    ends = np.array([e.vertices for e in obj.data.edges])
    row, column = np.divmod(ends, across)
    mine = (row == 0).all(axis=1) | (column == 0).all(axis=1)
    obj.data.edges.foreach_set("use_seam", mine)
    assert run(cut_at_seams=True) == {"FINISHED"}
    assert "not_followed" not in only_part(obj)
    assert only_part(obj)["seam_edges"] == np.count_nonzero(mine)
    values, corners = uv(obj), parts_of(obj)[0].corner_vertices
    low, high = np.full((len(obj.data.vertices), 2), np.inf), np.full((len(obj.data.vertices), 2), -np.inf)
    np.minimum.at(low, corners, values)
    np.maximum.at(high, corners, values)
    torn = np.flatnonzero((high - low).max(axis=1) > 1e-4)
    assert set(torn) == set(ends[mine].ravel())


def test_seams_that_leave_no_disk_are_told_and_left_out():
    obj = torus()
    obj.data.edges[0].use_seam = True
    assert run(cut_at_seams=True) == {"FINISHED"}
    assert "disk" in only_part(obj)["not_followed"]
