"""Reports as plain data, ready for JSON. Complex numbers are pairs [real, imaginary]."""

import math

import numpy as np


def complex_pairs(matrix):
    """Nested lists in which each complex number is [real, imaginary]."""
    matrix = np.asarray(matrix)
    return np.stack([matrix.real, matrix.imag], axis=-1).tolist()


def finite_or_none(number):
    """None where a quality is infinite, because some UV triangle has collapsed: JSON knows no infinity."""
    return number if math.isfinite(number) else None


def component_report(structure):
    """What is known about one component, with the quality of its balanced map."""
    coefficients = structure.balanced_coefficients()
    quality = structure.quality(structure.uv(coefficients))
    surface = structure.surface
    return {
        "done": True,
        "faces": len(surface.face_offsets) - 1,
        "genus": surface.genus,
        "boundary_count": surface.boundary_count,
        "description": structure.description,
        **structure.invariants(),
        "residuals": vars(structure.residuals) | {"solver": structure.solver.residual},
        "solver": vars(structure.solver),
        "timings": structure.timings,
        "intrinsic_flips": structure.flip_count,
        "balanced": {
            "coefficients": complex_pairs(coefficients) if np.iscomplexobj(coefficients) else coefficients.tolist(),
            "mean_angle": finite_or_none(quality.mean_angle),
            "density_ratio": finite_or_none(quality.density_ratio),
            "flipped_triangles": int(quality.flipped.sum()),
            "collapsed_triangles": int(quality.collapsed.sum()),
        },
    }


def skipped_report(surface, error):
    """Why a component was not done."""
    return {
        "done": False,
        "faces": len(surface.face_offsets) - 1,
        "genus": surface.genus,
        "boundary_count": surface.boundary_count,
        "reason": str(error),
    }
