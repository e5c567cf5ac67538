# SPDX-License-Identifier: GPL-3.0-or-later
"""What is reported of a tiling: first in words, then in numbers."""

from dataclasses import asdict

import numpy as np

from . import native, report, tiling

EVEN, FAIRLY_EVEN = 6.0, 20.0  # the largest 95 : 5 % ratios of the density that are called so
SHEARED, SLIGHTLY_SHEARED = 1.05, 1.01  # likewise the smallest mean s1 / s2 that the rounding adds
SHOWN_PARTS = 8  # of which the redo panel shows a line


def verdict(made):
    """A few words, such as "Even, seamless, 8 poles"."""
    ratio, added, count = made.density_ratio, made.added_distortion, len(made.poles)
    words = ["even" if ratio <= EVEN else "fairly even" if ratio <= FAIRLY_EVEN else "uneven", "seamless"]
    if added >= SLIGHTLY_SHEARED:
        words.append("sheared" if added >= SHEARED else "slightly sheared")
    words.append("no poles" if count == 0 else "1 pole" if count == 1 else f"{count} poles")
    return ", ".join(words).capitalize()


def part_report(part):
    """The package's report of a `tiling.TiledPart`, and its tiling; vertices are those of the object."""
    package, component = native.load().report, part.component
    if part.tiling is None:
        return package.skipped_report(component.surface, part.reason)
    made = part.tiling
    entry = package.component_report(component.surface, component.structure, package.map_report([], made.quality))
    zeros, orders = made.zeros
    return (
        entry
        | report.not_followed(component)
        | {
            "forms": component.form_count,
            "tiling": package.plain(
                {
                    "verdict": verdict(made),
                    "added_distortion": float(made.added_distortion),
                    "density_ratio": float(made.density_ratio),
                    "left_over": float(made.left_over),
                    "poles": part.vertices(made.poles),
                    "residues": package.complex_pairs(made.residues),
                    "zeros": part.vertices(zeros),
                    "orders": np.asarray(orders),
                    "periods": np.asarray(made.periods),
                }
            ),
        }
    )


def asked(options):
    """`tiling.TileOptions` for a report; where poles are allowed is a vertex group of the object."""
    return {name: value for name, value in asdict(options).items() if name != "allowed"}


def asked_again(stored, allowed):
    """The `tiling.TileOptions` out of a stored report; None where there are none."""
    values = report.parsed(stored).get("asked")
    if values is None:
        return None
    values = {name: _as_tuple(value) for name, value in values.items()}
    return tiling.TileOptions(**values, allowed=allowed)


def _as_tuple(value):
    return tuple(map(_as_tuple, value)) if isinstance(value, list) else value


def read_out(stored):
    """Those of all parts in a stored report, for the redo panel; none if someone has edited it."""
    parts = [part["tiling"] for part in report.parsed(stored).get("components", []) if "tiling" in part]
    if len(parts) == 1:
        return list(report.tiling_lines(parts[0]))
    return [f"Part {index}: {part['verdict']}" for index, part in enumerate(parts[:SHOWN_PARTS], 1)]


def draw_read_out(layout, obj):
    """In a redo panel, for the active object or None."""
    lines = read_out(obj.get(report.PROPERTY)) if obj is not None else []
    if lines:
        column = layout.box().column(align=True)
        for line in lines:
            column.label(text=line)


def notes(obj, entry):
    """For the user: the verdicts of an object's parts in its report."""
    verdicts = {part["tiling"]["verdict"] for part in entry["components"] if "tiling" in part}
    return [f"{obj.name}: {'; '.join(sorted(verdicts))}"] if verdicts else []


def marks(stored):
    """((n,) vertices, (n,) whether it is a pole) of a stored report; none of one without a tiling."""
    parts = [part["tiling"] for part in report.parsed(stored).get("components", []) if "tiling" in part]
    poles = [vertex for part in parts for vertex in part["poles"]]
    zeros = [vertex for part in parts for vertex in part["zeros"]]
    is_pole = np.arange(len(poles) + len(zeros)) < len(poles)
    return np.array(poles + zeros, np.int64), is_pole
