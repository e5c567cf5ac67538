"""What every result must be, whatever it was made of; and which errors are answers."""

import linecache
import traceback

import holomorph
import numpy as np
from holomorph import BoundedStructure, ConformalStructure, RectangleMap

ROUNDING = 1e-7  # relative: bounds may miss an exact value, or cross, by what the solver leaves over


def check_surface(surface):
    """A surface that was accepted has finite positions, and corners that are vertices."""
    native = surface._native
    assert native.intrinsic or np.isfinite(surface.vertices).all(), "a vertex is not finite"
    assert 0 <= surface.corner_vertices.min() <= surface.corner_vertices.max() < native.vertex_count
    assert (np.diff(surface.face_offsets) >= 3).all()
    assert len(surface.triangles) == (np.diff(surface.face_offsets) - 2).sum()
    assert np.isfinite(surface.repairs.mollification)


def check_finite(name, array):
    assert np.isfinite(array).all(), f"{name} is not finite"


def is_positive_definite(matrix):
    """By the eigenvalues of the matrix scaled to a diagonal of 1, which sees small entries beside large ones."""
    scale = np.sqrt(matrix.diagonal())
    if not (np.isfinite(scale).all() and (scale > 0).all()):
        return False
    return np.linalg.eigvalsh(matrix / np.outer(scale, scale))[0] > 0


def check_order(name, lower, upper):
    """lower <= upper as quadratic forms, each pair of rows in its own unit."""
    lower, upper = np.atleast_2d(lower), np.atleast_2d(upper)
    check_finite(f"{name}, lower", lower)
    check_finite(f"{name}, upper", upper)
    scale = np.sqrt(upper.diagonal())
    assert (scale > 0).all(), f"{name}: the upper bound is not positive"
    least = np.linalg.eigvalsh((upper - lower) / np.outer(scale, scale))[0]
    assert least >= -ROUNDING, f"{name} cross by {-least:.1e}"


def check_contains(name, lower, upper, exact):
    """Bounds of a positive number."""
    slack = ROUNDING * exact
    assert lower <= exact + slack and exact <= upper + slack, f"{name} [{lower!r}, {upper!r}] without {exact!r}"


def check_invariants(structure):
    """Period matrices, moduli and their bounds, as far as the structure has them."""
    if isinstance(structure, (ConformalStructure, BoundedStructure)):
        check_finite("period_matrix", structure.period_matrix)
        assert is_positive_definite(structure.period_matrix.imag), "Im Omega is not positive definite"
        assert (
            np.abs(structure.period_matrix - structure.period_matrix.T).max()
            <= 1e-6 * np.abs(structure.period_matrix).max()
        ), "Omega is not symmetric"
        if structure.period_bounds is not None:
            check_order("period_bounds", *structure.period_bounds)
    if _has_modulus(structure) and structure.modulus_bounds is not None:
        lower, upper = structure.modulus_bounds
        check_order("modulus_bounds", lower, upper)
        assert lower * (1 - ROUNDING) <= structure.modulus <= upper * (1 + ROUNDING), "the modulus is out of its bounds"
    for name, value in vars(structure.residuals).items():
        check_finite(f"the residual {name}", value)


def _has_modulus(structure):
    surface = structure._component
    is_annulus = isinstance(structure, BoundedStructure) and (surface.genus, surface.boundary_count) == (0, 2)
    return is_annulus or isinstance(structure, RectangleMap)


def check_map(structure, coefficients):
    """A UV map is finite, and so are the numbers that its quality is told in."""
    uv = structure.uv(coefficients)
    check_finite("uv", uv)
    quality = structure.quality(uv)
    assert not np.isnan(quality.angle).any() and not np.isnan(quality.area).any(), "quality is not a number"
    assert not np.isnan([quality.mean_angle, quality.density_ratio, quality.median_density]).any()
    return uv


def answer(call, *arguments):
    """ "done", or the name of the error in which a call ended. An error that is none of ours goes on."""
    try:
        call(*arguments)
    except holomorph.Error as error:
        assert str(error), f"{type(error).__name__} without a message"
        return type(error).__name__
    except ValueError as error:
        if type(error) is not ValueError or not _is_raised_by_us(error):
            raise
        return "ValueError"
    return "done"


def _is_raised_by_us(error):
    """Whether a statement of the package raised it, and not NumPy or Python inside of it."""
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return "/holomorph/" in frame.filename and linecache.getline(frame.filename, frame.lineno).lstrip().startswith(
        "raise"
    )
