"""What each kind of surface gets in Blender: straight boundaries, rectangles, disks, poles; and choices that do not
fit."""

import json

import numpy as np
import pytest
from loaded_addon import module
from scenes import (
    boundary_corners,
    everything,
    mesh_object,
    parts_of,
    pick,
    run,
    select,
    sphere_arrays,
    stored_report,
    straightness,
    torus,
    torus_arrays,
    tube_arrays,
    two_parts,
    uv,
    written,
)

FLOAT32 = 1e-6  # part of the UV size


def torus_with_a_hole():
    vertices, faces = torus_arrays()
    return mesh_object("Holed", vertices, np.delete(faces, [5, 100], axis=0))


def poles():
    """The lowest and the highest vertex of the sphere."""
    heights = np.array(sphere_arrays()[0])[:, 2]
    return [int(heights.argmin()), int(heights.argmax())]


def only_part(obj):
    (entry,) = stored_report(obj)["components"]
    return entry


def test_the_ends_of_a_tube_are_straight_and_their_length_is_the_same():
    obj = mesh_object("Tube", *tube_arrays())
    assert run() == {"FINISHED"}
    values, (part,) = uv(obj), parts_of(obj)
    assert straightness(part, values) < FLOAT32
    ends = values[boundary_corners(part)]
    heights = np.unique(np.round(ends[..., 1], 6))
    assert len(heights) == 2
    lengths = [np.abs(np.diff(ends[np.isclose(ends[:, 0, 1], h, atol=1e-5), :, 0])).sum() for h in heights]
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-5)
    entry = only_part(obj)
    lower, upper = entry["modulus_bounds"]
    assert lower <= entry["modulus"] <= upper
    # Height over circumference, read off the map itself.
    assert np.ptp(heights) / lengths[0] == pytest.approx(entry["modulus"], rel=1e-4)


@pytest.mark.parametrize("name", ["Holomorphic", "Holomorphic 1", "Holomorphic 2", "Holomorphic 3"])
def test_all_maps_of_a_surface_with_handles_and_holes_have_straight_boundaries(name):
    obj = torus_with_a_hole()
    assert run() == {"FINISHED"}
    assert (only_part(obj)["genus"], only_part(obj)["boundary_count"], only_part(obj)["forms"]) == (1, 2, 3)
    (part,) = parts_of(obj)
    assert straightness(part, uv(obj, name)) < FLOAT32


def test_a_sphere_gets_two_poles_by_itself_or_those_that_are_picked():
    obj = mesh_object("Sphere", *sphere_arrays())
    assert run() == {"FINISHED"}
    assert len(only_part(obj)["poles"]) == 2
    pick(obj, poles())
    assert run() == {"FINISHED"}
    assert sorted(only_part(obj)["poles"]) == sorted(poles())
    assert "log map" in only_part(obj)["description"]


def test_a_sphere_that_was_spun_gets_uvs_at_every_corner():
    """Each pole is a ring of coincident vertices: beside a pole there are edges without length."""
    around, along = 16, 8
    theta, phi = np.arange(along + 1) * np.pi / along, 2 * np.pi * np.arange(around) / around
    radius = np.where(np.arange(along + 1) % along > 0, np.sin(theta), 0.0)[:, None]
    vertices = np.stack(np.broadcast_arrays(radius * np.cos(phi), radius * np.sin(phi), np.cos(theta)[:, None]), -1)
    ring = np.arange(around * (along + 1)).reshape(along + 1, around)
    after = np.roll(ring, -1, axis=1)
    quads = np.stack([ring[:-1], ring[1:], after[1:], after[:-1]], -1).reshape(-1, 4)
    obj = mesh_object("Spun", vertices.reshape(-1, 3), [*quads.tolist(), ring[0].tolist(), ring[-1, ::-1].tolist()])
    assert run() == {"FINISHED"}
    corners = uv(obj)[: quads.size].reshape(-1, 4, 2)
    assert np.isfinite(corners).all() and np.ptp(corners, axis=1).max(axis=1).min() > FLOAT32
    assert only_part(obj)["done"] and only_part(obj)["main_map"]["collapsed_triangles"] == 0


def test_poles_with_residues_on_a_torus():
    obj = torus(around=80, across=40)
    pick(obj, [0, 840, 2000])
    assert run(use_selection="POLES", residues="1 1 -2", evenness=0) == {"FINISHED"}
    entry = only_part(obj)
    assert entry["poles"] == [0, 840, 2000]
    assert entry["residues"] == [[1, 0], [1, 0], [-2, 0]]
    assert entry["main_map"]["mean_angle"] < 1.3


