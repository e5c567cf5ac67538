"""Period matrices of curves y^2 = f(x), an oracle for surfaces: integrals along a path through the branch points.

The points are sorted, so that the path does not cross itself. The loop C_k goes around its edge k and back on the other
sheet; the path passes each point on the left, so C_k . C_(k+1) = 1, and other loops do not meet. So a_i = C_(2i-1) and
b_i = C_2i + C_(2i+2) + ... + C_2g are canonical. What is made is checked: it is symmetric only if all signs are right.
"""

import numpy as np
from holomorph.forms.certificate import PeriodMatrix

NODES = 4000  # of Chebyshev's rule, for points that are hundreds of times nearer than the edges are long
ERROR = 1e-11  # what rounding leaves of the curves in these tests


def curve_period_matrix(coefficients):
    """(g, g) `PeriodMatrix`; the coefficients of f, the highest power first."""
    return period_matrix_of(np.roots(coefficients).astype(complex))


def period_matrix_of(points):
    """The same from the 2g + 1 or 2g + 2 roots of f."""
    points = np.asarray(points, complex)
    points = points - np.median(points)
    points = points / np.median(np.abs(points))
    points = points[np.lexsort((points.imag, points.real.round(9)))]
    g = (len(points) - 1) // 2
    loops = np.array(list(_loops(points, g)))[: 2 * g]
    a, b = loops[0::2].T, np.cumsum(loops[1::2][::-1], axis=0)[::-1].T
    omega = np.linalg.solve(a, b)
    assert np.abs(omega - omega.T).max() < ERROR * np.abs(omega).max()
    omega = (omega + omega.T) / 2
    assert np.linalg.eigvalsh(omega.imag).min() > 0
    return PeriodMatrix.of(omega, ERROR)


def _loops(points, g):
    """For each edge of the path the integrals of x^j dx / y, j < g, around it; y is carried along."""
    cosines = np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
    angles = np.angle(points[0] - points)  # of x - e_j, where x is at the start of the edge
    for k in range(len(points) - 1):
        start, end = points[k : k + 2]
        along = np.angle(end - start)
        # Past e_k on its left, the direction from it turns clockwise.
        angles[k] = along if k == 0 else angles[k] - np.mod(angles[k] - along, 2 * np.pi)
        others = np.delete(np.arange(len(points)), [k, k + 1])
        middle, half = (start + end) / 2, (end - start) / 2
        turned = angles[others] + np.angle((middle - points[others]) / (start - points[others]))
        x = middle + half * cosines[:, None]
        # For the other points, roots of (x - e) / (middle - e), which stay on one branch along the edge.
        roots = np.sqrt(np.abs(middle - points[others])) * np.exp(0.5j * turned)
        rest = np.prod(roots * np.sqrt((x - points[others]) / (middle - points[others])), axis=1)
        both = np.exp(0.5j * (angles[k] + angles[k + 1]))  # of (x - e_k) (x - e_(k+1)), times |half| sin
        powers = x ** np.arange(g)
        yield 2 * np.pi / NODES * half / np.abs(half) * (powers / (both * rest)[:, None]).sum(axis=0)
        angles[others] = turned + np.angle((end - points[others]) / (middle - points[others]))
