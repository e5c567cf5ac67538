"""Islands that are cut open where they would be stretched most."""

import numpy as np
from loaded_addon import module
from packed import assert_packed
from scenes import everything, mesh_object, run, select, stored_report


def finger_arrays(n=24):
    """A square sheet with a finger on it."""
    i, j = np.divmod(np.arange((n + 1) ** 2), n + 1)
    x, y = i / n, j / n
    height = 0.7 * np.exp(-((x - 0.5) ** 2 + (y - 0.6) ** 2) / 0.01)
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    faces = np.stack([first, first + n + 1, first + n + 2, first + 1], axis=1)
    return np.stack([x, y, height], axis=1), faces.tolist()


def main_range(obj):
    (part,) = stored_report(obj)["components"]
    return part["main_map"]["size_range"]


def test_the_map_becomes_even():
    obj = mesh_object("Finger", *finger_arrays())
    select(obj)
    run(main="ISLANDS", evenness=0)
    before = main_range(obj)
    assert run(main="ISLANDS", most_stretch=2.0, evenness=0) == {"FINISHED"}
    assert main_range(obj) < 2 and before > 3.2 * main_range(obj)
    assert_packed(obj)


def test_it_is_only_for_islands():
    obj = mesh_object("Finger", *finger_arrays())
    select(obj)
    run(main="BALANCED")
    before = everything(obj)
    run(main="BALANCED", most_stretch=2.0)
    assert everything(obj) == before


def test_the_cuts_become_seams():
    obj = mesh_object("Finger", *finger_arrays())
    select(obj)
    run(main="ISLANDS", most_stretch=2.0, seams=True)
    ends = module("scene.mesh_io").marked_edges(obj.data, "use_seam")
    tip = int(np.argmax(finger_arrays()[0][:, 2]))
    heights = np.array([v.co.z for v in obj.data.vertices])
    assert len(ends) > 5 and heights[np.unique(ends)].max() > 0.8 * heights[tip]
