"""Conformal invariants of surfaces with boundary against exact values: orders of convergence, bounds, refinement."""

import json
from functools import cache

import families
import numpy as np
import pytest
from forms import edge_forms
from holomorph import Surface, conformal_structure
from shared_data import shared_folder
from solved import surface_of

# Capacity of {max |x| < 1} minus {max |x| <= 1/2}: ../shared/reference/values.json, by elliptic integrals.
SQUARE_MINUS_SQUARE = 10.234092569368052


@cache
def reference_structure(name):
    return conformal_structure(Surface.read(shared_folder("reference") / "meshes" / f"{name}.obj"))


def exact(*keys):
    value = json.loads((shared_folder("reference") / "values.json").read_text())["boundary"]
    for key in keys:
        value = value[key]
    return value


def orders(errors, factors=2.0):
    """Observed orders of convergence of errors on meshes each finer by `factors`."""
    errors = np.abs(errors)
    return np.log(errors[:-1] / errors[1:]) / np.log(factors)


def contains(bounds, value):
    return bounds[0] <= value <= bounds[1]


# ---- moduli of annuli ----------------------------------------------------------------------------


def test_eccentric_annulus():
    """Circles inscribed by polygons: second order, and here the width of the bounds is larger than that error."""
    modulus = exact("eccentric_annulus", "R=1,r=0.3,d=0.4")
    structures = [reference_structure(f"annulus_eccentric_{h}") for h in (0.08, 0.04, 0.02)]
    assert (orders([structure.modulus - modulus for structure in structures]) > 1.9).all()
    assert (orders([np.subtract(*structure.modulus_bounds) for structure in structures]) > 1.9).all()
    assert contains(structures[-1].modulus_bounds, modulus)
    assert abs(structures[-1].modulus - modulus) < 1e-4


@pytest.mark.parametrize("n", [3, 5, 24])
def test_prism(n):
    """A tube of n flat sides is a flat cylinder: linear functions are exact on any mesh, and the bounds close up."""
    mesh = families.cylinder(n, 7)
    height = np.ptp(mesh.vertices[:, 2])
    modulus = height / (2 * n * np.sin(np.pi / n))
    structure = conformal_structure(surface_of(mesh))
    assert abs(structure.modulus - modulus) < 1e-12 * modulus
    assert np.abs(np.array(structure.modulus_bounds) - modulus).max() < 1e-12 * modulus


