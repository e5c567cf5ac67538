"""How much of the plane a map covers twice."""

import numpy as np

from ..core.array_types import Progress
from ..core.progress import tell

ROWS_PER_EDGE, MOST_ROWS = 8, 4096  # numbers of lines across a curve that are looked at
MOST_CROSSINGS = 500_000, 64  # of all lines with edges, about: this many, or so many for each edge
AT_ONCE = 500_000, 16  # of these that are there at the same time


def overlapping_part(curve, progress: Progress | None = None) -> float:
    """The part of the region around which closed curves wind that they wind around more than once: 0 where the map that
    they bound lies beside itself nowhere.

    curve : (n, 2) complex ends of directed edges, which make closed curves
    progress : is asked whether to go on

    The winding number is exact along each of up to 4096 horizontal lines at equal distances, the area the sum of the
    lengths: an overlap lower than their distance may lie between two of them. A curve of many edges across all lines,
    as around a star, has fewer lines.
    Cost: O(m log m) for m crossings, at most half a million or 64 for each edge.
    """
    start, end = curve.T
    low = start.imag.min()
    extent = start.imag.max() - low
    if not extent > 0 or not np.isfinite(curve).all():
        return 0.0
    per_row = np.abs(end.imag - start.imag).sum() / extent
    most = max(MOST_CROSSINGS[0], MOST_CROSSINGS[1] * len(curve))
    rows = max(min(ROWS_PER_EDGE * len(curve), MOST_ROWS, int(most / per_row)), 1)
    height = extent / rows
    # Row k lies at low + (k + 1/2) height. Each end is rounded once: edges that meet there share no row and skip none.
    first, last = (np.ceil((at.imag - low) / height - 0.5).astype(np.int64) for at in (start, end))
    lowest, highest = np.minimum(first, last), np.maximum(first, last)
    crossings = np.cumsum(np.cumsum(np.bincount(lowest, minlength=rows + 1) - np.bincount(highest, minlength=rows + 1)))
    at_once = max(AT_ONCE[0], AT_ONCE[1] * len(curve))
    breaks = np.searchsorted(crossings, np.arange(at_once, crossings[-1], at_once))
    around = twice = 0.0
    for begin, after in zip([0, *breaks], [*breaks, rows]):
        tell(progress, 0.0, "overlaps")
        from_row = np.maximum(lowest, begin)
        count = np.maximum(np.minimum(highest, after) - from_row, 0)
        edge = np.repeat(np.arange(len(curve)), count)
        row = from_row[edge] + np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)
        along = (low + (row + 0.5) * height - start.imag[edge]) / (end.imag - start.imag)[edge]
        x = start.real[edge] + along * (end.real - start.real)[edge]
        order = np.argsort(x)
        order = order[np.argsort(row[order].astype(np.uint16), kind="stable")]  # a radix sort
        winding = np.cumsum(np.sign(first - last)[edge[order]])[:-1]  # 0 at the end of each row
        length = np.diff(x[order])
        around += float(length[winding != 0].sum())
        twice += float(length[np.abs(winding) > 1].sum())
    return twice / around if around > 0 else 0.0