def test_a_component_is_reported_as_by_the_package():
    obj = torus_with_a_hole()
    assert run(density=2.0) == {"FINISHED"}
    (part,) = parts_of(obj)
    package = module("native").load()
    expected = package.report.part_report(package.form_map(part, package.automatic_structure(part)))
    entry = only_part(obj)
    assert entry.keys() == expected.keys() and entry["main_map"].keys() == expected["main_map"].keys()
    assert entry["main_map"]["coefficients"] == pytest.approx(expected["main_map"]["coefficients"])
    measured = {"timings", "solver", "residuals", "main_map"}
    assert {k: v for k, v in entry.items() if k not in measured} == json.loads(
        json.dumps({k: v for k, v in expected.items() if k not in measured})
    )
    assert stored_report(obj)["dials"]["density"] == 2.0


def test_a_skipped_component_has_its_reason(monkeypatch):
    structures = module("solving.jobs").structures
    structure_of_part = structures._structure_of_part

    def without_spheres(part, *rest):
        if part.genus == 0:
            return structures.PartStructure(part, None, reason="too round")
        return structure_of_part(part, *rest)

    monkeypatch.setattr(structures, "_structure_of_part", without_spheres)
    obj = two_parts("Two", torus_arrays(), sphere_arrays())
    assert run() == {"FINISHED"}
    (skipped,) = [c for c in stored_report(obj)["components"] if not c["done"]]
    (part,) = [p for p in parts_of(obj) if p.genus == 0]
    assert skipped == module("native").load().report.skipped_report(part, "too round")


def test_the_vertices_in_the_report_are_those_of_the_whole_mesh():
    obj = two_parts("Two", torus_arrays(), sphere_arrays())
    picked = [len(torus_arrays()[0]) + pole for pole in poles()]
    pick(obj, picked)
    assert run() == {"FINISHED"}
    closed, with_poles = sorted(stored_report(obj)["components"], key=lambda c: -c["genus"])
    assert "poles" not in closed
    assert sorted(with_poles["poles"]) == sorted(picked)
    assert all(str(vertex) in with_poles["description"] for vertex in picked)


@pytest.mark.parametrize(
    ("picked", "options", "word"),
    [
        ([3], {"use_selection": "POLES"}, "pole"),
        (poles(), {"use_selection": "POLES", "residues": "1 1"}, "residue"),
        (poles(), {"use_selection": "POLES", "residues": "1"}, "residue"),
        (poles(), {"use_selection": "POLES", "residues": "one two"}, "'one' is not a number"),
        ([3, 7, 20, 30], {"use_selection": "RECTANGLE"}, "rectangle"),
    ],
)
def test_an_explicit_choice_that_does_not_fit_is_refused(picked, options, word):
    obj = mesh_object("Sphere", *sphere_arrays())
    pick(obj, picked)
    before = everything(obj)
    with pytest.raises(RuntimeError, match=word) as caught:
        run(**options)
    assert everything(obj) == before
    assert "Traceback" not in str(caught.value)


def test_an_automatic_choice_that_does_not_fit_is_left_out_and_told():
    obj = mesh_object("Sphere", *sphere_arrays())
    pick(obj, [3])
    assert run() == {"FINISHED"}
    entry = only_part(obj)
    assert "pole" in entry["not_followed"]
    assert len(entry["poles"]) == 2


@pytest.mark.parametrize("solver", ["direct", "multigrid"])
def test_the_solver_can_be_chosen(solver):
    obj = mesh_object("Tube", *tube_arrays(around=240, along=120))
    assert run(solver=solver) == {"FINISHED"}
    assert only_part(obj)["solver"]["name"].startswith(solver)


def test_the_papers_solver_is_for_the_parts_that_it_fits():
    obj = two_parts("Two", torus_arrays(), sphere_arrays())
    assert run(solver="paper") == {"FINISHED"}
    closed, with_poles = sorted(stored_report(obj)["components"], key=lambda c: -c["genus"])
    assert closed["solver"]["name"].startswith("paper")
    assert with_poles["done"] and not with_poles["solver"]["name"].startswith("paper")


def test_a_modifier_that_may_close_the_surface_is_told():
    obj = mesh_object("Tube", *tube_arrays())
    obj.modifiers.new("My Mirror", "MIRROR")
    outcome = written(obj)
    assert any("My Mirror" in note for note in outcome.notes)


def test_the_panel_tells_kinds_and_moduli():
    obj = mesh_object("Tube", *tube_arrays())
    select(obj)
    run()
    lines = obj.holomorph_map.made.summary
    assert "genus 0, 2 boundary loops" in lines and "modulus" in lines and "between" in lines