def cone(n):
    """From radius 1/2 to 2 at the half angle 30 degrees: ln(R/r) / (2 pi sin a)."""
    radius = 0.5 * 4 ** np.linspace(0, 1, n // 4 + 1)
    return families.ring_of_revolution(radius, radius / np.tan(np.pi / 6), n), np.log(4) / np.pi


def catenoid(n):
    """r = cosh z, 0 <= z <= 1.5: dz / 2 pi."""
    height = np.linspace(0, 1.5, n // 4 + 1)
    return families.ring_of_revolution(np.cosh(height), height, n), 1.5 / (2 * np.pi)


@pytest.mark.parametrize("ring", [cone, catenoid])
def test_rings_of_revolution(ring):
    """(1 / 2 pi) times the integral of ds / r along the profile: second order."""
    errors = []
    for n in (16, 32, 64):
        mesh, modulus = ring(n)
        errors.append(conformal_structure(surface_of(mesh)).modulus / modulus - 1)
    assert (orders(errors) > 1.8).all()
    assert abs(errors[-1]) < 2e-3


# ---- polygonal boundaries: the bounds are those of the very domain ---------------------------------


def polygonal(structures, capacity, worst_order):
    errors = np.array([structure.capacity_matrix[0, 0] - capacity for structure in structures])
    widths = np.array([np.subtract(*(bound[0, 0] for bound in structure.capacity_bounds)) for structure in structures])
    for structure in structures:
        assert contains([bound[0, 0] for bound in structure.capacity_bounds], capacity)
    assert (orders(widths) > worst_order).all()
    return np.abs(errors / widths)


def test_square_minus_square_of_the_reference():
    """Corners of 3 pi / 2: order 4/3; the projected value is far inside the bounds."""
    structures = [reference_structure(f"square_minus_square_0.5_{h}") for h in (0.05, 0.025)]
    assert exact("square_minus_square", "capacity, {max|x|<1} minus {max|x|<=a}", "0.5") == SQUARE_MINUS_SQUARE
    assert (polygonal(structures, SQUARE_MINUS_SQUARE, 1.25) < 1 / 50).all()


@pytest.mark.parametrize("jitter", [0.0, 0.25])
def test_square_minus_square(jitter):
    structures = [conformal_structure(surface_of(families.square_minus_square(k, jitter))) for k in (4, 8, 16)]
    assert (polygonal(structures, SQUARE_MINUS_SQUARE, 1.2) < 1 / 4).all()


@pytest.mark.parametrize("jitter", [0.0, 0.2])
def test_corner_of_a_cube(jitter):
    """Three of the four trapezoids that make the square ring, and by symmetry three quarters of its capacity."""
    structures = [conformal_structure(surface_of(families.cube_corner(k, jitter))) for k in (4, 8, 16)]
    assert (polygonal(structures, 0.75 * SQUARE_MINUS_SQUARE, 1.2) < 1 / 4).all()


# ---- several holes -------------------------------------------------------------------------------


def test_three_holes():
    """Circles inscribed by polygons: second order. The outer circle is loop 0, because it is the longest."""
    diagonal = exact("three_holes", "unit disk minus three disks of radius 0.2 at 0.5 w^k", "capacity diagonal")
    between = exact("three_holes", "unit disk minus three disks of radius 0.2 at 0.5 w^k", "off diagonal")
    capacity = np.where(np.eye(3), diagonal, between)
    structures = [reference_structure(f"three_holes_{h}") for h in (0.05, 0.025)]
    errors = [np.abs(structure.capacity_matrix - capacity).max() for structure in structures]
    assert orders(errors) > 1.9
    assert errors[-1] < 1e-2
    for structure in structures:
        assert np.abs(structure.period_matrix - 0.5j * structure.capacity_matrix).max() < 1e-12


# ---- the same polyhedral surface on finer meshes -------------------------------------------------

REFINED = {
    "square minus square": families.square_minus_square(2, jitter=0.2),
    "three holes in a ball": families.punched(families.block_with_holes(0, refine=3, jitter=0.1), 3),
    "torus with a hole": families.without_faces(families.torus(10, 8), [3], ((1, 1),)),
    "torus with three holes": families.punched(families.torus(12, 9), 3),
    "genus 2 with two holes": families.punched(families.block_with_holes(2, refine=2), 2),
}


def in_coarse_classes(coarse, fine):
    """Lower bound, projected value and upper bound of the natural Gram matrix of `fine` in the classes of `coarse`,
    whose vertices come first in `fine`: over the loops of `coarse` with the midpoint of every edge put in."""
    edges = edge_forms(fine)
    middle = {}
    old = len(coarse.surface.vertices)
    for a, b in fine.edges[(fine.edges[:, 0] < old) & (fine.edges[:, 1] >= old)]:
        middle.setdefault(int(b), []).append(int(a))
    between = {tuple(sorted(ends)): vertex for vertex, ends in middle.items() if len(ends) == 2}
    loops = []
    for loop in coarse.homology_basis:
        pairs = zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True)
        loops.append(np.array([v for a, b in pairs for v in (a, between[min(a, b), max(a, b)])]))
    M = np.rint(edges.integrals(fine.natural_forms, loops).T)
    change = np.linalg.inv(M).T
    natural, dirichlet = fine.gram_matrices
    lower = fine.pairing @ np.linalg.inv(dirichlet) @ fine.pairing.T
    projected = fine.projected_gram_matrices[0]
    return [change @ gram @ change.T for gram in (lower, projected, natural)]


def least_eigenvalue(matrix):
    return np.linalg.eigvalsh((matrix + matrix.T) / 2).min()


@pytest.mark.parametrize("name", REFINED)
def test_bounds_are_nested_under_refinement(name):
    """Midpoints change nothing about the surface: upper bounds fall, lower ones rise, as quadratic forms, and the
    projected value stays within them all. The widths shrink."""
    mesh = families.triangles_of(REFINED[name])
    coarse = conformal_structure(surface_of(mesh))
    fine = conformal_structure(surface_of(families.subdivided(mesh)))
    natural, dirichlet = coarse.gram_matrices
    first = coarse.pairing @ np.linalg.inv(dirichlet) @ coarse.pairing.T
    lower, projected, upper = in_coarse_classes(coarse, fine)
    slack = 1e-10 * np.abs(upper).max()
    for smaller, larger in ((first, lower), (lower, projected), (projected, upper), (upper, natural)):
        assert least_eigenvalue(larger - smaller) > -slack
    assert np.trace(upper - lower) < 0.6 * np.trace(natural - first)
